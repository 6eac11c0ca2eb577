import { Group, Matrix4, Quaternion, type Vector2, Vector3 } from "three";
import { State } from "../core/core.ts";
import type { Palette } from "../palette.ts";
import type { Part, Setting } from "../stage/part.ts";
import { AXES, quaternion, vector } from "../stage/rotor.ts";
import { across, aim as point, arc, Shapes } from "../stage/shapes.ts";
import type { Sight } from "../stage/tools.ts";
import { isBehind, moved, rayAt, under } from "./globe.ts";
import { Grip, type Holding } from "./grip.ts";
import type { Given, Hands } from "./hands.ts";
import { Held } from "./held.ts";
import { turned } from "./impulse.ts";

/** Distances of the grips from the origin, in drawn units: those of Ω and L are apart where both point alike. */
const RADII = { omega: 1.12, momentum: 1.68, attitude: 1.3 } as const;
type Kind = keyof typeof RADII;

const NAMES: Record<Kind, [symbol: string, label: string, what: string]> = {
  omega: ["Ω", "Direction of Ω in space; its size and the attitude stay.", "Ω turned"],
  momentum: ["L", "Direction of L in space; its size and the attitude stay.", "L turned"],
  attitude: ["R", "End of the arc of the attitude R; Ω in the body stays.", "R turned"],
};

/** Grips at the normals of the discs of Ω and L, and at the end of the arc of the rotor R. */
export class Aim {
  private readonly pulls: Pull[];

  constructor(
    private readonly hands: Hands,
    private readonly palette: () => Palette,
  ) {
    this.pulls = (Object.keys(RADII) as Kind[]).map((kind) => new Pull(kind, hands));
  }

  /** Changes when another frame is needed. */
  get changed(): unknown[] {
    return this.pulls.map(({ held }) => held.value.value);
  }

  attach(layer: HTMLElement): () => void {
    for (const pull of this.pulls) pull.attach(layer);
    return () => this.pulls.forEach(({ held }) => held.dispose());
  }

  place(sight: Sight | null): void {
    const palette = this.palette();
    const colours: Record<Kind, string> = {
      omega: palette.omega,
      momentum: palette.momentum,
      attitude: palette.text,
    };
    for (const pull of this.pulls) {
      if (sight) pull.place(sight, this.active, colours[pull.kind]);
      else pull.hide();
    }
  }

  part({ palette, screen }: Setting): Part {
    const thin = { width: 1.6, behind: 0.35 };
    const stems = this.pulls.slice(0, 2).map((pull) => {
      const shapes = new Shapes(screen, palette[pull.kind as "omega" | "momentum"]);
      return { pull, line: shapes.line([], thin), object: shapes.object };
    });
    const turn = new Shapes(screen, palette.text);
    const line = turn.line([], { width: 2.6, behind: 0.35 });
    const head = turn.head(AXES[0], AXES[1]);
    const rotor = this.pulls[2]!;
    const inSpace = new Group().add(turn.object, ...stems.map(({ object }) => object));
    return {
      inSpace,
      update: (instant) => {
        inSpace.visible = this.active;
        if (!this.active) return;
        for (const { pull, line: stem } of stems) {
          const axial = instant[pull.kind as "omega" | "momentum"];
          const end = pull.held.value.peek()?.clone() ?? axial.clone().normalize();
          stem.set(end.lengthSq() > 0 ? [new Vector3(), end.multiplyScalar(RADII[pull.kind])] : []);
        }
        const { axis, angle, from } = rotor.arc(instant.attitude);
        const points = arc(axis, from.clone().multiplyScalar(RADII.attitude), angle);
        line.set(points);
        head.visible = angle > 0.08;
        const along = axis.clone().cross(points.at(-1)!);
        if (head.visible) point(head, points.at(-1)!, along);
      },
    };
  }

  private get active(): boolean {
    return this.hands.tool.peek() === "aim" && this.hands.able.peek();
  }
}

