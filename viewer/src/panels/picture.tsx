import { type ReadonlySignal, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { sizeAt, State } from "../core/core.ts";
import { typed } from "../format/numbers.ts";
import { Defined } from "../glossary/term.tsx";
import { Legend } from "../legend/legend.tsx";
import { HandsBar } from "../hands/bar.tsx";
import { EnergyGrip } from "../hands/energyGrip.ts";
import type { Hands } from "../hands/hands.ts";
import { SpaceHands } from "../hands/space.ts";
import { type Model, words } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { EnergyView, hasEnergyView } from "../stage/energy.ts";
import { separatrix } from "../stage/polhodes.ts";
import { Stage } from "../stage/stage.ts";
import { LONGEST_STEP } from "../stage/viewport.ts";

/** The picture, its caption, and error messages. */
export function Picture(props: {
  model: Model;
  palette: ReadonlySignal<Palette>;
  hands: Hands;
  compact: boolean;
  /** Whether there is no motion because a lesson is about formulas. */
  formulas: boolean;
}) {
  const { model, palette, hands, compact, formulas } = props;
  const place = useRef<HTMLDivElement>(null);
  const missing = useSignal<string | null>(null);
  useEffect(() => {
    try {
      const stage = new Stage(place.current!, model, palette, new SpaceHands(hands, () => palette.peek()));
      return () => stage.dispose();
    } catch (error) {
      missing.value = words(error);
      // Without a stage, which advances the time, a clock does.
      return runClock(model);
    }
  }, [model, palette, hands]);
  const caption = model.caption.value ?? model.about.value?.caption ?? null;
  const beside = model.shown.value.energy && hasEnergyView(model.about.value) && missing.value === null;
  const looks = ["seen", model.solving.value && "old", beside && "two"].filter(Boolean).join(" ");
  return (
    <section class="picture" aria-label="Picture">
      <div class={looks}>
        <div class="stage" ref={place} {...marking(model)} />
        {beside && <Energy model={model} palette={palette} hands={hands} />}
        {missing.value !== null && <p class="missing">{missing.value}</p>}
        {formulas && missing.value === null && (
          <p class="missing">
            This step of the lesson has no motion. Its formulas are on the page “Algebra”.
          </p>
        )}
        <div class="foot">
          <Solving model={model} />
          <Strobe model={model} />
          {missing.value === null && model.motion.value && <Legend model={model} />}
        </div>
        <ErrorMessage model={model} />
      </div>
      {caption && (
        <p class="caption">
          <Defined text={caption} />
        </p>
      )}
      {!compact && model.about.value && <HandsBar hands={hands} />}
    </section>
  );
}

/** Says that the picture is old, if the new motion takes so long that it is seen (see page.css). */
function Solving({ model }: { model: Model }) {
  return (
    <p class="solving" id="solving" role="status">
      {model.solving.value && "Computing… This picture is old."}
    </p>
  );
}

/** The energy ellipsoid beside the picture in space, with the names of what is drawn. */
function Energy({ model, palette, hands }: { model: Model; palette: ReadonlySignal<Palette>; hands: Hands }) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const view = new EnergyView(place.current!, model, palette, new EnergyGrip(hands, () => palette.peek()));
    return () => view.dispose();
  }, [model, palette, hands]);
  return (
    <>
      <p class="where left">In space</p>
      <div class="energy" ref={place} {...marking(model)} />
      <p class="where">In the body</p>
      <ul class="legend">
        <li class="dot">Ω, on its path: drag it</li>
        <li class="thin">paths of the same energy</li>
        {separatrix(model.about.value!.body.moments).length > 0 && <li class="dashed">separatrix</li>}
      </ul>
    </>
  );
}

/** While the pointer is over one picture, the tip of Ω is marked in both. */
function marking(model: Model) {
  return {
    onPointerEnter: () => (model.marked.value = true),
    onPointerLeave: () => (model.marked.value = false),
  };
}

/** Advances the model's time while it plays; returns the function that stops it. */
function runClock(model: Model): () => void {
  let frame = 0;
  let before = performance.now();
  const tick = (now: number): void => {
    model.tick(Math.min(Math.max((now - before) / 1000, 0), LONGEST_STEP));
    before = now;
    frame = requestAnimationFrame(tick);
  };
  tick(before);
  return () => cancelAnimationFrame(frame);
}

/** An error in the scene or in a file; the picture still shows the last motion. */
function ErrorMessage({ model }: { model: Model }) {
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

/** Frames per second of most screens. */
const FRAME_RATE = 60;

/** Warns during playback if the body turns so far per frame that its rotation cannot be seen. */
function Strobe({ model }: { model: Model }) {
  const row = model.row.value;
  if (!row || !model.playing.value) return null;
  const rate = sizeAt(row, State.omegaSpace);
  const faithful = (Math.PI / 2) * (FRAME_RATE / rate);
  if (!(Math.abs(model.speed.value) > faithful)) return null;
  // One digit, rounded down.
  const power = 10 ** Math.floor(Math.log10(faithful));
  const most = typed(Math.floor(faithful / power) * power, 1);
  return (
    <p class="strobe" id="strobe">
      Stroboscopic: more than a quarter turn per frame. Faithful up to {most}×.
    </p>
  );
}
