import { IconButton } from "../inputs/button.tsx";
import type { Question } from "./lesson.ts";
import type { Lessons } from "./lessons.ts";
import { LESSONS } from "./library.ts";
import { Prose } from "./prose.tsx";

/** The lessons that are part of the page; each opens at its first step. */
export function LessonList({ lessons }: { lessons: Lessons }) {
  return (
    <ul class="lessons">
      {LESSONS.map(({ id, title, about, file }) => (
        <li key={id}>
          <button data-lesson={id} onClick={() => (lessons.model.lesson.value = file)}>
            <strong>{title}</strong>
            <span class="note">{about}</span>
          </button>
        </li>
      ))}
    </ul>
  );
}

/** The current step of a lesson. */
export function LessonPanel({ lessons }: { lessons: Lessons }) {
  const lesson = lessons.lesson.value;
  const step = lessons.step;
  const index = lessons.index.value;
  if (!lesson || !step) return null;
  const last = lessons.last.value;
  const act = (target: string): void => lessons.act(target);
  const { question } = step;
  const choice = lessons.answers.value.get(index);
  const following = LESSONS[LESSONS.findIndex(({ file }) => file.name === lesson.name) + 1];
  const count = lesson.steps.length;
  return (
    <section
      class="lesson"
      aria-label={`Lesson: ${lesson.title}`}
      data-lesson={lesson.name.replace(/\.md$/u, "")}
      data-step={index + 1}
    >
      <div class="course">
        <p>
          {lesson.title}
          <span class="note">
            , step {index + 1} of {count}
          </span>
        </p>
        <IconButton
          id="lesson-close"
          class="quiet"
          label="Leave the lesson"
          icon="close"
          onClick={() => lessons.close()}
        />
      </div>
      <h2 tabIndex={-1}>{step.title}</h2>
      <div class="prose">
        <Prose tokens={step.text} last={last} act={act} />
        {question && <Choices question={question} choice={choice} choose={(k) => lessons.answer(k)} />}
        {question && choice !== undefined && (
          <>
            <p class="verdict" tabIndex={-1}>
              {question.choices[choice]!.right ? "That is right." : "Not so."}
            </p>
            <Prose tokens={question.answer} last={last} act={act} />
          </>
        )}
      </div>
      <nav aria-label="Steps of the lesson">
        <button id="lesson-back" disabled={index === 0} onClick={() => lessons.go(index - 1)}>
          Back
        </button>
        {index + 1 < count ? (
          <button id="lesson-next" class="primary" onClick={() => lessons.go(index + 1)}>
            Next
          </button>
        ) : following ? (
          <button
            id="lesson-next"
            class="primary"
            onClick={() => (lessons.model.lesson.value = following.file)}
          >
            Next lesson
          </button>
        ) : (
          <button id="lesson-next" class="primary" onClick={() => lessons.close()}>
            Finish
          </button>
        )}
      </nav>
    </section>
  );
}

/** The choices of a question; after the answer, the right ones are marked. */
function Choices(props: {
  question: Question;
  choice: number | undefined;
  choose: (choice: number) => void;
}) {
  const { question, choice, choose } = props;
  const done = choice !== undefined;
  return (
    <div class="guesses" role="group" aria-label="Predict">
      {question.choices.map(({ tokens, right }, k) => {
        const mark = done && right ? " right" : done && k === choice ? " wrong" : "";
        return (
          <button
            key={k}
            class={`guess${mark}`}
            aria-pressed={k === choice}
            disabled={done}
            onClick={() => choose(k)}
          >
            <span class="tick" aria-hidden="true">
              {mark === " right" ? "✓" : mark === " wrong" ? "✗" : ""}
            </span>
            <span>
              <Prose tokens={tokens} last={null} act={() => {}} plain />
            </span>
          </button>
        );
      })}
    </div>
  );
}
