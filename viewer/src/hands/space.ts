import { computed, effect, type ReadonlySignal } from "@preact/signals";
import type { Palette } from "../palette.ts";
import type { Figure } from "../stage/figure.ts";
import type { Part, Setting } from "../stage/part.ts";
import type { Sight, SpaceTools } from "../stage/tools.ts";
import { Aim } from "./aim.ts";
import { ghostPart } from "./ghostPart.ts";
import { layerOf } from "./grip.ts";
import type { Hands } from "./hands.ts";
import { Push } from "./push.ts";

/** The tools over the picture in space, and the ghost in it. */
export class SpaceHands implements SpaceTools {
  readonly changed: ReadonlySignal<unknown>;
  private readonly aim: Aim;
  private readonly push: Push;

  constructor(
    private readonly hands: Hands,
    palette: () => Palette,
  ) {
    this.aim = new Aim(hands, palette);
    this.push = new Push(hands, palette);
    this.changed = computed(() => [
      hands.tool.value,
      hands.ghost.motion.value,
      this.push.arrow.value,
      ...this.aim.changed,
    ]);
  }

  attach(host: HTMLElement): () => void {
    const layer = layerOf(host, "Handles in the picture");
    layer.addEventListener("keydown", (event) => {
      const tool = this.hands.tool.peek();
      if (event.key !== "Escape" || event.defaultPrevented || tool === "none") return;
      event.preventDefault();
      this.hands.choose(tool);
      (layer.getRootNode() as ParentNode).querySelector<HTMLElement>(`#${tool}`)?.focus();
    });
    const leave = [
      this.aim.attach(layer),
      this.push.attach(host, layer),
      effect(() => {
        host.dataset["tool"] = this.hands.tool.value;
        this.push.arrow.value = null;
      }),
    ];
    return () => {
      for (const one of leave) one();
      layer.remove();
    };
  }

  parts(setting: Setting): Part[] {
    return [
      ghostPart(setting, () => this.hands.ghost.motion.peek()),
      this.aim.part(setting),
      this.push.part(setting),
    ];
  }

  place(sight: Sight | null, figure: Figure | null): void {
    this.aim.place(sight);
    this.push.place(sight, figure);
  }
}
