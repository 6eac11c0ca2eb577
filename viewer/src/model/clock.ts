import { effect } from "@preact/signals";
import type { Model } from "./model.ts";

/** The longest step in s, so that a page that was hidden continues where it was. */
const LONGEST = 0.1;

/** Advances the model's time while it plays; returns the function that stops it. */
export function runClock(model: Model): () => void {
  let frame = 0;
  let before = 0;
  const tick = (now: number): void => {
    model.tick(Math.min(Math.max((now - before) / 1000, 0), LONGEST));
    before = now;
    frame = requestAnimationFrame(tick);
  };
  const forget = effect(() => {
    cancelAnimationFrame(frame);
    if (!model.playing.value) return;
    before = performance.now();
    frame = requestAnimationFrame(tick);
  });
  return () => {
    forget();
    cancelAnimationFrame(frame);
  };
}
