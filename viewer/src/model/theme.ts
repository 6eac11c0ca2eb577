import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { DARK, LIGHT, type Palette, readable } from "../palette.ts";
import type { Model } from "./model.ts";

/** The palette of the model's theme, which may follow the system's; `dispose` stops following it. */
export function paletteOf(model: Model): { palette: ReadonlySignal<Palette>; dispose: () => void } {
  const query = matchMedia("(prefers-color-scheme: dark)");
  const machine = signal(query.matches);
  const listen = (): void => {
    machine.value = query.matches;
  };
  query.addEventListener("change", listen);
  const palette = computed(() => {
    const theme = model.theme.value;
    return theme === "dark" || (theme === "auto" && machine.value) ? DARK : LIGHT;
  });
  return { palette, dispose: () => query.removeEventListener("change", listen) };
}

/** A palette as CSS variables. */
export function variables(palette: Palette): [string, string][] {
  const { axes, ...others } = palette;
  return [
    ["color-scheme", palette === DARK ? "dark" : "light"],
    ...axes.map((colour, k): [string, string] => [`--axis-${k + 1}`, colour]),
    ...Object.entries(others).map(([name, colour]): [string, string] => [`--${name}`, colour]),
    ["--holds", readable(axes[2], palette)],
    ["--fails", readable(palette.omega, palette)],
    ["--on-accent", palette === DARK ? palette.background : palette.surface],
  ];
}
