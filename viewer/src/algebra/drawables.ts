import { Vector3 } from "three";
import type { Line, Quadruple, Triple } from "../core/core.ts";
import type { Core } from "../core/wasm.ts";
import type { GivenValue, Shape } from "../document.ts";
import { vectorLiteral } from "./literal.ts";
import { nonzeroGrades } from "./notation.ts";

/** Number of colours. */
const COLOURS = 8;

/** A formula with at most this many characters is its own label. */
const LONGEST = 8;

/** The parts of the value of a line that are drawn. Bivectors are given by their axial vectors. */
export interface Drawable {
  /** The number of its line, from 0; null for a given value. */
  line: number | null;
  /** The name, or the formula, or the number of the line if the formula is long. */
  label: string;
  colour: number;
  vector: Vector3 | null;
  bivector: Vector3 | null;
  trivector: number | null;
  /** A rotation by an angle from 0 to 2π about a unit axial vector; `turned` are the vectors that other lines turn. */
  rotor: { axis: Vector3; angle: number; turned: Vector3[] } | null;
  /** The two or three vectors of which it is the wedge product, if it is one. */
  edges: Vector3[];
  /** What is drawn of a given value. */
  shapes: readonly Shape[];
  /** Whether its components are literals in the text. */
  movable: boolean;
}

/** The drawables of lines, in their order. */
export function drawablesOf(lines: readonly Line[], core: Core): Drawable[] {
  const items: Drawable[] = [];
  const named = new Map<string, Drawable>();
  lines.forEach((line, number) => {
    const { value, name, shown } = line;
    // A bare name shows a value that is already drawn.
    if (!value || shown === null || (name === null && named.has(shown))) return;
    const item = drawableOf(line, number, items.length % COLOURS, named, core);
    if (!item) return;
    items.push(item);
    if (name !== null) named.set(name, item);
  });
  for (const { shown } of lines) if (shown !== null) recordTurned(shown, named);
  return items;
}

/** The drawable of a given value, with the next colour after `before` others. */
export function drawableOfGiven({ name, shapes }: GivenValue, before: number): Drawable {
  const nothing = { vector: null, bivector: null, trivector: null, rotor: null, edges: [], movable: false };
  return { ...nothing, line: null, label: name, colour: before % COLOURS, shapes };
}

function drawableOf(
  line: Line,
  number: number,
  colour: number,
  named: Map<string, Drawable>,
  core: Core,
): Drawable | null {
  const { components, rotor } = line.value!;
  const grades = nonzeroGrades(line.value!);
  const part = (grade: number, start: number) =>
    grades.includes(grade) ? new Vector3(...(components.slice(start, start + 3) as Triple)) : null;
  const nonzero = (vector: Vector3 | null) => (vector && vector.length() > 0 ? vector : null);
  const item: Drawable = {
    line: number,
    label: line.name ?? (line.shown!.length <= LONGEST ? line.shown! : `(${number + 1})`),
    colour,
    vector: nonzero(part(1, 1)),
    bivector: rotor ? null : nonzero(part(2, 4)),
    trivector: grades.includes(3) && components[7] !== 0 ? components[7]! : null,
    rotor: rotor ? turnOf(components, core) : null,
    edges: edges(line.shown!, named),
    shapes: [],
    movable: isMovable(line),
  };
  const visible = item.vector ?? item.bivector ?? item.trivector ?? item.rotor;
  return visible === null ? null : item;
}

/** The rotation of a rotor; null for the rotors 1 and −1, up to rounding. */
function turnOf([scalar, , , , ...bivector]: readonly number[], core: Core): Drawable["rotor"] {
  const rotor = [scalar, ...bivector.slice(0, 3)] as Quadruple;
  if (Math.hypot(...rotor.slice(1)) < 1e-12) return null;
  const { plane, angle } = core.planeAngle(rotor);
  return { axis: new Vector3(...plane), angle, turned: [] };
}

/** The vectors of a wedge product of named vectors, or of bivectors that are wedge products of such. */
function edges(shown: string, named: Map<string, Drawable>): Vector3[] {
  const factors = shown.replace(/[()]/gu, "").split("∧");
  if (factors.length < 2) return [];
  const swept = factors.map((factor) => {
    const item = named.get(factor);
    if (!item) return null;
    return item.edges.length > 0 ? item.edges : item.vector && !item.bivector ? [item.vector] : null;
  });
  const all = swept.flatMap((vectors) => vectors ?? []);
  return swept.includes(null) || all.length > 3 ? [] : all;
}

/** Records in a rotor the vectors that it turns: `R a ~R`, on either side of an equation. */
function recordTurned(shown: string, named: Map<string, Drawable>): void {
  for (const side of shown.split(" = ")) {
    const found = /^(\S+) (\S+) ~\1$/u.exec(side);
    const rotor = found && named.get(found[1]!)?.rotor;
    const vector = found && named.get(found[2]!)?.vector;
    if (rotor && vector && !rotor.turned.includes(vector)) rotor.turned.push(vector);
  }
}

/** Whether a line defines a vector by literal components that are those of its value. */
function isMovable({ text, name, value }: Line): boolean {
  const literal = name !== null && value ? vectorLiteral(text) : null;
  return !!literal && literal.components.every((x, k) => Math.abs(x - value!.components[k + 1]!) < 1e-9);
}
