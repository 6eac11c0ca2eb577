import type { Solid } from "../core/core.ts";
import { type BodyChoice, reshaped, resized, SIZES, sizeOf, thin } from "../vary/body.ts";
import type { Controls } from "../vary/controls.ts";
import { around, type Range, Slider } from "./slider.tsx";
import { DENSITY, lengthUnit, massUnit, si } from "./units.ts";

/** Not the rod: a body without any thickness has no definite rate about its axis. */
const FORMS: [BodyChoice["form"], string][] = [
  ["box", "Box"],
  ["ellipsoid", "Ellipsoid"],
  ["cylinder", "Cylinder"],
  ["disc", "Disc, thin"],
  ["cone", "Cone"],
  ["capsule", "Capsule"],
  ["torus", "Ring"],
  ["sphere", "Sphere"],
  ["hollow_sphere", "Hollow sphere"],
];

/** From cork to gold. */
const DENSITIES: Range = { min: 100, max: 25_000, scale: "log" };

/** What the body is. */
export function BodyPanel({ controls }: { controls: Controls }) {
  const body = controls.body.value;
  const about = controls.about.value;
  if (!body || !about) return null;
  const { form, solid } = body;
  return (
    <>
      <div class="row">
        <label for="form">Form</label>
        <select
          id="form"
          value={form}
          disabled={!controls.free.value}
          onChange={(event) =>
            controls.setBody(reshaped(body, event.currentTarget.value as BodyChoice["form"]))
          }
        >
          {!about.body.solid && <option value="scene">As in the scene</option>}
          <option value="masses">Masses along the axes</option>
          {FORMS.map(([name, label]) => (
            <option value={name} key={name}>
              {label}
            </option>
          ))}
        </select>
      </div>
      {form === "masses" && <Masses body={body} controls={controls} />}
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
      {SIZES[solid.kind].map(([name, label]) => (
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
  const choose = (chosen: string): void =>
    controls.setBody({
      ...body,
      amount: chosen === "mass" ? { kind: "mass", value: mass } : { kind: "density", value: 1000 },
    });
  return (
    <>
      {!thin(body.form) && (
        <div class="row">
          <label for="amount">Given by</label>
          <select id="amount" value={kind} onChange={(event) => choose(event.currentTarget.value)}>
            <option value="mass">mass</option>
            <option value="density">density</option>
          </select>
        </div>
      )}
      <Slider
        id={kind}
        label={kind === "mass" ? "Mass" : "Density"}
        value={value}
        range={kind === "mass" ? around(mass, 20) : DENSITIES}
        unit={kind === "mass" ? massUnit(mass) : DENSITY}
        onChange={(value) => controls.setBody({ ...body, amount: { kind, value } })}
      />
    </>
  );
}

/** ∫x_k² dm along each axis: whatever they are, there is such a body. */
function Masses({ body, controls }: { body: BodyChoice; controls: Controls }) {
  const about = controls.about.value!;
  const largest = Math.max(...about.body.moments);
  const range: Range = { min: 0, max: 1.5 * largest, scale: "linear" };
  return (
    <>
      <p class="note">
        How far the mass lies out along each axis: ∫x² dm. Each moment is the sum of the other two, i₁ = ∫x₂²
        + x₃² dm, so that every setting is a body.
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
            controls.setBody({
              ...body,
              spread: body.spread.map((other, j) => (j === k ? value : other)) as BodyChoice["spread"],
            })
          }
        />
      ))}
    </>
  );
}
