"""Names of other libraries are errors, and what these tell to write works."""

import functools
import itertools
import math
import operator
import re
import rlcompleter

import numpy as np
import pytest
import quaternion
import sympy

import polhode as ph
from polhode import I, RigidTransform, Rotor, e1, e2
from polhode._algebra import foreign_tables, ufuncs
from polhode._mechanics import foreign_tables as names_of_motions
from polhode._support import package_names

x = sympy.Symbol("x")
TURNS = Rotor.random(3, rng=6)
V, PLANE, SPHERES = ph.vector(np.eye(3)), ph.pga(3), ph.cga(3)
BASE = {
    "np": np,
    "ph": ph,
    "functools": functools,
    "math": math,
    "itertools": itertools,
    "operator": operator,
    "sympy": sympy,
    "Rotor": Rotor,
    "RigidTransform": RigidTransform,
    "a": V,
    "b": Rotor.random(rng=4)(V),
    "A": 1 + e1 + I,
    "B": e1 ^ e2,
    "R": Rotor.random(rng=1),
    "S": Rotor.random(rng=2),
    "T": RigidTransform(Rotor.random(rng=3), e1),
    "theta": 0.3,
    "t": 0.5,
    "seq": "zyx",
    "name": "C3",
    "M": np.eye(3),
    "angles": [0.1, 0.2, 0.3],
    "q": [1, 0, 0, 0],
    "v": [1, 2, 3],
    "w": [3, -1, 2],
    "z": np.exp(1j * np.array([0.1, 0.2, 0.3])),
    "shape": (),
    "eps": 0.1,
    "axes": np.eye(3),
    "order": "e",
    "rtol": 0.1,
    "atol": 0.1,
    "x": [1, 2, 3],
    "xi": np.ones(6),
    "k": 1,
    "c": np.array([True, False, True]),
    "phi": 0.4,
    "H": np.eye(4),
    "D": [1, 0, 0, 0, 0, 0, 0, 0],
    "P": SPHERES.up([1, 2, 3]),
    "times": [0, 1],
    "U": RigidTransform(Rotor.random(rng=5), e2),
    "omega": np.zeros((2, 3)),
}
OF_PLANES = {
    "A": PLANE,
    "P": PLANE.point([1, 2, 3]),
    "Q": PLANE.point([0, 0, 1]),
    "θ": 0.3,
    "t": [1, 2, 3],
    "L": PLANE.line([0, 0, 0], [1, 0, 0]),
    "X": PLANE.plane([1, 0, 0]),
    "Y": PLANE.plane([0, 1, 0]),
}
OF_SPHERES = {
    "A": SPHERES,
    "P": SPHERES.up([1, 0, 0]),
    "Q": SPHERES.up([0, 1, 0]),
    "t": [1, 2, 3],
    "X": SPHERES.up([1, 0, 0]),
    "Y": SPHERES.line([0, 0, 0], [1, 0, 0]),
}
TABLES = {
    "MULTIVECTOR": (BASE["A"], {"P": OF_PLANES["P"]}),
    "ROTOR": (BASE["R"], {}),
    "PARTS_OF_ROTORS": (BASE["R"], {}),
    "TRANSFORM": (BASE["T"], {"S": RigidTransform(), "shape": (1,)}),
    "SPLINE": (spline := ph.RotorSpline([0, 1], Rotor.random(2, rng=6)), {"spline": spline}),
    "ALGEBRA": (ph.algebra(3), {"A": ph.algebra(3), "components": np.ones(3), "X": e1, "Y": e2}),
    "PGA": (PLANE, OF_PLANES),
    "CGA": (SPHERES, OF_SPHERES),
}
# Expressions that need a value of another kind.
OTHERS = {
    "astype(float)": {"value": sympy.Integer(2) * e1},
    "continuous()": {"value": Rotor.random(3, rng=1)},
    "factor()": {"value": e1 ^ e2},
    "reshape(-1)": {"value": V},
    "functools.reduce(operator.mul, R)": {"R": Rotor.random(3, rng=1)},
    "functools.reduce(operator.mul, T)": {"T": RigidTransform(Rotor.random(3, rng=1), e1)},
    "reshape(shape)": {"shape": ()},
    "k_vector(3, components)": {"components": np.ones(1)},
    "map(sympy.expand)": {"value": x * e1},
    "map(lambda c: sympy.integrate(c, x))": {"value": x * e1, "x": x},
    "map(lambda c: sympy.collect(c, x))": {"value": x * e1, "x": x},
    "ph.align([ph.e3, ph.e2], [a, b], weights=[np.inf, 1]).rotor": {"a": e1, "b": e2},
    "ph.concatenate([R, S])": {"R": Rotor.random(2, rng=1), "S": Rotor.random(3, rng=2)},
    **{
        f"multivector(components){part}": {"components": np.ones(8)}
        for part in ("", ".grade(0, 2)", ".grade(1, 3)")
    },
}


def expressions(text):
    """The expressions of a remedy, without the words after them."""
    for part in re.split(r",? or (?=[\w(~\"]+)", text):
        yield re.split(r", (?:which|the|as|with)\b| for | of | itself", part)[0]


def evaluated(text, names):
    """The value of an expression, or of the attribute or call of a value that it is."""
    first = re.match(r"[~(-]*(\w+)", text)[1]
    return eval(text if first in {*names, "len", "dict", "not", "float"} else f"value.{text}", dict(names))


