"""The algebra over SymPy expressions: results are the formulas of the handout."""

from fractions import Fraction

import numpy as np
import pytest

from generic_arrays import eight_of, multiplied, native, of, signature_terms
from polhode._generic import algebras, functions, layout, rotors
from polhode._generic.products import product

sympy = pytest.importorskip("sympy")
t, s = sympy.symbols("t s", positive=True)
x, y, z = sympy.symbols("x y z", real=True)
SCALAR, VECTOR, BIVECTOR, TRIVECTOR, EVEN, ALL = 1, 2, 4, 8, 5, 15


def symbols(*elements):
    return of(list(elements), t), of(t).asarray(list(elements))


def is_same(values, expected):
    return all(sympy.simplify(a - b) == 0 for a, b in zip(values, expected, strict=True))


def at(values, **numbers):
    """The values as floats."""
    free = {symbol: numbers[symbol.name] for v in values for symbol in sympy.sympify(v).free_symbols}
    return np.array([float(sympy.sympify(v).subs(free)) for v in values])


def test_exp_of_a_symbolic_turn():
    d, B = symbols(0, 0, t / 2)
    R, mask = functions.exp(d, B, BIVECTOR)
    assert mask == EVEN
    assert list(R) == [sympy.cos(t / 2), 0, 0, sympy.sin(t / 2)]
    assert is_same(multiplied(d, R, EVEN, rotors.to_quaternion(d, R), EVEN), [1] + [0] * 7)
    # A symbol of unknown sign gives the same.
    theta = sympy.Symbol("theta")
    assert functions.exp(d, d.asarray([0, theta, 0]), BIVECTOR)[0][2] == sympy.sin(theta)


def test_exp_of_a_turn_in_a_tilted_plane_has_no_roots_of_squares():
    d = of(x)
    B = d.asarray([Fraction(3, 5) * x, 0, Fraction(4, 5) * x])
    R, _ = functions.exp(d, B, BIVECTOR)
    assert is_same(R, [sympy.cos(x), sympy.sin(x) * 3 / 5, 0, sympy.sin(x) * 4 / 5])


def test_rotors_of_any_bivector_are_unit():
    d, B = symbols(x, y, z)
    R, _ = functions.exp(d, B, BIVECTOR)
    assert sympy.simplify(functions.norm_squared(d, R)) == 1


def test_exp_of_vectors_scalars_and_trivectors():
    d, a = symbols(0, x, 0)
    assert is_same(functions.exp(d, a, VECTOR)[0], [sympy.cosh(x), 0, sympy.sinh(x), 0])
    assert list(functions.exp(d, d.asarray([x]), SCALAR)[0]) == [sympy.exp(x)]
    assert is_same(functions.exp(d, d.asarray([x]), TRIVECTOR)[0], [sympy.cos(x), sympy.sin(x)])
    got = functions.exp(d, d.asarray([y, 0, 0, x]), EVEN)[0]
    assert is_same(got, [sympy.exp(y) * sympy.cos(x), 0, 0, sympy.exp(y) * sympy.sin(x)])


def test_log_undoes_exp():
    d = of(t)
    R, _ = functions.exp(d, d.asarray([0, 0, x / 2]), BIVECTOR)
    log, mask = functions.log(d, R, EVEN)
    assert mask == EVEN
    assert np.allclose(at(log, x=0.75), [0, 0, 0, 0.375], rtol=0, atol=1e-15)
    assert np.allclose(at(log, x=-0.75), [0, 0, 0, -0.375], rtol=0, atol=1e-15)
    minus_one, _ = functions.log(d, d.asarray([sympy.Integer(-1)]), SCALAR)
    assert list(minus_one) == [0, 0, 0, sympy.pi]
    assert list(functions.log(d, d.asarray([t]), SCALAR)[0]) == [sympy.log(t), 0, 0, 0]
    unknown, _ = functions.log(d, d.asarray([x]), SCALAR)
    assert np.allclose(at(unknown, x=-2.0), [np.log(2), 0, 0, np.pi])
    assert np.allclose(at(unknown, x=2.0), [np.log(2), 0, 0, 0])


@pytest.mark.parametrize("name", ["inverse", "exp", "log", "sqrt"])
@pytest.mark.parametrize("mask", range(1, 16))
def test_functions_of_any_symbols_are_those_of_the_core(name, mask):
    """With symbols, for which the values are substituted afterwards."""
    numbers = dict(zip("abcdefgh", (0.7, -1.1, 0.4, 0.9, 0.3, -0.8, 1.3, 0.6), strict=True))
    all8 = np.array([sympy.Symbol(name, real=True) for name in numbers], dtype=object)
    symbol = all8[layout.indices(mask)]
    values = np.array([numbers[v.name] for v in symbol])
    if name in ("log", "sqrt") and mask == SCALAR | TRIVECTOR:
        values = abs(values)
    got, grades = getattr(functions, name)(of(symbol), symbol, mask)
    expected, core = native(name, values, mask)
    assert grades == core
    put_in = {v.name: float(value) for v, value in zip(symbol, values, strict=True)}
    assert np.allclose(at(got, **put_in), expected, rtol=1e-13, atol=1e-13)


