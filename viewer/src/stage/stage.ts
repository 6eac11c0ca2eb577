import type { ReadonlySignal } from "@preact/signals";
import { Group, Vector2, Vector3 } from "three";
import { State } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import type { CameraName, Shown } from "../document.ts";
import type { Model } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { body } from "./body.ts";
import { crowd } from "./crowd.ts";
import { disc, MOMENTUM, OMEGA } from "./disc.ts";
import { figureOf } from "./figure.ts";
import { frame } from "./frames.ts";
import { gravity } from "./gravity.ts";
import type { Instant, Part, Setting } from "./part.ts";
import { Paths } from "./paths.ts";
import { level, poinsot } from "./poinsot.ts";
import { quaternion, vector } from "./rotor.ts";
import { shadow } from "./shadow.ts";
import { tip } from "./tip.ts";
import { Viewport } from "./viewport.ts";

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

/** The picture of a model's motion, which advances the time of the model while it plays. */
export class Stage extends Viewport {
  /** The objects in body axes. */
  private turning = new Group();
  private parts: Part[] = [];
  private paths: Paths | null = null;
  private motion: Motion | null = null;
  private painted: Palette | null = null;
  private camera: CameraName | null = null;
  /** The motion whose invariable plane is horizontal. */
  private levelled: Motion | null = null;
  /** Whether a captured picture has a view in space axes. */
  private given = false;
  private fitting = false;
  private played = 0;
  private shownAt = Number.NaN;
  private whole = false;

  constructor(
    host: HTMLElement,
    private readonly model: Model,
    private readonly palette: ReadonlySignal<Palette>,
  ) {
    super(host);
    let fitted = model.fitted.peek();
    let turned = model.turned.peek();
    this.watch(() => {
      this.fitting ||= model.fitted.value > fitted;
      fitted = model.fitted.value;
      const turn = model.turned.value;
      if (turn && turn !== turned) this.viewpoint.turn(turn);
      turned = turn;
      const { motion, row, shown, marked, camera, playing } = model;
      for (const watched of [motion, row, shown, marked, camera, playing, palette]) void watched.value;
    });
  }

  /** Returns to the preset of the model's camera. */
  override home(): void {
    this.fitting = true;
    this.draw();
  }

  /** Draws the present state with its labels at once, in any size. For stages whose host has none. */
  picture(options: PictureOptions): HTMLCanvasElement {
    const { width, height, scale, view, title = "", note = "" } = options;
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [width, height];
    const size = new Vector2(width / scale, height / scale);
    if (!size.equals(this.screen.value)) this.fill(size.x, size.y, scale);
    this.played = options.played ?? 0;
    this.given = view !== undefined;
    if (view) {
      this.camera = this.model.camera.peek();
      this.levelled = null;
      this.viewpoint.upright.identity();
      this.viewpoint.from(...view);
    }
    this.whole = true;
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

  protected override advance(seconds: number): boolean {
    const playing = this.model.playing.peek();
    if (playing) {
      this.model.tick(seconds);
      this.played += seconds;
    }
    return playing;
  }

  protected override get unfinished(): boolean {
    return this.paths?.unfinished ?? false;
  }

  protected override show(): void {
    const { model } = this;
    const shown = model.shown.peek();
    this.build();
    const row = model.row.peek();
    this.space.visible = row !== null;
    if (row) {
      // The camera first: space and labels depend on it.
      this.stand(vector(row, State.omegaSpace), vector(row, State.momentumSpace));
      const instant = this.instant(row);
      this.turning.quaternion.copy(instant.attitude);
      for (const part of this.parts) part.update(instant, shown);
      const description = this.description(shown);
      if (this.canvas.ariaLabel !== description) this.canvas.ariaLabel = description;
    }
    const time = model.time.peek();
    const steady = !this.whole && (model.playing.peek() || time === this.shownAt);
    this.shownAt = time;
    this.render(shown.labels && row !== null, steady);
    this.host.dataset.points = String(this.paths?.points ?? 0);
  }

  /** Builds the parts for a new motion or other colours. */
  private build(): void {
    const [motion, palette] = [this.model.motion.peek(), this.palette.peek()];
    if (motion === this.motion && palette === this.painted) return;
    [this.motion, this.painted, this.parts] = [motion, palette, []];
    this.replace(palette);
    this.say(null);
    this.paths = null;
    if (!motion) return;
    const figure = figureOf(motion);
    const setting: Setting = {
      figure,
      palette,
      screen: this.screen,
      labels: this.labels,
      calm: this.calm,
      say: (message) => this.say(message),
    };
    this.paths = new Paths(setting);
    const parts = [
      body(setting),
      frame(setting, "body"),
      frame(setting, "space"),
      disc(setting, OMEGA),
      disc(setting, MOMENTUM),
      poinsot(setting),
      this.paths,
      tip(setting, () => this.model.marked.peek()),
      gravity(setting),
      shadow(setting),
      crowd(setting),
    ];
    this.parts = parts.filter((part) => part !== null);
    this.turning = new Group();
    this.space.add(this.turning);
    for (const { inSpace, inBody } of this.parts) {
      if (inSpace) this.space.add(inSpace);
      if (inBody) this.turning.add(inBody);
    }
    // Look at an upright top above its tip.
    const top = figure.traced.clone().applyQuaternion(quaternion(figure.about.start.rotor)).z;
    this.viewpoint.look(new Vector3(0, 0, figure.about.held ? Math.max(0.2 * top, 0) : 0));
  }

  /** Moves to the model's camera if it has changed or a fit was requested. */
  private stand(omega: Vector3, momentum: Vector3): void {
    const name = this.model.camera.peek();
    // Poinsot's plane is at rest if L is.
    const still = this.model.shown.peek().poinsot && (this.motion?.about.free ?? null) !== null;
    const turned = name === "oblique" && still && !this.given && momentum.length() > 0;
    const levelled = turned ? this.motion : null;
    const upright = levelled && level(omega, momentum);
    const before = this.levelled;
    this.levelled = levelled;
    if (name === this.camera && !this.fitting && (before === null) === (levelled === null)) {
      // The user's view is kept while sliders move.
      if (upright && before !== levelled) this.viewpoint.upright.copy(upright);
      return;
    }
    this.viewpoint.go(name, momentum, this.camera === null || this.calm.matches, upright);
    this.camera = name;
    this.fitting = false;
  }

  private instant(row: Float64Array): Instant {
    const attitude = quaternion(row, State.rotor);
    const { upright, withBody } = this.viewpoint;
    this.space.quaternion.copy(upright).slerp(attitude.clone().invert(), withBody);
    return {
      time: row[State.time]!,
      attitude,
      omega: vector(row, State.omegaSpace),
      momentum: vector(row, State.momentumSpace),
      doubleKinetic: vector(row, State.omegaBody).dot(vector(row, State.momentumBody)),
      ...this.directions(),
      played: this.played,
      whole: this.whole,
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
      [shown.energy, "the tip of Ω"],
      [shown.gravity && about?.held === true, "the pivot and the weight"],
    ];
    const drawn = things.filter(([seen]) => seen).map(([, thing]) => thing);
    const bodies = about?.ensemble ? ` One of ${about.ensemble} bodies.` : "";
    return `${about?.title ?? "A rigid body in motion"}.${bodies} Drawn: ${drawn.join(", ") || "nothing"}. The keys I, J, K and L turn the view, + and − zoom, F fits it.`;
  }
}
