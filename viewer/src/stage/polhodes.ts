import { Vector3 } from "three";
import type { Triple } from "../core/core.ts";
import { ordered } from "./axes.ts";

/**
 * Curves of constant |L| on the energy ellipsoid, in principal axes. In the coordinates u_k = ω_k √(i_k/2T) the ellipsoid
 * is the unit sphere, and Σ i_k u_k² = |L|²/2T on a curve.
 */

/** Points of a closed curve. */
const POINTS = 128;
/** Where neighbours pass the meridian, as fractions of the way from a pole to the separatrix. */
const NEIGHBOURS = [0.3, 0.62, 0.88];
/** Moments whose relative difference is less than this count as equal. */
const EQUAL = 1e-9;

/** A closed curve of unit vectors u. */
export type Curve = Vector3[];

/** The polhodes near that of a body, evenly spread between the poles and the separatrix. */
export function neighbours(moments: Triple): Curve[] {
  const [small, , large] = ordered(moments);
  return [small, large].flatMap((pole) => {
    const other = pole === small ? large : small;
    const reach = separatrixAngle(moments, pole);
    // Of two equal moments, neither has an axis of its own.
    if (reach < 1e-4) return [];
    return NEIGHBOURS.flatMap((part) => {
      const at = new Vector3().setComponent(pole, Math.cos(part * reach));
      at.setComponent(other, Math.sin(part * reach));
      const curve = through(moments, at);
      return curve ? [curve, curve.map((u) => u.clone().negate())] : [];
    });
  });
}

/** The two circles of the separatrix, which cross at the axis of the middle moment; none with two equal moments. */
export function separatrix(moments: Triple): Curve[] {
  const [small, middle, large] = ordered(moments);
  const [a, b, c] = [moments[small]!, moments[middle]!, moments[large]!];
  if (b - a < EQUAL * c || c - b < EQUAL * c) return [];
  const side = Math.sqrt((c - b) / (c - a));
  const up = Math.sqrt((b - a) / (c - a));
  return [1, -1].map((sign) =>
    turn().map((angle) => {
      const u = new Vector3().setComponent(middle, Math.cos(angle));
      u.setComponent(small, sign * side * Math.sin(angle));
      return u.setComponent(large, up * Math.sin(angle));
    }),
  );
}

/** The curve through a unit vector; null where it is a point, an axis of the body. */
export function through(moments: Triple, u: Vector3): Curve | null {
  const [small, middle, large] = ordered(moments);
  const [a, b, c] = [moments[small]!, moments[middle]!, moments[large]!];
  const level =
    a * u.getComponent(small) ** 2 + b * u.getComponent(middle) ** 2 + c * u.getComponent(large) ** 2;
  if (c - a < EQUAL * c) return null;
  // Around the axis of the largest moment, or around that of the smallest.
  const outer = level > b || (level === b && b - a < EQUAL * c);
  const [pole, other] = outer ? [large, small] : [small, large];
  const far = Math.abs(moments[pole]! - level);
  const [across, along] = [
    far / Math.abs(moments[pole]! - moments[other]!),
    far / Math.abs(moments[pole]! - b),
  ];
  if (!(across > 0) || !Number.isFinite(along)) return null;
  const side = u.getComponent(pole) < 0 ? -1 : 1;
  return turn().map((angle) => {
    const v = new Vector3().setComponent(other, Math.sqrt(across) * Math.cos(angle));
    v.setComponent(middle, Math.sqrt(along) * Math.sin(angle));
    return v.setComponent(pole, side * Math.sqrt(Math.max(1 - v.lengthSq(), 0)));
  });
}

/** The angle from a pole to the separatrix along the meridian of the other pole. */
function separatrixAngle(moments: Triple, pole: number): number {
  const [small, middle, large] = ordered(moments);
  const [a, b, c] = [moments[small]!, moments[middle]!, moments[large]!];
  const near = pole === large ? b - a : c - b;
  return c - a < EQUAL * c ? 0 : Math.acos(Math.sqrt(near / (c - a)));
}

function turn(): number[] {
  return Array.from({ length: POINTS }, (_, k) => (2 * Math.PI * k) / POINTS);
}
