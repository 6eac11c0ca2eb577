import { useRef } from "preact/hooks";
import { Icon, IconButton } from "../inputs/button.tsx";
import { Dialog } from "../inputs/dialog.tsx";
import type { Model } from "../model/model.ts";
import { titleOf } from "../presets/files.ts";
import { GROUPS, openPreset, type Preset } from "../presets/index.ts";
import { ACCEPTED, openFiles } from "./open.ts";

/** A button that opens the list of built-in scenes, and one that opens files. */
export function Scenes({ model }: { model: Model }) {
  const dialog = useRef<HTMLDialogElement>(null);
  const input = useRef<HTMLInputElement>(null);
  const choose = (preset: Preset): void => {
    dialog.current?.close();
    model.lesson.value = null;
    void openPreset(model, preset);
  };
  return (
    <div class="scenes">
      <button id="scenes" aria-haspopup="dialog" onClick={() => dialog.current?.showModal()}>
        <Icon name="scenes" /> Scenes
      </button>
      <IconButton
        id="open"
        class="quiet"
        label="Open a scene"
        icon="open"
        onClick={() => input.current?.click()}
      />
      <input
        id="file"
        ref={input}
        class="hidden"
        type="file"
        multiple
        accept={ACCEPTED}
        tabIndex={-1}
        aria-label="Scene and mesh files"
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (files.length > 0) void openFiles(model, files);
        }}
      />
      <Dialog frame={dialog} name="gallery" title="Scenes">
        {GROUPS.map(([title, presets]) => (
          <section key={title} aria-label={title}>
            <h3>{title}</h3>
            <ul class="lessons">
              {presets.map((preset) => (
                <li key={preset.name}>
                  <Entry preset={preset} open={model.preset.value === preset.name} choose={choose} />
                </li>
              ))}
            </ul>
          </section>
        ))}
      </Dialog>
    </div>
  );
}

/** A scene with its title and a sentence about it. */
function Entry(props: { preset: Preset; open: boolean; choose: (preset: Preset) => void }) {
  const { preset, open, choose } = props;
  const { title, about } = titleOf(preset.name);
  return (
    <button data-scene={preset.name} aria-current={open ? "true" : undefined} onClick={() => choose(preset)}>
      <strong>{title}</strong>
      <span class="note">{about}</span>
    </button>
  );
}
