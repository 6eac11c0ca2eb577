"""Motors of every kind of coefficients: functions, paths, screws, derivatives at singular points."""

from fractions import Fraction

import numpy as np
import pytest
import sympy

import polhode as ph
from generic_arrays import EPS, difference, floating
from polhode import RigidTransform, Rotor, e1, e2, e3

__all__ = ["floating"]
A = ph.algebra(3, 0, 1)
N = A.basis_vectors[3]


def bivectors(count=30):
    """Screws of small and large turns, pure translations, turns near half a turn."""
    b = np.random.default_rng(1).standard_normal((count, 6))
    b[:5] *= 1e-9
    b[5:10, [0, 1, 3]] *= 1e-9
    b[10:12, [0, 1, 3]] = 0
    b[12:15, [0, 1, 3]] *= np.pi / 2 / np.linalg.norm(b[12:15, [0, 1, 3]], axis=-1, keepdims=True)
    b[15] = 0
    return b


def test_functions_are_those_of_the_core(floating):
    b = bivectors()
    B, expected = A.bivector(floating(b)), A.bivector(b).exp()
    M = B.exp()
    assert M.grades == expected.grades
    # A dozen roundings of numbers below |b|² < 30.
    assert np.all(difference(M.components, expected.components) <= 256 * EPS)
    log, core = M.log(), expected.log()
    assert log.grades == core.grades
    assert np.all(difference(log.components, core.components) <= 1024 * EPS)
    assert np.all(difference(log.exp().components, expected.components) <= 1024 * EPS)
    assert np.all(difference(M.sqrt().components, expected.sqrt().components) <= 1024 * EPS)
    assert np.all(difference((M**0.3).components, (expected**0.3).components) <= 1024 * EPS)
    double = (2.0 * M).log()
    assert np.all(difference(double.components[..., 0], np.full(30, np.log(2))) <= 64 * EPS)
    scaled = M * (3.0 + 0.5 * A.I)
    assert np.all(difference(scaled.normalized().components, expected.components) <= 256 * EPS)


def test_paths_and_screws_are_those_of_the_core(floating):
    M, expected = A.bivector(floating(bivectors())).exp(), A.bivector(bivectors()).exp()
    t = np.linspace(0, 1, 3)[:, None]
    path, core = ph.slerp(M[:15], M[15:], floating(t)), ph.slerp(expected[:15], expected[15:], t)
    assert np.all(difference(path.components, core.components) <= 4096 * EPS)
    matrices = ph.adjoint_matrix(M)
    assert type(matrices) is type(M.components)
    assert np.all(np.abs(np.asarray(matrices) - ph.adjoint_matrix(expected)) <= 1024 * EPS)
    found, screw = ph.screw_parameters(M), ph.screw_parameters(expected)
    for x, y in zip(found, screw, strict=True):
        value, other = (np.asarray(getattr(v, "components", v), float) for v in (x, y))
        value, other = (np.delete(v, slice(12, 15), axis=0) for v in (value, other))  # half turns: ± axis
        # The point of the axis of a turn by 1e-9 is 1e9 away; its direction is known to 1e-7 then.
        assert np.all(np.abs(value - other) <= 1e-6 * (1 + np.abs(other)))


def test_a_motor_that_is_not_one_is_an_error(floating):
    good = np.eye(8)[0]
    wrong = floating(np.stack([good, good + np.eye(8)[7]]))  # 1 + J: M ~M is not a number
    M = ph.Multivector._of(wrong, 0b10101, A)
    with pytest.raises(ValueError, match=r"(at index \(1,\).*not a motor|at index \(1,\).*log)"):
        M.log()
    zero = ph.Multivector._of(floating(np.stack([good, np.zeros(8)])), 0b10101, A)
    with pytest.raises(ValueError, match=r"index \(1,\)"):
        zero.log()


# --- JAX


def jax_with_64_bits():
    jax = pytest.importorskip("jax")
    return jax, jax.enable_x64(True)


# Over (e12, e13, e14, e23, e24, e34): nothing, a translation, half a turn, almost one, almost none.
SPECIAL = {
    "identity": [0.0, 0, 0, 0, 0, 0],
    "translation": [0.0, 0, 1, 0, 2, -1],
    "half a turn": [np.pi / 2, 0, 1, 0, 0.5, -1],
    "nearly half a turn": [0.3, -0.4, 1, np.sqrt((np.pi / 2 - 1e-9) ** 2 - 0.25), 0.5, -1],
    "a tiny turn": [1e-12, 0, 1, 2e-12, 0.5, -1],
    "most of a turn": [2.0, 1.0, 1, -1.0, 0.5, -1],
}


def special(jax):
    return jax.numpy.asarray(list(SPECIAL.values()))


