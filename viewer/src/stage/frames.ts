import { Color, Group } from "three";
import { REACH } from "./figure.ts";
import type { Part, Setting } from "./part.ts";
import { AXES } from "./rotor.ts";
import { Shapes } from "./shapes.ts";

/** Three axes with their labels: f1, f2, f3 of the body, or e1, e2, e3 of space, thinner, dashed and paler. */
export function frame({ palette, screen, labels }: Setting, of: "body" | "space"): Part {
  const body = of === "body";
  const length = body ? REACH : 1.55;
  const arrows = new Group();
  const named = AXES.map((axis, k) => {
    const colour = palette.axes[k as 0 | 1 | 2];
    const shapes = new Shapes(screen, new Color(colour).lerp(new Color(palette.background), body ? 0 : 0.3));
    shapes.arrow(axis.clone().multiplyScalar(length), body ? { width: 2.6 } : { width: 1.4, dash: 0.05 });
    arrows.add(shapes.object);
    // Labels that are at rest have their places first; the others move out of their way.
    return { axis, label: labels.add(body ? "f" : "e", colour, { index: k + 1, rank: body ? 3 : 2 }) };
  });
  return {
    ...(body ? { inBody: arrows } : { inSpace: arrows }),
    update({ attitude }, shown) {
      arrows.visible = body ? shown.bodyFrame : shown.spaceFrame;
      for (const { axis, label } of named) {
        label.hidden = !arrows.visible;
        label.at.copy(axis).multiplyScalar(length);
        if (body) label.at.applyQuaternion(attitude);
      }
    },
  };
}
