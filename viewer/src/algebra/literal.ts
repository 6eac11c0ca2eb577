import type { Triple } from "../core/core.ts";
import { numberText } from "./notation.ts";

/** Literal numbers in the text of a line, which handles and sliders change. */

const NUMBER = String.raw`(?:\d+(?:\.\d*)?|\.\d+)`;
const TERM = String.raw`(?:${NUMBER}\s*\*?\s*)?e_?[123₁₂₃]`;
const UNIT = String.raw`(?:[\p{L}°](?:[\p{L}°/*·²³⁻¹ ]|\^-?\d)*)?`;
const VECTOR = new RegExp(
  String.raw`^(\s*[^=#(]+=\s*)([+\-−]?\s*${TERM}(?:\s*[+\-−]\s*${TERM})*)(\s*(?:#.*)?)$`,
  "u",
);
const SCALAR = new RegExp(String.raw`^(\s*[^=#(]+=\s*)([\-−]?\s*${NUMBER})(\s*${UNIT})(\s*(?:#.*)?)$`, "u");

/** The parts of a line such as `a = 2 e1 + e2`; null if its components are not literals. */
export function vectorLiteral(text: string): { head: string; components: Triple; tail: string } | null {
  const found = VECTOR.exec(text);
  if (!found) return null;
  const components: Triple = [0, 0, 0];
  for (const [, sign, number, axis] of found[2]!.matchAll(
    new RegExp(String.raw`([+\-−]?)\s*(${NUMBER})?\s*\*?\s*e_?([123₁₂₃])`, "gu"),
  )) {
    const k = "123₁₂₃".indexOf(axis!) % 3;
    components[k]! += (sign === "" || sign === "+" ? 1 : -1) * (number === undefined ? 1 : Number(number));
  }
  return { head: found[1]!, components, tail: found[3]! };
}

/** The line with other components, rounded to two decimals. */
export function withVector(text: string, components: Triple): string {
  const literal = vectorLiteral(text);
  if (!literal) return text;
  let body = "";
  components.forEach((x, k) => {
    const size = numberText(Math.abs(Math.round(x * 100) / 100));
    if (size === "0") return;
    const sign = x < 0 ? (body ? " - " : "-") : body ? " + " : "";
    body += `${sign}${size === "1" ? "" : `${size} `}e${k + 1}`;
  });
  return literal.head + (body || "0 e1") + literal.tail;
}

/** The number and the unit of a line such as `θ = 60 deg`; null if the number is not a literal. */
export function scalarLiteral(
  text: string,
): { head: string; number: number; unit: string; tail: string } | null {
  const found = SCALAR.exec(text);
  if (!found) return null;
  const number = Number(found[2]!.replace("−", "-").replace(/\s/gu, ""));
  return { head: found[1]!, number, unit: found[3]!, tail: found[4]! };
}

/** The line with another number in the same unit. */
export function withScalar(text: string, number: number): string {
  const literal = scalarLiteral(text);
  return literal ? literal.head + numberText(number) + literal.unit + literal.tail : text;
}

/** The text without its literals: it identifies a preset after handles and sliders have changed it. */
export function outline(text: string): string {
  const lines = text.split("\n").map((line) => {
    const literal = vectorLiteral(line) ?? scalarLiteral(line);
    return literal ? `${literal.head}…${literal.tail}` : line;
  });
  return lines.join("\n");
}
