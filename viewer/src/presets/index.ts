import type { Files } from "../core/core.ts";
import type { ViewState } from "../document.ts";
import { type Model, SHOWN } from "../model/model.ts";
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

/** A scene that the page knows, and how to look at it. */
export interface Preset {
  /** The name of its file. */
  name: string;
  title: string;
  scene: string;
  /** Files that the scene names, in base64. */
  files?: Record<string, string>;
  view: Partial<ViewState>;
  /** What to look at. */
  caption: string;
}

/** What the axis of a top draws. */
const TOP: Partial<ViewState> = {
  speed: 0.5,
  shown: { gravity: true, trace: true, polhode: false, omega: false, momentum: true },
};

export const PRESETS: Preset[] = [
  {
    name: "t-handle.toml",
    title: "Dzhanibekov’s T-handle",
    scene: handle,
    files: { "t-handle.stl": handleMesh },
    view: { speed: 0.2, shown: { polhode: true, trace: true, omega: true, momentum: true } },
    caption:
      "Spun about the axis of its middle moment, the handle turns over, again and again. L stays where it is; on the " +
      "body, Ω leaves one end of the axis and arrives at the other along the polhode.",
  },
  {
    name: "racket.toml",
    title: "The tennis racket: a book",
    scene: racket,
    view: { speed: 0.5, shown: { polhode: true, trace: true, omega: true, momentum: true } },
    caption:
      "About its longest or its shortest side a book spins steadily; about the middle one it turns over, however small " +
      "the push off that axis. Choose where it spins under “Spin in”, and how far off by the slider.",
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
      "The ellipsoid of inertia rolls on a plane that never moves, at right angles to the axis of L. It touches where Ω is: " +
      "the point draws the polhode on the body and the herpolhode on the plane.",
  },
  {
    name: "free-top.toml",
    title: "Symmetric top",
    scene: symmetric,
    view: { speed: 0.1, shown: { polhode: true, herpolhode: true, omega: true, momentum: true } },
    caption:
      "Two steady turns, one on either side of the rotor: R(t) = exp(−½Ωₗ t) R(0) exp(−½Ωᵣ t), handout eq. (4.35). " +
      "The axis goes round L while the body turns about the axis.",
  },
  {
    name: "nutating-top.toml",
    title: "Heavy top: loops",
    scene: loops,
    view: TOP,
    caption:
      "Let go with its axis moving backward, a heavy top draws loops. Put its spin less and less off the axis, and the " +
      "loops close to cusps; turn the direction of that push to 90°, and they open to waves.",
  },
  {
    name: "cusps.toml",
    title: "Heavy top: cusps",
    scene: cusps,
    view: TOP,
    caption:
      "Let go at rest but for its spin, the axis falls, is led aside, rises, and stands still for a moment.",
  },
  {
    name: "waves.toml",
    title: "Heavy top: waves",
    scene: waves,
    view: TOP,
    caption: "Pushed forward a little as it is let go, the axis never stops: it goes round in waves.",
  },
  {
    name: "sleeping.toml",
    title: "Heavy top: sleeping",
    scene: sleeping,
    view: { ...TOP, speed: 1 },
    caption:
      "Faster than 2 √(m g l i₁)/i₃ a top stays upright: it sleeps. Lower its rate below 15.3 rad/s, or 2.44 rev/s, " +
      "and it wakes up.",
  },
  {
    name: "gyroscope.toml",
    title: "Gyroscope on a point",
    scene: gyroscope,
    view: { ...TOP, speed: 1, shown: { ...TOP.shown, axial: false } },
    caption:
      "A hundred turns in a second: the axis goes round the vertical at nearly m g l / (i₃ ω₃). Its nutation is too small " +
      "to be seen; slow the spin and it shows.",
  },
  {
    name: "feynman-plate.toml",
    title: "Feynman’s plate",
    scene: plate,
    view: { speed: 0.1, shown: { polhode: false, trace: true, omega: true, momentum: true } },
    caption:
      "A plate thrown with a wobble: the wobble goes round twice while the plate turns once, as Feynman saw in a cafeteria.",
  },
  {
    name: "toutatis.toml",
    title: "Asteroid Toutatis",
    scene: toutatis,
    view: { speed: 86_400, shown: { polhode: true, herpolhode: true, trace: true, momentum: true } },
    caption:
      "4179 Toutatis tumbles: it rolls about its long axis in 5.4 days, while that axis goes round L in 7.35. No two of its days are " +
      "alike.",
  },
];

/** Whether a motion may play by itself: not where the machine's owner wants things still. */
export function mayMove(): boolean {
  return !matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** Shows a preset, playing if it may. */
export function openPreset(model: Model, preset: Preset): void {
  const files: Files = new Map(Object.entries(preset.files ?? {}).map(([name, text]) => [name, bytes(text)]));
  model.open(preset.scene, { name: preset.name, files });
  if (model.problem.value !== null) return;
  model.caption.value = preset.caption;
  model.shown.value = SHOWN;
  model.look({
    camera: "oblique",
    playing: mayMove(),
    ...preset.view,
  });
}

function bytes(base64: string): Uint8Array {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
}
