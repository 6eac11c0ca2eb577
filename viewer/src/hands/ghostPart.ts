import { Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial } from "three";
import { State } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import type { Part, Setting } from "../stage/part.ts";
import { quaternion } from "../stage/rotor.ts";
import { look } from "../stage/surface.ts";
import { stateOf } from "./ghost.ts";

/** The ghost: a body that is seen through, at the same place. */
export function ghostPart({ figure, palette }: Setting, motion: () => Motion | null): Part {
  const { faces, edges } = look(figure.surface);
  const color = new Color(palette.trace);
  const skin = new MeshLambertMaterial({ color, transparent: true, opacity: 0.3, depthWrite: false });
  const ink = new LineBasicMaterial({ color, transparent: true, opacity: 0.9 });
  const body = new Mesh(faces, skin);
  body.renderOrder = 1;
  const inSpace = new Group().add(body, new LineSegments(edges, ink));
  return {
    inSpace,
    update({ time }, shown) {
      const ghost = shown.ghost ? motion() : null;
      const row = ghost && stateOf(ghost, time);
      inSpace.visible = row !== null;
      if (row) quaternion(row, State.rotor, inSpace.quaternion);
    },
  };
}
