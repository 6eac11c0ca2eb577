import packed from "virtual:polhode-core";
import { unpacked } from "../packed.ts";
import { Core } from "./wasm.ts";

/** Loads the core from this bundle. */
export async function loadCore(): Promise<Core> {
  return Core.of(await WebAssembly.compile(await unpacked(packed)));
}
