import { effect, type ReadonlySignal, signal } from "@preact/signals";
import { render } from "preact";
import { Problem, State } from "./core/core.ts";
import { loadCore } from "./core/load.ts";
import { type PageDocument, parsed, type ViewState } from "./document.ts";
import { Model, words } from "./model/model.ts";
import { paletteOf, variables } from "./model/theme.ts";
import { LIGHT, type Palette } from "./palette.ts";
import { App } from "./panels/app.tsx";
import { regimeOf } from "./panels/regime.ts";
import { bindKeys, commitOnEnter } from "./panels/keys.ts";
import { mayAutoplay, openPreset, PRESETS } from "./presets/index.ts";
import { Address } from "./share/address.ts";
import type { Sharing } from "./share/share.tsx";
import { type PictureOptions, Stage } from "./stage/stage.ts";
import styles from "./theme.css?inline";

/** Panels are beside the picture from this width on, in px; the same as in theme.css. */
const WIDE = 900;

/** For captured pictures. */
const PAPER: Palette = { ...LIGHT, background: "#ffffff" };

/**
 * `<polhode-viewer>`: a motion, its read-outs and its controls. It shows the document in its property `document`, in a
 * child `<script type="application/json">` or at the address in `src`; without one, the first preset.
 *
 * Attributes: `theme` is auto, light or dark; `compact` leaves out panels where space is small; `titled` gives the
 * document the title of the scene; `bare` draws nothing but what `capture` returns. It dispatches `connected` and `disconnected`: notebooks remove cells that are scrolled
 * away, and restore them. The attributes `data-…` have the state that is shown, with all digits.
 */
export class PolhodeViewer extends HTMLElement {
  static readonly observedAttributes = ["theme", "compact", "src"];

  /** The script of the viewer, where whoever embeds it has it: a notebook. Its address is then not the viewer's. */
  script: (() => string | undefined) | null = null;

  /** The state of the page, once the core is loaded. */
  ready: Promise<Model>;

  private resolve!: (model: Model) => void;
  /** Rejected if the viewer cannot start. */
  private readonly failure: Promise<never>;
  private fail!: (error: unknown) => void;
  private given: PageDocument | null = null;
  private model: Model | null = null;
  private palette: ReadonlySignal<Palette> | null = null;
  private sharing: Sharing | null = null;
  private leave: (() => void)[] = [];
  /** The stage of `capture`. */
  private studio: Stage | null = null;
  private readonly place: HTMLElement;
  /** Not in the attribute `style`, which belongs to the embedding page. */
  private readonly colours = document.createElement("style");

  constructor() {
    super();
    this.ready = new Promise((resolve) => (this.resolve = resolve));
    this.failure = new Promise<never>((_, reject) => (this.fail = reject));
    this.failure.catch(() => {});
    const root = this.attachShadow({ mode: "open" });
    const style = document.createElement("style");
    style.textContent = styles;
    this.place = document.createElement("div");
    this.place.className = "place";
    root.append(style, this.colours, this.place);
  }

  get document(): PageDocument | null {
    return this.given;
  }

  set document(given: PageDocument | null) {
    this.given = given;
    if (given) void this.model?.show(given).catch(this.report);
  }

  connectedCallback(): void {
    // A property set before the element was defined hides the accessor.
    if (Object.hasOwn(this, "document")) {
      const early = (this as { document: PageDocument | null }).document;
      Reflect.deleteProperty(this, "document");
      this.given = early;
    }
    if (!this.model) {
      this.dataset["state"] = "loading";
      render(<p class="notice">Loading…</p>, this.place);
      void this.start();
    }
    this.dispatchEvent(new Event("connected"));
  }

  disconnectedCallback(): void {
    // Notebooks move elements: one that is connected again by then was only moved.
    queueMicrotask(() => {
      if (!this.isConnected) this.stop();
    });
    this.dispatchEvent(new Event("disconnected"));
  }

  attributeChangedCallback(name: string, _old: string | null, value: string | null): void {
    if (!this.model) return;
    if (name === "theme") this.model.look({ theme: themeOf(value) });
    else if (name === "src")
      void this.source()
        .then((given) => given && this.model?.show(given))
        .catch(this.report);
    else this.draw(this.model);
  }

  private async start(): Promise<void> {
    try {
      const model = new Model(await loadCore());
      if (!this.isConnected || this.model) return;
      this.model = model;
      if (this.hasAttribute("theme")) model.look({ theme: themeOf(this.getAttribute("theme")) });
      this.sharing = this.shared(model);
      await this.first(model).catch(this.report);
      // The element may have been removed in the meantime.
      if (this.model !== model) return;
      this.watch(model);
      this.draw(model);
      this.resolve(model);
    } catch (error) {
      this.report(error);
    }
  }

  /** Shows the given document, by default playing. */
  private async first(model: Model): Promise<void> {
    const given = this.given ?? (await this.child()) ?? (await this.source());
    this.given ??= given;
    const { address } = this.sharing!;
    if (address?.given) {
      try {
        await address.read();
        return;
      } catch (error) {
        // After the scene of the page is shown, which removes older problems.
        void this.ready.then(() => this.report(error));
      }
    }
    if (given) await model.show(given);
    if (!given?.scene && !given?.recorded && !given?.lesson) await openPreset(model, PRESETS[0]!);
    else if (given.view?.playing === undefined && !this.hasAttribute("compact"))
      model.look({ playing: mayAutoplay() });
  }

