import type { ComponentChildren } from "preact";

/** A labelled list of choices in a row, with further controls behind it. */
export function Select<T extends string | number>(props: {
  id: string;
  label: string;
  value: T;
  options: readonly (readonly [value: T, text: string])[];
  disabled?: boolean;
  onChange: (value: T) => void;
  children?: ComponentChildren;
}) {
  const { id, label, value, options, disabled = false, onChange, children } = props;
  return (
    <div class="row">
      <label for={id}>{label}</label>
      <select
        id={id}
        value={value}
        disabled={disabled}
        onChange={(event) => onChange(options[event.currentTarget.selectedIndex]![0])}
      >
        {options.map(([option, text]) => (
          <option value={option} key={option}>
            {text}
          </option>
        ))}
      </select>
      {children}
    </div>
  );
}
