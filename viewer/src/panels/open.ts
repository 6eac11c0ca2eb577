import type { PageDocument } from "../document.ts";
import { type Model, words } from "../model/model.ts";

/** What a scene may come with. */
export const OPENED = ".toml,.json,.stl,.obj,.ply";

/** Opens files of this machine: a scene with the meshes that it names, or a document of the page. */
export async function openFiles(model: Model, files: readonly File[]): Promise<void> {
  try {
    const scene = files.find((file) => /\.(toml|json)$/i.test(file.name));
    if (!scene) {
      const names = files.map((file) => file.name).join(", ");
      model.problem.value = `${names}: choose the scene (.toml) along with it`;
      return;
    }
    const text = await scene.text();
    if (/\.json$/i.test(scene.name)) {
      await model.show(JSON.parse(text) as PageDocument);
      return;
    }
    const others = files.filter((file) => file !== scene);
    const contents = others.map(
      async (file) => [file.name, new Uint8Array(await file.arrayBuffer())] as const,
    );
    model.page.value = "motion";
    model.open(text, { name: scene.name, files: new Map(await Promise.all(contents)) });
  } catch (error) {
    model.problem.value = words(error);
  }
}
