import type { Signal } from "@preact/signals";
import { scalarLiteral, vectorLiteral, withScalar, withVector } from "../algebra/literal.ts";
import type { Triple } from "../core/core.ts";
import { mayAutoplay } from "../presets/index.ts";

/** Duration in ms. */
const LASTS = 700;

/**
 * Changes numbers and vectors in lines of formulas steadily to those of other lines, unless the user prefers reduced
 * motion. It ends when anything else changes the lines.
 */
export function glide(lines: Signal<string>, target: string): void {
  const [from, to] = [lines.peek().split("\n"), target.split("\n")];
  if (!mayAutoplay() || from.length !== to.length) {
    lines.value = target;
    return;
  }
  const began = performance.now();
  let last = lines.peek();
  const step = (): void => {
    if (lines.peek() !== last) return;
    const part = Math.min((performance.now() - began) / LASTS, 1);
    const eased = part * part * (3 - 2 * part);
    last = part < 1 ? to.map((line, k) => between(from[k]!, line, eased)).join("\n") : target;
    lines.value = last;
    if (part < 1) requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

function between(from: string, to: string, part: number): string {
  const mixed = (a: number, b: number): number => a + (b - a) * part;
  const [a, b] = [scalarLiteral(from), scalarLiteral(to)];
  if (a && b && a.unit === b.unit) return withScalar(to, mixed(a.number, b.number));
  const [u, v] = [vectorLiteral(from), vectorLiteral(to)];
  return u && v ? withVector(to, u.components.map((x, k) => mixed(x, v.components[k]!)) as Triple) : to;
}
