import { Vector3 } from "three";
import type { Screen } from "../stage/ribbon.ts";
import { across, arc, circle, ROUND } from "../stage/shapes.ts";
import { Blades } from "./blades.ts";
import type { Drawable } from "./drawables.ts";
import { drawShape, extentOf, type Scale } from "./objects.ts";

/** The point of a label, and the text of the label after the name. */
export interface Mark {
  at: Vector3;
  note: string;
  /** For a label on a rim: at the point farthest in a direction of the screen. */
  rim?: { axis: Vector3; radius: number };
}

/** The shapes and the label of an item, in drawn units: `unit` times the values. */
export interface Figure {
  item: Drawable;
  shapes: Blades;
  mark: Mark;
}

/** The radius of the arc of a turn, in drawn units. */
const TURN = 0.5;
const DASHED = { width: 1.3, opacity: 0.8, behind: 0.5, dash: 0.045 };

export function figureOf(
  item: Drawable,
  items: readonly Drawable[],
  screen: Screen,
  colour: string,
  scale: Scale,
): Figure {
  const { unit } = scale;
  const shapes = new Blades(screen, colour);
  let mark: Mark = { at: new Vector3(), note: "" };
  const scaled = (vector: Vector3) => vector.clone().multiplyScalar(unit);
  const [a, b, c] = item.edges.map(scaled);
  for (const shape of item.shapes) mark.at = drawShape(shapes, shape, scale);
  if (item.rotor) {
    const alone = !items.some((other) => other !== item && other.rotor && other.rotor.turned.length > 0);
    mark = turn(shapes, item.rotor, unit, alone);
  }
  if (item.trivector !== null) {
    if (a && b && c) {
      const base = (other: Drawable) =>
        other.bivector && other.edges.every((edge, k) => edge === item.edges[k]);
      shapes.parallelepiped(a, b, c, {
        base: !items.some((other) => other.edges.length === 2 && base(other)),
      });
      mark.at = a.clone().add(b).add(c);
    } else {
      mark.at = cube(shapes, item.trivector, unit);
    }
    if (item.trivector < 0) mark.note = "left-handed";
  }
  if (item.bivector) {
    if (a && b && !c) {
      shapes.parallelogram(a, b);
      mark.at = a.clone().add(b);
    } else {
      const radius = discRadius(item.bivector) * unit;
      shapes.disc(item.bivector, radius);
      mark.rim = { axis: item.bivector, radius };
    }
  }
  if (item.vector) {
    shapes.arrow(scaled(item.vector), { width: 2.8, behind: 0.35, order: 4 });
    mark = { at: scaled(item.vector), note: mark.note };
  }
  return { item, shapes, mark };
}

/** Points that must be in view, in the units of the values. */
export function extent(item: Drawable): Vector3[] {
  const points = [new Vector3()];
  points.push(...item.shapes.flatMap(extentOf));
  if (item.vector) points.push(item.vector);
  const [a, b, c] = item.edges;
  if (a && b) points.push(a, b, a.clone().add(b));
  if (a && b && c) points.push(c, ...[a, b, a.clone().add(b)].map((point) => point.clone().add(c)));
  if (item.bivector && !b) {
    const rim = circle(item.bivector, discRadius(item.bivector));
    points.push(...rim.filter((_, k) => k % (ROUND / 4) === 0));
  }
  if (item.trivector !== null && !c) {
    const half = Math.cbrt(Math.abs(item.trivector)) / 2;
    points.push(new Vector3(half, half, half), new Vector3(-half, -half, -half));
  }
  for (const vector of item.rotor?.turned ?? []) {
    points.push(vector, vector.clone().applyAxisAngle(item.rotor!.axis, item.rotor!.angle));
  }
  return points;
}

/** The area of the disc is the norm of the bivector. */
function discRadius(bivector: Vector3): number {
  return Math.sqrt(bivector.length() / Math.PI);
}

/** The angle of a rotor in its plane, and the arcs of the vectors that it turns; if `alone`, with their projections. */
function turn(
  shapes: Blades,
  { axis, angle, turned }: NonNullable<Drawable["rotor"]>,
  unit: number,
  alone: boolean,
): Mark {
  const starts = turned.map((vector) => vector.clone().multiplyScalar(unit));
  for (const from of starts) {
    shapes.line(arc(axis, from, angle), DASHED);
    if (alone) projections(shapes, axis, from, angle);
  }
  const inPlane = starts
    .map((from) => from.clone().projectOnPlane(axis))
    .find((part) => part.length() > 0.15);
  const radius = inPlane ? Math.min(TURN, 0.62 * inPlane.length()) : TURN;
  const start = (inPlane ?? across(axis)).clone().setLength(radius);
  shapes.sector(axis, start, angle);
  if (!inPlane) shapes.line(arc(axis, start, 2 * Math.PI), DASHED);
  const middle = start.clone().applyAxisAngle(axis, angle / 2);
  return { at: middle, note: `${Number(((angle * 180) / Math.PI).toFixed(1))}°` };
}

/** The projection of a vector on the plane of a turn, before and after. */
function projections(shapes: Blades, axis: Vector3, from: Vector3, angle: number): void {
  const to = from.clone().applyAxisAngle(axis, angle);
  for (const tip of [from, to]) {
    const inPlane = tip.clone().projectOnPlane(axis);
    const high = tip.distanceTo(inPlane) > 0.05;
    if (inPlane.length() > 0.05 && high) {
      shapes.line([new Vector3(), inPlane], { width: 1.2, opacity: 0.7, behind: 0.5 });
      shapes.line([inPlane, tip], DASHED);
    }
  }
}

/** A cube with the volume of a trivector; the rim of its base and then its height give the orientation. */
function cube(shapes: Blades, trivector: number, unit: number): Vector3 {
  const side = Math.cbrt(Math.abs(trivector)) * unit;
  const [x, y, z] = [0, 1, 2].map((k) => new Vector3().setComponent(k, side)) as [Vector3, Vector3, Vector3];
  const corner = new Vector3(-side / 2, -side / 2, -side / 2);
  if (trivector > 0) shapes.parallelepiped(x, y, z, { from: corner });
  else shapes.parallelepiped(y, x, z, { from: corner });
  return new Vector3(side / 2, side / 2, side / 2);
}
