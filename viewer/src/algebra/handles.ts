import { type Camera, Vector2, Vector3 } from "three";
import { onScreen } from "../stage/labels.ts";
import { AXES } from "../stage/rotor.ts";
import type { Triple } from "../core/core.ts";
import type { Drawable } from "./drawables.ts";

/** How far an arrow key moves a tip, in the units of the values. */
const STEP = 0.1;

const HINT = "Arrow keys move it; Shift with up or down moves it along the view.";

/** Buttons at the tips of vectors for dragging them in the plane of the screen, or with Shift along the view. */
export class Handles {
  private readonly layer = document.createElement("div");
  private buttons: { button: HTMLButtonElement; item: Drawable }[] = [];
  private camera: Camera | null = null;
  private size = new Vector2(1, 1);

  constructor(
    host: HTMLElement,
    /** Drawn units per 1. */
    private readonly unit: () => number,
    private readonly move: (line: number, components: Triple) => void,
  ) {
    this.layer.className = "handles";
    this.layer.setAttribute("role", "group");
    this.layer.setAttribute("aria-label", "Vectors that can be moved");
    host.append(this.layer);
  }

  dispose(): void {
    this.layer.remove();
  }

  /** Reuses the buttons, so that they keep the focus and the pointer. */
  show(items: readonly Drawable[], colours: readonly string[]): void {
    while (this.buttons.length > items.length) this.buttons.pop()!.button.remove();
    items.forEach((item, k) => {
      const entry = this.buttons[k] ?? this.add(item);
      entry.item = item;
      const parts = item.vector!.toArray().map((x) => Number(x.toFixed(2)));
      entry.button.setAttribute("aria-label", `${item.label} = (${parts.join(", ")}). ${HINT}`);
      entry.button.title = `Drag ${item.label}; with Shift, along the view`;
      entry.button.style.color = colours[item.colour]!;
      entry.button.dataset["handle"] = item.label;
    });
  }

  place(camera: Camera, size: Vector2): void {
    this.camera = camera;
    this.size.copy(size);
    for (const { button, item } of this.buttons) {
      const { x, y } = onScreen(this.tip(item), camera, size.x, size.y);
      button.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  private tip(item: Drawable): Vector3 {
    return item.vector!.clone().multiplyScalar(this.unit());
  }

  private add(item: Drawable): { button: HTMLButtonElement; item: Drawable } {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "handle";
    const entry = { button, item };
    this.buttons.push(entry);
    this.layer.append(button);
    let last: { x: number; y: number; tip: Vector3 } | null = null;
    button.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      button.setPointerCapture(event.pointerId);
      last = { x: event.clientX, y: event.clientY, tip: this.tip(entry.item) };
    });
    button.addEventListener("pointermove", (event) => {
      if (!last || !button.hasPointerCapture(event.pointerId)) return;
      // All digits of the tip are kept here: a rounded tip would not follow small movements.
      const tip = this.dragged(last.tip, event.clientX - last.x, event.clientY - last.y, event.shiftKey);
      last = { x: event.clientX, y: event.clientY, tip };
      this.move(entry.item.line!, tip.clone().divideScalar(this.unit()).toArray());
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      button.addEventListener(end, () => (last = null));
    }
    button.addEventListener("keydown", (event) => this.moveByKey(event, entry.item));
    return entry;
  }

  /** The tip moved with the pointer by some pixels. */
  private dragged(tip: Vector3, dx: number, dy: number, along: boolean): Vector3 {
    const camera = this.camera!;
    const at = tip.clone().project(camera);
    const moved = at.add(new Vector3((2 * dx) / this.size.x, (-2 * dy) / this.size.y, 0)).unproject(camera);
    if (!along) return moved;
    const up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    return tip.clone().addScaledVector(camera.getWorldDirection(new Vector3()), moved.sub(tip).dot(up));
  }

  /** Moves a vector along the axis nearest to right or up on the screen, or with Shift to the view. */
  private moveByKey(event: KeyboardEvent, item: Drawable): void {
    const step = KEYS[event.key];
    if (!step || !this.camera) return;
    event.preventDefault();
    event.stopPropagation();
    const [key, sign] = step;
    const { matrixWorld } = this.camera;
    const directions = [0, 1, 2].map((k) => new Vector3().setFromMatrixColumn(matrixWorld, k));
    directions[2]!.negate();
    // Each direction takes the nearest of the axes that are left.
    const axes = [0, 1, 2];
    const steps = directions.map((direction) => {
      const axis = axes.reduce((a, b) => (size(direction, b) > size(direction, a) ? b : a));
      axes.splice(axes.indexOf(axis), 1);
      return AXES[axis as 0 | 1 | 2].clone().multiplyScalar(Math.sign(direction.getComponent(axis)) || 1);
    });
    const along = steps[key === 1 && event.shiftKey ? 2 : key]!;
    this.move(
      item.line!,
      along
        .multiplyScalar(sign * STEP)
        .add(item.vector!)
        .toArray(),
    );
  }
}

/** The direction of an arrow key, 0 to the right or 1 up, and its sign. */
const KEYS: Record<string, [0 | 1, number]> = {
  ArrowRight: [0, 1],
  ArrowLeft: [0, -1],
  ArrowUp: [1, 1],
  ArrowDown: [1, -1],
};

function size(direction: Vector3, axis: number): number {
  return Math.abs(direction.getComponent(axis));
}
