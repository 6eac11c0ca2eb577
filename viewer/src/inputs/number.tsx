import { useSignal } from "@preact/signals";

/** A number field. `shown` replaces whatever is entered that is not a number, or that `onNumber` does not accept. */
export function NumberField(props: {
  id: string;
  label: string;
  shown: string;
  width?: string;
  onFocus?: () => void;
  onNumber: (number: number) => void;
}) {
  const { id, label, shown, width, onFocus = () => {}, onNumber } = props;
  const entered = useSignal(0);
  // Read here so that the field is rendered after each entry, even if `shown` has not changed.
  void entered.value;
  return (
    <input
      id={id}
      class="digits"
      type="number"
      step="any"
      value={shown}
      style={width === undefined ? {} : { width }}
      aria-label={label}
      onFocus={onFocus}
      onChange={(event) => {
        const number = event.currentTarget.valueAsNumber;
        if (Number.isFinite(number)) onNumber(number);
        entered.value += 1;
      }}
    />
  );
}
