import { useSignal } from "@preact/signals";
/**
 * A field for a number. `shown` is what the number is: text that is not a number, or one that `onNumber` takes only in
 * part, is replaced by it.
 */
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
  // The field is drawn again after each entry, also where `shown` stays as it was.
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
