"""Directives of the handout's pages: equations with their tests, pictures, formulas in the text.

``{equation} 4.13`` shows lines of the handout under their number, with the tests of that equation folded
below; ``{formula}`` shows other lines, and the role ``{formula}`` one in the text; the role ``{handout}``
links to an equation by its number; ``{equations}`` is the table of all of them; ``{picture}`` embeds a figure
that the build draws with a function of docs/handout/pictures.py.
"""

import base64
import hashlib
import importlib.util
import io
import logging as python_logging
import os
from html import escape
from pathlib import Path

import matplotlib
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective, SphinxRole

import handout_tests
from notation import mathml

DOCS = Path(__file__).parents[1]
ROOT = DOCS.parent
PICTURES = DOCS / "handout/pictures.py"

logger = logging.getLogger(__name__)


class Equation(SphinxDirective):
    """Lines of the handout under their numbers, and the tests of these equations."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True

    def run(self):
        numbers = self.arguments[0].split(", ")
        lines = "".join(mathml(line, display=True) for line in self.content)
        labels = " ".join(
            f'<a class="number" id="{handout_tests.anchor(number)}" href="#{handout_tests.anchor(number)}">'
            f"{label(number)}</a>"
            for number in numbers
        )
        shown = f'<div class="equation"><div class="lines">{lines}</div><div>{labels}</div></div>'
        return [html(shown), *self.tests(numbers)]

    def tests(self, numbers):
        """Return the tests of the equations, folded."""
        formulas, tests = [], []
        for number in numbers:
            formulas += handout_tests.formulas_of_equations(ROOT).get(number, [])
            tests += handout_tests.tests_of_equations(ROOT).get(number, [])
        for place in (*formulas, *tests):
            self.env.note_dependency(str(ROOT / place.path))
        if not formulas and not tests:
            raise self.error(f"no test has the number {', '.join(numbers)}")
        found = [html("<details class='tested'><summary>How it is tested</summary>")]
        if formulas:
            found.append(html(self.formulas(formulas)))
        for test in dict.fromkeys(tests):
            place = f"{test.path}#L{test.first}-L{test.last}"
            found.append(html(f"<p>{link(self.config, place, f'{test.path}, line {test.first}')}</p>"))
            found.append(nodes.literal_block(test.source, test.source, language="python"))
        return [*found, html("</details>")]

    def formulas(self, formulas):
        listed = "".join(
            f"<li>{link(self.config, f'{formula.path}#L{formula.line}', formula.text, code=True)}</li>"
            for formula in formulas
        )
        return (
            "<p>As formulas, over floats, 10,000 rows of floats, fractions and symbols, and beside each a "
            f"wrong version that must fail:</p><ul>{listed}</ul>"
        )


class Formula(SphinxDirective):
    """Lines that are not numbered in the handout."""

    has_content = True

    def run(self):
        lines = "".join(mathml(line, display=True) for line in self.content)
        return [html(f'<div class="equation"><div class="lines">{lines}</div></div>')]


class FormulaRole(SphinxRole):
    """A formula in the text."""

    def run(self):
        return [html(mathml(self.text))], []


class HandoutRole(SphinxRole):
    """Link to an equation by its number."""

    def run(self):
        for shown in handout_tests.shown_equations(DOCS):
            if self.text in shown.numbers:
                address = address_of(shown.page, self.env.docname, self.text)
                return [nodes.reference("", label(self.text), internal=True, refuri=address)], []
        logger.warning("no page has the equation %r", self.text, location=self.get_location())
        return [nodes.Text(self.text)], []


class Equations(SphinxDirective):
    """The table of all equations: page and tests."""

    def run(self):
        tests = handout_tests.tests_of_equations(ROOT)
        formulas = handout_tests.formulas_of_equations(ROOT)
        rows = []
        for shown in handout_tests.shown_equations(DOCS):
            self.env.note_dependency(str(DOCS / f"{shown.page}.md"))
            for number in shown.numbers:
                places = [(f"{t.path}#L{t.first}-L{t.last}", t.path, t.first) for t in tests.get(number, [])]
                places += [(f"{f.path}#L{f.line}", f.path, f.line) for f in formulas.get(number, [])]
                named = ", ".join(
                    link(self.config, place, f"{Path(path).name}:{line}") for place, path, line in places
                )
                address = address_of(shown.page, self.env.docname, number)
                rows.append(
                    f'<tr><td><a href="{address}">{label(number)}</a></td>'
                    f"<td>{mathml(shown.lines[0])}</td><td class='tests'>{named}</td></tr>"
                )
        head = "<thead><tr><th>number</th><th>equation</th><th>tests</th></tr></thead>"
        table = f"<table class='docutils equations'>{head}<tbody>{''.join(rows)}</tbody></table>"
        return [html(f'<div class="table-wrapper">{table}</div>')]


class Picture(SphinxDirective):
    """A figure that a function of pictures.py draws; the content is its caption, `alt` describes it."""

    required_arguments = 1
    has_content = True
    option_spec = {"alt": directives.unchanged_required}  # noqa: RUF012

    def run(self):
        self.env.note_dependency(str(PICTURES))
        data = base64.b64encode(svg(getattr(pictures(), self.arguments[0])())).decode()
        image = f'<img alt="{escape(self.options["alt"])}" src="data:image/svg+xml;base64,{data}">'
        caption = nodes.container()
        self.state.nested_parse(self.content, self.content_offset, caption)
        begin = html(f"<figure class='picture'>{image}<figcaption>")
        return [begin, *caption.children, html("</figcaption></figure>")]


def pictures():
    """Return the module docs/handout/pictures.py."""
    # Sphinx shows messages of all libraries, here those about letters taken from another font.
    python_logging.getLogger("matplotlib").setLevel(python_logging.WARNING)
    spec = importlib.util.spec_from_file_location("handout_pictures", PICTURES)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def svg(figure):
    """Return a figure as the bytes of an SVG file, the same for the same figure; without margins."""
    buffer = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "polhode", "svg.fonttype": "path"}):
        figure.savefig(buffer, format="svg", bbox_inches="tight", pad_inches=0.06, metadata={"Date": None})
    return buffer.getvalue()


def html(text):
    return nodes.raw("", text, format="html")


def label(number):
    return f"({number})" if number[0].isdigit() else number


def link(config, place, text, code=False):
    """Return a link to a place in the repository."""
    tag = "code" if code else "span"
    return f'<a href="{config.repository}/blob/main/{place}"><{tag}>{escape(text)}</{tag}></a>'


def address_of(page, docname, number):
    """Return the address of an equation, relative to another page."""
    return f"{os.path.relpath(page, Path(docname).parent)}.html#{handout_tests.anchor(number)}"


def setup(app):
    app.add_config_value("repository", "", "env")
    # After a change of these files all pages are read again.
    sources = "".join(path.read_text() for path in sorted(Path(__file__).parent.glob("*.py")))
    app.add_config_value("handout_pages", hashlib.sha256(sources.encode()).hexdigest(), "env")
    app.add_directive("equation", Equation)
    app.add_directive("equations", Equations)
    app.add_directive("formula", Formula)
    app.add_directive("picture", Picture)
    app.add_role("formula", FormulaRole())
    app.add_role("handout", HandoutRole())
    return {"parallel_read_safe": True}
