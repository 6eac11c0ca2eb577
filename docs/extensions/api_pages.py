"""Reference of the Python package, from its docstrings.

``{api} Rotor slerp`` shows these public names of `polhode`, with the public methods of classes;
``{api-module} torque`` shows those of a module. Docstrings are plain text with single and double backticks:
`|R|` is a norm, and `*` a product. Examples are shown as they are.
"""

from __future__ import annotations

import importlib
import inspect
import itertools
import re

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.util.docutils import SphinxDirective

import polhode
from polhode._support.foreign_names import ForeignName

ANY = re.compile(r": ~?(typing\.)?Any\b")
# Attributes with a description in common, as napoleon writes them, and what stands for the spaces in them.
TOGETHER = re.compile(r":ivar (\w+(?:, \w+)+):")
JOINER = "\u2060"
LITERAL = re.compile(r"(``.*?``|`[^`]*`)")


class Api(SphinxDirective):
    """Directive for names of the package."""

    required_arguments = 1
    final_argument_whitespace = True
    module = "polhode"

    def run(self):
        # Pages are Markdown; docstrings are not.
        lines = ["```{eval-rst}"]
        for name in self.names():
            lines += [*described(self.module, name), ""]
        lines.append("```")
        node = nodes.section()
        node.document = self.state.document
        self.state.nested_parse(StringList(lines, source=self.env.docname), 0, node)
        return node.children

    def names(self):
        return self.arguments[0].split()


class ApiModule(Api):
    """Directive for all names of a module of the package."""

    @property
    def module(self):
        return f"polhode.{self.arguments[0]}"

    def names(self):
        return public_names(self.module)


def public_names(module):
    """The public names of a module, in the order of its source."""
    found = importlib.import_module(module)
    return [name for name in dir(found) if not name.startswith("_")]


def described(module, name):
    """Lines of reStructuredText for one name."""
    found = getattr(importlib.import_module(module), name)
    if inspect.isclass(found):
        others = ", ".join(base.__name__ for base in shown_elsewhere(found))
        return [f".. autoclass:: {module}.{name}", "   :members:", f"   :inherited-members: {others}"]
    if callable(found):
        return [f".. autofunction:: {module}.{name}"]
    return [f".. autodata:: {module}.{name}"]


def shown_elsewhere(found):
    """The classes that a class extends, from the first on that is public or of another package."""
    bases = found.__mro__[1:]
    return itertools.dropwhile(
        lambda base: base.__module__.startswith("polhode.") and not is_public(base), bases
    )


def is_public(found):
    return getattr(polhode, found.__name__, None) is found


def escaped(line):
    """A line of a docstring as reStructuredText: outside of backticks, `|` and `*` are themselves."""
    parts = LITERAL.split(line)
    return "".join(part if k % 2 else re.sub(r"([|*\\])", r"\\\1", part) for k, part in enumerate(parts))


def escape_docstring(app, what, name, obj, options, lines):
    example = False  # from a prompt to the next empty line: code, and its output
    for k, line in enumerate(lines):
        example = bool(line.strip()) and (example or line.lstrip().startswith(">>>"))
        if not example:
            lines[k] = escaped(line)


HELD: dict[str, list[str]] = {}


def hold_property(app, what, name, obj, options, lines):
    """Keep the text of properties from napoleon, which takes what precedes a colon for a type."""
    if what == "property":
        end = lines.index("Examples") if "Examples" in lines else len(lines)
        HELD[name] = lines[:end]
        lines[:] = ["", *lines[end:]]


def restore_property(app, what, name, obj, options, lines):
    if name in HELD:
        lines[:] = [*HELD.pop(name), *lines]


def skip_member(app, what, name, obj, skip, options):
    """Leave out names of other libraries, and fields of named tuples, which the class describes."""
    return True if isinstance(obj, ForeignName) or type(obj).__name__ == "_tuplegetter" else None


def join_attributes(app, what, name, obj, options, lines):
    """Keep Sphinx from reading the names of attributes with one description as a type and a name."""
    lines[:] = [TOGETHER.sub(lambda m: f":ivar {m[1].replace(' ', JOINER)}:", line) for line in lines]


def restore_spaces(app, doctree):
    for text in list(doctree.findall(nodes.Text)):
        if JOINER in text:
            text.parent.replace(text, nodes.Text(text.replace(JOINER, " ")))


def shorten_signature(app, what, name, obj, options, signature, returned):
    """Leave out `Any`, and the arguments of constructors that only the binding calls."""
    if signature is None:
        return None
    signature = "" if re.search(r"[(, *]_\w", signature) else ANY.sub("", signature)
    return signature, None if returned in ("Any", "~typing.Any") else returned


def setup(app):
    app.setup_extension("sphinx.ext.autodoc")
    app.setup_extension("sphinx.ext.napoleon")
    app.connect("autodoc-process-docstring", escape_docstring, priority=300)
    app.connect("autodoc-process-docstring", hold_property, priority=400)
    app.connect("autodoc-process-docstring", restore_property, priority=600)
    app.connect("autodoc-skip-member", skip_member)
    app.connect("autodoc-process-docstring", join_attributes, priority=600)
    app.connect("doctree-read", restore_spaces)
    app.connect("autodoc-process-signature", shorten_signature)
    app.add_directive("api", Api)
    app.add_directive("api-module", ApiModule)
    return {"parallel_read_safe": True}
