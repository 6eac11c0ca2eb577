/**
 * What the page asks of the core: the same Rust that Python calls, compiled to WebAssembly. All physics and all algebra
 * of the page come from here. Frames, signs and orders of components are those of CONVENTIONS.md: bivectors
 * (e2e3, e3e1, e1e2), rotors (1, e2e3, e3e1, e1e2), `a' = R a ~R` from body axes to space axes. SI units.
 */

/** What is wrong with what a person wrote or chose, in words meant for them, with places. */
export class Problem extends Error {}

/** Files that scenes name, by their names in the scene. */
export type Files = ReadonlyMap<string, Uint8Array>;

export interface Core {
  /** Reads a scene and follows its motion. A Problem if the scene is wrong or takes longer than `budget` seconds. */
  open(scene: string, options?: { name?: string; files?: Files; budget?: number }): Motion;
  /**
   * A motion that was followed elsewhere, at its times; between them it is interpolated, for looking only. `about` is
   * an `About` as JSON text; the scene is needed for the surface of a mesh alone.
   */
  recorded(about: string, rows: Float64Array, of?: { scene: string; name: string; files: Files }): Motion;
  /** The scene with tables replaced by those of `change`, a TOML text; an empty table takes its one away; of `run.samples = 11` that field alone. */
  merged(scene: string, change: string): string;
  /** Each line evaluated, with the names that earlier ones gave values. */
  evaluated(lines: string): Line[];
  /** The torque laws of the registry. */
  readonly laws: readonly LawEntry[];
}

/** Numbers in a row of states: see `State`. */
export const ROW = 24;

/** Where things are in a row of states. */
export const State = {
  time: 0,
  /** R, four components, body axes to space axes. */
  rotor: 1,
  /** Ω_B, rad/s. */
  omegaBody: 5,
  /** Ω_S = R Ω_B ~R, rad/s. */
  omegaSpace: 8,
  /** L_B, of the whole with wheels, kg m²/s. */
  momentumBody: 11,
  /** L_S. */
  momentumSpace: 14,
  /** Kinetic and potential, J. */
  energy: 17,
  /** Of the centre of mass, of the fixed point where there is one, m. */
  position: 18,
  /** m/s. */
  velocity: 21,
} as const;

export interface Motion {
  readonly about: About;
  /**
   * Rows of states at times of any order. Exact motions know all times within `about.horizon` of the start, others
   * those from the start on for `about.duration`; a Problem for any other.
   */
  states(times: ArrayLike<number>): Float64Array;
  /** The surface of a mesh body in body axes, m: vertices (n × 3) and triangles (m × 3); null for others. */
  surface(): { vertices: Float64Array; faces: Uint32Array } | null;
  /** The first bodies of an ensemble: rotors (n × 4) at a time, body axes to space axes; n at most `count`. */
  bodies(time: number, count: number): Float64Array;
  close(): void;
}

export type Solid =
  | { kind: "box"; lengths: Triple }
  | { kind: "ellipsoid"; semi_axes: Triple }
  | { kind: "sphere"; radius: number }
  | { kind: "hollow_sphere"; outer_radius: number; inner_radius: number }
  | { kind: "cylinder" | "cone" | "capsule"; radius: number; height: number }
  | { kind: "rod"; length: number }
  | { kind: "disc"; radius: number }
  | { kind: "torus"; major_radius: number; minor_radius: number };

export type Triple = [number, number, number];
export type Quadruple = [number, number, number, number];

/** What is known of a motion besides its states. */
export interface About {
  title: string | null;
  body: {
    /** kg; null where nobody said it. */
    mass: number | null;
    /** In body axes, m; under gravity from the fixed point, the origin. */
    center_of_mass: Triple;
    /** About the centre of mass, or the fixed point if `held`, kg m². */
    moments: Triple;
    /** The rotor from principal axes to body axes. */
    frame: Quadruple;
    /** The solid that the scene says; its axes are the body's. */
    solid: Solid | null;
    /** Where the origin of that solid, or of the mesh, is in body axes. */
    solid_at: Triple;
    /** Whether `surface()` has a mesh. */
    mesh: boolean;
  };
  /** Whether the body is held at a fixed point, the origin of body axes. */
  held: boolean;
  /** The heavy law's vector m g (centre of mass) in body axes, N m; null without weight. */
  heavy: Triple | null;
  /** What turns the body: the name of each law, and its formula or its arguments as text. */
  laws: { name: string; text: string }[];
  /** The initial state, as the scene says it. */
  start: { rotor: Quadruple; omega_body: Triple; time: number };
  duration: number;
  samples: number;
  /** `exact`, the name of a method of steps, or `recorded`. */
  method: string;
  exact: boolean;
  /** Exact motions are known so far from the start, s; null where any time will do. */
  horizon: number | null;
  steps: number;
  error_estimate: number | null;
  /** What is conserved: its value at the start in SI, and its largest relative change. */
  conserved: { name: string; value: number; drift: number }[];
  norm_drift: number;
  /** Of a free body: the kind of motion in words, and its times in s, null where there is none. */
  free: {
    regime: string;
    modulus: number;
    axis: 1 | 2 | 3;
    period: number | null;
    precession_period: number | null;
    flip_time: number | null;
  } | null;
  /** Of a symmetric top under its weight alone: the kind of motion in words, angles in rad, rates in rad/s, s. */
  top: {
    regime: string;
    /** Smallest and largest angle of the axis from up. */
    tilt: [number, number];
    nutation_period: number | null;
    /** Mean rate about e3. */
    precession_rate: number | null;
    /** The spin from which on an upright top sleeps. */
    critical_spin: number;
    sleeps: boolean;
  } | null;
  /** How many bodies an ensemble has; null for one body. */
  ensemble: number | null;
}

/** What a line of the page of algebra came to. */
export interface Line {
  /** The line as it was written. */
  text: string;
  /** The name that got the value; null if none did. */
  name: string | null;
  /** The formula in canonical spelling, and as LaTeX. */
  shown: string | null;
  latex: string | null;
  /** The value: components (1, e1, e2, e3, e2e3, e3e1, e1e2, I) and the grades that it can have. */
  value: { components: number[]; grades: number[]; rotor: boolean; text: string } | null;
  /** Of an equation: whether it holds, the largest difference of the sides and the size of the terms. */
  equation: { holds: boolean; residual: number; size: number } | null;
  /** What is wrong, and where in the text, in UTF-16 units. */
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
