/** Solves scenes in a thread of its own, so that the page stays responsive. */
import { Problem } from "./core.ts";
import { Core, type Motion } from "./wasm.ts";
import type { Order, Report, Work } from "./work.ts";

let module: WebAssembly.Module;

self.onmessage = async ({ data }: MessageEvent<Order>) => {
  if ("module" in data) {
    module = data.module;
    report({ kind: "ready" });
    return;
  }
  try {
    await solve(data.work);
  } catch (error) {
    const message = error instanceof Problem ? error.message : `the solver failed: ${String(error)}`;
    report({ kind: "problem", message });
  }
};

/** Each scene has a core of its own: the memory of one that has solved many would be large. */
async function solve({ scene, ...options }: Work): Promise<void> {
  const core = await Core.of(module);
  const motion = core.open(scene, options);
  const many = motion.about.ensemble !== null;
  send(core, motion, many);
  if (!many) return;
  try {
    motion.bodies(motion.about.start.time);
  } catch (error) {
    // The core keeps the problem; the page meets it where it draws the bodies.
    if (!(error instanceof Problem)) throw error;
  }
  send(core, motion, false);
}

function send(core: Core, { handle, about }: Motion, awaitsBodies: boolean): void {
  const memory = core.memory();
  report({ kind: "solution", memory, handle, about, awaitsBodies }, [memory]);
}

function report(message: Report, moved: Transferable[] = []): void {
  self.postMessage(message, { transfer: moved });
}
