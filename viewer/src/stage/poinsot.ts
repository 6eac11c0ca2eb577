import {
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { AZIMUTH } from "./camera.ts";
import type { Part, Setting } from "./part.ts";
import { AXES, quaternion } from "./rotor.ts";
import { circle, Shapes } from "./shapes.ts";

/** Radius of the drawn part of the plane. */
const PLANE = 1.35;

/**
 * Poinsot's construction. The ellipsoid x·I(x) = 2T of the body touches the plane with normal L at the distance 2T/|L|,
 * at the point ω, and rolls on it without slipping. Under a torque, T and L change; the present ellipsoid and plane still
 * touch at ω. With a wheel, whose momentum is in L but not in the ellipsoid, they would not touch: nothing is drawn.
 */
export function poinsot({ figure, palette, screen }: Setting): Part | null {
  const { body, laws } = figure.about;
  if (laws.some(({ name }) => name === "gyrostat")) return null;
  const skin = new Mesh(
    new SphereGeometry(1, 48, 24).rotateX(Math.PI / 2),
    new MeshLambertMaterial({ color: palette.polhode, transparent: true, opacity: 0.14, depthWrite: false }),
  );
  skin.renderOrder = 4;
  const circles = new Shapes(screen, palette.polhode);
  for (const axis of AXES) circles.line(circle(axis, 1), { width: 1, opacity: 0.5, behind: 0.4 }, true);
  const ellipsoid = new Group().add(skin, circles.object);
  quaternion(body.frame, 0, ellipsoid.quaternion);

  const plane = new Shapes(screen, palette.faint);
  plane.face(circle(AXES[2], PLANE), 0.08, 5);
  for (const part of [0.25, 0.5, 0.75, 1]) {
    plane.line(circle(AXES[2], part * PLANE), { width: 1, opacity: 0.45 }, true);
  }
  for (let k = 0; k < 6; k++) {
    const to = new Vector3(PLANE, 0, 0).applyAxisAngle(AXES[2], (Math.PI * k) / 6);
    plane.line([to.clone().negate(), to], { width: 1, opacity: 0.3 });
  }
  const contact = new Mesh(
    new SphereGeometry(0.028, 16, 12),
    new MeshBasicMaterial({ color: palette.omega }),
  );
  const inBody = new Group().add(ellipsoid);
  const inSpace = new Group().add(plane.object, contact);
  return {
    layer: "poinsot",
    inBody,
    inSpace,
    update({ omega, momentum, doubleKinetic }, shown) {
      inBody.visible = inSpace.visible = shown.poinsot && doubleKinetic > 0;
      if (!inBody.visible) return;
      const axes = body.moments.map((moment) => Math.sqrt(doubleKinetic / moment) * figure.rate);
      // The ellipsoid of a rod, without a moment about its line, is an infinite tube.
      ellipsoid.scale.fromArray(axes.map((axis) => Math.min(axis, 10)));
      const size = momentum.length();
      const normal = momentum.clone().divideScalar(size);
      plane.object.position.copy(normal).multiplyScalar((doubleKinetic / size) * figure.rate);
      plane.object.quaternion.setFromUnitVectors(AXES[2], normal);
      contact.position.copy(omega).multiplyScalar(figure.rate);
    },
  };
}

/** The turn of space that makes the invariable plane horizontal, with the point of contact on the side of the eye. */
export function level(omega: Vector3, momentum: Vector3): Quaternion {
  const upright = new Quaternion().setFromUnitVectors(momentum.clone().normalize(), AXES[2]);
  const contact = omega.clone().applyQuaternion(upright);
  const turn = AZIMUTH - Math.atan2(contact.y, contact.x);
  return upright.premultiply(new Quaternion().setFromAxisAngle(AXES[2], turn));
}
