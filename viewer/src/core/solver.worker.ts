/** Solves scenes in a thread of its own, so that the page stays responsive. */
import { Problem } from "./core.ts";
import { Core, Motion } from "./wasm.ts";
import type { Order, Piece, Report, Solution, Work } from "./work.ts";

let module: WebAssembly.Module;
/** The ensemble whose bodies the page asks for. */
let ensemble: Motion | Promise<Motion> | null = null;

self.onmessage = async ({ data }: MessageEvent<Order>) => {
  try {
    if ("module" in data) begin(data.module, data.solution);
    else if ("work" in data) await solve(data.work);
    else compute((await ensemble)!, data.piece);
  } catch (error) {
    const message = error instanceof Problem ? error.message : `the solver failed: ${String(error)}`;
    report({ kind: "problem", message });
  }
};

function begin(compiled: WebAssembly.Module, solution?: Solution): void {
  module = compiled;
  if (solution) ensemble = taken(solution);
  report({ kind: "ready" });
}

async function taken({ memory, handle, about }: Solution): Promise<Motion> {
  return new Motion(await Core.of(module, memory), handle, about);
}

/** Each scene has a core of its own: the memory of one that has solved many would be large. */
async function solve({ scene, ...options }: Work): Promise<void> {
  ensemble = null;
  const core = await Core.of(module);
  const motion = core.open(scene, options);
  const { about } = motion;
  const many = about.ensemble !== null;
  send(core, motion, many);
  if (!many) return;
  if (!about.exact) {
    ensemble = motion;
    return;
  }
  try {
    motion.bodies(about.start.time);
  } catch (error) {
    // The core keeps the problem; the page meets it where it draws the bodies.
    if (!(error instanceof Problem)) throw error;
  }
  send(core, motion, false);
}

function compute(motion: Motion, { from, to, until }: Piece): void {
  const begun = performance.now();
  const slice = motion.slice(from, to, Math.max(until - Date.now(), 0) / 1000);
  report({ kind: "slice", slice, took: performance.now() - begun }, [slice.rotors.buffer]);
}

function send(core: Core, { handle, about }: Motion, awaitsBodies: boolean): void {
  const memory = core.memory();
  report({ kind: "solution", memory, handle, about, awaitsBodies }, [memory]);
}

function report(message: Report, moved: Transferable[] = []): void {
  self.postMessage(message, { transfer: moved });
}
