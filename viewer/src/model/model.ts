import { batch, computed, signal } from "@preact/signals";
import { type About, type Files, Problem, ROW, State } from "../core/core.ts";
import type { Core, Motion } from "../core/wasm.ts";
import type { CameraName, PageDocument, Shown, ViewState } from "../document.ts";
import { unpacked } from "../packed.ts";

/** How long a scene may be followed in the page before it gives up, in s. */
const BUDGET = 8;

/** What is drawn at first. */
export const SHOWN: Shown = {
  body: true,
  bodyFrame: true,
  spaceFrame: true,
  omega: true,
  momentum: true,
  axial: false,
  poinsot: false,
  polhode: true,
  herpolhode: false,
  trace: true,
  gravity: true,
  labels: true,
};

/** What a scene is called, and the files that it names. */
interface Opened {
  name: string;
  files: Files;
}

/**
 * The state of the page. All that is shown follows from it: the stage and the panels read its signals, and change it
 * through its methods alone.
 */
export class Model {
  readonly page = signal<"motion" | "algebra">("motion");
  /** The scene in TOML; null where a recorded motion is shown. */
  readonly scene = signal<string | null>(null);
  readonly motion = signal<Motion | null>(null);
  /** A text of the scene that is being written, or that is wrong; null where the scene is what is written. */
  readonly draft = signal<string | null>(null);
  /** What is wrong with the scene, or with a file that was opened, in words with places; the last motion stays. */
  readonly problem = signal<string | null>(null);
  readonly time = signal(0);
  readonly playing = signal(false);
  /** Seconds of motion in a second of the clock. */
  readonly speed = signal(1);
  readonly camera = signal<CameraName>("oblique");
  readonly theme = signal<ViewState["theme"]>("auto");
  readonly shown = signal<Shown>(SHOWN);
  /** The lines of the page of algebra. */
  readonly lines = signal("");
  /** What the motion was when its scene was last written or chosen, not varied: sliders take their ranges from it. */
  readonly opened = signal<About | null>(null);
  /** What to look at, in a sentence or two. */
  readonly caption = signal<string | null>(null);
  /** How many times all was to be brought into view. */
  readonly fitted = signal(0);

  readonly about = computed<About | null>(() => this.motion.value?.about ?? null);
  /** The row of the state at the time shown. */
  readonly row = computed<Float64Array | null>(() => this.motion.value?.states([this.time.value]) ?? null);

  private name = "scene.toml";
  private files: Files = new Map();
  /** The scene as it was given, and as it was last opened. */
  private original: string | null = null;
  private base: string | null = null;
  /** What came with a scene that is wrong, for when it is right. */
  private pending: Opened | null = null;

  constructor(readonly core: Core) {}

  /** Shows a document. */
  async show(document: PageDocument): Promise<void> {
    if (document.format !== 1) {
      throw new Problem(`this page reads documents of format 1, not ${String(document.format)}`);
    }
    const files = new Map<string, Uint8Array>();
    for (const [name, content] of Object.entries(document.files ?? {})) {
      files.set(name, await unpacked(content));
    }
    const rows = document.recorded && floats(await unpacked(document.recorded.rows));
    batch(() => {
      if (document.lines !== undefined) this.lines.value = document.lines;
      this.page.value = document.page ?? "motion";
      if (document.recorded && rows) {
        this.record(document, rows, files);
      } else if (document.scene !== undefined) {
        this.open(document.scene, { name: document.name ?? "scene.toml", files });
      }
      if (document.view) this.look(document.view);
    });
  }

  /** Shows another scene, from its start. What is wrong with it is in `problem`, and then all else stays. */
  open(scene: string, options: Opened | null = this.pending): void {
    const { name, files } = options ?? { name: this.name, files: this.files };
    if (!this.follow(scene, name, files)) {
      this.draft.value = scene;
      this.pending = options;
      return;
    }
    batch(() => {
      if (options) {
        this.name = name;
        this.files = files;
        this.original = scene;
        this.caption.value = null;
      }
      this.pending = null;
      this.draft.value = null;
      this.base = scene;
      this.opened.value = this.about.value;
      this.time.value = this.about.value?.start.time ?? 0;
      this.speed.value = usualSpeed(this.motion.value);
    });
  }

  /** Tries the scene again with files that it names. */
  supply(files: Files): void {
    const { name, files: others } = this.pending ?? { name: this.name, files: this.files };
    const scene = this.draft.value ?? this.scene.value;
    const given = [...files.keys()].join(", ");
    if (scene === null || ![...files.keys()].some((file) => scene.includes(file))) {
      const of = scene === null ? "a recorded motion" : name;
      this.problem.value = `${given}: ${of} does not name ${files.size > 1 ? "these files" : "this file"}`;
      return;
    }
    this.open(scene, { name, files: new Map([...others, ...files]) });
    if (this.problem.value !== null) {
      this.problem.value = `${given}: was added to ${name}, in which something is still wrong:\n${this.problem.value}`;
    }
  }

