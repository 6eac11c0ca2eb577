import type { Motion } from "../core/wasm.ts";
import { ROW } from "../core/core.ts";

/** Long work in steps, between which a frame can be drawn. */
export type Steps<T> = Generator<undefined, T, undefined>;

/** States computed in one step: a third of a millisecond for a motion without a closed form. */
const STATES = 25;

/** Runs some work for a time in ms, or to its end; returns whether it has ended. */
export function advance(work: Steps<void>, time: number): boolean {
  const end = performance.now() + time;
  do {
    if (work.next().done) return true;
  } while (performance.now() < end);
  return false;
}

/** Rows of states, as those of `motion.states`. */
export function* statesOf(motion: Motion, times: Float64Array): Steps<Float64Array> {
  const rows = new Float64Array(ROW * times.length);
  for (let first = 0; first < times.length; first += STATES) {
    rows.set(motion.states(times.subarray(first, first + STATES)), ROW * first);
    yield;
  }
  return rows;
}
