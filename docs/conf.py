"""How Sphinx makes the pages of build/docs from the guides."""

project = "Polhode"
copyright = "the authors of Polhode"
extensions = ["myst_parser"]
exclude_patterns = ["_build"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = "Polhode"
html_show_sourcelink = False
html_copy_source = False
# The system's fonts and nothing from elsewhere: the pages are read from disk too.
html_static_path = []


def with_links_inside(app, docname, source):
    """Let links to files beside docs/ point at the pages that hold them here."""
    source[0] = source[0].replace("(../CONVENTIONS.md)", "(conventions.md)")


def setup(app):
    app.connect("source-read", with_links_inside)
