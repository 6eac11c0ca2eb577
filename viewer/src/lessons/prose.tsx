import type { Token, Tokens } from "marked";
import type { ComponentChildren } from "preact";
import { Defined } from "../glossary/term.tsx";
import { drives } from "./lesson.ts";

/** The text of a lesson. `act` does what an underlined phrase says; `last` is the phrase that was pressed last. */
export function Prose(props: {
  tokens: readonly Token[];
  last: string | null;
  act: (target: string) => void;
  /** Whether terms have no definitions, as inside links and buttons. */
  plain?: boolean;
}) {
  const { tokens, last, act, plain = false } = props;
  const inside = (token: Token): ComponentChildren => {
    const { tokens: parts, text, type } = token as Tokens.Generic;
    const bare = plain || type === "link";
    if (parts) return <Prose tokens={parts} last={last} act={act} plain={bare} />;
    const written = unescaped(String(text ?? ""));
    return type === "text" && !bare ? <Defined text={written} /> : written;
  };
  return <>{tokens.map((token) => drawn(token, inside(token), props))}</>;
}

function drawn(
  token: Token,
  inside: ComponentChildren,
  { last, act }: { last: string | null; act: (target: string) => void },
): ComponentChildren {
  switch (token.type) {
    case "paragraph":
      return <p>{inside}</p>;
    case "strong":
      return <strong>{inside}</strong>;
    case "em":
      return <em>{inside}</em>;
    case "del":
      return <del>{inside}</del>;
    case "codespan":
      return <code>{inside}</code>;
    case "blockquote":
      return <blockquote>{inside}</blockquote>;
    case "br":
      return <br />;
    case "hr":
      return <hr />;
    case "list": {
      const { ordered, items } = token as Tokens.List;
      const rows = items.map(({ tokens }) => (
        <li>
          <Prose tokens={tokens} last={last} act={act} />
        </li>
      ));
      return ordered ? <ol>{rows}</ol> : <ul>{rows}</ul>;
    }
    case "table": {
      const { header, rows } = token as Tokens.Table;
      const row = (cells: Tokens.TableCell[], Cell: "th" | "td") => (
        <tr>
          {cells.map(({ tokens }) => (
            <Cell>
              <Prose tokens={tokens} last={last} act={act} />
            </Cell>
          ))}
        </tr>
      );
      return (
        <table>
          <thead>{row(header, "th")}</thead>
          <tbody>{rows.map((cells) => row(cells, "td"))}</tbody>
        </table>
      );
    }
    case "link": {
      const link = token as Tokens.Link;
      const target = drives(link);
      // A link is broken across lines, a button is not.
      if (target !== null)
        return (
          <a
            role="button"
            tabIndex={0}
            class={target === last ? "drive last" : "drive"}
            data-do={target}
            onClick={() => act(target)}
            onKeyDown={(event) => {
              if (event.key !== "Enter" && event.key !== " ") return;
              event.preventDefault();
              act(target);
            }}
          >
            {inside}
          </a>
        );
      return (
        <a href={link.href} target="_blank" rel="noopener noreferrer">
          {inside}
        </a>
      );
    }
    default:
      return inside;
  }
}

/** The lexer leaves entities such as `&amp;` as they are written. */
function unescaped(text: string): string {
  const entities: Record<string, string> = { amp: "&", lt: "<", gt: ">", quot: '"', nbsp: "\u00a0" };
  return text.replace(/&(\w+);/gu, (whole, name: string) => entities[name] ?? whole);
}
