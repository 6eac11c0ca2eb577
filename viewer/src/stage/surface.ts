import { BufferGeometry, EdgesGeometry, Float32BufferAttribute } from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import type { Surface } from "../core/core.ts";

/** Faces that meet at a smaller angle are shaded as one smooth surface; others have an edge between them. */
const CREASE = 35;
/** The number of tints, see `Surface`. */
const TINTS = 5;
/** For normals, three takes points within 0.01 as one. A power of two, which costs no digits. */
const FINER = 1024;

/** The geometry of a surface: faces with normals, in one group per tint, and its sharp edges. */
export interface Look {
  faces: BufferGeometry;
  edges: BufferGeometry;
}

let last: { surface: Surface; look: Look } | null = null;

/** While a slider moves, motions follow each other fast, mostly of the same body: the last look is kept. */
export function look(surface: Surface): Look {
  if (!last || !same(last.surface, surface)) last = { surface, look: lookOf(surface) };
  return last.look;
}

function lookOf({ vertices, faces, tints }: Surface): Look {
  const indices: number[] = [];
  const geometry = new BufferGeometry();
  for (let tint = 0; tint < TINTS; tint++) {
    const start = indices.length;
    tints.forEach((other, f) => {
      if (other === tint) indices.push(...faces.subarray(3 * f, 3 * f + 3));
    });
    geometry.addGroup(start, indices.length - start, tint);
  }
  geometry.setAttribute("position", new Float32BufferAttribute(vertices, 3));
  geometry.setIndex(indices);
  const edges = new EdgesGeometry(geometry, CREASE);
  const creased = toCreasedNormals(geometry.scale(FINER, FINER, FINER), (CREASE * Math.PI) / 180);
  return { faces: creased.scale(1 / FINER, 1 / FINER, 1 / FINER), edges };
}

function same(a: Surface, b: Surface): boolean {
  return equal(a.vertices, b.vertices) && equal(a.faces, b.faces) && equal(a.tints, b.tints);
}

function equal(a: Float64Array | Uint32Array, b: Float64Array | Uint32Array): boolean {
  return a.length === b.length && a.every((x: number, k: number) => x === b[k]);
}
