import { Lexer, type Token, type Tokens } from "marked";
import { type Files, Problem } from "../core/core.ts";
import type { Core } from "../core/wasm.ts";
import { words } from "../model/model.ts";
import { drives, type Lesson, type Question, type Settings, type Step, type Subject } from "./lesson.ts";
import { changed, quoted, settingsOf } from "./settings.ts";

/** A scene by its name: its text, and the files that it names. */
export type SceneNamed = (name: string) => { scene: string; name: string; files: Files } | null;

const FIELDS = ["title", "about", "scene"] as const;
/** What a lesson may contain besides text. */
const SAFE = ["space", "paragraph", "text", "list", "list_item", "strong", "em", "codespan", "link", "br"];
const ALLOWED = [...SAFE, "escape", "blockquote", "checkbox", "table", "hr", "del"];

/**
 * Parses a lesson. All of it is checked here; only scenes are solved later, when their step is shown. A Problem begins
 * with the file and the line, and says what to write.
 */
export function lessonOf(text: string, name: string, core: Core, scenes: SceneNamed): Lesson {
  return new Parser(text.replace(/\r\n?/gu, "\n"), name, core, scenes).lesson();
}

class Parser {
  private subject: Subject | null = null;
  private readonly steps: Step[] = [];

  constructor(
    private readonly text: string,
    private readonly name: string,
    private readonly core: Core,
    private readonly scenes: SceneNamed,
  ) {}

  lesson(): Lesson {
    const { fields, lines } = this.front();
    let line = lines + 1;
    const body = this.text.split("\n").slice(lines).join("\n");
    for (const token of new Lexer({ gfm: true }).lex(body)) {
      this.take(token, line);
      line += token.raw.split("\n").length - 1;
    }
    if (this.steps.length === 0)
      throw this.problem(line, "the lesson has no steps; begin each step with a heading `## …`");
    return {
      name: this.name,
      title: fields.get("title")!,
      about: fields.get("about") ?? "",
      steps: this.steps,
    };
  }

  /** The fields between `---` at the top, and the number of lines that they take. */
  private front(): { fields: Map<string, string>; lines: number } {
    const lines = this.text.split("\n");
    const end = lines.indexOf("---", 1);
    if (lines[0] !== "---" || end < 0) {
      const example = "---\ntitle: A title\nscene: t-handle\n---";
      throw this.problem(
        1,
        `a lesson begins with its title and scene between two lines \`---\`:\n${example}`,
      );
    }
    const fields = new Map<string, string>();
    lines.slice(1, end).forEach((written, k) => {
      const [, key, value] = /^(\w+):\s*(.*?)\s*$/u.exec(written) ?? [];
      if (written.trim() === "") return;
      if (key === undefined || !(FIELDS as readonly string[]).includes(key))
        throw this.problem(k + 2, `unknown field ${quoted(written)}; write \`${FIELDS.join(": …`, `")}: …\``);
      if (fields.has(key)) throw this.problem(k + 2, `a second field ${quoted(key)}; remove one of them`);
      fields.set(key, plain(value!));
      if (key === "scene") this.subject = this.named(plain(value!), k + 2);
    });
    if (!fields.get("title")) throw this.problem(1, "the lesson has no title; add a line `title: …`");
    return { fields, lines: end + 1 };
  }

  private named(name: string, line: number): Subject {
    const found = this.at(line, () => this.scenes(name));
    if (!found)
      throw this.problem(
        line,
        `unknown scene ${quoted(name)}; write the name of an example, such as t-handle, or of a file .toml beside ` +
          "the lesson, or write the scene in a code block ```toml",
      );
    return { kind: "scene", above: null, ...found };
  }

  private take(token: Token, line: number): void {
    if (token.type === "heading" && (token as Tokens.Heading).depth === 2) {
      this.begin((token as Tokens.Heading).text, line);
    } else if (token.type === "code") {
      this.code(token as Tokens.Code, line);
    } else if (token.type === "html") {
      this.comment(token.raw, line);
    } else if (token.type !== "space") {
      this.write(token, line);
    }
  }

  private begin(title: string, line: number): void {
    const subject = this.subject;
    // A scene may be given in the step.
    this.steps.push({ title, line, subject: subject!, text: [], set: {}, question: null });
  }

  /** The step that is being read. */
  private current(line: number): Step {
    const step = this.steps.at(-1);
    if (!step) throw this.problem(line, "text before the first step; begin each step with a heading `## …`");
    if (!step.subject)
      throw this.problem(
        line,
        "this step has nothing to show; give `scene: …` at the top, or a code block ```toml or ```ga before its text",
      );
    return step;
  }

