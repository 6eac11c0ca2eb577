import { typed } from "../format/numbers.ts";
import type { Unit } from "../format/units.ts";
import { NumberField } from "./number.tsx";
import { POSITIONS, positionOf, type Range, valueAt } from "./range.ts";

/** A slider with a number field in a unit. The field also accepts numbers beyond the range of the slider. */
export function Slider(props: {
  id: string;
  label: string;
  value: number;
  range: Range;
  unit: Unit;
  onChange: (value: number) => void;
}) {
  const { id, label, value, range, unit, onChange } = props;
  const shown = typed(value / unit.size, 4);
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
        onNumber={(number) => onChange(number * unit.size)}
      />
      <span class="unit">{unit.label}</span>
    </div>
  );
}
