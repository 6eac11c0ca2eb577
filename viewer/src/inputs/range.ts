import type { Unit } from "../format/units.ts";

/** Number of slider positions, fine enough that each pixel has one. */
export const POSITIONS = 1000;

/**
 * The range of a slider in SI units. A logarithmic range covers powers of ten; with `zero`, its left end is 0. There are
 * no values beyond a closed range.
 */
export interface Range {
  min: number;
  max: number;
  scale: "linear" | "log";
  zero?: boolean;
  closed?: boolean;
}

/** A logarithmic range from a fraction of a value to a multiple of it. */
export function around(value: number, times = 10): Range {
  return { min: value / times, max: value * times, scale: "log" };
}

/** The nearest value of the range if it is closed; any value otherwise. */
export function accepted(value: number, { min, max, zero, closed }: Range): number {
  return closed ? Math.min(Math.max(value, zero ? 0 : min), max) : value;
}

export function positionOf(value: number, { min, max, scale, zero }: Range): number {
  const first = zero ? 1 : 0;
  if (scale === "linear") return Math.round(((value - min) / (max - min)) * POSITIONS);
  if (value < min) return 0;
  return Math.round(first + (Math.log(value / min) / Math.log(max / min)) * (POSITIONS - first));
}

/** The value at a position, rounded to four digits in its unit. */
export function valueAt(position: number, { min, max, scale, zero }: Range, unit: Unit): number {
  if (scale === "linear") {
    const step = 10 ** (Math.floor(Math.log10((max - min) / unit.size)) - 3);
    const value = min + (position / POSITIONS) * (max - min);
    return clean(Math.round(value / unit.size / step) * step * unit.size);
  }
  const first = zero ? 1 : 0;
  if (position < first) return 0;
  const value = min * (max / min) ** ((position - first) / (POSITIONS - first));
  return clean(Number((value / unit.size).toPrecision(4)) * unit.size);
}

/** Removes the rounding errors of a product of short decimal numbers. */
function clean(number: number): number {
  return Number(number.toPrecision(14));
}
