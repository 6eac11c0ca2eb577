import { idOf, split } from "./glossary.ts";

/** A text in which the terms of the glossary have their definitions. */
export function Defined({ text }: { text: string }) {
  return (
    <>
      {split(text).map(({ text, term }) =>
        term === null ? text : <Term key={term} term={term} text={text} />,
      )}
    </>
  );
}

/** A term with its definition; it is broken across lines, which a button is not. */
export function Term({ term, text = term }: { term: string; text?: string }) {
  return (
    <span role="button" tabIndex={0} class="defined" data-term={term} aria-describedby={idOf(term)}>
      {text}
    </span>
  );
}
