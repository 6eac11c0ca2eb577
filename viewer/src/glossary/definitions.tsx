import { useSignal } from "@preact/signals";
import type { RefObject } from "preact";
import { useEffect } from "preact/hooks";
import { DEFINITIONS, type Definition, GLOSSARY, idOf } from "./glossary.ts";

/** ms until a definition opens under the pointer, and until it closes behind it, so that the pointer can move to it. */
const OPENING = 250;
const CLOSING = 200;
/** In px: its greatest width, and its distance from the term. */
const WIDTH = 320;
const GAP = 6;

interface Shown {
  definition: Definition;
  /** Of the term, in the app. */
  left: number;
  top: number;
  bottom: number;
  /** Whether it is above the term. */
  above: boolean;
}

/**
 * Shows the definition of whatever has the attribute `data-term`, while the pointer is over it or it has the focus. A tap,
 * Enter and Space open and close that of a term; Escape closes it.
 */
export function Definitions({ app }: { app: RefObject<HTMLElement | null> }) {
  const shown = useSignal<Shown | null>(null);
  useEffect(
    () =>
      follow(
        app.current!,
        (found) => (shown.value = found),
        () => shown.value !== null,
      ),
    [],
  );
  const { definition, left, top, bottom, above } = shown.value ?? {};
  return (
    <>
      {definition && (
        <div
          aria-hidden="true"
          class="definition"
          style={{
            left: `${left}px`,
            ...(above ? { top: `${top! - GAP}px` } : { top: `${bottom! + GAP}px` }),
          }}
          data-above={above}
        >
          <strong>{definition.term}</strong> {definition.text}
        </div>
      )}
      <dl hidden>
        {DEFINITIONS.map(({ term, text }) => (
          <div key={term}>
            <dt>{term}</dt>
            <dd id={idOf(term)}>{text}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}

/** Follows pointer, focus and keys in the app; returns a function that ends it. */
function follow(app: HTMLElement, set: (shown: Shown | null) => void, isOpen: () => boolean): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let current: Element | null = null;
  const later = (act: () => void, wait: number): void => {
    clearTimeout(timer);
    timer = setTimeout(act, wait);
  };
  const close = (): void => {
    clearTimeout(timer);
    current = null;
    set(null);
  };
  const open = (target: HTMLElement): void => {
    clearTimeout(timer);
    const definition = GLOSSARY.get(target.dataset["term"]!);
    if (!definition || !target.isConnected) return;
    current = target;
    // The first line of a term that is broken across two.
    const box = target.getClientRects()[0] ?? target.getBoundingClientRect();
    const frame = app.getBoundingClientRect();
    const width = Math.min(WIDTH, frame.width - 2 * GAP);
    const left = Math.max(Math.min(box.left - frame.left, frame.width - width - GAP), GAP);
    const above = box.bottom - frame.top > 0.6 * frame.height;
    const [top, bottom] = [box.top, box.bottom].map((y) => y - frame.top + app.scrollTop);
    set({ definition, left, top: top!, bottom: bottom!, above });
  };
  const termOf = (event: Event): HTMLElement | null =>
    (event.target as Element).closest<HTMLElement>("[data-term]");
  const listeners: [string, (event: never) => void][] = [
    [
      "pointerover",
      (event: PointerEvent) => {
        if (event.pointerType === "touch") return;
        const target = termOf(event);
        if (target) target === current ? clearTimeout(timer) : later(() => open(target), OPENING);
        else if ((event.target as Element).closest(".definition")) clearTimeout(timer);
        else if (isOpen()) later(close, CLOSING);
        else clearTimeout(timer);
      },
    ],
    ["pointerleave", () => later(close, CLOSING)],
    [
      "focusin",
      (event: FocusEvent) => {
        const target = termOf(event);
        if (target && (event.target as Element).matches(":focus-visible")) open(target);
      },
    ],
    ["focusout", close],
    [
      "click",
      (event: PointerEvent) => {
        const target = termOf(event);
        // Under a mouse it is open already.
        if (target?.classList.contains("defined"))
          target === current && event.pointerType === "touch" ? close() : open(target);
        else if (!(event.target as Element).closest(".definition")) close();
      },
    ],
    [
      "keydown",
      (event: KeyboardEvent) => {
        const target = termOf(event);
        if (target?.classList.contains("defined") && (event.key === "Enter" || event.key === " "))
          target === current ? close() : open(target);
        else return;
        event.preventDefault();
      },
    ],
  ];
  for (const [name, listen] of listeners) app.addEventListener(name, listen as EventListener);
  app.addEventListener("scroll", close, true);
  // Also while the focus is elsewhere; what the key does otherwise waits for the next time.
  const escape = (event: KeyboardEvent): void => {
    if (event.key !== "Escape" || !isOpen()) return;
    event.preventDefault();
    close();
  };
  document.addEventListener("keydown", escape, true);
  return () => {
    clearTimeout(timer);
    for (const [name, listen] of listeners) app.removeEventListener(name, listen as EventListener);
    app.removeEventListener("scroll", close, true);
    document.removeEventListener("keydown", escape, true);
  };
}
