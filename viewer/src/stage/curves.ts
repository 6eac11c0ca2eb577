import { type Camera, Matrix4, type Object3D, type Vector2 } from "three";
import type { CurveName } from "../model/model.ts";

/** Those that show one motion, and are marked together. */
const TOGETHER: readonly CurveName[] = ["polhode", "herpolhode", "trace"];

/** The distance in CSS pixels at which the pointer is over a curve. */
const NEAR = 7;

/** Something that can be pointed at. */
export interface Curve {
  name: CurveName;
  object: Object3D;
  /** Calls back with points in the axes of the object, and whether each continues the line from the last one. */
  visit: (point: (x: number, y: number, z: number, joined: boolean) => void) => void;
  /** Marks it, or no longer. */
  mark?: (marked: boolean) => void;
}

/** Whether a curve is marked while the pointer is over one. */
function isMarked(name: CurveName, pointed: CurveName | null): boolean {
  return name === pointed || (pointed !== null && TOGETHER.includes(pointed) && TOGETHER.includes(name));
}

/** The curves of a picture. */
export class Curves {
  private list: Curve[] = [];

  add(curve: Curve): void {
    this.list.push(curve);
  }

  clear(): void {
    this.list = [];
  }

  mark(pointed: CurveName | null): void {
    for (const { name, mark } of this.list) mark?.(isMarked(name, pointed));
  }

  /** The curve nearest to a point of a screen of a size in CSS pixels; null if none is near. */
  at(x: number, y: number, camera: Camera, size: Vector2): CurveName | null {
    let [found, least]: [CurveName | null, number] = [null, NEAR];
    for (const { name, object, visit } of this.list) {
      if (!isSeen(object)) continue;
      const onto = new Matrix4()
        .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
        .multiply(object.matrixWorld);
      const away = distance(onto, visit, x, y, size);
      // Lines before the cloud, which covers much.
      if (away < least && (name !== "cloud" || found === null)) [found, least] = [name, away];
    }
    return found;
  }
}

function isSeen(object: Object3D): boolean {
  for (let one: Object3D | null = object; one; one = one.parent) if (!one.visible) return false;
  return true;
}

/** The distance of a point of the screen from points and the lines between them, in CSS pixels. */
function distance(onto: Matrix4, visit: Curve["visit"], x: number, y: number, size: Vector2): number {
  const m = onto.elements;
  let least = Infinity;
  let [lastX, lastY, before] = [0, 0, false];
  visit((px, py, pz, joined) => {
    const w = m[3]! * px + m[7]! * py + m[11]! * pz + m[15]!;
    const here = w > 0;
    const sx = ((1 + (m[0]! * px + m[4]! * py + m[8]! * pz + m[12]!) / w) * size.x) / 2 - x;
    const sy = ((1 - (m[1]! * px + m[5]! * py + m[9]! * pz + m[13]!) / w) * size.y) / 2 - y;
    if (here) {
      let part = 0;
      const [dx, dy] = [lastX - sx, lastY - sy];
      const square = dx * dx + dy * dy;
      if (joined && before && square > 0) part = Math.min(Math.max(-(sx * dx + sy * dy) / square, 0), 1);
      least = Math.min(least, Math.hypot(sx + part * dx, sy + part * dy));
    }
    [lastX, lastY, before] = [sx, sy, here];
  });
  return least;
}
