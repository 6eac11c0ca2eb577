import type { About } from "../core/core.ts";
import type { Shown } from "../document.ts";
import { namedAxes } from "../stage/axes.ts";
import type { Figure } from "../stage/figure.ts";

/** A thing in the picture: its layer, its name, and how its colour is shown. */
export interface Entry {
  layer: keyof Shown;
  name: string;
  /** `disc`, `line`, `dashed`, `arrow`, `plane`, `axes` or `dot`. */
  look: string;
  /** The variable of its colour in the style. */
  colour: string;
  /** What it is, in the glossary. */
  term?: string;
}

/** What of a motion `acting` draws, and whether there is a torque. */
type Acts = Pick<Figure, "acting" | "torque">;

const KINDS = { planet: "planet", field: "field B", dipole: "dipole m", sun: "sun", wheel: "wheel" };

/** The things that the picture of a motion may have, by layer. */
export function entriesOf(about: About, { acting, torque }: Acts): Entry[] {
  const axes = namedAxes(about.body);
  const kinds = new Set((acting?.sources ?? []).map(({ kind }) => KINDS[kind]));
  if ((acting?.thrusts.length ?? 0) > 0) kinds.add("thrust F");
  const own = axes.own ? "body axes" : "body and principal axes";
  const entries: (Entry | false)[] = [
    { layer: "omega", name: "Ω, angular velocity", look: "disc", colour: "omega", term: "angular velocity" },
    {
      layer: "momentum",
      name: "L, angular momentum",
      look: "disc",
      colour: "momentum",
      term: "angular momentum",
    },
    torque > 0 && { layer: "torque", name: "T, torque", look: "disc", colour: "torque", term: "torque" },
    { layer: "axial", name: "axial vectors", look: "arrow", colour: "muted", term: "axial vector" },
    { layer: "energy", name: "Ω, its tip", look: "dot", colour: "omega", term: "angular velocity" },
    { layer: "bodyFrame", name: `f, ${own}`, look: "axes", colour: "text", term: "body axes" },
    { layer: "spaceFrame", name: "e, space axes", look: "axes pale", colour: "text", term: "space axes" },
    {
      layer: "trace",
      name: about.held ? "path of the axis" : "path of an axis",
      look: "line",
      colour: "trace",
    },
    { layer: "polhode", name: "polhode", look: "line", colour: "polhode", term: "polhode" },
    { layer: "herpolhode", name: "herpolhode", look: "line", colour: "herpolhode", term: "herpolhode" },
    {
      layer: "poinsot",
      name: "energy ellipsoid, invariable plane",
      look: "plane",
      colour: "polhode",
      term: "invariable plane",
    },
    about.held && { layer: "gravity", name: "pivot, weight", look: "arrow", colour: "weight" },
    kinds.size > 0 && { layer: "sources", name: [...kinds].join(", "), look: "arrow", colour: "weight" },
  ];
  return entries.filter((entry) => entry !== false);
}
