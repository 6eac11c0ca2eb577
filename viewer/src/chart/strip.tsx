import { type ReadonlySignal, type Signal, useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { About } from "../core/core.ts";
import { namedAxes } from "../stage/axes.ts";
import { significant } from "../format/numbers.ts";
import { duration } from "../format/units.ts";
import { Icon } from "../inputs/button.tsx";
import { type Model, span } from "../model/model.ts";
import { advance } from "../stage/steps.ts";
import { curve, HEIGHT, heightOf } from "./curves.ts";
import { marksOf } from "./marks.ts";
import { alongAxes, type Envelope, sampled } from "./samples.ts";

/** The host has room for the chart from this size on, in px; else it is folded at first. */
const ROOM = { width: 560, height: 640 };
/** Columns of the chart at most, and the time in ms for them in a frame. */
const COLUMNS = 900;
const FRAME = 6;

/** ω in the body over the duration that the time slider covers. `first` is the time at its left end. */
export function Strip(props: { model: Model; about: About; first: ReadonlySignal<number> }) {
  const { model, about, first } = props;
  const open = useSignal<boolean | null>(null);
  const hovered = useSignal<number | null>(null);
  const place = useRef<HTMLElement>(null);
  useEffect(() => {
    const { host } = place.current!.getRootNode() as ShadowRoot;
    open.value ??= host.clientWidth >= ROOM.width && host.clientHeight >= ROOM.height;
  }, []);
  return (
    <figure class={open.value ? "strip" : "strip folded"} ref={place} aria-label="Chart of ω in the body">
      <div class="names">
        <button
          id="strip-toggle"
          class="quiet"
          aria-expanded={open.value === true}
          aria-label={open.value ? "Chart of ω in the body" : undefined}
          title={open.value ? "Fold the chart" : "Chart of ω in the body"}
          onClick={() => (open.value = !open.value)}
        >
          <Icon name={open.value ? "down" : "right"} />
          <i class="symbol">ω</i>
          {!open.value && " over time"}
        </button>
        {open.value && <Names model={model} about={about} hovered={hovered} />}
      </div>
      {open.value && <Plot {...{ model, about, first, hovered }} />}
    </figure>
  );
}

/** The names of the axes in the colours of their curves, with the values at the time shown, or where the pointer is. */
function Names(props: { model: Model; about: About; hovered: ReadonlySignal<number | null> }) {
  const { model, about, hovered } = props;
  const at = hovered.value;
  const row = at === null ? model.row.value : (model.motion.value?.states([at]) ?? null);
  if (!row) return null;
  const axes = namedAxes(about.body);
  const values = alongAxes(row, axes);
  const order = ["smallest", "middle", "largest"];
  const inOrder = [0, 1, 2].sort((a, b) => order.indexOf(axes.names[a]!) - order.indexOf(axes.names[b]!));
  return (
    <ul aria-hidden="true" data-time={at ?? model.time.value}>
      {inOrder.map((k) => (
        <li key={k} class={`axis-${k + 1}`}>
          <span class="name">{axes.names[k]}</span> <span class="digits">{significant(values[k]!, 3)}</span>
        </li>
      ))}
      <li class="unit">rad/s</li>
      {at !== null && <li class="when digits">t = {duration(at, 4)}</li>}
    </ul>
  );
}

interface PlotProps {
  model: Model;
  about: About;
  first: ReadonlySignal<number>;
  hovered: Signal<number | null>;
}

/** The curves, on which the pointer sets the time. Keys do so on the time slider, which gets the focus. */
function Plot({ model, about, first, hovered }: PlotProps) {
  const place = useRef<HTMLDivElement>(null);
  const envelope = useEnvelope(model, first, place);
  const timeAt = (event: PointerEvent): number => {
    const { left, width } = place.current!.getBoundingClientRect();
    const share = Math.min(Math.max((event.clientX - left) / width, 0), 1);
    const [least, most] = span(about);
    return Math.min(Math.max(first.value + share * about.duration, least), most);
  };
  return (
    <div
      class="plot"
      ref={place}
      data-complete={envelope.value?.complete ?? false}
      onPointerDown={(event) => {
        if (event.button !== 0) return;
        event.preventDefault();
        place.current!.setPointerCapture(event.pointerId);
        const root = place.current!.getRootNode() as ShadowRoot;
        root.querySelector<HTMLElement>("#time")?.focus({ preventScroll: true });
        model.seek(timeAt(event));
      }}
      onPointerMove={(event) => {
        if (event.buttons & 1) model.seek(timeAt(event));
        hovered.value = event.pointerType === "touch" && !event.buttons ? null : timeAt(event);
      }}
      onPointerLeave={() => (hovered.value = null)}
      onPointerUp={(event) => event.pointerType === "touch" && (hovered.value = null)}
    >
      {envelope.value && <Curves envelope={envelope.value} about={about} from={first.value} />}
      <Head time={model.time} {...{ about, first }} kind="playhead" />
      <Head time={hovered} {...{ about, first }} kind="pointer" />
    </div>
  );
}

/** The samples of the present motion, which are computed between frames. */
function useEnvelope(model: Model, first: ReadonlySignal<number>, place: { current: HTMLElement | null }) {
  const envelope = useSignal<Envelope | null>(null);
  const motion = model.motion.value;
  const from = first.value;
  useEffect(() => {
    if (!motion) return;
    const columns = Math.min(Math.max(Math.round(place.current?.clientWidth ?? 0), 100), COLUMNS);
    const work = sampled(motion, { from, length: motion.about.duration, columns }, (found) => {
      envelope.value = found;
    });
    let frame = 0;
    const go = (): void => {
      // A motion that was replaced is closed at once.
      if (model.motion.peek() !== motion) return;
      frame = advance(work, FRAME) ? 0 : requestAnimationFrame(go);
    };
    frame = requestAnimationFrame(go);
    return () => cancelAnimationFrame(frame);
  }, [motion, from]);
  return envelope;
}

/** The curves with their marks, stretched to the width. */
function Curves({ envelope, about, from }: { envelope: Envelope; about: About; from: number }) {
  const columns = envelope.least[0]!.length;
  const zero = heightOf(0, envelope.range);
  const marks = marksOf(about, envelope, from, about.duration);
  const flips = marks.filter(({ name }) => name === "flip").length;
  const [least, most] = envelope.range.map((value) => significant(value, 3));
  const summary =
    `ω along the three principal axes from ${duration(from)} to ${duration(from + about.duration)}, ` +
    `between ${least} and ${most} rad/s${flips > 0 ? `, with ${flips} flips` : ""}`;
  const share = (time: number) => `${(100 * (time - from)) / about.duration}%`;
  return (
    <>
      <svg viewBox={`0 0 ${columns} ${HEIGHT}`} preserveAspectRatio="none" role="img" aria-label={summary}>
        <line class="zero" x1="0" x2={columns} y1={zero} y2={zero} />
        {[0, 1, 2].map((axis) => (
          <path
            key={axis}
            class={`axis-${axis + 1}${envelope.bands ? " band" : ""}`}
            d={curve(envelope, axis)}
          />
        ))}
      </svg>
      {marks.map(({ time, name }) => (
        <span
          key={`${name} ${time}`}
          class={name === "flip" ? "happening flip" : "happening"}
          style={{ left: share(time) }}
          title={`${name}, t = ${duration(time)}`}
          aria-hidden="true"
        />
      ))}
    </>
  );
}

/** A line at a time. */
function Head(props: {
  time: ReadonlySignal<number | null>;
  about: About;
  first: ReadonlySignal<number>;
  kind: string;
}) {
  const { time, about, first, kind } = props;
  const share = useComputed(() => {
    const at = time.value === null ? Number.NaN : (time.value - first.value) / about.duration;
    return at >= 0 && at <= 1 ? `${100 * at}%` : null;
  });
  return share.value === null ? null : <span class={kind} style={{ left: share.value }} aria-hidden="true" />;
}
