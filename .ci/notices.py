"""Write LICENSE-THIRD-PARTY.md: the notices of the crates in the native module and in the viewer.

Run it after a change of Cargo.lock; `tests/project/test_release.py` fails until it has been run. Wheels, the
source distribution and the npm package have the file.
"""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[1]
TARGET = ROOT / "LICENSE-THIRD-PARTY.md"
ROOTS = ("polhode-py", "polhode-wasm")
# Of a choice of licences the one taken, by the files that crates have.
FILES = ("LICENSE-MIT", "LICENSE-MIT.txt", "LICENSE", "LICENSE.md", "LICENSE.txt", "license-mit")
HEAD = """\
# Notices

Wheels and the viewer contain compiled code of the libraries below, under these licences. The notices of the
viewer's JavaScript libraries are beside it, in `viewer.licenses.md`.
"""


def notices() -> str:
    """Return the text: a section for each library, by name."""
    metadata = json.loads(_cargo("metadata", "--format-version", "1"))
    packages = {f"{p['name']} v{p['version']}": p for p in metadata["packages"] if p["source"]}
    linked = {
        " ".join(line.split()[:2])
        for root in ROOTS
        for line in _cargo(
            *("tree", "--package", root, "--target", "all", "--edges", "normal,no-proc-macro"),
            *("--prefix", "none"),
        ).splitlines()
    }
    sections = [HEAD, _section("Rust's standard library", "MIT OR Apache-2.0", _of_rust())]
    for name in sorted(linked & packages.keys()):
        package = packages[name]
        sections.append(_section(name, package["license"], _notice(Path(package["manifest_path"]).parent)))
    return "\n".join(sections)


def _cargo(*words: str) -> str:
    return subprocess.run(
        ["cargo", *words, "--locked"], cwd=ROOT, check=True, capture_output=True, text=True, timeout=120
    ).stdout


def _section(title: str, licence: str, text: str) -> str:
    lines = "\n".join(line.rstrip() for line in text.strip().splitlines())
    return f"## {title} ({licence})\n\n```text\n{lines}\n```\n"


def _of_rust() -> str:
    ours = (ROOT / "LICENSE-MIT").read_text()
    return re.sub(r"^Copyright.*$", "Copyright (c) The Rust Project Contributors", ours, flags=re.MULTILINE)


def _notice(folder: Path) -> str:
    for name in FILES:
        if (folder / name).is_file():
            return (folder / name).read_text()
    raise FileNotFoundError(f"{folder} has none of {', '.join(FILES)}; add the name of its licence to FILES")


if __name__ == "__main__":
    TARGET.write_text(notices())
    print(f"Written to {TARGET.relative_to(ROOT)}")
