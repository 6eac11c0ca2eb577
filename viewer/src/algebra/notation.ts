/** Values in mathematical notation. */

import type { Line } from "../core/core.ts";
import { exponentOf, powerOfTen } from "../format/numbers.ts";

/** A term of a value: its sign, the magnitude of its coefficient (empty for 1 before a blade), and its blade. */
export interface Term {
  negative: boolean;
  size: string;
  blade: string;
}

/** The indices of the basis blades; empty for the scalar 1. */
const BLADES = ["", "1", "2", "3", "23", "31", "12", "I"];
/** The first component of each grade. */
const STARTS = [0, 1, 4, 7, 8];

/** Components smaller than this fraction of the largest are rounding errors. */
const ROUNDING = 1e-12;
const DIGITS = 5;
const KINDS = ["scalar", "vector", "bivector", "trivector"];

/** The terms of a value with five digits for the largest; terms that round to 0 are left out. */
export function terms(components: readonly number[]): Term[] {
  const largest = Math.max(...components.map(Math.abs));
  const power = exponentOf(largest);
  const scientific = power < -3 || power > 5;
  const scale = scientific ? 10 ** power : 1;
  const decimals = scientific ? DIGITS - 1 : Math.max(DIGITS - 1 - power, 0);
  const times = scientific ? `·${powerOfTen(power)}` : "";
  return components.flatMap((x, k) => {
    const size = String(Number(Math.abs(x / scale).toFixed(decimals)));
    const blade = BLADES[k]!;
    if (size === "0") return [];
    return [{ negative: x < 0, size: size === "1" && !times && blade ? "" : size + times, blade }];
  });
}

/** The grades that are not zero up to rounding. */
export function nonzeroGrades({ components, grades }: NonNullable<Line["value"]>): number[] {
  const largest = Math.max(...components.map(Math.abs));
  const found = grades.filter((grade) =>
    components.slice(STARTS[grade], STARTS[grade + 1]).some((x) => Math.abs(x) > ROUNDING * largest),
  );
  return found.length > 0 ? found : grades.slice(0, 1);
}

/** The name of a value with some grades. */
export function kind(grades: readonly number[], rotor: boolean): string {
  if (rotor) return "rotor";
  if (grades.length === 1) return KINDS[grades[0]!]!;
  return `grades ${grades.join(", ")}`;
}

/** The letter, the index and the primes of a name: `a1'` is a with index 1 and one prime. */
export function nameParts(name: string): { letter: string; index: string; primes: string } {
  const match = /^(.+?)(?:_(\p{L}+\d*)|(\d+))?('*)$/u.exec(name);
  if (!match) return { letter: name, index: "", primes: "" };
  return { letter: match[1]!, index: match[2] ?? match[3] ?? "", primes: "′".repeat(match[4]!.length) };
}

/** A number with at most six decimals. */
export function numberText(x: number): string {
  return String(Number(x.toFixed(6)));
}