/** One grip: a direction in space that is dragged over a sphere. */
class Pull implements Holding {
  /** The direction while it is held. */
  readonly held: Held<Vector3>;
  private grip: Grip | null = null;
  private sight: Sight | null = null;
  private row: Float64Array | null = null;
  private far = false;
  /** Where the arc of the rotor began last: arcs that slide in their plane are the same rotor. */
  private from = AXES[0].clone();

  constructor(
    readonly kind: Kind,
    private readonly hands: Hands,
  ) {
    this.held = new Held(hands.model);
  }

  attach(layer: HTMLElement): void {
    this.grip = new Grip(layer, `grip-${this.kind}`, NAMES[this.kind][0], this);
  }

  hide(): void {
    this.grip?.hide();
  }

  place(sight: Sight, active: boolean, colour: string): void {
    this.sight = sight;
    const at = active ? this.now(sight.row) : null;
    this.grip?.place(at && at.applyMatrix4(this.globe), sight);
    this.grip?.describe(`${NAMES[this.kind][1]} Drag it, or move it with the arrow keys.`, colour);
  }

  /** The arc of a rotor: its plane by the axial vector, its angle up to π, and where it begins. */
  arc(attitude: Quaternion): { axis: Vector3; angle: number; from: Vector3 } {
    const held = this.held.value.peek();
    const turn = held ? new Quaternion().setFromUnitVectors(this.from, held) : attitude;
    const sense = turn.w < 0 ? -1 : 1;
    const axis = new Vector3(turn.x, turn.y, turn.z).multiplyScalar(sense);
    const angle = 2 * Math.atan2(axis.length(), Math.abs(turn.w));
    if (angle < 1e-9) axis.copy(AXES[2]);
    axis.normalize();
    if (!held && Math.abs(axis.dot(this.from)) > 1e-6) this.from = across(axis);
    return { axis, angle, from: this.from };
  }

  grab(byKey: boolean): boolean {
    const { sight } = this;
    const row = this.hands.grab(byKey);
    const at = row && this.now(row);
    if (!sight || !at) return false;
    this.row = row;
    this.far = isBehind(at, this.globe, sight.camera);
    return true;
  }

  drag(pointer: Vector2): void {
    const { u, far } = under(rayAt(pointer, this.sight!.camera), this.globe, this.far);
    this.far = far;
    this.set(u);
  }

  step(right: number, up: number): void {
    this.set(moved(this.now(this.row!)!, right, up, this.globe, this.sight!.camera));
  }

  release(): void {
    this.held.release();
    this.hands.release();
  }

  private get globe(): Matrix4 {
    const size = RADII[this.kind];
    return this.sight!.space.clone().multiply(new Matrix4().makeScale(size, size, size));
  }

  /** The direction of the grip, a unit vector in space axes; null if there is none. */
  private now(row: Float64Array): Vector3 | null {
    const held = this.held.value.peek();
    if (held) return held.clone();
    if (this.kind === "attitude") {
      const { axis, angle, from } = this.arc(quaternion(row, State.rotor));
      return from.clone().applyAxisAngle(axis, angle);
    }
    // L of a body without a moment about some axis cannot have every direction.
    const { moments } = this.hands.model.about.peek()!.body;
    if (this.kind === "momentum" && Math.min(...moments) <= 0) return null;
    const axial = vector(row, this.kind === "omega" ? State.omegaSpace : State.momentumSpace);
    return axial.lengthSq() > 0 ? axial.normalize() : null;
  }

  private set(u: Vector3): void {
    this.held.set(u);
    this.hands.give(NAMES[this.kind][2], this.given(u, this.row!));
  }

  private given(u: Vector3, row: Float64Array): Given {
    if (this.kind === "attitude") return { attitude: new Quaternion().setFromUnitVectors(this.from, u) };
    if (this.kind === "omega") {
      const size = vector(row, State.omegaBody).length();
      const inBody = u.clone().applyQuaternion(quaternion(row, State.rotor).conjugate());
      return { omega: inBody.multiplyScalar(size) };
    }
    const before = vector(row, State.momentumSpace);
    const change = u.clone().multiplyScalar(before.length()).sub(before);
    return { omega: turned(row, this.hands.model.about.peek()!, change).omega };
  }
}
