import { type ReadonlySignal, useComputed } from "@preact/signals";
import { useRef } from "preact/hooks";
import { Strip } from "../chart/strip.tsx";
import type { About } from "../core/core.ts";
import { typed } from "../format/numbers.ts";
import { duration, timeUnit } from "../format/units.ts";
import { IconButton, type IconName } from "../inputs/button.tsx";
import { NumberField } from "../inputs/fields.tsx";
import { type Model, span } from "../model/model.ts";
import { methodOf } from "./facts.tsx";
import { changeSpeed, setSpeed, step } from "./keys.ts";

const STEPS: [id: string, label: string, press: string, icon: IconName, act: (model: Model) => void][] = [
  ["restart", "To the start", "Home", "restart", (model) => model.toStart()],
  ["step-back", "Step back", "←", "back", (model) => step(model, -1)],
  ["step", "Step forward", "→", "forward", (model) => step(model, 1)],
];

/** Play, step, speed and time. */
export function Playback({ model, chart }: { model: Model; chart: boolean }) {
  const first = useFirst(model);
  const about = model.about.value;
  if (!about) return null;
  const playing = model.playing.value;
  return (
    <section class="playback" aria-label="Playback">
      <div class="line">
        <IconButton
          id="play"
          class="primary"
          label={playing ? "Pause" : "Play"}
          press="Space"
          icon={playing ? "pause" : "play"}
          onClick={() => (model.playing.value = !playing)}
        />
        <div class="buttons">
          {STEPS.map(([id, label, press, icon, act]) => (
            <IconButton key={id} id={id} label={label} press={press} icon={icon} onClick={() => act(model)} />
          ))}
        </div>
        <TimeSlider model={model} about={about} first={first} />
        <TimeField model={model} about={about} />
        <span class={about.exact ? "badge exact" : "badge"} title={methodOf(about)} id="method">
          {about.exact ? "exact" : about.method === "recorded" ? "recorded" : "stepped"}
        </span>
        <Speed model={model} />
      </div>
      {chart && <Strip model={model} about={about} first={first} />}
    </section>
  );
}

/** The first time on the slider and the chart. Beyond the end of a motion that is known there, they cover the next duration. */
function useFirst(model: Model): ReadonlySignal<number> {
  const first = useRef<number | null>(null);
  return useComputed(() => {
    const about = model.about.value;
    const [time, start, length] = [model.time.value, about?.start.time ?? 0, about?.duration ?? 1];
    first.current ??= start;
    if (time < first.current || time > first.current + length)
      first.current = start + Math.floor((time - start) / length) * length;
    return first.current;
  });
}

/** A slider over one duration. */
function TimeSlider(props: { model: Model; about: About; first: ReadonlySignal<number> }) {
  const { model, about } = props;
  const time = model.time.value;
  const first = props.first.value;
  return (
    <input
      id="time"
      class="time"
      type="range"
      aria-label="Time"
      aria-valuetext={duration(time)}
      min={first}
      max={first + about.duration}
      step="any"
      value={time}
      onInput={(event) => model.seek(event.currentTarget.valueAsNumber)}
    />
  );
}

function TimeField({ model, about }: { model: Model; about: About }) {
  const unit = timeUnit(about.duration);
  // Enough decimals for several thousand different times in a duration.
  const decimals = Math.min(Math.max(0, 4 - Math.ceil(Math.log10(about.duration / unit.size / 1.6))), 20);
  const shown = typed(Number((model.time.value / unit.size).toFixed(decimals)), 15);
  // Wide enough for all times of a duration, so that nothing moves during playback.
  const width = Math.max(4, (about.duration / unit.size).toFixed(decimals).length, shown.length);
  const [first, last] = span(about);
  const known = last < Number.MAX_VALUE ? `Known from ${duration(first)} to ${duration(last)}` : undefined;
  return (
    <div class="field number" title={known}>
      <label for="time-number">
        <i>t</i> =
      </label>
      <NumberField
        id="time-number"
        label={`Time, ${unit.label}`}
        shown={shown}
        width={`${Math.min(width, 12) + 1}ch`}
        onFocus={() => (model.playing.value = false)}
        onNumber={(number) => model.seek(number * unit.size)}
      />
      <span class="unit">{unit.label}</span>
    </div>
  );
}

/** The speed, as a multiple of real time or as a time per second. */
function Speed({ model }: { model: Model }) {
  const speed = model.speed.value;
  const unit = Math.abs(speed) < 200 ? null : timeUnit(2 * speed);
  const label = unit ? `${unit.label}/s` : "×";
  const shown = typed(speed / (unit?.size ?? 1), 3);
  return (
    <div class="field speed" role="group" aria-label="Speed">
      <IconButton id="slower" label="Slower" press="[" icon="minus" onClick={() => changeSpeed(model, -1)} />
      <NumberField
        id="speed"
        label={`Speed, ${unit ? label : "seconds of motion per second"}`}
        shown={shown}
        width={`${Math.max(3, shown.length) + 0.5}ch`}
        onNumber={(number) => setSpeed(model, number * (unit?.size ?? 1))}
      />
      <span class="unit">{label}</span>
      <IconButton id="faster" label="Faster" press="]" icon="plus" onClick={() => changeSpeed(model, 1)} />
    </div>
  );
}
