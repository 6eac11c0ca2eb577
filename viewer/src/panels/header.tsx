import type { ComponentChildren } from "preact";
import { useRef } from "preact/hooks";
import { Dialog } from "../inputs/dialog.tsx";
import type { Lesson } from "../lessons/lesson.ts";
import type { Model } from "../model/model.ts";
import { KEYS } from "./keys.ts";
import { Scenes } from "./scenes.tsx";

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
      <Dialog frame={dialog} name="shortcuts" title="Keys">
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
        <p class="note">
          Drag the dot of Ω on the energy ellipsoid, push the body, or aim Ω, L and the attitude by their
          handles. What you change at a time becomes the new start, at that time; what was before is replaced,
          and Undo brings it back.
        </p>
      </Dialog>
    </>
  );
}
