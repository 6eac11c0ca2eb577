const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A size with three digits and its unit. */
export function quantity(size: number, unit: string): string {
  const power = size > 0 ? Math.floor(Math.log10(size)) : 0;
  if (power >= -3 && power < 4) return `${size.toFixed(Math.min(Math.max(2 - power, 0), 5))} ${unit}`;
  const digits = String(Math.abs(power)).replace(/\d/g, (digit) => RAISED[Number(digit)]!);
  return `${(size / 10 ** power).toFixed(2)}·10${power < 0 ? "⁻" : ""}${digits} ${unit}`;
}
