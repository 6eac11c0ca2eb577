import { effect } from "@preact/signals";
import {
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  InstancedMesh,
  LineSegments,
  Mesh,
  type Object3D,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Palette } from "../palette.ts";
import { Viewpoint } from "./camera.ts";
import { Curves } from "./curves.ts";
import { Labels } from "./labels.ts";
import type { Screen } from "./ribbon.ts";
import type { Sight } from "./tools.ts";

/** WebGL 2 is not available. */
class NoWebGL extends Error {
  override message =
    "No 3-d picture: WebGL 2 is missing or switched off in this browser. All values are shown.";
}

const LOST = "The graphics context was lost; the picture returns when the browser restores it.";

/** The longest step in s, so that a page that was hidden continues where it was. */
export const LONGEST_STEP = 0.1;

/** The viewports by their hosts. */
const inHosts = new WeakMap<HTMLElement, Viewport>();

/** The picture in a host with its labels, at a number of pixels per CSS pixel; null if there is none. */
export function pictureIn(host: HTMLElement, scale: number): HTMLCanvasElement | null {
  return inHosts.get(host)?.pictured(scale) ?? null;
}

/** A 3-d picture with labels that fills its host. A frame is drawn only when something has changed. */
export abstract class Viewport {
  protected readonly canvas = document.createElement("canvas");
  protected readonly renderer: WebGLRenderer;
  protected readonly labels = new Labels();
  protected readonly curves = new Curves();
  protected readonly screen: Screen = { value: new Vector2(1, 1) };
  protected readonly viewpoint: Viewpoint;
  /** What is drawn, in space axes. */
  protected readonly space = new Group();
  protected readonly calm = matchMedia("(prefers-reduced-motion: reduce)");
  private readonly scene = new Scene();
  private readonly hemisphere = new HemisphereLight();
  private readonly lamp = new DirectionalLight();
  private readonly message = document.createElement("p");
  private readonly observer = new ResizeObserver(() => this.resize());
  private unwatch = () => {};
  /** Objects to release after the next frame, so that new ones reuse their shader programs. */
  private old: Object3D[] = [];
  private request = 0;
  private last: number | null = null;
  private drawn = 0;
  private spent = 0;
  private lost = false;
  /** Whether the host has a size. */
  private seen = false;
  /** Whether a frame is being drawn: its own changes request no other. */
  private drawing = false;

  constructor(protected readonly host: HTMLElement) {
    const context = this.canvas.getContext("webgl2", {
      antialias: true,
      powerPreference: "high-performance",
    });
    if (!context) throw new NoWebGL();
    this.renderer = new WebGLRenderer({ canvas: this.canvas, context });
    this.viewpoint = new Viewpoint(this.canvas, this.draw);
    // The lamp moves with the camera, at its upper left.
    this.lamp.position.set(-3, 4, 6);
    this.viewpoint.camera.add(this.lamp, this.lamp.target);
    this.hemisphere.position.set(0, 0, 1);
    this.scene.add(this.space, this.viewpoint.camera, this.hemisphere);
    this.furnish();
    this.observer.observe(host);
    inHosts.set(host, this);
  }

  /** Returns to the first view. */
  abstract home(): void;

  /** Draws the present state by `render`. */
  protected abstract show(): void;

  /** Advances by some seconds before a frame; returns whether there is more to come. */
  protected advance(_seconds: number): boolean {
    return false;
  }

  /** Whether a frame has left something to the next ones. */
  protected get unfinished(): boolean {
    return false;
  }

