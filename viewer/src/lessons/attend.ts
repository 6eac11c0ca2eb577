import type { RefObject } from "preact";
import { useEffect } from "preact/hooks";
import type { Lessons } from "./lessons.ts";

/**
 * Moves the focus, and with it the view, to what is read next: what was pressed is often removed, and what comes instead
 * may be below the picture or beyond the edge.
 */
export function useAttention(app: RefObject<HTMLElement | null>, lessons: Lessons): void {
  const signals = [lessons.lesson, lessons.index, lessons.answers, lessons.model.page];
  const rendered = signals.map((signal) => signal.value);
  useEffect(() => {
    const { next } = lessons;
    const root = app.current;
    if (!next || !root) return;
    // Preact runs pending effects before it renders newer values; those are not on the page yet.
    if (signals.some((signal, k) => signal.peek() !== rendered[k])) return;
    lessons.next = null;
    if (isElsewhere(root)) return;
    const target = next.map((selector) => root.querySelector<HTMLElement>(selector)).find(Boolean);
    target?.focus({ preventScroll: true });
    target?.scrollIntoView({ block: "nearest" });
  }, rendered);
}

/** Whether the user writes in another part of the document, such as a cell of a notebook. */
function isElsewhere(root: HTMLElement): boolean {
  const { activeElement, body } = root.ownerDocument;
  const host = (root.getRootNode() as ShadowRoot).host as Element | undefined;
  return activeElement !== null && activeElement !== body && !activeElement.contains(host ?? root);
}
