import { type ReadonlySignal, useSignal } from "@preact/signals";
import { Component, type ComponentChildren } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { AlgebraPage } from "../algebra/page.tsx";
import { Definitions } from "../glossary/definitions.tsx";
import { Hands } from "../hands/hands.ts";
import { useAttention } from "../lessons/attend.ts";
import { LessonList, LessonPanel } from "../lessons/panel.tsx";
import { Lessons } from "../lessons/lessons.ts";
import { type Model, words } from "../model/model.ts";
import type { Palette } from "../palette.ts";
import { Share, type Sharing } from "../share/share.tsx";
import { Controls } from "../vary/controls.ts";
import { BodyPanel } from "./body.tsx";
import { Editor } from "./editor.tsx";
import { Facts } from "./facts.tsx";
import { Header } from "./header.tsx";
import { LawsPanel } from "./laws.tsx";
import { openFiles } from "./open.ts";
import { Playback } from "./playback.tsx";
import { Readout } from "./readout.tsx";
import { Picture } from "./picture.tsx";
import { inWords } from "./regime.ts";
import { StartPanel } from "./start.tsx";
import { ViewPanel } from "./view.tsx";

interface Props {
  model: Model;
  palette: ReadonlySignal<Palette>;
  compact: boolean;
  /** Whether panels fit beside the picture; they are then open by default. */
  wide: boolean;
  sharing: Sharing;
}

/** Whether panels are open, for those that the user opened or folded. */
type Folds = Map<string, boolean>;

/** The page: the header, and the motion or the algebra below it. */
export function App({ model, palette, compact, wide, sharing }: Props) {
  const dragged = useSignal(false);
  // Kept while the algebra is shown.
  const controls = useMemo(() => new Controls(model), [model]);
  useEffect(() => () => controls.dispose(), [controls]);
  const hands = useMemo(() => new Hands(model, controls), [model, controls]);
  useEffect(() => () => hands.dispose(), [hands]);
  const lessons = useMemo(() => new Lessons(model), [model]);
  useEffect(() => () => lessons.dispose(), [lessons]);
  useEffect(() => sharing.address?.keep(lessons), [sharing, lessons]);
  const app = useRef<HTMLDivElement>(null);
  useAttention(app, lessons);
  const folds = useMemo<Folds>(() => new Map(), []);
  const motion = model.page.value === "motion";
  return (
    <div
      ref={app}
      class={`app${compact ? " compact" : ""}${dragged.value ? " dragged" : ""}`}
      onDragOver={(event) => {
        event.preventDefault();
        dragged.value = true;
      }}
      onDragLeave={() => (dragged.value = false)}
      onDrop={(event) => {
        event.preventDefault();
        dragged.value = false;
        const files = [...(event.dataTransfer?.files ?? [])];
        if (files.length > 0) void openFiles(model, files);
      }}
    >
      <Header
        model={model}
        compact={compact}
        lesson={lessons.lesson.value}
        share={<Share {...{ model, palette, lessons, sharing }} />}
      />
      <main>
        <div id="page" role="tabpanel" aria-labelledby={`tab-${model.page.value}`} class="page">
          <Boundary key={model.page.value}>
            {motion ? (
              <MotionPage {...{ model, palette, compact, wide, controls, hands, lessons, folds }} />
            ) : (
              <AlgebraPage
                model={model}
                palette={palette}
                lesson={lessons.step && <LessonPanel lessons={lessons} />}
              />
            )}
          </Boundary>
        </div>
      </main>
      <Definitions app={app} />
    </div>
  );
}

function MotionPage(
  props: Omit<Props, "sharing"> & { controls: Controls; hands: Hands; lessons: Lessons; folds: Folds },
) {
  const { model, palette, compact, controls, hands, lessons, folds } = props;
  const known = model.about.value !== null;
  // Without a motion, the text of an invalid scene.
  const editable = known || model.draft.value !== null;
  const learning = lessons.step !== null;
  const formulas = !known && lessons.step?.subject.kind === "lines";
  // In a lesson its text comes first.
  const wide = props.wide && !learning;
  const varied = !compact && controls.about.value !== null;
  const listed = (!compact || lessons.left.value) && !learning;
  const panels: [shown: boolean, id: string, title: string, open: boolean, content: ComponentChildren][] = [
    [
      listed,
      "lessons",
      "Lessons",
      model.preset.value !== null || lessons.left.value,
      <LessonList lessons={lessons} />,
    ],
    [known, "motion", "Motion", !learning && !compact, <Facts model={model} wide={wide} />],
    [known, "state", "State", learning ? false : !compact || wide, <Readout model={model} />],
    [varied, "start", "Spin and attitude", wide, <StartPanel controls={controls} />],
    [varied, "body", "Body", false, <BodyPanel controls={controls} />],
    [varied, "laws", "Torques", false, <LawsPanel controls={controls} />],
    [true, "view", "View", false, <ViewPanel model={model} />],
    [!compact && editable, "text", "Scene", !known && !learning, <Editor model={model} />],
  ];
  return (
    <div class="motion">
      <Picture model={model} palette={palette} hands={hands} formulas={formulas} compact={compact} />
      {/* The chart shows what is to come, which may answer the question of a lesson. */}
      <Playback model={model} chart={!lessons.asks} />
      <aside class="panels" aria-label="Values and controls">
        {learning && <LessonPanel lessons={lessons} />}
        {panels.map(
          ([shown, id, title, open, content]) =>
            shown && (
              <Panel key={`${id} ${learning}`} id={id} title={title} open={open} folds={folds}>
                {content}
              </Panel>
            ),
        )}
      </aside>
      {/* Announces to screen readers when the kind of motion changes. */}
      <p class="hidden" aria-live="polite">
        {inWords(model.about.value, model.core.laws)}
      </p>
    </div>
  );
}

function Panel(props: {
  id: string;
  title: string;
  open: boolean;
  folds: Folds;
  children: ComponentChildren;
}) {
  const { id, folds } = props;
  // The content of a folded panel is not rendered, because values change in every frame.
  const open = useSignal(folds.get(id) ?? props.open);
  return (
    <details
      id={`panel-${id}`}
      open={open.value}
      onToggle={(event) => {
        open.value = event.currentTarget.open;
        if (open.value !== (folds.get(id) ?? props.open)) folds.set(id, open.value);
      }}
    >
      <summary>
        <h2>{props.title}</h2>
      </summary>
      {open.value && <div class="inside">{props.children}</div>}
    </details>
  );
}

/** Shows its children, or the error raised while they were rendered; the rest of the page keeps working. */
class Boundary extends Component<{ children: ComponentChildren }, { problem: string | null }> {
  override state = { problem: null };

  static override getDerivedStateFromError(error: unknown): { problem: string } {
    return { problem: words(error) };
  }

  render() {
    if (this.state.problem === null) return this.props.children;
    return (
      <div class="notice">
        <div role="alert">
          <p>This page cannot be shown.</p>
          <pre>{this.state.problem}</pre>
        </div>
      </div>
    );
  }
}
