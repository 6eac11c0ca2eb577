import {
  BoxGeometry,
  type BufferGeometry,
  CapsuleGeometry,
  ConeGeometry,
  CylinderGeometry,
  LatheGeometry,
  SphereGeometry,
  SplineCurve,
  TorusGeometry,
  Vector2,
} from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import type { Solid, Triple } from "../core/core.ts";
import type { Surface } from "./surface.ts";

/** Steps around an axis of revolution; a multiple of four, so that each face is in one quadrant. */
const ROUND = 64;
/** Relative thickness of thin solids. */
const THIN = 0.03;

/** The surface of a solid in its own axes, m; axes of revolution lie along e3, as in crates/rigid/src/solids.rs. */
export function surfaceOf(solid: Solid): Surface {
  switch (solid.kind) {
    case "box":
      return welded(new BoxGeometry(...solid.lengths));
    case "ellipsoid":
      return ellipsoid(solid.semi_axes);
    case "sphere":
      return ellipsoid([solid.radius, solid.radius, solid.radius]);
    case "hollow_sphere":
      return ellipsoid([solid.outer_radius, solid.outer_radius, solid.outer_radius]);
    case "cylinder":
      return upright(new CylinderGeometry(solid.radius, solid.radius, solid.height, ROUND));
    case "cone":
      // Three centres it at half its height.
      return upright(new ConeGeometry(solid.radius, solid.height, ROUND).translate(0, solid.height / 2, 0));
    case "capsule":
      return upright(new CapsuleGeometry(solid.radius, solid.height, 24, ROUND));
    case "rod":
      return upright(new CylinderGeometry(THIN * solid.length, THIN * solid.length, solid.length, ROUND));
    case "disc":
      return upright(new CylinderGeometry(solid.radius, solid.radius, THIN * solid.radius, ROUND));
    case "torus":
      return welded(new TorusGeometry(solid.major_radius, solid.minor_radius, 32, ROUND));
  }
}

/**
 * A solid for a body with known principal moments only: the uniform box of mass 1 with these moments; a ball if its
 * sides differ by less than 5 %.
 */
export function equivalent(moments: Triple): Solid {
  const [a, b, c] = moments;
  const squares = [b + c - a, c + a - b, a + b - c].map((square) => 6 * Math.max(square, 0));
  const longest = Math.sqrt(Math.max(...squares));
  const lengths = squares.map((square) => Math.max(Math.sqrt(square), THIN * longest)) as Triple;
  if (Math.min(...lengths) > 0.95 * longest) {
    return { kind: "ellipsoid", semi_axes: lengths.map((length) => length / 2) as Triple };
  }
  return { kind: "box", lengths };
}

/** Profile of a spinning top: radii and heights, for a centre of mass at height 1. */
const TOP: [number, number][] = [
  [0, 0],
  [0.025, 0.03],
  [0.1, 0.24],
  [0.3, 0.54],
  [0.54, 0.78],
  [0.66, 0.96],
  [0.64, 1.1],
  [0.46, 1.22],
  [0.16, 1.3],
  [0.055, 1.38],
  [0.05, 1.6],
  [0, 1.63],
];

/** A spinning top with its tip at the origin and its centre of mass at a height on e3. */
export function spinningTop(height: number): Surface {
  const section = new SplineCurve(TOP.map(([radius, along]) => new Vector2(radius, along))).getPoints(24);
  for (const point of section) point.set(Math.max(point.x, 0), point.y).multiplyScalar(height);
  return upright(new LatheGeometry(section, ROUND));
}

function ellipsoid(semiAxes: Triple): Surface {
  return upright(new SphereGeometry(1, ROUND, ROUND / 2), semiAxes);
}

/** Three's solids of revolution lie along its y axis. */
function upright(geometry: BufferGeometry, scale: Triple = [1, 1, 1]): Surface {
  return welded(geometry.rotateX(Math.PI / 2).scale(...scale));
}

/** Merges vertices: those of Three are separate for each face. */
function welded(geometry: BufferGeometry): Surface {
  geometry.deleteAttribute("normal").deleteAttribute("uv").computeBoundingSphere();
  const whole = mergeVertices(geometry, 1e-6 * geometry.boundingSphere!.radius);
  const surface = { vertices: whole.attributes.position!.array, faces: whole.index!.array };
  geometry.dispose();
  whole.dispose();
  return surface;
}
