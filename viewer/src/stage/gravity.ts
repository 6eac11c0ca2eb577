import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from "three";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import { Arrow } from "./arrow.ts";
import { circle } from "./disc.ts";
import { type Figure, REACH } from "./figure.ts";
import type { Label, Labels } from "./labels.ts";
import type { Instant, Part } from "./part.ts";
import { Ribbon, type Screen } from "./ribbon.ts";
import { AXES } from "./rotor.ts";

/** Height of the stand under the pivot. */
export const STAND = 0.42;
const WEIGHT = 0.75;
const CIRCLES = 5;

/** For a held body: the pivot, the weight, and the sphere of the locus. */
export class Gravity implements Part {
  readonly inSpace = new Group();
  readonly inBody = new Group();
  private readonly stand: Mesh<ConeGeometry, MeshLambertMaterial>;
  private readonly stem: Mesh<CylinderGeometry, MeshLambertMaterial>;
  private readonly weight: Arrow;
  private readonly sphere: Ribbon[];
  private readonly label: Label;
  private figure: Figure | null = null;

  constructor(screen: Screen, labels: Labels) {
    const material = new MeshLambertMaterial();
    this.stand = new Mesh(
      new ConeGeometry(0.13, STAND, 48).rotateX(Math.PI / 2).translate(0, 0, -STAND / 2),
      material,
    );
    this.stem = new Mesh(
      new CylinderGeometry(0.014, 0.014, 1, 24).rotateX(Math.PI / 2).translate(0, 0, 0.5),
      material,
    );
    this.weight = new Arrow(screen, { width: 2.6, behind: 0.4 });
    this.weight.point(new Vector3(0, 0, -WEIGHT));
    this.sphere = sphereOf(screen);
    this.label = labels.add("mg", { rank: 4 });
    this.inSpace.add(this.stand, this.weight.object, ...this.sphere.map(({ object }) => object));
    this.inBody.add(this.stem);
  }

  follow(figure: Figure): void {
    this.figure = figure.about.held ? figure : null;
    const arm = figure.centre.length();
    this.stem.visible = arm > 0;
    if (arm === 0) return;
    this.stem.scale.set(1, 1, arm);
    this.stem.quaternion.setFromUnitVectors(AXES[2], figure.centre.clone().divideScalar(arm));
  }

  paint(palette: Palette): void {
    this.stand.material.color.set(palette.faint);
    this.weight.paint(palette.weight);
    this.label.paint(palette.weight);
    for (const ribbon of this.sphere) ribbon.paint(palette.faint);
  }

  update({ attitude }: Instant, shown: Shown): void {
    const { figure } = this;
    const seen = shown.gravity && figure !== null;
    this.inSpace.visible = seen;
    this.inBody.visible = seen;
    const heavy = seen && figure.about.heavy !== null && figure.centre.length() > 0;
    this.weight.object.visible = heavy;
    this.label.hide(!heavy);
    if (!heavy) return;
    this.weight.object.position.copy(figure.centre).applyQuaternion(attitude);
    this.label.at.copy(this.weight.object.position).addScaledVector(AXES[2], -WEIGHT);
  }

  dispose(): void {
    this.stand.geometry.dispose();
    this.stand.material.dispose();
    this.stem.geometry.dispose();
    this.weight.dispose();
    for (const ribbon of this.sphere) ribbon.dispose();
    this.label.dispose();
  }
}

/** Parallels and two meridians. */
function sphereOf(screen: Screen): Ribbon[] {
  const circles: Ribbon[] = [];
  for (let k = 1; k <= CIRCLES; k++) {
    const angle = (Math.PI * k) / (CIRCLES + 1);
    const ribbon = faint(screen);
    ribbon.object.position.z = REACH * Math.cos(angle);
    ribbon.object.scale.setScalar(REACH * Math.sin(angle));
    circles.push(ribbon);
  }
  for (const axis of [AXES[0], AXES[1]]) {
    const ribbon = faint(screen);
    ribbon.object.quaternion.setFromUnitVectors(AXES[2], axis);
    ribbon.object.scale.setScalar(REACH);
    circles.push(ribbon);
  }
  return circles;
}

function faint(screen: Screen): Ribbon {
  const ribbon = new Ribbon(screen, { width: 1, opacity: 0.4 });
  ribbon.set(circle(), { closed: true });
  return ribbon;
}
