"""Whether the viewer was built, and a small script that stands for it."""

from pathlib import Path

import pytest

import polhode

BUNDLE = Path(polhode.__file__).parent / "_viewer/viewer.js"

needs_bundle = pytest.mark.skipif(
    not (BUNDLE.is_file() and BUNDLE.stat().st_size), reason="the viewer was not built: make viewer"
)

# Stands for the bundle where only what goes around it is tested.
SCRIPT = 'const text = "</script><b>"; export default { render() {} };\n'
