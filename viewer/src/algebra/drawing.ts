import type { ReadonlySignal } from "@preact/signals";
import { Box3, Vector3 } from "three";
import type { Triple } from "../core/core.ts";
import type { Palette } from "../palette.ts";
import { type Turn, TURNS } from "../stage/camera.ts";
import type { Label } from "../stage/labels.ts";
import { AXES } from "../stage/rotor.ts";
import { Shapes } from "../stage/shapes.ts";
import { Viewport } from "../stage/viewport.ts";
import type { Drawable } from "./drawables.ts";
import { extent, type Figure, figureOf } from "./figures.ts";
import { Handles } from "./handles.ts";
import type { Scale } from "./objects.ts";
import { nameParts } from "./notation.ts";

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

/** Keys that turn the drawing while it has the focus; Home returns to the first view. */
const KEYS: Readonly<Record<string, Turn>> = {
  ...TURNS,
  ArrowLeft: TURNS["j"]!,
  ArrowRight: TURNS["l"]!,
  ArrowUp: TURNS["i"]!,
  ArrowDown: TURNS["k"]!,
};

/** The colours of items, in order. */
export function colours(palette: Palette): string[] {
  const { axes, trace, polhode, text, momentum, weight } = palette;
  return [...axes, trace, polhode, text, momentum, weight];
}

/**
 * A drawing of the values of lines: vectors as arrows, bivectors as oriented pieces of planes, trivectors as boxes,
 * rotors as turns.
 */
export class Drawing extends Viewport {
  private readonly handles: Handles;
  /** Items with a label on a rim. */
  private rims: { label: Label; figure: Figure }[] = [];
  private readonly scale: Scale = { unit: 1, middle: new Vector3() };
  private subject = "";

  constructor(
    host: HTMLElement,
    private readonly items: ReadonlySignal<readonly Drawable[]>,
    private readonly palette: ReadonlySignal<Palette>,
    move: (line: number, components: Triple) => void,
  ) {
    super(host);
    this.handles = new Handles(host, () => this.scale.unit, move);
    this.viewpoint.go("oblique", AXES[2], true);
    this.canvas.addEventListener("keydown", this.pressed);
    this.watch(() => this.build(items.value, palette.value));
  }

  override dispose(): void {
    super.dispose();
    this.handles.dispose();
  }

  /** Fits everything into view and restores the initial camera. */
  override home(): void {
    this.fit(this.items.peek());
    this.build(this.items.peek(), this.palette.peek());
    this.viewpoint.go("oblique", AXES[2], this.calm.matches);
  }

  private readonly pressed = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const turn = KEYS[event.key];
    if (turn) this.viewpoint.turn(turn);
    else if (event.key === "Home") this.home();
    else return;
    event.preventDefault();
  };

  protected override show(): void {
    const { right, up } = this.directions();
    for (const { label, figure } of this.rims) {
      const [across, high] = SIDES[figure.item.colour % SIDES.length]!;
      const { axis, radius } = figure.mark.rim!;
      label.at.copy(right).multiplyScalar(across).addScaledVector(up, high);
      label.at.projectOnPlane(axis).setLength(radius);
    }
    this.render(true);
    this.handles.place(this.viewpoint.camera, this.screen.value);
  }

  private build(items: readonly Drawable[], palette: Palette): void {
    this.keepInView(items);
    this.replace(palette);
    const tones = colours(palette);
    const figures = items.map((item) => figureOf(item, items, this.screen, tones[item.colour]!, this.scale));
    this.space.add(this.axes(palette).object, ...figures.map(({ shapes }) => shapes.object));
    this.rims = figures
      .map((figure) => ({ figure, label: this.name(figure, tones[figure.item.colour]!) }))
      .filter(({ figure }) => figure.mark.rim);
    this.handles.show(
      items.filter((item) => item.movable && item.vector),
      tones,
    );
    const list = items.map((item) => `${item.label}, ${described(item)}`).join("; ");
    this.canvas.setAttribute("aria-label", `Drawing of: ${list || "nothing"}. Arrow keys rotate it.`);
  }

  /** Keeps the unit while sizes are similar; otherwise a dragged vector would move away from the pointer. */
  private keepInView(items: readonly Drawable[]): void {
    const subject = items.map((item) => item.label).join(" ");
    const reach = Math.max(...items.flatMap(extent).map((point) => point.length()), 0) * this.scale.unit;
    const farthest = this.scale.middle.length() + LARGEST;
    if (subject !== this.subject || reach > farthest || (reach > 0 && reach < SMALLEST)) this.fit(items);
    this.subject = subject;
  }

  private fit(items: readonly Drawable[]): void {
    const points = items.flatMap(extent);
    if (points.length === 0) points.push(new Vector3(1, 1, 1), new Vector3());
    const middle = new Box3().setFromPoints(points).getCenter(new Vector3());
    const radius = Math.max(...points.map((point) => point.distanceTo(middle)));
    this.scale.unit = radius > 0 ? BALL / radius : 1;
    this.scale.middle = middle.multiplyScalar(this.scale.unit);
    this.viewpoint.look(this.scale.middle);
  }

  /** The length of the drawn axes: 1 if that is well visible, otherwise a round multiple or fraction of it. */
  private step(): number {
    const { unit } = this.scale;
    if (unit > 0.3 && unit < 1.9) return unit;
    const power = 10 ** Math.floor(Math.log10(1 / unit));
    return [5, 2, 1].map((first) => first * power * unit).find((step) => step < 1.2)!;
  }

  /** e1, e2, e3 with their labels, and a grid with the same spacing. */
  private axes(palette: Palette): Shapes {
    const shapes = new Shapes(this.screen, palette.faint);
    const step = this.step();
    AXES.forEach((axis, k) => {
      const label = this.labels.add("e", palette.faint, { index: k + 1, rank: 3 });
      label.at.copy(axis).multiplyScalar(step);
      shapes.arrow(label.at, { width: 1.6, opacity: 0.9, behind: 0.5 });
    });
    const count = Math.min(Math.ceil(BALL / step), 8);
    const thin = { width: 1, opacity: 0.22, behind: 0.22 };
    for (let k = -count; k <= count; k++) {
      const [at, half] = [k * step, count * step];
      shapes.line([new Vector3(-half, at, 0), new Vector3(half, at, 0)], thin);
      shapes.line([new Vector3(at, -half, 0), new Vector3(at, half, 0)], thin);
    }
    return shapes;
  }

  private name({ item, mark }: Figure, colour: string): Label {
    const { letter, index, primes } = nameParts(item.label);
    const label = this.labels.add(letter + primes, colour, { rank: 1, index });
    label.value = mark.note;
    label.at.copy(mark.at);
    return label;
  }
}

function described({ vector, bivector, trivector, rotor, shapes }: Drawable): string {
  const kinds = [
    ...new Set(shapes.map(({ kind }) => `a ${kind}`)),
    vector && "a vector",
    bivector && "a bivector",
    trivector !== null && (trivector > 0 ? "a right-handed trivector" : "a left-handed trivector"),
    rotor && `a rotation by ${Math.round((rotor.angle * 180) / Math.PI)}°`,
  ];
  return kinds.filter(Boolean).join(" and ");
}
