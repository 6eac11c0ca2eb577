/**
 * The compiled core under Node, without a page. Answers questions of tests/support/node_core.py, one line of JSON each:
 * { "question": name, … } gets { "value": … }, or { "problem": message } if the core raised a Problem.
 */
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { createServer } from "vite";

const root = fileURLToPath(new URL("..", import.meta.url));
const vite = await createServer({
  root,
  appType: "custom",
  logLevel: "error",
  optimizeDeps: { noDiscovery: true, include: [] },
  server: { middlewareMode: true, hmr: false, ws: false, watch: null },
});
const { loadCore } = await vite.ssrLoadModule("/src/core/load.ts");
const { Problem } = await vite.ssrLoadModule("/src/core/core.ts");
// The time budget of the core counts CPU time here, so that a loaded machine fails no test.
performance.now = () => process.cpuUsage().user / 1000;
const core = await loadCore();

/** Opens a motion, calls a function with it, and closes it. */
function withMotion({ scene, files = {}, ...options }, ask) {
  const bytes = Object.entries(files).map(([name, base64]) => [name, Buffer.from(base64, "base64")]);
  const motion = core.open(scene, { ...options, files: new Map(bytes) });
  try {
    return ask(motion);
  } finally {
    motion.close();
  }
}

const answers = {
  motion: ({ times, ...scene }) =>
    withMotion(scene, (motion) => ({ about: motion.about, rows: Array.from(motion.states(times)) })),
  surface: ({ arm = [0, 0, 0], ...scene }) =>
    withMotion(scene, (motion) => {
      const { vertices, faces, tints } = motion.surface(arm);
      return {
        vertices: Array.from(vertices),
        faces: Array.from(faces),
        tints: Array.from(tints),
        extents: motion.extents(),
      };
    }),
  bodies: ({ time, count, ...scene }) =>
    withMotion(scene, (motion) => Array.from(motion.bodies(time, count))),
  /** The bodies by a pool of workers, of which some fail. */
  pooled: async ({ time, count, processors, failing = [], ...scene }) => {
    const { Pool } = await vite.ssrLoadModule("/src/core/pool.ts");
    const { Core, Motion } = await vite.ssrLoadModule("/src/core/wasm.ts");
    const workers = [];
    class FakeWorker extends EventTarget {
      pieces = 0;
      ended = false;
      number = workers.push(this) - 1;
      postMessage({ module, solution, piece }) {
        if (module) this.motion = taken(module, solution);
        else setTimeout(() => void this.compute(piece));
      }
      async compute({ from, to }) {
        const slice = (await this.motion).slice(from, to);
        if (this.ended) return;
        this.pieces += 1;
        const failed = { kind: "problem", message: `worker ${this.number} failed` };
        // So long that each worker is worth starting.
        const done = { kind: "slice", slice, took: 90 * (to - from) };
        const data = failing.includes(this.number) ? failed : done;
        this.dispatchEvent(new MessageEvent("message", { data }));
      }
      terminate() {
        this.ended = true;
      }
    }
    const taken = async (module, { memory, handle, about }) =>
      new Motion(await Core.of(module, memory), handle, about);
    const own = await Core.of(core.module);
    const motion = own.open(scene.scene);
    const { handle, about } = motion;
    const job = { module: core.module, solution: { memory: own.memory(), handle, about }, count, processors };
    const first = new FakeWorker();
    first.motion = taken(job.module, job.solution);
    const parts = [];
    const failure = await new Promise((done) => {
      const listener = {
        progress: (part) => parts.push(part),
        complete: (slices, why) => {
          motion.join(slices, why);
          done(why);
        },
      };
      const pool = new Pool(first, job, () => new FakeWorker(), listener);
      first.addEventListener("message", ({ data }) => {
        if (data.kind === "slice") pool.take(first, data.slice, data.took);
        else pool.lose(first, data.message);
      });
    });
    return {
      bodies: Array.from(motion.bodies(time, count)),
      problem: motion.bodiesProblem,
      failure,
      parts,
      workers: workers.map(({ pieces, ended }) => ({ pieces, ended })),
    };
  },
  recorded: ({ about, rows, times }) => {
    const motion = core.recorded(about, Float64Array.from(rows));
    try {
      return { about: motion.about, rows: Array.from(motion.states(times)) };
    } finally {
      motion.close();
    }
  },
  merged: ({ scene, change }) => core.merged(scene, change),
  evaluated: ({ lines }) => core.evaluated(lines),
  table: async ({ text, name }) => (await vite.ssrLoadModule("/src/vary/read.ts")).tableOf(text, name),
  cloud: async ({ scene, ensemble, held, omega }) => {
    const { cloudOf } = await vite.ssrLoadModule("/src/vary/cloud.ts");
    return cloudOf(scene, { ensemble, held, start: { omega_body: omega } });
  },
  polhodes: async ({ moments, through }) => {
    const { Vector3 } = await vite.ssrLoadModule("three");
    const curves = await vite.ssrLoadModule("/src/stage/polhodes.ts");
    const plain = (curve) => curve.map((u) => u.toArray());
    const own = through.map((u) => curves.through(moments, new Vector3(...u)));
    return {
      neighbours: curves.neighbours(moments).map(plain),
      separatrix: curves.separatrix(moments).map(plain),
      through: own.map((curve) => curve && plain(curve)),
    };
  },
  pushed: async ({ time, at, impulse, ...scene }) => {
    const { Vector3 } = await vite.ssrLoadModule("three");
    const { pushed } = await vite.ssrLoadModule("/src/hands/impulse.ts");
    return withMotion(scene, (motion) => {
      const row = motion.states([time]);
      const after = pushed(row, motion.about, new Vector3(...at), new Vector3(...impulse));
      const [omega, momentum] = [after.omega.toArray(), after.momentum.toArray()];
      return { row: Array.from(row), omega, momentum, energy: after.energy };
    });
  },
  /** What the history shows after each of some calls of its methods. */
  history: async ({ calls }) => {
    const { History } = await vite.ssrLoadModule("/src/model/history.ts");
    const history = new History();
    return calls.map(([name, scene]) => {
      if (name === "record") history.record({ scene }, history.stamp());
      else if (name === "clear") history.clear({ scene });
      else history[name]();
      return [history.present?.scene ?? null, history.undoable.value, history.redoable.value];
    });
  },
  called: ({ name, given }) => core[name](...given),
};

for await (const line of createInterface({ input: process.stdin })) {
  const { question, ...rest } = JSON.parse(line);
  let answer;
  try {
    answer = { value: await answers[question](rest) };
  } catch (error) {
    if (!(error instanceof Problem)) throw error;
    answer = { problem: error.message };
  }
  process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await vite.close();
