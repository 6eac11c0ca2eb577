import type { ComponentChildren } from "preact";
import { useRef } from "preact/hooks";
import { Icon, IconButton } from "../inputs/button.tsx";
import { Choices } from "../inputs/fields.tsx";
import type { Lesson } from "../lessons/lesson.ts";
import type { Model } from "../model/model.ts";
import { openPreset, PRESETS } from "../presets/index.ts";
import { KEYS } from "./keys.ts";
import { ACCEPTED, openFiles } from "./open.ts";

const PAGES = ["motion", "algebra"] as const;

/** The title, the list of scenes, the tabs, what shares the page, and help. */
export function Header(props: {
  model: Model;
  compact: boolean;
  lesson: Lesson | null;
  share: ComponentChildren;
}) {
  const { model, compact, lesson, share } = props;
  const motion = model.page.value === "motion";
  return (
    <header>
      <h1>{motion ? (model.about.value?.title ?? lesson?.title ?? "Polhode") : "Algebra"}</h1>
      {!compact && motion && <Scenes model={model} />}
      <Tabs model={model} />
      {share}
      <Help />
    </header>
  );
}

/** The pages as tabs: the Tab key reaches one of them, the arrow keys change to the other. */
function Tabs({ model }: { model: Model }) {
  const changeTab = (event: KeyboardEvent): void => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    event.preventDefault();
    model.page.value = model.page.value === "motion" ? "algebra" : "motion";
    const tabs = (event.currentTarget as HTMLElement).querySelectorAll<HTMLElement>("button");
    tabs[PAGES.indexOf(model.page.value)]?.focus();
  };
  return (
    <div role="tablist" aria-label="Pages" class="tabs" onKeyDown={changeTab}>
      {PAGES.map((page) => (
        <button
          key={page}
          id={`tab-${page}`}
          role="tab"
          aria-selected={model.page.value === page}
          aria-controls="page"
          tabIndex={model.page.value === page ? 0 : -1}
          onClick={() => (model.page.value = page)}
        >
          {page === "motion" ? "Motion" : "Algebra"}
        </button>
      ))}
    </div>
  );
}

/** The presets, and a button that opens files. */
function Scenes({ model }: { model: Model }) {
  const input = useRef<HTMLInputElement>(null);
  const chosen = PRESETS.find(({ caption }) => caption === model.caption.value);
  return (
    <div class="scenes">
      <label for="preset" class="hidden">
        Scene
      </label>
      <Choices
        id="preset"
        value={chosen?.name ?? null}
        options={PRESETS.map(({ name, title }) => [name, title])}
        other="Scenes…"
        onChange={(name) => {
          model.lesson.value = null;
          void openPreset(
            model,
            PRESETS.find((preset) => preset.name === name)!,
          );
        }}
      />
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
    </div>
  );
}

/** A button that opens the list of keys. */
function Help() {
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
