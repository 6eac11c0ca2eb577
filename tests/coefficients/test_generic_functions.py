"""inverse, exp, log, sqrt over other coefficients: against the core, exact and symbolic identities."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import polhode as ph
from generic_arrays import (
    EPS,
    MASKS,
    difference,
    eight_of,
    exact,
    floating,
    fractions,
    multiplied,
    native,
    of,
    one_of,
)
from polhode._generic import functions, layout
from polhode._generic.exact import Exact

__all__ = ["floating"]
F = Fraction
NAMES = ("inverse", "exp", "log", "sqrt")
EVEN, BIVECTOR, ALL = 0b0101, 0b0100, 0b1111


def call(name, d, data, mask):
    return getattr(functions, name)(d, data, mask)


@pytest.mark.parametrize("name", NAMES)
def test_grades_are_those_of_the_core(name):
    for mask in MASKS:
        assert layout.indices(mask) == ph.e1.algebra._indices(mask)
        assert layout.grades_of(name, mask) == ph.e1.algebra._grades_of_function(name, mask)


# --- floating-point arrays


def samples(mask, seed):
    """Random components at several sizes; some nearly even, nearly null, or near ±1."""
    rng = np.random.default_rng(seed)
    full = np.concatenate([rng.standard_normal((12, 8)) * scale for scale in (1e-3, 1.0, 4.0)])
    near = np.array([[s, 0, 0, 0, 0, 0, 0, 0] for s in (1, -1)]) + 1e-7 * rng.standard_normal((6, 2, 8))
    tilted = rng.standard_normal((6, 8)) * [1, 1e-9, 1e-9, 1e-9, 1, 1, 1, 1e-9]
    return np.concatenate([full, near.reshape(-1, 8), tilted])[:, layout.indices(mask)]


def eigenvalues(full):
    """λ± of rows of eight."""
    zeta = full[:, 0] + 1j * full[:, 7]
    a, b = full[:, 1:4], full[:, 4:7]
    root = np.sqrt((a * a).sum(1) - (b * b).sum(1) + 2j * (a * b).sum(1))
    return zeta + root, zeta - root


@pytest.mark.parametrize("name", NAMES)
def test_floats_are_those_of_the_core(name, floating):
    for mask in MASKS:
        data = samples(mask, mask)
        full = eight_of(data, mask)
        plus, minus = eigenvalues(full)
        size = np.linalg.norm(full, axis=-1)
        condition = size**2 / np.abs(plus * minus) + 1
        cut = (np.minimum(plus.real, minus.real) < 0) & (np.abs(full[:, 1:4]).max(1) < 1e-6)
        regular = (
            (condition < 1e4) & ~cut
            if name in ("log", "sqrt", "inverse") and mask & 0b1010
            else condition < 1e12
        )
        # As many rows for every mask: JAX compiles anew for each shape.
        rows = np.resize(np.flatnonzero(regular), len(data))
        data, condition = data[rows], condition[rows]
        x = floating(data)
        got, grades = call(name, of(x), x, mask)
        expected, core_grades = native(name, data, mask)
        assert grades == core_grades
        assert type(got) is type(x)
        # Rounding ζ² − w leaves eps |M|² beside |λ+ λ−|, and exp magnifies rounding of its argument by |M|;
        # two dozen operations either way.
        allowed = (
            48 * EPS * condition if name != "exp" else 48 * EPS * (1 + np.linalg.norm(data, axis=-1)) ** 2
        )
        assert np.all(difference(got, expected) <= allowed * np.linalg.norm(expected, axis=-1) + 16 * EPS)


@pytest.mark.parametrize("name", NAMES)
def test_batches_and_single_values(name, floating):
    data = np.random.default_rng(3).standard_normal((2, 1, 3, 8)) + 6 * np.eye(8)[0]
    x = floating(data)
    got, _ = call(name, of(x), x, ALL)
    assert got.shape == data.shape
    one, _ = call(name, of(x), x[1, 0, 2, ...], ALL)
    assert difference(one, np.asarray(got)[1, 0, 2]) <= 4 * EPS * np.linalg.norm(np.asarray(one))
    empty = floating(np.ones((0, 8)))
    assert call(name, of(empty), empty, ALL)[0].shape == (0, 8)


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e160, 1e300])
def test_sizes_at_the_ends_of_the_range(scale, floating):
    eight = np.array([3.0, 1, -0.5, 0.25, 0.5, -1, 0.75, 2])
    for mask in MASKS:
        part = eight[layout.indices(mask)]
        x = floating(scale * part)
        d = of(x)
        norm = np.linalg.norm(part)
        assert abs(float(functions.norm(d, x)) / scale - norm) <= 4 * EPS * norm
        assert difference(functions.normalized(d, x), part / norm) <= 8 * EPS
        for name, power in (("inverse", -1), ("sqrt", 0.5)):
            got, _ = call(name, d, x, mask)
            expected, _ = native(name, part, mask)
            assert difference(np.asarray(got) / scale**power, expected) <= 64 * EPS * np.linalg.norm(expected)
        log, _ = call("log", d, x, mask)
        assert difference(log, native("log", scale * part, mask)[0]) <= 8 * EPS * 700


def test_exp_of_large_arguments(floating):
    x = floating(np.array([-800.0, 800.0, 0, 0]))
    assert difference(functions.exp(of(x), x, 0b0011)[0], [0.5, 0.5, 0, 0]) <= 4 * EPS
    turn = 1e160 * np.array([0.48, -0.6, 0.64])
    x = floating(turn)
    assert abs(float(functions.norm(of(x), functions.exp(of(x), x, BIVECTOR)[0])) - 1) <= 4 * EPS
    null = floating(1e200 * np.array([1.0, 0, 0, 0, 0, 1.0]))  # e1 + e1e2: the series ends
    assert np.array_equal(
        np.asarray(functions.exp(of(null), null, 0b0110)[0]), [1, 1e200, 0, 0, 0, 0, 1e200, 0]
    )


def test_float32_is_as_accurate_as_it_can_be():
    jnp = pytest.importorskip("jax.numpy")
    data = np.random.default_rng(4).standard_normal((50, 8)).astype(np.float32) + 4 * np.eye(8, dtype="f4")[0]
    for name in NAMES:
        got, _ = call(name, of(jnp.asarray(data)), jnp.asarray(data), ALL)
        assert got.dtype == np.float32
        expected, _ = native(name, data.astype(float), ALL)
        assert np.all(difference(got, expected) <= 64 * 2.0**-23 * np.linalg.norm(expected, axis=-1) * 4)


def test_roots_across_the_cut_square_to_their_argument(floating):
    # The eigenvalues −1 ± size (1 + I): their roots nearly cancel.
    m = np.array([[-1, 0, 0, size, 0, 0, size, 0] for size in (0.1, 1e-3, 1e-6, 1e-9, 1e-12)])
    x = floating(m)
    root = np.asarray(call("sqrt", of(x), x, ALL)[0])
    square = multiplied(of(root), root, ALL, root, ALL)
    assert np.all(difference(square, m) <= 32 * EPS)
    assert np.all(root[:, 0] > 0), "the principal root"


SPECIAL = [
    ("log", 0b0001, [-1.0], [0, 0, 0, np.pi]),
    ("log", ALL, [-1.0, 0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, np.pi, 0]),
    ("log", ALL, [-1.0, 0, 0, 0, 0, 0, 0, -0.0], [0, 0, 0, 0, 0, 0, np.pi, 0]),
    ("log", EVEN, [-1.0, 0, 1e-200, 0], [0, 0, np.pi, 0]),
    ("sqrt", EVEN, [-1.0, 0, 0, 0], [0, 0, 0, 1]),
    ("sqrt", ALL, [-4.0, 0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 2, 0]),
    ("sqrt", EVEN, [0.0, 0, 0, 0], [0, 0, 0, 0]),
    ("sqrt", ALL, [0.0] * 8, [0] * 8),
    ("sqrt", 0b0011, [1.0, 1, 0, 0], [0.5**0.5, 0.5**0.5, 0, 0, 0, 0, 0, 0]),
    ("exp", BIVECTOR, [0.0, 0, 0], [1, 0, 0, 0]),
    ("exp", ALL, [0.0] * 8, [1, 0, 0, 0, 0, 0, 0, 0]),
    ("exp", 0b0110, [1.0, 0, 0, 0, 0, 1], [1, 1, 0, 0, 0, 0, 1, 0]),
]


@pytest.mark.parametrize(("name", "mask", "value", "expected"), SPECIAL)
def test_special_values(name, mask, value, expected, floating):
    x = floating(np.array(value))
    assert difference(call(name, of(x), x, mask)[0], expected) <= 4 * EPS * 4


ERRORS = [
    ("inverse", 0b0011, [1.0, 1, 0, 0], "no inverse"),
    ("inverse", ALL, [0.0] * 8, "no inverse"),
    ("log", 0b0011, [1.0, 1, 0, 0], "no logarithm"),
    ("log", EVEN, [0.0, 0, 0, 0], "no logarithm"),
    ("sqrt", 0b0110, [1.0, 0, 0, 0, 0, 1], "no square root"),
    ("exp", 0b0001, [1000.0], "beyond the range"),
    ("exp", ALL, [np.nan] * 8, "NaN or infinite"),
    ("exp", 0b0010, [1000.0, 0, 0], "beyond the range"),
]


@pytest.mark.parametrize(("name", "mask", "value", "message"), ERRORS)
def test_undefined_values_raise_with_the_index(name, mask, value, message, floating):
    one = floating(np.array(value))
    with pytest.raises(ValueError, match=f"^[^(]*{message}"):
        call(name, of(one), one, mask)
    ones = np.tile(
        np.eye(8)[0][layout.indices(mask)] if mask & 1 else np.array([*[0.5] * (len(value) - 1), 0.7]),
        (2, 2, 1),
    )
    ones[1, 0] = value
    batch = floating(ones)
    with pytest.raises(ValueError, match=rf"at index \(1, 0\): .*{message}"):
        call(name, of(batch), batch, mask)
    if name == "inverse" and not np.any(value):
        with pytest.raises(ValueError, match="no direction"):
            functions.normalized(of(one), one)


# --- exact


@pytest.mark.parametrize("mask", MASKS)
def test_inverses_of_fractions_are_exact(mask):
    data = fractions((6, len(layout.indices(mask))), mask)
    data[:, 0] += 10
    d = of(data)
    inverse, grades = functions.inverse(d, data, mask)
    assert grades == layout.grades_of("inverse", mask)
    for product in (multiplied(d, data, mask, inverse, grades), multiplied(d, inverse, grades, data, mask)):
        assert np.array_equal(product, one_of(product))
    assert all(isinstance(x, int | F) for x in inverse.flat)


def test_quotients_of_integers_are_fractions():
    d = Exact()
    inverse, _ = functions.inverse(d, d.asarray([1, 2, 3, 4]), EVEN)
    assert list(inverse) == [F(1, 30), F(-1, 15), F(-1, 10), F(-2, 15)]
    assert list(functions.normalized(d, d.asarray([3, 0, 4]))) == [F(3, 5), 0, F(4, 5)]
    assert functions.norm(d, d.asarray([F(3, 2), 0, 2])) == F(5, 2)
    assert functions.norm_squared(d, d.asarray([F(1, 2), 1])) == F(5, 4)
    assert functions.norm(d, d.asarray([1, 1])) == 2**0.5


def test_exact_roots_and_functions():
    d = Exact()
    assert list(functions.sqrt(d, d.asarray([3, 0, 0, 4]), EVEN)[0]) == [2, 0, 0, 1]
    assert list(functions.sqrt(d, d.asarray([-3, 0, 0, 4]), EVEN)[0]) == [1, 0, 0, 2]
    assert list(functions.sqrt(d, d.asarray([-3, 0, 0, -4]), EVEN)[0]) == [1, 0, 0, -2]
    assert list(functions.sqrt(d, d.asarray([F(-1, 4)]), 1)[0]) == [0, 0, 0, F(1, 2)]
    assert list(functions.sqrt(d, d.asarray([5, 4, 0, 0]), 3)[0]) == [2, 1, 0, 0, 0, 0, 0, 0]
    assert list(functions.exp(d, d.asarray([0, 0, 0]), BIVECTOR)[0]) == [1, 0, 0, 0]
    assert list(functions.exp(d, d.asarray([1, 0, 0, 0, 0, 1]), 0b0110)[0]) == [1, 1, 0, 0, 0, 0, 1, 0]
    assert list(functions.log(d, d.asarray([1, 0, 0, 0]), EVEN)[0]) == [0, 0, 0, 0]


@pytest.mark.parametrize("mask", MASKS)
@pytest.mark.parametrize("name", ["exp", "log", "sqrt"])
def test_functions_of_fractions_are_near_those_of_the_core(name, mask):
    data = fractions((8, len(layout.indices(mask))), mask)
    got, _ = call(name, of(data), data, mask)
    expected, _ = native(name, data.astype(float), mask)
    # A root of a difference of products of up to a few hundred, a dozen roundings after exact products.
    assert np.all(difference(got, expected) <= 256 * EPS * (1 + np.linalg.norm(expected, axis=-1)))


@pytest.mark.parametrize(("name", "mask", "value", "message"), ERRORS[:5])
def test_undefined_exact_values_raise_with_the_index(name, mask, value, message):
    d = Exact()
    one = d.asarray(np.array(value))
    with pytest.raises(ValueError, match=f"^{message}"):
        call(name, d, one, mask)
    rows = np.stack([2 * one + 3, one])
    with pytest.raises(ValueError, match=rf"^at index \(1,\): {message}"):
        call(name, d, rows, mask)
    with pytest.raises(ValueError, match="NaN or infinite"):
        call(name, d, exact([float("nan"), *one[1:]]), mask)
    with pytest.raises(ValueError, match=r"^at index \(1,\): .*no direction"):
        functions.normalized(d, exact([[1, 2], [0, 0]]))


def test_multiprecision_numbers_keep_their_precision():
    with mpmath.workdps(60):
        tiny = mpmath.mpf(10) ** -55
        for mask in MASKS:
            data = np.frompyfunc(lambda x: mpmath.mpf(x.numerator) / x.denominator, 1, 1)(
                fractions((len(layout.indices(mask)),), mask)
            )
            d = of(data)
            log, grades = functions.log(d, data, mask)
            back, back_grades = functions.exp(d, log, grades)
            root, root_grades = functions.sqrt(d, data, mask)
            square = multiplied(d, root, root_grades, root, root_grades)
            want = eight_of(data, mask)
            assert all(
                abs(x - y) < tiny * 1000 for x, y in zip(eight_of(back, back_grades), want, strict=True)
            )
            assert all(abs(x - y) < tiny * 1000 for x, y in zip(square, want, strict=True))