  /** Shows the scene again as it was given. */
  reset(): void {
    if (this.original !== null) this.open(this.original, null);
  }

  /** Replaces tables and fields of the scene, as it was opened, by those of a TOML text; time goes on. */
  change(tables: string): void {
    if (this.base === null) return;
    try {
      this.follow(this.core.merged(this.base, tables), this.name, this.files);
    } catch (error) {
      this.problem.value = words(error);
    }
  }

  /** Goes to a time, or as near to it as the motion is known. */
  seek(time: number): void {
    const about = this.about.value;
    if (!about || Number.isNaN(time)) return;
    const [first, last] = span(about);
    this.time.value = Math.min(Math.max(time, first), last);
  }

  /** Goes to the start of the motion. */
  toStart(): void {
    this.seek(this.about.value?.start.time ?? 0);
  }

  /** Lets `seconds` of the clock pass; a motion that is known up to its end starts again there. */
  tick(seconds: number): void {
    const about = this.about.value;
    if (!this.playing.value || !about) return;
    const time = this.time.value + seconds * this.speed.value;
    const [first, last] = span(about);
    this.time.value = time > last ? first : time < first ? last : time;
  }

  /** Takes over what is said of the view. */
  look(view: Partial<ViewState>): void {
    batch(() => {
      if (view.shown) this.shown.value = { ...this.shown.value, ...view.shown };
      if (view.speed !== undefined) this.speed.value = view.speed;
      if (view.camera !== undefined) this.camera.value = view.camera;
      if (view.theme !== undefined) this.theme.value = view.theme;
      if (view.time !== undefined) this.seek(view.time);
      if (view.playing !== undefined) this.playing.value = view.playing;
    });
  }

  /** Draws a thing, or no longer. */
  toggle(thing: keyof Shown): void {
    this.shown.value = { ...this.shown.value, [thing]: !this.shown.value[thing] };
  }

  /** Brings all into view. */
  fit(): void {
    this.fitted.value += 1;
  }

  dispose(): void {
    const motion = this.motion.value;
    batch(() => {
      this.playing.value = false;
      this.motion.value = null;
    });
    motion?.close();
  }

  private follow(scene: string, name: string, files: Files): boolean {
    try {
      this.become(this.core.open(scene, { name, files, budget: BUDGET }), scene);
      return true;
    } catch (error) {
      this.problem.value = words(error);
      return false;
    }
  }

  private record(document: PageDocument, rows: Float64Array, files: Files): void {
    const { scene, name = "scene.toml", recorded } = document;
    const of = scene === undefined ? undefined : { scene, name, files };
    const motion = this.core.recorded(recorded?.about ?? "", rows, of);
    this.become(motion, scene ?? null);
    this.name = name;
    this.files = files;
    this.opened.value = motion.about;
    this.caption.value = null;
    this.original = scene ?? null;
    this.base = scene ?? null;
    this.draft.value = null;
    this.pending = null;
    this.time.value = rows[State.time] ?? 0;
    this.speed.value = usualSpeed(motion);
  }

  private become(motion: Motion, scene: string | null): void {
    const old = this.motion.value;
    batch(() => {
      this.scene.value = scene;
      this.motion.value = motion;
      this.problem.value = null;
      this.seek(this.time.value);
    });
    old?.close();
  }
}

/** The state at the start of a motion. */
export function firstRow(motion: Motion): Float64Array {
  return motion.states([motion.about.start.time]);
}

/** The times for which a motion is known. */
export function span(about: About): [number, number] {
  const start = about.start.time;
  if (!about.exact) return [start, start + about.duration];
  if (about.horizon === null) return [-Number.MAX_VALUE, Number.MAX_VALUE];
  return [start - about.horizon, start + about.horizon];
}

/**
 * The speed at which the body turns about once in three seconds, of the form 1, 2, 5 times a power of ten; up to three
 * times as fast where it would else take long to turn over.
 */
function usualSpeed(motion: Motion | null): number {
  const row = motion && firstRow(motion);
  if (!motion || !row || row.length < ROW) return 1;
  const rate = Math.hypot(...row.subarray(State.omegaSpace, State.omegaSpace + 3));
  const calm = rate > 0 ? (2 * Math.PI) / rate / 3 : motion.about.duration / 20;
  const wanted = Math.min(Math.max((motion.about.free?.flip_time ?? 0) / 6, calm), 3 * calm);
  const power = 10 ** Math.floor(Math.log10(wanted));
  const first = wanted / power;
  return (first < 1.5 ? 1 : first < 3.5 ? 2 : first < 7.5 ? 5 : 10) * power;
}

function floats(bytes: Uint8Array): Float64Array {
  return new Float64Array(bytes.buffer, bytes.byteOffset, Math.floor(bytes.byteLength / 8));
}

/** An error as people are told of it. */
export function words(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
