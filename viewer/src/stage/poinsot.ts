import {
  CircleGeometry,
  DoubleSide,
  FrontSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SphereGeometry,
} from "three";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import { circle } from "./disc.ts";
import type { Figure } from "./figure.ts";
import type { Instant, Part } from "./part.ts";
import { Ribbon, type Screen } from "./ribbon.ts";
import { AXES, quaternion } from "./rotor.ts";

const PLANE = 1.35;

/**
 * Poinsot's construction. The ellipsoid x·I(x) = 2T of the body touches the plane with normal L at the distance 2T/|L|,
 * at the point ω, and rolls on it without slipping. Under a torque, T and L change; the present ellipsoid and plane still
 * touch at ω. With a wheel, whose momentum is in L but not in the ellipsoid, they would not touch: nothing is drawn.
 */
export class Poinsot implements Part {
  readonly inBody = new Group();
  readonly inSpace = new Group();
  private readonly ellipsoid = new Group();
  private readonly skin: Mesh<SphereGeometry, MeshLambertMaterial>;
  private readonly circles: Ribbon[];
  private readonly sheet: Mesh<CircleGeometry, MeshBasicMaterial>;
  private readonly grid: Ribbon[];
  private readonly contact: Mesh<SphereGeometry, MeshBasicMaterial>;
  private figure: Figure | null = null;

  constructor(screen: Screen) {
    this.skin = new Mesh(
      new SphereGeometry(1, 48, 24).rotateX(Math.PI / 2),
      new MeshLambertMaterial({ transparent: true, opacity: 0.14, side: FrontSide, depthWrite: false }),
    );
    this.skin.renderOrder = 4;
    this.circles = AXES.map((axis) => {
      const ribbon = new Ribbon(screen, { width: 1, opacity: 0.5, behind: 0.4 });
      ribbon.set(circle(), { closed: true });
      ribbon.object.quaternion.setFromUnitVectors(AXES[2], axis);
      return ribbon;
    });
    this.ellipsoid.add(this.skin, ...this.circles.map(({ object }) => object));
    this.sheet = new Mesh(
      new CircleGeometry(PLANE, 72),
      new MeshBasicMaterial({
        transparent: true,
        opacity: 0.08,
        side: DoubleSide,
        depthWrite: false,
        forceSinglePass: true,
      }),
    );
    this.sheet.renderOrder = 5;
    this.grid = gridOf(screen);
    this.contact = new Mesh(new SphereGeometry(0.028, 16, 12), new MeshBasicMaterial());
    this.inBody.add(this.ellipsoid);
    this.inSpace.add(this.sheet, this.contact, ...this.grid.map(({ object }) => object));
  }

  follow(figure: Figure): void {
    const wheels = figure.about.laws.some(({ name }) => name === "gyrostat");
    this.figure = wheels ? null : figure;
    quaternion(figure.about.body.frame, 0, this.ellipsoid.quaternion);
  }

  paint(palette: Palette): void {
    this.skin.material.color.set(palette.polhode);
    for (const ribbon of this.circles) ribbon.paint(palette.polhode);
    this.sheet.material.color.set(palette.faint);
    for (const ribbon of this.grid) ribbon.paint(palette.faint);
    this.contact.material.color.set(palette.omega);
  }

  update({ omega, momentum, doubleKinetic }: Instant, shown: Shown): void {
    const { figure } = this;
    const seen = shown.poinsot && figure !== null && doubleKinetic > 0;
    this.inBody.visible = seen;
    this.inSpace.visible = seen;
    if (!seen) return;
    const axes = figure.about.body.moments.map((moment) => Math.sqrt(doubleKinetic / moment) * figure.rate);
    // The ellipsoid of a rod, without a moment about its line, is an infinite tube.
    const [a, b, c] = axes.map((axis) => Math.min(axis, 10)) as [number, number, number];
    this.ellipsoid.scale.set(a, b, c);
    const size = momentum.length();
    const normal = momentum.clone().divideScalar(size);
    const foot = normal.clone().multiplyScalar((doubleKinetic / size) * figure.rate);
    for (const object of [this.sheet, ...this.grid.map((ribbon) => ribbon.object)]) {
      object.position.copy(foot);
      object.quaternion.setFromUnitVectors(AXES[2], normal);
    }
    this.contact.position.copy(omega).multiplyScalar(figure.rate);
  }

  dispose(): void {
    for (const mesh of [this.skin, this.sheet, this.contact]) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    for (const ribbon of [...this.circles, ...this.grid]) ribbon.dispose();
  }
}

/** Circles and a cross on the plane. */
function gridOf(screen: Screen): Ribbon[] {
  const lines = [0.25, 0.5, 0.75, 1].map((radius) => {
    const ribbon = new Ribbon(screen, { width: 1, opacity: 0.45 });
    ribbon.set(
      circle().map((x) => x * radius * PLANE),
      { closed: true },
    );
    return ribbon;
  });
  for (let k = 0; k < 6; k++) {
    const [x, y] = [PLANE * Math.cos((Math.PI * k) / 6), PLANE * Math.sin((Math.PI * k) / 6)];
    const ribbon = new Ribbon(screen, { width: 1, opacity: 0.3 });
    ribbon.set([-x, -y, 0, x, y, 0]);
    lines.push(ribbon);
  }
  return lines;
}
