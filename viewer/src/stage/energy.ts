import type { ReadonlySignal } from "@preact/signals";
import { Group, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, SphereGeometry, Vector3 } from "three";
import { type About, State, type Triple } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import type { CurveName, Model } from "../model/model.ts";
import { firstRow } from "../model/speed.ts";
import type { Palette } from "../palette.ts";
import { axisNames, ordered } from "./axes.ts";
import { REACH } from "./figure.ts";
import { Hover } from "./hover.ts";
import { type Curve, neighbours, separatrix, through } from "./polhodes.ts";
import type { Ribbon } from "./ribbon.ts";
import { AXES, quaternion, vector } from "./rotor.ts";
import { Shapes } from "./shapes.ts";
import type { EnergyTool } from "./tools.ts";
import { Viewport } from "./viewport.ts";

/** Scale of the curves, so that they are drawn over the ellipsoid. */
const LIFTED = 1.004;
/** The radius of the dot at the tip of Ω, and its size while it is marked. */
const DOT = 0.045;
const MARKED = 1.8;

/** The semi-axes √(2T/i) of the energy ellipsoid of a state, along the principal axes, rad/s. */
export function semiAxesAt(row: Float64Array, moments: Triple): Vector3 {
  const doubleKinetic = vector(row, State.omegaBody).dot(vector(row, State.momentumBody));
  return new Vector3(...moments.map((moment) => Math.sqrt(doubleKinetic / moment)));
}

/**
 * The energy ellipsoid of a free body in body axes: all Ω of its energy. On it are its polhode, neighbours, the
 * separatrix, and a dot at the present Ω, at the same time as in the picture in space.
 */
export class EnergyView extends Viewport {
  private motion: Motion | null = null;
  private painted: Palette | null = null;
  private dot: Mesh | null = null;
  /** Drawn units for 1 rad/s. */
  private rate = 1;
  /** From the unit sphere to the ellipsoid in body axes. */
  private readonly globe = new Matrix4();
  private readonly leave: () => void;
  private readonly hover: Hover;

  constructor(
    host: HTMLElement,
    private readonly model: Model,
    private readonly palette: ReadonlySignal<Palette>,
    private readonly tool: EnergyTool | null = null,
  ) {
    super(host);
    this.leave = tool?.attach(host) ?? (() => {});
    this.watch(() => {
      void tool?.held.value;
      const { motion, row, marked, pointed, shown } = model;
      for (const watched of [motion, row, marked, pointed, shown, palette]) void watched.value;
    });
    const view = { camera: this.viewpoint.camera, size: this.screen.value };
    this.hover = new Hover(host, this.curves, view, model);
  }

  override home(): void {
    if (this.motion) this.viewpoint.from(...towards(this.motion.about));
    this.draw();
  }

  override dispose(): void {
    this.leave();
    this.hover.dispose();
    super.dispose();
  }

  protected override show(): void {
    this.build();
    this.curves.mark(this.model.pointed.peek()?.curve ?? null);
    const row = this.model.row.peek();
    if (row && this.dot) {
      const omega = this.tool?.held.peek() ?? vector(row, State.omegaBody);
      this.dot.position.copy(omega).multiplyScalar(this.rate * LIFTED);
      this.dot.scale.setScalar(this.model.marked.peek() ? MARKED : 1);
    }
    this.render(this.model.shown.peek().labels);
    const sight = this.sight(row);
    this.tool?.place(this.dot && sight, sight ? sight.space.clone().multiply(this.globe) : this.globe);
  }

