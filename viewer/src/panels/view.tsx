import { CAMERAS, type Shown, type ViewState } from "../document.ts";
import { Check, Select } from "../inputs/fields.tsx";
import type { Model } from "../model/model.ts";

const PARTS: [keyof Shown, string][] = [
  ["body", "Body"],
  ["labels", "Labels"],
  ["bodyFrame", "Body axes f₁ f₂ f₃"],
  ["spaceFrame", "Space axes e₁ e₂ e₃"],
  ["omega", "Ω as a disc"],
  ["momentum", "L as a disc"],
  ["torque", "Torque as a disc"],
  ["sources", "Fields, wheels, thrusts"],
  ["axial", "Axial vectors as arrows"],
  ["trace", "Path of an axis"],
  ["polhode", "Polhode"],
  ["herpolhode", "Herpolhode"],
  ["poinsot", "Poinsot’s ellipsoid"],
  ["energy", "Energy ellipsoid in body axes"],
  ["ghost", "Ghost 0.1° away"],
  ["gravity", "Pivot and weight"],
];

const THEMES: [ViewState["theme"], string][] = [
  ["auto", "Same as the system"],
  ["light", "Light"],
  ["dark", "Dark"],
];

/** What is drawn, the camera and the colours. */
export function ViewPanel({ model }: { model: Model }) {
  const shown = model.shown.value;
  return (
    <>
      <fieldset class="checks">
        <legend>Show</legend>
        {PARTS.map(([part, label]) => (
          <Check
            key={part}
            id={`show-${part}`}
            label={label}
            checked={shown[part]}
            onChange={() => model.toggle(part)}
          />
        ))}
      </fieldset>
      <Select
        id="camera"
        label="Camera"
        value={model.camera.value}
        options={CAMERAS.map((camera, k) => [camera, `${k + 1}  ${camera}`])}
        onChange={(camera) => model.look({ camera })}
      >
        <button id="fit" title="Fit everything into the picture (F)" onClick={() => model.fit()}>
          Fit
        </button>
      </Select>
      <Select
        id="theme"
        label="Colours"
        value={model.theme.value}
        options={THEMES}
        onChange={(theme) => model.look({ theme })}
      />
    </>
  );
}
