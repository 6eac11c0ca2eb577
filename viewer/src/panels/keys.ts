import { CAMERAS } from "../document.ts";
import type { Model } from "../model/model.ts";

/** The keys, as the help tells them. */
export const KEYS: [string, string][] = [
  ["Space", "play or pause"],
  ["← →", "a step back or forward; with Shift ten"],
  ["Home", "to the start"],
  ["[ ]", "slower, faster"],
  ["1 – 6", `the camera: ${CAMERAS.join(", ")}`],
  ["F", "fit all into the picture"],
  ["P", "Poinsot's ellipsoid"],
  ["D", "light or dark"],
  ["?", "this help"],
];

/** A step is a thirtieth of a second of the clock. */
const STEP = 1 / 30;

/** What is looked at is between an atom and a galaxy, in seconds of motion in one of the clock. */
const SLOWEST = 1e-15;
const FASTEST = 1e15;

/** Steps forward, or back. */
export function step(model: Model, count: number): void {
  model.playing.value = false;
  model.seek(model.time.value + count * STEP * model.speed.value);
}

/** The next speed of the row 1, 2, 5, 10, … */
export function faster(model: Model, direction: 1 | -1): void {
  const speed = model.speed.value;
  const power = 10 ** Math.floor(Math.log10(speed) + 1e-9);
  const row = [0.5, 1, 2, 5, 10].map((first) => first * power);
  const next = direction > 0 ? row.find((s) => s > speed * 1.01) : row.findLast((s) => s < speed * 0.99);
  if (next !== undefined && next >= SLOWEST && next <= FASTEST)
    model.speed.value = Number(next.toPrecision(3));
}

/**
 * Keys of the viewer: those typed in it, and, where it is the only one of its page and not compact, those typed
 * nowhere else. Returns what ends it.
 */
export function bindKeys(host: HTMLElement, model: Model): () => void {
  const listen = (event: KeyboardEvent): void => {
    const inside = event.composedPath().includes(host);
    const alone = event.target === document.body && document.querySelectorAll(host.localName).length === 1;
    if (!inside && !(alone && !host.hasAttribute("compact"))) return;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (model.page.value !== "motion" || takesKeys(event)) return;
    if (act(event, host, model)) event.preventDefault();
  };
  document.addEventListener("keydown", listen);
  return () => document.removeEventListener("keydown", listen);
}

/**
 * Takes the number in a field at Enter. Browsers do so by themselves, but not within JupyterLab, where they only do when
 * the field is left. Returns what ends it.
 */
export function takeAtEnter(host: HTMLElement): () => void {
  const listen = (event: KeyboardEvent): void => {
    const field = event.composedPath()[0];
    if (event.key !== "Enter" || !(field instanceof HTMLInputElement) || field.type !== "number") return;
    event.preventDefault();
    field.blur();
    field.focus();
  };
  host.addEventListener("keydown", listen);
  return () => host.removeEventListener("keydown", listen);
}

function act(event: KeyboardEvent, host: HTMLElement, model: Model): boolean {
  const camera = CAMERAS[Number(event.key) - 1];
  if (camera) {
    // Again: back to where it was before the view was turned by hand.
    if (camera === model.camera.value) model.fit();
    model.camera.value = camera;
    return true;
  }
  const many = event.shiftKey ? 10 : 1;
  const actions: Record<string, () => void> = {
    " ": () => (model.playing.value = !model.playing.value),
    ArrowLeft: () => step(model, -many),
    ArrowRight: () => step(model, many),
    Home: () => model.toStart(),
    "[": () => faster(model, -1),
    "]": () => faster(model, 1),
    f: () => model.fit(),
    p: () => model.toggle("poinsot"),
    d: () => model.look({ theme: isDark(host) ? "light" : "dark" }),
    "?": () => host.shadowRoot?.querySelector<HTMLElement>("#help")?.click(),
  };
  const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  action?.();
  return action !== undefined;
}

function isDark(host: HTMLElement): boolean {
  return getComputedStyle(host).colorScheme === "dark";
}

/** Whether the key means something to what has the focus. */
function takesKeys(event: KeyboardEvent): boolean {
  const target = event.composedPath()[0];
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog")) return true;
  if (target instanceof HTMLInputElement) {
    if (target.type === "range") return event.key !== " ";
    return target.type === "checkbox" ? event.key === " " : true;
  }
  if (target.matches("button, summary, a")) return event.key === " " || event.key === "Enter";
  return target.matches("textarea, select") || target.isContentEditable;
}
