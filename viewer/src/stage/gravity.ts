import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from "three";
import { REACH } from "./figure.ts";
import { standOf } from "./floor.ts";
import type { Part, Setting } from "./part.ts";
import { AXES } from "./rotor.ts";
import { circle, Shapes } from "./shapes.ts";

const WEIGHT = new Vector3(0, 0, -0.75);
const PARALLELS = 5;

/** For a held body: the pivot, the weight, and the sphere of the locus. */
export function gravity({ figure, palette, screen, labels }: Setting): Part | null {
  const { about, centre } = figure;
  if (!about.held) return null;
  const arm = centre.length();
  const material = new MeshLambertMaterial({ color: palette.faint });
  const high = standOf(figure);
  const cone = new ConeGeometry(0.13, high, 48).rotateX(Math.PI / 2).translate(0, 0, -high / 2);
  const stem = new CylinderGeometry(0.014, 0.014, arm, 24).rotateX(Math.PI / 2).translate(0, 0, arm / 2);
  const inBody = new Mesh(stem, material);
  inBody.quaternion.setFromUnitVectors(AXES[2], centre.clone().normalize());
  const weight = new Shapes(screen, palette.weight);
  weight.arrow(WEIGHT, { width: 2.6, behind: 0.4 });
  const label = labels.add("mg", palette.weight, { rank: 4 });
  const sphere = new Shapes(screen, palette.faint);
  const thin = { width: 1, opacity: 0.4 };
  for (let k = 1; k <= PARALLELS; k++) {
    const angle = (Math.PI * k) / (PARALLELS + 1);
    const parallel = sphere.line(circle(AXES[2], REACH * Math.sin(angle)), thin, true);
    parallel.object.position.z = REACH * Math.cos(angle);
  }
  for (const axis of [AXES[0], AXES[1]]) sphere.line(circle(axis, REACH), thin, true);
  const inSpace = new Group().add(new Mesh(cone, material), weight.object, sphere.object);
  return {
    layer: "gravity",
    inSpace,
    inBody,
    update({ attitude }, shown) {
      inSpace.visible = shown.gravity;
      inBody.visible = shown.gravity && arm > 0;
      weight.object.visible = shown.gravity && about.heavy !== null && arm > 0;
      label.hidden = !weight.object.visible;
      weight.object.position.copy(centre).applyQuaternion(attitude);
      label.at.copy(weight.object.position).add(WEIGHT);
    },
  };
}
