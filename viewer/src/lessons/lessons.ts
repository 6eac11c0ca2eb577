import { batch, effect, signal, untracked } from "@preact/signals";
import { Problem } from "../core/core.ts";
import type { LessonFile } from "../document.ts";
import { type Model, SHOWN, words } from "../model/model.ts";
import { mayAutoplay } from "../presets/index.ts";
import { glide } from "./glide.ts";
import type { Lesson, Settings, Step, Subject } from "./lesson.ts";
import { sceneNamed } from "./library.ts";
import { joined, lessonOf } from "./parse.ts";
import { changed, settingsOf, withValues } from "./settings.ts";

const HEADING = [".lesson h2"];
const PRESSED = [".lesson .last"];
const VERDICT = [".lesson .verdict"];

/** The lesson of the page: its step, and the answers that were given. It sets what the picture shows. */
export class Lessons {
  readonly lesson = signal<Lesson | null>(null);
  /** The number of the step, from 0. */
  readonly index = signal(0);
  /** The chosen answer of each step. */
  readonly answers = signal<ReadonlyMap<number, number>>(new Map());
  /** Whether a lesson was left: then the list of lessons is open. */
  readonly left = signal(false);
  /** The phrase of this step that was pressed last. */
  readonly last = signal<string | null>(null);
  /** Selectors of what is read next, the first one that is on the page; it gets the focus. */
  next: readonly string[] | null = null;
  readonly dispose: () => void;
  /** The scene that was opened last, before anything changed it. */
  private opened: string | null = null;
  /** Settled when the scenes asked for are open; what a phrase does waits for its step. */
  private shown: Promise<void> = Promise.resolve();
  /** Number of steps shown; work for an earlier one is dropped. */
  private turn = 0;

  constructor(readonly model: Model) {
    this.dispose = effect(() => {
      const given = model.lesson.value;
      untracked(() => this.begin(given));
    });
    // A page does not take the focus when it is loaded.
    this.next = null;
  }

  get step(): Step | null {
    return this.lesson.value?.steps[this.index.value] ?? null;
  }

  /** Whether the step has a question that is not answered yet. */
  get asks(): boolean {
    return this.step?.question != null && !this.answers.value.has(this.index.value);
  }

  /** Shows a step from its start. */
  go(index: number): void {
    const step = this.lesson.value?.steps[index];
    if (!step) return;
    this.turn += 1;
    this.last.value = null;
    this.next = HEADING;
    this.index.value = index;
    const answered = step.question && this.answers.value.has(index);
    const set = answered ? joined(step.set, step.question!.set) : step.set;
    this.shown = this.present(step.subject, set, `${this.lesson.value!.name}:${step.line}`);
  }

  /** Does what an underlined phrase of this step says, from the scene of the step. */
  act(target: string): void {
    const step = this.step;
    if (!step) return;
    this.last.value = target;
    try {
      this.then(step, settingsOf(target, step.subject, this.model.core));
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      this.model.problem.value = words(error);
    }
  }

  /** Answers the question of this step, and shows what follows it. */
  answer(choice: number): void {
    const question = this.step?.question;
    if (!question || this.answers.value.has(this.index.value)) return;
    this.next = VERDICT;
    this.last.value = null;
    this.answers.value = new Map(this.answers.value).set(this.index.value, choice);
    this.then(this.step!, question.set);
  }

  close(): void {
    const id = this.lesson.value?.name.replace(/\.md$/u, "") ?? "";
    // Without the list of lessons, that of the figures of the algebra page.
    const places = [`.lessons [data-lesson="${CSS.escape(id)}"]`, "#panel-lessons summary", "#figure"];
    batch(() => {
      this.next = places;
      this.left.value = true;
      this.model.lesson.value = null;
    });
  }

  private begin(given: LessonFile | null): void {
    this.turn += 1;
    this.opened = null;
    this.answers.value = new Map();
    this.lesson.value = null;
    if (!given) return;
    try {
      const { text, name, files = new Map() } = given;
      this.lesson.value = lessonOf(text, name, this.model.core, (scene) => sceneNamed(scene, files));
      this.go(Math.min(given.step ?? 0, this.lesson.value.steps.length - 1));
      if (given.changed) this.change(given.changed);
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      this.model.page.value = "motion";
      this.model.problem.value = words(error);
    }
  }

