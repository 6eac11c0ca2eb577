import {
  BoxGeometry,
  type BufferGeometry,
  CapsuleGeometry,
  ConeGeometry,
  CylinderGeometry,
  LatheGeometry,
  SphereGeometry,
  TorusGeometry,
  Vector2,
} from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import type { Solid, Triple } from "../core/core.ts";
import type { Surface } from "./surface.ts";

/** Steps around an axis of revolution. A multiple of four, so that no face lies in two quadrants. */
const ROUND = 96;
/** What has no thickness is drawn with this part of its size. */
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
      // Three centres it on half its height.
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
 * A solid for a body of which the principal moments alone are known: the uniform box that has them, in principal
 * axes, for a mass of 1; a ball where its sides differ by less than a twentieth.
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

/** A spinning top of textbooks: its tip at the origin, widest at a height along e3, with a stem above. */
export function spinningTop(height: number): Surface {
  const profile = [
    [0, 0],
    [0.035, 0.06],
    [0.16, 0.42],
    [0.52, 0.86],
    [0.66, 0.98],
    [0.68, 1.04],
    [0.62, 1.1],
    [0.3, 1.2],
    [0.08, 1.26],
    [0.055, 1.32],
    [0.055, 1.62],
    [0.04, 1.65],
    [0, 1.66],
  ];
  return upright(
    new LatheGeometry(
      profile.map(([radius, along]) => new Vector2(radius! * height, along! * height)),
      ROUND,
    ),
  );
}

function ellipsoid(semiAxes: Triple): Surface {
  return upright(new SphereGeometry(1, ROUND, ROUND / 2), semiAxes);
}

/** Three's solids of revolution lie along its y axis. */
function upright(geometry: BufferGeometry, scale: Triple = [1, 1, 1]): Surface {
  return welded(geometry.rotateX(Math.PI / 2).scale(...scale));
}

/** Three gives each face vertices of its own; here faces share them. */
function welded(geometry: BufferGeometry): Surface {
  geometry.deleteAttribute("normal").deleteAttribute("uv").computeBoundingSphere();
  const whole = mergeVertices(geometry, 1e-6 * geometry.boundingSphere!.radius);
  const surface = { vertices: whole.attributes.position!.array, faces: whole.index!.array };
  geometry.dispose();
  whole.dispose();
  return surface;
}
