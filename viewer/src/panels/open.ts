import type { PageDocument } from "../document.ts";
import { type Model, words } from "../model/model.ts";

/** What a scene may come with. */
export const OPENED = ".toml,.json,.stl,.obj,.ply";

/**
 * Opens files of this machine: a scene with the meshes that it names, meshes that the scene on hand was missing, or a
 * document of the page.
 */
export async function openFiles(model: Model, files: readonly File[]): Promise<void> {
  try {
    const scene = files.find((file) => /\.(toml|json)$/i.test(file.name));
    const others = files.filter((file) => file !== scene);
    const contents = others.map(
      async (file) => [file.name, new Uint8Array(await file.arrayBuffer())] as const,
    );
    const named = new Map(await Promise.all(contents));
    const text = await scene?.text();
    if (!scene || text === undefined) {
      model.supply(named);
    } else if (/\.json$/i.test(scene.name)) {
      await model.show(JSON.parse(text) as PageDocument);
    } else {
      model.page.value = "motion";
      model.open(text, { name: scene.name, files: named });
    }
  } catch (error) {
    model.problem.value = words(error);
  }
}
