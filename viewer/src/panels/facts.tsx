import type { ComponentChildren } from "preact";
import type { About, Triple } from "../core/core.ts";
import { significant, small } from "../format/numbers.ts";
import { DEGREE, duration } from "../format/units.ts";
import type { Model } from "../model/model.ts";

/** Properties of the whole motion: regime, laws, periods, and accuracy. */
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
          <Fact name={LAWS[law.name] ?? law.name} key={law.name}>
            <code>
              {about.heavy && HEAVY.has(law.name) ? `m g l = ${weight(about.heavy)}` : shortened(law.text)}
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
        <Fact name="Method">{methodOf(about)}</Fact>
      </dl>
      <Conserved about={about} />
    </>
  );
}

/** Labels of the laws by their names in scenes. */
export const LAWS: Record<string, string> = {
  gravity: "Gravity",
  heavy: "Gravity",
  damping: "Damping",
  viscous_damping: "Viscous damping",
  quadratic_damping: "Quadratic damping",
  gravity_gradient: "Gravity gradient",
  magnetic: "Magnetic dipole",
  torsion_spring: "Torsion spring",
  pd_control: "PD control",
  gyrostat: "Wheel",
  larmor: "Larmor",
  constant_body: "Constant in the body",
  constant_space: "Constant in space",
  tabulated: "Table",
  torque_body: "Torque, in the body",
  torque_space: "Torque, in space",
};

const HEAVY = new Set(["gravity", "heavy"]);

/** The vector m g l, in N m. */
function weight(heavy: Triple): string {
  const parts = heavy.map((part) => significant(part, 5));
  return `(${parts.join(", ")}) N m`;
}

function Times({ free }: { free: NonNullable<About["free"]> }) {
  return (
    <>
      {free.period !== null && <Fact name="Period of Ω">{duration(free.period, 7)}</Fact>}
      {free.flip_time !== null && <Fact name="Flip period">{duration(free.flip_time, 7)}</Fact>}
      {free.precession_period !== null && (
        <Fact name="Precession">{duration(free.precession_period, 7)} per turn about L</Fact>
      )}
      {free.modulus > 0 && <Fact name="Modulus k">{significant(free.modulus, 7)}</Fact>}
    </>
  );
}

/** Nutation and precession of a heavy top, and whether it is stable upright. */
function Top({ top }: { top: NonNullable<About["top"]> }) {
  const [least, most] = top.tilt.map((angle) => significant(angle / DEGREE.size, 5));
  const turn = top.precession_rate && (2 * Math.PI) / Math.abs(top.precession_rate);
  return (
    <>
      <Fact name="Tilt from vertical">{least === most ? `${least}°` : `${least}° to ${most}°`}</Fact>
      {top.nutation_period !== null && <Fact name="Nutation period">{duration(top.nutation_period, 7)}</Fact>}
      {turn !== null && turn !== 0 && (
        <Fact name="Precession">{duration(turn, 7)} per turn about e₃, on average</Fact>
      )}
      <Fact name="Upright">
        {top.sleeps ? "stable" : "unstable"}; stable from a spin of {significant(top.critical_spin, 5)} rad/s
        on
      </Fact>
    </>
  );
}

/** The regime of the motion in words; empty if it has no name. */
export function regimeOf(about: About | null): string {
  return about?.free?.regime ?? about?.top?.regime ?? "";
}

/** The principal axis that Ω circles. */
function circled(moments: Triple, axis: 1 | 2 | 3): string {
  const which = moments[axis - 1] === Math.max(...moments) ? "largest" : "smallest";
  return `: Ω circles axis ${axis}, which has the ${which} moment`;
}

/** The arguments of a law, rounded; a formula is left as it is. */
function shortened(text: string): string {
  if (/[^-+\d.e(), ]/.test(text)) return text;
  return text.replace(/\d[\d.]*(e[-+]?\d+)?/g, (number) => significant(Number(number), 5));
}

/** The method and its error estimate in words. */
export function methodOf(about: About): string {
  if (about.exact) return "exact, in closed form";
  if (about.method === "recorded") return "recorded, interpolated between rows";
  const steps = `${about.method}, ${about.steps.toLocaleString("en")} steps`;
  return about.error_estimate === null ? steps : `${steps}, error about ${small(about.error_estimate)}`;
}

function Conserved({ about }: { about: About }) {
  return (
    <table class="conserved">
      <thead>
        <tr>
          <th scope="col">Conserved</th>
          <th scope="col">Value, SI</th>
          <th scope="col">Drift</th>
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
