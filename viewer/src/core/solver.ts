import { BODIES, type Files, Problem } from "./core.ts";
import { Pool } from "./pool.ts";
import SolverWorker from "./solver.worker.ts?worker&inline";
import { Core, Motion } from "./wasm.ts";
import type { Order, Report, Solution } from "./work.ts";

/** Time limits for solving a scene, in s: in the worker, and in the page if it has none, which is then blocked. */
const BUDGET = 20;
const BLOCKING = 8;

/** After this time in ms a scene is given up if a newer one waits. */
const PATIENCE = 400;

interface Task {
  scene: string;
  name: string;
  files: Files;
  /** Whether to give up older scenes at once. By default one that is nearly solved is shown on the way. */
  only?: boolean;
  /** Gets the fraction of the bodies of an ensemble that are computed. */
  progress?: (part: number) => void;
  /** Gets the motion of an ensemble again, with its bodies. */
  complete?: (motion: Motion) => void;
}

interface Request extends Task {
  /** Whether the motion is known; the worker may still compute the bodies of its ensemble. */
  solved: boolean;
  /** Answers with null if the scene was given up. */
  resolve: (motion: Motion | null) => void;
  reject: (problem: Problem) => void;
}

/**
 * Solves scenes one at a time in a worker, which others help with the bodies of an ensemble; only the newest waits. If
 * the page may not have workers, it solves them itself.
 */
export class Solver {
  private worker: Worker | null = null;
  private pool: Pool | null = null;
  private available = typeof Worker !== "undefined";
  /** Whether a worker has ever answered. */
  private proved = false;
  private running: Request | null = null;
  private waiting: Request | null = null;
  private begun = 0;
  private patience: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly core: Core) {}

  /** The motion of a scene; null if it was given up for a newer one. Rejected with a Problem. */
  solve(task: Task): Promise<Motion | null> {
    return new Promise((resolve, reject) => {
      this.waiting?.resolve(null);
      this.waiting = { ...task, solved: false, resolve, reject };
      if (!this.running) this.next();
      else if (task.only || this.running.solved) this.restart();
      else {
        const left = PATIENCE - (performance.now() - this.begun);
        this.patience ??= setTimeout(() => this.restart(), left);
      }
    });
  }

  /** Gives everything up. */
  dispose(): void {
    this.waiting?.resolve(null);
    this.waiting = null;
    this.stop();
  }

  private restart(): void {
    this.stop();
    this.next();
  }

  /** Ends the workers in the middle of their work. */
  private stop(): void {
    this.pool?.stop();
    this.pool = null;
    this.worker?.terminate();
    this.worker = null;
    this.finished()?.resolve(null);
  }

  private finished(): Request | null {
    clearTimeout(this.patience);
    this.patience = undefined;
    const request = this.running;
    this.running = null;
    return request;
  }

  private next(): void {
    const request = this.waiting;
    if (!request) return;
    this.waiting = null;
    const { scene, name, files } = request;
    if (this.available) {
      this.running = request;
      this.begun = performance.now();
      this.send({ work: { scene, name, files, budget: BUDGET } });
      return;
    }
    try {
      request.resolve(this.core.open(scene, { name, files, budget: BLOCKING }));
    } catch (error) {
      request.reject(problemOf(error));
    }
  }

  private send(order: Order): void {
    try {
      this.worker ??= this.started();
      this.worker.postMessage(order);
    } catch (error) {
      this.failed(String(error));
    }
  }

  private started(): Worker {
    const worker = new SolverWorker();
    worker.addEventListener("message", ({ data }: MessageEvent<Report>) => {
      if (worker === this.worker) void this.take(data);
    });
    worker.addEventListener("error", (event) => {
      event.preventDefault();
      if (worker === this.worker) this.failed(event.message);
    });
    worker.postMessage({ module: this.core.module } satisfies Order);
    return worker;
  }

  private async take(report: Report): Promise<void> {
    this.proved = true;
    const request = this.running;
    if (!request || report.kind === "ready") return;
    if (report.kind === "slice") {
      this.pool?.take(this.worker!, report.slice, report.took);
      return;
    }
    if (report.kind === "problem" && this.pool) {
      this.pool.lose(this.worker!, report.message);
      return;
    }
    if (report.kind === "problem") {
      this.finished();
      request.reject(new Problem(report.message));
    } else {
      const { memory, handle, about, awaitsBodies } = report;
      const motion = new Motion(await Core.of(this.core.module, memory), handle, about);
      if (this.running !== request) return;
      motion.awaitsBodies = awaitsBodies;
      if (request.solved) request.complete?.(motion);
      else request.resolve(motion);
      request.solved = true;
      if (!awaitsBodies) this.finished();
      else if (this.waiting) this.stop();
      else if (!about.exact) this.compute(request, motion, { memory, handle, about });
    }
    if (!this.running) this.next();
  }

  /** Has the bodies of an ensemble computed. */
  private compute(request: Request, motion: Motion, solution: Solution): void {
    const { module } = this.core;
    const count = Math.min(BODIES, solution.about.ensemble ?? 0);
    const processors = navigator.hardwareConcurrency || 1;
    const job = { module, solution, count, processors };
    this.pool = new Pool(this.worker!, job, () => new SolverWorker(), {
      progress: (part) => request.progress?.(part),
      complete: (slices, failure) => {
        this.pool = null;
        motion.join(slices, failure);
        this.finished();
        request.complete?.(motion.again());
        this.next();
      },
    });
  }

  /** The worker failed. If none has ever answered, the page may not have workers. */
  private failed(message: string): void {
    const request = this.finished();
    this.stop();
    if (this.proved) request?.reject(new Problem(`the solver failed (${message}); reload the page`));
    else {
      this.available = false;
      if (this.waiting) request?.resolve(null);
      else this.waiting = request;
    }
    this.next();
  }
}

function problemOf(error: unknown): Problem {
  return error instanceof Problem ? error : new Problem(String(error));
}
