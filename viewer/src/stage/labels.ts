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
const LETTER = `italic 17px ${FAMILY}`;
const SMALL = `13px ${FAMILY}`;
/** Shifts of a label that would overlap another, in heights. */
const PLACES = [0, -1, 1, -2, 2];

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
}

export interface Point {
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

/** The layer of labels over the canvas. Those without room are hidden. */
export class Labels {
  readonly element = document.createElement("canvas");
  /** Colours of letters are readable on this one's background, which is also that of their halo. */
  palette = LIGHT;
  private readonly context = this.element.getContext("2d")!;
  private labels: Label[] = [];
  private placed: { label: Label; pieces: Piece[]; box: Box2 }[] = [];

  constructor() {
    // The description of the canvas and the panels have the same content.
    this.element.setAttribute("aria-hidden", "true");
    this.element.style.cssText =
      "position: absolute; inset: 0; width: 100%; height: 100%; pointer-events: none";
  }

  add(symbol: string, colour: string, style: { index?: string | number; rank: number }): Label {
    const label = {
      index: "",
      ...style,
      symbol,
      colour: readable(colour, this.palette),
      at: new Vector3(),
      value: "",
      hidden: false,
      side: null,
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
  }

  /** Places the labels on a canvas of a size in CSS pixels, and draws them. */
  place(camera: Camera, space: Matrix4, size: Vector2, shown: boolean): void {
    const [width, height] = [size.x, size.y];
    this.placed = [];
    const centre = onScreen(new Vector3().setFromMatrixPosition(space), camera, width, height);
    for (const label of shown ? this.labels : []) {
      if (label.hidden) continue;
      const point = onScreen(label.at.clone().applyMatrix4(space), camera, width, height);
      const { pieces, width: wide } = this.typeset(label, width >= ROOMY);
      const taken = this.placed.map(({ box }) => box);
      const box = free(around(point, centre, wide, label.side), taken, width, height);
      if (box) this.placed.push({ label, pieces, box });
    }
    this.context.clearRect(0, 0, width, height);
    this.draw(this.context);
  }

  /** Draws the labels at their last places, in CSS pixels. */
  draw(context: CanvasRenderingContext2D): void {
    [context.strokeStyle, context.lineWidth, context.lineJoin] = [this.palette.background, HALO, "round"];
    for (const { label, pieces, box } of this.placed) {
      context.fillStyle = label.colour;
      for (const { text, font, x, y } of pieces) {
        context.font = font;
        context.strokeText(text, box.min.x + x, box.min.y + y);
        context.fillText(text, box.min.x + x, box.min.y + y);
      }
    }
  }

  private typeset(label: Label, valued: boolean): { pieces: Piece[]; width: number } {
    const pieces: Piece[] = [];
    let width = 0;
    const write = (text: string, font: string, gap = 0, drop = 0): void => {
      if (!text) return;
      pieces.push({ text, font, x: width + gap, y: BASELINE + drop });
      this.context.font = font;
      width += gap + this.context.measureText(text).width;
    };
    write(label.symbol, LETTER);
    write(String(label.index), SMALL, 0, DROP);
    if (valued) write(label.value, SMALL, GAP);
    return { pieces, width };
  }
}

/** The place of a point in space axes on a canvas of this size. */
export function onScreen(point: Vector3, camera: Camera, width: number, height: number): Point {
  point.project(camera);
  return { x: ((1 + point.x) * width) / 2, y: ((1 - point.y) * height) / 2 };
}

/** The box of a label beside a point: away from the centre until the point is outside, or on the given side. */
function around(point: Point, centre: Point, width: number, side: Point | null): Box2 {
  let [dx, dy] = [point.x - centre.x, point.y - centre.y || -1e-3];
  let away = Math.min((width / 2 + GAP) / Math.abs(dx), (HEIGHT / 2 + GAP) / Math.abs(dy));
  if (side) {
    const length = Math.hypot(side.x, side.y);
    [dx, dy] = [side.x / length, -side.y / length];
    away = (width / 2) * Math.abs(dx) + (HEIGHT / 2) * Math.abs(dy) + GAP;
  }
  const middle = new Vector2(point.x + dx * away, point.y + dy * away);
  return new Box2().setFromCenterAndSize(middle, new Vector2(width, HEIGHT));
}

/** The box, moved into the picture and beside those that are taken; null without room. */
function free(box: Box2, taken: Box2[], width: number, height: number): Box2 | null {
  const shift = Math.max(4 - box.min.x, Math.min(0, width - 4 - box.max.x));
  const moved = PLACES.map((place) => box.clone().translate(new Vector2(shift, place * HEIGHT)));
  const room = (at: Box2) =>
    at.min.y >= 0 && at.max.y <= height && !taken.some((other) => at.intersectsBox(other));
  return moved.find(room) ?? null;
}
