import type { Camera, Vector2 } from "three";
import type { CurveName, Model } from "../model/model.ts";
import type { Curves } from "./curves.ts";
import { named } from "./names.ts";

/** CSS pixels from the pointer to the text. */
const AWAY = 14;

/** Says to the model which curve is under the pointer, and names it beside the pointer. */
export class Hover {
  private readonly tip = document.createElement("p");
  private request = 0;
  private name: CurveName | null = null;

  constructor(
    private readonly host: HTMLElement,
    private readonly curves: Curves,
    private readonly view: { camera: Camera; size: Vector2 },
    private readonly model: Model,
  ) {
    this.tip.className = "curve-tip";
    this.tip.setAttribute("role", "tooltip");
    this.tip.hidden = true;
    host.append(this.tip);
    host.addEventListener("pointermove", this.moved);
    host.addEventListener("pointerleave", this.left);
    host.addEventListener("pointerdown", this.left);
  }

  dispose(): void {
    this.left();
    this.tip.remove();
    this.host.removeEventListener("pointermove", this.moved);
    this.host.removeEventListener("pointerleave", this.left);
    this.host.removeEventListener("pointerdown", this.left);
  }

  private readonly moved = (event: PointerEvent): void => {
    // A finger has no place before it touches, and whoever drags turns the picture.
    if (event.pointerType === "touch" || event.buttons !== 0) return;
    const box = this.host.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    cancelAnimationFrame(this.request);
    this.request = requestAnimationFrame(() => {
      this.show(this.curves.at(x, y, this.view.camera, this.view.size), x, y);
    });
  };

  private readonly left = (): void => {
    cancelAnimationFrame(this.request);
    this.show(null, 0, 0);
  };

  private show(name: CurveName | null, x: number, y: number): void {
    if (name !== this.name) {
      this.name = name;
      this.tip.hidden = name === null;
      if (name !== null) this.tip.textContent = named(name, this.model);
      const { pointed } = this.model;
      if (name !== null) pointed.value = { curve: name };
      else if (pointed.peek()?.curve !== undefined) pointed.value = null;
    }
    if (name === null) return;
    const { clientWidth: width, clientHeight: height } = this.host;
    const left = Math.min(x + AWAY, width - this.tip.offsetWidth - 4);
    const above = y - AWAY - this.tip.offsetHeight;
    const top = above >= 4 ? above : Math.min(y + AWAY, height - this.tip.offsetHeight - 4);
    this.tip.style.translate = `${Math.max(left, 4)}px ${Math.max(top, 4)}px`;
  }
}
