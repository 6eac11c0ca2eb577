/**
 * Colours of the page, light and dark: Okabe and Ito's palette, safe for colour-blind readers. Each part also has a label
 * or a shape of its own. The figures of `python/polhode/_figures` use the same colours.
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
  omega: "#D55E00",
  momentum: "#0072B2",
  trace: "#CC79A7",
  polhode: "#B07A00",
  herpolhode: "#009E73",
  body: "#c9d2de",
  weight: "#5b6675",
};

export const DARK: Palette = {
  background: "#11151c",
  surface: "#1a202b",
  text: "#e8ecf2",
  faint: "#7c8798",
  axes: ["#56B4E9", "#F0803C", "#2FC99A"],
  omega: "#F0803C",
  momentum: "#56B4E9",
  trace: "#E59CC4",
  polhode: "#F0C75E",
  herpolhode: "#2FC99A",
  body: "#5a6678",
  weight: "#a8b2c1",
};
