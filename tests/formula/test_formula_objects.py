"""Formulas themselves: values that are compared, pickled and printed, with trees, grades and steps."""

import pickle
import weakref

import pytest

import polhode as ph
from polhode import e1, e2
from samples import random_rotors


def test_formulas_are_made_by_a_function():
    f = ph.formula("a b")
    assert isinstance(f, ph.Formula)
    assert weakref.ref(f)() is f
    for arguments in ((), ("a b",), (f,)):
        with pytest.raises(TypeError, match=r"ph\.formula\(text\)|missing"):
            type(f)(*arguments)
    with pytest.raises(AttributeError):
        f.other = 1


def test_formulas_are_values():
    f = ph.formula("R̃aR + V(a)", define={"V(x)": "x·e1"})
    again = pickle.loads(pickle.dumps(f))
    assert again == f
    assert hash(again) == hash(f)
    assert f != ph.formula("R̃aR + V(a)", define={"V(x)": "x·e2"})
    assert f != "R̃aR + V(a)"
    R = random_rotors(())
    assert again(R=R, a=e2) == f(R=R, a=e2)
    assert repr(f) == "ph.formula('R̃aR + V(a)')"
    other = pickle.loads(pickle.dumps(ph.formula("p", algebra=ph.algebra(4, 1))))
    assert other == ph.formula("p", algebra=ph.algebra(4, 1)) != ph.formula("p")


def test_spellings():
    f = ph.formula("-1/2 a^b ~R + <M>_2 pi")
    assert str(f) == str(ph.formula(str(f))) == str(ph.formula(f.ascii))
    assert f.ascii.isascii()
    assert f._repr_latex_() == f"${f.latex}$"
    assert r"\wedge" in f.latex
    # Letters without values may be factors later.
    for text in ("(Iω)·f", "(ab)²", "a/(bc)", "RaR~"):
        assert str(ph.formula(text)) == text


def test_trees_know_their_text_and_grades():
    tree = ph.formula("R a ~R + ½ B").tree(R="rotor", a=1, B=(2,))
    assert (tree["kind"], tree["value"], tree["grades"], tree["span"]) == ("sum", ["+", "+"], (1, 2), (0, 12))
    turned, half = tree["children"]
    assert (turned["text"], turned["grades"]) == ("R a ~R", (1,))
    assert [child["kind"] for child in half["children"]] == ["number", "name"]
    equation = ph.formula("a = b").tree(a=e1, b="vector")
    assert [side["text"] for side in equation["children"]] == ["a", "b"]
    assert ph.formula("x y + 1").tree()["grades"] == (0, 1, 2, 3)


def test_grades_and_steps_without_values():
    f = ph.formula("R a ~R + inertia(B)")
    assert f.grades(R="rotor", a=1, B=2, inertia="map of bivectors") == (1, 2)
    steps = f.steps(R="rotor", a=1, B=2, inertia="map of bivectors")
    assert steps[0] == "#1 = turn(R, a): grade 1, for R a ~R"
    assert steps[1] == "#2 = inertia(B): grade 2, for inertia(B)"
    for kinds_, message in [({"a": 4}, "grades 0 to 3"), ({"a": "plane"}, "rotor"), ({"a": ()}, "no grades")]:
        with pytest.raises(ValueError, match=message):
            ph.formula("a").grades(**kinds_)
    with pytest.raises(TypeError, match="expected grades"):
        ph.formula("a").grades(a=None)


def test_unused_values_change_nothing():
    """Neither in the first call nor in later ones."""
    f = ph.formula("a + 1")
    for _ in range(3):
        assert f(a=1.0, b=5.0) == 2
        assert f(b=ph.e1, a=1.0, c=ph.e1 ^ ph.e2) == 2
        assert ph.evaluate("a b", a=ph.e1, c=ph.e3, b=ph.e2) == ph.e1 * ph.e2
