import { Color, Group } from "three";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import { Arrow } from "./arrow.ts";
import { REACH } from "./figure.ts";
import type { Label, Labels } from "./labels.ts";
import type { Instant, Part } from "./part.ts";
import type { Screen } from "./ribbon.ts";
import { AXES } from "./rotor.ts";

/** Three axes with their labels: f1, f2, f3 of the body or e1, e2, e3 of space. */
abstract class Frame implements Part {
  protected readonly group = new Group();
  protected readonly arrows: Arrow[];
  protected readonly labels: Label[];

  constructor(
    screen: Screen,
    labels: Labels,
    letter: string,
    private readonly length: number,
    style: { width: number; dash?: number; behind?: number },
  ) {
    this.labels = AXES.map((_, k) => labels.add(letter, { index: k + 1, rank: letter === "f" ? 2 : 3 }));
    this.arrows = AXES.map((axis) => {
      const arrow = new Arrow(screen, style);
      arrow.point(axis.clone().multiplyScalar(length));
      this.group.add(arrow.object);
      return arrow;
    });
  }

  follow(): void {}

  paint(palette: Palette): void {
    palette.axes.forEach((color, k) => {
      this.arrows[k]!.paint(this.tone(color, palette));
      this.labels[k]!.paint(color);
    });
  }

  abstract update(instant: Instant, shown: Shown): void;

  dispose(): void {
    for (const arrow of this.arrows) arrow.dispose();
    for (const label of this.labels) label.dispose();
  }

  protected abstract tone(color: string, palette: Palette): Color;

  protected label(k: number, shown: boolean): void {
    this.labels[k]!.hide(!shown);
    this.labels[k]!.at.copy(AXES[k as 0 | 1 | 2]).multiplyScalar(this.length);
  }
}

/** The body frame. */
export class BodyFrame extends Frame {
  readonly inBody = this.group;

  constructor(screen: Screen, labels: Labels) {
    super(screen, labels, "f", REACH, { width: 2.6 });
  }

  update(instant: Instant, shown: Shown): void {
    this.group.visible = shown.bodyFrame;
    for (let k = 0; k < 3; k++) {
      this.label(k, shown.bodyFrame);
      this.labels[k]!.at.applyQuaternion(instant.attitude);
    }
  }

  protected tone(color: string): Color {
    return new Color(color);
  }
}

/** The space frame: thinner, dashed and paler. */
export class SpaceFrame extends Frame {
  readonly inSpace = this.group;

  constructor(screen: Screen, labels: Labels) {
    super(screen, labels, "e", 1.55, { width: 1.4, dash: 0.05 });
  }

  update(_: Instant, shown: Shown): void {
    this.group.visible = shown.spaceFrame;
    for (let k = 0; k < 3; k++) this.label(k, shown.spaceFrame);
  }

  protected tone(color: string, palette: Palette): Color {
    return new Color(color).lerp(new Color(palette.background), 0.3);
  }
}
