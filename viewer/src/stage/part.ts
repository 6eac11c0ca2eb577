import type { Object3D, Quaternion, Vector3 } from "three";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import type { Figure } from "./figure.ts";

/** The state that is drawn. Bivectors are given by their axial vectors, in space axes unless the name says else. */
export interface Instant {
  time: number;
  /** Body axes to space axes. */
  attitude: Quaternion;
  /** rad/s. */
  omega: Vector3;
  omegaBody: Vector3;
  /** kg m²/s. */
  momentum: Vector3;
  /** 2T = Ω·L, J: twice the kinetic energy of a body without wheels. */
  doubleKinetic: number;
  /** Where the screen's right and up point in space axes. */
  right: Vector3;
  up: Vector3;
  /** Seconds of the clock for which the motion has played. */
  played: number;
}

/** One thing on the stage. It is told of a motion, then of colours, then of one state after the other. */
export interface Part {
  /** What stays in space, and what turns with the body. */
  readonly inSpace?: Object3D;
  readonly inBody?: Object3D;
  follow(figure: Figure): void;
  paint(palette: Palette): void;
  update(instant: Instant, shown: Shown): void;
  dispose(): void;
}
