import text from "../../../docs/glossary.md?raw";

/** A term of docs/glossary.md. */
export interface Definition {
  /** As in its heading, in small letters unless it is a name. */
  term: string;
  /** Other words for it, such as its plural. */
  also: string[];
  text: string;
}

/** The terms by all their words, in small letters. */
export const GLOSSARY: ReadonlyMap<string, Definition> = parsed(text);

/** Each term once. */
export const DEFINITIONS: readonly Definition[] = [...new Set(GLOSSARY.values())];

/** The id of the element that holds the definition of a term, for screen readers. */
export function idOf(term: string): string {
  return `definition-${term.toLowerCase().replaceAll(/[^\p{L}]+/gu, "-")}`;
}

/** A piece of a text: a word of the glossary with its term, or what is between. */
export interface Piece {
  text: string;
  term: string | null;
}

/** Splits a text at the terms in it; each is found once. */
export function split(text: string): Piece[] {
  const pieces: Piece[] = [];
  const seen = new Set<string>();
  let end = 0;
  for (const { 0: word, index } of text.matchAll(WORDS)) {
    const { term } = GLOSSARY.get(word.toLowerCase())!;
    if (seen.has(term)) continue;
    seen.add(term);
    if (index > end) pieces.push({ text: text.slice(end, index), term: null });
    pieces.push({ text: word, term });
    end = index + word.length;
  }
  if (end < text.length) pieces.push({ text: text.slice(end), term: null });
  return pieces;
}

/** Each term is a heading `## …`; a comment `also: …` has its other words, separated by commas. */
function parsed(text: string): Map<string, Definition> {
  const found = new Map<string, Definition>();
  for (const section of text.split(/^## /mu).slice(1)) {
    const [heading, ...lines] = section.split("\n");
    const body = lines.join("\n");
    const also =
      /<!--\s*also:(.*?)-->/su
        .exec(body)?.[1]
        ?.split(",")
        .map((word) => word.trim()) ?? [];
    const definition = {
      term: heading!.trim().toLowerCase(),
      also,
      text: body
        .replaceAll(/<!--.*?-->/gsu, "")
        .trim()
        .replaceAll(/\s+/gu, " "),
    };
    for (const word of [definition.term, ...also]) found.set(word.toLowerCase(), definition);
  }
  return found;
}

/** Longer words first, so that a word is not found inside another term. */
const WORDS = new RegExp(
  `(?<![\\p{L}-])(?:${[...GLOSSARY.keys()].sort((a, b) => b.length - a.length).join("|")})(?![\\p{L}-])`,
  "giu",
);
