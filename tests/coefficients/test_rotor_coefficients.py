"""Parameters of rotors over every kind of coefficients, against those of floats, and by symbols."""

import numpy as np
import pytest
import sympy

import polhode as ph
from kinds import halves, kinds
from polhode import RigidTransform, Rotor, e1, e2, e3

kind = kinds()
AXES = np.eye(3)
# Whole numbers with whole lengths, so that rotors of integers are exact.
ROWS = np.frompyfunc(lambda n: halves((), 1) * 0 + n, 1, 1)(np.array([[1, 2, 2, 4], [2, 4, 5, 6]]))
ANGLES, VECTORS = halves((2, 3), 1) / 4, halves((2, 3), 2)

# Of rotors R, an array of angles and one of vectors of the kind.
FUNCTIONS = {
    "from_euler": lambda R, a, v: Rotor.from_euler("xyz", a),
    "from_euler in degrees": lambda R, a, v: Rotor.from_euler("ZXZ", a, degrees=True),
    "to_euler": lambda R, a, v: R.to_euler("xyz"),
    "to_euler in degrees": lambda R, a, v: R.to_euler("ZYZ", degrees=True),
    "from_mrp": lambda R, a, v: Rotor.from_mrp(v),
    "to_mrp": lambda R, a, v: R.to_mrp(),
    "from_davenport": lambda R, a, v: Rotor.from_davenport(AXES, "extrinsic", a),
    "to_davenport": lambda R, a, v: R.to_davenport(AXES, "intrinsic"),
    "from_axis_angle": lambda R, a, v: Rotor.from_axis_angle(v, a[..., 0]),
    "from_axis_angle in degrees": lambda R, a, v: Rotor.from_axis_angle(v, a[..., 0], degrees=True),
    "angle": lambda R, a, v: R.angle,
    "canonical": lambda R, a, v: (-R).canonical(),
    "continuous": lambda R, a, v: ph.stack([R[0, ...], -R[1, ...]]).continuous(),
    "from_vectors": lambda R, a, v: Rotor.from_vectors(v, a),
    "from_multivector": lambda R, a, v: Rotor.from_multivector(1 * R),
    "left_jacobian": lambda R, a, v: ph.left_jacobian(a),
    "slerp": lambda R, a, v: ph.slerp(R[0, ...], R[1, ...], a[..., 0]),
    "power": lambda R, a, v: R ** a[..., 0],
    "as_exp_coords": lambda R, a, v: RigidTransform(R, v).as_exp_coords(),
    "as_matrix": lambda R, a, v: RigidTransform(R, v).as_matrix(),
    "interpolate": lambda R, a, v: (
        RigidTransform(R[0, ...], v).interpolate(RigidTransform(R[1, ...], v), 0.5).as_matrix()
    ),
}


def arguments(kind):
    return Rotor.from_components(kind.array(ROWS)), kind.array(ANGLES), kind.array(VECTORS)


def numbers_of(kind, x):
    """The components as floats; of symbols x_k, which stand for the odd halves, with these numbers."""
    data = x._data if isinstance(x, ph.Multivector) else x
    if kind.name != "sympy":
        return kind.floats(data)
    values = {kind.make(n): float(n) for n in {*ANGLES.flat, *VECTORS.flat}}
    values = {symbol: n for symbol, n in values.items() if symbol.free_symbols}
    return np.reshape([float(sympy.sympify(c).subs(values)) for c in np.ravel(data)], np.shape(data))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_parameters_are_those_of_floats(kind, name):
    if kind.name == "sympy" and name in ("as_exp_coords", "interpolate", "left_jacobian", "from_vectors"):
        pytest.skip("expressions of some seconds; the other test of symbols has shorter ones")
    found = kind.evaluate(FUNCTIONS[name], *arguments(kind))
    data = found._data if isinstance(found, ph.Multivector) else found
    if kind.name.startswith(("float", "jax", "array")):
        assert kind.is_own(data)
    if kind.name == "int":  # whole numbers, not halves
        floats = [np.array(kind.array(x), float) for x in (ROWS, ANGLES, VECTORS)]
    elif kind.name == "fraction":
        floats = [np.array(x, float) / 3 for x in (ROWS, ANGLES, VECTORS)]
    else:
        floats = [np.array(x, float) for x in (ROWS, ANGLES, VECTORS)]
    expected = FUNCTIONS[name](Rotor.from_components(floats[0]), *floats[1:])
    expected = expected._data if isinstance(expected, ph.Multivector) else expected
    # Some hundred roundings of numbers below 10, in degrees of 180.
    size = 1e3 if "degrees" in name else 10
    assert np.all(np.abs(numbers_of(kind, found) - expected) <= 64 * kind.eps * size)


@pytest.mark.parametrize("call", [ph.mean, lambda R: R.reduce(right=Rotor.group("O"))])
def test_means_of_exact_numbers_are_clear_errors(kind, call):
    R = arguments(kind)[0]
    if kind.name.startswith(("float", "jax", "array")) and call is ph.mean:
        assert kind.holds(kind.evaluate(call, R))
    elif kind.name.startswith("float"):
        assert kind.holds(call(R))
    else:
        with pytest.raises(TypeError, match=r"needs .*floats.*astype\(float\)"):
            call(R)


def test_symbolic_parameters():
    t, u = sympy.symbols("t u", positive=True)
    R = Rotor.from_axis_angle([0, 0, 1], t)
    assert R(e1).simplify() == sympy.cos(t) * e1 + sympy.sin(t) * e2
    assert Rotor.from_axis_angle([0, 0, 1], 180 * t / sympy.pi, degrees=True) == R
    half = Rotor.from_mrp([0, 0, sympy.tan(t / 4)])
    assert (half(e1) - R(e1)).simplify() == 0
    values = {t: 0.3, u: 0.7}
    both = R * Rotor.from_axis_angle([1, 0, 0], u)
    for found, expected in (
        (both.to_euler("ZYX"), [0.3, 0.0, 0.7]),
        (both.to_davenport([e3, e2, e1], "intrinsic"), [0.3, 0.0, 0.7]),
        (R.to_mrp(), [0, 0, np.tan(0.075)]),
        (RigidTransform(R, u * e3).as_exp_coords(), [0, 0, 0.3, 0, 0, 0.7]),
    ):
        numbers = [float(sympy.sympify(x).subs(values)) for x in found]
        # Square roots of rounding near gimbal angles of 0.
        np.testing.assert_allclose(numbers, expected, rtol=0, atol=1e-7)
    with pytest.raises(TypeError, match="axes along e1, e2 and e3"):
        both.to_davenport([[1, 1, 0], [0, 0, 1], [1, 0, 0]], "intrinsic")


def test_numbers_take_the_precision_of_the_axis():
    for turn in (0.5, np.float32(0.5)):
        assert Rotor.from_axis_angle(np.eye(3, dtype=np.float32), turn).dtype == np.float32
    angles = np.ones((2, 3), np.float32)
    R = Rotor.from_davenport(AXES, "e", angles)
    assert R.dtype == R.to_davenport(AXES, "e").dtype == R.reduce(right=Rotor.group("O")).dtype == np.float32
