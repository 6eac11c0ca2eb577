import { Vector3 } from "three";
import {
  type About,
  type Acting,
  Problem,
  ROW,
  sizeAt,
  State,
  type Surface,
  type Triple,
} from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import { span } from "../model/model.ts";
import { firstRow } from "../model/speed.ts";
import { AXES, vector } from "./rotor.ts";

/** Length of the arrows f1, f2, f3, and radius of the sphere with the path of one of their tips. */
export const REACH = 1.25;

/**
 * A motion in drawn units: lengths over the distance from the drawn origin to the farthest point of the surface, so
 * that bodies of all sizes fill the view. The drawn origin is the fixed point of a held body, and the centre of mass of
 * any other.
 */
export interface Figure {
  motion: Motion;
  about: About;
  /** The length of a drawn unit, m. */
  size: number;
  /** The surface of the body in body axes from the drawn origin, in drawn units. */
  surface: Surface;
  /** The centre of mass from the drawn origin in body axes, in drawn units. */
  centre: Vector3;
  /** Unit vector in body axes whose path in space is drawn. */
  traced: Vector3;
  /** Drawn units of length for 1 rad/s: Poinsot's ellipsoid at the start reaches as far as the arrows f1, f2, f3. */
  rate: number;
  /** |Ω| and |L| at the start, or their largest values if the body starts at rest. */
  omega: number;
  momentum: number;
  /** What acts on the body at the start, null if that is not known, and the largest torque, N m. */
  acting: Acting | null;
  torque: number;
}

export function figureOf(motion: Motion): Figure {
  const about = motion.about;
  const start = firstRow(motion);
  const rows = sizeAt(start, State.omegaBody) > 0 ? start : some(motion);
  const omega = largest(rows, State.omegaSpace);
  const momentum = largest(rows, State.momentumSpace);
  const arm = about.held ? armOf(about) : new Vector3();
  const surface = surfaceFrom(motion, arm);
  const size = Math.max(largest(surface.vertices, 0, 3), arm.length()) || 1;
  const acting = actingOn(motion, start);
  return {
    motion,
    about,
    acting,
    torque: largestTorque(motion),
    size,
    surface: { ...surface, vertices: surface.vertices.map((x) => x / size) },
    centre: arm.clone().divideScalar(size),
    traced: arm.length() > 0 ? arm.clone().normalize() : nearestAxis(vector(rows, State.omegaBody)),
    rate: REACH / (longestSemiAxis(about, rows) || omega || 1),
    omega: omega || 1,
    momentum: momentum || 1,
  };
}

/** From the fixed point to the centre of mass; if only the heavy law is known, its vector. */
function armOf({ body, heavy }: About): Vector3 {
  const centre = vector(body.center_of_mass);
  return centre.length() > 0 || !heavy ? centre : vector(heavy);
}

/** The surface from the drawn origin, m: the fixed point, the origin of body axes, or else the centre of mass. */
function surfaceFrom(motion: Motion, arm: Vector3): Surface {
  const { body, held } = motion.about;
  const surface = motion.surface(arm.toArray());
  // A surface that follows from the moments is about the centre of mass already.
  const away: Triple = held || !(body.solid || body.mesh) ? [0, 0, 0] : body.center_of_mass;
  return { ...surface, vertices: surface.vertices.map((x, k) => x - away[k % 3]!) };
}

function nearestAxis(omegaBody: Vector3): Vector3 {
  const sizes = omegaBody.toArray().map(Math.abs);
  return AXES[sizes.indexOf(Math.max(...sizes)) as 0 | 1 | 2].clone();
}

/** Some states over the duration of the motion. */
function some(motion: Motion): Float64Array {
  const [first, last] = span(motion.about);
  const from = Math.max(first, motion.about.start.time);
  const to = Math.min(last, from + motion.about.duration);
  return motion.states(Array.from({ length: 65 }, (_, k) => from + ((to - from) * k) / 64));
}

/** What acts on the body in a state; null if that is not known, as for a recorded motion. */
export function actingOn(motion: Motion, row: Float64Array): Acting | null {
  if (motion.about.method === "recorded") return null;
  try {
    return motion.acting(row);
  } catch (error) {
    if (error instanceof Problem) return null;
    throw error;
  }
}

/** The largest torque over the duration of a motion, N m; zero without laws and thrusts. */
export function largestTorque(motion: Motion): number {
  const start = actingOn(motion, firstRow(motion));
  if (!start || motion.about.laws.length + start.thrusts.length === 0) return 0;
  const rows = some(motion);
  const sizes = Array.from({ length: rows.length / ROW }, (_, k) =>
    sizeAt(actingOn(motion, rows.subarray(ROW * k, ROW * (k + 1)))?.torque ?? [0, 0, 0], 0),
  );
  return Math.max(...sizes);
}

/** The largest size of the vectors at an offset in rows. */
function largest(rows: Float64Array, at: number, width = ROW): number {
  let most = 0;
  for (let row = at; row < rows.length; row += width) most = Math.max(most, sizeAt(rows, row));
  return most;
}

/** The longest semi-axis √(2T/i) of Poinsot's ellipsoid, rad/s. */
function longestSemiAxis(about: About, rows: Float64Array): number {
  const least = Math.min(...about.body.moments.filter((moment) => moment > 0));
  const doubleKinetic = vector(rows, State.omegaBody).dot(vector(rows, State.momentumBody));
  return doubleKinetic > 0 ? Math.sqrt(doubleKinetic / least) : 0;
}
