import type { ComponentChildren } from "preact";
import type { Line } from "../core/core.ts";

const WORD = /[\p{L}][\p{L}\p{M}\d₀-₉_'′∥⊥]*/gu;

/** The text of a line with names in the colours of the drawing, a pale comment, and the error marked. */
export function highlighted(line: Line, colourOf: (name: string) => string | undefined): ComponentChildren[] {
  const { text, problem } = line;
  const comment = text.indexOf("#") < 0 ? text.length : text.indexOf("#");
  const parts: ComponentChildren[] = [];
  let at = 0;
  /** Adds the text up to a position in a style; the mark of the error may cross its ends. */
  const until = (end: number, style?: { class?: string; colour?: string | undefined }): void => {
    const cuts = problem ? [problem.start, problem.end].filter((cut) => cut > at && cut < end) : [];
    for (const cut of [...cuts, end]) {
      if (cut === at) continue;
      const wrong = problem && at >= problem.start && at < problem.end ? "mistake" : "";
      const classes = [style?.class, wrong].filter(Boolean).join(" ");
      parts.push(
        <span class={classes || undefined} style={style?.colour && { color: style.colour }}>
          {text.slice(at, cut)}
        </span>,
      );
      at = cut;
    }
  };
  for (const found of text.slice(0, comment).matchAll(WORD)) {
    const colour = colourOf(canonical(found[0]));
    if (!colour) continue;
    until(found.index);
    until(found.index + found[0].length, { colour });
  }
  until(comment);
  until(text.length, { class: "comment" });
  // An error at the end of the line is marked after it.
  if (problem && problem.start >= text.trimEnd().length) parts.push(<span class="mistake"> </span>);
  // Gives an empty line the height of the others.
  parts.push("\u200b");
  return parts;
}

/** The canonical spelling of a name, as in the core. */
function canonical(name: string): string {
  return name
    .replace(/[₀-₉]/gu, (digit) => String("₀₁₂₃₄₅₆₇₈₉".indexOf(digit)))
    .replace(/_(\d)/gu, "$1")
    .replace(/′/gu, "'");
}
