import { effect, type ReadonlySignal } from "@preact/signals";
import { Color, DirectionalLight, HemisphereLight, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import type { Triple } from "../core/core.ts";
import type { Palette } from "../palette.ts";
import { Viewpoint } from "../stage/camera.ts";
import { type Label, Labels } from "../stage/labels.ts";
import type { Screen } from "../stage/ribbon.ts";
import { AXES } from "../stage/rotor.ts";
import { NoWebGL } from "../stage/stage.ts";
import { type Drawn, drawnOf, extent } from "./figures.ts";
import { Handles } from "./handles.ts";
import { nameParts } from "./notation.ts";
import { Shapes } from "./shapes.ts";
import type { Thing } from "./things.ts";

/** The ball in which all is to lie, in drawn units, and how large and small what was in it may become. */
const BALL = 1.62;
const LARGEST = 2;
const SMALLEST = 0.55;
/** Where the label of a disc stands on the screen, one after the other. */
const SIDES = [
  [1, -0.45],
  [-1, -0.45],
  [1, 0.6],
  [-1, 0.6],
] as const;

/** The colours of things, in their order. */
export function colours(palette: Palette): string[] {
  return [...palette.axes, palette.trace, palette.polhode, palette.text];
}

/**
 * The values of lines, drawn in an element that it fills and follows in size: vectors as arrows, bivectors as pieces of
 * planes with a sense, trivectors as boxes, rotors as turns. It draws when something has changed.
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
  private readonly unwatch: () => void;
  private readonly calm = matchMedia("(prefers-reduced-motion: reduce)");

  private drawn: Drawn[] = [];
  private named: { label: Label; drawn: Drawn | null; at: Vector3 }[] = [];
  private frame: Shapes | null = null;
  /** What is no longer shown; its programs on the graphics card go when others use them. */
  private old: Shapes[] = [];
  /** Drawn units for 1, and the point in the middle of the picture. */
  private unit = 1;
  private middle = new Vector3();
  private subject = "";
  private request = 0;

  constructor(
    private readonly host: HTMLElement,
    private readonly things: ReadonlySignal<readonly Thing[]>,
    private readonly palette: ReadonlySignal<Palette>,
    move: (line: number, components: Triple) => void,
  ) {
    const context = this.canvas.getContext("webgl2", { antialias: true });
    if (!context) throw new NoWebGL("this browser draws no WebGL 2");
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
    // Without this a context that is lost would not come back.
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", this.draw);
    this.observer = new ResizeObserver(this.resize);
    this.observer.observe(host);
    this.unwatch = effect(() => this.show(things.value, palette.value));
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    this.request = -1;
    this.unwatch();
    this.observer.disconnect();
    this.viewpoint.dispose();
    this.handles.dispose();
    for (const shapes of [...this.drawn.map((drawn) => drawn.shapes), ...this.old]) shapes.dispose();
    this.frame?.dispose();
    this.renderer.dispose();
    // Browsers have few contexts, and take long to collect one that nobody uses.
    this.renderer.forceContextLoss();
    this.labels.element.remove();
    this.canvas.remove();
  }

  /** Looks at everything from the first place again. */
  home(): void {
    this.fit(this.things.peek());
    this.show(this.things.peek(), this.palette.peek());
    this.viewpoint.go("oblique", AXES[2], this.calm.matches);
  }

  private show(things: readonly Thing[], palette: Palette): void {
    this.keepInView(things);
    this.old.push(...this.drawn.map((drawn) => drawn.shapes), ...(this.frame ? [this.frame] : []));
    for (const shapes of this.old) this.scene.remove(shapes.object);
    const tones = colours(palette);
    this.drawn = things.map((thing) => drawnOf(thing, things, this.screen, tones[thing.colour]!, this.unit));
    this.frame = this.axes(palette);
    this.scene.add(this.frame.object, ...this.drawn.map((drawn) => drawn.shapes.object));
    this.name(tones, palette);
    this.handles.show(
      things.filter((thing) => thing.movable && thing.vector),
      tones,
    );
    this.light(palette);
    const list = things.map((thing) => `${thing.label}, ${described(thing)}`).join("; ");
    this.canvas.setAttribute("aria-label", `Drawn: ${list || "nothing"}. Arrow keys turn the picture.`);
    this.draw();
  }

  /** The unit stays while things are about as large as before: what is dragged would else run away. */
  private keepInView(things: readonly Thing[]): void {
    const subject = things.map((thing) => thing.label).join(" ");
    const reach = Math.max(...things.flatMap(extent).map((point) => point.length()), 0) * this.unit;
    const farthest = this.middle.length() + LARGEST;
    if (subject !== this.subject || reach > farthest || (reach > 0 && reach < SMALLEST)) this.fit(things);
    this.subject = subject;
  }

  private fit(things: readonly Thing[]): void {
    const points = things.flatMap(extent);
    if (points.length === 0) points.push(new Vector3(1, 1, 1), new Vector3());
    const [low, high] = [Math.min, Math.max].map(
      (most) =>
        new Vector3(
          ...([0, 1, 2].map((k) => most(...points.map((point) => point.getComponent(k)))) as Triple),
        ),
    ) as [Vector3, Vector3];
    const middle = low.add(high).multiplyScalar(0.5);
    const radius = Math.max(...points.map((point) => point.distanceTo(middle)));
    this.unit = radius > 0 ? BALL / radius : 1;
    this.middle = middle.multiplyScalar(this.unit);
    this.viewpoint.look(this.middle);
  }

  /** The length of the drawn axes: that of e1 where it can be seen well, else a round multiple or part of it. */
  private step(): number {
    const { unit } = this;
    if (unit > 0.3 && unit < 1.9) return unit;
    const power = 10 ** Math.floor(Math.log10(1 / unit));
    return [5, 2, 1].map((first) => first * power * unit).find((step) => step < 1.2)!;
  }

  /** e1, e2, e3 on a grid of the same step. */
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

  /** Gives each thing and each axis its label. */
  private name(tones: string[], palette: Palette): void {
    for (const { label } of this.named) label.dispose();
    const step = this.step();
    const axes = AXES.map((axis, k) => {
      const label = this.labels.add("e", { index: k + 1, rank: 3 });
      label.paint(palette.faint);
      return { label, drawn: null, at: axis.clone().multiplyScalar(step) };
    });
    const things = this.drawn.map((drawn) => {
      const { letter, index, primes } = nameParts(drawn.thing.label);
      const label = this.labels.add(letter + primes, { rank: 1, ...(index && { index }) });
      label.paint(tones[drawn.thing.colour]!);
      label.say(drawn.mark.says);
      return { label, drawn, at: drawn.mark.at };
    });
    this.named = [...things, ...axes];
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

  /** Asks for one frame. */
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
    for (const { label, drawn, at } of this.named) {
      label.at.copy(at);
      if (!drawn?.mark.rim) continue;
      const [across, high] = SIDES[drawn.thing.colour % SIDES.length]!;
      const { axis, radius } = drawn.mark.rim;
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

function described({ vector, bivector, trivector, rotor }: Thing): string {
  const kinds = [
    vector && "a vector",
    bivector && "a bivector",
    trivector !== null && (trivector > 0 ? "a right-handed trivector" : "a left-handed trivector"),
    rotor && `a turn by ${Math.round((rotor.angle * 180) / Math.PI)}°`,
  ];
  return kinds.filter(Boolean).join(" and ");
}
