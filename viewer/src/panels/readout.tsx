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
  const about = model.about.value;
  if (!row || !first || !about) return null;
  const conserved = new Set(about.conserved.map(({ name }) => name));
  const three = (at: number) => row.subarray(at, at + 3);
  const omega = scaleFor(length(first, State.omegaBody));
  const momentum = scaleFor(length(first, State.momentumSpace));
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
          <Number
            value={length(row, State.momentumSpace)}
            start={length(first, State.momentumSpace)}
            scale={length(first, State.momentumSpace)}
            conserved={conserved.has("angular_momentum")}
          />
        </Quantity>
        <Quantity symbol={<Symbol name="E" />} note="" unit="J">
          <Number
            value={row[State.energy]!}
            start={first[State.energy]!}
            scale={energyScale(first)}
            conserved={conserved.has("energy")}
          />
        </Quantity>
      </dl>
    </>
  );
}

/** A number, and its change since the start: a drift, relative to `scale`, only where the motion conserves it. */
function Number(props: { value: number; start: number; scale: number; conserved: boolean }) {
  const { value, start, scale, conserved } = props;
  const change = value - start;
  const drift = scale > 0 && `drift ${small(Math.abs(change) / scale)}`;
  const since = `${change > 0 ? "+" : ""}${significant(change, 3)} since t = 0`;
  return (
    <>
      <span class="digits">{significant(value, 7)}</span>
      <span class="note"> {conserved ? drift : since}</span>
    </>
  );
}

/** What an energy is compared with, which may be near 0 itself: its kinetic part, if that is larger. */
function energyScale(row: Float64Array): number {
  const kinetic = [0, 1, 2].reduce(
    (sum, k) => sum + row[State.omegaBody + k]! * row[State.momentumBody + k]!,
    0,
  );
  return Math.max(Math.abs(row[State.energy]!), kinetic / 2);
}

function length(row: Float64Array, at: number): number {
  return Math.hypot(row[at]!, row[at + 1]!, row[at + 2]!);
}
