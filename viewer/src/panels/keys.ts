import { CAMERAS } from "../document.ts";
import { bindHistory } from "../hands/keys.ts";
import type { Model } from "../model/model.ts";
import { TURNS } from "../stage/camera.ts";

/** The keys and their actions, for the help. */
export const KEYS: [string, string][] = [
  ["Space", "play or pause"],
  ["← →", "one step back or forward; with Shift, ten steps"],
  ["Home", "go to the start"],
  ["[ ]", "slower, faster"],
  ["1 – 6", `camera: ${CAMERAS.join(", ")}`],
  ["I J K L", "turn the picture up, left, down, right"],
  ["+ -", "nearer, farther"],
  ["F", "fit everything into the picture"],
  ["P", "show or hide Poinsot’s ellipsoid"],
  ["D", "light or dark colours"],
  ["Ctrl+Z", "undo a change of the scene; with Shift, redo"],
  ["U", "push the body: arrow keys aim, Enter pushes, Esc ends"],
  ["A", "aim Ω, L and the attitude by handles; arrow keys move them, with Shift finely"],
  ["G", "show or hide the ghost, which starts 0.1° away"],
  ["?", "this help"],
];

/** One step, in seconds of real time. */
const STEP = 1 / 30;

/** Limits of the speed, in seconds of motion per second of real time: from atoms to galaxies. */
const SLOWEST = 1e-15;
const FASTEST = 1e15;

/** Stops and moves by some steps, forward or back. */
export function step(model: Model, count: number): void {
  model.playing.value = false;
  model.seek(model.time.value + count * STEP * model.speed.value);
}

/** Changes the speed to the next one of 1, 2, 5, 10, … */
export function changeSpeed(model: Model, direction: 1 | -1): void {
  const sign = Math.sign(model.speed.value) || 1;
  const speed = Math.abs(model.speed.value);
  const power = 10 ** Math.floor(Math.log10(speed) + 1e-9);
  const speeds = [0.5, 1, 2, 5, 10].map((first) => first * power);
  const next =
    direction > 0 ? speeds.find((s) => s > speed * 1.01) : speeds.findLast((s) => s < speed * 0.99);
  if (next !== undefined && next >= SLOWEST && next <= FASTEST)
    model.speed.value = sign * Number(next.toPrecision(3));
}

/** Sets the speed, within its limits; a negative one plays backwards. */
export function setSpeed(model: Model, speed: number): void {
  const size = Math.min(Math.max(Math.abs(speed), SLOWEST), FASTEST);
  model.speed.value = speed < 0 ? -size : size;
}

/**
 * Binds the keys of the viewer: those typed in it and, if it is the only viewer of the page and not compact, those typed
 * on the page itself. Returns a function that unbinds them.
 */
export function bindKeys(host: HTMLElement, model: Model): () => void {
  const ours = (event: KeyboardEvent): boolean => {
    const inside = event.composedPath().includes(host);
    const onPage = event.target === document.body && document.querySelectorAll(host.localName).length === 1;
    if (!inside && !(onPage && !host.hasAttribute("compact"))) return false;
    return model.page.value === "motion" && !takesKeys(event);
  };
  const listen = (event: KeyboardEvent): void => {
    if (!ours(event)) return;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (perform(event, host, model)) event.preventDefault();
  };
  document.addEventListener("keydown", listen);
  const unbind = bindHistory(host, model, ours);
  return () => {
    document.removeEventListener("keydown", listen);
    unbind();
  };
}

/**
 * Commits number fields on Enter. Browsers do so themselves, but within JupyterLab only when the field loses focus.
 * Returns a function that undoes it.
 */
export function commitOnEnter(host: HTMLElement): () => void {
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

function perform(event: KeyboardEvent, host: HTMLElement, model: Model): boolean {
  const camera = CAMERAS[Number(event.key) - 1];
  if (camera) {
    // The same camera again resets the view.
    if (camera === model.camera.value) model.fit();
    model.camera.value = camera;
    return true;
  }
  const count = event.shiftKey ? 10 : 1;
  const actions: Record<string, () => void> = {
    " ": () => (model.playing.value = !model.playing.value),
    ArrowLeft: () => step(model, -count),
    ArrowRight: () => step(model, count),
    Home: () => model.toStart(),
    "[": () => changeSpeed(model, -1),
    "]": () => changeSpeed(model, 1),
    f: () => model.fit(),
    p: () => model.toggle("poinsot"),
    g: () => model.toggle("ghost"),
    u: () => host.shadowRoot?.querySelector<HTMLElement>("#push")?.click(),
    a: () => host.shadowRoot?.querySelector<HTMLElement>("#aim")?.click(),
    d: () => model.look({ theme: isDark(host) ? "light" : "dark" }),
    "?": () => host.shadowRoot?.querySelector<HTMLElement>("#help")?.click(),
  };
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const turn = TURNS[key];
  if (turn) model.turned.value = [...turn];
  actions[key]?.();
  return turn !== undefined || actions[key] !== undefined;
}

function isDark(host: HTMLElement): boolean {
  return getComputedStyle(host).colorScheme === "dark";
}

/** Whether the focused element uses the key itself. */
function takesKeys(event: KeyboardEvent): boolean {
  const target = event.composedPath()[0];
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog")) return true;
  if (target instanceof HTMLInputElement) {
    if (target.type === "range") return /^(Arrow|Page|Home|End)/.test(event.key);
    return target.type === "checkbox" ? event.key === " " : true;
  }
  if (target.matches("button, summary, a")) return event.key === " " || event.key === "Enter";
  return target.matches("textarea, select") || target.isContentEditable;
}
