import type { Files } from "../core/core.ts";
import { decoded } from "../packed.ts";

/** The scenes that are part of the page, by path: the examples, and those beside this file. */
const SCENES = import.meta.glob<string>(["../../../examples/*.toml", "./*.toml"], {
  query: "?raw",
  import: "default",
  eager: true,
});
/** Meshes and tables that scenes refer to, in base64. */
const OTHERS = import.meta.glob<string>("../../../examples/*.{stl,obj,ply,csv}", {
  query: "?base64",
  import: "default",
  eager: true,
});

const nameOf = (path: string): string => path.replace(/^.*\//u, "");
const byName = <T>(files: Record<string, T>): Map<string, T> =>
  new Map(Object.entries(files).map(([path, content]) => [nameOf(path), content]));
const scenes = byName(SCENES);
const others = byName(OTHERS);

/** The names of all scenes. */
export const NAMES: readonly string[] = [...scenes.keys()];

/** A scene by its file name with the files that it refers to; null if there is none. */
export function sceneFile(name: string): { scene: string; name: string; files: Files } | null {
  const scene = scenes.get(name);
  if (scene === undefined) return null;
  const needed = [...others].filter(([other]) => scene.includes(other));
  return { scene, name, files: new Map(needed.map(([other, text]) => [other, decoded(text)])) };
}

/** The title of a scene, and the first sentence of its caption. */
export function titleOf(name: string): { title: string; about: string } {
  const text = scenes.get(name) ?? "";
  const title = /^title = "(.*)"$/mu.exec(text)?.[1] ?? name;
  const caption = /^caption = """\n([^]*?)"""$/mu.exec(text)?.[1] ?? "";
  return { title, about: caption.replaceAll("\n", " ").replace(/(?<=[.?!]) .*$/u, "") };
}
