import { effect, type ReadonlySignal } from "@preact/signals";
import {
  Box3,
  Color,
  DirectionalLight,
  HemisphereLight,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Triple } from "../core/core.ts";
import type { Palette } from "../palette.ts";
import { Viewpoint } from "../stage/camera.ts";
import { type Label, Labels } from "../stage/labels.ts";
import type { Screen } from "../stage/ribbon.ts";
import { AXES } from "../stage/rotor.ts";
import { NoWebGL } from "../stage/stage.ts";
import { extent, type Figure, figureOf } from "./figures.ts";
import { Handles } from "./handles.ts";
import { nameParts } from "./notation.ts";
import { Shapes } from "./shapes.ts";
import type { Drawable } from "./drawables.ts";

/** Radius of the ball that everything is fitted into, and the limits of the reach at which it is fitted again. */
const BALL = 1.62;
const LARGEST = 2;
const SMALLEST = 0.55;
/** Directions on the screen for the labels of discs, in turn. */
const SIDES = [
  [1, -0.45],
  [-1, -0.45],
  [1, 0.6],
  [-1, 0.6],
] as const;

/** The colours of items, in order. */
export function colours(palette: Palette): string[] {
  return [...palette.axes, palette.trace, palette.polhode, palette.text];
}

/**
 * A drawing of the values of lines that fills its host element: vectors as arrows, bivectors as oriented pieces of
 * planes, trivectors as boxes, rotors as turns. A frame is rendered only when something has changed.
 */
export class Drawing {
  private readonly canvas = document.createElement("canvas");
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly hemisphere = new HemisphereLight();
  private readonly lamp = new DirectionalLight();
  private readonly labels = new Labels();
  private readonly screen: Screen = { value: new Vector2(1, 1) };
  private readonly viewpoint: Viewpoint;
  private readonly handles: Handles;
  private readonly observer: ResizeObserver;
  private readonly unsubscribe: () => void;
  private readonly calm = matchMedia("(prefers-reduced-motion: reduce)");

  private figures: Figure[] = [];
  private named: { label: Label; figure: Figure | null; at: Vector3 }[] = [];
  private frame: Shapes | null = null;
  /** Shapes to dispose after the next frame, so that new shapes reuse their shader programs. */
  private old: Shapes[] = [];
  /** Drawn units per 1, and the centre of the picture. */
  private unit = 1;
  private middle = new Vector3();
  private subject = "";
  private request = 0;

  constructor(
    private readonly host: HTMLElement,
    private readonly items: ReadonlySignal<readonly Drawable[]>,
    private readonly palette: ReadonlySignal<Palette>,
    move: (line: number, components: Triple) => void,
  ) {
    const context = this.canvas.getContext("webgl2", { antialias: true });
    if (!context) throw new NoWebGL();
    this.renderer = new WebGLRenderer({ canvas: this.canvas, context, antialias: true });
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.className = "algebra-canvas";
    host.append(this.canvas, this.labels.element);
    this.handles = new Handles(host, () => this.unit, move);
    this.viewpoint = new Viewpoint(this.canvas, this.draw, () => this.home());
    this.lamp.position.set(-3, 4, 6);
    this.viewpoint.camera.add(this.lamp, this.lamp.target);
    this.hemisphere.position.set(0, 0, 1);
    this.scene.add(this.viewpoint.camera, this.hemisphere);
    this.viewpoint.go("oblique", AXES[2], true);
    // Without this, a lost context is not restored.
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", this.draw);
    this.observer = new ResizeObserver(this.resize);
    this.observer.observe(host);
    this.unsubscribe = effect(() => this.show(items.value, palette.value));
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    this.request = -1;
    this.unsubscribe();
    this.observer.disconnect();
    this.viewpoint.dispose();
    this.handles.dispose();
    for (const shapes of [...this.figures.map((figure) => figure.shapes), ...this.old]) shapes.dispose();
    this.frame?.dispose();
    this.renderer.dispose();
    // Browsers limit the number of contexts and free unused ones late.
    this.renderer.forceContextLoss();
    this.labels.element.remove();
    this.canvas.remove();
  }

  /** Fits everything into view and restores the initial camera. */
  home(): void {
    this.fit(this.items.peek());
    this.show(this.items.peek(), this.palette.peek());
    this.viewpoint.go("oblique", AXES[2], this.calm.matches);
  }

  private show(items: readonly Drawable[], palette: Palette): void {
    this.keepInView(items);
    this.old.push(...this.figures.map((figure) => figure.shapes), ...(this.frame ? [this.frame] : []));
    for (const shapes of this.old) this.scene.remove(shapes.object);
    const tones = colours(palette);
    this.figures = items.map((item) => figureOf(item, items, this.screen, tones[item.colour]!, this.unit));
    this.frame = this.axes(palette);
    this.scene.add(this.frame.object, ...this.figures.map((figure) => figure.shapes.object));
    this.name(tones, palette);
    this.handles.show(
      items.filter((item) => item.movable && item.vector),
      tones,
    );
    this.light(palette);
    const list = items.map((item) => `${item.label}, ${described(item)}`).join("; ");
    this.canvas.setAttribute("aria-label", `Drawing of: ${list || "nothing"}. Arrow keys rotate it.`);
    this.draw();
  }

