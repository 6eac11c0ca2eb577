"""NumPy's functions and scalars on values: a product, a function of the value, or an error with a remedy."""

import operator

import numpy as np
import pytest
from scipy import integrate, interpolate, linalg, optimize, spatial

import polhode as ph
from polhode import e1, e2, e3
from samples import EPS, same

VALUES = {
    "vector": ph.vector([1.0, 2.0, 3.0]),
    "vectors": ph.vector(np.arange(9.0).reshape(3, 3)),
    "single precision": ph.vector(np.ones((3, 3), np.float32)),
    "rotor": ph.Rotor.from_plane_angle(e1 ^ e2, 0.3),
    "exact": ph.vector(np.array([1, 2, 3], dtype=object)),
    "complex": ph.vector([1j, 2, 3]),
    "in another algebra": ph.algebra(1, 3).vector([1.0, 2, 3, 4]),
}
NUMBERS = [
    np.float64(2),
    np.float32(2),
    np.int64(2),
    np.array(2.0),
    np.array([1.0, 2.0, 4.0]),
    np.array([1, 2, 3]),
]
OPERATORS = (
    *(operator.mul, operator.add, operator.sub, operator.truediv, operator.xor, operator.or_),
    *(operator.eq, operator.ne),
)


@pytest.mark.parametrize("name", VALUES)
@pytest.mark.parametrize("operate", OPERATORS)
def test_numbers_and_arrays_on_the_left_are_scalars(name, operate):
    A = VALUES[name]
    for left in NUMBERS:
        if operate is operator.truediv and name == "vectors":
            A = A + 1 * e1
        scalars = A.algebra.scalar(left)
        found, expected = operate(left, A), operate(scalars, A)
        if operate in (operator.eq, operator.ne):
            assert same(found, expected)
        else:
            assert isinstance(found, ph.Multivector)
            assert np.all(found.is_close(expected, rtol=1e-6 if name == "single precision" else 1e-14))
            assert found.shape == np.broadcast_shapes(np.shape(left), A.shape)


def test_functions_of_numpy_are_methods():
    a = VALUES["vector"] / 5
    M = 2 + a
    for f, method in [
        *((getattr(np, name), name) for name in ("exp", "log", "sqrt", "sin", "cos", "tan")),
        *((getattr(np, name), name) for name in ("sinh", "cosh", "tanh")),
        *((np.abs, "norm"), (np.conj, "conj"), (np.reciprocal, "inverse")),
        *((np.negative, "__neg__"), (np.positive, "__pos__")),
    ]:
        assert same(f(M), getattr(M, method)())
    assert type(np.exp(e1 ^ e2)) is ph.Rotor
    assert type(np.sqrt(VALUES["rotor"])) is ph.Rotor
    assert same(np.power(a, 2), a**2)
    assert same(np.add(a, 1), 1 + a)
    assert same(np.multiply(a, e2), a * e2)


@pytest.mark.parametrize(
    "call",
    [
        *(lambda a: np.sign(a), lambda a: np.arcsin(a), lambda a: np.isfinite(a), lambda a: np.maximum(a, 0)),
        *(lambda a: np.add.reduce(a), lambda a: np.multiply.outer(np.ones(2), a), lambda a: np.ones(3) < a),
        *(lambda a: np.ones(3) @ a, lambda a: np.ones(3) ** a, lambda a: np.ones(3) % a),
        *(lambda a: np.array([True]) * a, lambda a: np.array(["x"]) * a, lambda a: np.float64(1) // a),
        *(lambda a: np.multiply(np.ones(2), a, out=np.ones(2)), lambda a: np.exp(a, where=True)),
        *(
            lambda a: np.sum(a),
            lambda a: np.linalg.norm(a),
            lambda a: np.cross(a, a),
            lambda a: np.clip(a, 0, 1),
        ),
    ],
)
def test_other_functions_name_the_remedy(call):
    for name in ("vector", "vectors", "rotor"):
        with pytest.raises(TypeError, match=r"np\.\w+(\.\w+)? does not accept .*methods.*\.components"):
            call(VALUES[name])


def test_errors_name_the_function():
    for call, name in ((lambda: np.sign(e1), "np.sign"), (lambda: np.add.reduce(e1), "np.add.reduce")):
        with pytest.raises(TypeError, match=f"^{name} does not accept"):
            call()


def test_products_along_a_batch_name_the_remedy():
    turns = ph.Rotor.random(3, rng=1)
    for call in (np.cumprod, np.prod, np.multiply.accumulate, np.multiply.reduce):
        with pytest.raises(TypeError, match=r"write .*\(.*operator\.mul, R\)|operator\.mul\)\)"):
            call(turns)


def test_other_libraries_leave_operators_to_values():
    # They ask the value, and defer to None.
    assert e1.__array_ufunc__ is None
    assert callable(ph.Multivector.__array_ufunc__)


def test_scipy_takes_the_arrays():
    rng = np.random.default_rng(1)
    points = ph.vector(rng.standard_normal((20, 3)))
    R = ph.Rotor.random(20, rng=2)
    rotations = spatial.transform.Rotation.from_quat(R.to_quaternion(order="xyzw"))
    # Both turn by products of rounded entries.
    assert np.max(abs(rotations.apply(points.components) - R(points).components)) <= 64 * EPS
    again = spatial.transform.Rotation.from_matrix(R.to_matrix())
    assert np.max(abs(again.apply(np.asarray(points)) - R(points).components)) <= 64 * EPS
    spatial.transform.Rotation.from_rotvec(np.asarray(R.log().dual()))
    assert spatial.cKDTree(np.asarray(points)).query(points[3].components)[1] == 3
    linalg.svd(np.asarray(points), overwrite_a=True)
    linalg.expm(ph.LinearMap.from_function(R[0]).matrix)
    linalg.inv(ph.Inertia.from_principal_moments(1, 2, 3).matrix, overwrite_a=True)
    interpolate.CubicSpline(np.arange(20.0), points.components)(0.5)
    spatial.transform.Slerp(np.arange(20.0), rotations)(0.5)
    spatial.transform.RotationSpline(np.arange(20.0), rotations)(0.5)
    # A differential equation and a least-squares problem whose functions are written with values.
    spin = ph.bivector([0.0, 0.0, 1.0])

    def rate(_, x):
        return np.asarray(ph.vector(x).dot(spin))

    motion = integrate.solve_ivp(rate, (0, 1), e1.components, rtol=1e-10, atol=1e-12)
    # Its steps meet a local tolerance of 1e-10; some dozen of them.
    assert ph.vector(motion.y[:, -1]).is_close(ph.Rotor.from_plane_angle(spin, 1.0)(e1), rtol=1e-8)
    fit = optimize.least_squares(lambda x: (ph.vector(x) - 2 * e3).components, np.zeros(3))
    assert np.allclose(fit.x, [0, 0, 2])
