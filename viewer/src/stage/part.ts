import type { Object3D, Quaternion, Vector3 } from "three";
import type { Shown } from "../document.ts";
import type { Palette } from "../palette.ts";
import type { Figure } from "./figure.ts";

/** The state to draw. Bivectors are given by their axial vectors, in space axes unless the name says otherwise. */
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
  /** The screen's right and up in space axes. */
  right: Vector3;
  up: Vector3;
  /** Seconds for which the motion has played. */
  played: number;
}

/** A part of the picture: it gets a motion, colours, and then states. */
export interface Part {
  /** Objects in space axes, and in body axes. */
  readonly inSpace?: Object3D;
  readonly inBody?: Object3D;
  follow(figure: Figure): void;
  paint(palette: Palette): void;
  update(instant: Instant, shown: Shown): void;
  dispose(): void;
}
