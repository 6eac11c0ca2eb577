"""Each law is known to few source files: the registry, its code, and its Python functions."""

import re
from pathlib import Path

import pytest

from polhode._mechanics.registry import FORCES, TORQUES

ROOT = Path(__file__).parents[2]

# Terms of the field, which texts use too, count where they name a law: in quotes, or as a function.
TERMS = {
    *("central", "constant", "damping", "drag", "gyrostat", "heavy"),
    *("larmor", "magnetic", "spring", "tabulated", "thrust"),
}
# `heavy` and `gyrostat` are kinds of motion too, `heavy` a field of `About` on the page, `constant` a step of
# formulas: these do not count.
OF_KINDS = re.compile(r"_report/|_figures/|describe|wasm/src/about|rigid/src/facts|_viewer/recording")
OTHERS = {"heavy": OF_KINDS, "gyrostat": OF_KINDS, "constant": re.compile(r"_generic/|formula/")}
SUFFIXES = {".rs", ".py", ".pyi", ".ts", ".tsx"}


def sources():
    """The files of the source, without tests."""
    folders = [*(ROOT / "crates").glob("*/src"), ROOT / "python" / "polhode", ROOT / "viewer" / "src"]
    for folder in folders:
        for path in folder.rglob("*"):
            parts = path.relative_to(ROOT).parts
            if path.suffix in SUFFIXES and not any("test" in part for part in parts):
                yield path


def naming(name):
    """The source files that name a law.

    For a name that is not a term of the field: ``grep -rlw NAME crates/*/src python/polhode viewer/src``.
    """
    pattern = rf"\b{name}\b"
    if name in TERMS:
        pattern = rf"[\"']{name}[\"']|\bdef {name}\("
    return [path for path in sources() if re.search(pattern, path.read_text())]


@pytest.mark.parametrize("name", [*TORQUES, *FORCES])
def test_a_law_is_named_in_at_most_6_source_files(name):
    found = [path.relative_to(ROOT).as_posix() for path in naming(name)]
    if name in OTHERS:
        found = [path for path in found if not OTHERS[name].search(path)]
    assert any("registry" in path for path in found)
    assert len(found) <= 6, found
