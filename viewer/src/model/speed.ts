import { type About, sizeAt, State } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";

/** Real time, in s, of one turn of the body, of one cycle of what is slow, and of a whole motion. */
const TURN = 3;
const CYCLE = 8;
const WHOLE = 60;
/** Turns per second of real time that are well visible. */
const VISIBLE = 5;
/** Without another slow time, a motion computed in steps plays in a third of this. */
const PARTS = 3;

/** The state at the start of a motion. */
export function firstRow(motion: Motion): Float64Array {
  return motion.states([motion.about.start.time]);
}

/**
 * The default speed, 1, 2 or 5 times a power of ten: a slow cycle, such as a flip or a turn of precession, in some
 * seconds, and the whole motion in a minute if its turns stay visible; at least one turn in three seconds.
 */
export function defaultSpeed(motion: Motion): number {
  const { about } = motion;
  const rate = sizeAt(firstRow(motion), State.omegaSpace);
  const turn = rate > 0 ? (2 * Math.PI) / rate : Infinity;
  const calm = rate > 0 ? turn / TURN : about.duration / 20;
  return rounded(Math.max(calm, slow(about) / CYCLE, Math.min(about.duration / WHOLE, VISIBLE * turn)));
}

/** The time of a slow cycle, s. */
function slow({ exact, free, top, duration }: About): number {
  if (free) return free.flip_time ?? free.period ?? 0;
  if (top?.precession_rate) return Math.min((2 * Math.PI) / Math.abs(top.precession_rate), duration);
  return exact ? 0 : duration / PARTS;
}

/** The nearest of 1, 2, 5, 10, … */
function rounded(speed: number): number {
  const power = 10 ** Math.floor(Math.log10(speed));
  const first = speed / power;
  return (first < 1.5 ? 1 : first < 3.5 ? 2 : first < 7.5 ? 5 : 10) * power;
}
