import type { About, Quadruple, Solid, SolidKind, Triple } from "../core/core.ts";
import type { Core, Motion } from "../core/wasm.ts";
import { table } from "./toml.ts";

/** The body chosen by the controls. */
export interface BodyChoice {
  /** The body of the scene, a body given by its second moments, or a solid. */
  form: "scene" | "masses" | SolidKind;
  /** The dimensions of the solid, if it is one. */
  solid: Solid | null;
  /** The solid when its form was chosen; the sliders take their ranges from it. */
  first: Solid | null;
  /** kg, or kg/m³. */
  amount: { kind: "mass" | "density"; value: number };
  /** The second moments ∫x_k² dm along three orthogonal axes, kg m²: any three non-negative numbers are a body. */
  spread: Triple;
  /** The rotor from those axes to body axes; null where they are the body axes. */
  frame: Quadruple | null;
}

/** The dimensions of each solid: `radius`, or `lengths.0` for the first of several, with labels. */
export const SIZES: Record<SolidKind, [name: string, label: string][]> = {
  box: [
    ["lengths.0", "Side along e₁"],
    ["lengths.1", "Side along e₂"],
    ["lengths.2", "Side along e₃"],
  ],
  ellipsoid: [
    ["semi_axes.0", "Semi-axis e₁"],
    ["semi_axes.1", "Semi-axis e₂"],
    ["semi_axes.2", "Semi-axis e₃"],
  ],
  sphere: [["radius", "Radius"]],
  hollow_sphere: [
    ["outer_radius", "Outer radius"],
    ["inner_radius", "Inner radius"],
  ],
  cylinder: [
    ["radius", "Radius"],
    ["height", "Height"],
  ],
  cone: [
    ["radius", "Radius"],
    ["height", "Height"],
  ],
  capsule: [
    ["radius", "Radius"],
    ["height", "Cylinder height"],
  ],
  rod: [["length", "Length"]],
  disc: [["radius", "Radius"]],
  torus: [
    ["major_radius", "Ring radius"],
    ["minor_radius", "Tube radius"],
  ],
};

/** Solids without a volume have a mass but no density. */
export const isThin = (form: BodyChoice["form"]): boolean => form === "rod" || form === "disc";

/** The body of a motion as the initial choice. */
export function bodyOf({ body }: About, core: Core): BodyChoice {
  return {
    form: body.solid ? body.solid.kind : "scene",
    solid: body.solid,
    first: body.solid,
    amount: { kind: "mass", value: body.mass ?? 1 },
    ...core.secondMoments(body.moments, body.frame),
  };
}

/** The same choice with another form of about the same size. */
export function reshaped(
  choice: BodyChoice,
  form: BodyChoice["form"],
  core: Core,
  motion: Motion,
): BodyChoice {
  if (form === "scene" || form === "masses") return { ...choice, form };
  const massOnly = isThin(form) && choice.amount.kind === "density";
  const amount = massOnly ? { kind: "mass" as const, value: 1 } : choice.amount;
  const solid = core.solid(form, motion.extents());
  return { ...choice, form, amount, solid, first: solid };
}

/** A dimension of a solid by its name in `SIZES`. */
export function sizeOf(solid: Solid, name: string): number {
  const [field, index] = name.split(".");
  const value = solid[field!] as number | Triple;
  return typeof value === "number" ? value : value[Number(index)]!;
}

/** The solid with another dimension. */
export function resized(solid: Solid, name: string, size: number): Solid {
  const [field, index] = name.split(".");
  const old = solid[field!] as number | Triple;
  const value = typeof old === "number" ? size : (old.with(Number(index), size) as Triple);
  return { ...solid, [field!]: value };
}

/** The table `[body]` of a choice. */
export function bodyTable({ form, solid, amount, spread, frame }: BodyChoice, core: Core): string {
  if (form === "masses" || !solid) {
    const mass = amount.kind === "mass" ? amount.value : 1;
    const inertia = core.inertia(spread, frame ?? [1, 0, 0, 0]);
    return table("body", frame ? { inertia, mass } : { moments: inertia.map((row, k) => row[k]!), mass });
  }
  const { kind, ...sizes } = solid;
  return table("body", { solid: kind, ...sizes, [amount.kind]: amount.value });
}
