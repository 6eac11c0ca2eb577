import { PLANES } from "../format/numbers.ts";
import { Check, Select, Slider } from "../inputs/fields.tsx";
import type { Controls } from "../vary/controls.ts";
import { AXIS, key, type LawForm, type LawsChoice, type Parameter } from "../vary/laws.ts";
import { labelOf } from "./facts.tsx";

/** Controls of the torques: those of the scene, or a sum of laws chosen here. */
export function LawsPanel({ controls }: { controls: Controls }) {
  const about = controls.about.value;
  const choice = controls.laws.value;
  if (!about) return null;
  const own = about.laws.map(({ name }) => labelOf(name, controls.model.core.laws)).join(", ") || "none";
  return (
    <>
      <Select
        id="laws"
        label="Torques"
        value={choice.from}
        options={[
          ["scene", `As in the scene: ${own}`],
          ["here", "Chosen here"],
        ]}
        onChange={(from) => controls.chooseLaws(from)}
      />
      {choice.from === "here" &&
        controls.forms.value.map((law) => (
          <Law key={law.name} law={law} choice={choice} controls={controls} />
        ))}
    </>
  );
}

function Law({ law, choice, controls }: { law: LawForm; choice: LawsChoice; controls: Controls }) {
  const on = choice.on.has(law.name);
  const formula = controls.model.core.laws.find(({ name }) => name === law.name)?.formula;
  const toggle = (): void => {
    const names = new Set(choice.on);
    if (!names.delete(law.name)) names.add(law.name);
    controls.setLaws({ ...choice, on: names });
  };
  const set = (parameter: Parameter, value: number): void =>
    controls.setLaws({ ...choice, values: { ...choice.values, [key(law, parameter)]: value } });
  return (
    <div class="law">
      <Check id={`law-${law.name}`} label={law.label} checked={on} onChange={toggle} />
      {on && formula && (
        <p class="note">
          <code>T = {formula}</code>
        </p>
      )}
      {on &&
        law.parameters.map((parameter) => {
          const common = {
            id: `${law.name}-${parameter.name}`.replaceAll("_", "-"),
            value: choice.values[key(law, parameter)] ?? parameter.value,
            onChange: (value: number) => set(parameter, value),
          };
          return parameter.name === AXIS ? (
            <Select
              key={common.id}
              label="Plane"
              options={PLANES.map((plane, k) => [k, plane])}
              {...common}
            />
          ) : (
            <Slider key={common.id} {...parameter} {...common} />
          );
        })}
    </div>
  );
}
