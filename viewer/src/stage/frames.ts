import { Color, Group } from "three";
import { namedAxes } from "./axes.ts";
import { REACH } from "./figure.ts";
import type { Part, Setting } from "./part.ts";
import { AXES, quaternion } from "./rotor.ts";
import { Shapes } from "./shapes.ts";

/**
 * Three axes with their labels: f1, f2, f3 of the body with the names of their moments, or e1, e2, e3 of space, thinner,
 * dashed and paler.
 */
export function frame({ figure, palette, screen, labels }: Setting, of: "body" | "space"): Part {
  const body = of === "body";
  const { names, own } = namedAxes(figure.about.body);
  const length = body ? REACH : 1.55;
  const arrows = new Group();
  const named = AXES.map((axis, k) => {
    const colour = palette.axes[k as 0 | 1 | 2];
    const shapes = new Shapes(screen, new Color(colour).lerp(new Color(palette.background), body ? 0 : 0.3));
    shapes.arrow(axis.clone().multiplyScalar(length), body ? { width: 2.6 } : { width: 1.4, dash: 0.05 });
    arrows.add(shapes.object);
    // Labels that are at rest have their places first; the others move out of their way.
    const label = labels.add(body ? "f" : "e", colour, { index: k + 1, rank: body ? 3 : 2 });
    if (body && own) label.value = names[k]!;
    return { axis, label };
  });
  return {
    layer: body ? "bodyFrame" : "spaceFrame",
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

/** The principal axes of a body whose own axes lie elsewhere: thin lines with the names of their moments. */
export function principal({ figure, palette, screen, labels }: Setting): Part | null {
  const { names, own, frame } = namedAxes(figure.about.body);
  if (own) return null;
  const turn = quaternion(frame);
  const lines = new Group();
  const named = AXES.map((axis, k) => {
    const to = axis
      .clone()
      .applyQuaternion(turn)
      .multiplyScalar(0.95 * REACH);
    const shapes = new Shapes(screen, palette.text);
    shapes.line([to.clone().negate(), to], { width: 1.2, opacity: 0.7, behind: 0.3, dash: 0.03 });
    lines.add(shapes.object);
    return { to, label: labels.add(names[k]!, palette.text, { rank: 3 }) };
  });
  return {
    layer: "bodyFrame",
    inBody: lines,
    update({ attitude }, shown) {
      lines.visible = shown.bodyFrame;
      for (const { to, label } of named) {
        label.hidden = !lines.visible;
        label.at.copy(to).applyQuaternion(attitude);
      }
    },
  };
}
