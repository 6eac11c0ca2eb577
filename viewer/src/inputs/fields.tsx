import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { idOf, split } from "../glossary/glossary.ts";
import { shortlyTyped } from "../format/numbers.ts";
import type { Unit } from "../format/units.ts";
import { accepted, POSITIONS, positionOf, type Range, valueAt } from "./range.ts";

/** A number field. `shown` replaces whatever is entered that is not a number, or that `onNumber` does not accept. */
export function NumberField(props: {
  id: string;
  label: string;
  shown: string;
  width?: string;
  onFocus?: () => void;
  onNumber: (number: number) => void;
}) {
  const { id, label, shown, width, onFocus = () => {}, onNumber } = props;
  const entered = useSignal(0);
  // Read here so that the field is rendered after each entry, even if `shown` has not changed.
  void entered.value;
  return (
    <input
      id={id}
      class="digits"
      type="number"
      step="any"
      value={shown}
      style={width === undefined ? {} : { width }}
      aria-label={label}
      onFocus={onFocus}
      onChange={(event) => {
        const number = event.currentTarget.valueAsNumber;
        if (Number.isFinite(number)) onNumber(number);
        entered.value += 1;
      }}
    />
  );
}

/**
 * A slider with a number field in a unit. The field also accepts numbers beyond the range of the slider, unless that is
 * `closed`: the nearest end is then taken.
 */
export function Slider(props: {
  id: string;
  label: string;
  value: number;
  range: Range;
  unit: Unit;
  onChange: (value: number) => void;
}) {
  const { id, label, value, range, unit, onChange } = props;
  const shown = shortlyTyped(value / unit.size, 4);
  return (
    <div class="slider">
      <label for={id}>{label}</label>
      <input
        id={id}
        type="range"
        min={0}
        max={POSITIONS}
        step={1}
        value={positionOf(value, range)}
        aria-valuetext={`${shown} ${unit.label}`}
        onInput={(event) => onChange(valueAt(event.currentTarget.valueAsNumber, range, unit))}
      />
      <NumberField
        id={`${id}-number`}
        label={`${label}${unit.label && `, ${unit.label}`}`}
        shown={shown}
        onNumber={(number) => onChange(accepted(number * unit.size, range))}
      />
      <span class="unit">{unit.label}</span>
    </div>
  );
}

/** A list of choices; `other` is shown while none of them is chosen. */
export function Choices<T extends string | number>(props: {
  id: string;
  value: T | null;
  options: readonly (readonly [value: T, text: string])[];
  other?: string;
  disabled?: boolean;
  onChange: (value: T) => void;
}) {
  const { id, value, options, other, disabled = false, onChange } = props;
  const first = value === null ? 1 : 0;
  return (
    <select
      id={id}
      value={value ?? ""}
      disabled={disabled}
      onChange={(event) => onChange(options[event.currentTarget.selectedIndex - first]![0])}
    >
      {value === null && (
        <option value="" disabled>
          {other}
        </option>
      )}
      {options.map(([option, text]) => (
        <option value={option} key={option}>
          {text}
        </option>
      ))}
    </select>
  );
}

/** A labelled list of choices in a row, with further controls behind it. */
export function Select<T extends string | number>(props: {
  id: string;
  label: string;
  value: T;
  options: readonly (readonly [value: T, text: string])[];
  disabled?: boolean;
  onChange: (value: T) => void;
  children?: ComponentChildren;
}) {
  const { label, children, ...list } = props;
  return (
    <div class="row">
      <label for={list.id}>{label}</label>
      <Choices {...list} />
      {children}
    </div>
  );
}

/** A check box; the definition of the first term in its label is shown with it. */
export function Check(props: { id: string; label: string; checked: boolean; onChange: () => void }) {
  const { label, ...box } = props;
  const term = split(label).find((piece) => piece.term !== null)?.term ?? undefined;
  return (
    <label class="check" data-term={term}>
      <input type="checkbox" aria-describedby={term && idOf(term)} {...box} />
      {label}
    </label>
  );
}
