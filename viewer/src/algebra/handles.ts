import { type Camera, Plane, Raycaster, Vector2, Vector3 } from "three";
import { AXES } from "../stage/rotor.ts";
import type { Triple } from "../core/core.ts";
import type { Thing } from "./things.ts";

/** What an arrow key moves a tip, in units of the values. */
const STEP = 0.1;

const HINT = "Arrow keys move it; with Shift, up and down move it along the view.";

/** Buttons at the tips of vectors, by which they are dragged: in the plane of the screen, or with Shift along the view. */
export class Handles {
  private readonly layer = document.createElement("div");
  private buttons: { button: HTMLButtonElement; thing: Thing }[] = [];
  private camera: Camera | null = null;
  private size = new Vector2(1, 1);

  constructor(
    host: HTMLElement,
    /** Drawn units for 1. */
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

  /** Buttons are kept from one time to the next, so that they keep focus and pointer. */
  show(things: readonly Thing[], colours: readonly string[]): void {
    while (this.buttons.length > things.length) this.buttons.pop()!.button.remove();
    things.forEach((thing, k) => {
      const entry = this.buttons[k] ?? this.add(thing);
      entry.thing = thing;
      const parts = thing.vector!.toArray().map((x) => Number(x.toFixed(2)));
      entry.button.setAttribute("aria-label", `${thing.label} = (${parts.join(", ")}). ${HINT}`);
      entry.button.title = `Drag ${thing.label}; with Shift along the view`;
      entry.button.style.color = colours[thing.colour]!;
      entry.button.dataset["handle"] = thing.label;
    });
  }

  place(camera: Camera, width: number, height: number): void {
    this.camera = camera;
    this.size.set(width, height);
    for (const { button, thing } of this.buttons) {
      const at = this.tip(thing).project(camera);
      const [x, y] = [((1 + at.x) * width) / 2, ((1 - at.y) * height) / 2];
      button.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  private tip(thing: Thing): Vector3 {
    return thing.vector!.clone().multiplyScalar(this.unit());
  }

  private add(thing: Thing): { button: HTMLButtonElement; thing: Thing } {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "handle";
    const entry = { button, thing };
    this.buttons.push(entry);
    this.layer.append(button);
    let last: { x: number; y: number; tip: Vector3 } | null = null;
    button.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      button.setPointerCapture(event.pointerId);
      last = { x: event.clientX, y: event.clientY, tip: this.tip(entry.thing) };
    });
    button.addEventListener("pointermove", (event) => {
      if (!last || !button.hasPointerCapture(event.pointerId)) return;
      // The tip is kept with all its digits here: rounded ones would stick to their place.
      const tip = this.dragged(last.tip, event.clientX - last.x, event.clientY - last.y, event.shiftKey);
      last = { x: event.clientX, y: event.clientY, tip };
      this.move(entry.thing.line, tip.clone().divideScalar(this.unit()).toArray());
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      button.addEventListener(end, () => (last = null));
    }
    button.addEventListener("keydown", (event) => this.pressed(event, entry.thing));
    return entry;
  }

  /** A tip that follows the pointer by so many pixels. */
  private dragged(tip: Vector3, dx: number, dy: number, along: boolean): Vector3 {
    const camera = this.camera!;
    const view = camera.getWorldDirection(new Vector3());
    const at = tip.clone().project(camera);
    const to = new Vector2(at.x + (2 * dx) / this.size.x, at.y - (2 * dy) / this.size.y);
    const caster = new Raycaster();
    caster.setFromCamera(to, camera);
    const plane = new Plane().setFromNormalAndCoplanarPoint(view, tip);
    const moved = caster.ray.intersectPlane(plane, new Vector3()) ?? tip.clone();
    if (!along) return moved;
    const up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    return tip.clone().addScaledVector(view, moved.sub(tip).dot(up));
  }

  /** By the axes that lie most along the screen's right and up, and for Shift along the view. */
  private pressed(event: KeyboardEvent, thing: Thing): void {
    const signs: Record<string, [0 | 1, number]> = {
      ArrowRight: [0, 1],
      ArrowLeft: [0, -1],
      ArrowUp: [1, 1],
      ArrowDown: [1, -1],
    };
    const key = signs[event.key];
    if (!key || !this.camera) return;
    event.preventDefault();
    event.stopPropagation();
    const [screen, sign] = key;
    const columns = [0, 1].map((k) => new Vector3().setFromMatrixColumn(this.camera!.matrixWorld, k));
    const right = most(columns[0]!, [0, 1, 2]);
    const up = most(
      columns[1]!,
      [0, 1, 2].filter((k) => k !== right.axis),
    );
    const deep = most(
      this.camera.getWorldDirection(new Vector3()),
      [0, 1, 2].filter((k) => k !== right.axis && k !== up.axis),
    );
    const { axis, sense } = screen === 0 ? right : event.shiftKey ? deep : up;
    const moved = thing.vector!.clone().addScaledVector(AXES[axis as 0 | 1 | 2], sign * sense * STEP);
    this.move(thing.line, moved.toArray());
  }
}

/** Which of some axes a direction goes along most, and in which sense. */
function most(direction: Vector3, axes: number[]): { axis: number; sense: number } {
  const sizes = axes.map((k) => Math.abs(direction.getComponent(k)));
  const axis = axes[sizes.indexOf(Math.max(...sizes))]!;
  return { axis, sense: Math.sign(direction.getComponent(axis)) || 1 };
}
