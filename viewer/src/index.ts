import { define } from "./element.tsx";
import { render } from "./widget.ts";

define();

export { loadCore } from "./core/wasm.ts";
export { PolhodeViewer } from "./element.tsx";

/** For anywidget. */
export default { render };
