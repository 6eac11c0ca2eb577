import {
  BufferAttribute,
  type BufferGeometry,
  Color,
  Group,
  Matrix3,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  Vector3,
} from "three";
import type { Surface } from "../core/core.ts";
import { floorOf } from "./floor.ts";
import type { Part, Setting } from "./part.ts";
import { AXES } from "./rotor.ts";

/** The radius of the floor that is seen, and its opacity: on a dark ground, shadows are seen on a lighter floor alone. */
const FLOOR = 1.3;
const ON_LIGHT = 0.2;
const ON_DARK = 0.5;
const DARK = 0.55;
/** Extent of a shadow in standard deviations of the surface. */
const EXTENT = 2.6;

/** A soft shadow of a top on the floor under its stand: an ellipse like the outline of the body from above. */
export function shadow({ figure, palette }: Setting): Part | null {
  const floor = floorOf(figure);
  if (floor === null) return null;
  const night = new Color(palette.background).getHSL({ h: 0, s: 0, l: 0 }).l < 0.5;
  const ground = spot(palette.faint, (r) => (night ? ON_DARK : ON_LIGHT) * (1 - r * r) ** 2);
  ground.scale.setScalar(FLOOR);
  const shade = spot(
    "#000000",
    (r) => (night ? 1 : DARK) * Math.max(0, Math.exp(-((EXTENT * r) ** 2) / 2) - 0.034),
  );
  const foot = shade.clone();
  foot.scale.setScalar(0.3);
  const { mean, spread } = moments(figure.surface);
  const inSpace = new Group().add(ground, foot, shade);
  inSpace.position.z = floor;
  return {
    inSpace,
    update({ attitude }, shown) {
      inSpace.visible = shown.gravity;
      shade.visible = shown.body;
      const across = [AXES[0], AXES[1]].map((axis) =>
        axis.clone().applyQuaternion(attitude.clone().invert()),
      );
      const [u, v] = across as [Vector3, Vector3];
      const along = (a: Vector3, b: Vector3) => a.dot(b.clone().applyMatrix3(spread));
      const [xx, xy, yy] = [along(u, u), along(u, v), along(v, v)];
      const half = Math.hypot((xx - yy) / 2, xy);
      const size = (part: number) => EXTENT * Math.sqrt(Math.max((xx + yy) / 2 + part, 1e-4));
      shade.position.set(mean.dot(u), mean.dot(v), 0);
      shade.rotation.z = Math.atan2(2 * xy, xx - yy) / 2;
      shade.scale.set(size(half), size(-half), 1);
    },
  };
}

/** A disc whose opacity depends on the distance from its middle, from 0 to 1. */
function spot(colour: string, opacity: (radius: number) => number): Mesh {
  const geometry: BufferGeometry = new RingGeometry(0, 1, 64, 24);
  const places = geometry.getAttribute("position");
  const { r, g, b } = new Color(colour);
  const colours = new Float32Array(4 * places.count);
  for (let k = 0; k < places.count; k++) {
    colours.set([r, g, b, opacity(Math.min(Math.hypot(places.getX(k), places.getY(k)), 1))], 4 * k);
  }
  geometry.setAttribute("color", new BufferAttribute(colours, 4));
  const material = new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false });
  const mesh = new Mesh(geometry, material);
  // Before everything else that is transparent.
  mesh.renderOrder = -1;
  return mesh;
}

/** Mean and covariance of the points of a surface, by area. */
function moments({ vertices, faces }: Surface): { mean: Vector3; spread: Matrix3 } {
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  const middles: [at: Vector3, area: number][] = [];
  for (let f = 0; f < faces.length; f += 3) {
    [a, b, c].forEach((corner, k) => corner.fromArray(vertices, 3 * faces[f + k]!));
    const middle = a.clone().add(b).add(c).divideScalar(3);
    middles.push([middle, b.sub(a).cross(c.sub(a)).length() / 2]);
  }
  const whole = middles.reduce((sum, [, area]) => sum + area, 0) || 1;
  const mean = new Vector3();
  for (const [at, area] of middles) mean.addScaledVector(at, area / whole);
  const sums = Array.from({ length: 9 }, () => 0);
  for (const [at, area] of middles) {
    const from = at.sub(mean).toArray();
    for (let k = 0; k < 9; k++) sums[k]! += (from[k % 3]! * from[Math.floor(k / 3)]! * area) / whole;
  }
  return { mean, spread: new Matrix3().fromArray(sums) };
}