  /** Builds the ellipsoid of a new motion, or in other colours. */
  private build(): void {
    const [motion, palette] = [this.model.motion.peek(), this.palette.peek()];
    if (motion === this.motion && palette === this.painted) return;
    const first = this.motion === null;
    [this.motion, this.painted, this.dot] = [motion, palette, null];
    this.replace(palette);
    // The user's view is kept while sliders move.
    if (motion && first) this.viewpoint.from(...towards(motion.about));
    if (!motion || !hasEnergyView(motion.about)) return;
    const { moments, frame } = motion.about.body;
    const row = firstRow(motion);
    const omega = vector(row, State.omegaBody);
    const semiAxes = semiAxesAt(row, moments);
    this.rate = REACH / Math.max(...semiAxes.toArray());
    semiAxes.multiplyScalar(this.rate);
    this.globe.compose(new Vector3(), quaternion(frame), semiAxes);

    const body = new Group();
    quaternion(frame, 0, body.quaternion);
    const placed = (curve: Curve) => curve.map((u) => u.clone().multiply(semiAxes).multiplyScalar(LIFTED));
    body.add(this.skin(palette, semiAxes));
    const thin = new Shapes(this.screen, palette.polhode);
    for (const curve of neighbours(moments))
      this.named("neighbours", thin.line(placed(curve), { width: 1, opacity: 0.7, behind: 0.15 }, true));
    const dashed = new Shapes(this.screen, palette.text);
    for (const curve of separatrix(moments))
      this.named(
        "separatrix",
        dashed.line(placed(curve), { width: 1.6, opacity: 0.9, behind: 0.2, dash: 0.09 }, true),
      );
    const own = new Shapes(this.screen, palette.omega);
    const unit = omega.clone().applyQuaternion(body.quaternion.clone().invert());
    const curve = through(moments, unit.multiplyScalar(this.rate).divide(semiAxes).normalize());
    if (curve) this.named("polhode", own.line(placed(curve), { width: 2.6, behind: 0.3 }, true));
    body.add(thin.object, dashed.object, own.object);

    this.dot = new Mesh(new SphereGeometry(DOT, 24, 16), new MeshBasicMaterial({ color: palette.omega }));
    this.space.add(body, this.axes(motion.about, palette), this.dot);
    this.canvas.ariaLabel =
      "The energy ellipsoid in the body, with the polhode of Ω, its neighbours and the separatrix. Arrow keys turn it.";
  }

  private named(name: CurveName, line: Ribbon): void {
    this.curves.add(line.curve(name));
  }

  private skin(palette: Palette, semiAxes: Vector3): Mesh {
    const material = new MeshLambertMaterial({
      color: palette.polhode,
      transparent: true,
      opacity: 0.34,
    });
    const skin = new Mesh(new SphereGeometry(1, 64, 40).rotateX(Math.PI / 2), material);
    skin.scale.copy(semiAxes);
    return skin;
  }

  /** The principal axes with the names of their moments. */
  private axes({ body: { moments, frame } }: About, palette: Palette): Group {
    const names = axisNames(moments);
    const arrows = new Group();
    const turn = quaternion(frame);
    AXES.forEach((axis, k) => {
      const colour = palette.axes[k as 0 | 1 | 2];
      const to = axis
        .clone()
        .applyQuaternion(turn)
        .multiplyScalar(1.22 * REACH);
      const shapes = new Shapes(this.screen, colour);
      shapes.arrow(to, { width: 1.8, behind: 0.35 });
      arrows.add(shapes.object);
      const label = this.labels.add(names[k]!, colour, { rank: 1 });
      label.at.copy(to);
    });
    return arrows;
  }
}

/** A view of the end of the middle axis, where the separatrix crosses itself: azimuth and elevation in degrees. */
function towards({ body: { moments, frame } }: About): [number, number] {
  const [small, middle, large] = ordered(moments);
  const at = new Vector3().setComponent(small, 0.5).setComponent(middle, 1).setComponent(large, 0.45);
  at.applyQuaternion(quaternion(frame)).normalize();
  return [(Math.atan2(at.y, at.x) * 180) / Math.PI, (Math.asin(at.z) * 180) / Math.PI];
}

/** Whether the energy ellipsoid of a motion stays as it is: of a free body with three moments. */
export function hasEnergyView(about: About | null): boolean {
  if (!about?.free || about.ensemble !== null) return false;
  return Math.min(...about.body.moments) > 0 && Math.hypot(...about.start.omega_body) > 0;
}
