import {
  type About,
  type Acting,
  BODIES,
  type Files,
  type LawEntry,
  type Line,
  Problem,
  type Quadruple,
  type Solid,
  type Surface,
  type Triple,
} from "./core.ts";

/** The exports of the core: see crates/wasm/src/exports.rs. */
interface Exports {
  memory: WebAssembly.Memory;
  room(size: number): number;
  reply(): number;
  reply_size(): number;
  open(budget: number): number;
  record(): number;
  close(handle: number): void;
  about_motion(handle: number): number;
  acting(handle: number): number;
  states(handle: number): number;
  surface(handle: number): number;
  extents(handle: number): number;
  bodies(handle: number, time: number, count: number, budget: number): number;
  bodies_problem(handle: number): number;
  slice(handle: number, from: number, to: number, budget: number): number;
  join(handle: number): number;
  merge(): number;
  evaluate(): number;
  solid(): number;
  second_moments(): number;
  inertia(): number;
  attitude(): number;
  plane_angle(): number;
  law_registry(): number;
}

/** Default limit on the time to solve a scene, s. */
const BUDGET = 10;

/** What the core needs from the page. */
const IMPORTS = { page: { now: () => performance.now() / 1000 } };

/** Bytes of a page of WebAssembly memory. */
const PAGE = 65_536;

type Given = string | Uint8Array | Float64Array | readonly number[];

/** The core. What a call takes is put into rooms first; its reply is read afterwards. */
export class Core {
  readonly exports: Exports;
  private registry: readonly LawEntry[] | null = null;

  private constructor(
    readonly module: WebAssembly.Module,
    instance: WebAssembly.Instance,
  ) {
    this.exports = instance.exports as unknown as Exports;
  }

  /** A core with a memory of its own; with that of another one if `memory` is a copy of it. */
  static async of(module: WebAssembly.Module, memory?: ArrayBuffer): Promise<Core> {
    const core = new Core(module, await WebAssembly.instantiate(module, IMPORTS));
    if (!memory) return core;
    // A core at rest is its memory: between calls its stack is empty.
    const own = core.exports.memory;
    own.grow(Math.max(0, (memory.byteLength - own.buffer.byteLength) / PAGE));
    new Uint8Array(own.buffer).set(new Uint8Array(memory));
    return core;
  }

  /** A copy of the memory, with all motions in it. */
  memory(): ArrayBuffer {
    return this.exports.memory.buffer.slice(0);
  }

  /** The torque laws of the registry. */
  get laws(): readonly LawEntry[] {
    if (this.registry) return this.registry;
    this.call(this.exports.law_registry);
    return (this.registry = this.json<LawEntry[]>());
  }

  /** Solves a scene. A Problem if the scene is wrong or takes longer than `budget` seconds. */
  open(
    scene: string,
    {
      name = "scene.toml",
      files = new Map(),
      budget = BUDGET,
    }: Partial<{ name: string; files: Files; budget: number }> = {},
  ): Motion {
    const handle = this.call(() => this.exports.open(budget), scene, name, ...[...files].flat());
    this.call(() => this.exports.about_motion(handle));
    return new Motion(this, handle, this.json());
  }

  /**
   * A motion computed elsewhere, as rows of states, which are interpolated for display. `about` is an `About` as JSON
   * text; the scene gives the surface of the body.
   */
  recorded(about: string, rows: Float64Array, of?: { scene: string; name: string; files: Files }): Motion {
    const scene = of ? [of.scene, of.name, ...[...of.files].flat()] : [];
    return new Motion(this, this.call(this.exports.record, rows, ...scene), JSON.parse(about) as About);
  }

  /**
   * The scene with tables replaced by those of `change`, a TOML text. An empty table removes that of the scene; a dotted
   * key such as `run.samples` replaces one field.
   */
  merged(scene: string, change: string): string {
    this.call(this.exports.merge, scene, change);
    return this.text();
  }

  /** Evaluates lines of formulas, each with the names that earlier lines define. */
  evaluated(lines: string): Line[] {
    this.call(this.exports.evaluate, lines);
    return this.json();
  }

  /** The solid of a kind that fills a box of these side lengths, m. */
  solid(kind: string, lengths: Triple): Solid {
    this.call(this.exports.solid, kind, lengths);
    return this.json();
  }

  /**
   * The second moments ∫x_k² dm, kg m², of a body with these principal moments and this frame: along the body axes if
   * they are principal axes, with a null frame, and along the principal axes otherwise.
   */
  secondMoments(moments: Triple, frame: Quadruple): { spread: Triple; frame: Quadruple | null } {
    this.call(this.exports.second_moments, [...moments, ...frame]);
    const [a, b, c, ...rest] = this.floats();
    return { spread: [a!, b!, c!], frame: rest.length > 0 ? (rest as Quadruple) : null };
  }

  /** The inertia matrix in body axes of a body with second moments along axes, which a rotor takes to body axes. */
  inertia(spread: Triple, frame: Quadruple): Triple[] {
    this.call(this.exports.inertia, [...spread, ...frame]);
    const rows = [...this.floats()];
    return [0, 3, 6].map((k) => rows.slice(k, k + 3) as Triple);
  }

  /** The angles of the rotor exp(−½ turn e1e2) exp(−½ tilt e2e3) exp(−½ roll e1e2), rad. */
  attitude(rotor: Quadruple): { turn: number; tilt: number; roll: number } {
    this.call(this.exports.attitude, rotor);
    const [turn, tilt, roll] = [...this.floats()] as Triple;
    return { turn, tilt, roll };
  }

