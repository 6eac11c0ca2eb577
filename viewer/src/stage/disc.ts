import {
  CircleGeometry,
  ConeGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Vector3,
} from "three";
import type { Shown } from "../document.ts";
import { quantity } from "../format/numbers.ts";
import type { Palette } from "../palette.ts";
import { Arrow } from "./arrow.ts";
import type { Figure } from "./figure.ts";
import type { Label, Labels } from "./labels.ts";
import type { Instant, Part } from "./part.ts";
import { Ribbon, type Screen } from "./ribbon.ts";
import { AXES } from "./rotor.ts";

/** The style of a bivector; `radius` is that of its disc at the start. */
export interface DiscStyle {
  bivector: "omega" | "momentum";
  symbol: string;
  unit: string;
  radius: number;
  /** The place of its label on the rim: right and up. */
  label: [number, number];
}

export const OMEGA: DiscStyle = {
  bivector: "omega",
  symbol: "Ω",
  unit: "rad/s",
  radius: 1.1,
  label: [1, -0.45],
};
export const MOMENTUM: DiscStyle = {
  bivector: "momentum",
  symbol: "L",
  unit: "kg m²/s",
  radius: 1.32,
  label: [-1, -0.45],
};

/** Corners of a circle: its error is at most half a pixel. */
const ROUND = 72;
const HEADS = 3;
/** Turns per second of the arrowheads on the rim. */
const PACE = 0.08;

/**
 * A bivector as an oriented disc in its plane. The area is proportional to the size; arrowheads run around the rim in
 * the sense of the bivector, of which the axial vector is the right-handed normal.
 */
export class Disc implements Part {
  readonly inSpace = new Group();
  private readonly disc = new Group();
  private readonly heads = new Group();
  private readonly fill: Mesh<CircleGeometry, MeshBasicMaterial>;
  private readonly rim: Ribbon;
  private readonly head = new ConeGeometry(0.03, 0.1, 12);
  private readonly solid = new MeshLambertMaterial({ emissiveIntensity: 0.45 });
  private readonly arrow: Arrow;
  private readonly label: Label;
  private reference = 1;
  private radius = 1;
  private valued = true;
  private arrowLength = (_: number): number => 0;

  constructor(
    screen: Screen,
    labels: Labels,
    private readonly style: DiscStyle,
    private readonly calm: () => boolean,
  ) {
    this.fill = new Mesh(
      new CircleGeometry(1, ROUND),
      new MeshBasicMaterial({
        transparent: true,
        opacity: 0.09,
        side: DoubleSide,
        depthWrite: false,
        forceSinglePass: true,
      }),
    );
    this.fill.renderOrder = 3;
    this.rim = new Ribbon(screen, { width: 2, behind: 0.18 });
    this.rim.set(circle(), { closed: true });
    for (let k = 0; k < HEADS; k++) this.heads.add(new Mesh(this.head, this.solid));
    this.arrow = new Arrow(screen, { width: 2.6, behind: 0.35 });
    this.disc.add(this.fill, this.rim.object, this.heads);
    this.inSpace.add(this.disc, this.arrow.object);
    this.label = labels.add(style.symbol, { rank: 1 });
  }

  follow(figure: Figure): void {
    this.reference = figure[this.style.bivector];
    // Inside the sphere with the path of the axis of a top.
    this.radius = (figure.about.held ? 0.7 : 1) * this.style.radius;
    // Moments without a mass are often ratios: then L has no unit.
    this.valued = this.style.bivector === "omega" || figure.about.body.mass !== null;
    // The arrow of ω ends on polhode and herpolhode, that of L outside its disc.
    this.arrowLength =
      this.style.bivector === "omega"
        ? (size) => size * figure.rate
        : (size) => (1.6 * size) / figure.momentum;
  }

  paint(palette: Palette): void {
    const color = palette[this.style.bivector];
    this.fill.material.color.set(color);
    this.rim.paint(color);
    this.solid.color.set(color);
    this.solid.emissive.set(color);
    this.arrow.paint(color);
    this.label.paint(color);
  }

  update(instant: Instant, shown: Shown): void {
    const axial = instant[this.style.bivector];
    const size = axial.length();
    const seen = shown[this.style.bivector] && size > 1e-9 * this.reference;
    this.disc.visible = seen;
    this.arrow.object.visible = shown.axial && size > 0;
    this.label.hide(!(seen || this.arrow.object.visible));
    if (this.arrow.object.visible)
      this.arrow.point(axial.clone().multiplyScalar(this.arrowLength(size) / size));
    if (this.label.hidden) return;
    this.label.say(this.valued ? quantity(size, this.style.unit) : "");
    const normal = axial.clone().divideScalar(size);
    const radius = Math.min(this.radius * Math.sqrt(size / this.reference), 3);
    this.disc.quaternion.setFromUnitVectors(AXES[2], normal);
    this.fill.scale.setScalar(radius);
    this.rim.object.scale.setScalar(radius);
    const turned = this.calm() ? 0 : 2 * Math.PI * PACE * instant.played;
    this.heads.children.forEach((head, k) => {
      const angle = turned + (2 * Math.PI * k) / HEADS;
      head.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
      head.rotation.z = angle;
    });
    this.placeLabel(instant, normal, radius, seen);
  }

  dispose(): void {
    this.fill.geometry.dispose();
    this.fill.material.dispose();
    this.rim.dispose();
    this.head.dispose();
    this.solid.dispose();
    this.arrow.dispose();
    this.label.dispose();
  }

  /** At the point of the rim in the direction of the label's side; without a disc, at the arrow. */
  private placeLabel({ right, up }: Instant, normal: Vector3, radius: number, disc: boolean): void {
    if (!disc) {
      this.label.side = null;
      this.label.at.copy(this.arrow.object.children[1]!.position);
      return;
    }
    const [across, high] = this.style.label;
    const towards = right.clone().multiplyScalar(across).addScaledVector(up, high).projectOnPlane(normal);
    this.label.side = { x: across, y: high };
    this.label.at.copy(towards.setLength(radius));
  }
}

/** Points of the unit circle about e3. */
export function circle(): Float64Array {
  const points = new Float64Array(3 * ROUND);
  for (let k = 0; k < ROUND; k++) {
    const angle = (2 * Math.PI * k) / ROUND;
    points.set([Math.cos(angle), Math.sin(angle), 0], 3 * k);
  }
  return points;
}
