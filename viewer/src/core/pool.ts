import type { Slice } from "./wasm.ts";
import type { Order, Piece, Report, Solution } from "./work.ts";

/** Time limit for the bodies of an ensemble, ms. */
const BUDGET = 10_000;
/** The number of bodies that show how long the others take. */
const FIRST = 4;
/** How long a worker should be busy with a piece, ms, and how many pieces it is asked for in advance. */
const PIECE = 100;
const AHEAD = 2;
/** What a further worker must have to do, ms; it takes some 50 ms to start. */
const WORTH = 200;
/** Maximum number of workers, each of which has its own memory. */
const MOST = 8;

/** An ensemble without a closed form, whose scene is solved. */
interface Job {
  module: WebAssembly.Module;
  solution: Solution;
  /** The number of bodies to compute. */
  count: number;
  /** The number of processors. */
  processors: number;
}

interface Listener {
  /** Gets the fraction of the bodies that are known. */
  progress: (part: number) => void;
  /** Gets slices of the bodies from the first on, and why a worker failed. */
  complete: (slices: readonly Slice[], failure: string) => void;
}

/**
 * Computes the bodies of an ensemble in the worker that has solved its scene, and in others if there is work for them.
 * A body never depends on the others, so the bits are the same for any number of workers.
 */
export class Pool {
  private readonly slices: Slice[] = [];
  /** What each worker was asked for. */
  private readonly asked = new Map<Worker, Piece[]>();
  /** Pieces of workers that failed. */
  private readonly left: Piece[] = [];
  private next = 0;
  private known = 0;
  /** The time that the known bodies took, ms. */
  private spent = 0;
  private failure = "";
  private readonly until = Date.now() + BUDGET;

  constructor(
    private readonly first: Worker,
    private readonly job: Job,
    private readonly start: () => Worker,
    private readonly listener: Listener,
  ) {
    this.asked.set(first, []);
    this.ask(first, FIRST);
  }

  /** Takes a slice from a worker. */
  take(worker: Worker, slice: Slice, took: number): void {
    const pieces = this.asked.get(worker);
    if (!pieces) return;
    pieces.shift();
    this.slices.push(slice);
    this.known += slice.to - slice.from;
    this.spent += took;
    this.listener.progress(this.known / this.job.count);
    this.enlarge();
    this.feed(worker);
    this.finish();
  }

  /** Gives the work of a worker that failed to the others. */
  lose(worker: Worker, message: string): void {
    const pieces = this.asked.get(worker);
    if (!pieces) return;
    this.failure ||= message;
    this.left.push(...pieces);
    this.asked.delete(worker);
    if (worker !== this.first) worker.terminate();
    for (const other of this.asked.keys()) this.feed(other);
    this.finish();
  }

  /** Ends the workers that were started. */
  stop(): void {
    for (const worker of this.asked.keys()) if (worker !== this.first) worker.terminate();
    this.asked.clear();
  }

  /** Starts further workers if what is left is worth it. */
  private enlarge(): void {
    const { count, processors } = this.job;
    const worth = 1 + Math.floor(((count - this.next) * this.spent) / this.known / WORTH);
    const most = this.failure ? 1 : Math.min(MOST, processors, worth);
    while (this.asked.size < most) this.help(this.start());
  }

  private help(worker: Worker): void {
    worker.addEventListener("message", ({ data }: MessageEvent<Report>) => {
      if (data.kind === "slice") this.take(worker, data.slice, data.took);
      else if (data.kind === "problem") this.lose(worker, data.message);
    });
    worker.addEventListener("error", (event) => {
      event.preventDefault();
      this.lose(worker, event.message);
    });
    this.asked.set(worker, []);
    const { module, solution } = this.job;
    worker.postMessage({ module, solution } satisfies Order);
    this.feed(worker);
  }

  private feed(worker: Worker): void {
    // Shorter pieces towards the end, so that all workers end together.
    const share = (this.job.count - this.next) / (AHEAD * this.asked.size);
    const size = Math.max(Math.floor(Math.min((PIECE * this.known) / this.spent, share)), 1);
    while ((this.asked.get(worker)?.length ?? AHEAD) < AHEAD && this.ask(worker, size));
  }

  /** Asks a worker for more bodies; false if there is nothing left to do. */
  private ask(worker: Worker, size: number): boolean {
    if (Date.now() > this.until) return false;
    const piece = this.left.pop() ?? this.cut(size);
    if (!piece) return false;
    this.asked.get(worker)!.push(piece);
    worker.postMessage({ piece } satisfies Order);
    return true;
  }

  private cut(size: number): Piece | null {
    const { next: from, until } = this;
    if (from === this.job.count) return null;
    this.next = Math.min(from + size, this.job.count);
    return { from, to: this.next, until };
  }

  /** Reports the slices once all that was asked for is there. */
  private finish(): void {
    if ([...this.asked.values()].some((pieces) => pieces.length > 0)) return;
    this.stop();
    const slices = this.slices.sort((a, b) => a.from - b.from);
    const gap = slices.findIndex(({ from }, k) => from !== (slices[k - 1]?.to ?? 0));
    this.listener.complete(gap < 0 ? slices : slices.slice(0, gap), this.failure);
  }
}
