import { Group, type Vector3 } from "three";
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
/** Time in ms for the paths of one frame, so that the page stays responsive. */
const FRAME = 12;
/** The longest piece of a line, so that fading along it is even. */
const LONGEST = 0.15;
/** Scale of the polhode, so that it is drawn over the ellipsoid on which it lies. */
const LIFTED = 1.004;

interface Path {
  name: "trace" | "herpolhode" | "polhode";
  ribbon: Ribbon;
  /** How long it is seen, s. */
  tail: number;
  /** Its points from rows of states. */
  points: (rows: Float64Array) => Vector3[];
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
  /** Duration of a tail in s, the middle of the stretch, and that of the stretch that is being computed. */
  private tail = Number.NaN;
  private middle = Number.NaN;
  private wanted = Number.NaN;
  private asked = 0;
  private work: Steps<void> | null;

  constructor({ figure, palette, screen }: Setting) {
    [this.figure, this.palette, this.screen] = [figure, palette, screen];
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
    const end = performance.now() + FRAME;
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
    const polhode = this.path("polhode", 2.4, turns, (rows) =>
      taken(rows, State.omegaBody, LIFTED * figure.rate),
    );
    const open = [
      this.path("trace", 2.2, tail, (rows) => traced(rows, figure.traced)),
      this.path("herpolhode", 2, turns, (rows) => taken(rows, State.omegaSpace, figure.rate)),
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

  private path(name: Path["name"], width: number, tail: number, points: Path["points"]): Path {
    const ribbon = new Ribbon(this.screen, this.palette[name], {
      width,
      behind: name === "trace" ? 0.3 : 0.35,
    });
    (name === "polhode" ? this.inBody : this.inSpace).add(ofLayer(name, ribbon.object));
    return { name, ribbon, tail, points };
  }

  private *stretch(time: number): Steps<void> {
    const { figure } = this;
    // Times are multiples of one step, so that successive stretches have the same points.
    const [first, last] = span(figure.about);
    const step = Math.min(3 * this.tail, last - first) / POINTS;
    const from = Math.ceil(Math.max(first, time - 1.5 * this.tail) / step);
    const to = Math.floor(Math.min(last, time + 1.5 * this.tail) / step);
    const times = Float64Array.from({ length: Math.max(to - from + 1, 1) }, (_, k) =>
      Math.min(Math.max((from + k) * step, first), last),
    );
    const rows = yield* statesOf(figure.motion, times);
    const drawn: (() => void)[] = [];
    for (const path of this.open) {
      const points = path.points(rows);
      yield;
      const kept = thinned(points);
      const parameters = kept.map((k) => (times[k]! - time) / path.tail);
      const seen = kept.map((k) => points[k]!);
      drawn.push(() => path.ribbon.set(seen, { parameters }));
      yield;
    }
    // All at once: they fade together.
    for (const draw of drawn) draw();
    this.middle = time;
    this.asked = times.length;
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
  const path = traced(yield* statesOf(figure.motion, times), figure.traced);
  let bent = 0;
  for (let k = 1; k < path.length - 1; k++) {
    const [before, after] = [piece(path, k - 1), piece(path, k)];
    const seen = before.length() > 2e-3 && after.length() > 2e-3;
    if (seen && before.angleTo(after) > 0.3) bent++;
  }
  return bent <= 0.02 * count;
}

/** Whether the motion is known for a duration from its start. */
function within(figure: Figure, duration: number): boolean {
  const { start } = figure.about;
  const [first, last] = span(figure.about);
  return first <= start.time && start.time + duration <= last;
}

/** The tips of a unit vector of the body in space. */
function traced(rows: Float64Array, axis: Vector3): Vector3[] {
  return offsets(rows).map((at) =>
    axis
      .clone()
      .applyQuaternion(quaternion(rows, at + State.rotor))
      .multiplyScalar(REACH),
  );
}

function taken(rows: Float64Array, offset: number, scale: number): Vector3[] {
  return offsets(rows).map((at) => vector(rows, at + offset).multiplyScalar(scale));
}

function offsets(rows: Float64Array): number[] {
  return Array.from({ length: rows.length / ROW }, (_, k) => ROW * k);
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
  return taken(rows, State.omegaBody, LIFTED * figure.rate);
}

/** From a point of a path to the next one. */
function piece(points: readonly Vector3[], k: number): Vector3 {
  return points[k + 1]!.clone().sub(points[k]!);
}

/** Indices of the points that a smooth line needs: few where it is nearly straight. */
function thinned(points: readonly Vector3[]): number[] {
  const kept: number[] = [];
  // The last kept point, and the direction of the path there.
  let last = points[0]!;
  let way: Vector3 | null = null;
  points.forEach((here, k) => {
    if (k > 0 && k < points.length - 1) {
      const on = piece(points, k).normalize();
      way ??= piece(points, 0).normalize();
      if (on.length() === 0) return;
      const chord = here.distanceTo(last);
      // The height of an arc is 1/8 of its chord times its turn.
      if (chord < LONGEST && chord * on.distanceTo(way) < 8 * NEAR) return;
      way = on;
    }
    kept.push(k);
    last = here;
  });
  return kept;
}
