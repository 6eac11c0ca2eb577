import { Box2, type Camera, type Matrix4, Vector2, Vector3 } from "three";
import { LIGHT, readable } from "../palette.ts";

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
/** Room of the plate around the letters, its corners and its opacity. */
const PLATE = { x: 4, y: 1, corner: 4, opacity: 0.8 };
/** A label returns to a better place only if this much room is around it there: places do not alternate. */
const MARGIN = 8;
/** The part of the way to its place that a label goes in one frame; more if another one is in its way. */
const PACES = [0.25, 0.5, 0.75];
/** On a canvas narrower than this, letters are smaller by this factor. */
const NARROW = 300;
const SMALLER = 0.82;

/** A label of a point: an italic symbol, with an index or a value. */
export interface Label {
  /** In space axes, in drawn units. */
  at: Vector3;
  symbol: string;
  colour: string;
  index: string | number;
  /** Labels of low rank are placed first. */
  rank: number;
  value: string;
  hidden: boolean;
  /** The side of its point that it is on, right and up; null for away from the centre. */
  side: Point | null;
  /** Which of its places it has, and where its middle is drawn from its point; null before it is drawn. */
  place: number | null;
  from: Vector2 | null;
}

interface Point {
  x: number;
  y: number;
}

/** A piece of a label: its distance from the left end of the label, and its baseline. */
interface Piece {
  text: string;
  font: string;
  x: number;
  y: number;
}

/** The layer of labels over the canvas: each on a plate, none over another or under the legend. Those without room are hidden. */
export class Labels {
  readonly element = document.createElement("canvas");
  /** Colours of letters are readable on this one's background, which is also that of plates. */
  palette = LIGHT;
  /** Whether labels go to other places at once: for readers who prefer reduced motion. */
  calm = false;
  /** A part of the canvas without labels, in CSS pixels: the legend covers it. */
  covered: Box2 | null = null;
  /** Whether labels are still on their way to their places. */
  gliding = false;
  private readonly context = this.element.getContext("2d")!;
  private labels: Label[] = [];
  private placed: { label: Label; pieces: Piece[]; box: Box2 }[] = [];
  private scale = 1;

  constructor() {
    // The description of the canvas and the panels have the same content.
    this.element.setAttribute("aria-hidden", "true");
    this.element.style.cssText =
      "position: absolute; inset: 0; width: 100%; height: 100%; pointer-events: none";
  }

  add(symbol: string, colour: string, style: { index?: string | number; rank: number }): Label {
    const label: Label = {
      index: "",
      ...style,
      symbol,
      colour: readable(colour, this.palette),
      at: new Vector3(),
      value: "",
      hidden: false,
      side: null,
      place: null,
      from: null,
    };
    this.labels.push(label);
    this.labels.sort((a, b) => a.rank - b.rank);
    return label;
  }

  clear(): void {
    this.labels = [];
  }

  /** Adapts to a size in CSS pixels. */
  resize(width: number, height: number, ratio: number): void {
    this.element.width = width * ratio;
    this.element.height = height * ratio;
    this.context.scale(ratio, ratio);
    this.scale = width < NARROW ? SMALLER : 1;
  }

  /**
   * Places the labels on a canvas of a size in CSS pixels, and draws them. `steady` ones, of pictures that follow each
   * other without a jump, keep their places while they can; others have places that depend on this picture alone.
   */
  place(camera: Camera, space: Matrix4, size: Vector2, shown: boolean, steady = false): void {
    const [width, height] = [size.x, size.y];
    this.placed = [];
    this.gliding = false;
    const centre = onScreen(new Vector3().setFromMatrixPosition(space), camera, width, height);
    for (const label of shown ? this.labels : []) {
      if (!steady || label.hidden) [label.place, label.from] = [null, null];
      if (label.hidden) continue;
      const point = onScreen(label.at.clone().applyMatrix4(space), camera, width, height);
      const { pieces, width: wide } = this.typeset(label, width >= ROOMY);
      const plate = new Vector2(wide + 2 * PLATE.x, (HEIGHT + 2 * PLATE.y) * this.scale);
      const box = this.free(label, point, around(point, centre, plate, label.side), size);
      if (box) this.placed.push({ label, pieces, box });
    }
    this.element.dataset.plates = JSON.stringify(
      this.placed.map(({ label, box }) => [
        `${label.symbol}${label.index}`,
        ...box.min.toArray(),
        ...box.max.toArray(),
      ]),
    );
    this.context.clearRect(0, 0, width, height);
    this.draw(this.context);
  }

