import { Vector3 } from "three";
import type { Shape } from "../document.ts";
import { across, circle, ROUND } from "../stage/shapes.ts";
import type { Blades } from "./blades.ts";

/** Points, lines, planes, spheres, circles and screws of projective and conformal geometry. */

/** Half the drawn length of a line, half the side of a plane, and radii of a point and of a turn, in drawn units. */
const LINE = 1.6;
const PLANE = 1.1;
const POINT = 0.035;
const TURN = 0.4;
const THIN = { width: 1.2, opacity: 0.6, behind: 0.3 };
const DASHED = { width: 1.4, opacity: 0.8, behind: 0.5, dash: 0.045 };

/** The picture in which shapes are drawn: drawn units per 1, and its centre. */
export interface Scale {
  unit: number;
  middle: Vector3;
}

/** Draws a shape, and returns the place of its label. */
export function drawShape(shapes: Blades, shape: Shape, { unit, middle }: Scale): Vector3 {
  const scaled = (numbers: readonly number[]) => new Vector3().fromArray(numbers).multiplyScalar(unit);
  switch (shape.kind) {
    case "point": {
      const at = scaled(shape.at);
      shapes.ball(at, POINT);
      return at;
    }
    case "direction": {
      const to = new Vector3().fromArray(shape.along);
      shapes.arrow(to, { width: 2.4, behind: 0.35, dash: 0.045 });
      return to;
    }
    case "line": {
      const along = new Vector3().fromArray(shape.along);
      const foot = footOnLine(scaled(shape.at), along, middle);
      const end = (side: number) => foot.clone().addScaledVector(along, side * LINE);
      shapes.line([end(-1), end(1)], { width: 2.2, behind: 0.35 });
      shapes.head(end(0.5), along);
      return end(0.75);
    }
    case "plane": {
      const normal = new Vector3().fromArray(shape.normal);
      const foot = middle.clone().sub(middle.clone().sub(scaled(shape.at)).projectOnVector(normal));
      const side = across(normal).multiplyScalar(2 * PLANE);
      const other = normal.clone().cross(side);
      const corner = foot.clone().addScaledVector(side, -0.5).addScaledVector(other, -0.5);
      shapes.parallelogram(side, other, corner, 0.13);
      return corner.add(side).add(other);
    }
    case "sphere": {
      const [at, radius] = [scaled(shape.at), shape.radius * unit];
      shapes.ball(at, radius, 0.14);
      for (const axis of [0, 1, 2]) {
        const rim = circle(new Vector3().setComponent(axis, 1), radius).map((point) => point.add(at));
        shapes.line(rim, THIN, true);
      }
      return at.clone().add(new Vector3(0, 0, radius));
    }
    case "circle": {
      const around = shapes.at(scaled(shape.at));
      const rim = new Vector3().fromArray(shape.normal);
      around.disc(rim, shape.radius * unit);
      return circle(rim, shape.radius * unit)[ROUND / 8]!.add(scaled(shape.at));
    }
    case "screw": {
      const along = new Vector3().fromArray(shape.along);
      const foot = footOnLine(scaled(shape.at), along, middle);
      const end = (side: number) => foot.clone().addScaledVector(along, side * LINE);
      shapes.line([end(-1), end(1)], DASHED);
      const around = shapes.at(foot);
      const start = across(along).multiplyScalar(TURN);
      if (shape.angle > 0) around.sector(along, start, shape.angle);
      if (shape.shift !== 0) around.arrow(along.clone().multiplyScalar(shape.shift * unit), { width: 2.8 });
      return start.applyAxisAngle(along, shape.angle / 2).add(foot);
    }
  }
}

/** The points of a shape that must be in view. */
export function extentOf(shape: Shape): Vector3[] {
  const vector = (numbers: readonly number[]) => new Vector3().fromArray(numbers);
  switch (shape.kind) {
    case "direction":
      return [vector(shape.along)];
    case "sphere":
      return [0, 1, 2].flatMap((axis) =>
        [-1, 1].map((side) => vector(shape.at).add(new Vector3().setComponent(axis, side * shape.radius))),
      );
    case "circle":
      return circle(vector(shape.normal), shape.radius)
        .filter((_, k) => k % (ROUND / 8) === 0)
        .map((point) => point.add(vector(shape.at)));
    case "screw":
      return [vector(shape.at), vector(shape.at).addScaledVector(vector(shape.along), shape.shift)];
    default:
      return [vector(shape.at)];
  }
}

/** The point of a line that is nearest to the middle of the picture. */
function footOnLine(at: Vector3, along: Vector3, middle: Vector3): Vector3 {
  return at.clone().add(middle.clone().sub(at).projectOnVector(along));
}
