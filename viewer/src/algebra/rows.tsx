import type { ReadonlySignal, Signal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { Line } from "../core/core.ts";
import { scalarLiteral, withScalar } from "./literal.ts";
import { numberText } from "./notation.ts";
import { Kind, Result } from "./result.tsx";
import type { Drawable } from "./drawables.ts";
import { highlighted } from "./highlight.tsx";

/** Positions of the slider of a number. */
const STEPS = 200;

type Change = (line: number, text: (old: string) => string) => void;

interface Props {
  text: Signal<string>;
  lines: ReadonlySignal<readonly Line[]>;
  items: ReadonlySignal<readonly Drawable[]>;
  tones: ReadonlySignal<readonly string[]>;
  change: Change;
}

/** The lines with their values. Enter, Backspace, Delete, arrow keys and pasting work across lines. */
export function Rows({ text, lines, items, tones, change }: Props) {
  const list = useRef<HTMLOListElement>(null);
  /** The row and column of the caret after the next render. */
  const caret = useRef<[number, number] | null>(null);
  useLayoutEffect(() => {
    if (!caret.current) return;
    const [row, column] = caret.current;
    caret.current = null;
    focusAt(list.current, row, column);
  });
  const named = new Map(items.value.map((item) => [item.label, item]));
  const colourOf = (name: string) => {
    const item = named.get(name);
    return item ? tones.value[item.colour] : undefined;
  };
  /** Replaces rows by a text, and puts the caret at an offset in it. */
  const replace = (first: number, count: number, written: string, at: number): void => {
    const all = text.peek().split("\n");
    all.splice(first, count, ...written.split("\n"));
    const before = written.slice(0, at).split("\n");
    caret.current = [first + before.length - 1, before[before.length - 1]!.length];
    text.value = all.join("\n");
  };
  const onKey = (event: KeyboardEvent, row: number): void => {
    const area = event.currentTarget as HTMLTextAreaElement;
    const { selectionStart: start, selectionEnd: end, value } = area;
    const all = text.peek().split("\n");
    const plain = !event.shiftKey && !event.ctrlKey && !event.metaKey && !event.altKey;
    const wrapped = area.clientHeight > 2.5 * parseFloat(getComputedStyle(area).lineHeight);
    if (event.key === "Backspace" && start === 0 && end === 0 && row > 0) {
      replace(row - 1, 2, all[row - 1]! + value, all[row - 1]!.length);
    } else if (event.key === "Delete" && start === value.length && end === start && row < all.length - 1) {
      replace(row, 2, value + all[row + 1]!, start);
    } else if (event.key === "ArrowUp" && plain && row > 0 && (!wrapped || start === 0)) {
      focusAt(list.current, row - 1, start);
    } else if (event.key === "ArrowDown" && plain && row < all.length - 1) {
      if (wrapped && start < value.length) return;
      focusAt(list.current, row + 1, start);
    } else {
      return;
    }
    event.preventDefault();
  };
  return (
    <section class="rows" aria-label="Lines">
      <ol ref={list}>
        {lines.value.map((line, row) => {
          const item = items.value.find((one) => one.line === row);
          const tone = item && tones.value[item.colour];
          const scalar =
            line.value?.grades.join() === "0" && line.name !== null ? scalarLiteral(line.text) : null;
          return (
            <li
              key={row}
              class={line.problem ? "line wrong" : "line"}
              data-line={row + 1}
              data-components={line.value?.components.join(" ")}
              data-holds={line.equation ? String(line.equation.holds) : undefined}
              data-problem={line.problem?.message}
            >
              <div class="code">
                <pre aria-hidden="true">{highlighted(line, colourOf)}</pre>
                <textarea
                  rows={1}
                  spellcheck={false}
                  autocomplete="off"
                  autocapitalize="off"
                  aria-label={`Line ${row + 1}`}
                  aria-invalid={line.problem !== null}
                  aria-describedby={`came-${row}`}
                  value={line.text}
                  onInput={(event) => {
                    const { value, selectionStart } = event.currentTarget;
                    replace(row, 1, value, selectionStart);
                  }}
                  onKeyDown={(event) => onKey(event, row)}
                />
              </div>
              <Kind line={line} tone={tone} />
              {scalar && (
                <ScalarSlider
                  name={line.name!}
                  number={scalar.number}
                  unit={scalar.unit.trim()}
                  onChange={(number) => change(row, (old) => withScalar(old, number))}
                />
              )}
              <Result id={`came-${row}`} line={line} literal={scalar !== null || (item?.movable ?? false)} />
            </li>
          );
        })}
      </ol>
      <button class="quiet more" onClick={() => replace(text.peek().split("\n").length, 0, "", 0)}>
        + Line
      </button>
    </section>
  );
}

function focusAt(list: HTMLOListElement | null, row: number, column: number): void {
  const area = list?.children[row]?.querySelector("textarea");
  area?.focus();
  area?.setSelectionRange(column, column);
}

/** A slider for the number of a line such as `θ = 60 deg`. */
function ScalarSlider(props: {
  name: string;
  number: number;
  unit: string;
  onChange: (number: number) => void;
}) {
  const { name, number, unit, onChange } = props;
  const kept = useRef(rangeOf(number, unit));
  // The range is kept while it contains the number, so that the slider does not move during a drag.
  const { min, max } = kept.current;
  if (kept.current.unit !== unit || number < min || number > max) kept.current = rangeOf(number, unit);
  const { unit: _, ...range } = kept.current;
  return (
    <input
      class="scalar"
      type="range"
      {...range}
      value={number}
      aria-label={unit ? `${name}, ${unit}` : name}
      aria-valuetext={`${numberText(number)} ${unit}`}
      onInput={(event) => onChange(event.currentTarget.valueAsNumber)}
    />
  );
}

/** A full turn for angles; otherwise from 0 to a round number, or symmetric about 0 for negative numbers. */
function rangeOf(number: number, unit: string): { min: number; max: number; step: number; unit: string } {
  const angle = unit === "deg" || unit === "°";
  if (angle && Math.abs(number) <= 180) return { min: -180, max: 180, step: 1, unit };
  const size = 1.5 * Math.abs(number) || 1;
  const power = 10 ** Math.floor(Math.log10(size));
  const max = power * [1, 2, 5, 10].find((first) => first * power >= size * 0.999)!;
  const min = number < 0 ? -max : 0;
  return { min, max, step: (max - min) / STEPS, unit };
}
