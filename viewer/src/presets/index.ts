import type { Files } from "../core/core.ts";
import type { ViewState } from "../document.ts";
import { type Model, SHOWN } from "../model/model.ts";
import { decoded } from "../packed.ts";
import plate from "../../../examples/feynman-plate.toml?raw";
import gyroscope from "../../../examples/gyroscope.toml?raw";
import loops from "../../../examples/nutating-top.toml?raw";
import handle from "../../../examples/t-handle.toml?raw";
import handleMesh from "../../../examples/t-handle.stl?base64";
import toutatis from "../../../examples/toutatis.toml?raw";
import cusps from "./cusps.toml?raw";
import symmetric from "./free-top.toml?raw";
import poinsot from "./poinsot.toml?raw";
import racket from "./racket.toml?raw";
import sleeping from "./sleeping.toml?raw";
import waves from "./waves.toml?raw";

/** A built-in scene with its view and caption. */
export interface Preset {
  /** File name. */
  name: string;
  title: string;
  scene: string;
  /** Files that the scene names, in base64. */
  files?: Record<string, string>;
  /** Differences from the default view. */
  view: Partial<ViewState>;
  caption: string;
}

/** The view of a top: the path of its axis, without the polhode. */
const TOP: Partial<ViewState> = { speed: 0.5, shown: { polhode: false, omega: false } };

export const PRESETS: Preset[] = [
  {
    name: "t-handle.toml",
    title: "Dzhanibekov’s T-handle",
    scene: handle,
    files: { "t-handle.stl": handleMesh },
    view: { speed: 0.2, shown: { energy: true, omega: false, trace: false, polhode: false } },
    caption:
      "The handle spins about the axis of its middle moment, and flips again and again. In space L stays at rest. In the body " +
      "Ω keeps its energy, so it stays on this ellipsoid, and passes from one end of the axis to the other.",
  },
  {
    name: "racket.toml",
    title: "Tennis-racket theorem: a book",
    scene: racket,
    view: { speed: 0.5 },
    caption:
      "A book spins steadily about its longest or its shortest side; about the middle one it flips, however small the " +
      "perturbation. Choose the axis under “Spin plane” and the perturbation by “Off-axis angle”.",
  },
  {
    name: "poinsot.toml",
    title: "Poinsot’s rolling ellipsoid",
    scene: poinsot,
    view: {
      speed: 0.5,
      shown: {
        poinsot: true,
        herpolhode: true,
        trace: false,
        omega: false,
        momentum: false,
        bodyFrame: false,
      },
    },
    caption:
      "The inertia ellipsoid rolls on a fixed plane perpendicular to the axis of L. The point of contact is the tip of Ω; it " +
      "traces the polhode on the body and the herpolhode on the plane.",
  },
  {
    name: "free-top.toml",
    title: "Symmetric top",
    scene: symmetric,
    view: { speed: 0.1, shown: { herpolhode: true } },
    caption:
      "The motion is a product of two steady rotations: R(t) = exp(−½Ωₗ t) R(0) exp(−½Ωᵣ t), handout eq. (4.35). The axis " +
      "precesses about L while the body rotates about its axis.",
  },
  {
    name: "nutating-top.toml",
    title: "Heavy top: loops",
    scene: loops,
    view: TOP,
    caption:
      "A heavy top that starts with its axis moving backward draws loops. Reduce “Off-axis angle”, and the loops become " +
      "cusps; set “Azimuth” to 90°, and they become waves.",
  },
  {
    name: "cusps.toml",
    title: "Heavy top: cusps",
    scene: cusps,
    view: TOP,
    caption:
      "The top starts with spin alone. Its axis falls, is deflected sideways, rises, and stops for a moment.",
  },
  {
    name: "waves.toml",
    title: "Heavy top: waves",
    scene: waves,
    view: TOP,
    caption: "A top that starts with a small forward push never stops: its axis precesses in waves.",
  },
  {
    name: "sleeping.toml",
    title: "Heavy top: sleeping",
    scene: sleeping,
    view: { ...TOP, speed: 1 },
    caption:
      "A top that spins faster than 2 √(m g l i₁)/i₃ is stable upright: it sleeps. Reduce the rate below 15.3 rad/s, or " +
      "2.44 rev/s, and it falls.",
  },
  {
    name: "gyroscope.toml",
    title: "Gyroscope on a point",
    scene: gyroscope,
    view: { ...TOP, speed: 1 },
    caption:
      "At a hundred revolutions per second, the axis precesses about the vertical at nearly m g l / (i₃ ω₃). Its nutation is " +
      "too small to be seen; reduce the spin to make it visible.",
  },
  {
    name: "feynman-plate.toml",
    title: "Feynman’s plate",
    scene: plate,
    view: { speed: 0.1, shown: { polhode: false } },
    caption: "A plate thrown with a wobble: it wobbles twice per revolution, as Feynman saw in a cafeteria.",
  },
  {
    name: "toutatis.toml",
    title: "Asteroid Toutatis",
    scene: toutatis,
    view: { speed: 86_400, shown: { herpolhode: true } },
    caption:
      "4179 Toutatis tumbles: it rotates about its long axis in 5.4 days, while that axis precesses about L in 7.35 days. No " +
      "two of its days are alike.",
  },
];

/** Whether a motion may start playing: not if the user prefers reduced motion. */
export function mayAutoplay(): boolean {
  return !matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Opens a preset and plays it, unless the user prefers reduced motion. */
export async function openPreset(model: Model, preset: Preset): Promise<void> {
  const files: Files = new Map(
    Object.entries(preset.files ?? {}).map(([name, text]) => [name, decoded(text)]),
  );
  const newest = await model.open(preset.scene, { name: preset.name, files });
  if (!newest || model.problem.value !== null) return;
  model.caption.value = preset.caption;
  model.shown.value = SHOWN;
  model.look({ camera: "oblique", playing: mayAutoplay(), ...preset.view });
}
