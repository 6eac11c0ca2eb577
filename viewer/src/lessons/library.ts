import type { Files } from "../core/core.ts";
import type { LessonFile } from "../document.ts";
import { sceneFile } from "../presets/files.ts";
import { plain, type SceneNamed } from "./parse.ts";

const FOLDER = "../../../examples/lessons/";
const texts = import.meta.glob<string>("../../../examples/lessons/*.md", {
  query: "?raw",
  import: "default",
  eager: true,
});

/** The order of the lessons that are part of the page. */
const ORDER = [
  "book-thrown-three-ways",
  "why-l-stays-and-omega-wanders",
  "cross-products-to-bivectors",
  "half-angles",
  "earths-wobble",
  "why-a-gyroscope-stays-up",
];

/** The lessons that are part of the page. */
export const LESSONS: readonly { id: string; title: string; about: string; file: LessonFile }[] = ORDER.map(
  (id) => {
    const text = texts[`${FOLDER}${id}.md`]!;
    const field = (name: string) => plain(new RegExp(`^${name}: (.*)$`, "mu").exec(text)?.[1] ?? "");
    return { id, title: field("title"), about: field("about"), file: { text, name: `${id}.md` } };
  },
);

/**
 * A scene by its name: a file beside the lesson, or one that is part of the page. The empty name stands for a scene written in
 * the lesson, and gives its files alone.
 */
export function sceneNamed(name: string, files: Files): ReturnType<SceneNamed> {
  const beside = files.get(name);
  if (name === "") return { scene: "", name, files };
  if (beside) return { scene: new TextDecoder().decode(beside), name, files };
  return sceneFile(`${name}.toml`);
}
