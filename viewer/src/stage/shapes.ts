import {
  BufferGeometry,
  type ColorRepresentation,
  ConeGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import { Ribbon, type RibbonStyle, type Screen } from "./ribbon.ts";
import { AXES } from "./rotor.ts";

/** The length of an arrowhead. */
export const HEAD = 0.1;
/** Points per full turn. */
export const ROUND = 96;

/** Lines, faces and arrows of one colour. */
export class Shapes {
  readonly object = new Group();
  private readonly solid: MeshLambertMaterial;

  constructor(
    protected readonly screen: Screen,
    protected readonly colour: ColorRepresentation,
  ) {
    this.solid = new MeshLambertMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.45 });
  }

  line(points: readonly Vector3[], style: RibbonStyle, closed = false): Ribbon {
    const ribbon = new Ribbon(this.screen, this.colour, style);
    ribbon.set(points, { closed });
    this.object.add(ribbon.object);
    return ribbon;
  }

  /** A polygon that is convex, or all of which is seen from its first point. */
  face(points: readonly Vector3[], opacity: number, order = 1): void {
    const geometry = new BufferGeometry();
    geometry.setFromPoints([...points]);
    geometry.setIndex(points.slice(2).flatMap((_, k) => [0, k + 1, k + 2]));
    const material = new MeshBasicMaterial({
      color: this.colour,
      transparent: true,
      opacity,
      side: DoubleSide,
      depthWrite: false,
      forceSinglePass: true,
    });
    const mesh = new Mesh(geometry, material);
    mesh.renderOrder = order;
    this.object.add(mesh);
  }

  /** A ball around a point; with an opacity, one that is seen through. */
  ball(at: Vector3, radius: number, opacity?: number): void {
    const { colour: color } = this;
    const clear = { color, transparent: true, opacity: opacity ?? 1, depthWrite: false };
    const material = opacity === undefined ? this.solid : new MeshBasicMaterial(clear);
    const mesh = new Mesh(new SphereGeometry(radius, 48, 32), material);
    mesh.position.copy(at);
    this.object.add(mesh);
  }

  /** An arrowhead at a point. */
  head(at: Vector3, along: Vector3): Mesh {
    const cone = new ConeGeometry(0.28 * HEAD, HEAD, 16).rotateX(Math.PI / 2);
    const head = new Mesh(cone, this.solid);
    aim(head, at, along);
    this.object.add(head);
    return head;
  }

  /** An arrow from the origin of the object. */
  arrow(to: Vector3, style: RibbonStyle): Arrow {
    const arrow = new Arrow(this.line([], style), this.head(to, to));
    arrow.point(to);
    return arrow;
  }
}

/** Moves an arrowhead to a point. */
export function aim(head: Mesh, at: Vector3, along: Vector3): void {
  head.position.copy(at);
  head.quaternion.setFromUnitVectors(AXES[2], along.clone().normalize());
}

/** A line of constant width in pixels, with a cone at its end. */
export class Arrow {
  constructor(
    private readonly shaft: Ribbon,
    private readonly head: Mesh,
  ) {}

  /** Sets the end. An arrow that is shorter than its head is not drawn. */
  point(to: Vector3): void {
    const length = to.length();
    this.shaft.object.visible = this.head.visible = length > HEAD;
    if (length <= HEAD) return;
    this.shaft.set([new Vector3(), to.clone().multiplyScalar(1 - HEAD / length)]);
    aim(this.head, to.clone().multiplyScalar(1 - HEAD / 2 / length), to);
  }
}

/** Points of the arc of a point that turns right-handed around an axis through the origin. */
export function arc(axis: Vector3, from: Vector3, angle: number): Vector3[] {
  const unit = axis.clone().normalize();
  const count = Math.max(2, Math.ceil((ROUND * angle) / (2 * Math.PI)));
  return Array.from({ length: count + 1 }, (_, k) => from.clone().applyAxisAngle(unit, (angle * k) / count));
}

/** Points of the circle around an axis through the origin. */
export function circle(axis: Vector3, radius: number): Vector3[] {
  return arc(axis, across(axis).multiplyScalar(radius), 2 * Math.PI).slice(0, -1);
}

/** A unit vector perpendicular to an axis, in the plane of e1 and e2 if possible. */
export function across(axis: Vector3): Vector3 {
  const level = AXES[2].clone().cross(axis);
  return (level.length() > 1e-6 * axis.length() ? level : AXES[0].clone()).normalize();
}
