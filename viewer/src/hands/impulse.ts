import { Vector3 } from "three";
import { type About, State } from "../core/core.ts";
import { quaternion, vector } from "../stage/rotor.ts";

/** A body just after an impulse, which keeps its attitude. Bivectors are given by their axial vectors. */
interface Pushed {
  /** Ω_B, rad/s. */
  omega: Vector3;
  /** The change of L in space, r∧J, kg m²/s. */
  momentum: Vector3;
  /** The change of the kinetic energy of the rotation, J. */
  energy: number;
}

/**
 * An impulse J, N s, at a place r from the centre of mass or the fixed point, m, both in space axes: L changes by r∧J,
 * the dual of r×J (handout 3.2, 4.19).
 */
export function pushed(row: Float64Array, about: About, at: Vector3, impulse: Vector3): Pushed {
  return turned(row, about, at.clone().cross(impulse));
}

/** The body just after L in space has changed by a bivector: Ω_B + I⁻¹(~R ΔL R). */
export function turned(row: Float64Array, about: About, momentum: Vector3): Pushed {
  const inBody = momentum.clone().applyQuaternion(quaternion(row, State.rotor).conjugate());
  const before = vector(row, State.omegaBody);
  const omega = before.clone().add(inverseInertia(about, inBody));
  // I is symmetric, so that ½ Ω'·I(Ω') − ½ Ω·I(Ω) = ½ (Ω' + Ω)·ΔL.
  return { omega, momentum, energy: before.add(omega).dot(inBody) / 2 };
}

/** I⁻¹ in body axes; a rod does not turn about its own line. */
function inverseInertia({ body: { moments, frame } }: About, momentum: Vector3): Vector3 {
  const toBody = quaternion(frame);
  const parts = momentum.clone().applyQuaternion(toBody.clone().conjugate());
  moments.forEach((moment, k) => parts.setComponent(k, moment > 0 ? parts.getComponent(k) / moment : 0));
  return parts.applyQuaternion(toBody);
}
