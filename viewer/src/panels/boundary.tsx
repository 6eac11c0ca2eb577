import { Component, type ComponentChildren } from "preact";
import { words } from "../model/model.ts";

/** Shows its children, or the error raised while they were rendered; the rest of the page keeps working. */
export class Boundary extends Component<{ children: ComponentChildren }, { problem: string | null }> {
  override state = { problem: null };

  static override getDerivedStateFromError(error: unknown): { problem: string } {
    return { problem: words(error) };
  }

  render() {
    if (this.state.problem === null) return this.props.children;
    return (
      <div class="notice" role="alert">
        <p>This page cannot be shown.</p>
        <pre>{this.state.problem}</pre>
      </div>
    );
  }
}
