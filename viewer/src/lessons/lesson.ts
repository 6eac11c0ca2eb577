import type { Token, Tokens } from "marked";
import type { Files } from "../core/core.ts";
import type { CameraName, Shown } from "../document.ts";

/** A lesson as it was parsed; docs/lessons.md describes its file. */
export interface Lesson {
  /** File name, such as `book.md`. */
  name: string;
  title: string;
  /** One sentence for the list of lessons. */
  about: string;
  steps: Step[];
}

/** One step: its text, what it sets, and at most one question, which hides the text after it until it is answered. */
export interface Step {
  title: string;
  /** The line of its heading in the file. */
  line: number;
  /** What the picture shows: a scene, or lines of the algebra page. */
  subject: Subject;
  text: Token[];
  set: Settings;
  question: Question | null;
}

export interface Question {
  choices: { tokens: Token[]; right: boolean }[];
  /** The text after the choices, and what it sets. */
  answer: Token[];
  set: Settings;
}

export type Subject =
  | {
      kind: "scene";
      scene: string;
      name: string;
      files: Files;
      /** Lines of the lesson before a scene that is written in it; null for a scene by its name. */
      above: number | null;
    }
  | { kind: "lines"; lines: string };

/** What a step or an underlined phrase sets. What is absent does not change. */
export interface Settings {
  camera?: CameraName;
  /** s. */
  time?: number;
  speed?: number;
  playing?: boolean;
  shown?: Partial<Shown>;
  /** Whether everything that is not in `shown` is hidden. */
  only?: boolean;
  /** Text under the picture. */
  caption?: string;
  /** Fields of the scene as TOML, by their names: `"1 rev/s e1∧e2"` by `initial.spin`. */
  fields?: Record<string, string>;
  /** Values of lines of the algebra page by their names. */
  values?: Record<string, string>;
}

/** The target of a link that drives the picture; null for other links. */
export function drives({ href }: Pick<Tokens.Link, "href">): string | null {
  return href.startsWith(DO) ? href.slice(DO.length) : null;
}

const DO = "#do:";
