import { BufferAttribute, BufferGeometry, Float32BufferAttribute } from "three";
import type { Surface } from "../core/core.ts";

/** Faces that meet at a smaller angle are shaded as one smooth surface; others have an edge between them. */
const CREASE = Math.cos((35 * Math.PI) / 180);

/** The geometry of a surface: faces with normals, in one group per tint, and its sharp edges. */
export interface Look {
  faces: BufferGeometry;
  edges: BufferGeometry;
}

export function look(surface: Surface): Look {
  const { vertices, faces } = surface;
  const normals = faceNormals(surface);
  const around = facesAround(surface);
  const positions = new Float32Array(3 * faces.length);
  const smooth = new Float32Array(3 * faces.length);
  const geometry = new BufferGeometry();
  let corner = 0;
  for (const [tint, ofTint] of facesByTint(surface, normals).entries()) {
    if (!ofTint) continue;
    geometry.addGroup(corner, 3 * ofTint.length, tint);
    for (const f of ofTint) {
      for (let i = 0; i < 3; i++, corner++) {
        const v = faces[3 * f + i]!;
        let [x, y, z] = [0, 0, 0];
        for (let k = around.start[v]!; k < around.start[v + 1]!; k++) {
          const g = around.faces[k]!;
          if (cosine(normals, f, g) < CREASE) continue;
          x += normals[4 * g]! * normals[4 * g + 3]!;
          y += normals[4 * g + 1]! * normals[4 * g + 3]!;
          z += normals[4 * g + 2]! * normals[4 * g + 3]!;
        }
        const length = Math.hypot(x, y, z) || 1;
        smooth.set([x / length, y / length, z / length], 3 * corner);
        positions.set(vertices.subarray(3 * v, 3 * v + 3), 3 * corner);
      }
    }
  }
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new BufferAttribute(smooth, 3));
  return { faces: geometry, edges: sharpEdges(surface, normals, around) };
}

/** The unit normal of each face, and twice its area. */
function faceNormals({ vertices, faces }: Surface): Float64Array {
  const normals = new Float64Array((faces.length / 3) * 4);
  for (let f = 0; f < faces.length / 3; f++) {
    const [a, b, c] = [3 * faces[3 * f]!, 3 * faces[3 * f + 1]!, 3 * faces[3 * f + 2]!];
    const edge = (from: number, to: number, i: number) => vertices[to + i]! - vertices[from + i]!;
    const [ux, uy, uz] = [edge(a, b, 0), edge(a, b, 1), edge(a, b, 2)];
    const [vx, vy, vz] = [edge(a, c, 0), edge(a, c, 1), edge(a, c, 2)];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const area = Math.hypot(x, y, z);
    if (area > 0) normals.set([x / area, y / area, z / area, area], 4 * f);
  }
  return normals;
}

/** The faces at each vertex: those of vertex v are at start[v] to start[v + 1]. */
function facesAround({ vertices, faces }: Surface): { start: Uint32Array; faces: Uint32Array } {
  const start = new Uint32Array(vertices.length / 3 + 1);
  for (let k = 0; k < faces.length; k++) start[faces[k]! + 1]!++;
  for (let v = 1; v < start.length; v++) start[v]! += start[v - 1]!;
  const next = start.slice();
  const around = new Uint32Array(faces.length);
  for (let k = 0; k < faces.length; k++) around[next[faces[k]!]!++] = Math.floor(k / 3);
  return { start, faces: around };
}

/** The faces of each tint, without those that have no area. */
function facesByTint({ tints }: Surface, normals: Float64Array): number[][] {
  const faces: number[][] = [];
  tints.forEach((tint, f) => {
    if (normals[4 * f + 3] !== 0) (faces[tint] ??= []).push(f);
  });
  return faces;
}

function sharpEdges(
  { vertices, faces }: Surface,
  normals: Float64Array,
  around: { start: Uint32Array; faces: Uint32Array },
): BufferGeometry {
  const points: number[] = [];
  for (let f = 0; f < faces.length / 3; f++) {
    for (let i = 0; i < 3; i++) {
      const [a, b] = [faces[3 * f + i]!, faces[3 * f + ((i + 1) % 3)]!];
      for (let k = around.start[a]!; k < around.start[a + 1]!; k++) {
        const g = around.faces[k]!;
        if (g <= f || ![0, 1, 2].some((j) => faces[3 * g + j] === b)) continue;
        if (cosine(normals, f, g) >= CREASE) continue;
        for (const v of [a, b]) points.push(...vertices.subarray(3 * v, 3 * v + 3));
      }
    }
  }
  return new BufferGeometry().setAttribute("position", new Float32BufferAttribute(points, 3));
}

function cosine(normals: Float64Array, f: number, g: number): number {
  return (
    normals[4 * f]! * normals[4 * g]! +
    normals[4 * f + 1]! * normals[4 * g + 1]! +
    normals[4 * f + 2]! * normals[4 * g + 2]!
  );
}
