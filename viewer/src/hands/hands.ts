import { batch, computed, type ReadonlySignal, signal } from "@preact/signals";
import { type Quaternion, Vector3 } from "three";
import { State, type Quadruple, type Triple } from "../core/core.ts";
import { type Model, span } from "../model/model.ts";
import type { Controls } from "../vary/controls.ts";
import { startAt } from "../vary/start.ts";
import { Ghost } from "./ghost.ts";
import { changeOf } from "./report.ts";

/** What the pointer does in the picture in space, besides turning the camera. */
export type Tool = "none" | "push" | "aim";

/** A state that the hands give: what is absent stays. */
export interface Given {
  omega?: Vector3;
  attitude?: Quaternion;
  velocity?: Vector3;
}

/**
 * The hands of the user on the body. What they change at a time becomes the start of the motion, at that time: the
 * controls write it into the scene, and the motion goes on from there.
 */
export class Hands {
  readonly tool = signal<Tool>("none");
  /** Whether there is a scene to change. */
  readonly able: ReadonlySignal<boolean>;
  /** What is being done, while it has no result. */
  readonly doing = signal<string | null>(null);
  /** What can be done where the pointer or the focus is. */
  readonly hint = signal<string | null>(null);
  /** What the last change did. */
  readonly report: ReadonlySignal<string | null>;
  readonly ghost: Ghost;

  /** The state from which the last change began, with its name, and the controls after it. */
  private readonly last = signal<{
    what: string;
    before: Float64Array;
    start: unknown;
    body: unknown;
  } | null>(null);
  private before: Float64Array | null = null;
  private resume = false;

  constructor(
    readonly model: Model,
    private readonly controls: Controls,
  ) {
    this.ghost = new Ghost(model);
    this.able = computed(() => controls.about.value !== null && model.about.value !== null);
    this.report = computed(() => this.reported());
  }

  dispose(): void {
    this.ghost.dispose();
  }

  /** Chooses a tool, or puts it away. */
  choose(tool: Tool): void {
    this.doing.value = null;
    this.last.value = null;
    this.tool.value = this.tool.value === tool ? "none" : tool;
  }

  /** Stops the motion and takes hold of its state, a row of `State`. A drag lets it play on; a key does not. */
  grab(byKey = false): Float64Array | null {
    const row = this.model.row.peek();
    if (!row || !this.able.peek()) return null;
    this.resume = !byKey && this.model.playing.peek();
    this.model.playing.value = false;
    this.before = row;
    return row;
  }

  /** Gives the body another state at the time of the grab; `what` names the change. */
  give(what: string, { omega, attitude, velocity }: Given): void {
    const row = this.before;
    if (!row) return;
    const three = (at: number): Triple => [row[at]!, row[at + 1]!, row[at + 2]!];
    const rotor: Quadruple = attitude
      ? [attitude.w, -attitude.x, -attitude.y, -attitude.z]
      : [row[State.rotor]!, ...three(State.rotor + 1)];
    const path = this.moves(row)
      ? { position: three(State.position), velocity: velocity?.toArray() ?? three(State.velocity) }
      : null;
    const start = startAt(rotor, omega?.toArray() ?? three(State.omegaBody), path, row[State.time]!);
    batch(() => {
      this.controls.setStart(start);
      this.last.value = { what, before: row, start, body: this.controls.body.peek() };
    });
  }

  /** Lets go; the motion plays on if it did. */
  release(): void {
    if (this.resume) this.model.playing.value = true;
    this.resume = false;
  }

  /** Whether the centre of mass has a path of its own; by now, if forces have moved it since the start. */
  moves(row: Float64Array): boolean {
    if (this.model.about.peek()?.held) return false;
    const known = this.controls.start.peek()?.path ?? null;
    return known !== null || row.subarray(State.position, State.velocity + 3).some((part) => part !== 0);
  }

  /** In words, unless something else has changed the start or the body since. */
  private reported(): string | null {
    const [last, motion] = [this.last.value, this.model.motion.value];
    const { start, body } = this.controls;
    if (!last || !motion || start.value !== last.start || body.value !== last.body) return null;
    const time = last.before[State.time]!;
    const [first, end] = span(motion.about);
    if (motion.about.start.time !== time || time < first || time > end) return null;
    return `${last.what}: ${changeOf(last.before, motion.states([time]), motion.about)}`;
  }
}
