import { effect, signal } from "@preact/signals";
import type { Model } from "../model/model.ts";

/** A value that is held by the user, and afterwards until the motion that has it is solved. */
export class Held<T> {
  readonly value = signal<T | null>(null);
  readonly dispose: () => void;
  private holding = false;

  constructor(private readonly model: Model) {
    this.dispose = effect(() => {
      void model.motion.value;
      if (!model.solving.value) this.settle();
    });
  }

  set(value: T): void {
    this.holding = true;
    this.value.value = value;
  }

  release(): void {
    this.holding = false;
    // The controls ask for the motion in the next frame.
    requestAnimationFrame(() =>
      requestAnimationFrame(() => {
        if (!this.model.solving.peek()) this.settle();
      }),
    );
  }

  private settle(): void {
    if (!this.holding) this.value.value = null;
  }
}