  /** The scene, or the lines of formulas, of this step and those that follow. */
  private code({ lang, text }: Tokens.Code, line: number): void {
    if (lang !== "toml" && lang !== "ga")
      throw this.problem(
        line,
        `a code block is a scene (\`\`\`toml) or lines of formulas (\`\`\`ga), got \`\`\`${lang ?? ""}`,
      );
    const step = this.steps.at(-1);
    if (step && (step.text.length > 0 || Object.keys(step.set).length > 0))
      throw this.problem(line, "a code block must precede the settings and the text of its step; move it up");
    if (lang === "toml") {
      this.at(line, () => this.core.merged("\n".repeat(line) + text, ""));
      const files = this.scenes("")?.files ?? new Map();
      this.subject = { kind: "scene", scene: `${text}\n`, name: this.name, files, above: line };
    } else {
      const wrong = this.core.evaluated(text).findIndex(({ problem }) => problem !== null);
      const message = this.core.evaluated(text)[wrong]?.problem?.message;
      if (message !== undefined) throw this.problem(line + 1 + wrong, message);
      this.subject = { kind: "lines", lines: text };
    }
    if (step) step.subject = this.subject;
  }

  /** `<!-- do: … -->`, which a reader of the Markdown does not see. */
  private comment(raw: string, line: number): void {
    const [, text] = /^<!--\s*do:([\s\S]*?)-->\s*$/u.exec(raw) ?? [];
    if (text === undefined) {
      if (/^<!--[\s\S]*-->\s*$/u.test(raw)) return;
      throw this.problem(line, "a lesson shows no HTML; write Markdown, and settings as `<!-- do: … -->`");
    }
    const step = this.current(line);
    const set = this.settings(text.replaceAll("\n", " "), step, line);
    if (step.question) step.question.set = joined(step.question.set, set);
    else step.set = joined(step.set, set);
  }

  private write(token: Token, line: number): void {
    const step = this.current(line);
    this.check(token, token.raw, line, step);
    if (token.type === "list" && (token as Tokens.List).items.some(({ task }) => task)) {
      if (step.question) throw this.problem(line, "a second question in this step; begin a new step for it");
      step.question = this.question(token as Tokens.List, line);
    } else {
      (step.question ? step.question.answer : step.text).push(token);
    }
  }

  private question({ items }: Tokens.List, line: number): Question {
    const choices = items.map(({ checked, tokens }) => ({
      tokens: tokens.filter(({ type }) => type !== "checkbox"),
      right: checked === true,
    }));
    if (choices.length < 2 || !choices.some(({ right }) => right) || items.some(({ task }) => !task))
      throw this.problem(
        line,
        "a question needs at least two choices `- [ ] …`, of which the right ones are marked `- [x] …`",
      );
    return { choices, answer: [], set: {} };
  }

  /** Checks the parts of a token, and the target of each link. */
  private check(token: Token, whole: string, line: number, step: Step): void {
    const here = line + whole.slice(0, Math.max(whole.indexOf(token.raw), 0)).split("\n").length - 1;
    if (!ALLOWED.includes(token.type))
      throw this.problem(
        here,
        `a lesson cannot show this (${token.type}): ${quoted(token.raw.trim().slice(0, 40))}; write it as text`,
      );
    if (token.type === "link") {
      const target = drives(token as Tokens.Link);
      if (target !== null) this.settings(target, step, here);
      else if (!/^https?:\/\//u.test((token as Tokens.Link).href))
        throw this.problem(
          here,
          `unknown link ${quoted((token as Tokens.Link).href)}; write \`#do:\` and settings, or an address https://…`,
        );
    }
    for (const part of parts(token)) this.check(part, whole, line, step);
  }

  /** Settings that fit those of their step. */
  private settings(text: string, { subject, set }: Step, line: number): Settings {
    return this.at(line, () => {
      const found = settingsOf(text, subject, this.core);
      if (subject.kind === "scene") changed(subject.scene, joined(set, found).fields, this.core);
      return found;
    });
  }

  /** Runs a check; its Problem gets the place. */
  private at<T>(line: number, check: () => T): T {
    try {
      return check();
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      throw this.problem(line, words(error));
    }
  }

  private problem(line: number, message: string): Problem {
    return new Problem(`${this.name}:${line}: error: ${message}`);
  }
}

/** The text of a field, which has quotation marks if it contains a colon. */
export function plain(value: string): string {
  return value.replace(/^(["'])(.*)\1$/u, "$2");
}

/** The tokens inside a token. */
export function parts(token: Token): Token[] {
  if (token.type === "list") return (token as Tokens.List).items;
  if (token.type === "table") {
    const { header, rows } = token as Tokens.Table;
    return [...header, ...rows.flat()].flatMap((cell) => cell.tokens);
  }
  return (token as Tokens.Generic).tokens ?? [];
}

/** Settings, and those that follow them. */
export function joined(first: Settings, then: Settings): Settings {
  const both: Settings = { ...first, ...then };
  if (first.shown && then.shown && !then.only) both.shown = { ...first.shown, ...then.shown };
  if (first.fields && then.fields) both.fields = { ...first.fields, ...then.fields };
  if (first.values && then.values) both.values = { ...first.values, ...then.values };
  return both;
}