def test_exp_and_log_are_inverse_to_second_order_under_jit():
    jax, bits = jax_with_64_bits()
    with bits:

        def there_and_back(x):
            return A.bivector(x).exp().log().grade(2).components

        slope = jax.jacfwd(there_and_back)
        both = jax.jit(jax.vmap(lambda x: jax.jvp(slope, (x,), (jax.numpy.ones(6),))))
        first, second = both(special(jax))
        np.testing.assert_allclose(first, np.broadcast_to(np.eye(6), first.shape), rtol=0, atol=256 * EPS)
        np.testing.assert_allclose(second, 0, rtol=0, atol=4096 * EPS)


def test_paths_and_screws_have_finite_derivatives():
    jax, bits = jax_with_64_bits()
    with bits:
        start = A.scalar(1.0)

        def height(x, t):
            return ph.slerp(start, A.bivector(x).exp(), t).components.sum()

        slope = jax.jit(jax.vmap(jax.grad(height, (0, 1)), (0, None)))(special(jax), 0.3)
        assert all(np.all(np.isfinite(np.asarray(part))) for part in slope)

        def screw(x):
            found = ph.screw_parameters(A.bivector(x).exp())
            return found.axis.components.sum() + found.point.components.sum() + found.angle + found.distance

        assert np.all(np.isfinite(np.asarray(jax.jit(jax.vmap(jax.grad(screw)))(special(jax)))))


def test_powers_by_arrays_of_exponents_and_vmap():
    jax, bits = jax_with_64_bits()
    with bits:
        M = A.bivector(jax.numpy.asarray(bivectors())).exp()
        t = jax.numpy.linspace(-1, 1, 30)
        together = (M**t).components
        each = jax.vmap(lambda m, s: (m**s).components)(M, t)
        assert np.all(difference(together, each) <= 16 * EPS)


# --- SymPy and exact numbers


def test_a_symbolic_screw():
    angle, rise, t = sympy.symbols("theta h t", positive=True)
    B = -angle / 2 * (A.basis_vectors[0] ^ A.basis_vectors[1]) + rise / 2 * (A.basis_vectors[2] ^ N)
    M = B.exp()
    assert (M * ~M).simplify() == 1
    expected = RigidTransform(Rotor.from_plane_angle(e1 ^ e2, angle), rise * e3).to_motor()
    assert (M - expected).simplify() == 0
    part = (B * t).exp()
    assert (part.subs(t, 1) - M).simplify() == 0
    half = M.subs(angle, sympy.pi / 2).log()
    assert half.simplify() == B.subs(angle, sympy.pi / 2).simplify()
    velocity = part.diff(t).simplify().subs(t, 0)
    assert (velocity - B).simplify() == 0
    quarter = M.subs(angle, sympy.pi / 2)
    assert ((quarter**t).subs(t, 1) - quarter).simplify() == 0
    path = ph.slerp(A.scalar(sympy.Integer(1)), quarter, t)
    assert (path - quarter**t).simplify() == 0


def test_symbolic_transforms_have_screws():
    x, y, rise = sympy.symbols("x y h", positive=True)
    turn = RigidTransform(Rotor.from_plane_angle(e1 ^ e2, sympy.pi / 2), rise * e3)
    there = RigidTransform(translation=ph.vector([x, y, 0]))
    axis, point, angle, distance = (there * turn * there.inv()).screw_parameters()
    assert axis.simplify() == e3
    assert (point - x * e1 - y * e2).simplify() == 0
    assert sympy.simplify(angle - sympy.pi / 2) == 0
    assert sympy.simplify(distance - rise) == 0
    twist = sympy.symbols("a b c u v w", real=True)
    moved = sympy.Matrix(there.adjoint()) * sympy.Matrix(twist)
    a, b, c, u, v, w = twist
    assert list(moved) == [a, b, c, u + y * c, v - x * c, w + x * b - y * a]
    shift = there.screw_parameters()
    assert sympy.simplify(shift.distance - sympy.sqrt(x**2 + y**2)) == 0
    assert shift.pitch == sympy.oo
    assert (
        there.to_motor().log() == sympy.Rational(1, 2) * (x * A.basis_vectors[0] + y * A.basis_vectors[1]) * N
    )


def test_exact_translations_stay_exact():
    there = RigidTransform(translation=ph.vector([Fraction(1), Fraction(2), Fraction(2)]))
    motor = there.to_motor()
    assert all(not isinstance(x, float) for x in motor.components.flat)
    assert (motor ** Fraction(1, 3)).log() * 3 == motor.log()
    axis, point, angle, distance = there.screw_parameters()
    assert (axis, point) == (Fraction(1, 3) * e1 + Fraction(2, 3) * e2 + Fraction(2, 3) * e3, 0)
    assert (angle, distance) == (0, 3)
    assert (there.adjoint()[3:, :3] == np.array([[0, -2, 2], [2, 0, -1], [-2, 1, 0]])).all()
    with pytest.raises(ValueError, match="not a motor"):
        (motor + A.I).log()
    assert (
        RigidTransform.from_exp_coords([Fraction(0)] * 3 + [Fraction(1), Fraction(2), Fraction(2)]) == there
    )
