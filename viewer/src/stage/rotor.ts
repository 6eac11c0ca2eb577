import { Quaternion, Vector3 } from "three";

/** The quaternion of a rotor (1, e2e3, e3e1, e1e2). */
export function quaternion(rotor: ArrayLike<number>, at = 0, into = new Quaternion()): Quaternion {
  return into.set(-rotor[at + 1]!, -rotor[at + 2]!, -rotor[at + 3]!, rotor[at]!);
}

/** Three numbers: a vector, or the axial vector of a bivector (e2e3, e3e1, e1e2). */
export function vector(numbers: ArrayLike<number>, at = 0, into = new Vector3()): Vector3 {
  return into.set(numbers[at]!, numbers[at + 1]!, numbers[at + 2]!);
}

export const AXES: readonly [Vector3, Vector3, Vector3] = [
  new Vector3(1, 0, 0),
  new Vector3(0, 1, 0),
  new Vector3(0, 0, 1),
];
