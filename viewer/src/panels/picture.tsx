import { effect, type ReadonlySignal, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { runClock } from "../model/clock.ts";
import { type Model, words } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { NoWebGL, Stage } from "../stage/stage.ts";

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
        <Trouble model={model} />
      </div>
      {model.caption.value !== null && <p class="caption">{model.caption.value}</p>}
    </section>
  );
}

/** What is wrong with the scene, in the core's words; the picture stays that of the last motion. */
function Trouble({ model }: { model: Model }) {
  const problem = model.problem.value;
  if (problem === null) return null;
  return (
    <div class="trouble" role="alert" id="problem">
      <pre>{problem}</pre>
      {model.motion.value && (
        <button class="quiet" onClick={() => model.reset()}>
          Reset
        </button>
      )}
    </div>
  );
}
