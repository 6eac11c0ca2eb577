import { Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";
import type { Part, Setting } from "./part.ts";
import { Shapes } from "./shapes.ts";

const DOT = 0.04;
/** The size while it is marked. */
const MARKED = 1.8;

/** The axis of Ω with a dot at its tip, beside the energy ellipsoid on which the same dot moves. */
export function tip({ figure, palette, screen }: Setting, marked: () => boolean): Part {
  const shapes = new Shapes(screen, palette.omega);
  const line = shapes.line([], { width: 1.6, behind: 0.35 });
  const dot = new Mesh(new SphereGeometry(DOT, 24, 16), new MeshBasicMaterial({ color: palette.omega }));
  const inSpace = new Group().add(shapes.object, dot);
  return {
    layer: "energy",
    inSpace,
    update({ omega }, shown) {
      inSpace.visible = shown.energy && omega.length() > 0;
      if (!inSpace.visible) return;
      dot.position.copy(omega).multiplyScalar(figure.rate);
      dot.scale.setScalar(marked() ? MARKED : 1);
      line.set([new Vector3(), dot.position.clone()]);
    },
  };
}
