/** Values as they stand on paper. */

/** A term of a value: its sign, the size of its coefficient, empty for 1 before a blade, and the indices of its blade. */
export interface Term {
  negative: boolean;
  size: string;
  blade: string;
}

/** `1`, then vectors by their index, bivectors by two, and I. */
const BLADES = ["", "1", "2", "3", "23", "31", "12", "I"];
/** Where each grade begins among the components. */
export const STARTS = [0, 1, 4, 7, 8];

/** Below this part of the largest component a component is rounding. */
const NOTHING = 1e-12;
const DIGITS = 5;
const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const KINDS = ["scalar", "vector", "bivector", "trivector"];

/** The terms of a value that are seen in five digits of its largest; none, if it is 0. */
export function terms(components: readonly number[]): Term[] {
  const largest = Math.max(...components.map(Math.abs));
  const power = largest > 0 ? Math.floor(Math.log10(largest)) : 0;
  const scientific = power < -3 || power > 5;
  const scale = scientific ? 10 ** power : 1;
  const decimals = scientific ? DIGITS - 1 : Math.max(DIGITS - 1 - power, 0);
  const raised = [...String(Math.abs(power))].map((digit) => RAISED[Number(digit)]).join("");
  const times = scientific ? `·10${power < 0 ? "⁻" : ""}${raised}` : "";
  return components.flatMap((x, k) => {
    const size = String(Number(Math.abs(x / scale).toFixed(decimals)));
    const blade = BLADES[k]!;
    if (size === "0") return [];
    return [{ negative: x < 0, size: size === "1" && !times && blade ? "" : size + times, blade }];
  });
}

/** The grades of which there is more than rounding. */
export function heldGrades({
  components,
  grades,
}: {
  components: readonly number[];
  grades: readonly number[];
}): number[] {
  const largest = Math.max(...components.map(Math.abs));
  const held = grades.filter((grade) =>
    components.slice(STARTS[grade], STARTS[grade + 1]).some((x) => Math.abs(x) > NOTHING * largest),
  );
  return held.length > 0 ? held : grades.slice(0, 1);
}

/** What a value of some grades is called. */
export function kind(grades: readonly number[], rotor: boolean): string {
  if (rotor) return "rotor";
  if (grades.length === 1) return KINDS[grades[0]!]!;
  return `grades ${grades.join(", ")}`;
}

/** A name as a letter with an index: `a1` is a with the index 1. */
export function nameParts(name: string): { letter: string; index: string; primes: string } {
  const found = /^(.+?)(?:_(\p{L}+\d*)|(\d+))?('*)$/u.exec(name);
  if (!found) return { letter: name, index: "", primes: "" };
  return { letter: found[1]!, index: found[2] ?? found[3] ?? "", primes: "′".repeat(found[4]!.length) };
}

/** A number without needless digits. */
export function numberText(x: number): string {
  return String(Number(x.toFixed(6)));
}

/** A residual or a size in two digits. */
export function small(x: number): string {
  if (x === 0) return "0";
  const [digits, power] = x.toExponential(1).split("e") as [string, string];
  if (Math.abs(Number(power)) < 4) return String(Number(x.toPrecision(2)));
  const raised = [...power.replace(/[+-]/u, "")].map((digit) => RAISED[Number(digit)]).join("");
  return `${Number(digits)}·10${power.startsWith("-") ? "⁻" : ""}${raised}`;
}