  /** What the page may share. Its address is that of the viewer if it has no other viewer and is not a notebook. */
  private shared(model: Model): Sharing {
    const alone = this.ownerDocument.querySelectorAll(this.localName).length === 1;
    const own = () => this.given;
    const has = alone && this.script === null && !this.hasAttribute("bare");
    return {
      address: has ? new Address(model, own, this.hasAttribute("titled")) : null,
      own,
      script: this.script,
    };
  }

  /** The document inside the element, after it was parsed. */
  private async child(): Promise<PageDocument | null> {
    if (this.ownerDocument.readyState === "loading") {
      await new Promise((done) =>
        this.ownerDocument.addEventListener("DOMContentLoaded", done, { once: true }),
      );
    }
    const script = this.querySelector('script[type="application/json"]');
    return script ? parsed(script.textContent ?? "", "the document inside <polhode-viewer>") : null;
  }

  private async source(): Promise<PageDocument | null> {
    const address = this.getAttribute("src");
    if (address === null) return null;
    const url = new URL(address, this.ownerDocument.baseURI);
    if (url.origin !== new URL(this.ownerDocument.baseURI).origin) {
      throw new Problem(`${address} is on another server; src must be on the server of the page`);
    }
    const answer = await fetch(url);
    if (!answer.ok) throw new Problem(`${address} cannot be read: ${answer.status} ${answer.statusText}`);
    return parsed(await answer.text(), address);
  }

  /** Shows an error; before the page is drawn, in its place. */
  private readonly report = (error: unknown): void => {
    if (this.model) {
      this.model.problem.value = words(error);
      return;
    }
    this.fail(error);
    this.dataset["state"] = "problem";
    render(
      <div class="notice" role="alert">
        <p>The viewer cannot start.</p>
        <pre>{words(error)}</pre>
      </div>,
      this.place,
    );
  };

  /**
   * Draws the state at a time on white, without the page around it, and returns a PNG in base64. For films and
   * figures: no clock runs, and equal times give equal pictures.
   */
  async capture(time: number, options: PictureOptions): Promise<string> {
    const model = await Promise.race([this.ready, this.failure]);
    if (model.problem.value !== null) throw new Problem(model.problem.value);
    this.studio ??= new Stage(document.createElement("div"), model, signal(PAPER));
    model.playing.value = false;
    model.seek(time);
    if (model.time.value !== time) throw new Problem(`the motion is not known at t = ${time} s`);
    return this.studio.picture(options).toDataURL("image/png").replace(/^.*,/, "");
  }

  private draw(model: Model): void {
    if (!this.palette || this.hasAttribute("bare")) return;
    const compact = this.hasAttribute("compact");
    const wide = this.clientWidth >= WIDE;
    const { palette, sharing } = this;
    render(<App {...{ model, palette, compact, wide }} sharing={sharing!} />, this.place);
  }

  /** Keeps colours and `data-…` up to date, and binds the keys. */
  private watch(model: Model): void {
    const { palette, dispose } = paletteOf(model);
    this.palette = palette;
    this.leave = [
      dispose,
      effect(() => {
        const set = variables(palette.value).map(([name, colour]) => `${name}: ${colour};`);
        this.colours.textContent = `:host { ${set.join(" ")} }`;
      }),
      effect(() => this.publish(model)),
      effect(() => {
        const title = model.about.value?.title ?? null;
        if (title !== null && this.hasAttribute("titled")) this.ownerDocument.title = title;
      }),
      bindKeys(this, model),
      commitOnEnter(this),
    ];
  }

  private publish(model: Model): void {
    const about = model.about.value;
    const row = model.row.value;
    const data = this.dataset;
    const settled = model.problem.value === null ? "ready" : "problem";
    data["state"] = model.solving.value ? "solving" : settled;
    data["method"] = about?.method ?? "";
    data["regime"] = regimeOf(about);
    const of = (first: number, count: number) =>
      row ? Array.from(row.subarray(first, first + count), String).join(" ") : "";
    data["time"] = of(State.time, 1);
    data["rotor"] = of(State.rotor, 4);
    data["omegaBody"] = of(State.omegaBody, 3);
    data["omegaSpace"] = of(State.omegaSpace, 3);
    data["momentumSpace"] = of(State.momentumSpace, 3);
    data["energy"] = of(State.energy, 1);
  }

  private stop(): void {
    for (const leave of this.leave) leave();
    this.leave = [];
    this.studio?.dispose();
    this.studio = null;
    render(null, this.place);
    this.model?.dispose();
    if (this.model) this.ready = new Promise((resolve) => (this.resolve = resolve));
    this.model = null;
  }
}

function themeOf(value: string | null): ViewState["theme"] {
  return value === "light" || value === "dark" ? value : "auto";
}

/** Defines the element, once. */
export function define(): void {
  if (!customElements.get("polhode-viewer")) customElements.define("polhode-viewer", PolhodeViewer);
}
