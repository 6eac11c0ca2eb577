import { DEGREE } from "../format/units.ts";
import { Icon, type IconName } from "../inputs/button.tsx";
import type { Hands, Tool } from "./hands.ts";

const TOOLS: [tool: Exclude<Tool, "none">, label: string, title: string][] = [
  ["push", "Push", "Push the body with an impulse (U)"],
  ["aim", "Aim", "Handles for Ω, L and the attitude (A)"],
];
/** The grips that keys move first. */
const FIRST = { push: "grip-push", aim: "grip-omega" } as const;
const HINTS: Record<Tool, string | null> = {
  none: null,
  push: "Press on the body and drag: the arrow is an impulse J. Released, it adds r∧J to L; the attitude stays.",
  aim: "Drag Ω, L or the end R of the arc of the attitude: the motion goes on from this instant.",
};

/** Undo and redo, the tools of the hands, the ghost, and one line that says what they did. */
export function HandsBar({ hands }: { hands: Hands }) {
  const { model, ghost } = hands;
  const { undoable, redoable } = model.history;
  const able = hands.able.value;
  const shown = model.shown.value.ghost;
  return (
    <div class="hands">
      <div class="buttons" role="group" aria-label="Hands on the body">
        <Action id="undo" icon="undo" title="Undo (Ctrl+Z)" off={!undoable.value} act={() => model.undo()}>
          Undo
        </Action>
        <Action
          id="redo"
          icon="redo"
          title="Redo (Ctrl+Shift+Z)"
          off={!redoable.value}
          act={() => model.redo()}
        >
          Redo
        </Action>
        {TOOLS.map(([tool, label, title]) => (
          <button
            key={tool}
            id={tool}
            title={title}
            aria-pressed={hands.tool.value === tool && able}
            disabled={!able}
            onClick={(event) => {
              hands.choose(tool);
              if (event.detail === 0) focusOn(FIRST[tool], event.currentTarget);
            }}
          >
            {label}
          </button>
        ))}
        <button
          id="ghost"
          title="A second body whose Ω at the start is 0.1° off (G)"
          aria-pressed={shown && ghost.able.value}
          disabled={!ghost.able.value}
          onClick={() => model.toggle("ghost")}
        >
          Ghost <span class="wide">0.1° away</span>
        </button>
        {shown && <Apart hands={hands} />}
      </div>
      <p class="did" role="status" id="hands-report">
        {line(hands)}
      </p>
    </div>
  );
}

/** Moves the focus to a grip, which the next frame shows. */
function focusOn(id: string, from: HTMLElement): void {
  const root = from.getRootNode() as ParentNode;
  requestAnimationFrame(() =>
    requestAnimationFrame(() => root.querySelector<HTMLElement>(`#${id}:not([hidden])`)?.focus()),
  );
}

/** What is being done, or else what was done last, or what can be done. */
function line({ doing, report, hint, tool }: Hands): string | null {
  return doing.value ?? report.value ?? hint.value ?? HINTS[tool.value];
}

/** The angle between the body and its ghost. */
function Apart({ hands }: { hands: Hands }) {
  const angle = hands.ghost.angle.value;
  return (
    <output id="apart" class="digits" aria-live="off">
      {angle === null ? "…" : `${(angle / DEGREE.size).toFixed(2)}°`}
      <span class="note"> apart</span>
    </output>
  );
}

function Action(props: {
  id: string;
  icon: IconName;
  title: string;
  off: boolean;
  act: () => Promise<void>;
  children: string;
}) {
  const { id, icon, title, off, act, children } = props;
  return (
    <button id={id} title={title} aria-label={children} disabled={off} onClick={() => void act()}>
      <Icon name={icon} /> <span class="wide">{children}</span>
    </button>
  );
}
