import { ROW, sizeAt, State } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import { type NamedAxes, namedAxes } from "../stage/axes.ts";
import { span } from "../model/model.ts";
import { firstRow } from "../model/speed.ts";
import { quaternion, vector } from "../stage/rotor.ts";
import { statesOf, type Steps } from "../stage/steps.ts";

/** States per turn of the body, and per column at most: beyond that the chart shows where ω is, not how it gets there. */
const PER_TURN = 14;
const PER_COLUMN = 24;
/** Its multiples spread the times evenly within a column; its multiples by square numbers shift each within its share, as if at random. */
const GOLDEN = (Math.sqrt(5) - 1) / 2;

/** The least and the largest ω along each of the named axes, rad/s, in columns of equal duration. */
export interface Envelope {
  /** The axis is that of the first index; NaN where the motion is not known. */
  least: Float64Array[];
  most: Float64Array[];
  /** Over all columns and axes, and zero. */
  range: [least: number, most: number];
  /** Whether columns hold more than a part of a turn, so that bands are drawn and not lines. */
  bands: boolean;
  /** Whether this is the last pass. */
  complete: boolean;
}

/** ω along named axes in a row of states, which begins at an offset. */
export function alongAxes(row: Float64Array, axes: NamedAxes, at = 0): number[] {
  const omega = vector(row, at + State.omegaBody);
  return (axes.own ? omega : omega.applyQuaternion(quaternion(axes.frame).invert())).toArray();
}

/**
 * Samples ω along the named axes from a time on, for a duration. Further passes sample each column once more, until the turns of the body are
 * resolved or columns are full; `show` gets what is known after each.
 */
export function* sampled(
  motion: Motion,
  { from, length, columns }: { from: number; length: number; columns: number },
  show: (envelope: Envelope) => void,
): Steps<void> {
  const { about } = motion;
  const axes = namedAxes(about.body);
  const per = (PER_TURN * (length / turnOf(motion))) / columns;
  const passes = Math.min(Math.max(Math.ceil(per), 1), PER_COLUMN);
  const filled = (value: number) => [0, 1, 2].map(() => new Float64Array(columns).fill(value));
  const [least, most] = [filled(Infinity), filled(-Infinity)];
  const range: [number, number] = [0, 0];
  const [first, last] = span(about);
  for (let pass = 0; pass < passes; pass++) {
    const times = Float64Array.from({ length: columns }, (_, k) => {
      // Equal steps alone may agree with the turns of the motion, of which they then show a few phases only.
      const moved = ((pass * columns + k) ** 2 * GOLDEN) % 1;
      const part = passes === 1 ? 0.5 : (pass * GOLDEN + moved / passes) % 1;
      return Math.min(Math.max(from + (length * (k + part)) / columns, first), last);
    });
    const rows = yield* statesOf(motion, times);
    for (let k = 0; k < columns; k++) {
      alongAxes(rows, axes, ROW * k).forEach((value, axis) => {
        least[axis]![k] = Math.min(least[axis]![k]!, value);
        most[axis]![k] = Math.max(most[axis]![k]!, value);
        range[0] = Math.min(range[0], value);
        range[1] = Math.max(range[1], value);
      });
    }
    yield;
    // The first pass at once, so that there is something to see; then now and then.
    const complete = pass === passes - 1;
    if (complete || pass % 4 === 0) show({ least, most, range: [...range], bands: passes > 1, complete });
  }
}

/** The time in which ω in the body may change, s: a turn of the body, or its period if that is shorter. */
function turnOf(motion: Motion): number {
  const { about } = motion;
  const rate = sizeAt(firstRow(motion), State.omegaBody) || about.duration / 100;
  // A symmetric body that spins about its axis has no other changes than its period.
  const period = about.free?.period ?? Infinity;
  if (about.free?.regime.startsWith("steady")) return Infinity;
  return about.free?.regime.startsWith("symmetric") ? period : Math.min((2 * Math.PI) / rate, period);
}
