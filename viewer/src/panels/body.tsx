import type { Solid } from "../core/core.ts";
import { DENSITY, lengthUnit, massUnit, si } from "../format/units.ts";
import { Select, Slider } from "../inputs/fields.tsx";
import { around, type Range } from "../inputs/range.ts";
import { type BodyChoice, dimensions, isThin, reshaped, resized, sizeOf } from "../vary/body.ts";
import type { Controls } from "../vary/controls.ts";

/** Without the rod, which has no moment about its axis and so no definite rate about it. */
const FORMS: [form: string, label: string][] = [
  ["masses", "Second moments"],
  ["box", "Box"],
  ["ellipsoid", "Ellipsoid"],
  ["cylinder", "Cylinder"],
  ["disc", "Thin disc"],
  ["cone", "Cone"],
  ["capsule", "Capsule"],
  ["torus", "Torus"],
  ["sphere", "Sphere"],
  ["hollow_sphere", "Hollow sphere"],
];
const AMOUNTS = [
  ["mass", "mass"],
  ["density", "density"],
] as const;

/** kg/m³, from cork to gold. */
const DENSITIES: Range = { min: 100, max: 25_000, scale: "log" };

/** Controls of the body. */
export function BodyPanel({ controls }: { controls: Controls }) {
  const body = controls.body.value;
  const about = controls.about.value;
  if (!body || !about) return null;
  const { form, solid } = body;
  const { core, motion } = controls.model;
  return (
    <>
      <Select
        id="form"
        label="Form"
        value={form}
        options={about.body.solid ? FORMS : [["scene", "As in the scene"], ...FORMS]}
        disabled={!controls.free.value}
        onChange={(form) => controls.setBody(reshaped(body, form, core, motion.value!))}
      />
      {form === "masses" && <SecondMoments body={body} controls={controls} />}
      {form !== "masses" && form !== "scene" && solid && (
        <Sizes body={body} solid={solid} controls={controls} />
      )}
    </>
  );
}

function Sizes({ body, solid, controls }: { body: BodyChoice; solid: Solid; controls: Controls }) {
  const first = body.first ?? solid;
  return (
    <>
      {dimensions(solid).map(([name, label]) => (
        <Slider
          key={name}
          id={`size-${name.replaceAll(/[._]/g, "-")}`}
          label={label}
          value={sizeOf(solid, name)}
          range={around(sizeOf(first, name))}
          unit={lengthUnit(sizeOf(first, name))}
          onChange={(size) => controls.setBody({ ...body, solid: resized(solid, name, size) })}
        />
      ))}
      <Amount body={body} controls={controls} />
    </>
  );
}

function Amount({ body, controls }: { body: BodyChoice; controls: Controls }) {
  const { kind, value } = body.amount;
  const mass = controls.about.value?.body.mass ?? 1;
  const set = (amount: BodyChoice["amount"]) => controls.setBody({ ...body, amount });
  return (
    <>
      {!isThin(body.form) && (
        <Select
          id="amount"
          label="Given by"
          value={kind}
          options={AMOUNTS}
          onChange={(kind) => set({ kind, value: kind === "mass" ? mass : 1000 })}
        />
      )}
      <Slider
        id={kind}
        label={kind === "mass" ? "Mass" : "Density"}
        value={value}
        range={kind === "mass" ? around(mass, 20) : DENSITIES}
        unit={kind === "mass" ? massUnit(mass) : DENSITY}
        onChange={(value) => set({ kind, value })}
      />
    </>
  );
}

/** Sliders for ∫x_k² dm, each setting of which is a possible body. */
function SecondMoments({ body, controls }: { body: BodyChoice; controls: Controls }) {
  const about = controls.about.value!;
  const largest = Math.max(...about.body.moments);
  const range: Range = { min: 0, max: 1.5 * largest, scale: "linear" };
  return (
    <>
      <p class="note">
        The second moment ∫x² dm along each axis. A moment of inertia is the sum of the two others, i₁ = ∫(x₂²
        + x₃²) dm, so every setting is a possible body.
      </p>
      {body.spread.map((spread, k) => (
        <Slider
          key={k}
          id={`spread-${k + 1}`}
          label={body.frame ? `Along axis ${k + 1}` : `Along e${"₁₂₃"[k]}`}
          value={spread}
          range={range}
          unit={si("kg m²")}
          onChange={(value) =>
            controls.setBody({ ...body, spread: body.spread.with(k, value) as BodyChoice["spread"] })
          }
        />
      ))}
    </>
  );
}
