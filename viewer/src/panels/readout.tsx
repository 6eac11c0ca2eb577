import { useComputed } from "@preact/signals";
import { State } from "../core/core.ts";
import { PLANES, type Scale, scaleFor, significant, small } from "../format/numbers.ts";
import { firstRow, type Model } from "../model/model.ts";
import { Quantity, Symbol, Terms } from "./quantity.tsx";

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
  const omega = length(first, State.omegaBody);
  const momentum = length(first, State.momentumSpace);
  const drifts = new Map(about.conserved.map(({ name, drift }) => [name, drift]));
  return (
    <>
      <dl class="readout">
        <Quantity symbol={<Symbol name="R" />} note="attitude, body to space" unit="">
          <Terms values={row.subarray(State.rotor, State.rotor + 4)} blades={["", ...PLANES]} scale={ROTOR} />
        </Quantity>
        {bivector("B", State.omegaBody, omega, "rad/s", "angular velocity, body axes", "omega")}
        {bivector("S", State.omegaSpace, omega, "rad/s", "angular velocity, space axes", "omega")}
        {bivector("", State.momentumSpace, momentum, "kg m²/s", "angular momentum, space axes", "momentum")}
      </dl>
      <dl class="readout pair">
        <Quantity
          symbol={
            <span>
              |<Symbol name="L" />|
            </span>
          }
          unit="kg m²/s"
        >
          <Value
            value={length(row, State.momentumSpace)}
            start={momentum}
            drift={drifts.get("angular_momentum")}
          />
        </Quantity>
        <Quantity symbol={<Symbol name="E" />} unit="J">
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

function length(row: Float64Array, at: number): number {
  return Math.hypot(row[at]!, row[at + 1]!, row[at + 2]!);
}
