"""XML documents without document types; each element has its place in the file."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from polhode._support.files import contents

_LARGEST, _DEEPEST = 50_000_000, 200

# Columns of a line in messages, and how many of them before the place.
_WIDEST, _BEFORE = 160, 40

# Products of three numbers below this do not overflow.
_GREATEST = 1e100

_INVALID = expat.errors.codes[expat.errors.XML_ERROR_INVALID_TOKEN]
_NO_COMMA = "write decimals with a point, and spaces between numbers"


class DocumentError(ValueError):
    """A mistake in an XML file, with its place."""


@dataclass(frozen=True)
class Source:
    """A file and its lines, for messages."""

    name: str
    lines: list[str]

    def error(self, line: int, column: int, words: str, kind: str = "error") -> str:
        """Return a message with the place, and the source line with carets under the element or word."""
        message = f"{self.name}:{line}:{column + 1}: {kind}: {words}"
        text = self.lines[line - 1].replace("\t", " ").rstrip() if line <= len(self.lines) else ""
        if not text.strip() or not text.isprintable():
            return message
        first = max(0, column - _BEFORE) if len(text) > _WIDEST else 0
        found = re.match(r"<[^\s>]*>?|\w+", text[column:])
        text, column = _excerpt(text, first), column - first + (first > 0)
        bar = " " * len(str(line))
        carets = "^" * min(len(found[0]) if found else 1, max(1, len(text) - column))
        return f"{message}\n{bar} |\n{line} | {text}\n{bar} | {' ' * column}{carets}"


def _excerpt(text: str, first: int) -> str:
    """Return a line, or its part from a column on if it is long, as in files without line breaks."""
    if len(text) <= _WIDEST:
        return text
    part = text[first : first + _WIDEST]
    return f"{'…' if first else ''}{part}{'…' if first + _WIDEST < len(text) else ''}"


@dataclass(eq=False)
class Node:
    """An XML element: its attributes, children, text and place."""

    tag: str
    attributes: dict[str, str]
    source: Source
    line: int
    column: int
    children: list[Node] = field(default_factory=list)
    text: str = ""

    def all(self, tag: str) -> list[Node]:
        """Return the children with a tag."""
        return [child for child in self.children if child.tag == tag]

    def first(self, tag: str) -> Node | None:
        """Return the first child with a tag."""
        return next(iter(self.all(tag)), None)

    def only(self, tag: str) -> Node | None:
        """Return the child with a tag, or None; an error for more than one."""
        found = self.all(tag)
        if len(found) > 1:
            raise found[1].error(f"<{self.tag}> has more than one <{tag}>; keep one")
        return found[0] if found else None

    def required(self, tag: str) -> Node:
        """Return the only child with a tag; an error without one."""
        if (found := self.only(tag)) is None:
            raise self.error(f"<{self.tag}> needs the element <{tag}>")
        return found

    def everything(self) -> Iterator[Node]:
        """Yield the element and all in it, in the order of the file."""
        yield self
        for child in self.children:
            yield from child.everything()

    def message(self, words: str, kind: str = "error") -> str:
        """Return a message that begins with the place of the element."""
        return self.source.error(self.line, self.column, words, kind)

    def error(self, words: str) -> DocumentError:
        """Return an error at the place of the element."""
        return DocumentError(self.message(words))

    def numbers(self, attribute: str | None, counts: int | tuple[int, ...]) -> list[float] | None:
        """Return the numbers in an attribute, or None without it; in the text for attribute None."""
        text = self.text if attribute is None else self.attributes.get(attribute)
        if text is None:
            return None
        what = f"<{self.tag}>" if attribute is None else f"attribute {attribute!r} of <{self.tag}>"
        allowed = (counts,) if isinstance(counts, int) else counts
        words = text.split()
        if len(words) not in allowed:
            number = " or ".join(map(str, allowed))
            noun = "number" if allowed == (1,) else "numbers"
            remedy = f"; {_NO_COMMA}" if "," in text else ""
            raise self.error(f"{what} must have {number} {noun}, got {text.strip()!r}{remedy}")
        return [self._number(word, what) for word in words]

    def _number(self, word: str, what: str) -> float:
        if "$" in word:
            raise self.error(f"{what} has the xacro expression {word!r}; expand the file with xacro first")
        try:
            # Python's own extensions: 1_000 and other digits.
            value = float(word) if word.isascii() and "_" not in word else math.nan
        except ValueError:
            value = math.nan
        if math.isnan(value):
            remedy = f"; {_NO_COMMA}" if "," in word else ""
            raise self.error(f"{what} has {word!r}, which is not a number{remedy}")
        if not abs(value) < _GREATEST:
            raise self.error(f"{what} must have numbers below {_GREATEST:g}, got {word!r}")
        return value


def read(path: str | os.PathLike[str]) -> Node:
    """Return the root element of an XML file.

    A document type is refused: entities could expand without limit, or name other files.
    """
    name = os.fsdecode(path)
    if not os.path.lexists(path):
        raise FileNotFoundError(f"{name}: no such file")
    if not os.path.isfile(path):
        raise DocumentError(f"{name}: error: not a regular file; give the path of a file")
    if os.path.getsize(path) > _LARGEST:
        raise DocumentError(f"{name}: error: larger than {_LARGEST // 1_000_000} MB; split the file")
    try:
        content = contents(path)
    except OSError as error:
        raise DocumentError(f"{name}: error: cannot be read: {error.strerror}") from None
    return parse(content, name)


def _is_utf8(content: bytes) -> bool:
    try:
        content.decode()
    except UnicodeDecodeError:
        return False
    return True


def parse(content: bytes, name: str) -> Node:
    """Return the root element of an XML document; `name` appears in errors."""
    # Expat counts lines by \n alone.
    source = Source(name, [line.rstrip("\r") for line in content.decode("utf-8", "replace").split("\n")])
    parser = expat.ParserCreate()
    parser.buffer_text = True
    top = Node("", {}, source, 1, 0)
    stack = [top]

    def start(tag: str, attributes: dict[str, str]) -> None:
        node = Node(tag, attributes, source, parser.CurrentLineNumber, parser.CurrentColumnNumber)
        if len(stack) > _DEEPEST:
            raise node.error(f"elements are nested more than {_DEEPEST} deep")
        stack[-1].children.append(node)
        stack.append(node)

    def end(_: str) -> None:
        stack.pop()

    def text(data: str) -> None:
        stack[-1].text += data

    def doctype(*_: object) -> None:
        line = parser.CurrentLineNumber
        column = max(0, source.lines[line - 1].find("<!DOCTYPE")) if line <= len(source.lines) else 0
        words = "a document type is not read, because its entities can expand without limit; delete it"
        raise DocumentError(source.error(line, column, words))

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = text, doctype
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        words = f"not well-formed XML: {expat.ErrorString(error.code)}"
        if not content.strip():
            words = "the file is empty; export it again"
        elif error.code == _INVALID and not _is_utf8(content):
            words = "not XML in UTF-8, nor in an encoding that its first line states; save the file as UTF-8"
        raise DocumentError(source.error(error.lineno, error.offset, words)) from None
    except DocumentError:
        raise
    except (LookupError, ValueError) as error:
        raise DocumentError(source.error(1, 0, f"unknown encoding: {error}")) from None
    return top.children[0]
