import type { Object3D, Quaternion, Vector3 } from "three";
import type { Acting } from "../core/core.ts";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import type { Curves } from "./curves.ts";
import type { Figure } from "./figure.ts";
import type { Labels } from "./labels.ts";
import type { Screen } from "./ribbon.ts";

/** What the parts of a picture are made from. */
export interface Setting {
  figure: Figure;
  palette: Palette;
  screen: Screen;
  labels: Labels;
  /** What can be pointed at. */
  curves: Curves;
  /** Whether the user prefers reduced motion. */
  calm: { readonly matches: boolean };
  /** The places of the cloud that was drawn last, for as long as those of a new motion are being computed. */
  cloud: { matrices: ArrayLike<number> | null };
  /** The fraction of the bodies of an ensemble that are computed. */
  bodiesKnown: () => number;
  /** Shows a message over the picture; an empty one hides it. */
  say: (message: string) => void;
}

/** The state to draw. Bivectors are given by their axial vectors, in space axes. */
export interface Instant {
  time: number;
  /** Body axes to space axes. */
  attitude: Quaternion;
  /** rad/s. */
  omega: Vector3;
  /** kg m²/s. */
  momentum: Vector3;
  /** N m; zero if it is not known. */
  torque: Vector3;
  /** What acts on the body; null if that is not known or nothing does. */
  acting: Acting | null;
  /** 2T = Ω·L, J: twice the kinetic energy of a body without wheels. */
  doubleKinetic: number;
  /** The screen's right and up in space axes. */
  right: Vector3;
  up: Vector3;
  /** Seconds for which the motion has played. */
  played: number;
  /** Whether everything must be drawn now: by default, parts may take some frames. */
  whole: boolean;
}

/** A part of the picture of one motion in one palette, which follows the state. */
export interface Part {
  /** The layer that it belongs to. */
  readonly layer?: keyof Shown;
  /** Objects in space axes, and in body axes. */
  readonly inSpace?: Object3D;
  readonly inBody?: Object3D;
  update(instant: Instant, shown: Shown): void;
}
