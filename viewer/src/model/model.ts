import { batch, computed, signal } from "@preact/signals";
import { type About, type Files, Problem, State } from "../core/core.ts";
import { History, type Kept } from "./history.ts";
import { defaultSpeed } from "./speed.ts";
import { Solver } from "../core/solver.ts";
import type { Core, Motion } from "../core/wasm.ts";
import type {
  CameraName,
  GivenValue,
  LessonFile,
  PageDocument,
  Pose,
  Shown,
  ViewState,
} from "../document.ts";
import { unpacked } from "../packed.ts";

/** Default visibility. */
export const SHOWN: Shown = {
  body: true,
  bodyFrame: true,
  spaceFrame: true,
  omega: true,
  momentum: true,
  torque: true,
  sources: true,
  axial: false,
  poinsot: false,
  polhode: true,
  herpolhode: false,
  trace: true,
  energy: false,
  ghost: false,
  gravity: true,
  labels: true,
};

/** What has a name where the pointer is over it. */
export type CurveName = "polhode" | "herpolhode" | "trace" | "separatrix" | "neighbours" | "cloud";

/** What the pointer is on: a layer in the legend, which is emphasized, or a curve in a picture, which is marked in all. */
type Pointed = { layer: keyof Shown; curve?: never } | { curve: CurveName; layer?: never };

/** The size of what lies over the lower left corner of the picture, in CSS pixels. */
export interface Covered {
  width: number;
  height: number;
}

/** The name of a scene, and the files that it refers to. */
interface Opened {
  name: string;
  files: Files;
}

/** Holds values that the history keeps beside a scene: those of the controls. */
interface Keeper {
  take(): unknown;
  /** Sets the values that `take` returned, or, from null, those of the motion shown. */
  give(kept: unknown): void;
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
  /** Whether a newer motion is being computed: what is shown is old. */
  readonly solving = signal(false);
  /** The fraction of the bodies of an ensemble that are computed. */
  readonly bodiesKnown = signal(0);
  readonly time = signal(0);
  readonly playing = signal(false);
  /** Seconds of motion per second. */
  readonly speed = signal(1);
  readonly camera = signal<CameraName>("oblique");
  /** Where the user turned the camera to; null at its preset. */
  readonly pose = signal<Pose | null>(null);
  readonly theme = signal<ViewState["theme"]>("auto");
  readonly shown = signal<Shown>(SHOWN);
  /** The lines of the algebra page, and the values that it was given. */
  readonly lines = signal("");
  readonly values = signal<readonly GivenValue[]>([]);
  /** The motion when its scene was last opened; the sliders take their ranges from it. */
  readonly opened = signal<About | null>(null);
  /** Whether the tip of Ω is marked, in the picture in space and on the energy ellipsoid. */
  readonly marked = signal(false);
  readonly pointed = signal<Pointed | null>(null);
  /** The size of the legend; labels keep clear of it. */
  readonly covered = signal<Covered | null>(null);
  /** The name of the built-in scene that is open; null for others. */
  readonly preset = signal<string | null>(null);
  /** Caption of the picture. */
  readonly caption = signal<string | null>(null);
  /** The lesson that the page shows. */
  readonly lesson = signal<LessonFile | null>(null);
  /** Number of requests to fit the picture into view. */
  readonly fitted = signal(0);
  /** The last request to turn the camera: steps across and down, and the factor of nearness. */
  readonly turned = signal<[across: number, down: number, closer: number] | null>(null);

  readonly about = computed<About | null>(() => this.motion.value?.about ?? null);
  /** The state at the time shown, a row of `State`. */
  readonly row = computed<Float64Array | null>(() => this.motion.value?.states([this.time.value]) ?? null);

  /** The changes of the scene, which can be undone. */
  readonly history = new History();

  private keeper: Keeper | null = null;
  private name = "scene.toml";
  private files: Files = new Map();
  /** The scene as given, and as last opened. */
  private original: string | null = null;
  private base: string | null = null;
  /** Name and files of an invalid scene, for when it is corrected. */
  private pending: Opened | null = null;
  private readonly solver: Solver;
  /** Number of the newest scene to solve, and of the newest one to open. */
  private asked = 0;
  private opening = 0;

  constructor(readonly core: Core) {
    this.solver = new Solver(core);
  }

