import packed from "virtual:polhode-core";
import { unpacked } from "../packed.ts";
import { type About, type Core, type Files, type LawEntry, type Line, type Motion, Problem } from "./core.ts";

/** What the core exports: see crates/wasm/src/exports.rs. */
interface Exports {
  memory: WebAssembly.Memory;
  room(size: number): number;
  reply(): number;
  reply_size(): number;
  open(budget: number): number;
  record(): number;
  close(handle: number): void;
  about_motion(handle: number): number;
  states(handle: number): number;
  surface_vertices(handle: number): number;
  surface_faces(handle: number): number;
  bodies(handle: number, time: number, count: number, budget: number): number;
  merge(): number;
  evaluate(): number;
  law_registry(): number;
}

/** How long a motion may be followed if nobody says it, in s. */
const BUDGET = 10;

/** Loads the core that is in this bundle. */
export async function loadCore(): Promise<Core> {
  const imports = { page: { now: () => performance.now() / 1000 } };
  const module = await WebAssembly.compile(await unpacked(packed));
  const instance = await WebAssembly.instantiate(module, imports);
  return new Compiled(instance.exports as unknown as Exports);
}

class Compiled implements Core {
  /** The torque laws of the registry. */
  readonly laws: readonly LawEntry[];

  constructor(private readonly exports: Exports) {
    this.checked(() => exports.law_registry());
    this.laws = JSON.parse(this.text()) as LawEntry[];
  }

  open(scene: string, { name = "scene.toml", files = new Map(), budget = BUDGET }: OpenOptions = {}): Motion {
    this.putScene(scene, name, files);
    const handle = this.checked(() => this.exports.open(budget));
    this.checked(() => this.exports.about_motion(handle));
    return new Held(this, handle, JSON.parse(this.text()) as About);
  }

  recorded(about: string, rows: Float64Array, of?: { scene: string; name: string; files: Files }): Motion {
    this.put(new Uint8Array(rows.buffer, rows.byteOffset, rows.byteLength));
    if (of) this.putScene(of.scene, of.name, of.files);
    return new Held(
      this,
      this.checked(() => this.exports.record()),
      JSON.parse(about) as About,
    );
  }

  merged(scene: string, change: string): string {
    this.putText(scene);
    this.putText(change);
    this.checked(() => this.exports.merge());
    return this.text();
  }

  evaluated(lines: string): Line[] {
    this.putText(lines);
    this.checked(() => this.exports.evaluate());
    return JSON.parse(this.text()) as Line[];
  }

  /** Calls the core about a motion it holds; a Problem if it says so. */
  ask(call: (exports: Exports) => number): void {
    this.checked(() => call(this.exports));
  }

  put(bytes: Uint8Array): void {
    const place = this.exports.room(bytes.length);
    new Uint8Array(this.exports.memory.buffer, place, bytes.length).set(bytes);
  }

  putText(text: string): void {
    this.put(new TextEncoder().encode(text));
  }

  private putScene(scene: string, name: string, files: Files): void {
    this.putText(scene);
    this.putText(name);
    for (const [file, content] of files) {
      this.putText(file);
      this.put(content);
    }
  }

  /** A copy of the answer. */
  bytes(): Uint8Array<ArrayBuffer> {
    const { memory, reply, reply_size } = this.exports;
    return new Uint8Array(memory.buffer.slice(reply(), reply() + reply_size()));
  }

  text(): string {
    return new TextDecoder().decode(this.bytes());
  }

  floats(): Float64Array {
    return new Float64Array(this.bytes().buffer);
  }

  /** The code of a call; a Problem where it says so, or where the core itself failed, after which it is not usable. */
  private checked(call: () => number): number {
    let code: number;
    try {
      code = call();
    } catch (error) {
      throw new Problem(`the core failed (${String(error)}); reload the page`);
    }
    if (code < 0) throw new Problem(this.text());
    return code;
  }
}

type OpenOptions = NonNullable<Parameters<Core["open"]>[1]>;

class Held implements Motion {
  constructor(
    private readonly core: Compiled,
    private readonly handle: number,
    readonly about: About,
  ) {}

  states(times: ArrayLike<number>): Float64Array {
    this.core.put(new Uint8Array(Float64Array.from(times).buffer));
    this.core.ask((exports) => exports.states(this.handle));
    return this.core.floats();
  }

  surface(): { vertices: Float64Array; faces: Uint32Array } | null {
    if (!this.about.body.mesh) return null;
    this.core.ask((exports) => exports.surface_vertices(this.handle));
    const vertices = this.core.floats();
    this.core.ask((exports) => exports.surface_faces(this.handle));
    return { vertices, faces: new Uint32Array(this.core.bytes().buffer) };
  }

  bodies(time: number, count: number): Float64Array {
    this.core.ask((exports) => exports.bodies(this.handle, time, count, BUDGET));
    return this.core.floats();
  }

  close(): void {
    this.core.ask((exports) => {
      exports.close(this.handle);
      return 0;
    });
  }
}
