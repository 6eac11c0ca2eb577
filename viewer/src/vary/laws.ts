import type { About, LawArgument, LawEntry, Triple } from "../core/core.ts";
import { lengthUnit, si, timeUnit, type Unit, unitLabel } from "../format/units.ts";
import { around, type Range } from "../inputs/range.ts";
import { table } from "./toml.ts";

/** The torque laws chosen in the controls: those of the scene, or those that are on here. */
export interface LawsChoice {
  from: "scene" | "here";
  /** The names of the laws that are on. */
  on: ReadonlySet<string>;
  /** Each parameter by its law and name, in SI units. */
  values: Record<string, number>;
}

export interface Parameter {
  name: string;
  label: string;
  unit: Unit;
  range: Range;
  value: number;
}

/** A law that can be chosen, with parameters of a size that suits the body. */
export interface LawForm {
  name: string;
  label: string;
  parameters: Parameter[];
}

/** The axis of a law that has one: a parameter of values 0, 1, 2. */
export const AXIS = "axis";

/** The law of a body that is held at the origin of its axes, and all laws that hold it at a point. */
export const WEIGHT = "heavy";
export const HOLDING: ReadonlySet<string> = new Set(["gravity", WEIGHT]);

/** The parameter of a law that is a value without a table. */
const VALUE = "value";

/**
 * The laws that can be chosen for a body: gravity, given by its pivot if `byPivot` and else by the moment of the weight,
 * and the laws of the registry whose arguments can be suggested from its motion. `size` is that of the body in m.
 */
export function lawsFor(
  registry: readonly LawEntry[],
  about: About,
  momentum: number,
  size: number,
  byPivot: boolean,
): LawForm[] {
  const rate = Math.hypot(...about.start.omega_body) || 1;
  const moment = Math.max(...about.body.moments);
  const spin = momentum || moment * rate;
  const suggested = (argument: LawArgument): number | null => suggestion(argument, rate, moment, spin);
  const others = registry.filter(
    (law) => law.name !== WEIGHT && required(law).every((x) => suggested(x) !== null),
  );
  const forms = others.map((law) => ({
    name: law.name,
    label: law.label,
    parameters: required(law).flatMap((argument) => parametersOf(argument, neat(suggested(argument)!))),
  }));
  return [gravity(about, size, (spin * rate) / 20, byPivot), ...forms];
}

function required(law: LawEntry): LawArgument[] {
  return law.arguments.filter((argument) => !argument.optional);
}

/** A value of an argument that changes the motion visibly but slowly; null if its unit says nothing about that. */
function suggestion(
  { unit, shape, period }: LawArgument,
  rate: number,
  moment: number,
  spin: number,
): number | null {
  const turn = (2 * Math.PI) / rate;
  if (period) return 10 * turn;
  switch (unit) {
    case "1/s":
      return 0.02 / turn;
    case "N m s":
      return (0.02 * moment) / turn;
    case "N m s^2":
      return (0.02 * moment) / (turn * rate);
    case "N m":
      return shape === "bivector" ? (0.02 * spin) / turn : moment * rate ** 2;
    case "kg m^2/s":
      return spin / 2;
    case "rad/s":
      return rate / 20;
    default:
      return null;
  }
}

function parameter(
  name: string,
  label: string,
  unit: Unit,
  value: number,
  range = around(value, 50),
): Parameter {
  return { name, label, unit, value, range };
}

function parametersOf({ name, field, period, unit, shape }: LawArgument, value: number): Parameter[] {
  const shown = period ? timeUnit(value) : si(unitLabel(unit), unit);
  const size = parameter(period || field || VALUE, period ? "Period" : name, shown, value);
  if (shape !== "bivector" && shape !== "vector") return [size];
  return [parameter(AXIS, "Plane", si(""), 2, { min: 0, max: 2, scale: "linear" }), size];
}

function gravity(about: About, size: number, moment: number, byPivot: boolean): LawForm {
  const label = "Gravity, on a pivot";
  if (!byPivot) {
    const held = about.heavy ? Math.hypot(...about.heavy) : neat(moment);
    return { name: WEIGHT, label, parameters: [parameter("weight", "m g l", si("N m"), held)] };
  }
  const sides: Range = { min: -size, max: size, scale: "linear" };
  const pivot = pivotOf(about) ?? -size / 2;
  return {
    name: "gravity",
    label,
    parameters: [
      parameter("acceleration", "Acceleration", si("m/s²", "m/s^2"), acceleration(about)),
      parameter("pivot", "Pivot along e₃", lengthUnit(size), pivot, sides),
    ],
  };
}

/** The choice before any change. */
export function noLaws(): LawsChoice {
  return { from: "scene", on: new Set(), values: {} };
}

export const key = (law: LawForm, parameter: Parameter): string => `${law.name}.${parameter.name}`;

/** The tables `[torque]` and `[gravity]` of a choice made here. */
export function lawTables(choice: LawsChoice, laws: LawForm[], about: About): string {
  const torque: Parameters<typeof table>[1] = {};
  let gravity = table("gravity");
  for (const law of laws) {
    if (!choice.on.has(law.name)) continue;
    const values = new Map(
      law.parameters.map((one) => [one.name, choice.values[key(law, one)] ?? one.value]),
    );
    const axis = values.get(AXIS);
    const along = (size: number): number | number[] =>
      axis === undefined ? size : [0, 1, 2].map((k) => (k === axis ? size : 0));
    values.delete(AXIS);
    if (law.name === "gravity") {
      gravity = table("gravity", {
        acceleration: values.get("acceleration")!,
        pivot: [-about.body.solid_at[0], -about.body.solid_at[1], values.get("pivot")!],
      });
    } else if (law.name === WEIGHT) {
      torque[WEIGHT] = unitVector(about.heavy).map((part) => part * values.get("weight")!);
    } else if (values.has(VALUE)) {
      torque[law.name] = along(values.get(VALUE)!);
    } else {
      torque[law.name] = Object.fromEntries([...values].map(([name, size]) => [name, along(size)]));
    }
  }
  return table("torque", torque) + gravity;
}

/** The fixed point on e3 in the axes of the solid or mesh; else its distance below the centre of mass. */
function pivotOf({ held, body }: About): number | null {
  const arm = Math.hypot(...body.center_of_mass);
  if (!held || arm === 0) return null;
  return body.solid || body.mesh ? -body.solid_at[2] : -arm;
}

/** A number with two digits. */
function neat(value: number): number {
  return Number(value.toPrecision(2));
}

/** The acceleration of gravity by the weight of the motion, or that of the Earth. */
function acceleration(about: About): number {
  const { heavy, body } = about;
  const arm = Math.hypot(...body.center_of_mass);
  if (!heavy || body.mass === null || arm === 0) return 9.81;
  return Number((Math.hypot(...heavy) / body.mass / arm).toPrecision(12));
}

function unitVector(vector: Triple | null): Triple {
  const size = vector ? Math.hypot(...vector) : 0;
  return vector && size > 0 ? (vector.map((part) => part / size) as Triple) : [0, 0, 1];
}
