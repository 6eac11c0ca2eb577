import { type Camera, Matrix4, Ray, Vector2, Vector3 } from "three";

/** The ray under a point of a picture, in coordinates from −1 to 1. */
export function rayAt(pointer: Vector2, camera: Camera): Ray {
  const origin = new Vector3().setFromMatrixPosition(camera.matrixWorld);
  return new Ray(origin, new Vector3(pointer.x, pointer.y, 0.5).unproject(camera).sub(origin).normalize());
}

/**
 * The point of a unit sphere under a ray, where `globe` takes the sphere to the world, as an ellipsoid perhaps: the
 * nearer one, or the farther one if `far`. For a ray beside the sphere, the point of its edge that is next to the ray:
 * from there a drag comes round to the front, and `far` ends.
 */
export function under(ray: Ray, globe: Matrix4, far: boolean): { u: Vector3; far: boolean } {
  const into = globe.clone().invert();
  const from = ray.origin.clone().applyMatrix4(into);
  const along = linear(into, ray.direction);
  const [a, b, c] = [along.lengthSq(), from.dot(along), from.lengthSq() - 1];
  const square = b * b - a * c;
  const root = Math.sqrt(Math.max(square, 0));
  const u = from.addScaledVector(along, (far ? root - b : -root - b) / a).normalize();
  return { u, far: far && square >= 0 };
}

/** A point of a unit sphere moved by an angle to the right and up on the screen. */
export function moved(u: Vector3, right: number, up: number, globe: Matrix4, camera: Camera): Vector3 {
  const into = globe.clone().invert();
  const way = new Vector3();
  [right, up].forEach((part, k) => {
    way.addScaledVector(
      linear(into, new Vector3().setFromMatrixColumn(camera.matrixWorld, k)).normalize(),
      part,
    );
  });
  way.projectOnPlane(u);
  const angle = Math.hypot(right, up);
  if (way.length() < 1e-9 * angle) return u.clone();
  return u
    .clone()
    .multiplyScalar(Math.cos(angle))
    .addScaledVector(way.normalize(), Math.sin(angle))
    .normalize();
}

/** Whether a point of the sphere is on the side away from the camera. */
export function isBehind(u: Vector3, globe: Matrix4, camera: Camera): boolean {
  const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld).applyMatrix4(globe.clone().invert());
  return u.dot(eye) < 1;
}

/** A direction under the linear part of a matrix. */
export function linear({ elements: m }: Matrix4, way: Vector3): Vector3 {
  const { x, y, z } = way;
  return new Vector3(
    m[0]! * x + m[4]! * y + m[8]! * z,
    m[1]! * x + m[5]! * y + m[9]! * z,
    m[2]! * x + m[6]! * y + m[10]! * z,
  );
}
