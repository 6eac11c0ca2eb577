import { useComputed } from "@preact/signals";
import { State } from "../core/core.ts";
import { firstRow, type Model } from "../model/model.ts";
import { BLADES, Quantity, Symbol, Terms } from "./bivector.tsx";
import { type Scale, scaleFor, significant, small } from "./format.ts";

const ROTOR: Scale = { factor: 1, decimals: 4, width: 6, power: "" };

/** What the state is at the time shown. */
export function Readout({ model }: { model: Model }) {
  // The scales are those of the start, so that digits keep their places while they change.
  const start = useComputed(() => model.motion.value && firstRow(model.motion.value));
  const row = model.row.value;
  const first = start.value;
  if (!row || !first) return null;
  const three = (at: number) => row.subarray(at, at + 3);
  const omega = scaleFor(length(first, State.omegaBody));
  const momentum = scaleFor(length(first, State.momentumSpace));
  const energy = row[State.energy]!;
  const size = length(row, State.momentumSpace);
  return (
    <>
      <dl class="readout">
        <Quantity symbol={<Symbol name="R" />} note="attitude, body to space" unit="">
          <Terms values={row.subarray(State.rotor, State.rotor + 4)} blades={["", ...BLADES]} scale={ROTOR} />
        </Quantity>
        <Quantity
          symbol={<Symbol name="Ω" sub="B" />}
          note="angular velocity, in the body"
          unit={`${omega.power}rad/s`}
          mark="omega"
        >
          <Terms values={three(State.omegaBody)} blades={BLADES} scale={omega} />
        </Quantity>
        <Quantity
          symbol={<Symbol name="Ω" sub="S" />}
          note="the same, in space"
          unit={`${omega.power}rad/s`}
          mark="omega"
        >
          <Terms values={three(State.omegaSpace)} blades={BLADES} scale={omega} />
        </Quantity>
        <Quantity
          symbol={<Symbol name="L" />}
          note="angular momentum, in space"
          unit={`${momentum.power}kg m²/s`}
          mark="momentum"
        >
          <Terms values={three(State.momentumSpace)} blades={BLADES} scale={momentum} />
        </Quantity>
      </dl>
      <dl class="readout pair">
        <Quantity
          symbol={
            <span>
              |<Symbol name="L" />|
            </span>
          }
          note=""
          unit="kg m²/s"
        >
          <Number value={size} start={length(first, State.momentumSpace)} />
        </Quantity>
        <Quantity symbol={<Symbol name="E" />} note="" unit="J">
          <Number value={energy} start={first[State.energy]!} />
        </Quantity>
      </dl>
    </>
  );
}

/** A number, and by how much of itself it has changed since the start. */
function Number({ value, start }: { value: number; start: number }) {
  const change = Math.abs(value / start - 1);
  const told = change > 1e-3 ? `${significant(value / start, 4)} of the start` : `drift ${small(change)}`;
  return (
    <>
      <span class="digits">{significant(value, 7)}</span>
      {start !== 0 && <span class="note"> {told}</span>}
    </>
  );
}

function length(row: Float64Array, at: number): number {
  return Math.hypot(row[at]!, row[at + 1]!, row[at + 2]!);
}
