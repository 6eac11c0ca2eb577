import { signal } from "@preact/signals";
import { Group, Matrix4, Mesh, Plane, Quaternion, Raycaster, Vector2, Vector3 } from "three";
import { hasMass, State } from "../core/core.ts";
import { quantity, significant } from "../format/numbers.ts";
import type { Palette } from "../palette.ts";
import type { Figure } from "../stage/figure.ts";
import type { Part, Setting } from "../stage/part.ts";
import { quaternion, vector } from "../stage/rotor.ts";
import { Shapes } from "../stage/shapes.ts";
import { look } from "../stage/surface.ts";
import type { Sight } from "../stage/tools.ts";
import { linear } from "./globe.ts";
import { ARROWS, Grip } from "./grip.ts";
import type { Hands } from "./hands.ts";
import { pushed } from "./impulse.ts";

/** An arrow of one drawn unit, at one drawn unit from the origin, changes L by this part of its size. */
const STRENGTH = 0.5;
/** Shorter arrows do not push. */
const LEAST = 0.03;
/** What an arrow key adds to the arrow, or moves its foot by, in drawn units; with Shift, a tenth. */
const STEP = 0.1;

/** An arrow: its foot on the body, in body axes, and its length and direction in space; in drawn units. */
interface Arrow {
  foot: Vector3;
  along: Vector3;
}

/** Pushes the body with an impulse at a point of its surface. */
export class Push {
  /** While it is drawn. */
  readonly arrow = signal<Arrow | null>(null);
  private sight: Sight | null = null;
  private figure: Figure | null = null;
  /** The foot for the keys, until the pointer has chosen another. */
  private foot: { of: Figure; at: Vector3 } | null = null;
  private grip: Grip | null = null;
  private dragging: number | null = null;

  constructor(
    private readonly hands: Hands,
    private readonly palette: () => Palette,
  ) {}

  attach(host: HTMLElement, layer: HTMLElement): () => void {
    this.grip = new Grip(layer, "grip-push", "J", { grab: () => false, drag() {}, step() {}, release() {} });
    this.grip.button.addEventListener("keydown", this.key, true);
    const stop = new AbortController();
    const options = { capture: true, signal: stop.signal };
    host.addEventListener("pointerdown", (event) => this.down(event, host), options);
    host.addEventListener("pointermove", (event) => this.move(event), options);
    host.addEventListener("pointerup", (event) => this.up(event, true), options);
    host.addEventListener("pointercancel", (event) => this.up(event, false), options);
    host.ownerDocument.addEventListener(
      "keydown",
      (event) => {
        if (event.key === "Escape" && this.dragging !== null) this.end(false);
      },
      options,
    );
    return () => stop.abort();
  }

  place(sight: Sight | null, figure: Figure | null): void {
    [this.sight, this.figure] = [sight, figure];
    if (!this.grip) return;
    if (!sight || !figure) return this.grip.hide();
    const seen = this.active && this.dragging === null;
    const at = seen ? this.footOf(figure, sight).clone() : null;
    this.grip.place(
      at && at.applyQuaternion(quaternion(sight.row, State.rotor)).applyMatrix4(sight.space),
      sight,
    );
    this.grip.describe(
      "Impulse J on the body. Arrow keys draw it, with Alt they move its foot; Enter pushes, Esc ends.",
      this.palette().text,
    );
  }

  part({ palette, screen }: Setting): Part {
    const shapes = new Shapes(screen, palette.text);
    const shaft = shapes.arrow(new Vector3(), { width: 4, behind: 0.5 });
    shapes.ball(new Vector3(), 0.035);
    const inSpace = new Group().add(shapes.object);
    return {
      inSpace,
      update: ({ attitude }) => {
        const arrow = this.arrow.peek();
        inSpace.visible = this.active && arrow !== null;
        if (!arrow) return;
        inSpace.position.copy(arrow.foot).applyQuaternion(attitude);
        shaft.point(arrow.along);
      },
    };
  }

