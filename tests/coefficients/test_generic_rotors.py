"""Rotors over other coefficients: against the compiled core, and exact rational rotations."""

from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from generic_arrays import EPS, difference, exact, floating, of
from polhode import _native
from polhode._generic import functions, rotors
from polhode._generic.exact import Exact

__all__ = ["floating"]
F = Fraction
BIVECTOR = 0b0100


def quaternions(seed, count=40):
    """Unit components over the whole double cover, also near ±1 and near half turns."""
    rng = np.random.default_rng(seed)
    c = rng.standard_normal((count, 4))
    c[10:20, 1:] *= 10.0 ** rng.uniform(-12, -1, (10, 1))
    c[20:25, 0] *= 1e-9
    c[25:27, 1:] = 0
    return c / np.linalg.norm(c, axis=-1, keepdims=True)


def test_rotors_are_those_of_the_core(floating):
    c = quaternions(1)
    r = floating(c)
    d = of(r)
    # A dozen operations each on components of at most 1 (angles: π).
    assert np.all(difference(rotors.from_components(d, floating(3 * c)), c) <= 8 * EPS)
    core_matrix = _native.rotor_to_matrix(c).reshape(-1, 3, 3)
    assert np.all(abs(np.asarray(rotors.to_matrix(d, r)) - core_matrix) <= 16 * EPS)
    assert np.all(difference(rotors.to_quaternion(d, r), _native.rotor_to_quaternion(c)) == 0)
    turns = _native.rotor_to_rotation_vector(c)
    assert np.all(difference(rotors.to_rotation_vector(d, r), turns) <= 16 * EPS)
    plane, angle = rotors.plane_angle(d, r)
    pairs = _native.rotor_plane_angle(c)
    assert np.all(difference(plane, pairs[:, :3]) <= 8 * EPS)
    assert np.all(abs(np.asarray(angle) - pairs[:, 3]) <= 16 * EPS)
    assert np.all(difference(rotors.from_plane_angle(d, plane, angle), c) <= 16 * EPS)
    back = rotors.from_rotation_vector(d, floating(turns))
    assert np.all(difference(back, _native.rotor_from_rotation_vector(turns)) <= 8 * EPS)
    assert np.all(difference(functions.exp(d, rotors.log(d, r), BIVECTOR)[0], c) <= 16 * EPS)
    matrices = floating(core_matrix)
    flat = np.ascontiguousarray(core_matrix.reshape(-1, 9))
    assert np.all(difference(rotors.from_matrix(d, matrices), _native.rotor_from_matrix(flat)) <= 32 * EPS)


def test_powers_and_products(floating):
    c, e = quaternions(2), quaternions(3)
    r, q = floating(c), floating(e)
    d = of(r)
    product = rotors.multiply(d, r, q)
    data = (ph.Multivector._of(c, 5) * ph.Multivector._of(e, 5)).components
    assert np.all(difference(product, data) <= 8 * EPS)
    assert np.all(difference(rotors.power(d, r, 2.0), rotors.multiply(d, r, r)) <= 32 * EPS)
    n = floating(np.linspace(-1, 1, len(c)))
    assert rotors.power(d, r, n).shape == c.shape
    assert np.all(difference(rotors.power(d, r, 1.0), c) <= 16 * EPS)


@pytest.mark.parametrize(("left", "right"), [((), ()), ((3, 1), (2,)), ((2,), ()), ((), (0,))])
def test_rotors_act_on_any_grades(left, right, floating):
    rng = np.random.default_rng(4)
    c = rng.standard_normal((*left, 4))
    c = c / np.linalg.norm(c, axis=-1, keepdims=True)
    for mask, size in ((0b0010, 3), (0b0100, 3), (0b1001, 2), (0b1111, 8)):
        value = rng.standard_normal((*right, size))
        r, m = floating(c), floating(value)
        got = rotors.apply(of(r, m), r, m, mask)
        batch = np.broadcast_shapes(left, right)
        wide = [np.ascontiguousarray(np.broadcast_to(v, (*batch, v.shape[-1]))) for v in (c, value)]
        core = ph.Rotor._from_rows(wide[0])(ph.Multivector._of(wide[1], mask)).components
        assert got.shape == core.shape
        assert np.all(abs(np.asarray(got) - core) <= 32 * EPS * (1 + abs(core).max(initial=0)))


def test_from_vectors_of_opposite_vectors(floating):
    rng = np.random.default_rng(5)
    a = rng.standard_normal((30, 3))
    b = rng.standard_normal((30, 3))
    b[10:15], b[15:20] = a[10:15], -a[15:20]
    b[20:25] = -a[20:25] + 1e-9 * b[20:25]
    x, y = floating(a), floating(b)
    got = rotors.from_vectors(of(x), x, y)
    core = _native.rotor_from_vectors(np.hstack([a, b]))
    assert np.all(difference(got[:20, ...], core[:20]) <= 16 * EPS)
    turned = np.asarray(rotors.apply(of(x), got, x, 0b0010))
    units = [
        v / np.linalg.norm(v, axis=-1, keepdims=True) * np.linalg.norm(a, axis=-1, keepdims=True)
        for v in (b,)
    ]
    assert np.all(difference(turned, units[0]) <= 32 * EPS * np.linalg.norm(a, axis=-1))