  /** Shows a document. */
  async show(document: PageDocument): Promise<void> {
    if (document.format !== 1) {
      throw new Problem(`this page reads documents of format 1, not ${String(document.format)}`);
    }
    const files = await this.filesOf(document);
    // A lesson that is continued at a step opens the scene of the step itself.
    const resumed = document.lesson?.step !== undefined;
    const rows = document.recorded && floats(await unpacked(document.recorded.rows));
    batch(() => {
      if (document.lines !== undefined) this.lines.value = document.lines;
      this.values.value = document.values ?? [];
      this.page.value = document.page ?? "motion";
      const { scene, view } = document;
      const changed = resumed ? { ...(scene !== undefined && { scene }), ...(view && { view }) } : {};
      this.lesson.value = document.lesson ? { ...document.lesson, files, changed } : null;
      if (document.recorded && rows) this.record(document, rows, files);
    });
    if (resumed) return;
    if (!document.recorded && document.scene !== undefined) {
      const options = { name: document.name ?? "scene.toml", files };
      if (!(await this.open(document.scene, options))) return;
    }
    if (document.caption !== undefined) this.caption.value = document.caption;
    if (document.view) this.look(document.view);
  }

  /** The files of a document. */
  async filesOf(document: PageDocument): Promise<Files> {
    const entries = Object.entries(document.files ?? {});
    return new Map(
      await Promise.all(entries.map(async ([name, text]) => [name, await unpacked(text)] as const)),
    );
  }

  /** The scene as it was given, its name and its files. */
  get source(): { name: string; files: Files; original: string | null } {
    return { name: this.name, files: this.files, original: this.original };
  }

  /**
   * Shows another scene from its start. If it is invalid, `problem` says why, and the last motion stays. False if a
   * newer scene was opened in the meantime.
   */
  async open(scene: string, options: Opened | null = this.pending): Promise<boolean> {
    const step = this.newStep();
    const { name, files } = options ?? { name: this.name, files: this.files };
    const motion = await this.solved(scene, name, files, true);
    if (motion === GIVEN_UP) return false;
    if (motion === null) {
      this.draft.value = scene;
      this.pending = options;
      return true;
    }
    batch(() => {
      this.become(motion, scene);
      if (options) this.take(scene, options);
      this.begin(scene, motion.about.start.time);
    });
    if (options) this.history.clear(this.kept());
    else this.remember(step);
    return true;
  }

  /** Shows another scene at the present time and speed. */
  async replace(scene: string): Promise<void> {
    const step = this.newStep();
    const motion = await this.solved(scene, this.name, this.files, true);
    if (motion === GIVEN_UP) return;
    if (motion === null) {
      this.draft.value = scene;
      return;
    }
    const [time, speed] = [this.time.value, this.speed.value];
    batch(() => {
      this.become(motion, scene);
      this.begin(scene, motion.about.start.time);
      this.look({ time, speed });
    });
    this.remember(step);
  }

  /** Opens the scene again with files that it refers to. */
  async supply(files: Files): Promise<void> {
    const { name, files: others } = this.pending ?? { name: this.name, files: this.files };
    const scene = this.draft.value ?? this.scene.value;
    const given = [...files.keys()].join(", ");
    if (scene === null || ![...files.keys()].some((file) => scene.includes(file))) {
      const of = scene === null ? "a recorded motion" : name;
      this.problem.value = `${given}: ${of} does not refer to ${files.size > 1 ? "these files" : "this file"}`;
      return;
    }
    const newest = await this.open(scene, { name, files: new Map([...others, ...files]) });
    if (newest && this.problem.value !== null) {
      this.problem.value = `${given}: was added to ${name}, which is still invalid:\n${this.problem.value}`;
    }
  }

  /** Shows the scene as it was given. */
  reset(): void {
    if (this.original !== null) void this.open(this.original, null);
  }

  /**
   * Replaces tables and fields of the opened scene by those of a TOML text; the time does not change. Nothing happens
   * while another scene is being opened.
   */
  async change(tables: string): Promise<void> {
    if (this.base === null || this.opening !== 0) return;
    const step = this.history.stamp();
    try {
      const scene = this.core.merged(this.base, tables);
      const motion = await this.solved(scene, this.name, this.files, false);
      if (!motion || motion === GIVEN_UP) return;
      this.become(motion, scene);
      this.remember(step);
    } catch (error) {
      this.problem.value = words(error);
    }
  }

  /** Undoes the last change of the scene; the time does not change. */
  undo(): Promise<void> {
    return this.restore(this.history.back());
  }

  /** Makes the change again that was undone last. */
  redo(): Promise<void> {
    return this.restore(this.history.forth());
  }

