import type { Envelope } from "./samples.ts";

/** Height of the drawing, in its own units; its width is that of the columns. */
export const HEIGHT = 100;
/** Room above and below. */
const MARGIN = 6;

/** The height of a value, from the top. */
export function heightOf(value: number, [least, most]: Envelope["range"]): number {
  const share = most > least ? (value - least) / (most - least) : 0.5;
  return MARGIN + (1 - share) * (HEIGHT - 2 * MARGIN);
}

/** The path of an axis: a line, or a band from the least to the largest values. */
export function curve({ least, most, range, bands }: Envelope, axis: number): string {
  const [low, high] = [least[axis]!, most[axis]!];
  const at = (k: number, value: number) => `${k + 0.5} ${heightOf(value, range).toFixed(2)}`;
  const known = [...low.keys()].filter((k) => Number.isFinite(low[k]!));
  if (known.length === 0) return "";
  if (!bands) return `M${known.map((k) => at(k, high[k]!)).join("L")}`;
  const above = known.map((k) => at(k, Math.max(high[k]!, low[k + 1] ?? -Infinity)));
  const below = known.map((k) => at(k, Math.min(low[k]!, high[k + 1] ?? Infinity)));
  return `M${above.join("L")}L${below.reverse().join("L")}Z`;
}
