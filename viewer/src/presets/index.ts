import type { ViewState } from "../document.ts";
import { type Model, SHOWN } from "../model/model.ts";
import { sceneFile, titleOf } from "./files.ts";

/** A built-in scene with its view. Its title and what it shows are in its file. */
export interface Preset {
  /** File name. */
  name: string;
  /** Differences from the default view. */
  view: Partial<ViewState>;
  /** What to look at and to try in the page, after the caption of the file. */
  hint?: string;
}

/** The view of a top: the path of its axis, without the polhode. */
const TOP: Partial<ViewState> = { speed: 0.5, shown: { polhode: false, omega: false } };
/** Ω and L as arrows, from the middle of the ellipsoid to its plane and through it. */
const ROLLING = { poinsot: true, herpolhode: true, axial: true, trace: false, omega: false, momentum: false };

/** The built-in scenes in groups; the first one is the first page. */
export const GROUPS: readonly (readonly [title: string, presets: readonly Preset[]])[] = [
  [
    "Free bodies",
    [
      {
        name: "t-handle.toml",
        view: { speed: 0.2, shown: { energy: true, omega: false, trace: false, polhode: false } },
        hint: "In space L stays at rest. In the body Ω keeps its energy: it stays on this ellipsoid.",
      },
      {
        name: "racket.toml",
        view: { speed: 0.5 },
        hint: "Choose the axis under “Spin plane” and the perturbation by “Off-axis angle”.",
      },
      {
        name: "poinsot.toml",
        view: { speed: 0.5, shown: { ...ROLLING, bodyFrame: false, spaceFrame: false } },
      },
      { name: "symmetric-top.toml", view: { speed: 0.1, shown: { herpolhode: true } } },
      { name: "feynman-plate.toml", view: { speed: 0.1, shown: { polhode: false } } },
    ],
  ],
  [
    "Tops",
    [
      {
        name: "nutating-top.toml",
        view: TOP,
        hint: "Reduce “Off-axis angle” for cusps; set “Azimuth” to 90° for waves.",
      },
      { name: "cusps.toml", view: TOP },
      { name: "waves.toml", view: TOP },
      { name: "sleeping.toml", view: { ...TOP, speed: 1 } },
      {
        name: "gyroscope.toml",
        view: { ...TOP, speed: 1 },
        hint: "Reduce the spin, and the nutation appears.",
      },
      { name: "kovalevskaya.toml", view: TOP },
    ],
  ],
  [
    "Earth and asteroids",
    [
      { name: "earth.toml", view: {} },
      { name: "toutatis.toml", view: { speed: 86_400, shown: { herpolhode: true } } },
      { name: "toutatis-uncertain.toml", view: { shown: { omega: false, polhode: false } } },
    ],
  ],
  [
    "Satellites",
    [
      { name: "gravity-gradient.toml", view: {} },
      { name: "dual-spin.toml", view: {} },
      { name: "detumbling.toml", view: {} },
    ],
  ],
];

export const PRESETS: readonly Preset[] = GROUPS.flatMap(([, presets]) => presets);

/** Whether a motion may start playing: not if the user prefers reduced motion. */
export function mayAutoplay(): boolean {
  return !matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Opens a preset and plays it, unless the user prefers reduced motion. */
export async function openPreset(model: Model, { name, view, hint }: Preset): Promise<void> {
  const { scene, files } = sceneFile(name)!;
  const newest = await model.open(scene, { name, files });
  if (!newest || model.problem.value !== null) return;
  model.preset.value = name;
  const caption = model.about.value?.caption ?? titleOf(name).about;
  model.caption.value = hint ? `${caption} ${hint}` : null;
  model.shown.value = SHOWN;
  model.look({ camera: "oblique", playing: mayAutoplay(), ...view });
}