  /** Lets the history keep values beside the scenes. */
  keep(keeper: Keeper | null): void {
    this.keeper = keeper;
    const { present } = this.history;
    if (present) present.controls ??= keeper?.take() ?? null;
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
      if (view.pose !== undefined) this.pose.value = view.pose;
      if (view.theme !== undefined) this.theme.value = view.theme;
      if (view.time !== undefined) this.seek(view.time);
      if (view.playing !== undefined) this.playing.value = view.playing;
    });
  }

  /** Toggles the visibility of a part. */
  toggle(part: keyof Shown): void {
    this.shown.value = { ...this.shown.value, [part]: !this.shown.value[part] };
  }

  /** Fits the picture into view. */
  fit(): void {
    this.fitted.value += 1;
  }

  dispose(): void {
    this.solver.dispose();
    const motion = this.motion.value;
    batch(() => {
      this.playing.value = false;
      this.motion.value = null;
    });
    motion?.close();
  }

  /** Solves a scene; null if it is invalid, and `problem` then says why. */
  private async solved(
    scene: string,
    name: string,
    files: Files,
    opens: boolean,
  ): Promise<Motion | null | typeof GIVEN_UP> {
    const number = ++this.asked;
    if (opens) this.opening = number;
    this.solving.value = true;
    this.bodiesKnown.value = 0;
    let shown: Motion | null = null;
    const complete = (motion: Motion): void => {
      if (this.motion.peek() !== shown) return;
      this.motion.value = motion;
    };
    try {
      const progress = (part: number): void => void (this.bodiesKnown.value = part);
      shown = await this.solver.solve({ scene, name, files, only: opens, progress, complete });
      return shown ?? GIVEN_UP;
    } catch (error) {
      // What is wrong with an older scene does not matter.
      if (number !== this.asked) return GIVEN_UP;
      this.problem.value = words(error);
      return null;
    } finally {
      if (this.opening === number) this.opening = 0;
      if (this.asked === number) this.solving.value = false;
    }
  }

  private newStep(): number {
    this.history.begin();
    return this.history.stamp();
  }

  /** Adds the scene shown to the history. */
  private remember(step: number): void {
    const kept = this.kept();
    if (kept) this.history.record(kept, step);
  }

  private kept(): Kept | null {
    const scene = this.scene.value;
    if (scene === null) return null;
    return { scene, base: this.base, opened: this.opened.value, controls: this.keeper?.take() ?? null };
  }

  private async restore(kept: Kept | null): Promise<void> {
    if (!kept) return;
    const motion = await this.solved(kept.scene, this.name, this.files, true);
    if (!motion || motion === GIVEN_UP) return;
    batch(() => {
      this.become(motion, kept.scene);
      [this.base, this.pending, this.draft.value] = [kept.base, null, null];
      this.opened.value = kept.opened;
    });
    this.keeper?.give(kept.controls);
  }

  private record(document: PageDocument, rows: Float64Array, files: Files): void {
    this.giveUp();
    const { scene, name = "scene.toml", recorded } = document;
    const of = scene === undefined ? undefined : { scene, name, files };
    const motion = this.core.recorded(recorded?.about ?? "", rows, of);
    this.become(motion, scene ?? null);
    this.take(scene ?? null, { name, files });
    this.begin(scene ?? null, rows[State.time] ?? 0);
    this.history.clear(this.kept());
  }

  /** Forgets the scenes that are being solved. */
  private giveUp(): void {
    this.solver.dispose();
    this.asked += 1;
    this.opening = 0;
    this.solving.value = false;
  }

  /** Remembers a scene as it was given. */
  private take(scene: string | null, { name, files }: Opened): void {
    [this.name, this.files, this.original] = [name, files, scene];
    this.caption.value = null;
    this.preset.value = null;
  }

  /** Starts the motion of a scene. */
  private begin(scene: string | null, time: number): void {
    this.pending = null;
    this.draft.value = null;
    this.base = scene;
    this.opened.value = this.about.value;
    this.time.value = time;
    this.speed.value = this.motion.value ? defaultSpeed(this.motion.value) : 1;
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

/** Instead of the motion of a scene that was given up for a newer one. */
const GIVEN_UP = Symbol();

/** The first and last time at which a motion is known. */
export function span(about: About): [number, number] {
  const start = about.start.time;
  if (!about.exact) return [start, start + about.duration];
  if (about.horizon === null) return [-Number.MAX_VALUE, Number.MAX_VALUE];
  return [start - about.horizon, start + about.horizon];
}

function floats(bytes: Uint8Array): Float64Array {
  return new Float64Array(bytes.buffer, bytes.byteOffset, Math.floor(bytes.byteLength / 8));
}

/** The message of an error. */
export function words(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
