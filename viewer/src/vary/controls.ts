import { batch, computed, effect, type ReadonlySignal, signal } from "@preact/signals";
import { type About, sizeAt, State, type Triple } from "../core/core.ts";
import { rateUnit, timeUnit } from "../format/units.ts";
import type { Model } from "../model/model.ts";
import { firstRow } from "../model/speed.ts";
import { type BodyChoice, bodyOf, bodyTable } from "./body.ts";
import { HOLDING, type LawForm, type LawsChoice, WEIGHT, lawsFor, lawTables, noLaws } from "./laws.ts";
import { type StartChoice, startOf, startTable } from "./start.ts";
import { fields, table } from "./toml.ts";

type Group = "body" | "start" | "laws" | "run";

interface ControlValues {
  body: BodyChoice | null;
  start: StartChoice | null;
  laws: LawsChoice;
  duration: number;
  /** What was changed. */
  touched: Group[];
}

/**
 * The values of the controls. They start from the scene as it was opened; a control that is changed replaces its table
 * of the scene, at most once per frame.
 */
export class Controls {
  /** Null where there is no scene to vary. */
  readonly about: ReadonlySignal<About | null>;
  readonly body = signal<BodyChoice | null>(null);
  readonly start = signal<StartChoice | null>(null);
  readonly laws = signal<LawsChoice>(noLaws());
  readonly duration = signal(0);
  /** The laws to choose from. */
  readonly forms: ReadonlySignal<LawForm[]>;

  private readonly touched = new Set<Group>();
  private frame = 0;
  private readonly unsubscribe: () => void;
  private momentum = 0;
  private size = 1;

  constructor(readonly model: Model) {
    this.about = computed(() => (model.scene.value === null ? null : model.opened.value));
    this.forms = computed(() => {
      const about = this.about.value;
      return about ? lawsFor(model.core.laws, about, this.momentum, this.size, this.byPivot.value) : [];
    });
    const unsubscribe = effect(() => {
      const about = model.opened.value;
      if (about) this.begin(about);
    });
    model.keep(this);
    this.unsubscribe = () => {
      unsubscribe();
      model.keep(null);
    };
  }

  /** All values, for the history. */
  take(): ControlValues {
    return {
      body: this.body.value,
      start: this.start.value,
      laws: this.laws.value,
      duration: this.duration.value,
      touched: [...this.touched],
    };
  }

  /** Sets the values that were taken; without them, those of the scene. */
  give(kept: unknown): void {
    const about = this.model.opened.peek();
    if (about) this.begin(about);
    if (!kept) return;
    const { body, start, laws, duration, touched } = kept as ControlValues;
    batch(() => {
      [this.body.value, this.start.value, this.laws.value] = [body, start, laws];
      this.duration.value = duration;
    });
    for (const group of touched) this.touched.add(group);
  }

  /** Whether gravity is given by a pivot in the body: for a solid, and for a mesh without a fixed point. */
  private readonly byPivot = computed(() => {
    const [about, body] = [this.about.value, this.body.value];
    if (!about || !body) return true;
    return body.form === "scene" ? about.body.mesh : body.form !== "masses";
  });

  /** Whether the form of the body may change: a held body may have no laws but gravity. */
  readonly free = computed(() => {
    const about = this.about.value;
    return !about?.held || about.laws.every(({ name }) => HOLDING.has(name));
  });

  setBody(body: BodyChoice): void {
    this.body.value = body;
    this.change("body");
  }

  setStart(start: StartChoice): void {
    this.start.value = start;
    this.change("start");
  }

  setLaws(laws: LawsChoice): void {
    this.laws.value = laws;
    this.change("laws");
  }

  /** Takes the laws of the scene, or those chosen here, which include the weight if the body is held. */
  chooseLaws(from: LawsChoice["from"]): void {
    const laws = this.laws.value;
    const first = this.about.value?.held ? [this.forms.value[0]!.name] : [];
    this.setLaws({ ...laws, from, on: laws.on.size > 0 ? laws.on : new Set(first) });
  }

  setDuration(duration: number): void {
    this.duration.value = duration;
    this.change("run");
  }

  dispose(): void {
    this.unsubscribe();
    cancelAnimationFrame(this.frame);
  }

  private begin(about: About): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.touched.clear();
    const motion = this.model.motion.peek();
    const row = motion && firstRow(motion);
    const three = (at: number): Triple => [row![at]!, row![at + 1]!, row![at + 2]!];
    const moves =
      row && !about.held && row.subarray(State.position, State.velocity + 3).some((part) => part !== 0);
    this.momentum = row ? sizeAt(row, State.momentumSpace) : 0;
    const longest = Math.max(...(motion?.extents() ?? [1]), 2 * Math.hypot(...about.body.center_of_mass));
    this.size = Number(longest.toPrecision(2));
    batch(() => {
      this.body.value = bodyOf(about, this.model.core);
      this.start.value = startOf(
        about,
        moves ? { position: three(State.position), velocity: three(State.velocity) } : null,
      );
      this.laws.value = noLaws();
      this.duration.value = about.duration;
    });
  }

  private change(group: Group): void {
    this.touched.add(group);
    if (this.frame !== 0) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      void this.model.change(this.tables());
    });
  }

  /** The tables of everything that was changed. */
  private tables(): string {
    const about = this.about.value;
    const [body, start, laws] = [this.body.value, this.start.value, this.laws.value];
    if (!about || !body || !start) return "";
    const { core } = this.model;
    const parts: string[] = [];
    if (this.touched.has("run")) parts.push(runFields(this.duration.value, about.samples));
    const chosen = this.touched.has("laws") && laws.from === "here";
    if (this.touched.has("body") && body.form !== "scene") {
      parts.push(bodyTable(body, core));
      const moved = body.form === "masses" || !about.body.solid;
      if (about.held && moved && !chosen) parts.push(this.sameWeight(about));
    } else if (chosen && laws.on.has(WEIGHT)) {
      // This law holds the body at the origin of its axes, so the moments must be about that point.
      parts.push(bodyTable({ ...body, form: "masses" }, core));
    }
    if (this.touched.has("start")) parts.push(startTable(start, rateUnit(start.spin.rate)));
    if (chosen) {
      parts.push(lawTables(laws, this.forms.value, about));
      const held = [...laws.on].some((name) => HOLDING.has(name));
      if (held && start.path) parts.push(table("force"));
    }
    return parts.join("\n");
  }

  /** The weight of the scene for another body, whose moments are about the fixed point. */
  private sameWeight(about: About): string {
    const on = new Set([this.forms.value[0]!.name]);
    return lawTables({ from: "here", on, values: {} }, this.forms.value, about);
  }
}

/** The duration with the same number of samples; `interval` is removed because it need not divide the duration. */
function runFields(duration: number, samples: number): string {
  const unit = timeUnit(duration);
  const size = Number((duration / unit.size).toPrecision(12));
  return fields("run", { duration: `${size} ${unit.scene}`, samples, interval: {} });
}
