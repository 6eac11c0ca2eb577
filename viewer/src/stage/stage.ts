import { effect, type ReadonlySignal } from "@preact/signals";
import {
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  LineSegments,
  Mesh,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { State } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import type { CameraName, Shown } from "../document.ts";
import type { Model } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { Body } from "./body.ts";
import { Viewpoint } from "./camera.ts";
import { Crowd } from "./crowd.ts";
import { Disc, MOMENTUM, OMEGA } from "./disc.ts";
import { figureOf } from "./figure.ts";
import { BodyFrame, SpaceFrame } from "./frames.ts";
import { Gravity } from "./gravity.ts";
import { Labels } from "./labels.ts";
import type { Instant, Part } from "./part.ts";
import { Paths } from "./paths.ts";
import { Poinsot } from "./poinsot.ts";
import type { Screen } from "./ribbon.ts";
import { quaternion, vector } from "./rotor.ts";

/** WebGL 2 is not available. */
export class NoWebGL extends Error {
  override message =
    "No 3-d picture: WebGL 2 is missing or switched off in this browser. All values are shown.";
}

const LOST = "The graphics context was lost; the picture returns when the browser restores it.";

/** Options of a captured picture; width and height are in pixels. */
export interface PictureOptions {
  width: number;
  height: number;
  /** Pixels per CSS pixel, the unit of letters and lines. */
  scale: number;
  /** Seconds for which the motion has played: arrowheads run around the discs. */
  played?: number;
  /** Azimuth from e1 towards e2 and elevation above e1∧e2, in degrees; by default those of the model's camera. */
  view?: [azimuth: number, elevation: number];
  /** Texts at the top and at the bottom. */
  title?: string;
  note?: string;
}

/** The font of these texts, and their distance from the edges in CSS pixels. */
const CAPTION = '15px "DejaVu Sans", "Liberation Sans", system-ui, sans-serif';
const MARGIN = 16;

/** The longest step in s, so that a page that was hidden continues where it was. */
const LONGEST = 0.1;

/**
 * The picture of a model's motion, which fills its element. It draws when something has changed, and advances the time
 * of the model while it plays.
 */
export class Stage {
  private readonly canvas = document.createElement("canvas");
  private readonly message = document.createElement("p");
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  /** Space axes, which turn back under a camera that turns with the body. */
  private readonly space = new Group();
  private readonly turning = new Group();
  private readonly hemisphere = new HemisphereLight();
  private readonly lamp = new DirectionalLight();
  private readonly labels = new Labels();
  private readonly screen: Screen = { value: new Vector2(1, 1) };
  private readonly viewpoint: Viewpoint;
  private readonly paths: Paths;
  private readonly crowd = new Crowd();
  private readonly parts: Part[];
  private readonly calm = matchMedia("(prefers-reduced-motion: reduce)");
  private readonly observer: ResizeObserver;
  private readonly unwatch: () => void;

  private motion: Motion | null = null;
  private painted: Palette | null = null;
  private camera: CameraName | null = null;
  private fitting = false;
  private request = 0;
  private last: number | null = null;
  private played = 0;
  private drawn = 0;
  private spent = 0;
  private lost = false;
  /** Whether the host has a size. */
  private seen = false;
  /** Whether a frame is being drawn: its own changes request no other. */
  private drawing = false;

  constructor(
    private readonly host: HTMLElement,
    private readonly model: Model,
    private readonly palette: ReadonlySignal<Palette>,
  ) {
    const context = this.canvas.getContext("webgl2", {
      antialias: true,
      powerPreference: "high-performance",
    });
    if (!context) throw new NoWebGL();
    this.renderer = new WebGLRenderer({ canvas: this.canvas, context });
    this.viewpoint = new Viewpoint(this.canvas, this.draw, this.fit);
    this.paths = new Paths(this.screen);
    const calm = () => this.calm.matches;
    this.parts = [
      new Body(),
      new BodyFrame(this.screen, this.labels),
      new SpaceFrame(this.screen, this.labels),
      new Disc(this.screen, this.labels, OMEGA, calm),
      new Disc(this.screen, this.labels, MOMENTUM, calm),
      new Poinsot(this.screen),
      this.paths,
      new Gravity(this.screen, this.labels),
      this.crowd,
    ];
    for (const { inSpace, inBody } of this.parts) {
      if (inSpace) this.space.add(inSpace);
      if (inBody) this.turning.add(inBody);
    }
    this.space.add(this.turning);
    // The lamp moves with the camera, at its upper left.
    this.lamp.position.set(-3, 4, 6);
    this.viewpoint.camera.add(this.lamp, this.lamp.target);
    this.hemisphere.position.set(0, 0, 1);
    this.scene.add(this.space, this.viewpoint.camera, this.hemisphere);
    this.furnish();
    this.observer = new ResizeObserver(this.resize);
    this.observer.observe(host);
    this.unwatch = effect(() => {
      const { model } = this;
      for (const watched of [model.motion, model.row, model.shown, model.camera, model.playing, palette]) {
        void watched.value;
      }
      this.draw();
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    this.request = 0;
    this.lost = true;
    this.unwatch();
    this.observer.disconnect();
    this.viewpoint.dispose();
    for (const part of this.parts) part.dispose();
    this.renderer.dispose();
    // Browsers limit the number of contexts; a notebook has many stages.
    this.renderer.forceContextLoss();
    this.canvas.remove();
    this.labels.element.remove();
    this.message.remove();
  }

  /** Returns to the preset of the model's camera. */
  readonly fit = (): void => {
    this.fitting = true;
    this.draw();
  };

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
      this.forget();
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.lost = false;
      this.say(null);
      this.resize();
    });
    message.setAttribute("role", "status");
    message.style.cssText = "position: absolute; inset: auto 1rem 1rem; margin: 0; text-align: center";
    if (getComputedStyle(host).position === "static") host.style.position = "relative";
    host.append(canvas, this.labels.element, message);
    this.say(null);
  }

  /** Shows a message, or none; `alone` hides the picture. */
  private say(message: string | null, alone = false): void {
    this.message.textContent = message;
    this.message.style.display = message ? "" : "none";
    for (const element of [this.canvas, this.labels.element])
      element.style.visibility = alone ? "hidden" : "";
  }

  /** Releases the resources of the lost context. */
  private forget(): void {
    this.scene.traverse((object) => {
      if (!(object instanceof Mesh || object instanceof LineSegments)) return;
      object.geometry.dispose();
      for (const material of [object.material].flat()) material.dispose();
    });
  }

  /** Requests a frame. */
  private readonly draw = (): void => {
    if (this.request === 0 && !this.lost && !this.drawing) this.request = requestAnimationFrame(this.frame);
  };

  private readonly resize = (): void => {
    const { clientWidth: width, clientHeight: height } = this.host;
    this.seen = width > 0 && height > 0;
    if (!this.seen || this.lost) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.screen.value.set(width, height);
    this.viewpoint.resize(width, height);
    // At once: resizing has cleared the canvas.
    cancelAnimationFrame(this.request);
    this.frame(performance.now());
  };

  /** Draws the present state with its labels at once, in any size. For stages whose host has none. */
  picture(options: PictureOptions): HTMLCanvasElement {
    const { width, height, scale, view, title = "", note = "" } = options;
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    const size = new Vector2(width / scale, height / scale);
    if (!size.equals(this.screen.value)) {
      this.renderer.setPixelRatio(1);
      this.renderer.setSize(width, height, false);
      this.screen.value.copy(size);
      this.viewpoint.resize(width, height);
    }
    this.played = options.played ?? 0;
    if (view) {
      this.camera = this.model.camera.peek();
      this.viewpoint.from(...view);
    }
    this.show();
    const context = canvas.getContext("2d")!;
    context.drawImage(this.canvas, 0, 0);
    context.scale(scale, scale);
    this.labels.draw(context);
    context.fillStyle = this.palette.peek().text;
    context.font = CAPTION;
    const room = size.x - 2 * MARGIN;
    context.fillText(title, MARGIN, MARGIN + 11, room);
    context.fillText(note, MARGIN, size.y - MARGIN, room);
    return canvas;
  }

  private readonly frame = (now: number): void => {
    this.request = 0;
    const began = performance.now();
    const passed = this.last === null ? 0 : Math.min((now - this.last) / 1000, LONGEST);
    const playing = this.model.playing.peek();
    this.drawing = true;
    try {
      if (playing) {
        this.model.tick(passed);
        this.played += passed;
      }
      this.viewpoint.step(passed);
      if (this.seen) this.show();
    } finally {
      this.drawing = false;
    }
    const going = playing || this.viewpoint.moving;
    this.last = going ? now : null;
    if (going) this.draw();
    const took = performance.now() - began;
    this.spent += (took - this.spent) * (this.drawn < 10 ? 0.5 : 0.1);
    this.drawn += 1;
    this.host.dataset.drawn = String(this.drawn);
    this.host.dataset.frameMs = this.spent.toFixed(3);
    this.host.dataset.points = String(this.paths.points);
  };

  /** Draws the present state. */
  private show(): void {
    const { model, renderer, viewpoint } = this;
    const shown = model.shown.peek();
    this.follow();
    this.paint();
    const row = model.row.peek();
    this.space.visible = row !== null;
    if (row) {
      // The camera first: space and labels depend on it.
      this.stand(vector(row, State.momentumSpace));
      const instant = this.instant(row);
      this.turning.quaternion.copy(instant.attitude);
      for (const part of this.parts) part.update(instant, shown);
      const { problem } = this.crowd;
      this.say(problem && `The other bodies are not drawn: ${problem}`);
      const description = this.description(shown);
      if (this.canvas.ariaLabel !== description) this.canvas.ariaLabel = description;
    }
    this.scene.updateMatrixWorld();
    this.labels.place(
      viewpoint.camera,
      this.space.matrixWorld,
      this.screen.value,
      shown.labels && row !== null,
    );
    renderer.render(this.scene, viewpoint.camera);
  }

  private follow(): void {
    const motion = this.model.motion.peek();
    if (!motion || motion === this.motion) return;
    const figure = figureOf(motion);
    for (const part of this.parts) part.follow(figure);
    // Look at an upright top above its tip.
    const start = quaternion(figure.about.start.rotor);
    const top = figure.traced.clone().applyQuaternion(start).z;
    this.viewpoint.look(new Vector3(0, 0, figure.about.held ? Math.max(0.2 * top, 0) : 0));
    this.motion = motion;
  }

  private paint(): void {
    const palette = this.palette.peek();
    if (palette === this.painted) return;
    this.painted = palette;
    const background = new Color(palette.background);
    const dark = background.getHSL({ h: 0, s: 0, l: 0 }).l < 0.5;
    this.renderer.setClearColor(background);
    this.host.style.backgroundColor = palette.background;
    this.hemisphere.color.set("#ffffff");
    this.hemisphere.groundColor.set(dark ? "#58606c" : "#aeb6c0");
    this.hemisphere.intensity = dark ? 2.1 : 2.2;
    this.lamp.intensity = dark ? 2.0 : 1.9;
    this.message.style.color = palette.text;
    this.labels.paint(palette.background);
    for (const part of this.parts) part.paint(palette);
  }

  /** Moves to the model's camera if it has changed or a fit was requested. */
  private stand(momentum: Vector3): void {
    const name = this.model.camera.peek();
    if (name === this.camera && !this.fitting) return;
    this.viewpoint.go(name, momentum, this.camera === null || this.calm.matches);
    this.camera = name;
    this.fitting = false;
  }

  private instant(row: Float64Array): Instant {
    const attitude = quaternion(row, State.rotor);
    const { camera, withBody } = this.viewpoint;
    this.space.quaternion.identity().slerp(attitude.clone().invert(), withBody);
    const toSpace = this.space.quaternion.clone().invert().multiply(camera.quaternion);
    const omegaBody = vector(row, State.omegaBody);
    return {
      time: row[State.time]!,
      attitude,
      omega: vector(row, State.omegaSpace),
      omegaBody,
      momentum: vector(row, State.momentumSpace),
      doubleKinetic: omegaBody.dot(vector(row, State.momentumBody)),
      right: new Vector3(1, 0, 0).applyQuaternion(toSpace),
      up: new Vector3(0, 1, 0).applyQuaternion(toSpace),
      played: this.played,
    };
  }

  private description(shown: Shown): string {
    const about = this.motion?.about;
    const things: [boolean, string][] = [
      [shown.body, "the body"],
      [shown.bodyFrame, "its axes f1, f2, f3"],
      [shown.spaceFrame, "the axes e1, e2, e3 of space"],
      [shown.omega, "the angular velocity Ω as an oriented disc"],
      [shown.momentum, "the angular momentum L as an oriented disc"],
      [shown.poinsot, "Poinsot's ellipsoid on the invariable plane"],
      [shown.polhode, "the polhode"],
      [shown.herpolhode, "the herpolhode"],
      [shown.trace, "the path of an axis of the body"],
      [shown.gravity && about?.held === true, "the pivot and the weight"],
    ];
    const drawn = things.filter(([seen]) => seen).map(([, thing]) => thing);
    const bodies = about?.ensemble ? ` One of ${about.ensemble} bodies.` : "";
    return `${about?.title ?? "A rigid body in motion"}.${bodies} Drawn: ${drawn.join(", ") || "nothing"}. Arrow keys turn the view, + and − zoom, Home goes back.`;
  }
}
