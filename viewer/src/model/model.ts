import { batch, computed, signal } from "@preact/signals";
import { type About, type Files, Problem, sizeAt, State } from "../core/core.ts";
import type { Core, Motion } from "../core/wasm.ts";
import type { CameraName, GivenValue, LessonFile, PageDocument, Shown, ViewState } from "../document.ts";
import { unpacked } from "../packed.ts";

/** Time limit for solving a scene in the page, in s. */
const BUDGET = 8;

/** Default visibility. */
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
  energy: false,
  gravity: true,
  labels: true,
};

/** The name of a scene, and the files that it refers to. */
interface Opened {
  name: string;
  files: Files;
}

/**
 * The state of the page. Everything shown follows from it: the stage and the panels read its signals, and change it
 * through its methods.
 */
export class Model {
  readonly page = signal<"motion" | "algebra">("motion");
  /** The scene in TOML; null for a recorded motion alone. */
  readonly scene = signal<string | null>(null);
  readonly motion = signal<Motion | null>(null);
  /** An unfinished or invalid text of the scene; null if the text is the scene. */
  readonly draft = signal<string | null>(null);
  /** Errors of the scene, or of an opened file, with their places; the last motion stays. */
  readonly problem = signal<string | null>(null);
  readonly time = signal(0);
  readonly playing = signal(false);
  /** Seconds of motion per second. */
  readonly speed = signal(1);
  readonly camera = signal<CameraName>("oblique");
  readonly theme = signal<ViewState["theme"]>("auto");
  readonly shown = signal<Shown>(SHOWN);
  /** The lines of the algebra page, and the values that it was given. */
  readonly lines = signal("");
  readonly values = signal<readonly GivenValue[]>([]);
  /** The motion when its scene was last opened; the sliders take their ranges from it. */
  readonly opened = signal<About | null>(null);
  /** Whether the tip of Ω is marked, in the picture in space and on the energy ellipsoid. */
  readonly marked = signal(false);
  /** Caption of the picture. */
  readonly caption = signal<string | null>(null);
  /** The lesson that the page shows. */
  readonly lesson = signal<LessonFile | null>(null);
  /** Number of requests to fit the picture into view. */
  readonly fitted = signal(0);

  readonly about = computed<About | null>(() => this.motion.value?.about ?? null);
  /** The state at the time shown, a row of `State`. */
  readonly row = computed<Float64Array | null>(() => this.motion.value?.states([this.time.value]) ?? null);

  private name = "scene.toml";
  private files: Files = new Map();
  /** The scene as given, and as last opened. */
  private original: string | null = null;
  private base: string | null = null;
  /** Name and files of an invalid scene, for when it is corrected. */
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
      this.values.value = document.values ?? [];
      this.page.value = document.page ?? "motion";
      this.lesson.value = document.lesson ? { ...document.lesson, files } : null;
      if (document.recorded && rows) {
        this.record(document, rows, files);
      } else if (document.scene !== undefined) {
        this.open(document.scene, { name: document.name ?? "scene.toml", files });
      }
      if (document.view) this.look(document.view);
    });
  }

  /** Shows another scene from its start. If it is invalid, `problem` says why, and the last motion stays. */
  open(scene: string, options: Opened | null = this.pending): void {
    const { name, files } = options ?? { name: this.name, files: this.files };
    if (!this.follow(scene, name, files)) {
      this.draft.value = scene;
      this.pending = options;
      return;
    }
    batch(() => {
      if (options) this.take(scene, options);
      this.begin(scene, this.about.value?.start.time ?? 0);
    });
  }

  /** Opens the scene again with files that it refers to. */
  supply(files: Files): void {
    const { name, files: others } = this.pending ?? { name: this.name, files: this.files };
    const scene = this.draft.value ?? this.scene.value;
    const given = [...files.keys()].join(", ");
    if (scene === null || ![...files.keys()].some((file) => scene.includes(file))) {
      const of = scene === null ? "a recorded motion" : name;
      this.problem.value = `${given}: ${of} does not refer to ${files.size > 1 ? "these files" : "this file"}`;
      return;
    }
    this.open(scene, { name, files: new Map([...others, ...files]) });
    if (this.problem.value !== null) {
      this.problem.value = `${given}: was added to ${name}, which is still invalid:\n${this.problem.value}`;
    }
  }

  /** Shows the scene as it was given. */
  reset(): void {
    if (this.original !== null) this.open(this.original, null);
  }

  /** Replaces tables and fields of the opened scene by those of a TOML text; the time does not change. */
  change(tables: string): void {
    if (this.base === null) return;
    try {
      this.follow(this.core.merged(this.base, tables), this.name, this.files);
    } catch (error) {
      this.problem.value = words(error);
    }
  }

  /** Goes to a time, or the nearest one at which the motion is known. */
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

  /** Advances by `seconds` of the clock; at its end a motion starts again. */
  tick(seconds: number): void {
    const about = this.about.value;
    if (!this.playing.value || !about) return;
    const time = this.time.value + seconds * this.speed.value;
    const [first, last] = span(about);
    this.time.value = time > last ? first : time < first ? last : time;
  }

  /** Applies settings of the view. */
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

  /** Toggles the visibility of a part. */
  toggle(thing: keyof Shown): void {
    this.shown.value = { ...this.shown.value, [thing]: !this.shown.value[thing] };
  }

  /** Fits the picture into view. */
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
    this.take(scene ?? null, { name, files });
    this.begin(scene ?? null, rows[State.time] ?? 0);
  }

  /** Remembers a scene as it was given. */
  private take(scene: string | null, { name, files }: Opened): void {
    [this.name, this.files, this.original] = [name, files, scene];
    this.caption.value = null;
  }

  /** Starts the motion of a scene. */
  private begin(scene: string | null, time: number): void {
    this.pending = null;
    this.draft.value = null;
    this.base = scene;
    this.opened.value = this.about.value;
    this.time.value = time;
    this.speed.value = defaultSpeed(this.motion.value);
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

/** The first and last time at which a motion is known. */
export function span(about: About): [number, number] {
  const start = about.start.time;
  if (!about.exact) return [start, start + about.duration];
  if (about.horizon === null) return [-Number.MAX_VALUE, Number.MAX_VALUE];
  return [start - about.horizon, start + about.horizon];
}

/**
 * The default speed, 1, 2 or 5 times a power of ten: about one turn in three seconds, up to three times as fast for a
 * body that takes long to flip.
 */
function defaultSpeed(motion: Motion | null): number {
  const row = motion && firstRow(motion);
  if (!motion || !row) return 1;
  const rate = sizeAt(row, State.omegaSpace);
  const calm = rate > 0 ? (2 * Math.PI) / rate / 3 : motion.about.duration / 20;
  const wanted = Math.min(Math.max((motion.about.free?.flip_time ?? 0) / 6, calm), 3 * calm);
  const power = 10 ** Math.floor(Math.log10(wanted));
  const first = wanted / power;
  return (first < 1.5 ? 1 : first < 3.5 ? 2 : first < 7.5 ? 5 : 10) * power;
}

function floats(bytes: Uint8Array): Float64Array {
  return new Float64Array(bytes.buffer, bytes.byteOffset, Math.floor(bytes.byteLength / 8));
}

/** The message of an error. */
export function words(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
