import type { About, Triple } from "../core/core.ts";
import { lengthUnit, si, timeUnit, type Unit } from "../format/units.ts";
import { around, type Range } from "../inputs/range.ts";
import { table } from "./toml.ts";

/** What turns the body, as the controls have it: nothing but what the scene says, or laws that are chosen here. */
export interface LawsChoice {
  from: "scene" | "here";
  /** The laws that are on. */
  on: ReadonlySet<LawName>;
  /** Each parameter by its law and name, in SI. */
  values: Record<string, number>;
}

export type LawName =
  | "gravity"
  | "heavy"
  | "damping"
  | "viscous_damping"
  | "constant_body"
  | "constant_space"
  | "torsion_spring"
  | "gyrostat"
  | "gravity_gradient";

export interface Parameter {
  name: string;
  label: string;
  unit: Unit;
  range: Range;
  value: number;
}

/** A law that can be chosen, with parameters of the size that this body feels. */
export interface LawForm {
  name: LawName;
  label: string;
  parameters: Parameter[];
}

/** The axes of a law with one: a parameter of values 0, 1, 2. */
export const AXIS = "axis";

/**
 * The laws for a body: gravity in terms of its pivot where `pivot` says that a change of it is understood, else of the
 * torque that the weight exerts. `size` is the body's in m.
 */
export function lawsFor(about: About, momentum: number, size: number, byPivot: boolean): LawForm[] {
  const rate = Math.hypot(...about.start.omega_body) || 1;
  const moment = Math.max(...about.body.moments);
  const turn = (2 * Math.PI) / rate;
  const spin = momentum || moment * rate;
  const parameter = (name: string, label: string, unit: Unit, value: number, range?: Range): Parameter => {
    return { name, label, unit, value, range: range ?? around(value, 50) };
  };
  const axis = parameter(AXIS, "Plane", si(""), 2, { min: 0, max: 2, scale: "linear" });
  const held = about.heavy ? Math.hypot(...about.heavy) : neat((spin * rate) / 20);
  const sides: Range = { min: -size, max: size, scale: "linear" };
  const pivot = pivotOf(about) ?? -size / 2;
  const gravity: LawForm = byPivot
    ? {
        name: "gravity",
        label: "Gravity, on a pivot",
        parameters: [
          parameter("acceleration", "Acceleration", si("m/s²", "m/s^2"), acceleration(about)),
          {
            name: "pivot",
            label: "Pivot along e₃",
            unit: lengthUnit(size),
            value: pivot,
            range: sides,
          },
        ],
      }
    : {
        name: "heavy",
        label: "Gravity, on a pivot",
        parameters: [parameter("weight", "m g l", si("N m"), held)],
      };
  return [
    gravity,
    {
      name: "damping",
      label: "Damping −g L",
      parameters: [parameter("rate", "g", si("1/s"), neat(0.02 / turn))],
    },
    {
      name: "viscous_damping",
      label: "Viscous damping −d Ω",
      parameters: [parameter("size", "d", si("N m s"), neat((0.02 * moment) / turn))],
    },
    {
      name: "constant_body",
      label: "Constant, in the body",
      parameters: [axis, parameter("size", "Size", si("N m"), neat((0.02 * spin) / turn))],
    },
    {
      name: "constant_space",
      label: "Constant, in space",
      parameters: [axis, parameter("size", "Size", si("N m"), neat((0.02 * spin) / turn))],
    },
    {
      name: "torsion_spring",
      label: "Torsion spring −k Θ",
      parameters: [parameter("stiffness", "k", si("N m/rad"), neat(moment * rate ** 2))],
    },
    {
      name: "gyrostat",
      label: "Wheel in the body",
      parameters: [axis, parameter("momentum", "Its momentum", si("N m s"), neat(spin / 2))],
    },
    {
      name: "gravity_gradient",
      label: "Gravity gradient, on an orbit",
      parameters: [parameter("period", "Period", timeUnit(10 * turn), neat(10 * turn))],
    },
  ];
}

/** What the controls begin with. */
export function noLaws(): LawsChoice {
  return { from: "scene", on: new Set(), values: {} };
}

export const key = (law: LawForm, parameter: Parameter): string => `${law.name}.${parameter.name}`;

/** The tables `[torque]` and `[gravity]` of a choice made here. */
export function lawTables(choice: LawsChoice, laws: LawForm[], about: About): string {
  const torque: Record<string, number | string | number[] | { stiffness: number } | { period: number }> = {};
  let gravity = table("gravity");
  for (const law of laws) {
    if (!choice.on.has(law.name)) continue;
    const value = (name: string): number => {
      const parameter = law.parameters.find((one) => one.name === name)!;
      return choice.values[key(law, parameter)] ?? parameter.value;
    };
    const along = (size: number): number[] => [0, 1, 2].map((k) => (k === value(AXIS) ? size : 0));
    switch (law.name) {
      case "gravity":
        gravity = table("gravity", {
          acceleration: value("acceleration"),
          pivot: [-about.body.solid_at[0], -about.body.solid_at[1], value("pivot")],
        });
        break;
      case "heavy":
        torque["heavy"] = unitVector(about.heavy).map((part) => part * value("weight"));
        break;
      case "damping":
        torque["damping"] = value("rate");
        break;
      case "viscous_damping":
        torque["viscous_damping"] = value("size");
        break;
      case "constant_body":
      case "constant_space":
        torque[law.name] = along(value("size"));
        break;
      case "torsion_spring":
        torque["torsion_spring"] = { stiffness: value("stiffness") };
        break;
      case "gyrostat":
        torque["gyrostat"] = along(value("momentum"));
        break;
      case "gravity_gradient":
        torque["gravity_gradient"] = { period: value("period") };
        break;
    }
  }
  return table("torque", torque) + gravity;
}

/** Where the fixed point is on e3: in the axes of the solid or mesh, or as far below the centre of mass. */
function pivotOf({ held, body }: About): number | null {
  const arm = Math.hypot(...body.center_of_mass);
  if (!held || arm === 0) return null;
  return body.solid || body.mesh ? -body.solid_at[2] : -arm;
}

/** A suggestion needs no more than two digits. */
function neat(value: number): number {
  return Number(value.toPrecision(2));
}

/** Of gravity, from the weight that the motion tells; that of the Earth where there is none. */
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
