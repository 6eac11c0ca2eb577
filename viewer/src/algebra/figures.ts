import { Vector3 } from "three";
import type { Screen } from "../stage/ribbon.ts";
import { across, arc, Shapes } from "./shapes.ts";
import type { Thing } from "./things.ts";

/** A point that has a label, and what the label says besides the name. */
export interface Mark {
  at: Vector3;
  says: string;
  /** Where on the screen it stands, for a rim: of all points that which is farthest to there. */
  rim?: { axis: Vector3; radius: number };
}

/** A thing as it is drawn: its shapes and where it is named. Drawn units are `unit` times those of the values. */
export interface Drawn {
  thing: Thing;
  shapes: Shapes;
  mark: Mark;
}

/** The radius of the arc of a turn, in drawn units. */
const TURN = 0.5;
const DASHED = { width: 1.3, opacity: 0.8, behind: 0.5, dash: 0.045 };

export function drawnOf(
  thing: Thing,
  things: readonly Thing[],
  screen: Screen,
  colour: string,
  unit: number,
): Drawn {
  const shapes = new Shapes(screen, colour);
  let mark: Mark = { at: new Vector3(), says: "" };
  const scaled = (vector: Vector3) => vector.clone().multiplyScalar(unit);
  const [a, b, c] = thing.edges.map(scaled);
  if (thing.rotor) {
    const alone = !things.some((other) => other !== thing && other.rotor && other.rotor.turned.length > 0);
    mark = turn(shapes, thing.rotor, unit, alone);
  }
  if (thing.trivector !== null) {
    if (a && b && c) {
      const base = (other: Thing) =>
        other.bivector && other.edges.every((edge, k) => edge === thing.edges[k]);
      shapes.parallelepiped(a, b, c, {
        base: !things.some((other) => other.edges.length === 2 && base(other)),
      });
      mark.at = a.clone().add(b).add(c);
    } else {
      mark.at = cube(shapes, thing.trivector, unit);
    }
    if (thing.trivector < 0) mark.says = "left-handed";
  }
  if (thing.bivector) {
    if (a && b && !c) {
      shapes.parallelogram(a, b);
      mark.at = a.clone().add(b);
    } else {
      const radius = discRadius(thing.bivector) * unit;
      shapes.disc(thing.bivector, radius);
      mark.rim = { axis: thing.bivector, radius };
    }
  }
  if (thing.vector) {
    shapes.arrow(scaled(thing.vector));
    mark = { at: scaled(thing.vector), says: mark.says };
  }
  return { thing, shapes, mark };
}

/** Points that have to be in view, in the units of the values. */
export function extent(thing: Thing): Vector3[] {
  const points = [new Vector3()];
  if (thing.vector) points.push(thing.vector);
  const [a, b, c] = thing.edges;
  if (a && b) points.push(a, b, a.clone().add(b));
  if (a && b && c) points.push(c, ...[a, b, a.clone().add(b)].map((point) => point.clone().add(c)));
  if (thing.bivector && !b) {
    const radius = discRadius(thing.bivector);
    const right = across(thing.bivector).multiplyScalar(radius);
    const up = thing.bivector.clone().normalize().cross(right);
    points.push(right, up, right.clone().negate(), up.clone().negate());
  }
  if (thing.trivector !== null && !c) {
    const half = Math.cbrt(Math.abs(thing.trivector)) / 2;
    points.push(new Vector3(half, half, half), new Vector3(-half, -half, -half));
  }
  for (const vector of thing.rotor?.turned ?? []) {
    points.push(vector, vector.clone().applyAxisAngle(thing.rotor!.axis, thing.rotor!.angle));
  }
  return points;
}

/** The area of the disc is the size of the bivector. */
function discRadius(bivector: Vector3): number {
  return Math.sqrt(bivector.length() / Math.PI);
}

/** The plane of a rotor, the angle in it, and the way of what is turned, if it is alone with what it leaves in the plane. */
function turn(
  shapes: Shapes,
  { axis, angle, turned }: NonNullable<Thing["rotor"]>,
  unit: number,
  alone: boolean,
): Mark {
  const ways = turned.map((vector) => vector.clone().multiplyScalar(unit));
  for (const from of ways) {
    shapes.line(arc(axis, from, angle), DASHED);
    if (alone) shadows(shapes, axis, from, angle);
  }
  const inPlane = ways.map((way) => way.clone().projectOnPlane(axis)).find((way) => way.length() > 0.15);
  const radius = inPlane ? Math.min(TURN, 0.62 * inPlane.length()) : TURN;
  const start = (inPlane ?? across(axis)).clone().setLength(radius);
  shapes.sector(axis, start, angle);
  if (!inPlane) shapes.line(arc(axis, start, 2 * Math.PI), DASHED);
  const middle = start.clone().applyAxisAngle(axis, angle / 2);
  return { at: middle, says: `${Number(((angle * 180) / Math.PI).toFixed(1))}°` };
}

/** What of a vector lies in the plane of a turn, before and after. */
function shadows(shapes: Shapes, axis: Vector3, from: Vector3, angle: number): void {
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

/** A cube of the volume of a trivector: the rim of its base and then its height give its sense. */
function cube(shapes: Shapes, trivector: number, unit: number): Vector3 {
  const side = Math.cbrt(Math.abs(trivector)) * unit;
  const [x, y, z] = [0, 1, 2].map((k) => new Vector3().setComponent(k, side)) as [Vector3, Vector3, Vector3];
  const corner = new Vector3(-side / 2, -side / 2, -side / 2);
  if (trivector > 0) shapes.parallelepiped(x, y, z, { from: corner });
  else shapes.parallelepiped(y, x, z, { from: corner });
  return new Vector3(side / 2, side / 2, side / 2);
}
