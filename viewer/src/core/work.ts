/** The messages between the page and the worker that solves its scenes. */
import type { About, Files } from "./core.ts";

/** A scene to solve, in at most `budget` seconds. */
export interface Work {
  scene: string;
  name: string;
  files: Files;
  budget: number;
}

/** To the worker: the compiled core first, then one scene after the other. */
export type Order = { module: WebAssembly.Module } | { work: Work };

/** From the worker. A solution is the memory of a core and a motion in it; that of an ensemble comes twice. */
export type Report =
  | { kind: "ready" }
  | { kind: "solution"; memory: ArrayBuffer; handle: number; about: About; awaitsBodies: boolean }
  | { kind: "problem"; message: string };
