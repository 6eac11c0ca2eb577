import type { ComponentChildren } from "preact";
import { type About, hasMass, type LawArgument, type LawEntry, type Triple } from "../core/core.ts";
import { significant, small } from "../format/numbers.ts";
import { DEGREE, duration, unitLabel } from "../format/units.ts";
import { Defined, Term } from "../glossary/term.tsx";
import { axisNames, ordered } from "../stage/axes.ts";
import type { Model } from "../model/model.ts";
import { cloudOf } from "../vary/cloud.ts";
import { HOLDING } from "../vary/laws.ts";
import { Details } from "./details.tsx";
import { inWords, regimeOf } from "./regime.ts";

type Fact = [name: string, value: ComponentChildren, id?: string];

/** Properties of the whole motion: what happens in words, and in the details regime, laws, periods, and accuracy. */
export function Facts({ model, wide }: { model: Model; wide: boolean }) {
  const about = model.about.value;
  if (!about) return null;
  const { body, free, top } = about;
  const regime = regimeOf(about);
  const circles = free && free.period !== null && circled(body.moments, free.axis);
  const facts: Fact[] = [
    ["Regime", regime && <Defined text={`${regime}${circles || ""}`} />, "regime"],
    ...about.laws.map(({ name, text }): Fact => {
      const weight = about.heavy && HOLDING.has(name) && `m g l = (${list(about.heavy)}) N m`;
      return [
        labelOf(name, model.core.laws),
        <code>{weight || described(name, text, model.core.laws, hasMass(about))}</code>,
      ];
    }),
    ...(free ? freeFacts(free) : []),
    ...(top ? topFacts(top) : []),
    [
      "Moments",
      `${namedMoments(body.moments)}${hasMass(about) ? ", kg m²" : ""}${about.held ? ", about the fixed point" : ""}`,
    ],
    ["Mass", body.mass !== null && `${significant(body.mass, 5)} kg`],
    ["Bodies", cloudOf(model.scene.value, about) ?? about.ensemble?.toLocaleString("en"), "cloud"],
    ["Not drawn", model.motion.value?.bodiesProblem],
    ["Method", methodOf(about)],
  ];
  return (
    <>
      <p class="happens">
        <Defined text={inWords(about, model.core.laws)} />
      </p>
      <Details wide={wide}>
        <dl class="facts">
          {facts.map(
            ([name, value, id], k) =>
              value && (
                <div class="fact" key={k}>
                  <dt>
                    {name === "Moments" ? (
                      <Term term="principal moments" text={name} />
                    ) : (
                      <Defined text={name} />
                    )}
                  </dt>
                  <dd id={id}>{value}</dd>
                </div>
              ),
          )}
        </dl>
        <Conserved about={about} />
      </Details>
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

/** Periods of a free body. */
function freeFacts({ period, flip_time, precession_period, modulus }: NonNullable<About["free"]>): Fact[] {
  return [
    ["Period of Ω", period !== null && duration(period, 7)],
    ["Flip period", flip_time !== null && duration(flip_time, 7)],
    ["Precession", precession_period !== null && `${duration(precession_period, 7)} per turn about L`],
    ["Modulus k", modulus > 0 && significant(modulus, 7)],
  ];
}

/** Nutation and precession of a heavy top, and whether it is stable upright. */
function topFacts({ tilt, nutation_period, precession_rate, ...top }: NonNullable<About["top"]>): Fact[] {
  const [least, most] = tilt.map((angle) => significant(angle / DEGREE.size, 5));
  const turn = precession_rate && (2 * Math.PI) / Math.abs(precession_rate);
  const stable = top.sleeps ? "stable" : "unstable";
  return [
    ["Tilt from vertical", least === most ? `${least}°` : `${least}° to ${most}°`],
    ["Nutation period", nutation_period !== null && duration(nutation_period, 7)],
    ["Precession", turn && `${duration(turn, 7)} per turn about e₃, on average`],
    ["Upright", `${stable}; stable from a spin of ${significant(top.critical_spin, 5)} rad/s on`],
  ];
}

/** The principal axis that Ω circles. */
function circled(moments: Triple, axis: 1 | 2 | 3): string {
  const name = axisNames(moments)[axis - 1]!;
  return name.includes("axis") ? `: Ω circles the ${name}` : `: Ω circles the axis of the ${name} moment`;
}

/** The principal moments from the smallest to the largest, each with the name of its axis. */
function namedMoments(moments: Triple): string {
  const names = axisNames(moments);
  const alike = (a: number, b: number) => names[a] === names[b] && names[a] !== "";
  const listed = ordered(moments).filter((k, at, all) => at === 0 || !alike(k, all[at - 1]!));
  return listed.map((k) => `${significant(moments[k]!, 5)} (${names[k]})`).join(", ");
}

function list(numbers: readonly number[]): string {
  return numbers.map((number) => significant(number, 5)).join(", ");
}

const NUMBER = /-?\d[\d.]*(e[-+]?\d+)?/g;

/** How many numbers an argument of a law has, by its shape. */
const COUNTS: Partial<Record<LawArgument["shape"], number>> = {
  scalar: 1,
  vector: 3,
  bivector: 3,
  gains: 3,
  rotor: 4,
};

/**
 * The arguments of a law, rounded, with their names in `registry`; a formula is left as it is. Units of mass and force are left
 * out unless the mass is known.
 */
function described(name: string, text: string, registry: readonly LawEntry[], massive: boolean): string {
  if (/[^-+\d.e(), ]/.test(text)) return text;
  const numbers = [...text.matchAll(NUMBER)].map(([number]) => Number(number));
  const argued = registry.find((law) => law.name === name)?.arguments ?? [];
  const counts = argued.map(({ shape }) => COUNTS[shape] ?? Number.NaN);
  if (counts.reduce((sum, count) => sum + count, 0) !== numbers.length)
    return text.replace(NUMBER, (number) => significant(Number(number), 5));
  return argued
    .map((argument, k) => {
      const own = numbers.splice(0, counts[k]);
      const value = own.length === 1 ? list(own) : `(${list(own)})`;
      const unit =
        (massive || !/kg|N/.test(argument.unit)) && argument.unit && `\u00a0${unitLabel(argument.unit)}`;
      return `${argument.name.replaceAll("_", " ")} = ${value}${unit || ""}`;
    })
    .join(", ");
}

/** The method and its error estimate in words. */
export function methodOf(about: About): string {
  if (about.exact) return "exact, in closed form";
  if (about.method === "recorded") return "recorded, interpolated between rows";
  const steps = `${about.method}, ${about.steps.toLocaleString("en")} steps`;
  return about.error_estimate === null ? steps : `${steps}, error about ${small(about.error_estimate)}`;
}

function Conserved({ about }: { about: About }) {
  const rows = about.conserved.map(({ name, value, drift }) => ({
    name: name.replaceAll("_", " ").replace("jacobi", "Jacobi"),
    value: significant(value, 7),
    drift,
  }));
  return (
    <table class="conserved">
      <thead>
        <tr>
          <th scope="col">
            <Term term="conserved" text="Conserved" />
          </th>
          <th scope="col">{hasMass(about) ? "Value, SI" : "Value"}</th>
          <th scope="col">Drift</th>
        </tr>
      </thead>
      <tbody>
        {[...rows, { name: "|R| − 1", value: "0", drift: about.norm_drift }].map(({ name, value, drift }) => (
          <tr key={name}>
            <th scope="row">
              <Defined text={name} />
            </th>
            <td class="digits">{value}</td>
            <td class="digits">{small(drift)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
