"""The algebra page: its values equal those of Python, and vectors can be dragged."""

import numpy as np
import pytest

import polhode as ph
from polhode._formula.agreement import Agreement
from polhode._formula.shell.session import Session


def components(value):
    """Return a value over 1, e1, e2, e3, e2e3, e3e1, e1e2, I."""
    if isinstance(value, ph.Rotor):
        value = ph.scalar(value.components[0]) + ph.bivector(value.components[1:])
    whole = ph.multivector(np.zeros(8)) + value
    return whole.components


def lines_of(page):
    """Return text, components, whether it holds, and error of each line."""
    rows = page.page.locator("li.line").evaluate_all(
        "rows => rows.map(row => [row.querySelector('textarea').value, { ...row.dataset }])"
    )
    return [(text, data.get("components"), data.get("holds"), data.get("problem")) for text, data in rows]


def compare(page):
    """Compare each line of a page with Python; return the number of lines."""
    session = Session(only_finite=True)
    lines = lines_of(page)
    for text, shown, holds, problem in lines:
        value = session.run(text.partition("#")[0]).value
        assert problem is None
        if isinstance(value, Agreement):
            assert holds == str(value.holds).lower(), text
        elif value is None:
            assert shown is None
        else:
            expected = components(value)
            found = np.array(shown.split(), dtype=float)
            np.testing.assert_allclose(
                found, expected, rtol=0, atol=1e-12 * np.abs(expected).max(), err_msg=text
            )
    return len(lines)


@pytest.fixture
def algebra(opened):
    """An algebra page with the first preset."""
    page = opened({"format": 1, "page": "algebra"})
    page.page.locator("li.line").first.wait_for()
    return page


def test_presets_have_the_values_of_python(algebra):
    figures = algebra.page.locator("#figure")
    names = figures.locator("option:not([disabled])").evaluate_all("options => options.map(o => o.value)")
    assert len(names) >= 9
    for name in names:
        figures.select_option(name)
        assert compare(algebra) >= 5


def test_vectors_can_be_dragged(algebra):
    handle = algebra.page.locator("[data-handle=a]")
    before = lines_of(algebra)
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    algebra.page.mouse.move(x, y)
    algebra.page.mouse.down()
    algebra.page.mouse.move(x + 40, y - 25, steps=4)
    algebra.page.mouse.up()
    after = lines_of(algebra)
    assert after[0][0] != before[0][0]
    assert [line[0] for line in after[1:]] == [line[0] for line in before[1:]]
    # The values that depend on a have changed.
    assert after[3][1] != before[3][1]
    compare(algebra)
    # The tip is still under the pointer, up to the two decimals of the text.
    box = handle.bounding_box()
    assert np.hypot(box["x"] + box["width"] / 2 - x - 40, box["y"] + box["height"] / 2 - y + 25) < 3


def test_vectors_can_be_moved_by_keys(algebra):
    handle = algebra.page.locator("[data-handle=a]")
    first = np.array(lines_of(algebra)[0][1].split(), dtype=float)
    handle.press("ArrowUp")
    second = np.array(lines_of(algebra)[0][1].split(), dtype=float)
    assert np.abs(second - first).max() == pytest.approx(0.1, abs=1e-12)
    assert np.count_nonzero(second - first) == 1
    handle.press("ArrowDown")
    np.testing.assert_allclose(np.array(lines_of(algebra)[0][1].split(), dtype=float), first, atol=1e-12)
    compare(algebra)


def test_lines_can_be_edited(algebra):
    algebra.page.get_by_label("Line 1", exact=True).fill("a = 2 e1 + 0.5 e3")
    compare(algebra)
    algebra.page.get_by_label("Line 2", exact=True).fill("b = a ∧∧ e2")
    assert "∧" in lines_of(algebra)[1][3]
    algebra.page.get_by_label("Line 2", exact=True).fill("b = a∧e2")
    compare(algebra)


def test_sliders_change_numbers(algebra):
    algebra.page.locator("#figure").select_option("rotor")
    before = lines_of(algebra)
    algebra.page.locator("li.line input[type=range]").first.press("ArrowRight")
    after = lines_of(algebra)
    assert after[0][0] != before[0][0]
    assert after[4][1] != before[4][1]
    compare(algebra)


def test_lines_of_a_document_are_shown(opened):
    page = opened({"format": 1, "page": "algebra", "lines": "a = e1 + e2\na² = 2"})
    page.page.locator("li.line").first.wait_for()
    assert [line[0] for line in lines_of(page)] == ["a = e1 + e2", "a² = 2"]
    assert lines_of(page)[1][2] == "true"
