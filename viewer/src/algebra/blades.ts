import { Vector3 } from "three";
import { arc, circle, HEAD, ROUND, Shapes } from "../stage/shapes.ts";

/** Pieces of planes, volumes and turns of one colour. */
export class Blades extends Shapes {
  /** Shapes of the same colour around another origin. */
  at(origin: Vector3): Blades {
    const moved = new Blades(this.screen, this.colour);
    moved.object.position.copy(origin);
    this.object.add(moved.object);
    return moved;
  }

  /** The parallelogram a∧b, whose rim runs along `a` first. */
  parallelogram(a: Vector3, b: Vector3, from = new Vector3(), opacity = 0.16): void {
    const corners = [from, from.clone().add(a), from.clone().add(a).add(b), from.clone().add(b)];
    this.face(corners, opacity);
    this.line(corners, { width: 1.8, behind: 0.3 }, true);
    corners.forEach((corner, k) => {
      const along = corners[(k + 1) % 4]!.clone().sub(corner);
      if (along.length() > 0.25) this.head(corner.clone().addScaledVector(along, 0.5), along);
    });
  }

  /** The parallelepiped a∧b∧c, with the parallelogram a∧b as its base. */
  parallelepiped(
    a: Vector3,
    b: Vector3,
    c: Vector3,
    { from = new Vector3(), base: seen = true }: { from?: Vector3; base?: boolean },
  ): void {
    if (seen) this.parallelogram(a, b, from, 0.1);
    const corner = (...edges: Vector3[]) => edges.reduce((sum, edge) => sum.add(edge), from.clone());
    const top = [corner(c), corner(a, c), corner(a, b, c), corner(b, c)];
    const base = [corner(), corner(a), corner(a, b), corner(b)];
    this.face(top, 0.12);
    this.line(top, { width: 1.6, behind: 0.3 }, true);
    base.forEach((low, k) => {
      this.line([low, top[k]!], { width: 1.6, behind: 0.3 });
      this.face([low, base[(k + 1) % 4]!, top[(k + 1) % 4]!, top[k]!], 0.07);
      this.head(low.clone().lerp(top[k]!, 0.5), c);
    });
  }

  /** A disc around the origin; its rim runs right-handed around the axis. */
  disc(axis: Vector3, radius: number): void {
    const points = circle(axis, radius);
    this.face(points, 0.14);
    this.line(points, { width: 2, behind: 0.3 }, true);
    for (let k = 0; k < 3; k++) {
      const at = points[Math.round((ROUND * (k + 0.25)) / 3)]!;
      this.head(at, axis.clone().cross(at));
    }
  }

  /** The sector of a rotation from a direction on, with an arrowhead at the end of its arc. */
  sector(axis: Vector3, from: Vector3, angle: number): void {
    const points = arc(axis, from, angle);
    this.face([new Vector3(), ...points], 0.16);
    // The arc ends at the base of the head.
    const short = arc(axis, from, Math.max(angle - (0.75 * HEAD) / from.length(), angle / 2));
    this.line(short, { width: 2.4, behind: 0.4 });
    const end = points[points.length - 1]!;
    const along = axis.clone().cross(end);
    this.head(end.clone().addScaledVector(along.clone().normalize(), -HEAD / 2), along);
  }
}
