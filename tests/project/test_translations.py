"""Every line of docs/translations.md, run: the peer's expression and ours give the same numbers."""

import numpy as np
import pytest

import polhode as ph
from translations import INTRODUCTION, SECTIONS, TABLES, code, numbers

EPS = 2.0**-52
MODULES = {"SciPy": "scipy", "numpy-quaternion": "quaternion"}
CASES = [
    pytest.param(library, line, id=f"{library}-{line.operation}")
    for library, table in TABLES.items()
    for line in table
]


@pytest.fixture(scope="module")
def ours():
    names = {}
    exec(code(INTRODUCTION), names)
    return names


@pytest.fixture(scope="module")
def theirs():
    """The names of each peer's set-up, computed on access."""
    made = {}

    def names(library):
        pytest.importorskip(MODULES.get(library, library))
        if library not in made:
            made[library] = {}
            exec(code(SECTIONS[library]), made[library])
        return made[library]

    return names


@pytest.mark.parametrize(("library", "line"), CASES)
def test_the_line_holds(library, line, ours, theirs):
    right = eval(line.ours, dict(ours))
    if line.theirs is None:
        return
    left = eval(line.theirs, dict(theirs(library)))
    if isinstance(right, bool | np.bool_):
        assert left == right
        return
    x, y = numbers(left), numbers(right)
    if x.ndim != y.ndim:  # a number and a scalar
        x, y = (z if z.ndim else z * np.eye(8)[0] for z in (x, y))
    assert x.shape == y.shape
    if library == "SciPy" and isinstance(right, ph.Rotor):
        x = x * np.sign((x * y).sum(axis=-1, keepdims=True))
    # The longest chains, inverses and exponentials, round some tens of times.
    assert np.abs(x - y).max() <= 64 * EPS * max(1, np.abs(y).max())


@pytest.mark.parametrize("library", ["clifford", "kingdon", "galgebra", "galaga"])
def test_every_operation_is_translated(library):
    wanted = [line.operation for line in TABLES["clifford"]]
    assert [line.operation for line in TABLES[library] if line.operation in wanted] == wanted


def test_operations_of_a_table_are_unique():
    for table in TABLES.values():
        operations = [line.operation for line in table]
        assert len(operations) == len(set(operations)) > 20


def test_the_recipe_for_slerp_at_any_times(theirs):
    names = dict(theirs("SciPy"))
    exec(code(SECTIONS["SciPy"], 1), names)
    expected = ph.Rotor.from_scipy(eval("Slerp(times, rotations)(t)", names))
    assert (names["turned"].distance(expected) < 16 * EPS).all()


def test_the_rates_of_splines_are_those_of_scipy():
    from scipy.spatial.transform import RotationSpline

    times = np.linspace(0, 2, 101)
    rotors = ph.Rotor.from_euler("ZXY", np.stack([np.sin(times), 0.7 * times, 0.4 * times**2], axis=-1))
    theirs, spline = RotationSpline(times, rotors.to_scipy()), ph.RotorSpline(times, rotors)
    # Two curves through the same attitudes, which differ in the fourth power of the step, 1.6e-7.
    assert np.allclose(theirs(1.03, 1), spline.omega_body(1.03).dual().components, atol=1e-5)
    assert np.allclose(theirs(1.03, 2), spline.alpha_body(1.03).dual().components, atol=1e-3)
