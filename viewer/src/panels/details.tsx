import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";

const KEY = "polhode-details";

/** Numbers behind the word “Details”. Whether they are open is remembered, also by the next page. */
export function Details({ wide, children }: { wide: boolean; children: ComponentChildren }) {
  const open = useSignal(remembered() ?? wide);
  return (
    <details
      class="details"
      open={open.value}
      onToggle={(event) => {
        if (event.currentTarget.open === open.value) return;
        open.value = event.currentTarget.open;
        remember(open.value);
      }}
    >
      <summary>Details</summary>
      {open.value && children}
    </details>
  );
}

// Some pages have no storage, such as those in sandboxed frames: then nothing is remembered.
function remembered(): boolean | null {
  try {
    const kept = localStorage.getItem(KEY);
    return kept === null ? null : kept === "open";
  } catch {
    return null;
  }
}

function remember(open: boolean): void {
  try {
    localStorage.setItem(KEY, open ? "open" : "closed");
  } catch {
    return;
  }
}
