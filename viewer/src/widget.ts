/**
 * The viewer in a notebook, as anywidget wants it. The traits of `python/polhode/_viewer/widget.py` and the signals of the
 * page follow each other.
 */
import { effect } from "@preact/signals";
import { State } from "./core/core.ts";
import type { PageDocument, ViewState } from "./document.ts";
import type { Model } from "./model/model.ts";

/** The side of Python, as anywidget gives it. */
export interface Traits {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  on(event: string, heard: () => void): void;
  off(event: string, heard: () => void): void;
  save_changes(): void;
}

interface Viewer extends HTMLElement {
  document: PageDocument | null;
  readonly ready: Promise<Model>;
}

const VIEW = ["time", "playing", "speed", "camera", "theme", "shown"] as const;
const HEARD = ["document", "scene", ...VIEW] as const;

/** Python is told of changes this often, in ms: a motion that plays changes with each frame. */
const PAUSE = 100;

/** Tells when it comes into a page and when it leaves: notebooks take out what is scrolled away, and put it back. */
class Anchor extends HTMLElement {
  entered = () => {};
  left = () => {};

  connectedCallback(): void {
    this.entered();
  }

  disconnectedCallback(): void {
    this.left();
  }
}

/** Shows the widget in a place of the notebook, until what it returns is called. */
export function render({ model: traits, el }: { model: Traits; el: HTMLElement }): () => void {
  if (!customElements.get("polhode-anchor")) customElements.define("polhode-anchor", Anchor);
  const viewer = document.createElement("polhode-viewer") as Viewer;
  viewer.style.cssText = "display: block; height: min(40rem, 85vh)";
  viewer.document = present(traits);
  const anchor = document.createElement("polhode-anchor") as Anchor;
  let leave = () => {};
  const disconnect = () => {
    leave();
    leave = () => {};
  };
  let away = false;
  anchor.entered = () => {
    // The viewer begins anew, with what Python says by now.
    if (away) viewer.document = present(traits);
    away = false;
    const { ready } = viewer;
    void ready.then((model) => {
      if (viewer.ready !== ready || !viewer.isConnected) return;
      disconnect();
      leave = connected(viewer, model, traits);
    });
  };
  anchor.left = () => {
    disconnect();
    // What is back by then was only moved, and goes on.
    queueMicrotask(() => {
      away = !viewer.isConnected;
    });
  };
  el.append(viewer, anchor);
  return () => {
    anchor.entered = anchor.left = () => {};
    disconnect();
    viewer.remove();
    anchor.remove();
  };
}

/** The document that shows what the traits say. */
export function present(traits: Traits): PageDocument {
  const given = traits.get("document") as PageDocument;
  const scene = traits.get("scene") as string | null;
  // A notebook has many of them: none plays before it is asked to.
  const view = { playing: false, ...known(traits, VIEW) };
  if (scene === null || scene === given.scene) return { ...given, view };
  const { recorded: _, ...others } = given;
  return { ...others, scene, view };
}

/** What the traits say of the view; what nobody has chosen is for the page to choose. */
function known(traits: Traits, names: readonly string[]): Partial<ViewState> {
  const chosen = names.filter((name) => (VIEW as readonly string[]).includes(name));
  return Object.fromEntries(
    chosen.map((name) => [name, traits.get(name)]).filter(([, value]) => value !== null),
  );
}

/** Lets traits and signals follow each other, until what it returns is called. */
export function connected(
  viewer: { document: PageDocument | null },
  model: Model,
  traits: Traits,
): () => void {
  let telling = false;
  let timer: ReturnType<typeof setTimeout> | undefined;

  const tellSoon = () => {
    timer ??= setTimeout(tell, PAUSE);
  };
  const tell = () => {
    clearTimeout(timer);
    timer = undefined;
    telling = true;
    for (const [name, value] of Object.entries(told(model))) traits.set(name, value);
    telling = false;
    traits.save_changes();
  };

  let played = false;
  const stop = effect(() => {
    told(model); // so that any change of it is heard
    const stopped = played && !model.playing.value;
    played = model.playing.value;
    if (stopped) tell();
    else tellSoon();
  });

  // What Python changes together is heard one by one, and taken over together.
  const changed = new Set<string>();
  const take = () => {
    const names = [...changed];
    changed.clear();
    if (names.includes("document")) {
      viewer.document = present(traits);
      return;
    }
    if (names.includes("scene")) open(model, traits.get("scene") as string | null);
    model.look(known(traits, names));
    tellSoon(); // what was not taken
  };
  const heard = HEARD.map((name) => {
    const hear = () => {
      if (telling) return;
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

/** Shows another scene; time and speed go on. */
function open(model: Model, scene: string | null): void {
  if (scene === null || scene === model.scene.value) return;
  const { time, speed } = model;
  const before = { speed: speed.value, time: time.value };
  model.open(scene);
  model.look(before);
}

/** What Python is told. */
function told(model: Model): Record<string, unknown> {
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

/** The state shown, with its time: Python knows by it whether it is that of the time that it set. */
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
