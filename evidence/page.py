"""One HTML page of headings, tables and plots, complete in itself."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STYLE = """
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; display: block; overflow-x: auto;
  margin: 1rem 0; }
th, td { padding: 0.15rem 0.7rem; text-align: right; border-bottom: 1px solid #8884; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
td.words, th.words { white-space: normal; text-align: left; min-width: 12rem; overflow-wrap: anywhere; }
.bad { color: #c62828; font-weight: 600; }
figure { margin: 1rem 0; background: white; border-radius: 0.3rem; padding: 0.5rem; overflow-x: auto; }
figure svg, figure img { width: 100%; min-width: 38rem; height: auto; }
figcaption { color: #555; font-size: 0.9rem; position: sticky; left: 0; }
"""


def _marked(text: str) -> str:
    """Return text as HTML; what stands in backticks is code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def _cells(tag: str, cells: Sequence[str], wordy: Sequence[bool]) -> str:
    kinds = (' class="words"' if words else "" for words in wordy)
    return "".join(f"<{tag}{kind}>{_marked(cell)}</{tag}>" for kind, cell in zip(kinds, cells, strict=True))


class Page:
    """Collects the parts of the page."""

    def __init__(self, title: str) -> None:
        self.title, self.parts = title, [f"<h1>{escape(title)}</h1>"]

    def heading(self, text: str, level: int = 2) -> None:
        """Begin a section, of level 2 or deeper."""
        self.parts.append(f"<h{level}>{escape(text)}</h{level}>")

    def text(self, *paragraphs: str) -> None:
        """Add paragraphs."""
        self.parts += [f"<p>{_marked(text)}</p>" for text in paragraphs]

    def facts(self, lines: Iterable[str]) -> None:
        """Add a list, a line each."""
        self.parts.append(f"<ul>{''.join(f'<li>{_marked(line)}</li>' for line in lines)}</ul>")

    def table(self, header: Sequence[str], rows: Iterable[Sequence[str]], bad: Sequence[bool] = ()) -> None:
        """Add a table; bad rows stand out. Columns with long cells are set as words, others as numbers."""
        lines = [list(row) for row in rows]
        wordy = [any(len(line[k]) > 20 for line in lines) for k in range(len(header))]
        self.parts.append(f"<table><tr>{_cells('th', header, wordy)}</tr>")
        for k, line in enumerate(lines):
            kind = ' class="bad"' if k < len(bad) and bad[k] else ""
            self.parts.append(f"<tr{kind}>{_cells('td', line, wordy)}</tr>")
        self.parts.append("</table>")

    def plot(self, drawing: Figure, caption: str) -> None:
        """Add a figure of matplotlib as SVG."""
        text = StringIO()
        drawing.savefig(text, format="svg", bbox_inches="tight")
        svg = text.getvalue()
        self._figure(svg[svg.index("<svg") :], caption)

    def image(self, path: Path, caption: str) -> None:
        """Add an image file."""
        data = b64encode(path.read_bytes()).decode()
        self._figure(f'<img alt="{escape(caption)}" src="data:image/png;base64,{data}">', caption)

    def _figure(self, drawing: str, caption: str) -> None:
        self.parts.append(f"<figure>{drawing}<figcaption>{escape(caption)}</figcaption></figure>")

    def markdown(self, text: str, deeper: int = 0) -> None:
        """Add headings, tables, lists and paragraphs of a report, its headings deeper by some levels."""
        for block in text.strip().split("\n\n"):
            lines = block.splitlines()
            if block.startswith("#"):
                marks, _, title = lines[0].partition(" ")
                self.heading(title, len(marks) + deeper)
                lines = lines[1:]
            if lines and lines[0].startswith("|"):
                header, _, *rows = ([cell.strip() for cell in line.strip("|").split(" | ")] for line in lines)
                self.table(header, rows)
            elif lines and lines[0].startswith("- "):
                self.facts(line.removeprefix("- ") for line in lines)
            elif lines:
                self.text(" ".join(lines))

    def html(self) -> bytes:
        """The page."""
        return (
            f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(self.title)}</title>'
            f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style>'
            f"<body>{''.join(self.parts)}</body></html>\n"
        ).encode()
