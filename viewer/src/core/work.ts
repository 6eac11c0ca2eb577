/** The messages between the page and the workers that solve its scenes. */
import type { About, Files } from "./core.ts";
import type { Slice } from "./wasm.ts";

/** A scene to solve, in at most `budget` seconds. */
export interface Work {
  scene: string;
  name: string;
  files: Files;
  budget: number;
}

/** The memory of a core and a motion in it, which another core takes over. */
export interface Solution {
  memory: ArrayBuffer;
  handle: number;
  about: About;
}

/** Bodies of the motion that the worker holds, from number `from` up to `to`, until a time of the clock, ms. */
export interface Piece {
  from: number;
  to: number;
  until: number;
}

/**
 * To a worker: the compiled core first, then one scene after the other. A worker that helps another one gets the solution
 * of that. Bodies of an ensemble are asked for in pieces.
 */
export type Order = { module: WebAssembly.Module; solution?: Solution } | { work: Work } | { piece: Piece };

/** From a worker. The solution of an ensemble in closed form comes twice; `took` is in ms. */
export type Report =
  | { kind: "ready" }
  | ({ kind: "solution"; awaitsBodies: boolean } & Solution)
  | { kind: "slice"; slice: Slice; took: number }
  | { kind: "problem"; message: string };
