"""The viewer's bundle where it was built, and a small one in its place for tests of what goes around it."""

import pytest

from polhode import _html

BUILT = _html._BUNDLE.is_file() and _html._BUNDLE.stat().st_size > 0

needs_bundle = pytest.mark.skipif(not BUILT, reason="the viewer was not built: make viewer")

SCRIPT = 'const text = "</script><b>"; export default { render() {} };\n'


@pytest.fixture
def bundle(tmp_path_factory, monkeypatch):
    """The path of a small bundle, which stands for the viewer's."""
    path = tmp_path_factory.mktemp("viewer") / "viewer.js"
    path.write_text(SCRIPT)
    monkeypatch.setattr(_html, "_BUNDLE", path)
    return path
