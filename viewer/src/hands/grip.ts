import { Vector2, type Vector3 } from "three";
import { onScreen } from "../stage/labels.ts";
import type { Sight } from "../stage/tools.ts";

/** The angle of an arrow key, and with Shift, rad. */
const STEP = (2 * Math.PI) / 180;
const FINE = STEP / 20;

/** What a grip moves. */
export interface Holding {
  /** Takes hold; false if there is nothing to move. `byKey` for one step of an arrow key. */
  grab(byKey: boolean): boolean;
  /** The pointer is at a point of the picture, in coordinates from −1 to 1. */
  drag(pointer: Vector2): void;
  /** Moves it by an angle to the right and up on the screen. */
  step(right: number, up: number): void;
  release(): void;
}

/** A round button over a picture, at a point of it, to be dragged or moved by arrow keys. */
export class Grip {
  readonly button = document.createElement("button");
  private sight: Sight | null = null;
  private readonly at = new Vector2();

  constructor(
    layer: HTMLElement,
    id: string,
    text: string,
    private readonly holding: Holding,
  ) {
    const { button } = this;
    button.type = "button";
    button.id = id;
    button.className = "grip";
    button.textContent = text;
    // Until a frame places it.
    button.hidden = true;
    layer.append(button);
    // Where the pointer is off the middle of the button.
    let off: Vector2 | null = null;
    button.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !this.sight || !holding.grab(false)) return;
      button.setPointerCapture(event.pointerId);
      off = this.at.clone().sub(this.pixels(event));
    });
    button.addEventListener("pointermove", (event) => {
      if (!off || !this.sight || !button.hasPointerCapture(event.pointerId)) return;
      const { x, y } = this.pixels(event).add(off);
      const { size } = this.sight;
      holding.drag(new Vector2((2 * x) / size.x - 1, 1 - (2 * y) / size.y));
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      button.addEventListener(end, () => {
        if (off) holding.release();
        off = null;
      });
    }
    button.addEventListener("keydown", (event) => this.press(event));
  }

  /** Says what the grip is and where it stands. */
  describe(label: string, colour: string): void {
    if (this.button.ariaLabel !== label) this.button.ariaLabel = this.button.title = label;
    this.button.style.color = colour;
  }

  hide(): void {
    this.button.hidden = true;
  }

  /** Moves it to a point of the world; null hides it. */
  place(point: Vector3 | null, sight: Sight): void {
    this.sight = sight;
    this.button.hidden = point === null;
    if (!point) return;
    const { x, y } = onScreen(point.clone(), sight.camera, sight.size.x, sight.size.y);
    this.at.set(x, y);
    this.button.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
  }

  /** The place of the pointer in the picture. */
  private pixels(event: PointerEvent): Vector2 {
    const { left, top } = this.button.parentElement!.getBoundingClientRect();
    return new Vector2(event.clientX - left, event.clientY - top);
  }

  private press(event: KeyboardEvent): void {
    const way = ARROWS[event.key];
    if (!way || event.ctrlKey || event.metaKey || event.altKey || !this.sight) return;
    event.preventDefault();
    event.stopPropagation();
    if (!this.holding.grab(true)) return;
    const angle = event.shiftKey ? FINE : STEP;
    this.holding.step(way[0] * angle, way[1] * angle);
    this.holding.release();
  }
}

/** Arrow keys: to the right and up. */
export const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowRight: [1, 0],
  ArrowLeft: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** The layer of the grips of a picture. */
export function layerOf(host: HTMLElement, label: string): HTMLElement {
  const layer = document.createElement("div");
  layer.className = "grips";
  layer.setAttribute("role", "group");
  layer.ariaLabel = label;
  host.append(layer);
  return layer;
}
