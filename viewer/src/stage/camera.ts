import { MathUtils, PerspectiveCamera, Quaternion, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { CameraName } from "../document.ts";
import { AXES } from "./rotor.ts";

/** Vertical angle of view in degrees: a long lens, with little perspective. */
const LENS = 24;
/** The radius of a ball that fits into view, in drawn units. */
const FIT = 1.72;
/** Limits of the distance, in units of the distance at which that ball fits. */
const NEAREST = 0.2;
const FARTHEST = 4;
/** Duration of a move to a preset, in s. */
const MOVE = 0.6;
/** The angle of one step of a turn. */
const STEP = (5 * Math.PI) / 180;

/** Azimuth of the preset 'oblique', and its elevations: e1 points left and towards the viewer, e2 right, e3 up. */
export const AZIMUTH = 0.6;
const LOW = 0.33;
/** Higher, to look down on a plane. */
const HIGH = 0.55;

/** Three's spherical coordinates have their pole along y, ours along e3. */
const TO_Y = new Quaternion().setFromUnitVectors(AXES[2], AXES[1]);
const FROM_Y = TO_Y.clone().invert();

/** A turn of the camera: steps to the right and down around the figure, and the factor of nearness. */
export type Turn = readonly [across: number, down: number, closer: number];

/** Keys that turn the camera. */
export const TURNS: Readonly<Record<string, Turn>> = {
  j: [-1, 0, 1],
  l: [1, 0, 1],
  i: [0, -1, 1],
  k: [0, 1, 1],
  "+": [0, 0, 1.1],
  "=": [0, 0, 1.1],
  "-": [0, 0, 1 / 1.1],
};

interface Move {
  from: Spherical;
  to: Spherical;
  withFrom: number;
  withTo: number;
  uprightFrom: Quaternion;
  uprightTo: Quaternion;
  passed: number;
}

/** The camera, which looks at the middle of the figure; the pointer moves it. */
export class Viewpoint {
  readonly camera = new PerspectiveCamera(LENS, 1, 0.1, 100);
  /** How much space turns back under the body: from 0, not at all, to 1, where the body is at rest. */
  withBody = 0;
  /** The turn of space that makes another direction than e3 the vertical of the picture. */
  readonly upright = new Quaternion();
  private readonly controls: OrbitControls;
  private fit = 1;
  private move: Move | null = null;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly changed: () => void,
  ) {
    this.camera.up.copy(AXES[2]);
    this.camera.position.copy(oblique(LOW));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.rotateSpeed = 0.8;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", this.grabbed);
  }

  /** Moves to a preset; `momentum` is the axial vector of L. With an upright, looks down on its horizontal plane. */
  go(name: CameraName, momentum: Vector3, atOnce: boolean, upright: Quaternion | null = null): void {
    const towards = upright ? oblique(HIGH) : direction(name, momentum);
    const to = spherical(towards.multiplyScalar(this.fit));
    const from = this.here;
    // The shorter way around.
    to.theta += 2 * Math.PI * Math.round((from.theta - to.theta) / (2 * Math.PI));
    const withTo = name === "with the body" ? 1 : 0;
    this.move = {
      from,
      to,
      withFrom: this.withBody,
      withTo,
      uprightFrom: this.upright.clone(),
      uprightTo: upright ?? new Quaternion(),
      passed: atOnce ? MOVE : 0,
    };
    this.step(0);
    this.changed();
  }

  /** Moves at once to an azimuth, from e1 towards e2, and an elevation above e1∧e2, in degrees. */
  from(azimuth: number, elevation: number): void {
    this.move = null;
    const radians = Math.PI / 180;
    // The zero of theta is the z axis, to which TO_Y turns −e2.
    this.stand(new Spherical(this.fit, (90 - elevation) * radians, (azimuth + 90) * radians));
  }

  get moving(): boolean {
    return this.move !== null;
  }

  /** Advances a move by some seconds. */
  step(seconds: number): void {
    const { move } = this;
    if (!move) return;
    move.passed += seconds;
    const part = Math.min(move.passed / MOVE, 1);
    const eased = MathUtils.smoothstep(part, 0, 1);
    const between = (a: number, b: number) => MathUtils.lerp(a, b, eased);
    const { from, to } = move;
    this.withBody = between(move.withFrom, move.withTo);
    this.upright.slerpQuaternions(move.uprightFrom, move.uprightTo, eased);
    this.stand(
      new Spherical(
        between(from.radius, to.radius),
        between(from.phi, to.phi),
        between(from.theta, to.theta),
      ),
    );
    if (part === 1) this.move = null;
  }

  /** Adapts to a new size of the canvas: what was in view stays in view. */
  resize(width: number, height: number): void {
    const aspect = width / height;
    this.camera.aspect = aspect;
    const half = Math.tan((LENS * Math.PI) / 360) * Math.min(aspect, 1);
    const fit = FIT / Math.sin(Math.atan(half));
    const at = this.here;
    for (const end of [at, this.move?.from, this.move?.to]) if (end) end.radius *= fit / this.fit;
    this.fit = fit;
    this.controls.minDistance = NEAREST * fit;
    this.controls.maxDistance = FARTHEST * fit;
    this.camera.near = 0.02 * fit;
    this.camera.far = 2 * FARTHEST * fit;
    this.camera.updateProjectionMatrix();
    this.stand(at);
  }

  /** Turns at once, from where the camera is. */
  turn([across, down, closer]: Turn): void {
    const at = this.here;
    at.set(at.radius / closer, at.phi + down * STEP, at.theta + across * STEP);
    this.grabbed();
    this.stand(at);
    this.changed();
  }

  /** Sets the point to look at. */
  look(at: Vector3): void {
    if (this.controls.target.equals(at)) return;
    this.camera.position.add(at).sub(this.controls.target);
    this.controls.target.copy(at);
    this.controls.update();
  }

  dispose(): void {
    this.controls.dispose();
  }

  private readonly grabbed = (): void => {
    if (this.move) {
      this.withBody = this.move.withTo;
      this.upright.copy(this.move.uprightTo);
    }
    this.move = null;
  };

  private stand(at: Spherical): void {
    at.makeSafe();
    this.camera.position.setFromSpherical(at).applyQuaternion(FROM_Y).add(this.controls.target);
    this.controls.update();
  }

  /** The place of the camera around the point that it looks at. */
  private get here(): Spherical {
    return spherical(this.camera.position.clone().sub(this.controls.target));
  }
}

function spherical(from: Vector3): Spherical {
  return new Spherical().setFromVector3(from.applyQuaternion(TO_Y)).makeSafe();
}

/** The direction of the preset 'oblique' at an elevation. */
function oblique(elevation: number): Vector3 {
  const across = Math.cos(elevation);
  return new Vector3(across * Math.cos(AZIMUTH), across * Math.sin(AZIMUTH), Math.sin(elevation));
}

/** The direction of a preset from the middle of the figure, a unit vector in space axes. */
function direction(name: CameraName, momentum: Vector3): Vector3 {
  const axis = ["along e1", "along e2", "along e3"].indexOf(name);
  if (axis >= 0) return AXES[axis as 0 | 1 | 2].clone();
  if (name !== "along L") return oblique(LOW);
  return momentum.length() > 0 ? momentum.clone().normalize() : AXES[2].clone();
}
