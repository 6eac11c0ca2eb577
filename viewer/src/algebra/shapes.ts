import {
  BufferAttribute,
  BufferGeometry,
  ConeGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Vector3,
} from "three";
import { Arrow } from "../stage/arrow.ts";
import { Ribbon, type RibbonStyle, type Screen } from "../stage/ribbon.ts";
import { AXES } from "../stage/rotor.ts";

const HEAD = new ConeGeometry(0.026, 0.09, 20).translate(0, -0.045, 0).rotateX(Math.PI / 2);
/** Points per full turn. */
const ROUND = 96;

/** Lines, faces and arrowheads of one colour; new ones are created for each change. */
export class Shapes {
  readonly object = new Group();
  private readonly resources: { dispose(): void }[] = [];
  private readonly solid: MeshLambertMaterial;

  constructor(
    private readonly screen: Screen,
    private readonly colour: string,
  ) {
    this.solid = new MeshLambertMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.45 });
    this.resources.push(this.solid);
  }

  dispose(): void {
    for (const resource of this.resources) resource.dispose();
  }

  arrow(to: Vector3, style: RibbonStyle = { width: 2.8, behind: 0.35, order: 4 }, from?: Vector3): void {
    const arrow = new Arrow(this.screen, style);
    arrow.point(to);
    arrow.paint(this.colour);
    if (from) arrow.object.position.copy(from);
    this.add(arrow);
  }

  line(points: readonly Vector3[], style: RibbonStyle, closed = false): void {
    const ribbon = new Ribbon(this.screen, style);
    ribbon.set(
      points.flatMap((point) => point.toArray()),
      { closed },
    );
    ribbon.paint(this.colour);
    this.add(ribbon);
  }

  /** A convex polygon. */
  face(points: readonly Vector3[], opacity: number): void {
    const geometry = new BufferGeometry();
    const corners = points.flatMap((point) => point.toArray());
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
    geometry.setIndex(points.slice(2).flatMap((_, k) => [0, k + 1, k + 2]));
    const material = new MeshBasicMaterial({
      color: this.colour,
      transparent: true,
      opacity,
      side: DoubleSide,
      depthWrite: false,
    });
    const mesh = new Mesh(geometry, material);
    mesh.renderOrder = 1;
    this.object.add(mesh);
    this.resources.push(geometry, material);
  }

  /** An arrowhead at a point. */
  head(at: Vector3, along: Vector3, size = 1): void {
    const direction = along.clone().normalize();
    const head = new Mesh(HEAD, this.solid);
    head.position.copy(at).addScaledVector(direction, 0.045 * size);
    head.quaternion.setFromUnitVectors(AXES[2], direction);
    head.scale.setScalar(size);
    this.object.add(head);
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
    const points = arc(axis, across(axis).multiplyScalar(radius), 2 * Math.PI);
    this.face(points.slice(0, -1), 0.14);
    this.line(points.slice(0, -1), { width: 2, behind: 0.3 }, true);
    for (let k = 0; k < 3; k++) {
      const at = points[Math.round((ROUND * (k + 0.25)) / 3)]!;
      this.head(at, axis.clone().cross(at));
    }
  }

  /** The sector of a rotation from a direction on, with an arrowhead at the end of its arc. */
  sector(axis: Vector3, from: Vector3, angle: number): void {
    const points = arc(axis, from, angle);
    const origin = new Vector3();
    for (let k = 1; k < points.length; k++) this.face([origin, points[k - 1]!, points[k]!], 0.16);
    // The arc ends at the base of the head.
    const short = arc(axis, from, Math.max(angle - 0.07 / from.length(), angle / 2));
    this.line(short, { width: 2.4, behind: 0.4 });
    const end = points[points.length - 1]!;
    this.head(
      end.clone().addScaledVector(axis.clone().cross(end).normalize(), -0.045),
      axis.clone().cross(end),
    );
  }

  private add(shape: { object: Group; dispose(): void }): void {
    this.object.add(shape.object);
    this.resources.push(shape);
  }
}

/** Points of the arc of a point that turns right-handed around an axis through the origin. */
export function arc(axis: Vector3, from: Vector3, angle: number): Vector3[] {
  const unit = axis.clone().normalize();
  const count = Math.max(2, Math.ceil((ROUND * angle) / (2 * Math.PI)));
  return Array.from({ length: count + 1 }, (_, k) => from.clone().applyAxisAngle(unit, (angle * k) / count));
}

/** A unit vector perpendicular to an axis, in the plane of e1 and e2 if possible. */
export function across(axis: Vector3): Vector3 {
  const level = AXES[2].clone().cross(axis);
  return (level.length() > 1e-6 * axis.length() ? level : AXES[0].clone()).normalize();
}
