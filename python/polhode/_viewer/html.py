"""A page that needs nothing else: the viewer and what it shows in one HTML file."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

from polhode._viewer.document import Document, title_of

_BUNDLE = Path(__file__).with_name("viewer.js")

# Nothing comes from outside, and nothing goes there. The core is WebAssembly, which a page must allow.
_INLINE_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'"
)

_PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="Polhode">{policy}
<title>{title}</title>
<link rel="icon" href="data:,">
<style>
html, body {{ height: 100%; margin: 0; }}
polhode-viewer {{ display: block; height: 100%; }}
</style>
</head>
<body>
<noscript>This page draws a motion, for which it needs JavaScript.</noscript>
{element}
{script}
</body>
</html>
"""


def bundle_path() -> Path:
    """Return where the viewer's bundle is; a FileNotFoundError with the remedy where it was not built."""
    if not _BUNDLE.is_file() or _BUNDLE.stat().st_size == 0:
        raise FileNotFoundError(
            f"{_BUNDLE} is missing: this copy of polhode was built without its viewer. Build it with `make "
            "viewer`, which needs Node >= 20 and the Rust target wasm32-unknown-unknown, or install a wheel"
        )
    return _BUNDLE


def page(shown: Document, bare: bool = False) -> str:
    """Return a page that shows a document: one file of HTML that loads nothing else.

    A bare one draws nothing by itself; it takes pictures. A FileNotFoundError if the viewer was not built.
    """
    data = json.dumps(shown, allow_nan=False).replace("<", "\\u003c")
    return _PAGE.format(
        policy=f'\n<meta http-equiv="Content-Security-Policy" content="{_INLINE_POLICY}">',
        title=_title(title_of(shown)),
        element=f"<polhode-viewer{' bare' * bare}>"
        f'<script type="application/json">{data}</script></polhode-viewer>',
        script=f'<script type="module">\n{_inline(bundle_path().read_text(encoding="utf-8"))}</script>',
    )


def served_page(title: str) -> str:
    """Return a page that fetches the viewer and its document from where it came from."""
    return _PAGE.format(
        policy="",
        title=_title(title),
        element='<polhode-viewer src="/document.json"></polhode-viewer>',
        script='<script type="module" src="/viewer.js"></script>',
    )


def _title(text: str) -> str:
    """Return a title as HTML; the bytes of a file's name that are no text have no UTF-8 either."""
    return html.escape(text.encode(errors="replace").decode())


def _inline(script: str) -> str:
    """Return a script that may stand in a page: nothing in it ends it early.

    ``</script`` stands in texts alone, where < can be written by its number. After ``<!--`` a page reads
    scripts by other rules.
    """
    if "<!--" in script:
        raise ValueError("the viewer's bundle has the mark `<!--`, with which it cannot stand in a page")
    return re.sub(r"<(?=/script)", r"\\x3C", script, flags=re.IGNORECASE)
