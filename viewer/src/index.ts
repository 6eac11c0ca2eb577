import { define } from "./element.tsx";

define();

export { loadCore } from "./core/wasm.ts";
export { PolhodeViewer } from "./element.tsx";
