import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { Model } from "../model/model.ts";

/** A text editor for the scene. Its errors are shown over the picture. */
export function Editor({ model }: { model: Model }) {
  const copied = useSignal(false);
  const area = useRef<HTMLTextAreaElement>(null);
  const { draft } = model;
  const scene = draft.value ?? model.scene.value;
  if (scene === null) return <p class="note">This recorded motion has no scene to edit.</p>;
  const apply = (): void => void model.open(scene);
  const copy = async (): Promise<void> => {
    area.current?.select();
    // Where the clipboard is not accessible, the selected text can be copied by hand.
    await navigator.clipboard?.writeText(area.current?.value ?? "").catch(() => undefined);
    copied.value = true;
    setTimeout(() => (copied.value = false), 1500);
  };
  return (
    <form
      class="editor"
      onSubmit={(event) => {
        event.preventDefault();
        apply();
      }}
    >
      <label for="scene" class="hidden">
        Scene, in TOML
      </label>
      <textarea
        id="scene"
        ref={area}
        rows={16}
        spellcheck={false}
        autocomplete="off"
        aria-invalid={draft.value !== null && model.problem.value !== null}
        aria-describedby="problem"
        value={scene}
        onInput={(event) => (draft.value = event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) apply();
        }}
      />
      <div class="buttons">
        <button id="apply" class="primary" type="submit" title="Apply (Ctrl+Enter)">
          Apply
        </button>
        <button id="copy" type="button" onClick={() => void copy()}>
          {copied.value ? "Copied" : "Copy"}
        </button>
        <button id="reset" type="button" onClick={() => model.reset()}>
          Reset
        </button>
      </div>
    </form>
  );
}
