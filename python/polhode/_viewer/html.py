"""Self-contained pages: the viewer and its document in one HTML file."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

from polhode._viewer.document import Document, title_of

_BUNDLE = Path(__file__).with_name("viewer.js")

# No connections in or out. The core is WebAssembly, which the policy must allow.
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
<noscript>This page shows a motion and needs JavaScript.</noscript>
{element}
{script}
</body>
</html>
"""


def bundle_path() -> Path:
    """Return the path of the viewer's bundle; a FileNotFoundError with the remedy if it was not built."""
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
    """Return a page that fetches the viewer and its document from its own server."""
    return _PAGE.format(
        policy="",
        title=_title(title),
        element='<polhode-viewer src="/document.json"></polhode-viewer>',
        script='<script type="module" src="/viewer.js"></script>',
    )


def _title(text: str) -> str:
    """Return a title as HTML; bytes of a file name that are not UTF-8 are replaced."""
    return html.escape(text.encode(errors="replace").decode())


def _inline(script: str) -> str:
    """Return a script that can be embedded in a page: nothing in it closes the element.

    ``</script`` occurs in string literals only, where < can be escaped. After ``<!--`` HTML parses scripts by
    other rules.
    """
    if "<!--" in script:
        raise ValueError("the viewer's bundle contains `<!--` and cannot be embedded in a page")
    return re.sub(r"<(?=/script)", r"\\x3C", script, flags=re.IGNORECASE)