  /** The unit plane and the angle, from 0 to 2π, of a rotor. */
  planeAngle(rotor: Quadruple): { plane: Triple; angle: number } {
    this.call(this.exports.plane_angle, rotor);
    const [x, y, z, angle] = [...this.floats()] as Quadruple;
    return { plane: [x, y, z], angle };
  }

  /**
   * Puts what an export takes, calls it, and returns its code. A Problem if the call reports one, or if the core crashed
   * and cannot be used again.
   */
  call(run: () => number, ...given: Given[]): number {
    for (const one of given) {
      const content = typeof one === "string" ? new TextEncoder().encode(one) : one;
      const { buffer, byteOffset, byteLength } =
        content instanceof Array ? Float64Array.from(content) : content;
      const place = this.exports.room(byteLength);
      new Uint8Array(this.exports.memory.buffer, place).set(new Uint8Array(buffer, byteOffset, byteLength));
    }
    let code: number;
    try {
      code = run();
    } catch (error) {
      throw new Problem(`the core failed (${String(error)}); reload the page`);
    }
    if (code < 0) throw new Problem(this.text());
    return code;
  }

  /** A copy of the reply. */
  bytes(): ArrayBuffer {
    const { memory, reply, reply_size } = this.exports;
    return memory.buffer.slice(reply(), reply() + reply_size());
  }

  floats(): Float64Array {
    return new Float64Array(this.bytes());
  }

  text(from = 0): string {
    return new TextDecoder().decode(new Uint8Array(this.bytes(), from));
  }

  json<T>(): T {
    return JSON.parse(this.text()) as T;
  }
}

/** Bodies of an ensemble, computed apart from the others. */
export interface Slice {
  from: number;
  to: number;
  rotors: Uint8Array;
  /** Why the first body that is not known is not; empty if all are. */
  problem: string;
}

/** The motion of a scene, or a recorded one. */
export class Motion {
  /** Whether the bodies of its ensemble are still being computed elsewhere. */
  awaitsBodies = false;

  constructor(
    private readonly core: Core,
    readonly handle: number,
    readonly about: About,
  ) {}

  /**
   * Rows of states at times in any order; a Problem for times at which the motion is not known. Exact motions are known
   * within `about.horizon` of the start, others for `about.duration` from the start on.
   */
  states(times: ArrayLike<number>): Float64Array {
    this.core.call(() => this.core.exports.states(this.handle), Float64Array.from(times));
    return this.core.floats();
  }

  /** What acts on the body in the state of a row; a Problem for a recorded motion. */
  acting(row: Float64Array): Acting {
    this.core.call(() => this.core.exports.acting(this.handle), row.slice());
    return this.core.json();
  }

  /**
   * The surface of the body in body axes; where only its moments are known, that of an equivalent box, ball or spinning
   * top. `arm` points from the fixed point to the centre of mass, m.
   */
  surface(arm: Triple): Surface {
    const size = 3 * this.core.call(() => this.core.exports.surface(this.handle), this.body(arm));
    const reply = this.core.bytes();
    const rest = new Uint32Array(reply, 8 * size);
    const faces = (3 * rest.length) / 4;
    return {
      vertices: new Float64Array(reply, 0, size),
      faces: rest.subarray(0, faces),
      tints: rest.subarray(faces),
    };
  }

  /** The side lengths of a box around the body, m. */
  extents(): Triple {
    this.core.call(() => this.core.exports.extents(this.handle), this.body([0, 0, 0]));
    return [...this.core.floats()] as Triple;
  }

  /**
   * The first bodies of an ensemble: rotors (n × 4) at a time, body axes to space axes, NaN for those that are not known;
   * n at most `count`. The first call computes them, unless they were joined.
   */
  bodies(time: number, count = BODIES): Float64Array {
    this.core.call(() => this.core.exports.bodies(this.handle, time, count, BUDGET));
    return this.core.floats();
  }

  /** Why the first of these bodies that are not known is not; empty if all are. */
  get bodiesProblem(): string {
    this.core.call(() => this.core.exports.bodies_problem(this.handle));
    return this.core.text();
  }

  /** Computes the bodies of an ensemble without a closed form from number `from` up to `to`, for `join`. */
  slice(from: number, to: number, budget = BUDGET): Slice {
    const size = this.core.call(() => this.core.exports.slice(this.handle, from, to, budget));
    return { from, to, rotors: new Uint8Array(this.core.bytes(), 0, size), problem: this.core.text(size) };
  }

  /** Takes consecutive slices, from the first body on; other cores may have computed them, or failed. */
  join(slices: readonly Slice[], failure = ""): void {
    const problem = slices.find((slice) => slice.problem)?.problem ?? failure;
    this.core.call(() => this.core.exports.join(this.handle), problem, ...slices.map(({ rotors }) => rotors));
  }

  /** The same motion as another object. */
  again(): Motion {
    return new Motion(this.core, this.handle, this.about);
  }

  close(): void {
    this.core.exports.close(this.handle);
  }

  /** Where the surface of the body is not known, it follows from these. */
  private body(arm: Triple): number[] {
    const { mass, moments, frame } = this.about.body;
    return [mass ?? 1, ...moments, ...frame, ...arm];
  }
}