  /** Says what the arrow would do. */
  private say(): void {
    const [arrow, found] = [this.arrow.peek(), this.result()];
    this.hands.doing.value = null;
    if (!arrow || !found) return;
    const { about, size } = this.figure!;
    const whole = hasMass(about);
    const part = found.after.momentum.length() / (vector(this.sight!.row, State.momentumSpace).length() || 1);
    const impulse = `J = ${quantity(found.impulse.length(), whole ? "N s" : "")}`;
    const arm = `${quantity(arrow.foot.length() * size, "m")} from the ${about.held ? "pivot" : "centre"}`;
    this.hands.doing.value =
      `${impulse.trim()}${whole ? ` at ${arm}` : ""}: L changes by ${significant(100 * part, 3)} %, ` +
      `E by ${found.after.energy > 0 ? "+" : ""}${significant(found.after.energy, 3)}${whole ? " J" : ""}.`;
  }

  private get active(): boolean {
    return this.hands.tool.peek() === "push" && this.hands.able.peek();
  }

  /** The impulse of the arrow, and the body after it. */
  private result() {
    const [arrow, sight, figure] = [this.arrow.peek(), this.sight, this.figure];
    if (!arrow || !sight || !figure) return null;
    const { about, size } = figure;
    const row = sight.row;
    const resting = vector(row, State.momentumSpace).length() === 0;
    const scale = resting ? Math.max(...about.body.moments) : figure.momentum;
    const impulse = arrow.along.clone().multiplyScalar((STRENGTH * scale) / size);
    const at = arrow.foot.clone().applyQuaternion(quaternion(row, State.rotor)).multiplyScalar(size);
    return { impulse, after: pushed(row, about, at, impulse) };
  }

  private down(event: PointerEvent, host: HTMLElement): void {
    // A second finger zooms.
    if (this.dragging !== null) return this.end(false);
    if (!this.active || event.button !== 0) return;
    const foot = this.hit(this.pointer(event, host));
    if (!foot || !this.hands.grab()) return;
    // Not the camera's.
    event.stopPropagation();
    event.preventDefault();
    host.setPointerCapture(event.pointerId);
    this.dragging = event.pointerId;
    this.foot = { of: this.figure!, at: foot };
    this.arrow.value = { foot, along: new Vector3() };
    this.say();
  }

  private move(event: PointerEvent): void {
    const arrow = this.arrow.peek();
    if (event.pointerId !== this.dragging || !arrow || !this.sight) return;
    event.stopPropagation();
    const { camera, space, row } = this.sight;
    const foot = arrow.foot.clone().applyQuaternion(quaternion(row, State.rotor)).applyMatrix4(space);
    const ray = this.caster(this.pointer(event, event.currentTarget as HTMLElement)).ray;
    // In the plane of the screen.
    const plane = new Plane().setFromNormalAndCoplanarPoint(camera.getWorldDirection(new Vector3()), foot);
    const tip = ray.intersectPlane(plane, new Vector3());
    if (!tip) return;
    this.arrow.value = { ...arrow, along: linear(space.clone().invert(), tip.sub(foot)) };
    this.say();
  }

  private up(event: PointerEvent, pushes: boolean): void {
    if (event.pointerId === this.dragging) this.end(pushes);
  }

  private end(pushes: boolean): void {
    this.dragging = null;
    if (pushes) this.push();
    this.arrow.value = null;
    this.say();
    this.hands.release();
  }

  /** Adds the impulse of the arrow to the motion. */
  private push(): void {
    const [arrow, found] = [this.arrow.peek(), this.result()];
    if (!arrow || !found || arrow.along.length() < LEAST) return;
    const { omega } = found.after;
    const { mass } = this.figure!.about.body;
    const velocity = vector(this.sight!.row, State.velocity);
    const kicked = this.hands.moves(this.sight!.row) && mass !== null && mass > 0;
    this.hands.give(
      "Push",
      kicked ? { omega, velocity: velocity.addScaledVector(found.impulse, 1 / mass) } : { omega },
    );
  }