  /** Draws the labels at their last places, in CSS pixels. */
  draw(context: CanvasRenderingContext2D): void {
    const { background } = this.palette;
    [context.strokeStyle, context.lineWidth, context.lineJoin] = [background, HALO, "round"];
    for (const { label, pieces, box } of this.placed) {
      const { x: wide, y: high } = box.getSize(new Vector2());
      context.fillStyle = background;
      context.globalAlpha = PLATE.opacity;
      context.beginPath();
      context.roundRect(box.min.x, box.min.y, wide, high, PLATE.corner);
      context.fill();
      context.globalAlpha = 1;
      context.fillStyle = label.colour;
      for (const { text, font, x, y } of pieces) {
        const [left, base] = [box.min.x + PLATE.x + x, box.min.y + PLATE.y + y];
        context.font = font;
        context.strokeText(text, left, base);
        context.fillText(text, left, base);
      }
    }
  }

  private typeset(label: Label, valued: boolean): { pieces: Piece[]; width: number } {
    const { scale } = this;
    const [letter, small] = [`italic ${17 * scale}px ${FAMILY}`, `${13 * scale}px ${FAMILY}`];
    const pieces: Piece[] = [];
    let width = 0;
    const write = (text: string, font: string, gap = 0, drop = 0): void => {
      if (!text) return;
      pieces.push({ text, font, x: width + gap, y: (BASELINE + drop) * scale });
      this.context.font = font;
      width += gap + this.context.measureText(text).width;
    };
    write(label.symbol, letter);
    write(String(label.index), small, 0, DROP);
    if (valued) write(label.value, small, GAP);
    return { pieces, width };
  }

  /** The plate of a label in the picture, clear of the other plates and the legend; null without room. */
  private free(label: Label, point: Point, best: Box2, size: Vector2): Box2 | null {
    const taken = this.placed.map(({ box }) => box);
    if (this.covered) taken.push(this.covered);
    const room = (box: Box2, margin = 0): boolean => {
      const { min, max } = box;
      if (min.x < 0 || max.x > size.x || min.y < 0 || max.y > size.y) return false;
      const wider = box.clone().expandByScalar(margin);
      return !taken.some((other) => wider.intersectsBox(other));
    };
    const places = placesOf(best, point, size.x);
    const had = label.place === null ? null : places[label.place]!;
    const better = places.findIndex((box, k) => room(box, had && k !== label.place ? MARGIN : 0));
    const place = better < 0 ? places.findIndex((box) => room(box)) : better;
    const from = label.from;
    [label.place, label.from] = [place < 0 ? null : place, null];
    if (place < 0) return null;
    const target = places[place]!.getCenter(new Vector2()).sub(point);
    label.from = target;
    if (!from || this.calm || from.distanceTo(target) < 1) return places[place]!;
    for (const part of PACES) {
      const way = from.clone().lerp(target, part);
      const box = new Box2().setFromCenterAndSize(way.clone().add(point), best.getSize(new Vector2()));
      if (!room(box)) continue;
      label.from = way;
      this.gliding = true;
      return box;
    }
    return places[place]!;
  }
}

/** The place of a point in space axes on a canvas of this size. */
export function onScreen(point: Vector3, camera: Camera, width: number, height: number): Point {
  point.project(camera);
  return { x: ((1 + point.x) * width) / 2, y: ((1 - point.y) * height) / 2 };
}

/** The plate of a label beside a point: away from the centre until the point is outside, or on the given side. */
function around(point: Point, centre: Point, size: Vector2, side: Point | null): Box2 {
  let [dx, dy] = [point.x - centre.x, point.y - centre.y || -1e-3];
  let away = Math.min((size.x / 2 + GAP) / Math.abs(dx), (size.y / 2 + GAP) / Math.abs(dy));
  if (side) {
    const length = Math.hypot(side.x, side.y);
    [dx, dy] = [side.x / length, -side.y / length];
    away = (size.x / 2) * Math.abs(dx) + (size.y / 2) * Math.abs(dy) + GAP;
  }
  const middle = new Vector2(point.x + dx * away, point.y + dy * away);
  return new Box2().setFromCenterAndSize(middle, size);
}

/** Places of a plate, from the best one on: above and below that, and on the left and right of its point. */
function placesOf(best: Box2, point: Point, width: number): Box2[] {
  const size = best.getSize(new Vector2());
  const middle = best.getCenter(new Vector2());
  const beside = size.x / 2 + GAP;
  const middles = [
    ...[0, -1, 1].map((k) => new Vector2(middle.x, middle.y + k * size.y)),
    ...[1, -1].map((k) => new Vector2(point.x + k * beside, point.y)),
    ...[-2, 2].map((k) => new Vector2(middle.x, middle.y + k * size.y)),
  ];
  return middles.map((at) => {
    at.x += Math.max(size.x / 2 - at.x, Math.min(0, width - size.x / 2 - at.x));
    return new Box2().setFromCenterAndSize(at, size);
  });
}
