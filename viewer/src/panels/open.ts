import { parsed } from "../document.ts";
import { type Model, words } from "../model/model.ts";

/** What a scene may come with. */
export const OPENED = ".toml,.json,.stl,.obj,.ply";

/**
 * Opens files of this machine: a scene with the meshes that it names, meshes that the scene on hand was missing, or a
 * document of the page. What is wrong with a file is said with its name.
 */
export async function openFiles(model: Model, files: readonly File[]): Promise<void> {
  const ends = (file: File, ends: string) =>
    ends.split(",").some((end) => file.name.toLowerCase().endsWith(end));
  const scenes = files.filter((file) => ends(file, ".toml,.json"));
  const named = (some: readonly File[]) => some.map((file) => file.name).join(", ");
  const strange = files.filter((file) => !ends(file, OPENED));
  try {
    if (scenes.length > 1) {
      throw new Error(`${named(scenes)}: the page shows one scene at a time; open one of these`);
    }
    const [scene] = scenes;
    if (!scene && strange.length > 0) {
      const recorded = strange.some((file) => ends(file, ".nc"))
        ? "; `polhode view` shows a netCDF file"
        : "";
      throw new Error(
        `${named(strange)}: the page opens scenes (.toml), documents (.json) and meshes (.stl, .obj, .ply)${recorded}`,
      );
    }
    const meshes = files.filter((file) => file !== scene && !strange.includes(file));
    const contents = meshes.map(async (file) => [file.name, new Uint8Array(await bytes(file))] as const);
    const others = new Map(await Promise.all(contents));
    if (!scene) {
      model.supply(others);
      return;
    }
    const text = new TextDecoder().decode(await bytes(scene));
    if (ends(scene, ".json")) {
      await model.show(parsed(text, scene.name));
    } else {
      model.page.value = "motion";
      model.open(text, { name: scene.name, files: others });
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
