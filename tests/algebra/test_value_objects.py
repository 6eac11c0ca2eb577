"""Objects of values in Python: their types, references and operators beside those of any operands."""

import gc
import inspect
import sys

import numpy as np
import pytest

import polhode as ph

R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 0.3)
S = ph.Rotor.from_plane_angle(ph.e2 ^ ph.e3, 1.1)
BATCH = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.array([0.3, 0.4]))
v = ph.vector([1.0, 2.0, 3.0])

OPERATIONS = {
    "rotors": lambda: S * R,
    "product": lambda: v * v,
    "number": lambda: 2.0 * v,
    "whole": lambda: v * 2,
    "sum": lambda: v + v,
    "difference": lambda: 1 - v,
    "negative": lambda: -R,
    "reverse": lambda: ~R,
    "turn": lambda: R(v),
    "batch": lambda: BATCH * R,
    "turned": lambda: BATCH(v),
    "log": lambda: R.log(),
    "logs": lambda: BATCH.log(),
    "exp": lambda: (ph.e1 ^ ph.e2).exp(),
    "masked": lambda: (ph.e1 ^ ph.e2).exp(errors="mask"),
    "refused": lambda: refused(v, "x"),
}


def refused(a, b):
    with pytest.raises(TypeError, match="multiply"):
        a * b
    return a


@pytest.mark.parametrize("name", OPERATIONS)
def test_operations_keep_counts_of_references(name):
    """Each object holds one reference to its type, to its array and to its algebra, and gives it up."""
    f = OPERATIONS[name]
    held = [ph.Multivector, ph.Rotor, R, v, BATCH, BATCH._data, BATCH.algebra]
    f()
    gc.collect()  # what earlier tests left in cycles holds the types too
    before = [sys.getrefcount(x) for x in held]
    for _ in range(1000):
        f()
    after = [sys.getrefcount(x) for x in held]
    assert max(abs(b - a) for a, b in zip(before, after, strict=True)) < 10
    kept = [f() for _ in range(100)]
    kinds = [type(x) for x in kept]
    assert sum(sys.getrefcount(x) for x in held[:2]) >= sum(before[:2]) + 99
    del kept, kinds
    gc.collect()
    assert max(abs(sys.getrefcount(x) - b) for x, b in zip(held[:2], before[:2], strict=True)) < 10


@pytest.mark.parametrize("form", [ph.Multivector, ph.Rotor])
def test_types_are_derived_but_have_their_methods(form):
    assert form.__module__ == "polhode"
    assert {"inverse", "exp", "log", "wedge"} <= set(dir(form))
    assert "log" in vars(form)
    assert str(inspect.signature(form.log)) == "(self, /, *, errors='raise')"
    assert "Examples" in form.exp.__doc__


@pytest.mark.parametrize("form", [ph.Multivector, ph.Rotor])
def test_classes_derived_by_users_have_no_constructor_either(form):
    class Derived(form):
        pass

    for create in (form, Derived):
        with pytest.raises(TypeError, match="has no public constructor"):
            create(1.0)
    with pytest.raises(TypeError, match="not safe"):
        object.__new__(form)


def test_methods_refuse_wrong_arguments():
    for call in (
        lambda: R.log(1),
        lambda: v.exp(error="mask"),
        lambda: R(),
        lambda: R(v, v),
        lambda: R(x=v, y=v),
    ):
        with pytest.raises(TypeError):
            call()
    for wrong in (v.exp, R.log):
        with pytest.raises(ValueError, match="errors"):
            wrong(errors="ignore")


def test_operators_of_single_values_are_those_of_rows():
    """The same bits: with numbers on both sides, and for rotors."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        a, b = (ph.multivector(x) for x in rng.standard_normal((2, 8)))
        rows = [ph.multivector([x.components]) for x in (a, b)]
        x = float(rng.standard_normal())
        for f in (
            lambda a, b, _x: a * b,
            lambda a, b, _x: a + b,
            lambda a, b, _x: a - b,
            lambda a, _b, x: x * a,
            lambda a, _b, x: a * x,
            lambda a, _b, x: x - a,
            lambda a, _b, x: a - x,
            lambda a, _b, _x: -a,
            lambda a, _b, _x: ~a,
        ):
            np.testing.assert_array_equal(f(a, b, x).components, f(*rows, x).components[0])
