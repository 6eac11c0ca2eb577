/** Tolerance of a line in drawn units: a fifth of a pixel in the default view. */
const NEAR = 1e-3;
/** The longest piece, so that fading along the line is even. */
const LONGEST = 0.15;

/** Indices of the points (n × 3) that a smooth line needs: few where it is nearly straight. */
export function thinned(points: ArrayLike<number>): Uint32Array {
  const count = points.length / 3;
  const kept = [];
  // The last kept point, and the direction of the path there.
  let last = 0;
  let way: [number, number, number] | null = null;
  for (let k = 0; k < count; k++) {
    if (k > 0 && k < count - 1) {
      const on = direction(points, k, k + 1);
      way ??= direction(points, last, last + 1);
      if (!on) continue;
      const chord = distance(points, last, k);
      // The height of an arc is 1/8 of its chord times its turn.
      const turn = way ? Math.hypot(on[0] - way[0], on[1] - way[1], on[2] - way[2]) : 2;
      if (chord < LONGEST && chord * turn < 8 * NEAR) continue;
      way = on;
    }
    kept.push(k);
    last = k;
  }
  return Uint32Array.from(kept);
}

/** The rows (n × `width`) with these indices. */
export function rowsOf(numbers: ArrayLike<number>, indices: Uint32Array, width: number): Float64Array {
  const rows = new Float64Array(indices.length * width);
  indices.forEach((k, row) => {
    for (let i = 0; i < width; i++) rows[width * row + i] = numbers[width * k + i]!;
  });
  return rows;
}

function distance(points: ArrayLike<number>, a: number, b: number): number {
  return Math.hypot(
    points[3 * b]! - points[3 * a]!,
    points[3 * b + 1]! - points[3 * a + 1]!,
    points[3 * b + 2]! - points[3 * a + 2]!,
  );
}

function direction(points: ArrayLike<number>, a: number, b: number): [number, number, number] | null {
  const length = distance(points, a, b);
  if (length === 0) return null;
  return [0, 1, 2].map((i) => (points[3 * b + i]! - points[3 * a + i]!) / length) as [number, number, number];
}
