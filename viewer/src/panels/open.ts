import { parsed } from "../document.ts";
import { type Model, words } from "../model/model.ts";

/** Suffixes of the files that the page opens. */
export const ACCEPTED = ".toml,.json,.md,.stl,.obj,.ply";

/**
 * Opens local files: a scene with the meshes that it names, meshes that the current scene lacks, or a document of the
 * page. Errors name the file.
 */
export async function openFiles(model: Model, files: readonly File[]): Promise<void> {
  const hasSuffix = (file: File, suffixes: string) =>
    suffixes.split(",").some((suffix) => file.name.toLowerCase().endsWith(suffix));
  // A lesson comes with the scenes and meshes that it names.
  const lessons = files.filter((file) => hasSuffix(file, ".md"));
  const scenes = lessons.length > 0 ? lessons : files.filter((file) => hasSuffix(file, ".toml,.json"));
  const named = (some: readonly File[]) => some.map((file) => file.name).join(", ");
  const unknown = files.filter((file) => !hasSuffix(file, ACCEPTED));
  try {
    if (scenes.length > 1) {
      throw new Error(`${named(scenes)}: the page shows one scene at a time; open one of these files`);
    }
    const [scene] = scenes;
    if (!scene && unknown.length > 0) {
      const netcdf = unknown.some((file) => hasSuffix(file, ".nc"));
      const hint = netcdf ? "; `polhode view` shows netCDF files" : "";
      throw new Error(
        `${named(unknown)}: the page opens scenes (.toml), documents (.json) and meshes (.stl, .obj, .ply), and lessons (.md)${hint}`,
      );
    }
    const meshes = files.filter((file) => file !== scene && !unknown.includes(file));
    const contents = meshes.map(async (file) => [file.name, new Uint8Array(await bytes(file))] as const);
    const others = new Map(await Promise.all(contents));
    if (!scene) {
      await model.supply(others);
      return;
    }
    const text = new TextDecoder().decode(await bytes(scene));
    if (hasSuffix(scene, ".md")) {
      model.lesson.value = { text, name: scene.name, files: others };
    } else if (hasSuffix(scene, ".json")) {
      await model.show(parsed(text, scene.name));
    } else {
      // The text of a lesson is about its own scenes.
      model.lesson.value = null;
      model.page.value = "motion";
      await model.open(text, { name: scene.name, files: others });
    }
  } catch (error) {
    model.page.value = "motion";
    model.problem.value = words(error);
  }
}

async function bytes(file: File): Promise<ArrayBuffer> {
  try {
    return await file.arrayBuffer();
  } catch (error) {
    throw new Error(`${file.name} cannot be read: ${words(error)}`);
  }
}
