"""Values of the algebra in the page: formulas of 3-d space, shapes of projective and conformal geometry."""

import json

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3
from polhode._viewer.document import document
from polhode._viewer.html import page as html
from viewers import needs_bundle

P, C = ph.pga(3), ph.cga(3)
N = np.array([2.0, -1.0, 2.0]) / 3
AT = np.array([0.3, -0.7, 1.1])


def given(value):
    """Return the kind and the only shape of a value."""
    (entry,) = document(value)["values"]
    (shape,) = entry["shapes"]
    return entry["kind"], {name: x if name == "kind" else np.asarray(x) for name, x in shape.items()}


def same(shape, kind, **numbers):
    assert shape.pop("kind") == kind
    assert shape.keys() == numbers.keys()
    for name, x in numbers.items():
        np.testing.assert_allclose(shape[name], x, rtol=0, atol=1e-12, err_msg=name)


# --- 3-d space


def test_values_of_space_become_formulas():
    R = ph.Rotor.from_plane_angle(e1 ^ e2, 0.5)
    shown = document({"a": e1 - 0.5 * e2, "B": e2 ^ e3, "R": R, "M": 1 + e1})
    assert shown["lines"] == "a = e1 - 0.5 e2\nB = e2∧e3\nR = exp(-0.25 e1∧e2)\nM = 1 + e1"
    assert document([e1, e2 + e3])["lines"] == "e1\ne2 + e3"
    assert document({"a": ph.vector(np.eye(3))})["lines"] == "a1 = e1\na2 = e2\na3 = e3"


def test_formulas_have_the_values():
    from polhode._formula.shell.session import Session

    rng = np.random.default_rng(3)
    values = {"a": ph.vector(rng.normal(size=3)), "M": ph.multivector(rng.normal(size=8) * 1e-9)}
    values["R"] = ph.Rotor.random(rng=4)
    session = Session(only_finite=True)
    for line in document(values)["lines"].split("\n"):
        session.run(line)
    for name, value in values.items():
        # Six digits are shown.
        scale = np.abs(value.components).max()
        assert session.values[name].is_close(value, atol=1e-5 * scale, rtol=0)


# --- projective geometry


def test_points_lines_and_planes_of_projective_geometry():
    kind, shape = given(3 * P.point(AT))
    assert kind == "point"
    same(shape, "point", at=AT)
    kind, shape = given(-2 * P.plane(N, 0.4))
    same(shape, "plane", at=0.4 * N, normal=-N)
    kind, shape = given(P.line(AT, direction=N))
    same(shape, "line", at=AT - (AT @ N) * N, along=N)
    kind, shape = given(P.direction(2 * N))
    assert kind == "direction"
    same(shape, "direction", along=N)


def test_motors_are_screws():
    turn = ph.Rotor.from_axis_angle(N, 1.2)
    axis = np.array([0.5, 0.2, -0.3])
    axis -= (axis @ N) * N
    move = ph.RigidTransform(turn, axis - turn.to_matrix() @ axis + 0.8 * N)
    for value in (P.motor(move), -P.motor(move), move):
        kind, shape = given(value)
        assert kind == "motor"
        same(shape, "screw", at=axis, along=N, angle=1.2, shift=0.8)
    _, shape = given(P.translator([0.0, 0.0, -2.0]))
    same(shape, "screw", at=np.zeros(3), along=[0, 0, -1], angle=0, shift=2)


def test_values_at_infinity_are_listed_but_not_drawn():
    shown = document({"p": P.e0, "M": P.motor(ph.Rotor.identity())})["values"]
    assert [(entry["kind"], entry["shapes"]) for entry in shown] == [("plane at infinity", []), ("motor", [])]


# --- conformal geometry


def test_rounds_and_flats_of_conformal_geometry():
    kind, shape = given(-2 * C.up(AT))
    assert kind == "point"
    same(shape, "point", at=AT)
    kind, shape = given(C.sphere(AT, 0.7))
    same(shape, "sphere", at=AT, radius=0.7)
    kind, shape = given(C.sphere(AT, 0.7).dual())
    assert kind == "dual sphere"
    same(shape, "sphere", at=AT, radius=0.7)
    kind, shape = given(2 * C.circle(AT, N, 0.5))
    same(shape, "circle", at=AT, radius=0.5, normal=N)
    kind, shape = given(C.plane(N, -0.4))
    same(shape, "plane", at=-0.4 * N, normal=N)
    kind, shape = given(C.line(AT, direction=N))
    same(shape, "line", at=AT - (AT @ N) * N, along=N)


def test_point_pairs_are_two_points():
    (entry,) = document({"pair": C.point_pair(AT, N)})["values"]
    assert entry["kind"] == "point pair"
    np.testing.assert_allclose([shape["at"] for shape in entry["shapes"]], [AT, N], atol=1e-12)


def test_imaginary_rounds_are_named():
    apart = C.sphere([0, 0, 0], 1).dual() ^ C.sphere([3, 0, 0], 1).dual()
    (entry,) = document(apart.dual())["values"]
    assert (entry["kind"], entry["shapes"]) == ("imaginary circle", [])


# --- lists, batches, errors


def test_a_batch_is_drawn_together():
    places = np.random.default_rng(0).normal(size=(2, 5, 3))
    (entry,) = document({"cloud": P.point(places)})["values"]
    assert (entry["kind"], entry["text"]) == ("10 × point", "shape (2, 5)")
    np.testing.assert_allclose([shape["at"] for shape in entry["shapes"]], places.reshape(-1, 3), atol=1e-12)


@pytest.mark.parametrize(
    ("value", "error", "message"),
    [
        (ph.algebra(2).scalar(1), TypeError, "value of Cl\\(2\\): the page draws"),
        ([P.e0, "a"], TypeError, r"cannot show \(2\), of type str"),
        ({"2a": e1}, ValueError, "'2a' is not a name"),
        (ph.vector(np.ones((30, 3))), ValueError, "at most 24 values"),
        (P.point(np.ones((1001, 3))), ValueError, "at most 1000"),
        (P.point([np.inf, 0, 0]), ValueError, "not finite"),
        ({}, ValueError, "no values"),
    ],
)
def test_values_that_cannot_be_shown(value, error, message):
    with pytest.raises(error, match=message):
        document(value)


@needs_bundle
def test_the_page_draws_them(opened):
    values = {"A": P.point(AT), "p": P.plane(N, 0.4), "S": C.sphere(AT, 0.5), "a": e1 + e2}
    page = opened(document(values))
    rows = page.page.locator("[data-value]")
    rows.first.wait_for()
    assert rows.evaluate_all("all => all.map(row => row.dataset.value)") == ["A", "p", "S"]
    drawn = page.page.locator(".drawing canvas[aria-label]").get_attribute("aria-label")
    assert drawn.startswith("Drawing of: a, a vector; A, a point; p, a plane; S, a sphere.")


def test_a_document_is_json():
    text = html(document({"M": P.motor(None, [1.0, 2.0, 3.0]), "a": e1}))
    assert "screw" in text
    assert json.loads(json.dumps(document(P.point(AT))))["page"] == "algebra"
