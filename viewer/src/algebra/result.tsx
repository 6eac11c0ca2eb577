import type { Line } from "../core/core.ts";
import { significant } from "../format/numbers.ts";
import { kind, nonzeroGrades, terms } from "./notation.ts";

/** The value of a line, unless its text already shows it (`literal`); whether an equation holds; or the error. */
export function Result({ id, line, literal }: { id: string; line: Line; literal: boolean }) {
  const { problem, equation, value } = line;
  if (problem) {
    return (
      <p id={id} class="came problem">
        {problem.message}
      </p>
    );
  }
  if (equation) {
    const { holds, residual, size } = equation;
    const fails = `fails: residual ${significant(residual, 2)} for terms of size ${significant(size, 2)}`;
    return (
      <p
        id={id}
        class={holds ? "came holds" : "came fails"}
        title={`residual ${residual} for terms of size ${size}`}
      >
        <span class="tick" aria-hidden="true">
          {holds ? "✓" : "✗"}
        </span>
        {holds ? `holds, residual ${significant(residual, 2)}` : fails}
      </p>
    );
  }
  if (value && !literal && !line.text.includes(`= ${value.text}`)) {
    return (
      <p id={id} class="came" title={value.text}>
        <Value components={value.components} />
      </p>
    );
  }
  return null;
}

/** The kind of a value: an icon in its colour in the drawing, and the word. */
export function Kind({ line, tone }: { line: Line; tone: string | undefined }) {
  const { value, name, shown } = line;
  if (!value) return name !== null && shown !== null ? <span class="kind">function</span> : null;
  const what = kind(nonzeroGrades(value), value.rotor);
  const glyph = GLYPHS[what];
  const filled = what === "scalar";
  return (
    <span
      class="kind"
      title={`may have the grade${value.grades.length > 1 ? "s" : ""} ${value.grades.join(", ")}`}
    >
      {what}
      {glyph && (
        <svg viewBox="0 0 16 16" aria-hidden="true" style={tone && { color: tone }}>
          <path d={glyph} fill={filled ? "currentColor" : "none"} stroke="currentColor" stroke-width="1.5" />
        </svg>
      )}
    </span>
  );
}

/** `2 e₁ − 3 e₂∧e₃`, with vectors in italics. */
function Value({ components }: { components: readonly number[] }) {
  const all = terms(components);
  if (all.length === 0) return <span class="value">= 0</span>;
  return (
    <span class="value">
      {"= "}
      {all.map(({ negative, size, blade }, k) => (
        <>
          {k > 0 && " "}
          <span class="term">
            {k === 0 ? negative && "−" : negative ? "− " : "+ "}
            {size}
            {size && blade && "\u2009"}
            <Blade blade={blade} />
          </span>
        </>
      ))}
    </span>
  );
}

function Blade({ blade }: { blade: string }) {
  if (blade === "I") return <i>I</i>;
  return (
    <>
      {[...blade].map((index, k) => (
        <>
          {k > 0 && "∧"}
          <i>e</i>
          <sub>{index}</sub>
        </>
      ))}
    </>
  );
}

const GLYPHS: Record<string, string> = {
  scalar: "M8 6.6a1.4 1.4 0 1 0 .01 0z",
  vector: "M3 13 12 4M12 4H7.2M12 4v4.8",
  bivector: "M2.5 12.5 6 4.5h8l-3.5 8z",
  trivector: "M2.5 6v7.5H10V6zM2.5 6 6 3h7.5L10 6M13.5 3v7.5L10 13.5",
  rotor: "M13 11A5.5 5.5 0 1 1 11.5 4M11.8 1v3.4H8.4",
};
