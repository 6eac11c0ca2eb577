import type { About, LawEntry } from "../core/core.ts";
import { duration } from "../format/units.ts";

/** The regime of the motion as the core names it; empty if it has no name. */
export function regimeOf(about: About | null): string {
  return about?.free?.regime ?? about?.top?.regime ?? "";
}

/** From this modulus on a free body stays long near its middle axis, and turns over quickly in between. */
const FLIPPING = 0.99;

/** What happens, in a sentence for readers who do not know the names of regimes; `registry` has those of the laws. */
export function inWords(about: About | null, registry: readonly LawEntry[]): string {
  if (!about) return "";
  const { free, top, laws, held } = about;
  if (free) return ofFree(free);
  if (top) return ofTop(top);
  if (held) return "A heavy body turns about a fixed point. Its weight changes L all the time.";
  if (laws.length === 0) return "";
  if (laws.every(({ name }) => name === "gyrostat"))
    return "No torque acts from outside, so L is constant. A wheel in the body carries a part of it.";
  const labels = registry
    .filter((law) => laws.some(({ name }) => name === law.name))
    .map(({ label }) => label);
  const named = labels.length > 0 ? ` (${labels.join(", ").toLowerCase()})` : "";
  return `${laws.length > 1 ? "Torques act" : "A torque acts"} on the body${named}, so L changes.`;
}

function ofFree({
  regime,
  modulus,
  period,
  flip_time,
  precession_period,
}: NonNullable<About["free"]>): string {
  const turn = precession_period === null ? "" : `, once in ${duration(precession_period, 3)}`;
  switch (regime) {
    case "at rest":
      return "The body is at rest, and nothing turns it.";
    case "steady rotation about a fixed axis":
      return "It turns about one axis, which stays where it is.";
    case "symmetric top, regular precession":
      return `It wobbles steadily: its axis circles the axis of L${turn}.`;
    case "separatrix":
      return "It turns over once at most: its rotation tends to the axis of the middle moment.";
  }
  if (modulus > FLIPPING && flip_time !== null)
    return `It turns over again and again, every ${duration(flip_time, 3)}: about the axis of the middle moment no rotation is stable.`;
  const which = regime === "long-axis mode" ? "smallest" : "largest";
  const back = period === null ? "" : `, once in ${duration(period, 3)}`;
  return `It tumbles: in the body, Ω circles the axis of the ${which} moment${back}.`;
}

function ofTop({ regime, tilt, precession_rate }: NonNullable<About["top"]>): string {
  const around = precession_rate && (2 * Math.PI) / Math.abs(precession_rate);
  const turn = around ? `, once in ${duration(around, 3)}` : "";
  const path = /^nutating with (\w+)$/u.exec(regime)?.[1];
  if (path) return `The axis goes around the vertical${turn}, and nods on its way: its path has ${path}.`;
  switch (regime) {
    case "at rest":
      return "The body is at rest, and nothing turns it.";
    case "sleeping, upright":
      return "The top sleeps: it spins fast enough to stand upright.";
    case "sleeping, nearly upright":
      return "The top sleeps: it spins fast enough to stay nearly upright.";
    case "upright, unstable":
      return "The top stands upright, but spins too slowly: after the smallest push it falls.";
    case "hanging":
      return "The body hangs below its fixed point.";
    case "regular precession":
      return `The axis goes around the vertical${turn}, always at the same tilt.`;
    case "pendulum, swinging":
      return "It does not spin: it swings like a pendulum.";
    case "pendulum, circulating":
      return "It does not spin: it goes over the top again and again, like a pendulum.";
    case "separatrix":
      return tilt[0] === 0 ? "It rises towards the vertical, and never reaches it." : "";
  }
  return "";
}
