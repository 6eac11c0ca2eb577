import { Group, Quaternion, Vector3 } from "three";
import { ROW, State } from "../core/core.ts";
import type { Shown } from "../document.ts";
import { span } from "../model/model.ts";
import { ofLayer } from "./emphasis.ts";
import { type Figure, REACH } from "./figure.ts";
import type { Instant, Part, Setting } from "./part.ts";
import { Ribbon } from "./ribbon.ts";
import { quaternion, vector } from "./rotor.ts";
import { advance, statesOf, type Steps } from "./steps.ts";

/** Maximum number of points of a path. */
const POINTS = 10_000;
/** Duration of a tail, in turns of the body. */
const TURNS = 8;
const MOST_TURNS = 60;
/** Tolerance of a line in drawn units: a fifth of a pixel in the default view. */
const NEAR = 1e-3;
/** Time in ms for the paths of one frame: while the motion plays, so that no frame is late, and otherwise. */
const FRAME = 1;
const PAUSED = 8;
/** Points of a path computed in one step. */
const STEP = 500;
/** The longest piece of a line, so that fading along it is even. */
const LONGEST = 0.15;
/** Scale of the polhode, so that it is drawn over the ellipsoid on which it lies. */
const LIFTED = 1.004;

interface Path {
  name: "trace" | "herpolhode" | "polhode";
  ribbon: Ribbon;
  /** How long it is seen, s. */
  tail: number;
  /** Its point at an offset in rows of states. */
  point: (rows: Float64Array, at: number, into: Vector3) => void;
}

/**
 * The path of a body axis in space, and those of ω: the herpolhode in space, the polhode in the body. They are computed
 * for a stretch of three tails around a multiple of the tail; while the present is next to that, only the fading
 * changes. Frames are drawn while they are computed.
 */
export class Paths implements Part {
  readonly inSpace = new Group();
  readonly inBody = new Group();
  /** Those that are drawn by stretches, and the polhode if it is closed. */
  private open: Path[] = [];
  private readonly closed: Path[] = [];
  private readonly figure: Figure;
  private readonly screen: Setting["screen"];
  private readonly palette: Setting["palette"];
  private readonly curves: Setting["curves"];
  /** Duration of a tail in s, the middle of the stretch, and that of the stretch that is being computed. */
  private tail = Number.NaN;
  private middle = Number.NaN;
  private wanted = Number.NaN;
  private asked = 0;
  private work: Steps<void> | null;
  /** The time of the last frame. */
  private seen = Number.NaN;
  /** The last stretch: its rows, and the number of the first one. */
  private last: { from: number; rows: Float64Array } | null = null;

  constructor({ figure, palette, screen, curves }: Setting) {
    [this.figure, this.palette, this.screen, this.curves] = [figure, palette, screen, curves];
    this.work = this.prepared();
  }

  /** Number of states of the visible paths. */
  get points(): number {
    const seen = ({ ribbon }: Path) => ribbon.object.visible && ribbon.count > 0;
    const states = this.closed.filter(seen).map(({ ribbon }) => ribbon.count);
    return states.reduce((sum, count) => sum + count, this.open.filter(seen).length * this.asked);
  }

  /** Whether further frames are needed. */
  get unfinished(): boolean {
    return this.work !== null;
  }

  update({ time, whole }: Instant, shown: Shown): void {
    const end = performance.now() + (time === this.seen ? PAUSED : FRAME);
    this.seen = time;
    do {
      this.request(time, shown);
      if (this.work && advance(this.work, whole ? Infinity : end - performance.now())) this.work = null;
    } while (this.request(time, shown) && (whole || performance.now() < end));
    for (const { name, ribbon } of [...this.open, ...this.closed]) ribbon.object.visible = shown[name];
    for (const { ribbon, tail } of this.open) ribbon.fade((time - this.middle) / tail);
  }

  /** Begins to compute another stretch if it is needed. */
  private request(time: number, shown: Shown): boolean {
    if (Number.isNaN(this.tail) || !this.open.some(({ name }) => shown[name])) return this.unfinished;
    // The stretch depends on the time alone, so that equal times give equal pictures.
    const middle = this.tail * Math.round(time / this.tail);
    if (middle !== this.wanted) {
      this.wanted = middle;
      this.work = middle === this.middle ? null : this.stretch(middle);
    }
    return this.unfinished;
  }

