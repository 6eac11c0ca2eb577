/** Numbers as text: a true minus sign, powers of ten with raised digits, a fixed place for each digit. */

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** The basis bivectors, in the order of components. */
export const PLANES = ["e₂∧e₃", "e₃∧e₁", "e₁∧e₂"];

/** `10⁻³`. */
export function powerOfTen(exponent: number): string {
  const digits = String(Math.abs(exponent)).replace(/\d/g, (digit) => RAISED[Number(digit)]!);
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

/** The power of ten of the first digit of a number; 0 for zero. */
export function exponentOf(number: number): number {
  return number === 0 || !Number.isFinite(number) ? 0 : Math.floor(Math.log10(Math.abs(number)));
}

/** A number with this many significant digits: `0.06283`, `1.2 × 10⁻⁷`. */
export function significant(number: number, digits = 6): string {
  if (!Number.isFinite(number)) return number > 0 ? "∞" : number < 0 ? "−∞" : "not a number";
  const exponent = exponentOf(number);
  if (exponent < -4 || exponent > 7) {
    const [mantissa, power] = number.toExponential(digits - 1).split("e");
    return times(minus(trimmed(mantissa!)), Number(power));
  }
  return minus(trimmed(number.toPrecision(digits)));
}

/** A magnitude with three digits and its unit; trailing zeros are kept so that a changing value does not jump. */
export function quantity(size: number, unit: string): string {
  const exponent = exponentOf(size);
  const plain = exponent >= -3 && exponent < 4;
  const digits = plain
    ? size.toFixed(Math.max(2 - exponent, 0))
    : times((size / 10 ** exponent).toFixed(2), exponent);
  return `${digits}\u00a0${unit}`;
}

/** A number as text for an input field. */
export function typed(number: number, digits = 6): string {
  return String(Number(number.toPrecision(digits)));
}

/** A number as text for a short input field: `0.0042`, `4.2e-5`. */
export function shortlyTyped(number: number, digits: number): string {
  const plain = typed(number, digits);
  const power = Number(plain).toExponential().replace("+", "");
  return power.length < plain.length ? power : plain;
}

/** An error or a drift: `3 × 10⁻¹⁶`, `0`. */
export function small(number: number): string {
  if (number === 0) return "0";
  const [mantissa, power] = number.toExponential(0).split("e");
  return times(minus(mantissa!), Number(power));
}

/** The common format of numbers of similar magnitude: a power of ten is factored out. */
export interface Scale {
  factor: number;
  decimals: number;
  /** Characters before and after the decimal point, with the point. */
  width: number;
  /** `10⁻³ `, or nothing. */
  power: string;
}

/** The format for numbers up to `size`, with five digits for the largest. */
export function scaleFor(size: number): Scale {
  const exponent = exponentOf(size);
  if (exponent < -2 || exponent > 4) {
    return { factor: 10 ** -exponent, decimals: 4, width: 6, power: `${powerOfTen(exponent)} ` };
  }
  const decimals = Math.min(Math.max(4 - exponent, 1), 5);
  return { factor: 1, decimals, width: Math.max(exponent, 0) + 2 + decimals, power: "" };
}

/** The sign and the digits of a number; a number that rounds to zero has no sign. */
export function scaled(number: number, scale: Scale): { negative: boolean; digits: string } {
  const digits = (Math.abs(number) * scale.factor).toFixed(scale.decimals);
  return { negative: number < 0 && /[1-9]/.test(digits), digits: digits.padStart(scale.width, "\u2007") };
}

/** `1.2 × 10⁻⁷`, without a place to break the line. */
function times(mantissa: string, power: number): string {
  return `${mantissa}\u00a0×\u00a0${powerOfTen(power)}`;
}

function trimmed(digits: string): string {
  return digits.includes(".") ? digits.replace(/\.?0+$/, "") : digits;
}

function minus(text: string): string {
  return text.replace("-", "−");
}
