import { Quaternion, Vector3 } from "three";
import { type About, type Motion, ROW, State } from "../core/core.ts";
import { firstRow, span } from "../model/model.ts";
import { equivalent, spinningTop, surfaceOf } from "./solids.ts";
import { AXES, quaternion, vector } from "./rotor.ts";
import type { Surface } from "./surface.ts";

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
  /** The body's surface in body axes from the drawn origin, in drawn units, and how its faces are tinted. */
  surface: Surface;
  tinted: "plain" | "sides" | "quadrants";
  /** The centre of mass from the drawn origin in body axes, in drawn units. */
  centre: Vector3;
  /** Unit vector in body axes whose path in space is drawn. */
  traced: Vector3;
  /** Drawn units of length for 1 rad/s: Poinsot's ellipsoid at the start reaches as far as the arrows f1, f2, f3. */
  rate: number;
  /** |Ω| and |L| at the start, or their largest values if the body starts at rest. */
  omega: number;
  momentum: number;
}

export function figureOf(motion: Motion): Figure {
  const about = motion.about;
  const start = firstRow(motion);
  const rows = Math.hypot(...start.subarray(State.omegaBody, State.omegaBody + 3)) > 0 ? start : some(motion);
  const omega = largest(rows, State.omegaSpace);
  const momentum = largest(rows, State.momentumSpace);
  const arm = about.held ? armOf(about) : new Vector3();
  const body = shape(motion, arm);
  const size = Math.max(farthest(body.surface), arm.length()) || 1;
  return {
    motion,
    about,
    surface: scaled(body.surface, 1 / size),
    tinted: body.tinted,
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

/** The body's surface from the drawn origin, in m; `arm` points from there to the centre of mass of a top. */
function shape(motion: Motion, arm: Vector3): Pick<Figure, "surface" | "tinted"> {
  const { body, held } = motion.about;
  const still = new Quaternion();
  const away = held ? new Vector3() : vector(body.center_of_mass).negate();
  const mesh = motion.surface();
  if (mesh) return { surface: moved(mesh, still, away), tinted: "plain" };
  if (body.solid) {
    const at = vector(body.solid_at).add(away);
    const tinted = body.solid.kind === "box" ? "sides" : "quadrants";
    return { surface: moved(surfaceOf(body.solid), still, at), tinted };
  }
  const frame = quaternion(body.frame);
  if (arm.length() === 0) {
    const solid = equivalent(body.moments);
    const tinted = solid.kind === "box" ? "sides" : "quadrants";
    return { surface: moved(surfaceOf(solid), frame, new Vector3()), tinted };
  }
  // A held body with known moments only: a top if it is symmetric, else a box at the end of the arm.
  const upright = AXES.findIndex(
    (axis) => Math.abs(axis.clone().applyQuaternion(frame).dot(arm)) > 0.999 * arm.length(),
  );
  const [a, b] = body.moments.filter((_, k) => k !== upright);
  if (upright >= 0 && Math.abs(a! - b!) < 1e-6 * Math.max(a!, b!)) {
    const onto = new Quaternion().setFromUnitVectors(AXES[2], arm.clone().normalize());
    return { surface: moved(spinningTop(arm.length()), onto, new Vector3()), tinted: "quadrants" };
  }
  const box = surfaceOf(equivalent(body.moments));
  const size = (0.6 * arm.length()) / farthest(box);
  return { surface: moved(scaled(box, size), frame, arm), tinted: "sides" };
}

function moved({ vertices, faces }: Surface, turn: Quaternion, by: Vector3): Surface {
  const points = new Float32Array(vertices.length);
  const point = new Vector3();
  for (let at = 0; at < points.length; at += 3) {
    vector(vertices, at, point).applyQuaternion(turn).add(by).toArray(points, at);
  }
  return { vertices: points, faces };
}

function scaled({ vertices, faces }: Surface, by: number): Surface {
  return { vertices: Float32Array.from(vertices, (x) => x * by), faces };
}

function farthest({ vertices }: Surface): number {
  let most = 0;
  for (let at = 0; at < vertices.length; at += 3) {
    most = Math.max(most, Math.hypot(vertices[at]!, vertices[at + 1]!, vertices[at + 2]!));
  }
  return most;
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

function largest(rows: Float64Array, at: number): number {
  let most = 0;
  for (let row = at; row < rows.length; row += ROW) {
    most = Math.max(most, Math.hypot(rows[row]!, rows[row + 1]!, rows[row + 2]!));
  }
  return most;
}

/** The longest semi-axis √(2T/i) of Poinsot's ellipsoid, rad/s. */
function longestSemiAxis(about: About, rows: Float64Array): number {
  const least = Math.min(...about.body.moments.filter((moment) => moment > 0));
  const doubleKinetic = vector(rows, State.omegaBody).dot(vector(rows, State.momentumBody));
  return doubleKinetic > 0 ? Math.sqrt(doubleKinetic / least) : 0;
}
