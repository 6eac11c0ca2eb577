import { type About, hasMass, sizeAt, State } from "../core/core.ts";
import { significant } from "../format/numbers.ts";

/** Changes smaller than this, relative to the quantity, are rounding. */
const ROUNDING = 1e-9;

/** How L and E differ between two states: `L changes by 0.3 kg m²/s (12 %), E by +0.01 J`. */
export function changeOf(before: Float64Array, after: Float64Array, about: About): string {
  const part = (at: number): number => after[at]! - before[at]!;
  const momentum = Math.hypot(...[0, 1, 2].map((k) => part(State.momentumSpace + k)));
  const size = Math.max(sizeAt(before, State.momentumSpace), sizeAt(after, State.momentumSpace));
  const unit = (text: string): string => (hasMass(about) ? ` ${text}` : "");
  const first = sizeAt(before, State.momentumSpace);
  const share = first > 0 ? ` (${significant((100 * momentum) / first, 3)} %)` : "";
  const ofL =
    momentum > ROUNDING * size
      ? `L changes by ${significant(momentum, 4)}${unit("kg m²/s")}${share}`
      : "L stays";
  const energy = part(State.energy);
  const most = Math.max(Math.abs(before[State.energy]!), Math.abs(after[State.energy]!));
  const ofE =
    Math.abs(energy) > ROUNDING * most
      ? `E by ${energy > 0 ? "+" : ""}${significant(energy, 4)}${unit("J")}`
      : "E stays";
  return `${ofL}, ${ofE}`;
}
