import { Problem } from "../core/core.ts";
import type { Core } from "../core/wasm.ts";
import { CAMERAS, type CameraName, type Shown } from "../document.ts";
import { SHOWN } from "../model/model.ts";
import type { Settings, Subject } from "./lesson.ts";

/** Tables of a scene that a lesson may change. */
const TABLES = ["body", "define", "ensemble", "force", "gravity", "initial", "method", "run", "torque"];
const PARTS = Object.keys(SHOWN) as (keyof Shown)[];
const KEYS = ["camera", "time", "speed", "play", "pause", "show", "hide", "only", "caption"];

/**
 * Parses settings such as `camera = along L; show = poinsot; initial.spin = 1 rev/s e1∧e2`. A Problem says what is wrong
 * and what to write.
 */
export function settingsOf(text: string, subject: Subject, core: Core): Settings {
  const found: Settings = {};
  for (const item of items(text)) {
    const [key, value] = divided(item);
    if (key.startsWith("let ")) {
      const name = key.slice(4).trim();
      defines(subject, name);
      found.values = { ...found.values, [name]: value };
    } else if (key.includes(".")) {
      found.fields = { ...found.fields, [key]: fieldOf(key, value, subject, core) };
    } else {
      Object.assign(found, setting(key, value, found, core));
    }
  }
  return found;
}

function setting(key: string, value: string, found: Settings, core: Core): Settings {
  switch (key) {
    case "play":
    case "pause":
      if (value) throw new Problem(`${key} takes no value, got ${quoted(value)}`);
      return { playing: key === "play" };
    case "camera":
      return { camera: among<CameraName>("camera", value, CAMERAS) };
    case "time":
      return { time: number("time", value, core) };
    case "speed":
      return { speed: number("speed", value, core) };
    case "caption":
      return { caption: value };
    case "show":
    case "hide":
    case "only": {
      const names = value.split(",").map((name) => among<keyof Shown>(key, name.trim(), PARTS));
      const shown = { ...found.shown, ...Object.fromEntries(names.map((name) => [name, key !== "hide"])) };
      return key === "only" ? { shown, only: true } : { shown };
    }
    default:
      throw new Problem(
        `unknown setting ${quoted(key)}; write one of ${KEYS.join(", ")}, \`let NAME\` for a line of formulas, ` +
          "or a field of the scene such as `initial.spin`",
      );
  }
}

/** The settings between semicolons outside quotation marks. */
function items(text: string): string[] {
  const parts = text.match(/(?:"[^"]*"|[^;"])+/gu) ?? [];
  const found = parts.map((part) => part.trim()).filter((part) => part !== "");
  if (found.length === 0) throw new Problem("no settings; write for example `camera = along L; time = 2 s`");
  return found;
}

function divided(item: string): [key: string, value: string] {
  const at = item.indexOf("=");
  if (at < 0) return [item, ""];
  return [item.slice(0, at).trim(), item.slice(at + 1).trim()];
}

function among<T extends string>(key: string, value: string, known: readonly T[]): T {
  const found = known.find((one) => one === value);
  if (found === undefined)
    throw new Problem(`${key}: unknown name ${quoted(value)}; write one of ${known.join(", ")}`);
  return found;
}

/** A number in SI units of a text with a unit. */
function number(key: string, text: string, core: Core): number {
  const [line] = core.evaluated(`x = ${text}`);
  const value = line?.value;
  if (!value || value.grades.join() !== "0" || !Number.isFinite(value.components[0]))
    throw new Problem(`${key}: ${quoted(text)} is not a number; write for example \`2\` or \`2 s\``);
  return value.components[0]!;
}

/** A value in TOML: texts that are not numbers, lists or tables get quotation marks. */
function fieldOf(key: string, value: string, subject: Subject, core: Core): string {
  const [table] = key.split(".");
  among("table", table!, TABLES);
  if (subject.kind !== "scene")
    throw new Problem(`${quoted(key)} is a field of a scene, but this step shows lines of formulas`);
  const plain = /^(?:["'[{]|true$|false$|[+-]?[\d_.]+(?:[eE][+-]?\d+)?$)/u.test(value);
  const toml = plain ? value : JSON.stringify(value);
  changed(subject.scene, { [key]: toml }, core);
  return toml;
}

/** A scene with other fields; a Problem if they are not TOML. */
export function changed(scene: string, fields: Record<string, string> | undefined, core: Core): string {
  const lines = Object.entries(fields ?? {}).map(([name, value]) => `${name} = ${value}`);
  return lines.length > 0 ? core.merged(scene, lines.join("\n")) : scene;
}

function defines(subject: Subject, name: string): void {
  if (subject.kind !== "lines")
    throw new Problem(
      `\`let ${name}\` changes a line of formulas, but this step shows a scene; write a \`ga\` code block first`,
    );
  const names = subject.lines.split("\n").flatMap((line) => /^\s*([^=\s(]+)\s*=[^=]/u.exec(line)?.[1] ?? []);
  if (!names.includes(name))
    throw new Problem(`no line of this step defines ${quoted(name)}; its lines define ${names.join(", ")}`);
}

/** Lines of formulas in which some names have other values. */
export function withValues(lines: string, values: Record<string, string>): string {
  return lines
    .split("\n")
    .map((line) => {
      const [, head, name] = /^(\s*([^=\s(]+)\s*=\s*)[^=]/u.exec(line) ?? [];
      return name !== undefined && name in values ? `${head}${values[name]}` : line;
    })
    .join("\n");
}

export function quoted(text: string): string {
  return `\`${text}\``;
}
