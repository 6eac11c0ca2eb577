import { Group, Vector3 } from "three";
import { quantity } from "../format/numbers.ts";
import { hasMass } from "../core/core.ts";
import { ofLayer } from "./emphasis.ts";
import type { Instant, Part, Setting } from "./part.ts";
import { AXES } from "./rotor.ts";
import { aim, circle, Shapes } from "./shapes.ts";

/** The style of a bivector; `radius` is that of its disc at the start. */
interface DiscStyle {
  bivector: "omega" | "momentum" | "torque";
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

/** Its radius is that of the largest torque. */
export const TORQUE: DiscStyle = {
  bivector: "torque",
  symbol: "T",
  unit: "N m",
  radius: 0.85,
  label: [0.5, 1],
};

const HEADS = 3;
/** Turns per second of the arrowheads on the rim. */
const PACE = 0.08;

/**
 * A bivector as an oriented disc in its plane. The area is proportional to the size; arrowheads run around the rim in
 * the sense of the bivector, of which the axial vector is the right-handed normal.
 */
export function disc({ figure, palette, screen, labels, calm }: Setting, style: DiscStyle): Part {
  const { bivector } = style;
  const reference = figure[bivector];
  // Inside the sphere with the path of the axis of a top.
  const standard = (figure.about.held ? 0.7 : 1) * style.radius;
  const valued = bivector === "omega" || hasMass(figure.about);
  // The arrow of ω ends on polhode and herpolhode, that of L outside its disc.
  const stretch = bivector === "omega" ? figure.rate : (bivector === "torque" ? 1.2 : 1.6) / reference;

  const sheet = new Shapes(screen, palette[bivector]);
  sheet.face(circle(AXES[2], 1), 0.09, 3);
  sheet.line(circle(AXES[2], 1), { width: 2, behind: 0.18 }, true);
  const running = new Shapes(screen, palette[bivector]);
  const heads = Array.from({ length: HEADS }, () => running.head(AXES[0], AXES[1]));
  const disc = new Group().add(sheet.object, running.object);
  const axis = new Shapes(screen, palette[bivector]);
  const arrow = axis.arrow(AXES[2], { width: 2.6, behind: 0.35 });
  const label = labels.add(style.symbol, palette[bivector], { rank: 1 });

  /** At the point of the rim in the direction of the label's side; without a disc, at the arrow. */
  const placeLabel = ({ right, up }: Instant, axial: Vector3, radius: number, arrowEnd: Vector3): void => {
    const [across, high] = style.label;
    label.side = disc.visible ? { x: across, y: high } : null;
    if (!disc.visible) return void label.at.copy(arrowEnd);
    label.at.copy(right).multiplyScalar(across).addScaledVector(up, high);
    label.at.projectOnPlane(axial).setLength(radius);
  };
  return {
    layer: bivector,
    inSpace: new Group().add(disc, ofLayer("axial", axis.object)),
    update(instant, shown) {
      const axial = instant[bivector];
      const size = axial.length();
      disc.visible = shown[bivector] && size > 1e-9 * reference;
      // Of what is shown as a disc; without discs, arrows stand for both.
      const arrows = shown[bivector] || (bivector !== "torque" && !(shown.omega || shown.momentum));
      axis.object.visible = shown.axial && arrows && size > 0;
      label.hidden = !(disc.visible || axis.object.visible);
      if (label.hidden) return;
      const end = axial.clone().multiplyScalar(stretch);
      arrow.point(end);
      label.value = valued ? quantity(size, style.unit) : "";
      const radius = Math.min(standard * Math.sqrt(size / reference), 3);
      disc.quaternion.setFromUnitVectors(AXES[2], axial.clone().divideScalar(size));
      sheet.object.scale.setScalar(radius);
      const turned = calm.matches ? 0 : 2 * Math.PI * PACE * instant.played;
      heads.forEach((head, k) => {
        const along = AXES[1].clone().applyAxisAngle(AXES[2], turned + (2 * Math.PI * k) / HEADS);
        aim(head, new Vector3(along.y, -along.x, 0).multiplyScalar(radius), along);
      });
      placeLabel(instant, axial, radius, end);
    },
  };
}
