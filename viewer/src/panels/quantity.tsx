import type { ComponentChildren } from "preact";
import { type Scale, scaled } from "../format/numbers.ts";

/** A sum of blades, `3.1 e₂∧e₃ + 0.2 e₃∧e₁ − 1.0 e₁∧e₂`, in which each digit keeps its place. */
export function Terms({
  values,
  blades,
  scale,
}: {
  values: ArrayLike<number>;
  blades: string[];
  scale: Scale;
}) {
  return (
    <span class="terms">
      {blades.map((blade, k) => {
        const { negative, digits } = scaled(values[k] ?? 0, scale);
        const sign = negative ? "−" : k > 0 ? "+" : "";
        return (
          <span class="term" key={blade}>
            <span class="sign">{sign}</span>
            <span class="digits">{digits}</span>
            {blade && <span class="blade">{` ${blade}`}</span>}
          </span>
        );
      })}
    </span>
  );
}

/** A symbol in italics with a subscript, such as Ω with B. */
export function Symbol({ name, sub }: { name: string; sub?: string }) {
  return (
    <i class="symbol">
      {name}
      {sub && <sub>{sub}</sub>}
    </i>
  );
}

/** The symbol, description and unit of a quantity, and its value below. */
export function Quantity(props: {
  symbol: ComponentChildren;
  note?: string;
  unit: string;
  mark?: string;
  children: ComponentChildren;
}) {
  return (
    <div class="quantity">
      <dt>
        {props.mark && <span class={`mark ${props.mark}`} aria-hidden="true" />}
        {props.symbol} <span class="note">{props.note}</span>
        <span class="unit">{props.unit}</span>
      </dt>
      <dd>{props.children}</dd>
    </div>
  );
}
