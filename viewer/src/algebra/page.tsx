import { type ReadonlySignal, useComputed, useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { IconButton } from "../inputs/button.tsx";
import { Choices } from "../inputs/fields.tsx";
import { type Model, words } from "../model/model.ts";
import { type Palette, readable } from "../palette.ts";
import styles from "./algebra.css?inline";
import { colours, Drawing } from "./drawing.ts";
import { GivenValues } from "./given.tsx";
import { outline, withVector } from "./literal.ts";
import { ALGEBRA_PRESETS } from "./presets.ts";
import { Rows } from "./rows.tsx";
import { type Drawable, drawableOfGiven, drawablesOf } from "./drawables.ts";

/** The algebra page: lines of formulas, their values, and a drawing. The text is its only state. */
export function AlgebraPage(props: {
  model: Model;
  palette: ReadonlySignal<Palette>;
  /** The text of a lesson, in place of the list of figures. */
  lesson: ComponentChildren;
}) {
  const { model, palette, lesson } = props;
  useEffect(() => {
    if (model.lines.peek() === "" && model.values.peek().length === 0)
      model.lines.value = ALGEBRA_PRESETS[0]!.lines;
  }, [model]);
  const lines = useComputed(() => model.core.evaluated(model.lines.value));
  const items = useComputed(() => {
    const written = drawablesOf(lines.value, model.core);
    const given = model.values.value.map((value, k) => drawableOfGiven(value, written.length + k));
    return [...written, ...given];
  });
  const tones = useComputed(() => colours(palette.value).map((tone) => readable(tone, palette.value)));
  const change = useMemo(
    () => (line: number, text: (old: string) => string) => {
      const all = model.lines.peek().split("\n");
      if (all[line] === undefined) return;
      all[line] = text(all[line]);
      model.lines.value = all.join("\n");
    },
    [model],
  );
  return (
    <main class="algebra">
      <style>{styles}</style>
      {!lesson && <Presets model={model} />}
      <Picture
        items={items}
        palette={palette}
        move={(line, to) => change(line, (old) => withVector(old, to))}
      />
      <div class={lesson ? "column whole" : "column"}>
        {lesson}
        <GivenValues values={model.values} items={items} tones={tones} />
        <Rows text={model.lines} lines={lines} items={items} tones={tones} change={change} />
      </div>
    </main>
  );
}

/** The list of presets, and the description of the current one. Handles and sliders change only literals. */
function Presets({ model }: { model: Model }) {
  const chosen = useComputed(() => {
    const written = outline(model.lines.value);
    return ALGEBRA_PRESETS.find(({ lines }) => outline(lines) === written) ?? null;
  });
  const preset = chosen.value;
  return (
    <section class="choice" aria-label="Figure">
      <label for="figure" class="hidden">
        Figure
      </label>
      <Choices
        id="figure"
        value={preset?.id ?? null}
        options={ALGEBRA_PRESETS.map(({ id, title }) => [id, title])}
        other="Your lines"
        onChange={(id) => (model.lines.value = ALGEBRA_PRESETS.find((next) => next.id === id)!.lines)}
      />
      <p class="about" aria-live="polite">
        {preset?.about ?? "Define a name or a function, V(x) = ½ x·x, or check whether an equation holds."}
      </p>
    </section>
  );
}

function Picture(props: {
  items: ReadonlySignal<readonly Drawable[]>;
  palette: ReadonlySignal<Palette>;
  move: (line: number, to: [number, number, number]) => void;
}) {
  const { items, palette, move } = props;
  const place = useRef<HTMLDivElement>(null);
  const drawing = useRef<Drawing | null>(null);
  const missing = useSignal<string | null>(null);
  useEffect(() => {
    try {
      drawing.current = new Drawing(place.current!, items, palette, move);
    } catch (error) {
      missing.value = words(error);
    }
    return () => drawing.current?.dispose();
  }, [items, palette]);
  return (
    <section class="drawing" aria-label="Drawing">
      <div class="drawn" ref={place} />
      {missing.value !== null ? (
        <p class="missing">{missing.value}</p>
      ) : (
        <IconButton
          id="home"
          class="quiet home"
          label="Fit everything into view"
          icon="fit"
          onClick={() => drawing.current?.home()}
        />
      )}
    </section>
  );
}
