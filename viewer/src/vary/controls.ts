import { batch, computed, effect, type ReadonlySignal, signal } from "@preact/signals";
import { type About, type LawEntry, State, type Triple } from "../core/core.ts";
import { firstRow, type Model } from "../model/model.ts";
import { type BodyChoice, bodyOf, bodyTable, spreadOf } from "./body.ts";
import { HOLDING, type LawForm, type LawsChoice, WEIGHT, lawsFor, lawTables, noLaws } from "./laws.ts";
import { type StartChoice, startOf, startTable } from "./start.ts";
import { rateUnit, timeUnit } from "../panels/units.ts";
import { fields, table } from "./toml.ts";

type Group = "body" | "start" | "laws" | "run";

/**
 * What the sliders say. They begin with the scene as it was opened; each that is moved has its table of the scene
 * replaced, at most once in a frame.
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

  /** The torque laws of the core. */
  readonly registry: readonly LawEntry[];

  private readonly touched = new Set<Group>();
  private frame = 0;
  private readonly forget: () => void;
  private momentum = 0;

  constructor(private readonly model: Model) {
    this.registry = model.core.laws;
    this.about = computed(() => (model.scene.value === null ? null : model.opened.value));
    this.forms = computed(() => {
      const about = this.about.value;
      return about ? lawsFor(this.registry, about, this.momentum, sizeOf(about), this.byPivot.value) : [];
    });
    this.forget = effect(() => {
      const about = model.opened.value;
      if (about) this.begin(about);
    });
  }

  /** Whether gravity is said by a pivot in the body: for a solid, and for a mesh that is not held elsewhere. */
  private readonly byPivot = computed(() => {
    const [about, body] = [this.about.value, this.body.value];
    if (!about || !body) return true;
    return body.form === "scene" ? about.body.mesh : body.form !== "masses";
  });

  /** Whether the body may be given by its masses, or by a solid, although it is held: only gravity may act then. */
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

  /** The laws of the scene, or those chosen here, which begin with the weight that the scene has. */
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
    this.forget();
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
    this.momentum = row ? Math.hypot(...three(State.momentumSpace)) : 0;
    batch(() => {
      this.body.value = bodyOf(about);
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
      this.model.change(this.tables());
    });
  }

  /** The tables of all that was moved. */
  private tables(): string {
    const about = this.about.value;
    const [body, start, laws] = [this.body.value, this.start.value, this.laws.value];
    if (!about || !body || !start) return "";
    const parts: string[] = [];
    if (this.touched.has("run")) parts.push(runFields(this.duration.value, about.samples));
    const chosen = this.touched.has("laws") && laws.from === "here";
    if (this.touched.has("body") && body.form !== "scene") {
      parts.push(bodyTable(body));
      const moved = body.form === "masses" || !about.body.solid;
      if (about.held && moved && !chosen) parts.push(this.weightAsBefore(about));
    } else if (chosen && laws.on.has(WEIGHT)) {
      // The weight acts on a body that is held at the origin of its axes, so its moments are said about that.
      parts.push(bodyTable({ ...body, form: "masses" }));
    }
    if (this.touched.has("start")) parts.push(startTable(start, rateUnit(start.spin.rate)));
    if (chosen) {
      parts.push(lawTables(laws, this.forms.value, about));
      const held = [...laws.on].some((name) => HOLDING.has(name));
      if (held && start.path) parts.push(table("force"));
    }
    return parts.join("\n");
  }

  /** The weight of the scene for a body that is said anew: its moments are those about the fixed point. */
  private weightAsBefore(about: About): string {
    const on = new Set([this.forms.value[0]!.name]);
    return lawTables({ from: "here", on, values: {} }, this.forms.value, about);
  }
}

/** The duration, in as many samples as before: an interval need not divide it. */
function runFields(duration: number, samples: number): string {
  const unit = timeUnit(duration);
  const size = Number((duration / unit.size).toPrecision(12));
  return fields("run", { duration: `${size} ${unit.scene}`, samples, interval: {} });
}

/** About how large a body is, in m. */
function sizeOf(about: About): number {
  const spread = Math.max(...spreadOf(about.body.moments));
  const arm = Math.hypot(...about.body.center_of_mass);
  return Number(Math.max(Math.sqrt((12 * spread) / (about.body.mass ?? 1)), 2 * arm).toPrecision(2));
}
