import { effect, type ReadonlySignal, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { State } from "../core/core.ts";
import { runClock } from "../model/clock.ts";
import { type Model, words } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { NoWebGL, Stage } from "../stage/stage.ts";
import { typed } from "./format.ts";

/** The picture, with what to look at and what is wrong. */
export function Picture({ model, palette }: { model: Model; palette: ReadonlySignal<Palette> }) {
  const place = useRef<HTMLDivElement>(null);
  const missing = useSignal<string | null>(null);
  useEffect(() => {
    try {
      const stage = new Stage(place.current!, model, palette);
      const before = model.fitted.peek();
      const forget = effect(() => {
        if (model.fitted.value > before) stage.fit();
      });
      return () => {
        forget();
        stage.dispose();
      };
    } catch (error) {
      missing.value =
        error instanceof NoWebGL
          ? "This browser draws no 3-d pictures (WebGL 2 is missing or switched off). All numbers are there."
          : words(error);
      // The stage lets time pass; now nobody else does.
      return runClock(model);
    }
  }, [model, palette]);
  return (
    <section class="picture" aria-label="Picture">
      <div class="seen">
        <div class="stage" ref={place} />
        {missing.value !== null && <p class="missing">{missing.value}</p>}
        <Strobe model={model} />
        <Trouble model={model} />
      </div>
      {model.caption.value !== null && <p class="caption">{model.caption.value}</p>}
    </section>
  );
}

/** What is wrong with the scene, or with a file; the picture stays that of the last motion. */
function Trouble({ model }: { model: Model }) {
  const problem = model.problem.value;
  if (problem === null) return null;
  return (
    <div class="trouble" role="alert" id="problem">
      <pre>{problem}</pre>
      {model.scene.value !== null && (
        <button class="quiet" onClick={() => model.reset()}>
          Reset
        </button>
      )}
      {model.motion.value && model.draft.value === null && (
        <button class="quiet" onClick={() => (model.problem.value = null)}>
          Close
        </button>
      )}
    </div>
  );
}

/** Pictures in a second of the clock, as most screens show them. */
const PICTURES = 60;

/** Says while time passes that the body turns too far from one picture to the next to be followed by eye. */
function Strobe({ model }: { model: Model }) {
  const row = model.row.value;
  if (!row || !model.playing.value) return null;
  const rate = Math.hypot(...row.subarray(State.omegaSpace, State.omegaSpace + 3));
  const faithful = (Math.PI / 2) * (PICTURES / rate);
  if (!(Math.abs(model.speed.value) > faithful)) return null;
  // One digit, rounded down.
  const power = 10 ** Math.floor(Math.log10(faithful));
  const most = typed(Math.floor(faithful / power) * power, 1);
  return (
    <p class="strobe" id="strobe">
      Stroboscopic: more than a quarter turn from picture to picture. Faithful up to {most}×.
    </p>
  );
}
