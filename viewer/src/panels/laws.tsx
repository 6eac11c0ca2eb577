import type { Controls } from "../vary/controls.ts";
import { AXIS, key, type LawForm, type LawsChoice, type Parameter } from "../vary/laws.ts";
import { labelOf } from "./facts.tsx";
import { Slider } from "./slider.tsx";

const PLANES = ["e₂∧e₃", "e₃∧e₁", "e₁∧e₂"];

/** What turns the body: as the scene says, or laws that add up. */
export function LawsPanel({ controls }: { controls: Controls }) {
  const about = controls.about.value;
  const choice = controls.laws.value;
  if (!about) return null;
  const own = about.laws.map(({ name }) => labelOf(name, controls.registry)).join(", ") || "none";
  return (
    <>
      <div class="row">
        <label for="laws">Torques</label>
        <select
          id="laws"
          value={choice.from}
          onChange={(event) => controls.chooseLaws(event.currentTarget.value as LawsChoice["from"])}
        >
          <option value="scene">{`As in the scene: ${own}`}</option>
          <option value="here">Chosen here</option>
        </select>
      </div>
      {choice.from === "here" &&
        controls.forms.value.map((law) => (
          <Law key={law.name} law={law} choice={choice} controls={controls} />
        ))}
    </>
  );
}

function Law({ law, choice, controls }: { law: LawForm; choice: LawsChoice; controls: Controls }) {
  const on = choice.on.has(law.name);
  const toggle = (): void => {
    const names = new Set(choice.on);
    if (!names.delete(law.name)) names.add(law.name);
    controls.setLaws({ ...choice, on: names });
  };
  const set = (parameter: Parameter, value: number): void =>
    controls.setLaws({ ...choice, values: { ...choice.values, [key(law, parameter)]: value } });
  return (
    <div class="law">
      <label class="check">
        <input id={`law-${law.name}`} type="checkbox" checked={on} onChange={toggle} />
        {law.label}
      </label>
      {on &&
        law.parameters.map((parameter) => {
          const value = choice.values[key(law, parameter)] ?? parameter.value;
          const id = `${law.name}-${parameter.name}`.replaceAll("_", "-");
          return parameter.name === AXIS ? (
            <PlaneChoice key={id} id={id} value={value} onChange={(axis) => set(parameter, axis)} />
          ) : (
            <Slider
              key={id}
              id={id}
              {...parameter}
              value={value}
              onChange={(value) => set(parameter, value)}
            />
          );
        })}
    </div>
  );
}

function PlaneChoice(props: { id: string; value: number; onChange: (axis: number) => void }) {
  return (
    <div class="row">
      <label for={props.id}>Plane</label>
      <select
        id={props.id}
        value={props.value}
        onChange={(event) => props.onChange(Number(event.currentTarget.value))}
      >
        {PLANES.map((plane, k) => (
          <option value={k} key={plane}>
            {plane}
          </option>
        ))}
      </select>
    </div>
  );
}
