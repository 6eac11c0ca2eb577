export { loadCore } from "./core/wasm.ts";
