import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { About } from "../core/core.ts";

/** A scene of the history, and what the controls need to go on from it. */
export interface Kept {
  scene: string;
  /** The scene that the controls change, and the motion from which they take their ranges. */
  base: string | null;
  opened: About | null;
  /** The values of the controls; null before they exist. */
  controls: unknown;
}

/** Maximum number of steps that can be undone. */
const BOUND = 100;
/** Changes without a press of a button or a key within this time in ms are one step. */
const PAUSE = 1000;

/**
 * The changes of a scene, to be undone and redone. A drag of a slider or a handle changes the scene many times: changes
 * with the same number are one step.
 */
export class History {
  /** The scene shown, as it is kept when the next step is made. */
  present: Kept | null = null;
  readonly undoable: ReadonlySignal<boolean>;
  readonly redoable: ReadonlySignal<boolean>;
  private readonly past = signal<readonly Kept[]>([]);
  private readonly future = signal<readonly Kept[]>([]);
  private step = 0;
  private recorded = -1;
  private held = false;
  private last = -Infinity;

  constructor() {
    this.undoable = computed(() => this.past.value.length > 0);
    this.redoable = computed(() => this.future.value.length > 0);
  }

  /** Begins a step; `held` while a pointer is down. */
  begin(held = false): void {
    this.step += 1;
    this.held = held;
    this.last = performance.now();
  }

  /** The pointer is up: what it has changed may still be solved. */
  end(): void {
    this.held = false;
    this.last = performance.now();
  }

  /** The number of the step to which a change belongs that is made now. */
  stamp(): number {
    const now = performance.now();
    if (!this.held && now - this.last > PAUSE) this.step += 1;
    this.last = now;
    return this.step;
  }

  /** Takes the scene after a change. */
  record(kept: Kept, step: number): void {
    if (this.present && step !== this.recorded && kept.scene !== this.present.scene) {
      this.past.value = [...this.past.value, this.present].slice(-BOUND);
      this.future.value = [];
      this.recorded = step;
    }
    this.present = kept;
  }

  /** Begins with another scene. */
  clear(kept: Kept | null): void {
    [this.past.value, this.future.value, this.present] = [[], [], kept];
    this.recorded = -1;
  }

  /** The scene before the last step, which is now the present one; null if there is none. */
  back(): Kept | null {
    return this.move(this.past, this.future);
  }

  /** The scene after the step that was undone last. */
  forth(): Kept | null {
    return this.move(this.future, this.past);
  }

  private move(from: typeof this.past, to: typeof this.past): Kept | null {
    const kept = from.value.at(-1);
    if (!kept || !this.present) return null;
    from.value = from.value.slice(0, -1);
    to.value = [...to.value, this.present];
    this.present = kept;
    this.recorded = -1;
    this.begin();
    return kept;
  }
}
