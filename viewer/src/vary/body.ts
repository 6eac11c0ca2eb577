import type { About, Quadruple, Solid, Triple } from "../core/core.ts";
import type { Core, Motion } from "../core/wasm.ts";
import { table } from "./toml.ts";

/** The body chosen by the controls. */
export interface BodyChoice {
  /** `scene`, the body of the scene; `masses`, a body given by its second moments; or the kind of a solid. */
  form: string;
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

const LISTS: Record<string, string> = { lengths: "Length along", semi_axes: "Semi-axis" };

/** The names of the dimensions of a solid, `radius`, or `lengths.0` for the first of several, with labels. */
export function dimensions({ kind: _, ...sizes }: Solid): [name: string, label: string][] {
  return Object.entries(sizes).flatMap(([name, size]): [string, string][] =>
    size instanceof Array
      ? size.map((_, k) => [`${name}.${k}`, `${LISTS[name]} e${"₁₂₃"[k]}`])
      : [[name, name[0]!.toUpperCase() + name.slice(1).replace("_", " ")]],
  );
}

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
  // Four digits, as those of sliders.
  const solid = JSON.parse(JSON.stringify(core.solid(form, motion.extents())), (_, value: unknown) =>
    typeof value === "number" ? Number(value.toPrecision(4)) : value,
  ) as Solid;
  return { ...choice, form, amount, solid, first: solid };
}

/** A dimension of a solid by its name in `dimensions`. */
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
