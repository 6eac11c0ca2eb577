"""Derivations that stand beside the kernels: ``{derivation} crates/rigid/src/exact/free/mod.rs``.

The directive shows the comment at the head of a Rust file, so that a derivation is stated once.
"""

from __future__ import annotations

import re
from pathlib import Path

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parents[2]
# A link of rustdoc to an item or a module, without an address.
LINK = re.compile(r"\[(`[^`\]]+`)\](?![(\[])")


class Derivation(SphinxDirective):
    """Directive for the comment at the head of a file of the core."""

    required_arguments = 1

    def run(self):
        path = ROOT / self.arguments[0]
        self.env.note_dependency(str(path))
        node = nodes.container(classes=["derivation"])
        node.document = self.state.document
        self.state.nested_parse(StringList(head(path.read_text()), source=str(path)), 0, node)
        address = f"{self.config.repository}/blob/main/{self.arguments[0]}"
        source = nodes.paragraph(classes=["derivation-source"])
        source += nodes.reference("", self.arguments[0], refuri=address)
        return [node, source]


def head(text):
    """The lines of the comment at the head of a Rust file, as Markdown."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("//!"):
            break
        lines.append(LINK.sub(r"\1", line[3:].removeprefix(" ")))
    if not lines:
        raise ValueError("the file does not begin with a comment (//!)")
    return lines


def setup(app):
    app.add_directive("derivation", Derivation)
    return {"parallel_read_safe": True}
