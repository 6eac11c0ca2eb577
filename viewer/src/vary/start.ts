import type { About, Quadruple, Triple } from "../core/core.ts";
import { typed } from "../format/numbers.ts";
import { DEGREE, type Unit } from "../format/units.ts";
import { table } from "./toml.ts";

/** The initial state chosen by the controls. */
export interface StartChoice {
  spin: Spin;
  /** Ω_B as given by hand, rad/s; null where it is `spin`. */
  omega: Triple | null;
  /** Null while the rotor of the scene is unchanged. */
  attitude: Attitude | null;
  rotor: Quadruple;
  /** Position and velocity of the centre of mass, where forces move it. */
  path: { position: Triple; velocity: Triple } | null;
  /** s. */
  time: number;
}

/** Ω_B in spherical coordinates: an axis, a rate, and an angle from the axis towards the next one. */
export interface Spin {
  /** 0, 1, 2 for e2∧e3, e3∧e1, e1∧e2; 3, 4, 5 for the opposite sense. */
  plane: number;
  /** rad/s. */
  rate: number;
  /** Angle from the axis, rad. */
  off: number;
  /** Azimuth of Ω about the axis, rad: 0 towards the next axis. */
  toward: number;
}

/** The rotor exp(−½ turn e1e2) exp(−½ tilt e2e3) exp(−½ roll e1e2); angles in rad. */
export interface Attitude {
  turn: number;
  tilt: number;
  roll: number;
}

const PLANES = ["e2∧e3", "e3∧e1", "e1∧e2"];

export function startOf(about: About, path: StartChoice["path"]): StartChoice {
  const { rotor, omega_body, time } = about.start;
  return { spin: spinOf(omega_body), omega: null, attitude: null, rotor, path, time };
}

/** A start with these numbers, bit for bit. */
export function startAt(
  rotor: Quadruple,
  omega: Triple,
  path: StartChoice["path"],
  time: number,
): StartChoice {
  return { spin: spinOf(omega), omega, attitude: null, rotor, path, time };
}

function spinOf(omega: Triple): Spin {
  const rate = Math.hypot(...omega);
  const sizes = omega.map(Math.abs);
  const main = rate === 0 ? 2 : sizes.indexOf(Math.max(...sizes));
  const sense = omega[main]! < 0 ? -1 : 1;
  const [next, after] = [sense * omega[(main + 1) % 3]!, sense * omega[(main + 2) % 3]!];
  return {
    plane: main + (sense < 0 ? 3 : 0),
    rate,
    off: rate === 0 ? 0 : Math.atan2(Math.hypot(next, after), sizes[main]!),
    toward: Math.atan2(after, next),
  };
}

/** The table `[initial]`; the core evaluates its formulas. */
export function startTable(start: StartChoice, rate: Unit): string {
  const { spin, omega, attitude, rotor, path, time } = start;
  return table("initial", {
    attitude: attitude ? rotorFormula(attitude) : { rotor },
    spin: omega ? { bivector: omega } : spinFormula(spin, rate),
    ...path,
    ...(time !== 0 && { time }),
  });
}

function spinFormula({ plane, rate, off, toward }: Spin, unit: Unit): string {
  const size = `${plane < 3 ? "" : "-"}${typed(rate / unit.size, 12)} ${unit.scene}`;
  const [axis, next, after] = [0, 1, 2].map((k) => PLANES[(plane + k) % 3]!);
  if (off === 0) return `${size} ${axis}`;
  const side = `cos(${angle(toward)}) ${next} + sin(${angle(toward)}) ${after}`;
  return `${size} (cos(${angle(off)}) ${axis} + sin(${angle(off)}) (${side}))`;
}

function rotorFormula({ turn, tilt, roll }: Attitude): string {
  const rotor = (by: number, plane: string): string => `exp(${angle(-by / 2)} ${plane})`;
  return `${rotor(turn, PLANES[2]!)} ${rotor(tilt, PLANES[0]!)} ${rotor(roll, PLANES[2]!)}`;
}

/** In twelve digits, which drops the rounding errors of the conversion from radians. */
function angle(radians: number): string {
  return `${typed(radians / DEGREE.size, 12)} deg`;
}
