import type { About, Quadruple, Triple } from "../core/core.ts";
import type { Unit } from "../panels/units.ts";
import { DEGREE } from "../panels/units.ts";
import { table } from "./toml.ts";

/** How a body starts, as the controls have it: spin, attitude, and where its centre of mass is. */
export interface StartChoice {
  spin: Spin;
  /** Null while the scene's own rotor stands. */
  attitude: Attitude | null;
  rotor: Quadruple;
  /** Of the centre of mass, where forces move it. */
  path: { position: Triple; velocity: Triple } | null;
  /** s. */
  time: number;
}

/** Ω_B: mostly in one plane, and off it by an angle, toward the next plane or the one after. */
export interface Spin {
  /** 0, 1, 2 for e2∧e3, e3∧e1, e1∧e2; three more for the other sense. */
  plane: number;
  /** rad/s. */
  rate: number;
  /** rad. */
  off: number;
  /** rad. */
  toward: number;
}

/** The rotor exp(−½ turn e1e2) exp(−½ tilt e2e3) exp(−½ roll e1e2): angles in rad. */
export interface Attitude {
  turn: number;
  tilt: number;
  roll: number;
}

const PLANES = ["e2∧e3", "e3∧e1", "e1∧e2"];

export function startOf(about: About, path: StartChoice["path"]): StartChoice {
  const { rotor, omega_body, time } = about.start;
  return { spin: spinOf(omega_body), attitude: null, rotor, path, time };
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

/** The angles of a rotor. */
export function attitudeOf([scalar, b1, b2, b3]: Quadruple): Attitude {
  const tilt = 2 * Math.atan2(Math.hypot(b1, b2), Math.hypot(scalar, b3));
  const sum = Math.atan2(-b3, scalar);
  const difference = b1 === 0 && b2 === 0 ? sum : Math.atan2(-b2, -b1);
  return { turn: wrapped(sum + difference), tilt, roll: wrapped(sum - difference) };
}

/** The table `[initial]`, in the words of the handout: the core does the algebra. */
export function startTable(start: StartChoice, rate: Unit): string {
  const { spin, attitude, rotor, path, time } = start;
  return table("initial", {
    attitude: attitude ? rotorFormula(attitude) : { rotor },
    spin: spinFormula(spin, rate),
    ...path,
    ...(time !== 0 && { time }),
  });
}

function spinFormula({ plane, rate, off, toward }: Spin, unit: Unit): string {
  const size = `${plane < 3 ? "" : "-"}${digits(rate / unit.size)} ${unit.scene}`;
  const [axis, next, after] = [0, 1, 2].map((k) => PLANES[(plane + k) % 3]!);
  if (off === 0) return `${size} ${axis}`;
  const side = `cos(${angle(toward)}) ${next} + sin(${angle(toward)}) ${after}`;
  return `${size} (cos(${angle(off)}) ${axis} + sin(${angle(off)}) (${side}))`;
}

function rotorFormula({ turn, tilt, roll }: Attitude): string {
  const turned = (by: number, plane: string): string => `exp(${angle(-by / 2)} ${plane})`;
  return `${turned(turn, PLANES[2]!)} ${turned(tilt, PLANES[0]!)} ${turned(roll, PLANES[2]!)}`;
}

function angle(radians: number): string {
  return `${digits(radians / DEGREE.size)} deg`;
}

/** Without the last digits, which come from radians. */
function digits(number: number): string {
  return String(Number(number.toPrecision(12)));
}

/** Between −π and π. */
function wrapped(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}
