import { CAMERAS, type Shown, type ViewState } from "../document.ts";
import type { Model } from "../model/model.ts";

const THINGS: [keyof Shown, string][] = [
  ["body", "Body"],
  ["labels", "Labels"],
  ["bodyFrame", "Body axes f₁ f₂ f₃"],
  ["spaceFrame", "Space axes e₁ e₂ e₃"],
  ["omega", "Ω, as a disc"],
  ["momentum", "L, as a disc"],
  ["axial", "Axial vectors, as arrows"],
  ["trace", "Path of an axis"],
  ["polhode", "Polhode"],
  ["herpolhode", "Herpolhode"],
  ["poinsot", "Poinsot’s ellipsoid"],
  ["gravity", "Pivot and weight"],
];

const THEMES: [ViewState["theme"], string][] = [
  ["auto", "As the machine"],
  ["light", "Light"],
  ["dark", "Dark"],
];

/** What is drawn, from where, in which colours. */
export function ViewPanel({ model }: { model: Model }) {
  const shown = model.shown.value;
  return (
    <>
      <fieldset class="checks">
        <legend>Shown</legend>
        {THINGS.map(([thing, label]) => (
          <label class="check" key={thing}>
            <input
              id={`show-${thing}`}
              type="checkbox"
              checked={shown[thing]}
              onChange={() => model.toggle(thing)}
            />
            {label}
          </label>
        ))}
      </fieldset>
      <div class="row">
        <label for="camera">Camera</label>
        <select
          id="camera"
          value={model.camera.value}
          onChange={(event) => model.look({ camera: event.currentTarget.value as ViewState["camera"] })}
        >
          {CAMERAS.map((camera, k) => (
            <option value={camera} key={camera}>
              {`${k + 1}  ${camera}`}
            </option>
          ))}
        </select>
        <button id="fit" title="Fit all into the picture (F)" onClick={() => model.fit()}>
          Fit
        </button>
      </div>
      <div class="row">
        <label for="theme">Colours</label>
        <select
          id="theme"
          value={model.theme.value}
          onChange={(event) => model.look({ theme: event.currentTarget.value as ViewState["theme"] })}
        >
          {THEMES.map(([theme, label]) => (
            <option value={theme} key={theme}>
              {label}
            </option>
          ))}
        </select>
      </div>
    </>
  );
}
