import { PLANES } from "../format/numbers.ts";
import { DEGREE, rateUnit, timeUnit } from "../format/units.ts";
import { around, type Range } from "../inputs/range.ts";
import { Select } from "../inputs/select.tsx";
import { Slider } from "../inputs/slider.tsx";
import type { Controls } from "../vary/controls.ts";
import type { Attitude, Spin } from "../vary/start.ts";

const CIRCLE: Range = { min: -Math.PI, max: Math.PI, scale: "linear" };
const HALF: Range = { min: 0, max: Math.PI, scale: "linear" };
/** From a thousandth of a degree, a small perturbation, to ninety degrees. */
const OFF: Range = { min: DEGREE.size / 1000, max: Math.PI / 2, scale: "log", zero: true };
const SENSES = ["", "−"].flatMap((sign, sense) =>
  PLANES.map((plane, k) => [k + 3 * sense, `${sign}${plane}, about ${sign}e${"₁₂₃"[k]}`] as const),
);

/** Controls of the initial state and of the duration. */
export function StartPanel({ controls }: { controls: Controls }) {
  const start = controls.start.value;
  const about = controls.about.value;
  if (!start || !about) return null;
  const { spin, rotor } = start;
  const usual = Math.hypot(...about.start.omega_body) || (2 * Math.PI) / about.duration;
  const attitude = start.attitude ?? controls.model.core.attitude(rotor);
  const spinAngle = (name: keyof Spin, label: string, range: Range) => (
    <Slider
      id={name}
      label={label}
      value={spin[name]}
      range={range}
      unit={DEGREE}
      onChange={(value) => controls.setStart({ ...start, spin: { ...spin, [name]: value } })}
    />
  );
  const attitudeAngle = (name: keyof Attitude, label: string, range: Range) => (
    <Slider
      id={name}
      label={label}
      value={attitude[name]}
      range={range}
      unit={DEGREE}
      onChange={(value) => controls.setStart({ ...start, attitude: { ...attitude, [name]: value } })}
    />
  );
  return (
    <>
      <Select
        id="plane"
        label="Spin plane"
        value={spin.plane}
        options={SENSES}
        onChange={(plane) => controls.setStart({ ...start, spin: { ...spin, plane } })}
      />
      <Slider
        id="rate"
        label="Rate"
        value={spin.rate}
        range={{ min: usual / 100, max: usual * 10, scale: "log", zero: true }}
        unit={rateUnit(usual)}
        onChange={(rate) => controls.setStart({ ...start, spin: { ...spin, rate } })}
      />
      {spinAngle("off", "Off-axis angle", OFF)}
      {spinAngle("toward", "Azimuth", CIRCLE)}
      {attitudeAngle("tilt", "Tilt of f₃ from e₃", HALF)}
      {attitudeAngle("turn", "Turn about e₃", CIRCLE)}
      {attitudeAngle("roll", "Roll about f₃", CIRCLE)}
      <Slider
        id="duration"
        label="Duration"
        value={controls.duration.value}
        range={around(about.duration, 100)}
        unit={timeUnit(about.duration)}
        onChange={(duration) => controls.setDuration(duration)}
      />
    </>
  );
}