  private readonly key = (event: KeyboardEvent): void => {
    const [sight, figure] = [this.sight, this.figure];
    if (!this.active || !sight || !figure || event.ctrlKey || event.metaKey) return;
    const way = ARROWS[event.key];
    const arrow = this.arrow.peek();
    if (event.key === "Escape" && arrow) this.arrow.value = null;
    else if (event.key === "Enter" || event.key === " ") {
      if (arrow && this.hands.grab(true)) this.push();
      this.arrow.value = null;
    } else if (way) {
      this.hands.grab(true);
      const step = event.shiftKey ? STEP / 10 : STEP;
      const [right, up] = [way[0] * step, way[1] * step];
      const foot = this.footOf(figure, sight);
      const along = arrow?.along.clone() ?? new Vector3();
      if (event.altKey) this.walk(foot, right, up, along);
      else this.arrow.value = { foot, along: along.add(onScreen(sight, right, up)) };
    } else return;
    event.preventDefault();
    event.stopPropagation();
    this.say();
  };

  /** Moves the foot over the body. */
  private walk(foot: Vector3, right: number, up: number, along: Vector3): void {
    const { camera, space, row } = this.sight!;
    const at = foot
      .clone()
      .applyQuaternion(quaternion(row, State.rotor))
      .add(onScreen(this.sight!, right, up));
    const seen = at.applyMatrix4(space).project(camera);
    const hit = this.hit(new Vector2(seen.x, seen.y));
    if (!hit) return;
    this.foot = { of: this.figure!, at: hit };
    this.arrow.value = { foot: hit, along };
  }

  /** The chosen foot, or the point of the body that is farthest to the upper right. */
  private footOf(figure: Figure, sight: Sight): Vector3 {
    if (this.foot && sameBody(this.foot.of, figure)) {
      this.foot.of = figure;
      return this.foot.at;
    }
    const way = linear(
      sight.space.clone().invert(),
      linear(sight.camera.matrixWorld, new Vector3(1, 0.6, 0.5)),
    ).applyQuaternion(quaternion(sight.row, State.rotor).conjugate());
    const { vertices } = figure.surface;
    let best = new Vector3();
    for (let k = 0; k < vertices.length; k += 3) {
      const vertex = vector(vertices, k);
      if (k === 0 || vertex.dot(way) > best.dot(way)) best = vertex;
    }
    this.foot = { of: figure, at: best };
    return best;
  }

  /** Where a ray through a point of the picture meets the body, in body axes. */
  private hit(pointer: Vector2): Vector3 | null {
    const [sight, figure] = [this.sight, this.figure];
    if (!sight || !figure) return null;
    const body = new Mesh(look(figure.surface).faces);
    const turn = new Matrix4().makeRotationFromQuaternion(
      quaternion(sight.row, State.rotor, new Quaternion()),
    );
    body.matrixWorld.multiplyMatrices(sight.space, turn);
    const [first] = this.caster(pointer).intersectObject(body, false);
    return first ? body.worldToLocal(first.point.clone()) : null;
  }

  private caster(pointer: Vector2): Raycaster {
    const caster = new Raycaster();
    caster.setFromCamera(pointer, this.sight!.camera);
    return caster;
  }

  /** The place of the pointer in the picture, from −1 to 1. */
  private pointer({ clientX, clientY }: PointerEvent, host: HTMLElement): Vector2 {
    const { left, top, width, height } = host.getBoundingClientRect();
    return new Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
  }
}

/** A vector to the right and up on the screen, in space axes. */
function onScreen({ camera, space }: Sight, right: number, up: number): Vector3 {
  return linear(space.clone().invert(), linear(camera.matrixWorld, new Vector3(right, up, 0)));
}

/** Whether two motions show the same body. */
function sameBody(a: Figure, b: Figure): boolean {
  return a === b || look(a.surface) === look(b.surface);
}
