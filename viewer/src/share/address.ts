import { effect } from "@preact/signals";
import { Problem } from "../core/core.ts";
import type { PageDocument } from "../document.ts";
import type { Lessons } from "../lessons/lessons.ts";
import { type Model, words } from "../model/model.ts";
import { restore, stateOf } from "./page-state.ts";
import { fragmentOf, isState, stateOfFragment } from "./state.ts";

/** The longest fragment that is written: programs that pass addresses on cut longer ones off. */
const LONGEST = 16_000;
/** The time in ms without a change after which the address is written. */
const PAUSE = 400;

/** The address of a page, whose fragment holds what the page shows. */
export class Address {
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** The address that was written last, and what in it is compared with the next one. */
  private last: string | null = null;
  private key: string | null = null;

  /**
   * `own` is the document of the page. An address that is `kept` always has what is shown; another one, of a page with
   * more than this viewer, is only read when the page is opened.
   */
  constructor(
    private readonly model: Model,
    private readonly own: () => PageDocument | null,
    private readonly kept: boolean,
  ) {}

  /** Whether the address of the page holds a state, or ought to. */
  get given(): boolean {
    const fragment = location.hash.slice(1);
    return fragment !== "" && (this.kept || isState(fragment));
  }

  /** Shows what the address holds. A Problem if it is malformed; nothing has changed then. */
  async read(hash = location.hash): Promise<void> {
    try {
      await restore(this.model, await stateOfFragment(hash.slice(1)), this.own());
    } catch (error) {
      throw new Problem(`the part of the address after # was ignored: ${words(error)}`);
    }
  }

  /** The address with what is shown; a Problem if it would be too long. */
  async written(lessons: Lessons): Promise<string> {
    const fragment = await fragmentOf(await stateOf(this.model, lessons, this.own()));
    if (fragment.length > LONGEST)
      throw new Problem(
        `the scene is too large for an address: ${fragment.length.toLocaleString("en")} letters of at most ` +
          `${LONGEST.toLocaleString("en")}. Save the page instead`,
      );
    return `${location.href.replace(/#.*$/u, "")}#${fragment}`;
  }

  /** Keeps the address up to date, and shows what another one holds; returns the function that stops both. */
  keep(lessons: Lessons): () => void {
    if (!this.kept) return () => {};
    const { model } = this;
    // The address with which the page was opened stays until something changes.
    void this.write(lessons);
    const stop = effect(() => {
      // Not the time while it runs: the address gets it when the motion stops.
      if (!model.playing.value) void model.time.value;
      const { page, scene, speed, camera, pose, theme, shown, lines, lesson } = model;
      for (const watched of [page, scene, speed, camera, pose, theme, shown, lines, lesson])
        void watched.value;
      void lessons.index.value;
      // Once nothing changes any more: not while a slider is dragged.
      clearTimeout(this.timer);
      this.timer = setTimeout(() => void this.write(lessons), PAUSE);
    });
    // The address of the event: that of the page may have been written in the meantime.
    const changed = ({ newURL }: HashChangeEvent): void => {
      const { hash } = new URL(newURL);
      if (newURL === this.last || hash === "") return;
      this.read(hash).catch((error: unknown) => (model.problem.value = words(error)));
    };
    window.addEventListener("hashchange", changed);
    return () => {
      stop();
      window.removeEventListener("hashchange", changed);
      clearTimeout(this.timer);
      this.timer = undefined;
    };
  }

  private async write(lessons: Lessons): Promise<void> {
    this.timer = undefined;
    const { model } = this;
    if (model.solving.peek() || model.motion.peek() === null) return;
    const address = await this.written(lessons).catch(() => null);
    if (address === null) return;
    // While the time runs, it is not a change.
    const key = model.playing.peek() ? address.replace(/&t=[^&]*/u, "") : address;
    if (key === this.key) return;
    const first = this.key === null;
    [this.key, this.last] = [key, address];
    if (first) return;
    try {
      history.replaceState(history.state, "", address);
    } catch {
      // Frames without an address of their own.
    }
  }
}
