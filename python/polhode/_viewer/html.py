"""Self-contained pages: the viewer and its document in one HTML file."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from pathlib import Path
from string import Template

from polhode._viewer.document import Document, title_of

_BUNDLE = Path(__file__).with_name("viewer.js")

# The page, which the viewer fills as well when it saves itself (viewer/src/share/page.ts). Its policy: no
# connections in or out, and no script but the viewer. Its core is WebAssembly, which the policy must allow;
# it solves scenes in a worker, whose script it holds itself.
_PAGE = Path(__file__).with_name("page.html")


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
    script = "\n" + _inline(bundle_path().read_text(encoding="utf-8"))
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return _template().substitute(
        digest=digest,
        title=_title(title_of(shown)),
        attributes=" bare" if bare else " titled",
        data=data,
        script=script,
    )


def served_page(title: str) -> str:
    """Return a page that fetches the viewer and its document from beside itself on its server.

    Its policy is in the headers of the server.
    """
    without = re.sub(
        r"<meta http-equiv=.*>\n|<script type=.application/json.>.*</script>", "", _template().template
    )
    linked = without.replace('<script type="module">${script}', '<script type="module" src="viewer.js">')
    attributes = ' titled src="document.json"'
    return Template(linked).substitute(title=_title(title), attributes=attributes)


def _template() -> Template:
    return Template(_PAGE.read_text(encoding="utf-8"))


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
