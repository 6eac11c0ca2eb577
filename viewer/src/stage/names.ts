import type { Shown } from "../document.ts";
import type { CurveName, Model } from "../model/model.ts";
import { cloudOf } from "../vary/cloud.ts";

/** What curves are, in the words that stand beside the pointer. */
const NAMES: Record<Exclude<CurveName, "cloud">, string> = {
  polhode: "Polhode: the path of Ω in the body",
  herpolhode: "Herpolhode: the path of Ω in space",
  trace: "The path of an axis of the body in space",
  separatrix: "Separatrix: divides the paths around the smallest from those around the largest moment",
  neighbours: "Path of Ω for the same energy and another |L|",
};

/** The name of a curve, or the sentence about the cloud of an ensemble. */
export function named(name: CurveName, model: Model): string {
  if (name !== "cloud") return NAMES[name];
  return cloudOf(model.scene.peek(), model.about.peek()) ?? "Bodies of the ensemble";
}

/** What is drawn: while the pointer is over the path of Ω in the body, also one in space that corresponds to it. */
export function revealed(shown: Shown, pointed: CurveName | null): Shown {
  if (pointed !== "polhode" || shown.herpolhode || shown.trace) return shown;
  return { ...shown, herpolhode: true };
}
