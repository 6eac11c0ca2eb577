import { ALGEBRA_PRESETS } from "../algebra/presets.ts";
import { type Files, Problem } from "../core/core.ts";
import type { LessonFile, PageDocument, ViewState } from "../document.ts";
import type { Lessons } from "../lessons/lessons.ts";
import { LESSONS, sceneNamed } from "../lessons/library.ts";
import { type Model, SHOWN } from "../model/model.ts";
import { mayAutoplay, openPreset, PRESETS } from "../presets/index.ts";
import { checksum, packedBytes } from "./packing.ts";
import type { PageState } from "./state.ts";

/** Stands for the lesson of the page's own document. */
const OWN = "own";

const OUTDATED =
  "this address was made for another version of the scene of this page: the changes that it makes to the scene were " +
  "left out";

/** The view of a model. */
function viewOf(model: Model): ViewState {
  const { time, playing, speed, camera, pose, theme, shown } = model;
  return {
    time: time.value,
    playing: playing.value,
    speed: speed.value,
    camera: camera.value,
    ...(pose.value && { pose: pose.value }),
    theme: theme.value,
    shown: shown.value,
  };
}

/** The state of a page whose document is `own`. */
export async function stateOf(model: Model, lessons: Lessons, own: PageDocument | null): Promise<PageState> {
  const scene = model.scene.value;
  const state: PageState = { page: model.page.value, view: viewOf(model), ...linesOf(model, own) };
  const lesson = model.lesson.value;
  if (lesson) {
    const known = LESSONS.find(({ file }) => file.text === lesson.text);
    state.lesson = known?.id ?? OWN;
    state.step = lessons.index.value;
    if (!known && own?.lesson?.text !== lesson.text) {
      const { text, name, files = new Map() } = lesson;
      state.document = { format: 1, lesson: { text, name }, files: await packedFiles(files) };
    }
    // The step opens its own scene, of which this may be a change.
    if (scene !== null && state.page === "motion") state.text = scene;
    return state;
  }
  const { name, files, original } = model.source;
  const changed = scene !== null && scene !== original;
  if (changed) state.text = scene;
  if (original === (own?.scene ?? null) && (own?.scene !== undefined || own?.recorded)) {
    if (changed) state.of = checksum(original ?? "");
    return state;
  }
  const known = sceneNamed(name.replace(/\.toml$/u, ""), new Map());
  if (known && known.name === name && known.scene === original && sameFiles(known.files, files)) {
    state.scene = name.replace(/\.toml$/u, "");
  } else if (original !== null) {
    state.document = { format: 1, scene: original, name, files: await packedFiles(files) };
  }
  return state;
}

/** The lines of the algebra page, unless they are those that it has by itself. */
function linesOf(model: Model, own: PageDocument | null): Pick<PageState, "figure" | "lines"> {
  const lines = model.lines.value;
  if (lines === (own?.lines ?? "")) return {};
  const figure = ALGEBRA_PRESETS.find((preset) => preset.lines === lines);
  if (figure) return figure === ALGEBRA_PRESETS[0] && !own?.lines ? {} : { figure: figure.id };
  return { lines };
}

/** A document of what a page shows, whose own document is `own`. */
export async function documentOf(
  model: Model,
  lessons: Lessons,
  own: PageDocument | null,
): Promise<PageDocument> {
  const scene = model.scene.value;
  const { name, files } = model.source;
  const lesson = model.lesson.value;
  const recorded = own?.recorded && model.about.value?.method === "recorded" ? own.recorded : undefined;
  return {
    format: 1,
    ...(scene !== null && { scene }),
    name,
    files: await packedFiles(new Map([...files, ...(lesson?.files ?? [])])),
    ...(recorded && { recorded }),
    page: model.page.value,
    ...(model.lines.value !== "" && { lines: model.lines.value }),
    ...(model.values.value.length > 0 && { values: [...model.values.value] }),
    ...(lesson && { lesson: { text: lesson.text, name: lesson.name, step: lessons.index.value } }),
    ...(model.caption.value !== null && { caption: model.caption.value }),
    view: viewOf(model),
  };
}

/** Shows a state in a page whose document is `own`. */
export async function restore(model: Model, state: PageState, own: PageDocument | null): Promise<void> {
  const { scene, text, of, page, view } = state;
  const lines = state.figure === undefined ? state.lines : figureNamed(state.figure);
  const lesson = state.lesson === undefined ? null : lessonNamed(state.lesson, state.document ?? own);
  const start = scene === undefined ? null : opener(scene);
  const playing = view.playing !== undefined && { playing: view.playing && mayAutoplay() };
  const shown = { ...view, ...playing };
  const base = state.document ?? own;
  if (lesson) {
    const files = base?.lesson && (await model.filesOf(base));
    const changed = { ...(text !== undefined && { scene: text }), view: shown };
    model.lesson.value = { ...lesson, ...(files && { files }), step: state.step ?? 0, changed };
  } else {
    model.lesson.value = null;
    if (start) await start(model);
    else if (base?.scene !== undefined || base?.recorded) {
      // The lesson of the page was left.
      const { lesson: _, ...motion } = base;
      await model.show({ ...motion, view: {} });
    } else await openPreset(model, PRESETS[0]!);
    const older = text !== undefined && of !== undefined && of !== checksum(base?.scene ?? "");
    if (text !== undefined && !older) await model.replace(text);
    model.look({ camera: "oblique", ...shown, shown: { ...SHOWN, ...view.shown } });
    model.page.value = page;
    if (older) model.problem.value ??= OUTDATED;
  }
  model.values.value = own?.values ?? [];
  model.lines.value = lines ?? own?.lines ?? "";
}

function opener(name: string): (model: Model) => Promise<unknown> {
  const preset = PRESETS.find((one) => one.name === `${name}.toml`);
  if (preset) return (model) => openPreset(model, preset);
  const found = name === "" ? null : sceneNamed(name, new Map());
  if (!found) throw new Problem(`scene: there is no scene \`${name}\` in this page`);
  return (model) => model.open(found.scene, { name: found.name, files: found.files });
}

function lessonNamed(id: string, document: PageDocument | null): LessonFile {
  const found = id === OWN ? document?.lesson : LESSONS.find((lesson) => lesson.id === id)?.file;
  if (!found) throw new Problem(`lesson: there is no lesson \`${id}\` in this page`);
  return found;
}

function figureNamed(id: string): string {
  const found = ALGEBRA_PRESETS.find((preset) => preset.id === id);
  if (!found) throw new Problem(`figure: there is no figure \`${id}\` in this page`);
  return found.lines;
}

async function packedFiles(files: Files): Promise<Record<string, string>> {
  const packing = [...files].map(async ([name, bytes]) => [name, await packedBytes(bytes)] as const);
  return Object.fromEntries(await Promise.all(packing));
}

function sameFiles(a: Files, b: Files): boolean {
  const same = ([name, bytes]: [string, Uint8Array]) => {
    const other = b.get(name);
    return other?.length === bytes.length && bytes.every((byte, k) => byte === other[k]);
  };
  return a.size === b.size && [...a].every(same);
}