  /** Keeps the unit while sizes are similar; otherwise a dragged vector would move away from the pointer. */
  private keepInView(items: readonly Drawable[]): void {
    const subject = items.map((item) => item.label).join(" ");
    const reach = Math.max(...items.flatMap(extent).map((point) => point.length()), 0) * this.unit;
    const farthest = this.middle.length() + LARGEST;
    if (subject !== this.subject || reach > farthest || (reach > 0 && reach < SMALLEST)) this.fit(items);
    this.subject = subject;
  }

  private fit(items: readonly Drawable[]): void {
    const points = items.flatMap(extent);
    if (points.length === 0) points.push(new Vector3(1, 1, 1), new Vector3());
    const middle = new Box3().setFromPoints(points).getCenter(new Vector3());
    const radius = Math.max(...points.map((point) => point.distanceTo(middle)));
    this.unit = radius > 0 ? BALL / radius : 1;
    this.middle = middle.multiplyScalar(this.unit);
    this.viewpoint.look(this.middle);
  }

  /** The length of the drawn axes: 1 if that is well visible, otherwise a round multiple or fraction of it. */
  private step(): number {
    const { unit } = this;
    if (unit > 0.3 && unit < 1.9) return unit;
    const power = 10 ** Math.floor(Math.log10(1 / unit));
    return [5, 2, 1].map((first) => first * power * unit).find((step) => step < 1.2)!;
  }

  /** e1, e2, e3 and a grid with the same spacing. */
  private axes(palette: Palette): Shapes {
    const shapes = new Shapes(this.screen, palette.faint);
    const step = this.step();
    for (const axis of AXES) {
      shapes.arrow(axis.clone().multiplyScalar(step), { width: 1.6, opacity: 0.9, behind: 0.5 });
    }
    const count = Math.min(Math.ceil(BALL / step), 8);
    const thin = { width: 1, opacity: 0.22, behind: 0.22 };
    for (let k = -count; k <= count; k++) {
      for (const [along, to] of [
        [0, 1],
        [1, 0],
      ] as const) {
        const at = AXES[to].clone().multiplyScalar(k * step);
        const half = AXES[along].clone().multiplyScalar(count * step);
        shapes.line([at.clone().sub(half), at.clone().add(half)], thin);
      }
    }
    return shapes;
  }

  /** Labels the items and the axes. */
  private name(tones: string[], palette: Palette): void {
    for (const { label } of this.named) label.dispose();
    const step = this.step();
    const axes = AXES.map((axis, k) => {
      const label = this.labels.add("e", { index: k + 1, rank: 3 });
      label.paint(palette.faint);
      return { label, figure: null, at: axis.clone().multiplyScalar(step) };
    });
    const items = this.figures.map((figure) => {
      const { letter, index, primes } = nameParts(figure.item.label);
      const label = this.labels.add(letter + primes, { rank: 1, ...(index && { index }) });
      label.paint(tones[figure.item.colour]!);
      label.say(figure.mark.note);
      return { label, figure, at: figure.mark.at };
    });
    this.named = [...items, ...axes];
  }

  private light(palette: Palette): void {
    const background = new Color(palette.background);
    const dark = background.getHSL({ h: 0, s: 0, l: 0 }).l < 0.5;
    this.renderer.setClearColor(background);
    this.hemisphere.groundColor.set(dark ? "#58606c" : "#c0c7d0");
    this.hemisphere.intensity = dark ? 2.3 : 2.5;
    this.lamp.intensity = dark ? 1.8 : 1.7;
    this.labels.paint(palette.background);
  }

  private readonly resize = (): void => {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.screen.value.set(width, height);
    this.viewpoint.resize(width, height);
    this.draw();
  };

  /** Requests one frame. */
  private readonly draw = (): void => {
    if (this.request === 0) this.request = requestAnimationFrame(this.render);
  };

  private readonly render = (): void => {
    this.request = 0;
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    const { camera } = this.viewpoint;
    this.viewpoint.step(1 / 60);
    if (this.viewpoint.moving) this.draw();
    this.scene.updateMatrixWorld();
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    for (const { label, figure, at } of this.named) {
      label.at.copy(at);
      if (!figure?.mark.rim) continue;
      const [across, high] = SIDES[figure.item.colour % SIDES.length]!;
      const { axis, radius } = figure.mark.rim;
      const towards = right.clone().multiplyScalar(across).addScaledVector(up, high).projectOnPlane(axis);
      label.at.copy(towards.setLength(radius));
    }
    this.labels.place(camera, this.scene.matrixWorld, new Vector2(width, height), true);
    this.handles.place(camera, width, height);
    this.renderer.render(this.scene, camera);
    for (const shapes of this.old) shapes.dispose();
    this.old = [];
  };
}

function described({ vector, bivector, trivector, rotor }: Drawable): string {
  const kinds = [
    vector && "a vector",
    bivector && "a bivector",
    trivector !== null && (trivector > 0 ? "a right-handed trivector" : "a left-handed trivector"),
    rotor && `a rotation by ${Math.round((rotor.angle * 180) / Math.PI)}°`,
  ];
  return kinds.filter(Boolean).join(" and ");
}