  /** What is on the screen, with its labels, in other pixels. */
  pictured(scale: number): HTMLCanvasElement | null {
    if (!this.seen || this.lost) return null;
    const { clientWidth: width, clientHeight: height } = this.host;
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width * scale, height * scale];
    const context = canvas.getContext("2d")!;
    this.drawing = true;
    try {
      this.fill(width, height, scale);
      this.show();
      context.drawImage(this.canvas, 0, 0, canvas.width, canvas.height);
      context.scale(scale, scale);
      this.labels.draw(context);
    } finally {
      this.drawing = false;
      this.resize();
    }
    return canvas;
  }

  dispose(): void {
    inHosts.delete(this.host);
    cancelAnimationFrame(this.request);
    this.lost = true;
    this.unwatch();
    this.observer.disconnect();
    this.viewpoint.dispose();
    release(this.scene);
    this.renderer.dispose();
    // Browsers limit the number of contexts; a notebook has many pictures.
    this.renderer.forceContextLoss();
    for (const element of [this.canvas, this.labels.element, this.message]) element.remove();
  }

  /** Requests a frame. */
  protected readonly draw = (): void => {
    if (this.request === 0 && !this.lost && !this.drawing) this.request = requestAnimationFrame(this.frame);
  };

  /** Draws a frame now, and after each change of a signal that `act` reads. */
  protected watch(act: () => void): void {
    this.unwatch = effect(() => {
      act();
      this.draw();
    });
  }

  /** Replaces what is drawn; the labels go at once. */
  protected replace(palette: Palette): void {
    this.old.push(...this.space.children);
    this.space.clear();
    this.labels.clear();
    this.curves.clear();
    const background = new Color(palette.background);
    const dark = background.getHSL({ h: 0, s: 0, l: 0 }).l < 0.5;
    this.renderer.setClearColor(background);
    this.host.style.backgroundColor = palette.background;
    this.hemisphere.groundColor.set(dark ? "#58606c" : "#aeb6c0");
    this.hemisphere.intensity = dark ? 2.1 : 2.2;
    this.lamp.intensity = dark ? 2.0 : 1.9;
    this.message.style.color = palette.text;
    this.labels.palette = palette;
  }

  /** Right and up on the screen, in space axes. */
  protected directions(): { right: Vector3; up: Vector3 } {
    const turn = this.space.quaternion.clone().invert().multiply(this.viewpoint.camera.quaternion);
    return {
      right: new Vector3(1, 0, 0).applyQuaternion(turn),
      up: new Vector3(0, 1, 0).applyQuaternion(turn),
    };
  }

  /** What tools need of the frame that was drawn; null without a state. */
  protected sight(row: Float64Array | null): Sight | null {
    if (!row) return null;
    const { camera } = this.viewpoint;
    return { camera, space: this.space.matrixWorld.clone(), size: this.screen.value, row };
  }

  /** Draws; labels of a `steady` picture, which follows the last one without a jump, keep their places. */
  protected render(labelled: boolean, steady = true): void {
    const { camera } = this.viewpoint;
    this.labels.calm = this.calm.matches;
    this.scene.updateMatrixWorld();
    this.labels.place(camera, this.space.matrixWorld, this.screen.value, labelled, steady);
    this.renderer.render(this.scene, camera);
    this.old.splice(0).forEach(release);
  }

  /** Shows a message, or none; `alone` hides the picture. */
  protected say(message: string | null, alone = false): void {
    this.message.textContent = message;
    this.message.style.display = message ? "" : "none";
    for (const element of [this.canvas, this.labels.element])
      element.style.visibility = alone ? "hidden" : "";
  }

  /** Adapts to a size in CSS pixels. */
  protected fill(width: number, height: number, ratio: number): void {
    this.renderer.setSize(Math.round(width * ratio), Math.round(height * ratio), false);
    this.labels.resize(width, height, ratio);
    this.screen.value.set(width, height);
    this.viewpoint.resize(width, height);
  }

  /** Adds canvas, labels and message to the host. */
  private furnish(): void {
    const { canvas, host, message } = this;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.style.cssText =
      "position: absolute; inset: 0; width: 100%; height: 100%; outline-offset: -2px; cursor: grab";
    canvas.addEventListener("webglcontextlost", (event) => {
      // Allows the browser to restore the context.
      event.preventDefault();
      this.lost = true;
      this.say(LOST, true);
      release(this.scene);
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.lost = false;
      this.say(null);
      this.resize();
    });
    message.setAttribute("role", "status");
    message.style.cssText = "position: absolute; inset: auto 1rem 2.4rem; margin: 0; text-align: center";
    if (getComputedStyle(host).position === "static") host.style.position = "relative";
    host.append(canvas, this.labels.element, message);
    this.say(null);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    this.seen = width > 0 && height > 0;
    if (!this.seen || this.lost) return;
    this.fill(width, height, Math.min(devicePixelRatio, 2));
    // At once: resizing has cleared the canvas.
    cancelAnimationFrame(this.request);
    this.frame(performance.now());
  }

  private readonly frame = (now: number): void => {
    this.request = 0;
    const began = performance.now();
    const passed = this.last === null ? 0 : Math.min((now - this.last) / 1000, LONGEST_STEP);
    let going = false;
    this.drawing = true;
    try {
      going = this.advance(passed);
      this.viewpoint.step(passed);
      if (this.seen) this.show();
    } finally {
      this.drawing = false;
    }
    going ||= this.viewpoint.moving || (this.seen && (this.unfinished || this.labels.gliding));
    this.last = going ? now : null;
    if (going) this.draw();
    const took = performance.now() - began;
    this.spent += (took - this.spent) * (this.drawn < 10 ? 0.5 : 0.1);
    this.drawn += 1;
    this.canvas.dataset.camera = this.viewpoint.camera.position.toArray().join(" ");
    const { upright } = this.viewpoint;
    this.canvas.dataset.upright = upright.toArray().join(" ");
    this.host.dataset.complete = String(!this.unfinished);
    this.host.dataset.drawn = String(this.drawn);
    this.host.dataset.frameMs = this.spent.toFixed(3);
  };
}

/** Releases what an object and those in it hold on the graphics card. */
function release(root: Object3D): void {
  root.traverse((object) => {
    if (!(object instanceof Mesh || object instanceof LineSegments)) return;
    if (object instanceof InstancedMesh) object.dispose();
    object.geometry.dispose();
    for (const material of [object.material].flat()) material.dispose();
  });
}
