import { Problem } from "../core/core.ts";
import { CAMERAS, type PageDocument, parsed, type Pose, type Shown, type ViewState } from "../document.ts";
import { SHOWN } from "../model/model.ts";
import { packedText, unpackedText } from "./packing.ts";

/** What a page shows, as far as its address has it. */
export interface PageState {
  /** A scene that is part of the viewer by its name, or a document; by default the document of the page. */
  scene?: string;
  document?: PageDocument;
  /** The text of the scene if it was changed, and the checksum of the text that was changed. */
  text?: string;
  of?: string;
  page: "motion" | "algebra";
  /** A figure of the algebra page, or its lines. */
  figure?: string;
  lines?: string;
  /** A lesson that is part of the viewer by its name; `own` for that of the document. Steps count from 0. */
  lesson?: string;
  step?: number;
  view: Partial<ViewState>;
}

/** The first field: the version of this format. */
const VERSION = "v=1";
const THEMES = ["auto", "light", "dark"] as const;
const PAGES = ["motion", "algebra"] as const;
const PARTS = Object.keys(SHOWN) as (keyof Shown)[];

/** The fields of an address after `#`; `docs/viewer.md` lists them. */
export async function fragmentOf(state: PageState): Promise<string> {
  const { scene, document, text, of, page, figure, lines, lesson, step, view } = state;
  const { time, speed, playing, camera, pose, theme, shown = {} } = view;
  const differing = (value: boolean) =>
    PARTS.filter((part) => SHOWN[part] !== value && shown[part] === value).join(",");
  const fields: [string, string | number | undefined][] = [
    ["scene", scene],
    ["document", document && (await packedText(JSON.stringify(document)))],
    ["lesson", lesson],
    ["step", step === undefined ? undefined : step + 1],
    ["of", of],
    ["text", text === undefined ? undefined : await packedText(text)],
    ["page", page === "motion" ? undefined : page],
    ["figure", figure],
    ["lines", lines === undefined ? undefined : await packedText(lines)],
    ["t", time],
    ["speed", speed],
    ["play", playing === undefined ? undefined : Number(playing)],
    ["camera", camera],
    ["view", pose?.map((number) => Number(number.toPrecision(5))).join(",")],
    ["show", differing(true) || undefined],
    ["hide", differing(false) || undefined],
    ["theme", theme === "auto" ? undefined : theme],
  ];
  const given = fields.filter(([, value]) => value !== undefined);
  return [VERSION, ...given.map(([name, value]) => `${name}=${escaped(String(value))}`)].join("&");
}

/** Whether a fragment is one of this format, of any version, rather than the name of a place in a page. */
export function isState(fragment: string): boolean {
  return /^v=\d+(?:&|$)/u.test(fragment);
}

/** The state of a fragment. A Problem says which field is wrong. */
export async function stateOfFragment(fragment: string): Promise<PageState> {
  const [version, ...fields] = fragment.split("&");
  if (version !== VERSION)
    throw new Problem(
      isState(fragment)
        ? `its format is ${quoted(version!)}, this page reads ${quoted(VERSION)}`
        : `it must begin with ${quoted(VERSION)}, got ${quoted(shortened(fragment))}`,
    );
  const state: PageState = { page: "motion", view: { shown: { ...SHOWN } } };
  for (const field of fields) {
    const at = field.indexOf("=");
    if (at < 1) throw new Problem(`${quoted(shortened(field))} is not of the form \`name=value\``);
    await take(state, field.slice(0, at), field.slice(at + 1));
  }
  return state;
}

async function take(state: PageState, name: string, escaped: string): Promise<void> {
  const value = unescaped(name, escaped);
  const { view } = state;
  switch (name) {
    case "scene":
    case "of":
    case "figure":
    case "lesson":
      state[name] = value;
      return;
    case "text":
    case "lines":
      state[name] = await unpack(name, value);
      return;
    case "document":
      state.document = parsed(await unpack(name, value), "the document in it");
      return;
    case "step":
      state.step = whole(name, value) - 1;
      return;
    case "page":
      state.page = among(name, value, PAGES);
      return;
    case "t":
      view.time = number(name, value);
      return;
    case "speed":
      view.speed = number(name, value);
      return;
    case "play":
      view.playing = among(name, value, ["0", "1"]) === "1";
      return;
    case "camera":
      view.camera = among(name, value, CAMERAS);
      return;
    case "view":
      view.pose = poseOf(name, value);
      return;
    case "theme":
      view.theme = among(name, value, THEMES);
      return;
    case "show":
    case "hide": {
      const named = value.split(",").map((part) => [among(name, part, PARTS), name === "show"]);
      view.shown = { ...view.shown, ...(Object.fromEntries(named) as Partial<Shown>) };
      return;
    }
    default:
      throw new Problem(`unknown field ${quoted(shortened(name))}`);
  }
}

/** The letters that must not be in an address are escaped; others stay readable. */
function escaped(value: string): string {
  return encodeURIComponent(value).replaceAll("%20", "+").replaceAll("%2C", ",");
}

function unescaped(name: string, value: string): string {
  try {
    return decodeURIComponent(value.replaceAll("+", " "));
  } catch {
    throw new Problem(`${name}: ${quoted(shortened(value))} is damaged`);
  }
}

async function unpack(name: string, value: string): Promise<string> {
  try {
    return await unpackedText(value);
  } catch {
    throw new Problem(`${name} is damaged: the address may have been cut off when it was copied`);
  }
}

function number(name: string, value: string): number {
  const found = Number(value);
  if (value.trim() === "" || !Number.isFinite(found))
    throw new Problem(`${name}: ${quoted(shortened(value))} is not a number`);
  return found;
}

function whole(name: string, value: string): number {
  const found = number(name, value);
  if (!Number.isInteger(found) || found < 1)
    throw new Problem(`${name}: ${quoted(shortened(value))} is not a whole number from 1 on`);
  return found;
}

function poseOf(name: string, value: string): Pose {
  const numbers = value.split(",").map((part) => number(name, part));
  const [azimuth, elevation, nearness] = numbers;
  if (numbers.length !== 3 || nearness! <= 0)
    throw new Problem(
      `${name}: ${quoted(shortened(value))} must be two angles in degrees and a nearness above 0`,
    );
  return [azimuth!, elevation!, nearness!];
}

function among<T extends string>(name: string, value: string, known: readonly T[]): T {
  const found = known.find((one) => one === value);
  if (found === undefined)
    throw new Problem(`${name}: ${quoted(shortened(value))} is not one of ${known.join(", ")}`);
  return found;
}

function shortened(text: string): string {
  return text.length > 40 ? `${text.slice(0, 40)}…` : text;
}

function quoted(text: string): string {
  return `\`${text}\``;
}
