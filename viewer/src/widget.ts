/**
 * The notebook widget, for anywidget: synchronises the traits of `python/polhode/_viewer/widget.py` with the signals of
 * the page.
 */
import { effect } from "@preact/signals";
import { State } from "./core/core.ts";
import type { PageDocument, ViewState } from "./document.ts";
import type { PolhodeViewer } from "./element.tsx";
import type { Model } from "./model/model.ts";

/** Python's traits, from anywidget. */
interface Traits {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  on(event: string, heard: () => void): void;
  off(event: string, heard: () => void): void;
  save_changes(): void;
}

const VIEW = ["time", "playing", "speed", "camera", "theme", "shown"] as const;
const HEARD = ["document", "scene", ...VIEW] as const;

/** Interval in ms at which changes are sent to Python: while a motion plays, each frame changes. */
const PAUSE = 100;

/** Shows the widget in an element of the notebook; returns the function that removes it. */
export function render({ model: traits, el }: { model: Traits; el: HTMLElement }): () => void {
  const viewer = document.createElement("polhode-viewer") as PolhodeViewer;
  viewer.style.cssText = "display: block; height: min(40rem, 85vh)";
  viewer.document = present(traits);
  // anywidget loads the script from an address that it then withdraws.
  viewer.script = () => traits.get("_esm") as string | undefined;
  let leave = () => {};
  let away = false;
  const entered = () => {
    // The viewer starts again, with the current traits.
    if (away) viewer.document = present(traits);
    away = false;
    const { ready } = viewer;
    void ready.then((model) => {
      if (viewer.ready !== ready || !viewer.isConnected) return;
      leave();
      leave = connected(viewer, model, traits);
    });
  };
  const left = () => {
    leave();
    leave = () => {};
    // An element that is connected again by then was only moved.
    queueMicrotask(() => {
      away = !viewer.isConnected;
    });
  };
  viewer.addEventListener("connected", entered);
  viewer.addEventListener("disconnected", left);
  el.append(viewer);
  return () => {
    viewer.removeEventListener("connected", entered);
    viewer.remove();
  };
}

/** The document of the current traits. */
function present(traits: Traits): PageDocument {
  const given = traits.get("document") as PageDocument;
  const scene = traits.get("scene") as string | null;
  // A notebook has many widgets: none plays by default.
  const view = { playing: false, ...known(traits, VIEW) };
  if (scene === null || scene === given.scene) return { ...given, view };
  const { recorded: _, ...others } = given;
  return { ...others, scene, view };
}

/** The traits of the view that were set; the page chooses the others. */
function known(traits: Traits, names: readonly string[]): Partial<ViewState> {
  const chosen = names.filter((name) => (VIEW as readonly string[]).includes(name));
  return Object.fromEntries(
    chosen.map((name) => [name, traits.get(name)]).filter(([, value]) => value !== null),
  );
}

/** Synchronises traits and signals; returns the function that stops it. */
function connected(viewer: { document: PageDocument | null }, model: Model, traits: Traits): () => void {
  let sending = false;
  let timer: ReturnType<typeof setTimeout> | undefined;

  const sendSoon = () => {
    timer ??= setTimeout(send, PAUSE);
  };
  const send = () => {
    clearTimeout(timer);
    timer = undefined;
    // Python may just have set the scene that is being solved: the old one must not replace it.
    if (model.solving.peek()) return;
    sending = true;
    for (const [name, value] of Object.entries(reported(model))) traits.set(name, value);
    sending = false;
    traits.save_changes();
  };

  let played = false;
  const stop = effect(() => {
    reported(model); // subscribes to its signals
    void model.solving.value;
    const stopped = played && !model.playing.value;
    played = model.playing.value;
    if (stopped) send();
    else sendSoon();
  });

  // Python sends changes one by one; they are applied together.
  const changed = new Set<string>();
  const take = () => {
    const names = [...changed];
    changed.clear();
    if (names.includes("document")) {
      viewer.document = present(traits);
      return;
    }
    const scene = names.includes("scene") ? (traits.get("scene") as string | null) : null;
    if (scene !== null && scene !== model.scene.value) void model.replace(scene).then(() => look(names));
    else look(names);
  };
  const look = (names: readonly string[]) => {
    model.look(known(traits, names));
    sendSoon(); // values that were not accepted
  };
  const heard = HEARD.map((name) => {
    const hear = () => {
      if (sending) return;
      if (changed.size === 0) queueMicrotask(take);
      changed.add(name);
    };
    traits.on(`change:${name}`, hear);
    return () => traits.off(`change:${name}`, hear);
  });

  return () => {
    stop();
    clearTimeout(timer);
    changed.clear();
    for (const deafen of heard) deafen();
  };
}

/** The values that are sent to Python. */
function reported(model: Model): Record<string, unknown> {
  return {
    scene: model.scene.value,
    problem: model.problem.value,
    time: model.time.value,
    playing: model.playing.value,
    speed: model.speed.value,
    camera: model.camera.value,
    theme: model.theme.value,
    shown: model.shown.value,
    state: state(model.row.value),
  };
}

/** The state shown. By its time Python knows whether it is that of the time that was set. */
function state(row: Float64Array | null): Record<string, number | number[]> | null {
  if (!row) return null;
  const part = (first: number, count: number) => Array.from(row.subarray(first, first + count));
  return {
    time: row[State.time]!,
    rotor: part(State.rotor, 4),
    omega_body: part(State.omegaBody, 3),
    position: part(State.position, 3),
    velocity: part(State.velocity, 3),
  };
}
