/**
 * The values that the page exchanges with the core (`wasm.ts`): the Rust code that Python calls, compiled to WebAssembly.
 * All physics and all algebra of the page come from it. Frames, signs and orders of components follow CONVENTIONS.md: bivectors (e2e3, e3e1, e1e2),
 * rotors (1, e2e3, e3e1, e1e2), `a' = R a ~R` from body axes to space axes. SI units.
 */

/** An error in the user's input, with a message for the user. */
export class Problem extends Error {}

/** Files that scenes name, by their names in the scene. */
export type Files = ReadonlyMap<string, Uint8Array>;

/** Maximum number of bodies of an ensemble that are drawn. */
export const BODIES = 1000;

/** Numbers per row of states. */
export const ROW = 24;

/** Offsets in a row of states. */
export const State = {
  time: 0,
  /** R, four components, body axes to space axes. */
  rotor: 1,
  /** Ω_B, rad/s. */
  omegaBody: 5,
  /** Ω_S = R Ω_B ~R, rad/s. */
  omegaSpace: 8,
  /** L_B with that of wheels, kg m²/s. */
  momentumBody: 11,
  /** L_S. */
  momentumSpace: 14,
  /** Kinetic and potential energy, J. */
  energy: 17,
  /** Of the centre of mass, or of the fixed point if there is one, m. */
  position: 18,
  /** m/s. */
  velocity: 21,
} as const;

/** The size of the vector or bivector at an offset. */
export function sizeAt(numbers: ArrayLike<number>, at: number): number {
  return Math.hypot(numbers[at]!, numbers[at + 1]!, numbers[at + 2]!);
}

/** A triangle mesh, m: vertices (n × 3), triangles (m × 3), and a tint per triangle (see crates/rigid, `Tint`). */
export interface Surface {
  vertices: Float64Array;
  faces: Uint32Array;
  tints: Uint32Array;
}

/** Whether the mass is known. Moments without a mass are often ratios: then L and E have no units. */
export function hasMass({ body }: About): boolean {
  return body.mass !== null;
}

/** A uniform solid: its kind, and its dimensions in m by their names in scenes. */
export type Solid = { kind: string; [dimension: string]: string | number | Triple };

export type Triple = [number, number, number];
export type Quadruple = [number, number, number, number];

/** Properties of a motion besides its states. */
export interface About {
  title: string | null;
  /** What the motion shows, in words. */
  caption: string | null;
  body: {
    /** kg; null if unknown. */
    mass: number | null;
    /** In body axes, m; under gravity from the fixed point, the origin. */
    center_of_mass: Triple;
    /** About the centre of mass, or about the fixed point if `held`, kg m². */
    moments: Triple;
    /** The rotor from principal axes to body axes. */
    frame: Quadruple;
    /** The solid that the scene gives, in its body axes. */
    solid: Solid | null;
    /** The origin of that solid, or of the mesh, in body axes. */
    solid_at: Triple;
    /** Whether the body is given by a mesh. */
    mesh: boolean;
  };
  /** Whether the body is held at a fixed point, the origin of body axes. */
  held: boolean;
  /** The vector m g (centre of mass) of the heavy law in body axes, N m; null without weight. */
  heavy: Triple | null;
  /** The torque laws: the name of each, and its formula or its arguments as text. */
  laws: { name: string; text: string }[];
  /** The initial state of the scene. */
  start: { rotor: Quadruple; omega_body: Triple; time: number };
  duration: number;
  samples: number;
  /** `exact`, `recorded`, or the name of a stepping method. */
  method: string;
  exact: boolean;
  /** How far from the start an exact motion is known, s; null if at all times. */
  horizon: number | null;
  steps: number;
  error_estimate: number | null;
  /** Conserved quantities: initial value in SI units, and largest relative change. */
  conserved: { name: string; value: number; drift: number }[];
  norm_drift: number;
  /** Of a free body: regime, and periods in s, null where there is none. */
  free: {
    regime: string;
    modulus: number;
    axis: 1 | 2 | 3;
    period: number | null;
    precession_period: number | null;
    flip_time: number | null;
  } | null;
  /** Of a heavy symmetric top: regime, angles in rad, rates in rad/s, period in s. */
  top: {
    regime: string;
    /** Smallest and largest angle between the axis and the vertical. */
    tilt: [number, number];
    nutation_period: number | null;
    /** Mean rate about e3. */
    precession_rate: number | null;
    /** The least spin at which the upright top is stable. */
    critical_spin: number;
    sleeps: boolean;
  } | null;
  /** Number of bodies of an ensemble; null for one body. */
  ensemble: number | null;
  /** Events of a recorded motion, with their times in s. */
  events?: { name: string; time: number }[];
}

/** What acts on the body in a state. */
export interface Acting {
  /** Axial vector of the torque in space, N m. */
  torque: Triple;
  /** Vectors that the laws depend on, in space or in body axes. Without a unit, `along` is a direction. */
  sources: {
    kind: "planet" | "field" | "dipole" | "sun" | "wheel";
    in_space: boolean;
    along: Triple;
    unit: string;
  }[];
  /** Forces of thrusters, N, and where they act, m, in body axes. */
  thrusts: { along: Triple; at: Triple }[];
}

/** The result of a line of formulas. */
export interface Line {
  /** The line as written. */
  text: string;
  /** The name that the line defines; null if none. */
  name: string | null;
  /** The formula in canonical spelling, and as LaTeX. */
  shown: string | null;
  latex: string | null;
  /** The value: components (1, e1, e2, e3, e2e3, e3e1, e1e2, I) and the grades that it may have. */
  value: { components: number[]; grades: number[]; rotor: boolean; text: string } | null;
  /** Of an equation: whether it holds, the largest difference between its sides, and the size of its terms. */
  equation: { holds: boolean; residual: number; size: number } | null;
  /** An error and its place in the text, in UTF-16 units. */
  problem: { message: string; start: number; end: number } | null;
}

/** A torque law of the registry: see crates/rigid/src/laws/registry. */
export interface LawEntry {
  /** Its field in `[torque]` of a scene. */
  name: string;
  label: string;
  formula: string;
  arguments: LawArgument[];
}

export interface LawArgument {
  name: string;
  /** Its field in the table of the law; empty if the law is this value alone. */
  field: string;
  /** SI; empty for pure numbers. */
  unit: string;
  shape: "scalar" | "vector" | "bivector" | "gains" | "rotor" | "numbers" | "bivectors" | "word";
  /** The field that gives 2π over a rate instead; empty if there is none. */
  period: string;
  optional: boolean;
}
