"""Marker for tests of the built viewer, and a small script in place of it."""

from pathlib import Path

import pytest

import polhode

BUNDLE = Path(polhode.__file__).parent / "_viewer/viewer.js"

needs_bundle = pytest.mark.skipif(
    not (BUNDLE.is_file() and BUNDLE.stat().st_size), reason="the viewer was not built: make viewer"
)

# Replaces the bundle in tests that do not run it.
SCRIPT = 'const text = "</script><b>"; export default { render() {} };\n'
