import { significant } from "./format.ts";

/** A unit that people read a quantity in: how it is shown, how a scene spells it, and how much it is in SI. */
export interface Unit {
  label: string;
  scene: string;
  size: number;
}

const unit = (label: string, size: number, scene = label): Unit => ({ label, scene, size });

/** From large to small; the first that makes a number of at least `least` is the one to use. */
const LENGTHS = [unit("km", 1000), unit("m", 1), unit("cm", 0.01), unit("mm", 0.001)];
const MASSES = [unit("t", 1000), unit("kg", 1), unit("g", 0.001)];
const TIMES = [unit("yr", 31_557_600), unit("d", 86_400), unit("h", 3600), unit("min", 60), unit("s", 1)];
const TURN = 2 * Math.PI;
const RATES = [unit("rev/s", TURN), unit("deg/s", TURN / 360), unit("deg/day", TURN / 360 / 86_400)];
export const DEGREE = unit("°", TURN / 360, "deg");
export const DENSITY = unit("g/cm³", 1000, "g/cm^3");
export const ONE = unit("", 1, "");

export const lengthUnit = (length: number): Unit => pick(LENGTHS, length, 0.8);
export const massUnit = (mass: number): Unit => pick(MASSES, mass, 0.1);
/** Minutes from two on, and so on, so that numbers stay short. */
export const timeUnit = (time: number): Unit => pick(TIMES, Math.abs(time), 2);
export const rateUnit = (rate: number): Unit => pick(RATES, rate, 0.02);

export function si(label: string, scene: string = label): Unit {
  return unit(label, 1, scene);
}

/** `3.2 d`, in the unit that fits. */
export function duration(time: number, digits = 5, fit = timeUnit(time)): string {
  return `${significant(time / fit.size, digits)} ${fit.label}`;
}

function pick(units: Unit[], size: number, least: number): Unit {
  return units.find((unit) => size >= least * unit.size) ?? units[units.length - 1]!;
}