  /** Decides how long tails are, and computes a closed polhode. */
  private *prepared(): Steps<void> {
    const { figure } = this;
    const tail = yield* tailOf(figure);
    // ω repeats the same curves.
    const turns = Math.min(tail, (2 * TURNS * Math.PI) / figure.omega);
    const polhode = this.path("polhode", 2.4, turns, tipAt(State.omegaBody, LIFTED * figure.rate));
    const open = [
      this.path("trace", 2.2, tail, axisAt(figure.traced)),
      this.path("herpolhode", 2, turns, tipAt(State.omegaSpace, figure.rate)),
    ];
    const period = figure.about.free?.period ?? null;
    if (period !== null && within(figure, period)) {
      polhode.ribbon.set(yield* polhodeOf(figure, period), { closed: true });
      this.closed.push(polhode);
    } else {
      open.push(polhode);
    }
    [this.open, this.tail] = [open, tail];
  }

  private path(name: Path["name"], width: number, tail: number, point: Path["point"]): Path {
    const ribbon = new Ribbon(this.screen, this.palette[name], {
      width,
      behind: name === "trace" ? 0.3 : 0.35,
    });
    (name === "polhode" ? this.inBody : this.inSpace).add(ofLayer(name, ribbon.object));
    this.curves.add(ribbon.curve(name));
    return { name, ribbon, tail, point };
  }

  private *stretch(time: number): Steps<void> {
    const { figure } = this;
    // Times are multiples of one step, so that successive stretches have the same points.
    const [first, last] = span(figure.about);
    const step = Math.min(3 * this.tail, last - first) / POINTS;
    const from = Math.ceil(Math.max(beginning(figure, time) ?? first, time - 1.5 * this.tail) / step);
    const to = Math.floor(Math.min(last, time + 1.5 * this.tail) / step);
    const times = Float64Array.from({ length: Math.max(to - from + 1, 1) }, (_, k) =>
      Math.min(Math.max((from + k) * step, first), last),
    );
    const rows = yield* this.rows(from, times);
    const drawn: (() => void)[] = [];
    for (const path of this.open) {
      const points = yield* pointsOf(rows, path.point);
      const kept = yield* thinned(points);
      const parameters = kept.map((k) => (times[k]! - time) / path.tail);
      const seen = new Float64Array(3 * kept.length);
      kept.forEach((k, place) => seen.set(points.subarray(3 * k, 3 * k + 3), 3 * place));
      drawn.push(() => path.ribbon.setNumbers(seen, { parameters }));
      yield;
    }
    // All at once: they fade together.
    for (const draw of drawn) draw();
    this.middle = time;
    this.asked = times.length;
  }

  /** The states at the times of a stretch, of which the last stretch has most. */
  private *rows(from: number, times: Float64Array): Steps<Float64Array> {
    const { last } = this;
    const count = times.length;
    const common = (k: number) => Math.min(Math.max(k, 0), count);
    const first = last ? common(last.from - from) : count;
    const end = last ? common(last.from + last.rows.length / ROW - from) : count;
    const rows = new Float64Array(ROW * count);
    if (last && first < end) {
      const shift = from - last.from;
      rows.set(last.rows.subarray(ROW * (first + shift), ROW * (end + shift)), ROW * first);
    }
    const parts = first < end ? [[0, first] as const, [end, count] as const] : [[0, count] as const];
    for (const [a, b] of parts) {
      if (a < b) rows.set(yield* statesOf(this.figure.motion, times.subarray(a, b)), ROW * a);
    }
    this.last = { from, rows };
    return rows;
  }
}

/** Duration of a tail: for a free body some turns and a period; for a top as long as its path is resolved. */
function* tailOf(figure: Figure): Steps<number> {
  const { about } = figure;
  const turn = (2 * Math.PI) / figure.omega;
  if (!about.held) {
    const period = 1.1 * (about.free?.period ?? 0);
    return Math.min(
      Math.max(TURNS * turn, period),
      MOST_TURNS * turn,
      about.exact ? Infinity : about.duration,
    );
  }
  let tail = about.duration;
  for (let halved = 0; halved < 12 && !(yield* resolved(figure, tail)); halved++) tail /= 2;
  return tail;
}

