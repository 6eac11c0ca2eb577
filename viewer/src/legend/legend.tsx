import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Shown } from "../document.ts";
import { idOf } from "../glossary/glossary.ts";
import { Icon } from "../inputs/button.tsx";
import type { Covered, Model } from "../model/model.ts";
import { firstRow } from "../model/speed.ts";
import { hasEnergyView } from "../stage/energy.ts";
import { actingOn, largestTorque } from "../stage/figure.ts";
import { entriesOf } from "./entries.ts";

/** The picture has room for the whole legend from this size on, in px; else it is folded at first. */
const ROOM = { width: 430, height: 330 };

/**
 * The names of what the picture shows. Pointing at one emphasizes the thing, pressing it hides the thing; it stays in the
 * list to show it again.
 */
export function Legend({ model }: { model: Model }) {
  const place = useRef<HTMLDivElement>(null);
  const open = useSignal<boolean | null>(null);
  const hidden = useSignal<ReadonlySet<keyof Shown>>(new Set());
  const point = (layer: keyof Shown | null): void => {
    if (layer !== null) model.pointed.value = { layer };
    else if (model.pointed.peek()?.layer !== undefined) model.pointed.value = null;
  };
  useEffect(() => {
    const width = place.current!.parentElement!.clientWidth;
    open.value ??= width >= ROOM.width && place.current!.closest(".seen")!.clientHeight >= ROOM.height;
    const leave = cover(place.current!, (covered) => (model.covered.value = covered));
    return () => {
      leave();
      point(null);
    };
  }, []);
  const entries = useComputed(() => {
    const motion = model.motion.value;
    if (!motion) return [];
    const acting = actingOn(motion, firstRow(motion));
    return entriesOf(motion.about, { acting, torque: acting ? largestTorque(motion) : 0 });
  });
  const shown = model.shown.value;
  const about = model.about.value;
  const present = entries.value.filter(
    ({ layer }) => (shown[layer] && (layer !== "energy" || hasEnergyView(about))) || hidden.value.has(layer),
  );
  const press = (layer: keyof Shown): void => {
    const set = new Set(hidden.value);
    if (shown[layer]) set.add(layer);
    else set.delete(layer);
    hidden.value = set;
    model.toggle(layer);
  };
  return (
    <div class="key" role="group" aria-label="Legend" ref={place}>
      <button
        id="legend-toggle"
        class="entry"
        aria-expanded={open.value === true}
        aria-label="Legend"
        onClick={() => (open.value = !open.value)}
      >
        <Icon name={open.value ? "down" : "right"} />
        {!open.value && "Legend"}
      </button>
      {open.value &&
        present.map(({ layer, name, look, colour, term }) => (
          <button
            key={layer}
            class="entry"
            data-layer={layer}
            data-term={term}
            aria-describedby={term && idOf(term)}
            aria-pressed={shown[layer]}
            onPointerEnter={() => point(layer)}
            onPointerLeave={() => point(null)}
            onFocus={(event) => event.currentTarget.matches(":focus-visible") && point(layer)}
            onBlur={() => point(null)}
            onClick={() => press(layer)}
          >
            <span class={`look ${look}`} style={{ "--colour": `var(--${colour})` }} aria-hidden="true" />
            {name}
          </button>
        ))}
    </div>
  );
}

/** Reports the size of the legend, up to the lower left corner of the picture, whenever it changes; null at the end. */
function cover(legend: HTMLElement, report: (covered: Covered | null) => void): () => void {
  const picture = legend.closest(".seen")!;
  const observer = new ResizeObserver(() => {
    const [own, whole] = [legend.getBoundingClientRect(), picture.getBoundingClientRect()];
    report({ width: own.right - whole.left, height: whole.bottom - own.top });
  });
  observer.observe(legend);
  return () => {
    observer.disconnect();
    report(null);
  };
}
