import { significant } from "./numbers.ts";

/** A unit of measurement: its label on the page, its spelling in scenes, and its size in SI units. */
export interface Unit {
  label: string;
  scene: string;
  size: number;
}

const unit = (label: string, size = 1, scene = label): Unit => ({ label, scene, size });
export const si = (label: string, scene = label): Unit => unit(label, 1, scene);

const TURN = 2 * Math.PI;
// From large to small: the first unit in which a number is not too small is used.
const LENGTHS = [unit("km", 1000), unit("m"), unit("cm", 0.01), unit("mm", 0.001)];
const MASSES = [unit("t", 1000), unit("kg"), unit("g", 0.001)];
const TIMES = [unit("yr", 31_557_600), unit("d", 86_400), unit("h", 3600), unit("min", 60), unit("s")];
const RATES = [unit("rev/s", TURN), unit("deg/s", TURN / 360), unit("deg/day", TURN / 360 / 86_400)];
export const DEGREE = unit("°", TURN / 360, "deg");
export const DENSITY = unit("g/cm³", 1000, "g/cm^3");

/** A unit as the core spells it, `kg m^2/s`, with raised digits. */
export const unitLabel = (unit: string): string => unit.replace("^2", "²").replace("^3", "³");
export const lengthUnit = (length: number): Unit => pick(LENGTHS, length, 0.8);
export const massUnit = (mass: number): Unit => pick(MASSES, mass, 0.1);
/** Minutes from 2 min on, hours from 2 h on and so forth, which keeps numbers short. */
export const timeUnit = (time: number): Unit => pick(TIMES, Math.abs(time), 2);
export const rateUnit = (rate: number): Unit => pick(RATES, rate, 0.02);

/** `3.2 d`: a time in a suitable unit, with a space that does not break. */
export function duration(time: number, digits = 5, fit = timeUnit(time)): string {
  return `${significant(time / fit.size, digits)}\u00a0${fit.label}`;
}

function pick(units: Unit[], size: number, least: number): Unit {
  return units.find((unit) => size >= least * unit.size) ?? units[units.length - 1]!;
}
