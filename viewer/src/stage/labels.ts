import { type Camera, type Matrix4, type Vector2, Vector3 } from "three";

/** CSS pixels. */
const HEIGHT = 19;
const GAP = 5;
/** The baseline below the top of a label, that of an index below it, and the width of the halo. */
const BASELINE = 14;
const DROP = 4;
const HALO = 4;
/** Labels have values on a canvas of at least this width. */
const ROOMY = 520;
const FAMILY = '"STIX Two Text", "Latin Modern Roman", Cambria, "Times New Roman", serif';
const SIZES = { letter: 17, small: 13 };
/** Measures texts; measuring elements in each frame would cause a new layout. */
const ruler = document.createElement("canvas").getContext("2d")!;
/** Shifts of a label that would overlap another, in heights. */
const PLACES = [0, -1, 1, -2, 2];

/** A label of a point: an italic symbol, with an index or a value. */
export class Label {
  /** In space axes, in drawn units. */
  readonly at = new Vector3();
  readonly element = document.createElement("div");
  private readonly value = document.createElement("span");
  private readonly symbolWidth: number;
  private valueWidth = 0;
  private color = "";
  /** Its last place; null if it is hidden or there was no room. */
  place: Point | null = null;
  /** The side of its point that it is on, right and up; null for away from the centre. */
  side: Point | null = null;

  constructor(
    private readonly symbol: string,
    readonly style: { index?: number | string; rank: number },
    private readonly gone: (label: Label) => void,
  ) {
    const letter = document.createElement("i");
    letter.textContent = symbol;
    this.element.append(letter);
    this.symbolWidth =
      measured(symbol, `italic ${SIZES.letter}px`) +
      (style.index === undefined ? 0 : measured(String(style.index), `${SIZES.small}px`));
    if (style.index !== undefined) {
      const index = document.createElement("sub");
      index.textContent = String(style.index);
      index.style.cssText = `font-size: ${SIZES.small}px; line-height: 0`;
      this.element.append(index);
    }
    this.value.style.cssText = `font-size: ${SIZES.small}px; margin-left: ${GAP}px; font-variant-numeric: tabular-nums`;
    this.element.append(this.value);
    this.element.style.cssText =
      "position: absolute; left: 0; top: 0; white-space: nowrap; will-change: transform";
  }

  get hidden(): boolean {
    return this.element.style.display === "none";
  }

  say(value: string): void {
    if (this.value.textContent === value) return;
    this.value.textContent = value;
    this.valueWidth = value ? GAP + measured(value, `${SIZES.small}px`) : 0;
  }

  /** Its width, without the value if `short`. */
  width(short: boolean): number {
    this.value.style.display = short ? "none" : "";
    return this.symbolWidth + (short ? 0 : this.valueWidth);
  }

  hide(hidden: boolean): void {
    this.element.style.display = hidden ? "none" : "";
  }

  paint(color: string): void {
    this.element.style.color = this.color = color;
  }

  /** Draws the label at its last place, with a halo. */
  draw(context: CanvasRenderingContext2D, background: string): void {
    if (!this.place) return;
    const write = (text: string, font: string, x: number, y: number): void => {
      context.font = `${font} ${FAMILY}`;
      context.strokeText(text, x, y);
      context.fillText(text, x, y);
    };
    const { x, y } = this.place;
    [context.strokeStyle, context.fillStyle] = [background, this.color];
    [context.lineWidth, context.lineJoin] = [HALO, "round"];
    const letter = `italic ${SIZES.letter}px`;
    write(this.symbol, letter, x, y + BASELINE);
    if (this.style.index !== undefined)
      write(
        String(this.style.index),
        `${SIZES.small}px`,
        x + measured(this.symbol, letter),
        y + BASELINE + DROP,
      );
    if (this.value.style.display !== "none")
      write(this.value.textContent ?? "", `${SIZES.small}px`, x + this.symbolWidth + GAP, y + BASELINE);
  }

  dispose(): void {
    this.element.remove();
    this.gone(this);
  }
}

interface Point {
  x: number;
  y: number;
}

interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** The layer of labels over the canvas. Labels of low rank are placed first; those without room are hidden. */
export class Labels {
  readonly element = document.createElement("div");
  private labels: Label[] = [];
  private background = "";

  constructor() {
    // The description of the canvas and the panels have the same content.
    this.element.setAttribute("aria-hidden", "true");
    this.element.style.cssText =
      "position: absolute; inset: 0; overflow: hidden; pointer-events: none; user-select: none; " +
      `font: ${SIZES.letter}px/${HEIGHT}px ${FAMILY}`;
  }

  add(symbol: string, style: { index?: number | string; rank: number }): Label {
    const label = new Label(symbol, style, (gone) => {
      this.labels = this.labels.filter((other) => other !== gone);
    });
    this.labels.push(label);
    this.labels.sort((a, b) => a.style.rank - b.style.rank);
    this.element.append(label.element);
    return label;
  }

  /** A halo in the colour of the background separates letters from lines. */
  paint(background: string): void {
    this.background = background;
    this.element.style.textShadow = [1, 1, 2, 2, 3, 3]
      .map((blur) => `0 0 ${blur}px ${background}`)
      .join(", ");
  }

  /** Draws the labels at their last places, in CSS pixels. */
  draw(context: CanvasRenderingContext2D): void {
    if (this.element.style.display === "none") return;
    for (const label of this.labels) label.draw(context, this.background);
  }

  place(camera: Camera, space: Matrix4, size: Vector2, shown: boolean): void {
    const [width, height] = [size.x, size.y];
    this.element.style.display = shown ? "" : "none";
    if (!shown) return;
    const taken: Box[] = [];
    const centre = onScreen(new Vector3().setFromMatrixPosition(space), camera, width, height);
    for (const label of this.labels) {
      label.place = null;
      if (label.hidden) continue;
      const point = onScreen(label.at.clone().applyMatrix4(space), camera, width, height);
      const box = free(around(point, centre, label.width(width < ROOMY), label.side), taken, width, height);
      label.element.style.visibility = box ? "" : "hidden";
      if (!box) continue;
      taken.push(box);
      label.place = { x: box.left, y: box.top };
      label.element.style.transform = `translate(${box.left.toFixed(1)}px, ${box.top.toFixed(1)}px)`;
    }
  }
}

function measured(text: string, font: string): number {
  ruler.font = `${font} ${FAMILY}`;
  return ruler.measureText(text).width;
}

function onScreen(point: Vector3, camera: Camera, width: number, height: number): Point {
  point.project(camera);
  return { x: ((1 + point.x) * width) / 2, y: ((1 - point.y) * height) / 2 };
}

/**
 * The box of a label beside a point: away from the centre until the point is outside, or on the given side.
 */
function around(point: Point, centre: Point, width: number, side: Point | null): Box {
  let [dx, dy] = [point.x - centre.x, point.y - centre.y || -1e-3];
  let away = Math.min((width / 2 + GAP) / Math.abs(dx), (HEIGHT / 2 + GAP) / Math.abs(dy));
  if (side) {
    const length = Math.hypot(side.x, side.y);
    [dx, dy] = [side.x / length, -side.y / length];
    away = (width / 2) * Math.abs(dx) + (HEIGHT / 2) * Math.abs(dy) + GAP;
  }
  const [x, y] = [point.x + dx * away, point.y + dy * away];
  return { left: x - width / 2, right: x + width / 2, top: y - HEIGHT / 2, bottom: y + HEIGHT / 2 };
}

function free(box: Box, taken: Box[], width: number, height: number): Box | null {
  const shift = Math.max(4 - box.left, Math.min(0, width - 4 - box.right));
  for (const place of PLACES) {
    const down = place * HEIGHT;
    const moved = {
      left: box.left + shift,
      right: box.right + shift,
      top: box.top + down,
      bottom: box.bottom + down,
    };
    if (moved.top < 0 || moved.bottom > height) continue;
    if (!taken.some((other) => overlap(moved, other))) return moved;
  }
  return null;
}

function overlap(a: Box, b: Box): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}
