import type { About } from "../core/core.ts";
import { namedAxes } from "../stage/axes.ts";
import type { Envelope } from "./samples.ts";

/** A mark over the chart: a time in s and what happens then. */
export interface Mark {
  time: number;
  name: string;
}

/** More marks than this are not drawn: they would cover the chart. */
const MOST = 60;

/** Flips of a free body, at which a spin mainly about the middle axis changes its sign, and the events of a recorded motion. */
export function marksOf(about: About, envelope: Envelope, from: number, length: number): Mark[] {
  const events = (about.events ?? [])
    .map(({ name, time }) => ({ name, time }))
    .filter(({ time }) => time >= from && time <= from + length);
  const marks = [...flips(about, envelope, from, length), ...events];
  return marks.length > MOST ? [] : marks;
}

function flips(about: About, { least, most, bands }: Envelope, from: number, length: number): Mark[] {
  const flip = about.free?.flip_time ?? null;
  const columns = least[0]!.length;
  // Of a flip in each few columns, none can be told from the next.
  if (flip === null || flip < (8 * length) / columns) return [];
  const middle = namedAxes(about.body).names.indexOf("middle");
  if (middle < 0) return [];
  const largest = [0, 1, 2].map((axis) =>
    Math.max(...most[axis]!.map((x, k) => Math.max(x, -least[axis]![k]!))),
  );
  if (largest[middle] !== Math.max(...largest)) return [];
  const value = (k: number) => (least[middle]![k]! + most[middle]![k]!) / 2;
  const marks: Mark[] = [];
  for (let k = 0; k + 1 < columns; k++) {
    const [a, b] = [value(k), value(k + 1)];
    if (!(a < 0 ? b >= 0 : b < 0)) continue;
    const place = k + 0.5 + (bands ? 0.5 : a / (a - b));
    marks.push({ time: from + (place * length) / columns, name: "flip" });
  }
  return marks;
}
