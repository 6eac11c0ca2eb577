import type { About, Quadruple, Solid, Triple } from "../core/core.ts";
import { table } from "./toml.ts";

/** A body as the controls have it. */
export interface BodyChoice {
  /** The scene's own, masses along the axes, or a solid. */
  form: "scene" | "masses" | Solid["kind"];
  /** The sizes of the solid, if it is one. */
  solid: Solid | null;
  /** The solid when its form was chosen, to which sizes are compared. */
  first: Solid | null;
  /** kg, or kg/m³. */
  amount: { kind: "mass" | "density"; value: number };
  /** ∫x_k² dm along three axes at right angles, kg m²: any three that are not negative are those of a body. */
  spread: Triple;
  /** The rotor that turns body axes to those three; null where they are the same. */
  frame: Quadruple | null;
}

/** The sizes of each solid by the names of the scene, with the words for them. */
export const SIZES: Record<Solid["kind"], [name: string, label: string][]> = {
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
    ["height", "Height between"],
  ],
  rod: [["length", "Length"]],
  disc: [["radius", "Radius"]],
  torus: [
    ["major_radius", "Radius of the ring"],
    ["minor_radius", "Radius of the tube"],
  ],
};

/** Solids without a volume: they have a mass, not a density. */
export const thin = (form: BodyChoice["form"]): boolean => form === "rod" || form === "disc";

/** The body of a motion, to be varied. */
export function bodyOf(about: About): BodyChoice {
  const { solid, mass, moments, frame } = about.body;
  // Principal axes are often those of the body in another order.
  const matrix = inBodyAxes(moments, frame);
  const size = Math.max(...moments);
  const aligned = matrix.every((row, i) =>
    row.every((entry, j) => i === j || Math.abs(entry) < 1e-12 * size),
  );
  return {
    form: solid ? solid.kind : "scene",
    solid,
    first: solid,
    amount: { kind: "mass", value: mass ?? 1 },
    spread: spreadOf(aligned ? [matrix[0]![0], matrix[1]![1], matrix[2]![2]] : moments),
    frame: aligned ? null : frame,
  };
}

/** ∫x_k² dm from the moments, each of which is the sum of two of them. */
export function spreadOf([i1, i2, i3]: Triple): Triple {
  const half = (i1 + i2 + i3) / 2;
  return [Math.max(half - i1, 0), Math.max(half - i2, 0), Math.max(half - i3, 0)];
}

/** The same body with another form, of about the same size. */
export function reshaped(choice: BodyChoice, form: BodyChoice["form"]): BodyChoice {
  if (form === "scene" || form === "masses") return { ...choice, form };
  const amount =
    thin(form) && choice.amount.kind === "density" ? { kind: "mass" as const, value: 1 } : choice.amount;
  const solid = solidOf(form, extents(choice));
  return { ...choice, form, amount, solid, first: solid };
}

/** A size of a solid, by its name in `SIZES`. */
export function sizeOf(solid: Solid, name: string): number {
  const [field, index] = name.split(".") as [string, string | undefined];
  const value = (solid as unknown as Record<string, number | Triple>)[field]!;
  return typeof value === "number" ? value : value[Number(index)]!;
}

/** The solid with another size. */
export function resized(solid: Solid, name: string, size: number): Solid {
  const [field, index] = name.split(".") as [string, string | undefined];
  const old = (solid as unknown as Record<string, number | Triple>)[field]!;
  const value = typeof old === "number" ? size : old.map((other, k) => (k === Number(index) ? size : other));
  return { ...solid, [field]: value } as Solid;
}

/** The table `[body]` of a choice. */
export function bodyTable(choice: BodyChoice): string {
  const { form, solid, amount, spread, frame } = choice;
  if (form === "masses" || !solid) {
    const [a, b, c] = spread;
    const moments: Triple = [b + c, c + a, a + b];
    const shape = frame ? { inertia: inBodyAxes(moments, frame) } : { moments };
    return table("body", { ...shape, mass: amount.kind === "mass" ? amount.value : 1 });
  }
  const { kind, ...sizes } = solid;
  return table("body", { solid: kind, ...sizes, [amount.kind]: amount.value });
}

/** Whole lengths along the axes: of the solid, or of a box with these masses. */
function extents(choice: BodyChoice): Triple {
  const solid = choice.solid;
  switch (solid?.kind) {
    case "box":
      return solid.lengths;
    case "ellipsoid":
      return solid.semi_axes.map((axis) => 2 * axis) as Triple;
    case "sphere":
      return [2 * solid.radius, 2 * solid.radius, 2 * solid.radius];
    case "hollow_sphere":
      return [2 * solid.outer_radius, 2 * solid.outer_radius, 2 * solid.outer_radius];
    case "cylinder":
    case "cone":
      return [2 * solid.radius, 2 * solid.radius, solid.height];
    case "capsule":
      return [2 * solid.radius, 2 * solid.radius, solid.height + 2 * solid.radius];
    case "rod":
      return [solid.length / 10, solid.length / 10, solid.length];
    case "disc":
      return [2 * solid.radius, 2 * solid.radius, solid.radius / 10];
    case "torus": {
      const across = 2 * (solid.major_radius + solid.minor_radius);
      return [across, across, 2 * solid.minor_radius];
    }
    case undefined: {
      const mass = choice.amount.kind === "mass" ? choice.amount.value : 1;
      const lengths = choice.spread.map((spread) => Math.sqrt((12 * spread) / mass));
      const least = Math.max(...lengths) / 50;
      return lengths.map((length) => Number(Math.max(length, least).toPrecision(3))) as Triple;
    }
  }
}

function solidOf(kind: Solid["kind"], [x, y, z]: Triple): Solid {
  const radius = (x + y) / 4;
  switch (kind) {
    case "box":
      return { kind, lengths: [x, y, z] };
    case "ellipsoid":
      return { kind, semi_axes: [x / 2, y / 2, z / 2] };
    case "sphere":
      return { kind, radius: (x + y + z) / 6 };
    case "hollow_sphere":
      return { kind, outer_radius: (x + y + z) / 6, inner_radius: (x + y + z) / 8 };
    case "cylinder":
    case "cone":
      return { kind, radius, height: z };
    case "capsule":
      return { kind, radius, height: Math.max(z - 2 * radius, radius / 10) };
    case "rod":
      return { kind, length: Math.max(x, y, z) };
    case "disc":
      return { kind, radius };
    case "torus": {
      const tube = Math.min(z / 2, radius / 3);
      return { kind, major_radius: radius - tube, minor_radius: tube };
    }
  }
}

/** The matrix of the moments in body axes, into which the rotor `frame` turns principal ones. */
function inBodyAxes(moments: Triple, [w, b1, b2, b3]: Quadruple): Triple[] {
  // The columns are the principal axes: the rotor w − x e2e3 − y e3e1 − z e1e2 is the quaternion w + xi + yj + zk.
  const [x, y, z] = [-b1, -b2, -b3];
  const axes: Triple[] = [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
  ];
  const entry = (i: number, j: number): number =>
    moments.reduce((sum, moment, k) => sum + axes[i]![k]! * moment * axes[j]![k]!, 0);
  return [0, 1, 2].map((i) => [0, 1, 2].map((j) => entry(Math.min(i, j), Math.max(i, j))) as Triple);
}