def test_from_matrix_returns_the_nearest_rotation(floating):
    noisy = _native.rotor_to_matrix(quaternions(6)).reshape(-1, 9) + 1e-5 * np.random.default_rng(7).uniform(
        -1, 1, (40, 9)
    )
    x = floating(noisy.reshape(-1, 3, 3))
    assert np.all(difference(rotors.from_matrix(of(x), x), _native.rotor_from_matrix(noisy)) <= 64 * EPS)


@pytest.mark.parametrize(
    ("make", "bad", "message"),
    [
        (rotors.from_components, np.zeros(4), "not a rotor"),
        (rotors.from_components, np.full(4, np.nan), "NaN or infinite"),
        (lambda d, x: rotors.from_plane_angle(d, x, x[..., 0]), np.zeros(3), "spans no plane"),
        (lambda d, x: rotors.from_vectors(d, x, x), np.zeros(3), "no direction"),
        (rotors.from_matrix, np.zeros((3, 3)), "not a rotation matrix"),
        (rotors.from_matrix, np.diag([1.0, 1, -1]), "reflection"),
    ],
)
def test_invalid_rotors_raise_with_the_index(make, bad, message, floating):
    good = np.eye(3) if bad.ndim == 2 else np.ones_like(bad)
    x = floating(np.stack([good, bad]))
    with pytest.raises(ValueError, match=rf"at index \(1,\): .*{message}"):
        make(of(x), x)
    if not np.isnan(bad).any():
        d = Exact()
        with pytest.raises(ValueError, match=rf"at index \(1,\): .*{message}"):
            make(d, d.asarray(np.stack([good, bad])))


# --- exact


def test_rational_rotations_are_exact():
    d = Exact()
    R = rotors.from_components(d, d.asarray([2, 4, 0, 4]))  # 36 = 6²
    assert list(R) == [F(1, 3), F(2, 3), 0, F(2, 3)]
    matrix = rotors.to_matrix(d, R)
    assert all(isinstance(x, int | F) for x in matrix.flat)
    assert np.array_equal(matrix @ matrix.T, np.eye(3, dtype=int))
    assert np.array_equal(rotors.from_matrix(d, matrix), R)
    turned = rotors.apply(d, R, d.asarray([[1, 0, 0], [0, 1, 2]]), 0b0010)
    assert np.array_equal(turned, [matrix[:, 0], matrix[:, 1] + 2 * matrix[:, 2]])
    assert np.array_equal(rotors.power(d, R, 3), rotors.multiply(d, R, rotors.multiply(d, R, R)))
    assert np.array_equal(rotors.multiply(d, R, rotors.power(d, R, -1)), [1, 0, 0, 0])
    assert np.array_equal(rotors.power(d, R, 0), [1, 0, 0, 0])


def test_exact_half_and_quarter_turns():
    d = Exact()
    half = rotors.from_vectors(d, d.asarray([2, 0, 0]), d.asarray([-3, 0, 0]))
    assert np.array_equal(rotors.to_matrix(d, half) @ [1, 0, 0], [-1, 0, 0])
    for diagonal in ((1, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1)):
        m = d.asarray(np.diag(diagonal))
        assert np.array_equal(rotors.to_matrix(d, rotors.from_matrix(d, m)), m)
    third = rotors.from_matrix(d, exact([[0, 0, 1], [1, 0, 0], [0, 1, 0]]))
    assert list(third) == [F(1, 2), F(-1, 2), F(-1, 2), F(-1, 2)]
    assert list(rotors.log(d, d.asarray([1, 0, 0, 0]))) == [0, 0, 0]
    assert list(rotors.log(d, d.asarray([-1, 0, 0, 0]))) == [0, 0, np.pi]
    plane, angle = rotors.plane_angle(d, d.asarray([0, 0, -1, 0]))
    assert list(plane) == [0, 1, 0]
    assert angle == np.pi


def test_exact_rotors_are_near_those_of_the_core():
    c = np.random.default_rng(8).integers(-4, 5, (20, 4)) + 0
    c[:, 0] += 1
    d = Exact()
    r = rotors.from_components(d, d.asarray(c[c.any(axis=1)]))
    floats = r.astype(float)
    assert np.all(difference(rotors.log(d, r), rotors.log(of(1.0), floats)) <= 16 * EPS)
    turns = rotors.to_rotation_vector(d, r)
    assert np.all(difference(turns, _native.rotor_to_rotation_vector(floats)) <= 16 * EPS)
    assert np.all(
        difference(rotors.from_rotation_vector(d, turns), floats * np.where(floats[:, :1] < 0, -1, 1))
        <= 16 * EPS
    )
