import type { Controls } from "../vary/controls.ts";
import { type Attitude, attitudeOf, type Spin } from "../vary/start.ts";
import { around, type Range, Slider } from "./slider.tsx";
import { DEGREE, rateUnit, timeUnit } from "./units.ts";

const PLANES = ["e₂∧e₃", "e₃∧e₁", "e₁∧e₂"];
const CIRCLE: Range = { min: -Math.PI, max: Math.PI, scale: "linear" };
const HALF: Range = { min: 0, max: Math.PI, scale: "linear" };
/** From a thousandth of a degree, for what a small push comes to, to ninety. */
const OFF: Range = { min: DEGREE.size / 1000, max: Math.PI / 2, scale: "log", zero: true };

/** How the motion starts and how long it is followed. */
export function StartPanel({ controls }: { controls: Controls }) {
  const start = controls.start.value;
  const about = controls.about.value;
  if (!start || !about) return null;
  return (
    <>
      <SpinControls
        spin={start.spin}
        usual={Math.hypot(...about.start.omega_body) || (2 * Math.PI) / about.duration}
        onChange={(spin) => controls.setStart({ ...start, spin })}
      />
      <AttitudeControls
        attitude={start.attitude ?? attitudeOf(start.rotor)}
        onChange={(attitude) => controls.setStart({ ...start, attitude })}
      />
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

function SpinControls(props: { spin: Spin; usual: number; onChange: (spin: Spin) => void }) {
  const { spin, usual, onChange } = props;
  return (
    <>
      <div class="row">
        <label for="plane">Spin in</label>
        <select
          id="plane"
          value={spin.plane}
          onChange={(event) => onChange({ ...spin, plane: Number(event.currentTarget.value) })}
        >
          {["", "−"].flatMap((sign, sense) =>
            PLANES.map((plane, k) => (
              <option value={k + 3 * sense} key={k + 3 * sense}>
                {`${sign}${plane}, about ${sign}e${"₁₂₃"[k]}`}
              </option>
            )),
          )}
        </select>
      </div>
      <Slider
        id="rate"
        label="Rate"
        value={spin.rate}
        range={{ min: usual / 100, max: usual * 10, scale: "log", zero: true }}
        unit={rateUnit(usual)}
        onChange={(rate) => onChange({ ...spin, rate })}
      />
      <Slider
        id="off"
        label="Off that axis by"
        value={spin.off}
        range={OFF}
        unit={DEGREE}
        onChange={(off) => onChange({ ...spin, off })}
      />
      <Slider
        id="toward"
        label="In the direction"
        value={spin.toward}
        range={CIRCLE}
        unit={DEGREE}
        onChange={(toward) => onChange({ ...spin, toward })}
      />
    </>
  );
}

/** The rotor of the start by three angles. */
function AttitudeControls(props: { attitude: Attitude; onChange: (attitude: Attitude) => void }) {
  const { attitude, onChange } = props;
  const angle = (name: keyof Attitude, label: string, range: Range) => (
    <Slider
      id={name}
      label={label}
      value={attitude[name]}
      range={range}
      unit={DEGREE}
      onChange={(value) => onChange({ ...attitude, [name]: value })}
    />
  );
  return (
    <>
      {angle("tilt", "Tilt of f₃ from e₃", HALF)}
      {angle("turn", "Turned about e₃", CIRCLE)}
      {angle("roll", "Rolled about f₃", CIRCLE)}
    </>
  );
}
