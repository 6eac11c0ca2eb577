import type { ComponentChildren, RefObject } from "preact";
import { IconButton } from "./button.tsx";

/**
 * A modal dialog under its title. The browser holds the focus in it, and gives it back when it closes: by its button, by
 * Escape, or by a press beside it. `autofocus` on a control of the content gives it the focus first.
 */
export function Dialog(props: {
  frame: RefObject<HTMLDialogElement | null>;
  /** Class of the dialog, and beginning of its ids. */
  name: string;
  title: string;
  children: ComponentChildren;
}) {
  const { frame, name, title, children } = props;
  return (
    <dialog
      ref={frame}
      class={name}
      aria-labelledby={`${name}-title`}
      onClick={(event) => {
        if (event.target === event.currentTarget) event.currentTarget.close();
      }}
    >
      <div class="dialog">
        <div class="heading">
          <h2 id={`${name}-title`}>{title}</h2>
          <IconButton
            id={`${name}-close`}
            class="quiet"
            label="Close"
            icon="close"
            onClick={() => frame.current?.close()}
          />
        </div>
        {children}
      </div>
    </dialog>
  );
}
