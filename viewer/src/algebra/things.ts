import { Vector3 } from "three";
import type { Line, Triple } from "../core/core.ts";
import { vectorLiteral } from "./literal.ts";
import { heldGrades } from "./notation.ts";

/** How many colours there are for things. */
export const COLOURS = 6;

/** Characters of a formula that may be a label. */
const LONGEST = 8;

/** What is drawn of the value of a line. Bivectors are given by their axial vectors. */
export interface Thing {
  /** The number of its line, from 0. */
  line: number;
  /** Its name, or the formula, or where that is long the number of the line. */
  label: string;
  colour: number;
  vector: Vector3 | null;
  bivector: Vector3 | null;
  trivector: number | null;
  /** It turns by an angle from 0 to 2π about a unit axial vector; `turned` is what it turns in other lines. */
  rotor: { axis: Vector3; angle: number; turned: Vector3[] } | null;
  /** The vectors that sweep it out, two or three, if it is the wedge of such. */
  edges: Vector3[];
  /** Whether its components are literals. */
  movable: boolean;
}

/** What there is to draw, in the order of the lines. */
export function thingsOf(lines: readonly Line[]): Thing[] {
  const things: Thing[] = [];
  const named = new Map<string, Thing>();
  lines.forEach((line, number) => {
    const { value, name, shown } = line;
    // A bare name only shows again what is there.
    if (!value || shown === null || (name === null && named.has(shown))) return;
    const thing = drawn(line, number, things.length % COLOURS, named);
    if (!thing) return;
    things.push(thing);
    if (name !== null) named.set(name, thing);
  });
  for (const { shown } of lines) if (shown !== null) turn(shown, named);
  return things;
}

function drawn(line: Line, number: number, colour: number, named: Map<string, Thing>): Thing | null {
  const { components, rotor } = line.value!;
  const held = heldGrades(line.value!);
  const part = (grade: number, start: number) =>
    held.includes(grade) ? new Vector3(...(components.slice(start, start + 3) as Triple)) : null;
  const nonzero = (vector: Vector3 | null) => (vector && vector.length() > 0 ? vector : null);
  const thing: Thing = {
    line: number,
    label: line.name ?? (line.shown!.length <= LONGEST ? line.shown! : `(${number + 1})`),
    colour,
    vector: nonzero(part(1, 1)),
    bivector: rotor ? null : nonzero(part(2, 4)),
    trivector: held.includes(3) && components[7] !== 0 ? components[7]! : null,
    rotor: rotor ? turnOf(components) : null,
    edges: edges(line.shown!, named),
    movable: isMovable(line),
  };
  const seen = thing.vector ?? thing.bivector ?? thing.trivector ?? thing.rotor;
  return seen === null ? null : thing;
}

/** The turn of a rotor, cos(θ/2) − sin(θ/2) B. */
function turnOf(components: readonly number[]): Thing["rotor"] {
  const axis = new Vector3(-components[4]!, -components[5]!, -components[6]!);
  const size = axis.length();
  if (size < 1e-12) return null;
  return { axis: axis.divideScalar(size), angle: 2 * Math.atan2(size, components[0]!), turned: [] };
}

/** The vectors of a wedge of named vectors, or of bivectors that are wedges of such. */
function edges(shown: string, named: Map<string, Thing>): Vector3[] {
  const factors = shown.replace(/[()]/gu, "").split("∧");
  if (factors.length < 2) return [];
  const swept = factors.map((factor) => {
    const thing = named.get(factor);
    if (!thing) return null;
    return thing.edges.length > 0 ? thing.edges : thing.vector && !thing.bivector ? [thing.vector] : null;
  });
  const all = swept.flatMap((vectors) => vectors ?? []);
  return swept.includes(null) || all.length > 3 ? [] : all;
}

/** Tells rotors what they turn: `R a ~R`, on any side of an equation. */
function turn(shown: string, named: Map<string, Thing>): void {
  for (const side of shown.split(" = ")) {
    const found = /^(\S+) (\S+) ~\1$/u.exec(side);
    const rotor = found && named.get(found[1]!)?.rotor;
    const vector = found && named.get(found[2]!)?.vector;
    if (rotor && vector && !rotor.turned.includes(vector)) rotor.turned.push(vector);
  }
}

/** Whether a line gives a name a vector by literal components, which are also those of its value. */
function isMovable({ text, name, value }: Line): boolean {
  const literal = name !== null && value ? vectorLiteral(text) : null;
  return !!literal && literal.components.every((x, k) => Math.abs(x - value!.components[k + 1]!) < 1e-9);
}
