import { useRef } from "preact/hooks";
import { numberText } from "./notation.ts";

/** Positions of a slider. */
const STEPS = 200;

interface Range {
  min: number;
  max: number;
  step: number;
}

/** A slider for the number of a line such as `θ = 60 deg`. */
export function ScalarSlider(props: {
  name: string;
  number: number;
  unit: string;
  onChange: (number: number) => void;
}) {
  const { name, number, unit, onChange } = props;
  const kept = useRef<(Range & { unit: string }) | null>(null);
  // The range is kept while it contains the number, so that the slider does not move during a drag.
  const { current } = kept;
  if (!current || current.unit !== unit || number < current.min || number > current.max) {
    kept.current = { ...rangeOf(number, unit), unit };
  }
  const { min, max, step } = kept.current!;
  return (
    <input
      class="scalar"
      type="range"
      min={min}
      max={max}
      step={step}
      value={number}
      aria-label={unit ? `${name}, ${unit}` : name}
      aria-valuetext={`${numberText(number)} ${unit}`}
      onInput={(event) => onChange(event.currentTarget.valueAsNumber)}
    />
  );
}

/** A full turn for angles; otherwise from 0 to a round number, or symmetric about 0 for negative numbers. */
function rangeOf(number: number, unit: string): Range {
  if ((unit === "deg" || unit === "°") && Math.abs(number) <= 180) return { min: -180, max: 180, step: 1 };
  const size = 1.5 * Math.abs(number) || 1;
  const power = 10 ** Math.floor(Math.log10(size));
  const max = power * [1, 2, 5, 10].find((first) => first * power >= size * 0.999)!;
  const min = number < 0 ? -max : 0;
  return { min, max, step: (max - min) / STEPS };
}