/** Whether the path turns little between its points, except at cusps. */
function* resolved(figure: Figure, tail: number): Steps<boolean> {
  const count = 600;
  const step = (3 * tail) / POINTS;
  const { start, duration } = figure.about;
  const times = Float64Array.from({ length: count }, (_, k) => start.time + Math.min(k * step, duration));
  const path = vectors(yield* pointsOf(yield* statesOf(figure.motion, times), axisAt(figure.traced)));
  let bent = 0;
  for (let k = 1; k < path.length - 1; k++) {
    const [before, after] = [piece(path, k - 1), piece(path, k)];
    const seen = before.length() > 2e-3 && after.length() > 2e-3;
    if (seen && before.angleTo(after) > 0.3) bent++;
  }
  return bent <= 0.02 * count;
}

/**
 * Where paths begin that are seen at a time from the start on; null for as early as they are known. Before the start of a
 * damped motion ω is larger the earlier it is.
 */
function beginning({ about }: Figure, time: number): number | null {
  const bounded = about.free !== null || about.top !== null;
  return about.exact && !bounded && time >= about.start.time ? about.start.time : null;
}

/** Whether the motion is known for a duration from its start. */
function within(figure: Figure, duration: number): boolean {
  const { start } = figure.about;
  const [first, last] = span(figure.about);
  return first <= start.time && start.time + duration <= last;
}

/** The tip of a unit vector of the body in space. */
function axisAt(axis: Vector3): Path["point"] {
  const turn = new Quaternion();
  return (rows, at, into) => {
    quaternion(rows, at + State.rotor, turn);
    into.copy(axis).applyQuaternion(turn).multiplyScalar(REACH);
  };
}

/** The tip of a vector of the rows. */
function tipAt(offset: number, scale: number): Path["point"] {
  return (rows, at, into) => void vector(rows, at + offset, into).multiplyScalar(scale);
}

/** The points (n × 3) of a path at rows of states. */
function* pointsOf(rows: Float64Array, point: Path["point"]): Steps<Float64Array> {
  const here = new Vector3();
  const points = new Float64Array((3 * rows.length) / ROW);
  for (let k = 0; k < points.length / 3; k++) {
    if (k % STEP === STEP - 1) yield;
    point(rows, ROW * k, here);
    here.toArray(points, 3 * k);
  }
  return points;
}

function vectors(points: Float64Array): Vector3[] {
  return Array.from({ length: points.length / 3 }, (_, k) => new Vector3().fromArray(points, 3 * k));
}

/** A closed polhode. The speed of ω varies greatly near a saddle, so intervals are halved until points are close. */
function* polhodeOf(figure: Figure, period: number): Steps<Vector3[]> {
  const near = 0.02;
  const start = figure.about.start.time;
  let times = Array.from({ length: 256 }, (_, k) => start + (period * k) / 256);
  let points = yield* rates(figure, times);
  for (let halved = 0; halved < 12 && times.length < POINTS / 4; halved++) {
    const finer = times.flatMap((time, k) => {
      const gap = points[k]!.distanceTo(points[(k + 1) % times.length]!);
      return gap > near ? [time, (time + (times[k + 1] ?? start + period)) / 2] : [time];
    });
    if (finer.length === times.length) break;
    times = finer;
    points = yield* rates(figure, times);
  }
  return points;
}

/** Points of the polhode. */
function* rates(figure: Figure, times: number[]): Steps<Vector3[]> {
  const rows = yield* statesOf(figure.motion, Float64Array.from(times));
  return vectors(yield* pointsOf(rows, tipAt(State.omegaBody, LIFTED * figure.rate)));
}

/** From a point of a path to the next one. */
function piece(points: readonly Vector3[], k: number): Vector3 {
  return points[k + 1]!.clone().sub(points[k]!);
}

/** Indices of the points that a smooth line needs: few where it is nearly straight. */
function* thinned(points: Float64Array): Steps<number[]> {
  const kept: number[] = [];
  const count = points.length / 3;
  // The last kept point, and the direction of the path there.
  const [last, way] = [new Vector3(), new Vector3()];
  const [here, on] = [new Vector3(), new Vector3()];
  for (let k = 0; k < count; k++) {
    if (k % STEP === STEP - 1) yield;
    here.fromArray(points, 3 * k);
    const inner = k > 0 && k < count - 1;
    if (k < count - 1) {
      on.fromArray(points, 3 * k + 3)
        .sub(here)
        .normalize();
    }
    if (inner && on.lengthSq() === 0) continue;
    const chord = here.distanceTo(last);
    // The height of an arc is 1/8 of its chord times its turn.
    if (inner && chord < LONGEST && chord * on.distanceTo(way) < 8 * NEAR) continue;
    if (k < count - 1) way.copy(on);
    kept.push(k);
    last.copy(here);
  }
  return kept;
}
