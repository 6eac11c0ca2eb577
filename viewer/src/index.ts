import { define } from "./element.tsx";
import { render } from "./widget.ts";

define();

export { loadCore } from "./core/load.ts";
export { PolhodeViewer } from "./element.tsx";

/** For anywidget. */
export default { render };
