import type { ReadonlySignal } from "@preact/signals";
import type { GivenValue } from "../document.ts";
import type { Drawable } from "./drawables.ts";

interface Props {
  values: ReadonlySignal<readonly GivenValue[]>;
  items: ReadonlySignal<readonly Drawable[]>;
  tones: ReadonlySignal<readonly string[]>;
}

/** The list of the values that Python gave. */
export function GivenValues({ values, items, tones }: Props) {
  if (values.value.length === 0) return null;
  const toneOf = (name: string) => {
    const item = items.value.find(({ line, label }) => line === null && label === name);
    return item && tones.value[item.colour];
  };
  return (
    <section class="given" aria-label="Values">
      <ul>
        {values.value.map(({ name, kind, text }) => (
          <li key={name} data-value={name}>
            <b style={{ color: toneOf(name) }}>{name}</b>
            <span class="kind">{kind}</span>
            <p class="came">{text}</p>
          </li>
        ))}
      </ul>
    </section>
  );
}
