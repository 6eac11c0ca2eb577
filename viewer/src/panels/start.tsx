import { PLANES } from "../format/numbers.ts";
import { DEGREE, rateUnit, timeUnit } from "../format/units.ts";
import { Select, Slider } from "../inputs/fields.tsx";
import { around, type Range } from "../inputs/range.ts";
import type { Controls } from "../vary/controls.ts";
import type { Attitude, Spin } from "../vary/start.ts";

const CIRCLE: Range = { min: -Math.PI, max: Math.PI, scale: "linear" };
const HALF: Range = { min: 0, max: Math.PI, scale: "linear", closed: true };
/** From a thousandth of a degree, a small perturbation, to ninety degrees. */
const OFF: Range = { min: DEGREE.size / 1000, max: Math.PI / 2, scale: "log", zero: true, closed: true };
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
  const setSpin = (change: Partial<Spin>): void =>
    controls.setStart({ ...start, spin: { ...spin, ...change }, omega: null });
  const setAttitude = (change: Partial<Attitude>): void =>
    controls.setStart({ ...start, attitude: { ...attitude, ...change } });
  const angle = (id: string, label: string, value: number, range: Range, set: (value: number) => void) => (
    <Slider id={id} label={label} value={value} range={range} unit={DEGREE} onChange={set} />
  );
  return (
    <>
      <Select
        id="plane"
        label="Spin plane"
        value={spin.plane}
        options={SENSES}
        onChange={(plane) => setSpin({ plane })}
      />
      <Slider
        id="rate"
        label="Rate"
        value={spin.rate}
        range={{ min: usual / 100, max: usual * 10, scale: "log", zero: true }}
        unit={rateUnit(usual)}
        onChange={(rate) => setSpin({ rate })}
      />
      {angle("off", "Off-axis angle", spin.off, OFF, (off) => setSpin({ off }))}
      {angle("toward", "Azimuth", spin.toward, CIRCLE, (toward) => setSpin({ toward }))}
      {angle("tilt", "Tilt of f₃ from e₃", attitude.tilt, HALF, (tilt) => setAttitude({ tilt }))}
      {angle("turn", "Turn about e₃", attitude.turn, CIRCLE, (turn) => setAttitude({ turn }))}
      {angle("roll", "Roll about f₃", attitude.roll, CIRCLE, (roll) => setAttitude({ roll }))}
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
