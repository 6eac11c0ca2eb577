import { useRef } from "preact/hooks";
import { Icon } from "./icons.tsx";
import { KEYS } from "./keys.ts";

/** A button, and the keys that it tells. */
export function Help() {
  const dialog = useRef<HTMLDialogElement>(null);
  return (
    <>
      <button
        id="help"
        class="quiet"
        aria-label="Keys"
        title="Keys (?)"
        aria-haspopup="dialog"
        onClick={() => dialog.current?.showModal()}
      >
        ?
      </button>
      <dialog
        ref={dialog}
        aria-labelledby="help-title"
        onClick={(event) => {
          if (event.target === event.currentTarget) event.currentTarget.close();
        }}
      >
        <div class="dialog">
          <h2 id="help-title">Keys</h2>
          <dl class="keys">
            {KEYS.map(([keys, action]) => (
              <div key={keys}>
                <dt>
                  {keys.split(" ").map((key) => (/^[–]$/.test(key) ? " – " : <kbd key={key}>{key}</kbd>))}
                </dt>
                <dd>{action}</dd>
              </div>
            ))}
          </dl>
          <p class="note">
            Drag to turn the picture, pinch or use the wheel to come nearer. Drop a scene (.toml) anywhere to
            open it, along with the mesh that it names.
          </p>
          <button id="help-close" onClick={() => dialog.current?.close()}>
            <Icon name="close" /> Close
          </button>
        </div>
      </dialog>
    </>
  );
}
