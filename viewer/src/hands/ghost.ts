import { computed, effect, type ReadonlySignal, signal, untracked } from "@preact/signals";
import { Quaternion, Vector3 } from "three";
import { Problem, State, type Triple } from "../core/core.ts";
import { Solver } from "../core/solver.ts";
import type { Motion } from "../core/wasm.ts";
import { DEGREE } from "../format/units.ts";
import { type Model, span } from "../model/model.ts";
import { AXES, quaternion } from "../stage/rotor.ts";
import { fields } from "../vary/toml.ts";

/** The angle between the two Ω at the start, rad. */
const TILT = 0.1 * DEGREE.size;

/** A second body, whose Ω at the start is a little off that of the first. Solved by the same core, in a worker. */
export class Ghost {
  readonly motion = signal<Motion | null>(null);
  /** The angle between the two attitudes, rad; null without a ghost. */
  readonly angle: ReadonlySignal<number | null>;
  /** Whether a scene can have a ghost: one of a single body that rotates. */
  readonly able: ReadonlySignal<boolean>;
  private readonly solver: Solver;
  private readonly unwatch: () => void;
  private number = 0;

  constructor(private readonly model: Model) {
    this.solver = new Solver(model.core);
    this.able = computed(() => {
      const about = model.about.value;
      if (!about || model.scene.value === null || about.ensemble !== null) return false;
      return Math.hypot(...about.start.omega_body) > 0;
    });
    this.angle = computed(() => {
      const [row, ghost] = [model.row.value, this.motion.value];
      const other = row && ghost && stateOf(ghost, row[State.time]!);
      return other && angleBetween(row, other);
    });
    this.unwatch = effect(() => {
      const wanted = model.shown.value.ghost && this.able.value;
      // For each new motion.
      void model.motion.value;
      untracked(() => void this.solve(wanted));
    });
  }

  dispose(): void {
    this.unwatch();
    this.number += 1;
    this.solver.dispose();
    this.become(null);
  }

  private async solve(wanted: boolean): Promise<void> {
    const { model } = this;
    const number = ++this.number;
    const [scene, about] = [model.scene.peek(), model.about.peek()];
    if (!wanted || scene === null || !about) {
      this.become(null);
      return;
    }
    try {
      const bivector = tilted(about.start.omega_body, about.body.frame);
      const other = model.core.merged(scene, fields("initial", { spin: { bivector } }));
      const { name, files } = model.source;
      const motion = await this.solver.solve({ scene: other, name, files });
      if (motion && number === this.number) this.become(motion);
      else motion?.close();
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      if (number === this.number) this.become(null);
    }
  }

  private become(motion: Motion | null): void {
    const old = this.motion.peek();
    this.motion.value = motion;
    old?.close();
  }
}

/** The state at a time, a row of `State`; null where the motion is not known, such as while a newer one is solved. */
export function stateOf(motion: Motion, time: number): Float64Array | null {
  const [first, last] = span(motion.about);
  return time >= first && time <= last ? motion.states([time]) : null;
}

/** Ω_B turned by the tilt towards the principal axis that is farthest from it. */
export function tilted(omega: Triple, frame: ArrayLike<number>): Triple {
  const turn = quaternion(frame);
  const size = Math.hypot(...omega);
  const unit = new Vector3(...omega).divideScalar(size);
  const axes = AXES.map((axis) => axis.clone().applyQuaternion(turn));
  const across = axes.reduce((a, b) => (Math.abs(b.dot(unit)) < Math.abs(a.dot(unit)) ? b : a));
  const towards = across.projectOnPlane(unit).normalize();
  return unit
    .multiplyScalar(Math.cos(TILT))
    .addScaledVector(towards, Math.sin(TILT))
    .setLength(size)
    .toArray();
}

/** The angle between the attitudes of two rows, from 0 to π. */
function angleBetween(a: Float64Array, b: Float64Array): number {
  const { x, y, z, w } = quaternion(a, State.rotor, new Quaternion())
    .conjugate()
    .multiply(quaternion(b, State.rotor));
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
}
