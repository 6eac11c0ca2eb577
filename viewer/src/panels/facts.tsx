import type { ComponentChildren } from "preact";
import type { About, LawEntry, Triple } from "../core/core.ts";
import type { Model } from "../model/model.ts";
import { significant, small } from "./format.ts";
import { HOLDING } from "../vary/laws.ts";
import { DEGREE, duration } from "./units.ts";

/** What is known of the motion as a whole: its kind, its times, and how far to trust it. */
export function Facts({ model }: { model: Model }) {
  const about = model.about.value;
  if (!about) return null;
  const { free } = about;
  return (
    <>
      <dl class="facts">
        {free && (
          <Fact name="Regime" id="regime">
            {free.regime}
            {free.period !== null && circled(about.body.moments, free.axis)}
          </Fact>
        )}
        {about.top && (
          <Fact name="Regime" id="regime">
            {about.top.regime}
          </Fact>
        )}
        {about.laws.map((law) => (
          <Fact name={labelOf(law.name, model.core.laws)} key={law.name}>
            <code>
              {about.heavy && HOLDING.has(law.name) ? `m g l = ${weight(about.heavy)}` : shortened(law.text)}
            </code>
          </Fact>
        ))}
        {free && <Times free={free} />}
        {about.top && <Top top={about.top} />}
        <Fact name="Moments">
          <span class="digits">{about.body.moments.map((moment) => significant(moment, 5)).join(", ")}</span>{" "}
          kg m²
          {about.held && " about the fixed point"}
        </Fact>
        {about.body.mass !== null && <Fact name="Mass">{significant(about.body.mass, 5)} kg</Fact>}
        {about.ensemble !== null && <Fact name="Bodies">{about.ensemble.toLocaleString("en")}</Fact>}
        <Fact name="Method">{trust(about)}</Fact>
      </dl>
      <Conserved about={about} />
    </>
  );
}

/** The label of a law by its name in the scene; `registry` has those of the torque laws with arguments. */
export function labelOf(name: string, registry: readonly LawEntry[]): string {
  const others: Record<string, string> = {
    gravity: "Gravity",
    torque_body: "Torque, in the body",
    torque_space: "Torque, in space",
  };
  return registry.find((law) => law.name === name)?.label ?? others[name] ?? name;
}

/** The vector m g l, in N m. */
function weight(heavy: Triple): string {
  const parts = heavy.map((part) => significant(part, 5));
  return `(${parts.join(", ")}) N m`;
}

function Times({ free }: { free: NonNullable<About["free"]> }) {
  return (
    <>
      {free.period !== null && <Fact name="Period of Ω">{duration(free.period, 7)}</Fact>}
      {free.flip_time !== null && <Fact name="From flip to flip">{duration(free.flip_time, 7)}</Fact>}
      {free.precession_period !== null && (
        <Fact name="Precession">{duration(free.precession_period, 7)} for a turn about L</Fact>
      )}
      {free.modulus > 0 && <Fact name="Modulus k">{significant(free.modulus, 7)}</Fact>}
    </>
  );
}

/** How a heavy top goes round, and whether it would sleep. */
function Top({ top }: { top: NonNullable<About["top"]> }) {
  const [least, most] = top.tilt.map((angle) => significant(angle / DEGREE.size, 5));
  const turn = top.precession_rate && (2 * Math.PI) / Math.abs(top.precession_rate);
  return (
    <>
      <Fact name="Tilt from up">{least === most ? `${least}°` : `${least}° to ${most}°`}</Fact>
      {top.nutation_period !== null && (
        <Fact name="Nutation">{duration(top.nutation_period, 7)} from low to low</Fact>
      )}
      {turn !== null && turn !== 0 && (
        <Fact name="Precession">{duration(turn, 7)} for a turn about e₃, on average</Fact>
      )}
      <Fact name="Upright">
        {top.sleeps ? "stable" : "not stable"} with this spin; it sleeps from{" "}
        {significant(top.critical_spin, 5)} rad/s on
      </Fact>
    </>
  );
}

/** What kind of motion it is, in words; empty where none has a name. */
export function regimeOf(about: About | null): string {
  return about?.free?.regime ?? about?.top?.regime ?? "";
}

/** Which axis Ω circles. */
function circled(moments: Triple, axis: 1 | 2 | 3): string {
  const which = moments[axis - 1] === Math.max(...moments) ? "largest" : "smallest";
  return `: Ω circles axis ${axis}, that of the ${which} moment`;
}

/** The numbers of a law with some digits; a formula as it stands. */
function shortened(text: string): string {
  if (/[^-+\d.e(), ]/.test(text)) return text;
  return text.replace(/\d[\d.]*(e[-+]?\d+)?/g, (number) => significant(Number(number), 5));
}

/** How the motion was found, and how far it may be off. */
export function trust(about: About): string {
  if (about.exact) return "exact, in closed form";
  if (about.method === "recorded") return "recorded, interpolated for the picture";
  const steps = `${about.method}, ${about.steps.toLocaleString("en")} steps`;
  return about.error_estimate === null ? steps : `${steps}, error about ${small(about.error_estimate)}`;
}

function Conserved({ about }: { about: About }) {
  return (
    <table class="conserved">
      <thead>
        <tr>
          <th scope="col">Conserved</th>
          <th scope="col">value, SI</th>
          <th scope="col">drift</th>
        </tr>
      </thead>
      <tbody>
        {about.conserved.map(({ name, value, drift }) => (
          <tr key={name}>
            <th scope="row">{name.replaceAll("_", " ")}</th>
            <td class="digits">{significant(value, 7)}</td>
            <td class="digits">{small(drift)}</td>
          </tr>
        ))}
        <tr>
          <th scope="row">|R| − 1</th>
          <td class="digits">0</td>
          <td class="digits">{small(about.norm_drift)}</td>
        </tr>
      </tbody>
    </table>
  );
}

function Fact({ name, id, children }: { name: string; id?: string; children: ComponentChildren }) {
  return (
    <div class="fact">
      <dt>{name}</dt>
      <dd {...(id ? { id } : {})}>{children}</dd>
    </div>
  );
}
