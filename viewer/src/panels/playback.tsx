import { useRef } from "preact/hooks";
import type { About } from "../core/core.ts";
import { type Model, span } from "../model/model.ts";
import { typed } from "./format.ts";
import { Icon } from "./icons.tsx";
import { faster, step } from "./keys.ts";
import { trust } from "./facts.tsx";
import { NumberField } from "./number.tsx";
import { duration, timeUnit } from "./units.ts";

/** Play, step, speed and time. */
export function Playback({ model }: { model: Model }) {
  const about = model.about.value;
  if (!about) return null;
  const playing = model.playing.value;
  return (
    <section class="playback" aria-label="Playback">
      <div class="line">
        <button
          id="play"
          class="primary"
          aria-label={playing ? "Pause" : "Play"}
          title={`${playing ? "Pause" : "Play"} (Space)`}
          onClick={() => (model.playing.value = !playing)}
        >
          <Icon name={playing ? "pause" : "play"} />
        </button>
        <div class="buttons">
          <button
            id="restart"
            aria-label="To the start"
            title="To the start (Home)"
            onClick={() => model.toStart()}
          >
            <Icon name="restart" />
          </button>
          <button id="step-back" aria-label="Step back" title="Step back (←)" onClick={() => step(model, -1)}>
            <Icon name="back" />
          </button>
          <button id="step" aria-label="Step forward" title="Step forward (→)" onClick={() => step(model, 1)}>
            <Icon name="forward" />
          </button>
        </div>
        <TimeSlider model={model} about={about} />
        <TimeField model={model} about={about} />
        <Trust about={about} />
        <Speed model={model} />
      </div>
    </section>
  );
}

/**
 * A slider over one duration. A motion that is known beyond it turns the page: the slider then covers the next
 * duration, or any other that has the time.
 */
function TimeSlider({ model, about }: { model: Model; about: About }) {
  const start = about.start.time;
  const first = useRef(start);
  const time = model.time.value;
  const length = about.duration;
  if (time < first.current || time > first.current + length)
    first.current = start + Math.floor((time - start) / length) * length;
  return (
    <input
      id="time"
      class="time"
      type="range"
      aria-label="Time"
      aria-valuetext={duration(time)}
      min={first.current}
      max={first.current + length}
      step="any"
      value={time}
      onInput={(event) => model.seek(event.currentTarget.valueAsNumber)}
    />
  );
}

function TimeField({ model, about }: { model: Model; about: About }) {
  const unit = timeUnit(about.duration);
  // Some thousand different times in a duration, each a decimal number.
  const decimals = Math.min(Math.max(0, 4 - Math.ceil(Math.log10(about.duration / unit.size / 1.6))), 20);
  const shown = typed(Number((model.time.value / unit.size).toFixed(decimals)), 15);
  // Room for all times of a duration, so that nothing moves while time passes.
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

/** Whether what is seen is exact. */
function Trust({ about }: { about: About }) {
  return (
    <span class={about.exact ? "badge exact" : "badge"} title={trust(about)} id="method">
      {about.exact ? "exact" : about.method === "recorded" ? "recorded" : "in steps"}
    </span>
  );
}

function Speed({ model }: { model: Model }) {
  const speed = model.speed.value;
  const shown = speed < 200 ? `${typed(speed, 3)}×` : `${duration(speed, 3, timeUnit(2 * speed))}/s`;
  return (
    <div class="field speed" role="group" aria-label="Speed">
      <button id="slower" aria-label="Slower" title="Slower ([)" onClick={() => faster(model, -1)}>
        <Icon name="minus" />
      </button>
      <output id="speed" title="Motion per second of the clock">
        {shown}
      </output>
      <button id="faster" aria-label="Faster" title="Faster (])" onClick={() => faster(model, 1)}>
        <Icon name="plus" />
      </button>
    </div>
  );
}