REMEDIES = [
    pytest.param(table, name, text, id=f"{table}-{name}-{text}")
    for table in TABLES
    for name, remedy in vars(foreign_tables)[table].items()
    if table == "ALGEBRA" or name not in foreign_tables.ALGEBRA
    for text in expressions(remedy)
]


@pytest.mark.parametrize(("table", "name", "text"), REMEDIES)
def test_the_error_of_a_name_tells_what_works(table, name, text):
    value, names = TABLES[table]
    with pytest.raises(AttributeError, match=f"has no attribute '{name}'; write .*{re.escape(text)}"):
        getattr(value, name)
    evaluated(text, BASE | {"value": value} | names | OTHERS.get(text, {}))


FUNCTIONS = [
    pytest.param(text, names, id=f"{name}-{text}")
    for table, names in (
        (package_names.WRITE, {}),
        (ufuncs._OURS, {"A": V, "B": V, "R": TURNS, "shape": (1, 3), "x": 0, "y": 1}),
    )
    for name, remedy in table.items()
    for text in expressions(remedy)
]


@pytest.mark.parametrize(("text", "names"), FUNCTIONS)
def test_the_error_of_a_function_tells_what_works(text, names):
    eval(text, BASE | names | OTHERS.get(text, {}))


@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("kind", ["rotation", "rotor"])
@pytest.mark.parametrize("metric", ["chordal", "intrinsic"])
def test_distances_are_those_of_numpy_quaternion(kind, metric, turned):
    """A rotor and its opposite have a distance, but not their rotations."""
    name, pair = f"{kind}_{metric}_distance", {"R": BASE["R"], "S": BASE["S"] if turned > 0 else -BASE["S"]}
    theirs = getattr(quaternion, name)(*(R.to_numpy_quaternion() for R in pair.values()))
    assert eval(package_names.WRITE[name], BASE | pair) == pytest.approx(theirs, rel=1e-12)


def test_expressions_for_names_of_the_package_are_shown():
    for name, ours in package_names.WRITE.items():
        with pytest.raises(AttributeError, match=f"has no attribute '{name}'; write {re.escape(ours)}$"):
            getattr(ph, name)


@pytest.mark.parametrize("name", package_names.SEE)
def test_names_of_the_package_are_seen(name):
    for ours in re.split(", | and ", package_names.SEE[name]):
        assert callable(eval(f"ph.{ours}"))
    with pytest.raises(AttributeError, match=r"; see polhode\."):
        getattr(ph, name)
    with pytest.raises(ImportError, match=f"^cannot import name '{name}' from 'polhode'; see polhode"):
        exec(f"from polhode import {name}")
    assert not hasattr(ph, name)


@pytest.mark.parametrize("module", [ph.torque, ph.force, ph.event])
def test_the_error_of_a_law_tells_what_works(module):
    laws = {"kp": 1, "kd": 1, "d": 1, "h": [1, 0, 0], "k": 1, "mu": 1, "F": [1, 0, 0], "m": 1}
    laws |= {"area": 1, "offset": [1, 0, 0], "sun": [0, 0, 1]}
    laws |= {"times": [0, 1], "torques": np.zeros((2, 3))}
    for name, ours in module._FOREIGN.items():
        with pytest.raises(AttributeError, match=f"'{name}'; write ph.{re.escape(ours)}$"):
            getattr(module, name)
        for text in re.split(", or of (?:a centre|space) ", ours):
            eval(f"ph.{text}", BASE | laws)
    assert not hasattr(module, "nothing")


BOX, START = ph.Body.box([1, 2, 3], mass=1), ph.State(BASE["R"], [0, 0, 1], [1, 2, 3])
MOVING = {
    "STATE": START,
    "CLOSED_FORM": ph.FreeMotion(BOX.inertia, BASE["R"], [0, 0, 1]),
    "TRAJECTORY": ph.simulate(BOX, START, [0, 1]),
    "STEPPER": ph.Stepper(BOX, START),
    "HISTORY": ph.io.AttitudeHistory.of(ph.simulate(BOX, START, [0, 1])),
}


@pytest.mark.parametrize(
    ("table", "name"),
    [
        ("STATE", "q"),
        ("STATE", "R"),
        ("CLOSED_FORM", "rotor"),
        ("CLOSED_FORM", "omega"),
        ("CLOSED_FORM", "sol"),
        ("TRAJECTORY", "sol"),
        ("STEPPER", "qpos"),
        ("STEPPER", "qvel"),
        ("STEPPER", "wheel_speeds"),
        ("HISTORY", "omega"),
    ],
)
def test_the_error_of_a_motion_tells_what_works(table, name):
    ours = vars(names_of_motions)[table][name]
    with pytest.raises(AttributeError, match=f"'{name}'; write {re.escape(ours)}$"):
        getattr(MOVING[table], name)
    for text in re.split(r", and ", ours):
        eval(f"value.{text}", {"value": MOVING[table], "t": 0.5})


def test_blades_are_found_by_any_name():
    blades = ph.cga().blades
    for name in ("e12", "e1∧e2", "e21", "einf"):
        assert name in blades
        assert blades.get(name) == blades[name]
    assert "e7" not in blades
    assert blades.get("e7", 3) == 3


def test_names_are_completed_at_the_prompt():
    """The prompt of Python reads every attribute, and only ignores those that do not exist."""
    completer = rlcompleter.Completer({"A": ph.e1})
    assert completer.complete("A.compon", 0) == "A.components"
    assert completer.complete("A.", 0)
    assert not hasattr(ph.e1, "variable")
