import type { Model } from "../model/model.ts";

/** Key presses on one element within this time in ms are one step. */
const PAUSE = 1000;

/**
 * Binds the keys of undo and redo for what `ours` accepts, and marks where a step of the history begins: at each press
 * of a button, and at each key but further arrows on the same element. Returns a function that unbinds them.
 */
export function bindHistory(
  host: HTMLElement,
  model: Model,
  ours: (event: KeyboardEvent) => boolean,
): () => void {
  let last: { target: EventTarget | undefined; at: number } | null = null;
  const press = (event: KeyboardEvent): void => {
    const [target, at] = [event.composedPath()[0], performance.now()];
    const again = event.key.startsWith("Arrow") && last?.target === target && at - last!.at < PAUSE;
    if (event.composedPath().includes(host) && !again && !event.repeat) model.history.begin();
    last = { target, at };
  };
  const undo = (event: KeyboardEvent): void => {
    if (event.defaultPrevented || event.altKey || !(event.ctrlKey || event.metaKey) || !ours(event)) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && !(key === "y" && !event.shiftKey)) return;
    event.preventDefault();
    void (key === "y" || event.shiftKey ? model.redo() : model.undo());
  };
  const down = (): void => model.history.begin(true);
  const up = (): void => model.history.end();
  const root = host.ownerDocument;
  host.addEventListener("pointerdown", down, true);
  root.addEventListener("pointerup", up, true);
  root.addEventListener("pointercancel", up, true);
  root.addEventListener("keydown", press, true);
  root.addEventListener("keydown", undo);
  return () => {
    host.removeEventListener("pointerdown", down, true);
    root.removeEventListener("pointerup", up, true);
    root.removeEventListener("pointercancel", up, true);
    root.removeEventListener("keydown", press, true);
    root.removeEventListener("keydown", undo);
  };
}
