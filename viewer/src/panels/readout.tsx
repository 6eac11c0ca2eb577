import { useComputed } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { hasMass, sizeAt, State } from "../core/core.ts";
import { PLANES, type Scale, scaled, scaleFor, significant, small } from "../format/numbers.ts";
import { Defined } from "../glossary/term.tsx";
import type { Model } from "../model/model.ts";
import { firstRow } from "../model/speed.ts";

const ROTOR: Scale = { factor: 1, decimals: 4, width: 6, power: "" };

/** The state at the time shown. */
export function Readout({ model }: { model: Model }) {
  // Scales follow from the initial state, so that digits keep their places while values change.
  const start = useComputed(() => model.motion.value && firstRow(model.motion.value));
  const row = model.row.value;
  const first = start.value;
  const about = model.about.value;
  if (!row || !first || !about) return null;
  const bivector = (sub: string, at: number, size: number, unit: string, note: string, mark: string) => {
    const scale = scaleFor(size);
    const symbol = mark === "omega" ? <Symbol name="Ω" sub={sub} /> : <Symbol name="L" />;
    return (
      <Quantity symbol={symbol} note={note} unit={scale.power + unit} mark={mark}>
        <Terms values={row.subarray(at, at + 3)} blades={PLANES} scale={scale} />
      </Quantity>
    );
  };
  const omega = sizeAt(first, State.omegaBody);
  const momentum = sizeAt(first, State.momentumSpace);
  const ofMass = (unit: string) => (hasMass(about) ? unit : "");
  const drifts = new Map(about.conserved.map(({ name, drift }) => [name, drift]));
  return (
    <>
      <dl class="readout">
        <Quantity symbol={<Symbol name="R" />} note="attitude, body to space" unit="">
          <Terms values={row.subarray(State.rotor, State.rotor + 4)} blades={["", ...PLANES]} scale={ROTOR} />
        </Quantity>
        {bivector("B", State.omegaBody, omega, "rad/s", "angular velocity, body axes", "omega")}
        {bivector("S", State.omegaSpace, omega, "rad/s", "angular velocity, space axes", "omega")}
        {bivector(
          "",
          State.momentumSpace,
          momentum,
          ofMass("kg m²/s"),
          "angular momentum, space axes",
          "momentum",
        )}
      </dl>
      <dl class="readout pair">
        <Quantity
          symbol={
            <span>
              |<Symbol name="L" />|
            </span>
          }
          unit={ofMass("kg m²/s")}
        >
          <Value
            value={sizeAt(row, State.momentumSpace)}
            start={momentum}
            drift={drifts.get("angular_momentum")}
          />
        </Quantity>
        <Quantity symbol={<Symbol name="E" />} unit={ofMass("J")}>
          <Value value={row[State.energy]!} start={first[State.energy]!} drift={drifts.get("energy")} />
        </Quantity>
      </dl>
    </>
  );
}

/** A number, with the drift of the motion if it is conserved, and otherwise with its change since the start. */
function Value({ value, start, drift }: { value: number; start: number; drift: number | undefined }) {
  const change = value - start;
  const since = `${change > 0 ? "+" : ""}${significant(change, 3)} since the start`;
  return (
    <>
      <span class="digits">{significant(value, 7)}</span>
      <span class="note"> {drift === undefined ? since : `drift ${small(drift)}`}</span>
    </>
  );
}

/** A sum of blades, `3.1 e₂∧e₃ + 0.2 e₃∧e₁ − 1.0 e₁∧e₂`, in which each digit keeps its place. */
function Terms({ values, blades, scale }: { values: ArrayLike<number>; blades: string[]; scale: Scale }) {
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
function Symbol({ name, sub }: { name: string; sub?: string }) {
  return (
    <i class="symbol">
      {name}
      {sub && <sub>{sub}</sub>}
    </i>
  );
}

/** The symbol, description and unit of a quantity, and its value below. */
function Quantity(props: {
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
        {props.symbol} <span class="note">{props.note && <Defined text={props.note} />}</span>
        <span class="unit">{props.unit}</span>
      </dt>
      <dd>{props.children}</dd>
    </div>
  );
}
