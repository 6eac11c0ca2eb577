import type { ReadonlySignal } from "@preact/signals";
import type { Camera, Matrix4, Vector2, Vector3 } from "three";
import type { Figure } from "./figure.ts";
import type { Part, Setting } from "./part.ts";

/** What is seen in a frame, for tools over a picture. */
export interface Sight {
  camera: Camera;
  /** From space axes of the drawn body to the axes of the camera's world; in the body for the energy ellipsoid. */
  space: Matrix4;
  /** The size of the picture in CSS pixels. */
  size: Vector2;
  /** The state drawn, a row of `State`. */
  row: Float64Array;
}

/** Tools over the picture in space. */
export interface SpaceTools {
  /** Changes when another frame is needed. */
  readonly changed: ReadonlySignal<unknown>;
  /** Adds elements to the host of the picture; returns the function that removes them. */
  attach(host: HTMLElement): () => void;
  /** What the tools draw of a motion. */
  parts(setting: Setting): Part[];
  /** After each frame; null without a motion. */
  place(sight: Sight | null, figure: Figure | null): void;
}

/** The tool over the energy ellipsoid. */
export interface EnergyTool {
  /** Ω_B while it is held, and until its motion is solved; null otherwise. */
  readonly held: ReadonlySignal<Vector3 | null>;
  attach(host: HTMLElement): () => void;
  /** After each frame; `globe` takes the unit sphere to the ellipsoid in the world of the camera. */
  place(sight: Sight | null, globe: Matrix4): void;
}
