import { type About, BODIES } from "../core/core.ts";
import { tableOf, type Value } from "./read.ts";

/** Fields of `[ensemble]` that are not variations. */
const OTHERS = new Set(["number", "seed", "keep", "covariance", "grid", "list", "table"]);

/** What the cloud of an ensemble is, in words; null for one body. */
export function cloudOf(scene: string | null, about: About | null): string | null {
  if (!about || about.ensemble === null || scene === null) return null;
  const drawn = Math.min(about.ensemble, BODIES);
  const many = (number: number) => number.toLocaleString("en");
  const count = drawn < about.ensemble ? `the first ${many(drawn)} of ${many(about.ensemble)}` : many(drawn);
  const spin = about.start.omega_body.map(Math.abs);
  const axis = `the direction of its axis f${"₁₂₃"[spin.indexOf(Math.max(...spin))]}`;
  const place = about.held ? "the direction from the fixed point to its centre of mass" : axis;
  return (
    `${count[0]!.toUpperCase()}${count.slice(1)} bodies, ${varied(tableOf(scene, "ensemble") ?? {})}. Each small box ` +
    `is one body: it lies in ${place}, and is turned like it. The colour is the same for all; the large body has the ` +
    "values of the scene itself."
  );
}

function varied(table: Record<string, Value>): string {
  const drawn = leaves(table).map(([name, value]) => `${name} ${spreadOf(value)}`);
  const points = pointsOf(table);
  const { covariance } = table;
  for (const one of covariance === undefined ? [] : [covariance].flat()) {
    const of = (one as { of?: Value }).of;
    drawn.push(
      `${[of].flat().join(" and ")} drawn together from a normal distribution with a covariance matrix`,
    );
  }
  const seed = drawn.length > 0 ? ` (seed ${String(table["seed"] ?? 0)})` : "";
  const parts = [...points, ...(drawn.length > 0 ? [`with ${listed(drawn)}${seed}`] : [])];
  return parts.join(", ");
}

/** The variations by their dotted names. */
function leaves(table: Record<string, Value>, above = ""): [string, Value][] {
  return Object.entries(table).flatMap(([name, value]): [string, Value][] => {
    if (above === "" && OTHERS.has(name)) return [];
    const full = above ? `${above}.${name}` : name;
    return isTable(value) && !isSpread(value) ? leaves(value, full) : [[full, value]];
  });
}

const isTable = (value: Value): value is Record<string, Value> =>
  typeof value === "object" && !Array.isArray(value);

const isSpread = (value: Record<string, Value>): boolean =>
  ["normal", "uniform", "relative", "direction"].some((kind) => kind in value);

function spreadOf(value: Value): string {
  if (!isTable(value)) return value === "uniform" ? "uniform over all attitudes" : String(value);
  const { normal, uniform, relative, direction } = value;
  const found = [
    direction !== undefined && "in a uniform direction",
    normal !== undefined && `normal with a deviation of ${width(normal)}`,
    uniform !== undefined && `uniform within ±${width(uniform)}`,
    relative !== undefined && `times a log-normal factor of width ${width(relative)}`,
  ];
  return found.filter(Boolean).join(", ");
}

function width(value: Value): string {
  return Array.isArray(value) ? `(${value.map(String).join(", ")})` : String(value);
}

/** The given points: a grid, lists or a table. */
function pointsOf({ grid, list, table }: Record<string, Value>): string[] {
  const named = (of: Value) => values(of as Record<string, Value>).map(([name, many]) => `${name} (${many})`);
  return [
    ...(grid === undefined ? [] : [`on the grid of ${named(grid).join(" × ")} values`]),
    ...(list === undefined ? [] : [`one for each row of the lists of ${listed(named(list))} values`]),
    ...(typeof table === "string" ? [`one for each row of ${table}`] : []),
  ];
}

/** The fields of a grid by their dotted names, and how many values each has. */
function values(table: Record<string, Value>, above = ""): [string, number][] {
  return Object.entries(table).flatMap(([name, value]): [string, number][] => {
    const full = above ? `${above}.${name}` : name;
    if (Array.isArray(value)) return [[full, value.length]];
    if (!isTable(value)) return [];
    return typeof value["number"] === "number" ? [[full, value["number"]]] : values(value, full);
  });
}

function listed(items: readonly string[]): string {
  return items.length < 2 ? items.join("") : `${items.slice(0, -1).join(", ")} and ${items.at(-1)!}`;
}
