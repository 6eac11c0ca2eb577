import { useRef } from "preact/hooks";
import { Icon } from "../inputs/button.tsx";
import { KEYS } from "./keys.ts";

/** A button that opens the list of keys. */
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
                <dt>{keys.split(" ").map((key) => (key === "–" ? " – " : <kbd key={key}>{key}</kbd>))}</dt>
                <dd>{action}</dd>
              </div>
            ))}
          </dl>
          <p class="note">
            Drag to rotate the picture; pinch or scroll to zoom. Drop a scene (.toml) anywhere to open it,
            together with the mesh that it names.
          </p>
          <button id="help-close" onClick={() => dialog.current?.close()}>
            <Icon name="close" /> Close
          </button>
        </div>
      </dialog>
    </>
  );
}
