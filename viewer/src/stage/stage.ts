import type { ReadonlySignal } from "@preact/signals";
import { Box2, Group, Vector2, Vector3 } from "three";
import { type About, State } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import type { CameraName, Pose, Shown } from "../document.ts";
import { namedAxes } from "./axes.ts";
import type { Covered, Model } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { acting } from "./acting.ts";
import { body } from "./body.ts";
import { crowd } from "./crowd.ts";
import { disc, MOMENTUM, OMEGA, TORQUE } from "./disc.ts";
import { emphasize, ofLayer } from "./emphasis.ts";
import { actingOn, type Figure, figureOf } from "./figure.ts";
import { frame, principal } from "./frames.ts";
import { gravity } from "./gravity.ts";
import { Hover } from "./hover.ts";
import { revealed } from "./names.ts";
import type { Instant, Part, Setting } from "./part.ts";
import { Paths } from "./paths.ts";
import { level, poinsot } from "./poinsot.ts";
import { quaternion, vector } from "./rotor.ts";
import { shadow } from "./shadow.ts";
import { tip } from "./tip.ts";
import type { SpaceTools } from "./tools.ts";
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
  /** The pose of the model that the camera has taken. */
  private pose: Pose | null = null;
  /** Whether a captured picture has a view in space axes. */
  private given = false;
  private fitting = false;
  private played = 0;
  private shownAt = Number.NaN;
  private whole = false;
  /** Whether laws or thrusts act on the body, and the layer that was emphasized. */
  private acts = false;
  private emphasized: keyof Shown | null = null;
  private figure: Figure | null = null;
  private readonly leave: () => void;
  private readonly hover: Hover;
  private readonly cloud: Setting["cloud"] = { matrices: null };

  constructor(
    host: HTMLElement,
    private readonly model: Model,
    private readonly palette: ReadonlySignal<Palette>,
    private readonly tools: SpaceTools | null = null,
  ) {
    super(host);
    this.leave = tools?.attach(host) ?? (() => {});
    let fitted = model.fitted.peek();
    let turned = model.turned.peek();
    this.watch(() => {
      this.fitting ||= model.fitted.value > fitted;
      fitted = model.fitted.value;
      const turn = model.turned.value;
      if (turn && turn !== turned) this.viewpoint.turn(turn);
      turned = turn;
      void tools?.changed.value;
      const { motion, row, shown, marked, pointed, covered, bodiesKnown, camera, pose, playing } = model;
      for (const watched of [
        motion,
        row,
        shown,
        marked,
        pointed,
        covered,
        bodiesKnown,
        camera,
        pose,
        playing,
        palette,
      ])
        void watched.value;
    });
    const view = { camera: this.viewpoint.camera, size: this.screen.value };
    this.hover = new Hover(host, this.curves, view, model);
    this.viewpoint.moved = () => {
      this.pose = this.viewpoint.pose;
      model.pose.value = this.pose;
    };
  }

  /** Returns to the preset of the model's camera. */
  override home(): void {
    this.fitting = true;
    this.draw();
  }

  override dispose(): void {
    this.leave();
    this.hover.dispose();
    super.dispose();
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
    const { layer = null, curve = null } = model.pointed.peek() ?? {};
    const shown = revealed(model.shown.peek(), curve);
    this.build();
    this.curves.mark(curve);
    const row = model.row.peek();
    this.space.visible = row !== null;
    if (row) {
      // The camera first: space and labels depend on it.
      this.stand(vector(row, State.omegaSpace), vector(row, State.momentumSpace));
      const instant = this.instant(row);
      this.turning.quaternion.copy(instant.attitude);
      for (const part of this.parts) part.update(instant, shown);
      if (layer !== null || this.emphasized !== null) emphasize(this.space, layer);
      this.emphasized = layer;
      const description = this.description(shown);
      if (this.canvas.ariaLabel !== description) this.canvas.ariaLabel = description;
    }
    this.labels.covered = this.whole ? null : corner(model.covered.peek(), this.screen.value);
    const time = model.time.peek();
    const steady = !this.whole && (model.playing.peek() || time === this.shownAt);
    this.shownAt = time;
    this.render(shown.labels && row !== null, steady);
    this.tools?.place(this.sight(row), this.figure);
    this.host.dataset.points = String(this.paths?.points ?? 0);
  }

  /** Builds the parts for a new motion or other colours. */
  private build(): void {
    const [motion, palette] = [this.model.motion.peek(), this.palette.peek()];
    if (motion === this.motion && palette === this.painted) return;
    [this.motion, this.painted, this.parts] = [motion, palette, []];
    this.replace(palette);
    this.say(null);
    [this.paths, this.figure] = [null, null];
    if (!motion) return;
    const figure = (this.figure = figureOf(motion));
    this.acts = figure.acting !== null && figure.about.laws.length + figure.acting.thrusts.length > 0;
    this.emphasized = null;
    const setting: Setting = {
      figure,
      palette,
      screen: this.screen,
      labels: this.labels,
      curves: this.curves,
      cloud: this.cloud,
      calm: this.calm,
      bodiesKnown: () => this.model.bodiesKnown.peek(),
      say: (message) => this.say(message),
    };
    this.paths = new Paths(setting);
    const parts = [
      body(setting),
      frame(setting, "body"),
      principal(setting),
      frame(setting, "space"),
      disc(setting, OMEGA),
      disc(setting, MOMENTUM),
      figure.torque > 0 ? disc(setting, TORQUE) : null,
      acting(setting),
      poinsot(setting),
      this.paths,
      tip(setting, () => this.model.marked.peek()),
      gravity(setting),
      shadow(setting),
      crowd(setting),
      ...(this.tools?.parts(setting) ?? []),
    ];
    this.parts = parts.filter((part) => part !== null);
    this.turning = new Group();
    this.space.add(this.turning);
    for (const { layer, inSpace, inBody } of this.parts) {
      for (const object of [inSpace, inBody]) if (layer && object) ofLayer(layer, object);
      if (inSpace) this.space.add(inSpace);
      if (inBody) this.turning.add(inBody);
    }
    // Look at an upright top above its tip.
    const top = figure.traced.clone().applyQuaternion(quaternion(figure.about.start.rotor)).z;
    this.viewpoint.look(new Vector3(0, 0, figure.about.held ? Math.max(0.2 * top, 0) : 0));
  }

  /** Moves to the model's camera if it has changed or a fit was requested, and to a pose that was set. */
  private stand(omega: Vector3, momentum: Vector3): void {
    const { camera, pose } = this.model;
    const name = camera.peek();
    const set = pose.peek() !== this.pose;
    // Poinsot's plane is at rest if L is.
    const still = this.model.shown.peek().poinsot && (this.motion?.about.free ?? null) !== null;
    const turned = name === "oblique" && still && !this.given && momentum.length() > 0;
    const levelled = turned ? this.motion : null;
    const upright = levelled && level(omega, momentum);
    const before = this.levelled;
    this.levelled = levelled;
    if (name !== this.camera || this.fitting || (before === null) !== (levelled === null)) {
      this.viewpoint.go(name, momentum, this.camera === null || this.calm.matches, upright);
      this.camera = name;
      this.fitting = false;
      if (!set) pose.value = null;
    } else if (upright && before !== levelled) {
      // The user's view is kept while sliders move.
      this.viewpoint.upright.copy(upright);
    }
    this.pose = pose.peek();
    if (set && this.pose) this.viewpoint.from(...this.pose);
  }

  private instant(row: Float64Array): Instant {
    const attitude = quaternion(row, State.rotor);
    const acting = this.acts ? actingOn(this.motion!, row) : null;
    const { upright, withBody } = this.viewpoint;
    this.space.quaternion.copy(upright).slerp(attitude.clone().invert(), withBody);
    return {
      time: row[State.time]!,
      attitude,
      omega: vector(row, State.omegaSpace),
      momentum: vector(row, State.momentumSpace),
      torque: vector(acting?.torque ?? [0, 0, 0]),
      acting,
      doubleKinetic: vector(row, State.omegaBody).dot(vector(row, State.momentumBody)),
      ...this.directions(),
      played: this.played,
      whole: this.whole,
    };
  }

  private description(shown: Shown): string {
    const about = this.motion?.about;
    const parts: [boolean, string][] = [
      [shown.body, "the body"],
      [shown.bodyFrame, bodyAxes(about)],
      [shown.spaceFrame, "the axes e1, e2, e3 of space"],
      [shown.omega, "the angular velocity Ω as an oriented disc"],
      [shown.momentum, "the angular momentum L as an oriented disc"],
      [shown.poinsot, "Poinsot's ellipsoid on the invariable plane"],
      [shown.polhode, "the polhode"],
      [shown.herpolhode, "the herpolhode"],
      [shown.trace, "the path of an axis of the body"],
      [shown.energy, "the tip of Ω"],
      [shown.ghost && this.tools !== null, "a ghost that started 0.1° away"],
      [shown.gravity && about?.held === true, "the pivot and the weight"],
      [shown.torque && this.acts, "the torque as an oriented disc"],
    ];
    const drawn = parts.filter(([seen]) => seen).map(([, part]) => part);
    const bodies = about?.ensemble ? ` One of ${about.ensemble} bodies.` : "";
    return `${about?.title ?? "A rigid body in motion"}.${bodies} Drawn: ${drawn.join(", ") || "nothing"}. The keys I, J, K and L turn the view, + and − zoom, F fits it.`;
  }
}

/** The box of a size at the lower left of a picture. */
function corner(covered: Covered | null, picture: Vector2): Box2 | null {
  return (
    covered && new Box2(new Vector2(0, picture.y - covered.height), new Vector2(covered.width, picture.y))
  );
}

/** The axes of the body in words. */
function bodyAxes(about: About | undefined): string {
  const axes = about && namedAxes(about.body);
  return axes?.own
    ? `its axes ${axes.names.map((name, k) => `f${k + 1} (${name})`).join(", ")}`
    : "its axes f1, f2, f3, and its principal axes";
}
