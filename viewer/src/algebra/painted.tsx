import type { ComponentChildren } from "preact";
import type { Line } from "../core/core.ts";

const WORD = /[\p{L}][\p{L}\p{M}\d₀-₉_'′∥⊥]*/gu;

/** The text of a line, its names in the colours of their things, its comment pale, and its mistake marked. */
export function painted(line: Line, colourOf: (name: string) => string | undefined): ComponentChildren[] {
  const { text, problem } = line;
  const comment = text.indexOf("#") < 0 ? text.length : text.indexOf("#");
  const parts: ComponentChildren[] = [];
  let at = 0;
  /** Up to a place, in a style; a mistake goes through. */
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
  // What is missing at the end is marked behind it.
  if (problem && problem.start >= text.trimEnd().length) parts.push(<span class="mistake"> </span>);
  // An empty line is as high as others.
  parts.push("\u200b");
  return parts;
}

/** The usual spelling of a name, as the core has it. */
function canonical(name: string): string {
  return name
    .replace(/[₀-₉]/gu, (digit) => String("₀₁₂₃₄₅₆₇₈₉".indexOf(digit)))
    .replace(/_(\d)/gu, "$1")
    .replace(/′/gu, "'");
}
