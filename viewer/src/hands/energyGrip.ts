import { effect } from "@preact/signals";
import { Matrix4, type Vector2, Vector3 } from "three";
import { State } from "../core/core.ts";
import { significant } from "../format/numbers.ts";
import type { Palette } from "../palette.ts";
import { semiAxesAt } from "../stage/energy.ts";
import { quaternion, vector } from "../stage/rotor.ts";
import type { EnergyTool, Sight } from "../stage/tools.ts";
import { isBehind, moved, rayAt, under } from "./globe.ts";
import { Grip, type Holding, layerOf } from "./grip.ts";
import type { Hands } from "./hands.ts";
import { Held } from "./held.ts";

const HINT = "Drag Ω over the ellipsoid of its energy: E and the attitude stay, L changes.";

/** A grip at Ω on the energy ellipsoid. The energy and the attitude stay, and the motion follows. */
export class EnergyGrip implements EnergyTool, Holding {
  private readonly hand: Held<Vector3>;
  private grip: Grip | null = null;
  private sight: Sight | null = null;
  private globe = new Matrix4();
  /** Semi-axes √(2T/i) in rad/s at the grab, and the side of the ellipsoid that is dragged over. */
  private axes = new Vector3();
  private far = false;

  constructor(
    private readonly hands: Hands,
    private readonly palette: () => Palette,
  ) {
    this.hand = new Held(hands.model);
  }

  get held() {
    return this.hand.value;
  }

  attach(host: HTMLElement): () => void {
    const layer = layerOf(host, "Ω on the energy ellipsoid");
    const grip = (this.grip = new Grip(layer, "grip-energy", "", this));
    const { hint } = this.hands;
    const say = (): void => {
      hint.value = HINT;
    };
    const hush = (): void => {
      hint.value = null;
    };
    for (const event of ["pointerenter", "focus"]) grip.button.addEventListener(event, say);
    for (const event of ["pointerleave", "blur"]) grip.button.addEventListener(event, hush);
    const unwatch = effect(() => {
      layer.hidden = !this.hands.able.value;
    });
    return () => {
      unwatch();
      hush();
      this.hand.dispose();
      layer.remove();
    };
  }

  place(sight: Sight | null, globe: Matrix4): void {
    this.sight = sight;
    this.globe.copy(globe);
    if (!this.grip) return;
    if (!sight) return this.grip.hide();
    const omega = this.held.peek() ?? vector(sight.row, State.omegaBody);
    const parts = omega.toArray().map((part) => significant(part, 3));
    // Not the numbers of each frame while it plays.
    const at = this.hands.model.playing.peek() ? "Ω" : `Ω = (${parts.join(", ")}) rad/s in the body`;
    this.grip.describe(
      `${at}. Drag it, or move it with the arrow keys; the energy stays.`,
      this.palette().omega,
    );
    this.grip.place(this.on(omega, sight).applyMatrix4(globe), sight);
  }

  grab(byKey: boolean): boolean {
    const { sight } = this;
    const row = this.hands.grab(byKey);
    if (!row || !sight) return false;
    this.axes = semiAxesAt(row, this.hands.model.about.peek()!.body.moments);
    this.far = isBehind(this.now(row), this.globe, sight.camera);
    return true;
  }

  drag(pointer: Vector2): void {
    const { u, far } = under(rayAt(pointer, this.sight!.camera), this.globe, this.far);
    this.far = far;
    this.set(u);
  }

  step(right: number, up: number): void {
    const { sight } = this;
    this.set(moved(this.now(sight!.row), right, up, this.globe, sight!.camera));
  }

  release(): void {
    this.hand.release();
    this.hands.release();
  }

  private set(u: Vector3): void {
    const { frame } = this.hands.model.about.peek()!.body;
    const omega = u.clone().multiply(this.axes).applyQuaternion(quaternion(frame));
    this.hand.set(omega);
    this.hands.give("Ω moved over its energy ellipsoid", { omega });
  }

  /** The point of the unit sphere where Ω is, or is held. */
  private now(row: Float64Array): Vector3 {
    return this.unit(this.held.peek() ?? vector(row, State.omegaBody), this.axes);
  }

  private on(omega: Vector3, { row }: Sight): Vector3 {
    return this.unit(omega, semiAxesAt(row, this.hands.model.about.peek()!.body.moments));
  }

  private unit(omega: Vector3, axes: Vector3): Vector3 {
    const { frame } = this.hands.model.about.peek()!.body;
    return omega.clone().applyQuaternion(quaternion(frame).conjugate()).divide(axes).normalize();
  }
}
