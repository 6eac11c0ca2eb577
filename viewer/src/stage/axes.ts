import type { About, Quadruple, Triple } from "../core/core.ts";
import { AXES, quaternion } from "./rotor.ts";

/** Moments whose relative difference is less than this count as equal. */
const EQUAL = 1e-9;

/** The indices of the axes from the smallest moment to the largest. */
export function ordered(moments: Triple): Triple {
  return [0, 1, 2].sort((a, b) => moments[a]! - moments[b]!) as Triple;
}

/**
 * The names of the principal axes by their moments of inertia. Two axes with equal moments have the same name: all axes across
 * the symmetry axis are alike, and all axes of a ball.
 */
export function axisNames(moments: Triple): [string, string, string] {
  const [small, middle, large] = ordered(moments);
  const equal = (a: number, b: number) => moments[b]! - moments[a]! <= EQUAL * moments[large]!;
  const names: [string, string, string] = ["", "", ""];
  if (equal(small, large)) return ["any axis", "any axis", "any axis"];
  const alike = equal(small, middle) ? large : equal(middle, large) ? small : null;
  if (alike !== null)
    return names.map((_, k) => (k === alike ? "symmetry axis" : "transverse axis")) as never;
  [names[small], names[middle], names[large]] = ["smallest", "middle", "largest"];
  return names;
}

/** Axes of a body with the names of their moments. */
export interface NamedAxes {
  /** By axis, which has the colour of this index. */
  names: [string, string, string];
  /** Whether they are the axes of the body itself; else they are its principal axes, which lie elsewhere. */
  own: boolean;
  /** The rotor from them to the axes of the body. */
  frame: Quadruple;
}

/** The cosine of the angle, a few hundredths of a degree, up to which a principal axis counts as an axis of the body. */
const ALONG = 1 - 1e-7;

/** The principal axes of a body: its own axes, if these lie along them, in any order. */
export function namedAxes({ moments, frame }: About["body"]): NamedAxes {
  const names = axisNames(moments);
  const turn = quaternion(frame);
  const along = AXES.map((axis) => axis.clone().applyQuaternion(turn).toArray().map(Math.abs));
  // The principal axis along each axis of the body.
  const which = [0, 1, 2].map((own) => along.findIndex((components) => components[own]! > ALONG));
  if (which.includes(-1)) return { names, own: false, frame };
  return { names: which.map((k) => names[k]) as NamedAxes["names"], own: true, frame: [1, 0, 0, 0] };
}
