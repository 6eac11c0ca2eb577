import { typed } from "./format.ts";
import { NumberField } from "./number.tsx";
import type { Unit } from "./units.ts";

/** Positions of a slider: fine enough that a pixel is a position. */
const POSITIONS = 1000;

/**
 * Where a slider may go, in SI. Logarithmic ones cover powers of ten; with `zero` their left end is 0.
 */
export interface Range {
  min: number;
  max: number;
  scale: "linear" | "log";
  zero?: boolean;
}

/** A range about a value: from a part of it to a multiple. */
export function around(value: number, times = 10): Range {
  return { min: value / times, max: value * times, scale: "log" };
}

/** A number that is set by a slider or by typing it, in its unit. The field takes numbers that the slider cannot reach. */
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
        value={position(value, range)}
        aria-valuetext={`${shown} ${unit.label}`}
        onInput={(event) => onChange(at(event.currentTarget.valueAsNumber, range, unit))}
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

function position(value: number, range: Range): number {
  const { min, max, scale, zero } = range;
  const first = zero ? 1 : 0;
  if (scale === "linear") return Math.round(((value - min) / (max - min)) * POSITIONS);
  if (value < min) return 0;
  return Math.round(first + (Math.log(value / min) / Math.log(max / min)) * (POSITIONS - first));
}

/** The value at a position, with four digits in its unit: a hand is not finer. */
function at(position: number, range: Range, unit: Unit): number {
  const { min, max, scale, zero } = range;
  if (scale === "linear") {
    const step = 10 ** (Math.floor(Math.log10((max - min) / unit.size)) - 3);
    const value = min + (position / POSITIONS) * (max - min);
    return clean(Math.round(value / unit.size / step) * step * unit.size);
  }
  const first = zero ? 1 : 0;
  if (position < first) return 0;
  const value = min * (max / min) ** ((position - first) / (POSITIONS - first));
  return clean(Number((value / unit.size).toPrecision(4)) * unit.size);
}

/** Without the last digits, which a product of short numbers may have. */
function clean(number: number): number {
  return Number(number.toPrecision(14));
}