def test_symbolic_inverses():
    d = of(t)
    bivector, _ = functions.inverse(d, d.asarray([0, 0, x]), BIVECTOR)
    assert list(bivector) == [0, 0, -1 / x]
    data = d.asarray([x, 0, 0, y])
    inverse, _ = functions.inverse(d, data, EVEN)
    assert is_same(inverse, [x / (x**2 + y**2), 0, 0, -y / (x**2 + y**2)])
    null = d.asarray([sympy.cos(x) ** 2 + sympy.sin(x) ** 2, 1, 0, 0])
    with pytest.raises(ValueError, match="no inverse"):
        functions.inverse(d, null, SCALAR | VECTOR)


def test_symbolic_roots():
    d = of(t)
    assert list(functions.sqrt(d, d.asarray([t**2]), SCALAR)[0]) == [t, 0, 0, 0]
    assert list(functions.sqrt(d, d.asarray([-t]), SCALAR)[0]) == [0, 0, 0, sympy.sqrt(t)]
    half, _ = functions.sqrt(d, d.asarray([x, 0, 0, y]), EVEN)
    square = multiplied(d, half, EVEN, half, EVEN)
    assert is_same(square, eight_of(d.asarray([x, 0, 0, y]), EVEN))


# --- rotors


def test_a_symbolic_turn():
    d = of(t)
    R = rotors.from_plane_angle(d, d.asarray([0, 0, 1]), d.asarray(x))
    assert list(R) == [sympy.cos(x / 2), 0, 0, -sympy.sin(x / 2)]
    matrix = rotors.to_matrix(d, R)
    expected = [[sympy.cos(x), -sympy.sin(x), 0], [sympy.sin(x), sympy.cos(x), 0], [0, 0, 1]]
    for row, row_expected in zip(matrix, expected, strict=True):
        assert is_same(row, row_expected)
    turned = rotors.apply(d, R, d.asarray([1, 0, 0]), VECTOR)
    assert is_same(turned, [sympy.cos(x), sympy.sin(x), 0])
    assert is_same(rotors.power(d, R, 2), [sympy.cos(x), 0, 0, -sympy.sin(x)])
    assert list(rotors.from_components(d, R)) == list(R)  # its norm proves to be 1
    twice = rotors.multiply(d, R, R)
    assert is_same(twice, [sympy.cos(x), 0, 0, -sympy.sin(x)])
    back = rotors.from_matrix(d, matrix)
    assert np.allclose(at(back, x=0.8), at(R, x=0.8))
    plane, angle = rotors.plane_angle(d, R)
    assert np.allclose(at([*plane, angle], x=0.8), [0, 0, 1, 0.8])
    assert np.allclose(at([*plane, angle], x=-0.8), [0, 0, -1, 0.8])
    assert np.allclose(at(rotors.to_rotation_vector(d, R), x=0.8), [0, 0, 0.8])
    assert np.allclose(at(rotors.to_rotation_vector(d, R), x=4.0), [0, 0, 4.0 - 2 * np.pi])


def test_vanishing_expressions_are_found_numerically():
    f = sympy.Function("f")
    d = of(t)
    R = d.asarray([sympy.cos(f(t)), 0, 0, sympy.sin(f(t))])
    assert list(rotors.from_components(d, R)) == list(R)
    for null in (x + abs(x), sympy.diff(f(t), t) ** 2 - f(t) ** 2, x - t, x - abs(x)):
        inverse, _ = functions.inverse(d, d.asarray([null]), SCALAR)
        assert list(inverse) == [1 / null]
    zero = sympy.expand((f(t) + x) ** 2) - f(t) ** 2 - 2 * x * f(t) - x**2
    with pytest.raises(ValueError, match="no inverse"):
        functions.inverse(d, d.asarray([zero, (x + 1) ** 2 - x**2 - 2 * x - 1, 0, 0]), SCALAR | VECTOR)


def test_from_vectors_of_symbols():
    d = of(t)
    R = rotors.from_vectors(d, d.asarray([1, 0, 0]), d.asarray([sympy.cos(x), sympy.sin(x), 0]))
    assert np.allclose(at(R, x=0.8), [np.cos(0.4), 0, 0, -np.sin(0.4)])
    quarter = rotors.from_vectors(d, d.asarray([t, 0, 0]), d.asarray([0, s, 0]))
    assert is_same(quarter, [sympy.sqrt(2) / 2, 0, 0, -sympy.sqrt(2) / 2])


# --- other signatures


def test_a_boost_of_spacetime():
    d, terms = of(t), signature_terms(1, 1, 0)
    boost = algebras.exp(d, terms, [3], d.asarray([0, 0, 0, x]))
    assert is_same(boost, [sympy.cosh(x), 0, 0, sympy.sinh(x)])
    turn = algebras.exp(d, signature_terms(2, 0, 0), [3], d.asarray([0, 0, 0, t]))
    assert is_same(turn, [sympy.cos(t), 0, 0, sympy.sin(t)])
    shift = algebras.exp(d, signature_terms(1, 0, 1), [3], d.asarray([0, 0, 0, t]))
    assert list(shift) == [1, 0, 0, t]
    mixed = np.zeros(16, dtype=int).astype(object)
    mixed[[3, 12]] = x, y
    with pytest.raises(TypeError, match="squares to a number; split it"):
        algebras.exp(d, signature_terms(4, 0, 0), [3, 12], mixed)


def test_symbolic_inverses_in_other_signatures():
    d, terms = of(t), signature_terms(1, 1, 1)
    M = d.asarray([x, 1, 0, y, 0, 2, 0, 0])
    inverse = algebras.inverse(d, terms, 3, M)
    assert is_same(product(d, terms, 8, M, inverse), [1] + [0] * 7)
