"""Sphinx configuration: pages of the guides in build/docs, with the viewer in them."""

import json
import os
import re
import sys
from pathlib import Path

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from polhode._viewer import document
from polhode._viewer.html import bundle_path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs/extensions"))

project = "Polhode"
copyright = "the authors of Polhode"
extensions = ["myst_parser", "handout_pages", "derivations", "api_pages"]
repository = "https://github.com/polhode/polhode"
exclude_patterns = ["_build"]
myst_heading_anchors = 3
default_role = "py:obj"  # docstrings put names in single backticks
autodoc_member_order = "bysource"
napoleon_use_ivar = True
html_theme = "furo"
html_title = "Polhode"
html_show_sourcelink = False
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["page.css", "handout.css", "derivation.css"]
html_js_files = [("viewer-theme.js", {"defer": "defer"})]


class Viewer(SphinxDirective):
    """Directive that shows a scene or a lesson in the viewer; its argument is the path from the root."""

    required_arguments = 1

    def run(self):
        path = ROOT / self.arguments[0]
        self.env.note_dependency(str(path))
        if not viewer_exists():
            return [nodes.paragraph(text=f"{self.arguments[0]}: these pages were built without the viewer.")]
        data = json.dumps(document.of_file(path)).replace("<", "\\u003c")
        # A lesson has its text below the picture.
        height = 58 if path.suffix == ".md" else 38
        script = os.path.relpath("_static/polhode-viewer.js", Path(self.env.docname).parent)
        html = (
            f'<script src="{script}"></script>'
            f'<polhode-viewer compact style="display: block; height: {height}rem; margin: 1rem 0">'
            f'<script type="application/json">{data}</script></polhode-viewer>'
        )
        return [nodes.raw("", html, format="html")]


def viewer_exists():
    try:
        return bundle_path().is_file()
    except FileNotFoundError:
        return False


def resolve_conventions_link(app, docname, source):
    """Make links to CONVENTIONS.md point to its page."""
    source[0] = re.sub(r"\(((?:\.\./)*)\.\./CONVENTIONS\.md\)", r"(\1conventions.md)", source[0])


def write_viewer(app, exception):
    """Write the viewer as text in a script: a page opened from disk may not import modules from files."""
    if exception is None and viewer_exists():
        text = json.dumps(bundle_path().read_text())
        (Path(app.outdir) / "_static/polhode-viewer.js").write_text(
            "window.polhodeViewer ??= import(URL.createObjectURL(\n"
            f'  new Blob([{text}], {{ type: "text/javascript" }}),\n));\n'
        )


def setup(app):
    app.add_directive("viewer", Viewer)
    app.connect("source-read", resolve_conventions_link)
    app.connect("build-finished", write_viewer)
