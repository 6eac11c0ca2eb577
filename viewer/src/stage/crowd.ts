import { Box3, BoxGeometry, InstancedMesh, Matrix4, MeshLambertMaterial, Quaternion, Vector3 } from "three";
import { BODIES, Problem } from "../core/core.ts";
import { REACH } from "./figure.ts";
import type { Part, Setting } from "./part.ts";
import { quaternion } from "./rotor.ts";

/** The length of a small body. */
const SIZE = 0.06;
/** The opacity of a cloud that is old. */
const OLD = 0.4;

/**
 * The bodies of an ensemble: small boxes on the sphere around the nominal body, each with its own attitude and in the
 * direction of its own axis. They start together and spread over the sphere.
 */
export function crowd(setting: Setting): Part | null {
  const { figure, palette, curves, cloud, bodiesKnown, say } = setting;
  const { about, motion, traced } = figure;
  if (about.ensemble === null) {
    cloud.matrices = null;
    return null;
  }
  const old = motion.awaitsBodies ? cloud.matrices : null;
  let said = "";
  // Screen readers read each message.
  const sayOnce = (message: string): void => {
    if (message !== said) say((said = message));
  };
  if (motion.awaitsBodies && !old) return { update: () => sayOnce(progress(bodiesKnown())) };
  const sides = new Box3().setFromArray(figure.surface.vertices).getSize(new Vector3());
  const box = new BoxGeometry(...sides.multiplyScalar(SIZE / Math.max(...sides)));
  const material = new MeshLambertMaterial({
    color: palette.trace,
    emissive: palette.trace,
    emissiveIntensity: 0.15,
    // Paler while it is that of the motion before: a cloud that vanished while a slider moves would flicker.
    ...(old && { transparent: true, opacity: OLD }),
  });
  const count = Math.min(BODIES, about.ensemble);
  const bodies = new InstancedMesh(box, material, old ? old.length / 16 : count);
  bodies.frustumCulled = false;
  if (old) {
    bodies.instanceMatrix.array.set(old);
    return { inSpace: bodies, update: () => {} };
  }
  curves.add({
    name: "cloud",
    object: bodies,
    visit: (point) => {
      const places = bodies.instanceMatrix.array;
      for (let at = 12; at < 16 * bodies.count; at += 16) {
        point(places[at]!, places[at + 1]!, places[at + 2]!, false);
      }
    },
  });
  let drawn = Number.NaN;

  const draw = (rotors: Float64Array): void => {
    const [turn, place, whole] = [new Quaternion(), new Vector3(), new Vector3(1, 1, 1)];
    const matrix = new Matrix4();
    const all = rotors.length / 4;
    bodies.count = 0;
    for (let k = 0; k < all; k++) {
      if (Number.isNaN(rotors[4 * k])) continue;
      quaternion(rotors, 4 * k, turn);
      place.copy(traced).applyQuaternion(turn).multiplyScalar(REACH);
      bodies.setMatrixAt(bodies.count++, matrix.compose(place, turn, whole));
    }
    bodies.instanceMatrix.needsUpdate = true;
    cloud.matrices = bodies.instanceMatrix.array.subarray(0, 16 * bodies.count);
  };
  return {
    inSpace: bodies,
    update({ time }) {
      if (!bodies.visible || time === drawn) return;
      drawn = time;
      try {
        draw(motion.bodies(Math.max(time, about.start.time)));
        sayOnce(
          bodies.count < count ? missing(count - bodies.count, count, motion.bodiesProblem !== "") : "",
        );
      } catch (error) {
        if (!(error instanceof Problem)) throw error;
        bodies.visible = false;
        say(`The other bodies are not drawn: ${error.message}`);
      }
    },
  };
}

function progress(known: number): string {
  const tenths = Math.floor(10 * known);
  return `The other bodies are being computed${tenths > 0 ? `: ${10 * tenths} %` : "…"}`;
}

function missing(some: number, all: number, known: boolean): string {
  const why = known ? "; “Details” says why" : "";
  return `${some.toLocaleString("en")} of ${all.toLocaleString("en")} bodies are not drawn${why}.`;
}