  /** Makes changes of the reader when the step is shown, unless another step is asked for in the meantime. */
  private change({ scene, view = {} }: NonNullable<LessonFile["changed"]>): void {
    const { model, turn } = this;
    this.shown = this.shown.then(async () => {
      if (turn !== this.turn) return;
      if (scene !== undefined && scene !== model.scene.value) await model.replace(scene);
      if (turn === this.turn) model.look(view);
    });
  }

  /** Applies settings when the step is shown, unless another step is asked for in the meantime. */
  private then(step: Step, set: Settings): void {
    const { turn } = this;
    this.shown = this.shown.then(() => (turn === this.turn ? this.apply(step, set) : undefined));
  }

  private async apply(step: Step, set: Settings): Promise<void> {
    const { model } = this;
    this.turnTo(step.subject);
    if (set.fields !== undefined || set.values) {
      const full = { ...set, fields: { ...step.set.fields, ...set.fields } };
      if (step.subject.kind === "lines") {
        const { values } = set;
        if (values) glide(model.lines, withValues(model.lines.value, values));
      } else {
        const speed = model.speed.value;
        const place = `${this.lesson.value!.name}:${step.line}`;
        if (!(await this.openScene(step.subject, full, place))) return;
        model.speed.value = speed;
      }
    }
    this.look(set, model.shown.value);
  }

  /** Shows the subject of a step with the settings of the step, and everything else as in a first view. */
  private async present(subject: Subject, set: Settings, place: string): Promise<void> {
    const { model } = this;
    this.turnTo(subject);
    if (subject.kind === "lines") {
      model.lines.value = withValues(subject.lines, set.values ?? {});
      model.values.value = [];
      return;
    }
    if (!(await this.openScene(subject, set, place))) return;
    this.look({ camera: "oblique", playing: true, ...set }, SHOWN);
    // Not that of the scene, which may answer the question of the step.
    model.caption.value = set.caption ?? "";
  }

  /** Turns to the page that a step is about, and back to what was pressed there. */
  private turnTo(subject: Subject): void {
    const { page } = this.model;
    const about = subject.kind === "scene" ? "motion" : "algebra";
    if (page.value !== about) this.next ??= PRESSED;
    page.value = about;
  }

  /** Opens the scene of a step, unless it is shown already. Returns whether it is valid and still asked for. */
  private async openScene(
    subject: Extract<Subject, { kind: "scene" }>,
    set: Settings,
    place: string,
  ): Promise<boolean> {
    const { model, turn } = this;
    const scene = changed(subject.scene, set.fields, model.core);
    const same = scene === this.opened && scene === model.scene.value && model.problem.value === null;
    if (!same) {
      const caption = model.caption.value;
      const newest = await model.open(scene, { name: subject.name, files: subject.files });
      if (!newest || turn !== this.turn) return false;
      const problem = model.problem.value;
      if (problem !== null) {
        model.problem.value = inLesson(problem, subject, set, place);
        return false;
      }
      this.opened = model.scene.value;
      model.caption.value = caption;
    }
    return true;
  }

  private look(set: Settings, before: Model["shown"]["value"]): void {
    const { model } = this;
    const none = Object.fromEntries(
      Object.keys(SHOWN).map((name) => [name, false]),
    ) as unknown as typeof before;
    const { camera, time, speed, playing, caption } = set;
    model.shown.value = { ...(set.only ? none : before), ...set.shown };
    if (caption !== undefined) model.caption.value = caption;
    model.look({
      ...(camera !== undefined && { camera }),
      ...(time !== undefined && { time }),
      ...(speed !== undefined && { speed }),
      ...(playing !== undefined && { playing: playing && mayAutoplay() }),
    });
  }
}

/** The message of an invalid scene with its place in the lesson. */
function inLesson(
  problem: string,
  { name, above }: Extract<Subject, { kind: "scene" }>,
  set: Settings,
  place: string,
): string {
  if (above === null || set.fields) return `${place}: error: the scene of this step is invalid:\n${problem}`;
  const lower = (line: string): string => String(Number(line) + above);
  // In the places, and beside the lines that are quoted.
  const quoted = problem.replace(/^\d+(?= +\|)/gmu, lower);
  const parts = quoted.split(`${name}:`);
  return parts.map((part, k) => (k > 0 ? part.replace(/^\d+/u, lower) : part)).join(`${name}:`);
}
