import { BoxGeometry, Group, InstancedMesh, Matrix4, MeshLambertMaterial, Quaternion, Vector3 } from "three";
import { Problem } from "../core/core.ts";
import type { Motion } from "../core/wasm.ts";
import type { Palette } from "../palette.ts";
import { type Figure, REACH } from "./figure.ts";
import type { Instant, Part } from "./part.ts";
import { quaternion } from "./rotor.ts";

/** Maximum number of bodies. */
const MOST = 1000;
/** The length of a small body. */
const SIZE = 0.06;

/**
 * The bodies of an ensemble: small boxes on the sphere around the nominal body, each with its own attitude and in the
 * direction of its own axis. They start together and spread over the sphere.
 */
export class Crowd implements Part {
  readonly inSpace = new Group();
  private readonly material = new MeshLambertMaterial({ emissiveIntensity: 0.15 });
  private bodies: InstancedMesh<BoxGeometry, MeshLambertMaterial> | null = null;
  /** The reason why the bodies are not drawn. */
  problem: string | null = null;
  private motion: Motion | null = null;
  private axis = new Vector3();
  private time = Number.NaN;

  follow(figure: Figure): void {
    this.clear();
    const { about, motion } = figure;
    if (about.ensemble === null) return;
    this.motion = motion;
    this.axis.copy(figure.traced);
    const sides = extent(figure.surface.vertices);
    const box = new BoxGeometry(...sides.multiplyScalar(SIZE / Math.max(...sides.toArray())).toArray());
    this.bodies = new InstancedMesh(box, this.material, Math.min(MOST, about.ensemble));
    this.bodies.frustumCulled = false;
    this.inSpace.add(this.bodies);
  }

  paint(palette: Palette): void {
    this.material.color.set(palette.trace);
    this.material.emissive.set(palette.trace);
  }

  update({ time }: Instant): void {
    if (!this.bodies || !this.motion || time === this.time) return;
    this.time = time;
    const rotors = this.rotors(this.motion, Math.max(time, this.motion.about.start.time));
    const count = Math.min(rotors.length / 4, MOST);
    const [turn, place, whole] = [new Quaternion(), new Vector3(), new Vector3(1, 1, 1)];
    const matrix = new Matrix4();
    for (let k = 0; k < count; k++) {
      quaternion(rotors, 4 * k, turn);
      place.copy(this.axis).applyQuaternion(turn).multiplyScalar(REACH);
      this.bodies.setMatrixAt(k, matrix.compose(place, turn, whole));
    }
    this.bodies.count = count;
    this.bodies.instanceMatrix.needsUpdate = true;
  }

  /** The rotors of the bodies; none if their motion fails, with the reason in `problem`. */
  private rotors(motion: Motion, time: number): Float64Array {
    try {
      return motion.bodies(time, MOST);
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      this.problem = error.message;
      this.motion = null;
      return new Float64Array();
    }
  }

  dispose(): void {
    this.clear();
    this.material.dispose();
  }

  private clear(): void {
    this.inSpace.clear();
    this.bodies?.geometry.dispose();
    this.bodies?.dispose();
    this.bodies = null;
    this.motion = null;
    this.problem = null;
    this.time = Number.NaN;
  }
}

/** The sides of the box around points. */
function extent(points: ArrayLike<number>): Vector3 {
  const [low, high, point] = [
    new Vector3(Infinity, Infinity, Infinity),
    new Vector3(-Infinity, -Infinity, -Infinity),
    new Vector3(),
  ];
  for (let at = 0; at < points.length; at += 3) {
    point.set(points[at]!, points[at + 1]!, points[at + 2]!);
    low.min(point);
    high.max(point);
  }
  return high.sub(low);
}
