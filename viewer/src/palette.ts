/**
 * Colours of the page, light and dark. The axes have those of Okabe and Ito's palette, safe for colour-blind readers; Ω and
 * L have others, and the paths of Ω have that of Ω. Each part also has a label or a shape of its own. The figures of
 * `python/polhode/_figures` use the same colours.
 */
export interface Palette {
  background: string;
  surface: string;
  text: string;
  faint: string;
  /** Axes 1, 2 and 3. */
  axes: [string, string, string];
  omega: string;
  momentum: string;
  torque: string;
  trace: string;
  polhode: string;
  herpolhode: string;
  body: string;
  weight: string;
}

export const LIGHT: Palette = {
  background: "#f6f7f9",
  surface: "#ffffff",
  text: "#1c2430",
  faint: "#8a94a3",
  axes: ["#0072B2", "#D55E00", "#009E73"],
  omega: "#B07A00",
  momentum: "#7B3F98",
  torque: "#A6192E",
  trace: "#CC79A7",
  polhode: "#B07A00",
  herpolhode: "#B07A00",
  body: "#c9d2de",
  weight: "#5b6675",
};

export const DARK: Palette = {
  background: "#11151c",
  surface: "#1a202b",
  text: "#e8ecf2",
  faint: "#7c8798",
  axes: ["#56B4E9", "#F0803C", "#2FC99A"],
  omega: "#F0C75E",
  momentum: "#C79BE0",
  torque: "#FF7B7B",
  trace: "#E59CC4",
  polhode: "#F0C75E",
  herpolhode: "#F0C75E",
  body: "#5a6678",
  weight: "#a8b2c1",
};

/** Contrast of text with what it stands on, at least: WCAG 2.2, level AA. */
const CONTRAST = 4.5;
/** Steps from a colour to that of text. */
const MIXES = 50;

/** A colour for text: the nearest one, towards that of other text, with enough contrast on the page and its panels. */
export function readable(colour: string, palette: Palette): string {
  const [from, to] = [channels(colour), channels(palette.text)];
  const grounds = [palette.background, palette.surface].map((ground) => luminance(channels(ground)));
  for (let k = 0; k < MIXES; k++) {
    const mixed = from.map((channel, c) => Math.round(channel + ((to[c]! - channel) * k) / MIXES));
    if (grounds.every((ground) => contrast(luminance(mixed), ground) >= CONTRAST)) return `rgb(${mixed})`;
  }
  return palette.text;
}

/** Contrast of two relative luminances: from 1 to 21. */
function contrast(a: number, b: number): number {
  return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
}

/** Red, green and blue of `#rrggbb`, from 0 to 255. */
function channels(colour: string): number[] {
  return [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
}

/** Relative luminance of sRGB, as WCAG defines it. */
function luminance(rgb: readonly number[]): number {
  const [r, g, b] = rgb.map((channel) => {
    const part = channel / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
}
