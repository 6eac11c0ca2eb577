import { Vector3 } from "three";
import type { Surface } from "../core/core.ts";
import type { Figure } from "./figure.ts";

/** Least height of the stand under the pivot. */
const STAND = 0.42;
/** Beyond this tilt a top would touch any floor. */
const HIGHEST = (115 * Math.PI) / 180;
/** Room between the lowest point that a top reaches and the floor. */
const ROOM = 0.04;

/** The height of the stand under the pivot of a held body: tops do not touch the floor under it. */
export function standOf(figure: Figure): number {
  return -(floorOf(figure) ?? -STAND);
}

/** The height of the floor under a top, below its fixed point; null if it has none. */
export function floorOf({ about, surface, traced }: Figure): number | null {
  if (!about.held || !about.top || about.top.tilt[1] > HIGHEST) return null;
  let lowest = 0;
  for (const tilt of about.top.tilt) lowest = Math.min(lowest, lowestAt(tilt, surface, traced));
  return Math.min(-STAND, lowest - ROOM);
}

/** The lowest point of a surface whose axis is tilted from the vertical by an angle. */
function lowestAt(tilt: number, { vertices }: Surface, axis: Vector3): number {
  let lowest = 0;
  const at = new Vector3();
  for (let k = 0; k < vertices.length; k += 3) {
    at.fromArray(vertices, k);
    const high = at.dot(axis);
    const out = Math.sqrt(Math.max(at.lengthSq() - high * high, 0));
    lowest = Math.min(lowest, high * Math.cos(tilt) - out * Math.sin(tilt));
  }
  return lowest;
}
