"""`RigidTransform` against 4x4 matrices, SciPy, screws in closed form, symbols and JAX."""

import contextlib
import copy
import pickle

import mpmath
import numpy as np
import pytest

import polhode as ph
from polhode import RigidTransform, e1, e2, e3

EPS = np.finfo(float).eps


@pytest.fixture
def transforms():
    rng = np.random.default_rng(1)
    return RigidTransform(ph.Rotor.random((6,), rng=2), rng.standard_normal((6, 3)))


def applied(matrices, points):
    return np.einsum("...ij,...j->...i", matrices[..., :3, :3], points) + matrices[..., :3, 3]


# --- points and groups


@pytest.mark.parametrize("angle", [7.0, 1.0, 1e-3, 1e-9, 0.0])
def test_turns_about_an_axis_through_a_point(angle):
    """The point moves along the axis alone, and another turns about it: p + R (x − p) + d n, in 50 digits."""
    axis, point, x, distance = [2, -1, 2], [3e3, 1.0, -2e3], [3001.0, 5.0, -2e3], 0.25
    T = RigidTransform.from_screw(axis, point, angle, distance)
    with mpmath.workdps(50):
        n = mpmath.matrix(axis) / 3
        hat = mpmath.matrix([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
        turn = mpmath.sin(angle) * hat + 2 * mpmath.sin(mpmath.mpf(angle) / 2) ** 2 * hat * hat
        shift = np.array([float(c) for c in -turn * mpmath.matrix(point) + distance * n])
        moved = [
            float(c)
            for c in mpmath.matrix(x) + turn * (mpmath.matrix(x) - mpmath.matrix(point)) + distance * n
        ]
    # Products of the parts of the point, of size 4e3, with sin θ or smaller numbers.
    np.testing.assert_allclose(
        T.translation.components, shift, rtol=0, atol=16 * EPS * (4e3 * min(angle, 2) + distance)
    )
    np.testing.assert_allclose(T.apply(x), moved, rtol=0, atol=64 * EPS * 4e3)
    degrees = RigidTransform.from_screw(axis, point, np.rad2deg(angle), distance, degrees=True)
    assert degrees.is_close(T, atol=64 * EPS * 4e3)


def test_screws_restore_transforms(transforms):
    for T in (transforms, RigidTransform(), RigidTransform.from_translation([1, -2, 3])):
        assert np.all(RigidTransform.from_screw(*T.screw_parameters()).is_close(T, atol=64 * EPS))
    many = RigidTransform.from_screw(np.eye(3)[:, None], e1, np.arange(4.0), [0.0])
    assert many.shape == (3, 4)
    assert many[2, 1].is_close(RigidTransform.from_screw(e3, [1, 0, 0], 1.0), atol=8 * EPS)
    with pytest.raises(ValueError, match=r"the axis at index \(1,\) is \[0.0, 0.0, 0.0\]"):
        RigidTransform.from_screw([[1, 0, 0], [0, 0, 0]], e1, 1.0)
    with pytest.raises(ValueError, match=r"the point needs 3 components"):
        RigidTransform.from_screw(e3, [1, 0], 1.0)


def test_the_handouts_displacement():
    """Handout eq. (4.1), y = R x ~R + x0."""
    R, x0, x = ph.Rotor.from_plane_angle(e1 ^ e2, np.pi / 2), e3, e1
    moved = RigidTransform(R, x0)
    assert moved.apply(x).is_close(e2 + e3, atol=2 * EPS)
    assert moved.apply(e2 + e3, inverse=True).is_close(e1, atol=2 * EPS)
    assert moved(x) == moved.apply(x)


def test_points_may_be_vectors_or_arrays(transforms):
    points = np.random.default_rng(3).standard_normal((6, 3))
    found = transforms.apply(points)
    assert isinstance(found, np.ndarray)
    np.testing.assert_allclose(found, applied(transforms.as_matrix(), points), rtol=0, atol=16 * EPS)
    np.testing.assert_array_equal(transforms.apply(ph.vector(points)).components, found)
    assert transforms.apply([1.0, 0.0, 0.0]).shape == (6, 3)


def test_products_are_those_of_matrices(transforms):
    other = transforms[::-1]
    product = (transforms * other).as_matrix()
    np.testing.assert_allclose(product, transforms.as_matrix() @ other.as_matrix(), rtol=0, atol=32 * EPS)
    for back in (transforms.inv(), ~transforms, transforms.inverse(), transforms**-1):
        expected = np.linalg.inv(transforms.as_matrix())
        np.testing.assert_allclose(back.as_matrix(), expected, rtol=0, atol=32 * EPS)


def test_batches(transforms):
    assert transforms.shape == (6,)
    assert len(transforms) == 6
    assert not transforms.single
    assert transforms[2].single
    assert (RigidTransform.stack(list(transforms)) == transforms).all()
    joined = RigidTransform.concatenate([transforms, transforms[0]])
    assert joined.shape == (7,)
    assert joined[6] == transforms[0]
    assert RigidTransform(ph.Rotor.identity(4), [1, 2, 3]).translation.shape == (4,)
    assert RigidTransform(ph.Rotor.identity((2, 1)), np.ones((1, 5, 3))).shape == (2, 5)
    with pytest.raises(ValueError, match=r"the rotor has \(2,\), the translation \(3,\)"):
        RigidTransform(ph.Rotor.identity(2), np.zeros((3, 3)))
    with pytest.raises(TypeError, match="no length"):
        len(transforms[0])
    for one in (transforms[0], transforms[:0]):
        with pytest.raises(TypeError, match="no truth value"):
            bool(one)


def test_values_are_kept(transforms):
    for same in (pickle.loads(pickle.dumps(transforms)), copy.deepcopy(transforms)):
        assert (same == transforms).all()
    with pytest.raises(AttributeError, match="immutable"):
        transforms.rotor = ph.Rotor.identity()
    assert str(RigidTransform(translation=[1, 0, 0])) == "RigidTransform(rotor=1, translation=e1)"
    first = f"rotor={transforms[0].rotor}, translation={transforms[0].translation}"
    assert str(transforms).startswith(f"RigidTransform of shape (6,):\n[{first},\n rotor=")
    assert str(RigidTransform.identity(9)).endswith(",\n …,\n rotor=1, translation=0]")
    assert f"{RigidTransform(translation=[1, 2, 0]):.1f}" == (
        "RigidTransform(rotor=1.0, translation=1.0 e1 + 2.0 e2)"
    )
    assert RigidTransform.identity() == RigidTransform()


# --- screws


def screw_matrix(coords):
    """The matrix exponential of a twist, in 40 digits."""
    with mpmath.workdps(40):
        a, b, c, x, y, z = (mpmath.mpf(float(k)) for k in coords)
        found = mpmath.expm(mpmath.matrix([[0, -c, b, x], [c, 0, -a, y], [-b, a, 0, z], [0, 0, 0, 0]]))
        return np.array(found.tolist(), float)


# No turn, tiny and ordinary ones, turns near and beyond half a turn, pure translations.
TWISTS = [
    [0, 0, 0, 0, 0, 0],
    [0, 0, 0, 1, -2, 3],
    [1e-300, 0, 0, 1, 2, 3],
    [1e-9, -2e-9, 1e-9, 1, 2, 3],
    [0.3, -0.2, 0.1, 1, 2, 3],
    [0, 0, 3.14159265, 1, 2, 3],
    [2.0, 2.0, 2.0, 1e3, -1e3, 1e-3],
    [0, 0, 5.0, 0, 0, 1],
]


@pytest.mark.parametrize("coords", TWISTS)
def test_screws_are_matrix_exponentials(coords):
    size = 1 + np.abs(coords).max()
    found = RigidTransform.from_exp_coords(coords)
    np.testing.assert_allclose(found.as_matrix(), screw_matrix(coords), rtol=0, atol=8 * EPS * size)
    again = RigidTransform.from_exp_coords(found.as_exp_coords())
    # The translation of a screw near half a turn is known to the rounding of the angle.
    np.testing.assert_allclose(again.as_matrix(), found.as_matrix(), rtol=0, atol=32 * EPS * size)
    if np.linalg.norm(coords[:3]) < np.pi:
        np.testing.assert_allclose(found.as_exp_coords(), coords, rtol=0, atol=16 * EPS * size)


def test_powers_are_screws(transforms):
    coords = transforms.as_exp_coords()
    assert (np.linalg.norm(coords[:, :3], axis=-1) <= np.pi).all()
    for n in (0, 0.3, 1, 2.5, np.linspace(-1, 1, 6)):
        expected = [screw_matrix(x) for x in coords * np.reshape(n, (-1, 1))]
        np.testing.assert_allclose((transforms**n).as_matrix(), expected, rtol=0, atol=64 * EPS)


def test_interpolation_is_along_a_screw(transforms):
    start, end = transforms[0], transforms[1]
    np.testing.assert_allclose(
        start.interpolate(end, 0).as_matrix(), start.as_matrix(), rtol=0, atol=16 * EPS
    )
    np.testing.assert_allclose(start.interpolate(end, 1).as_matrix(), end.as_matrix(), rtol=0, atol=32 * EPS)
    path = start.interpolate(end, np.linspace(0, 1, 5))
    steps = (path[:-1].inv() * path[1:]).as_exp_coords()
    np.testing.assert_allclose(steps, np.broadcast_to(steps[0], steps.shape), rtol=0, atol=64 * EPS)


# --- other representations


def test_motors_move_planes_and_points(transforms):
    algebra = ph.algebra(3, 0, 1)
    null = algebra.basis_vectors[3]
    T = transforms[0]
    M = T.to_motor()
    point, normal = np.array([1.0, -2.0, 0.5]), np.array([2.0, 1.0, -1.0])
    plane = algebra.vector([*normal, -normal @ point])  # through the point
    moved = (M * plane * ~M).grade(1).components
    turned = T.rotor(ph.vector(normal)).components
    expected = [*turned, -turned @ T.apply(point)]
    np.testing.assert_allclose(moved, expected, rtol=0, atol=64 * EPS)
    assert RigidTransform.from_motor(2.0 * M).is_close(T, atol=16 * EPS)
    shift = RigidTransform(translation=[1, 2, 3]).to_motor()
    assert shift == 1 + 0.5 * (algebra.vector([1, 2, 3, 0]) ^ null)
    with pytest.raises(TypeError, match="even element of"):
        RigidTransform.from_motor(e1)
    with pytest.raises(ValueError, match="even element, got the grades"):
        RigidTransform.from_motor(null)
    with pytest.raises(ValueError, match="the rotation part of a motor must be finite and not 0"):
        RigidTransform.from_motor(shift - 1)


def test_matrices_are_checked(transforms):
    again = RigidTransform.from_matrix(transforms.as_matrix())
    np.testing.assert_allclose(again.as_matrix(), transforms.as_matrix(), rtol=0, atol=8 * EPS)
    with pytest.raises(ValueError, match=r"shape \(\.\.\., 4, 4\), got \(3, 3\)"):
        RigidTransform.from_matrix(np.eye(3))
    wrong = np.eye(4)
    wrong[3, 0] = 0.5
    with pytest.raises(ValueError, match=r"last row .* got \[0\.5, 0\.0, 0\.0, 1\.0\]"):
        RigidTransform.from_matrix(wrong)
    with pytest.raises(ValueError, match="reflection"):
        RigidTransform.from_matrix(np.diag([1.0, 1.0, -1.0, 1.0]))
    measured = np.diag([1.1, 1.0, 0.8, 1.0])
    measured[:3, 3] = [1, 2, 3]
    assert RigidTransform.from_matrix(measured, nearest=True) == RigidTransform(translation=[1, 2, 3])


def test_dual_quaternions(transforms):
    for scalar_first in (False, True):
        q = transforms.as_dual_quat(scalar_first=scalar_first)
        again = RigidTransform.from_dual_quat(2 * q, scalar_first=scalar_first)
        np.testing.assert_allclose(again.as_matrix(), transforms.as_matrix(), rtol=0, atol=16 * EPS)
    real, dual = q[:, :4], q[:, 4:]
    assert np.abs((real * dual).sum(axis=-1)).max() <= 4 * EPS
    q[2, :4] = 0
    with pytest.raises(
        ValueError, match=r"at index \(2,\): the real part of a dual quaternion must be finite"
    ):
        RigidTransform.from_dual_quat(q)
    for wrong in (np.ones(7), np.ones((8, 2)), 1.0):
        with pytest.raises(ValueError, match="a dual quaternion needs 8 components, got shape"):
            RigidTransform.from_dual_quat(wrong)


def test_means_over_axes():
    rng = np.random.default_rng(5)
    T, w = RigidTransform(ph.Rotor.random((3, 4), rng=4), rng.standard_normal((3, 4, 3))), rng.random((3, 4))
    for axis, of_one in ((1, lambda k: (T[k], w[k])), (-2, lambda k: (T[:, k], w[:, k]))):
        for weights in (None, w):
            means = T.mean(weights, axis=axis)
            for k, mean in enumerate(means):
                part, own = of_one(k)
                # Of up to four attitudes, whose eigenvalues differ by some tenths.
                expected = part.mean(None if weights is None else own)
                assert mean.is_close(expected, rtol=64 * EPS, atol=16 * EPS)
    assert T.mean(axis=(0, 1)).is_close(T.mean(), rtol=64 * EPS, atol=16 * EPS)
    assert T.mean(axis=()).is_close(T, rtol=64 * EPS, atol=EPS).all()
    assert T[0, 0].mean().is_close(T[0, 0], rtol=64 * EPS, atol=EPS)
    with pytest.raises(ValueError, match="numbers >= 0"):
        T.mean(-w)


def test_scipy_agrees(transforms):
    spatial = pytest.importorskip("scipy.spatial.transform")
    if not hasattr(spatial, "RigidTransform"):
        pytest.skip("SciPy before 1.16")
    peer = transforms.to_scipy()
    pairs = [
        (transforms.as_matrix(), peer.as_matrix()),
        (transforms.as_exp_coords(), peer.as_exp_coords()),
        ((transforms * transforms[::-1]).as_matrix(), (peer * peer[::-1]).as_matrix()),
        (transforms.inv().as_matrix(), peer.inv().as_matrix()),
        (transforms.mean().as_matrix(), peer.mean().as_matrix()),
        (transforms.mean(range(6)).as_matrix(), peer.mean(weights=np.arange(6.0)).as_matrix()),
        (RigidTransform.from_scipy(peer).as_matrix(), peer.as_matrix()),
        (RigidTransform.from_dual_quat(peer.as_dual_quat()).as_matrix(), peer.as_matrix()),
        (RigidTransform.from_exp_coords(peer.as_exp_coords()).as_matrix(), peer.as_matrix()),
    ]
    for found, expected in pairs:
        np.testing.assert_allclose(found, expected, rtol=0, atol=64 * EPS)
    with pytest.raises(TypeError, match="got ndarray"):
        RigidTransform.from_scipy(np.eye(4))
    rotation = peer.rotation
    made = RigidTransform.from_components(np.zeros(3), rotation)
    np.testing.assert_allclose(made.rotation.to_matrix(), rotation.as_matrix(), rtol=0, atol=8 * EPS)


# --- other coefficients, states


def test_symbols():
    sympy = pytest.importorskip("sympy")
    x, y, angle = sympy.symbols("x y theta", real=True)
    T = RigidTransform(ph.Rotor.from_plane_angle(e1 ^ e2, angle), ph.vector([x, y, 0]))
    expected = sympy.Matrix(
        [
            [sympy.cos(angle), -sympy.sin(angle), 0, x],
            [sympy.sin(angle), sympy.cos(angle), 0, y],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        ]
    )
    assert sympy.simplify(sympy.Matrix(T.as_matrix()) - expected) == sympy.zeros(4)
    assert sympy.simplify(sympy.Matrix((T * T.inv()).as_matrix())) == sympy.eye(4)


def test_turns_about_a_point_of_symbols():
    sympy = pytest.importorskip("sympy")
    p, angle = sympy.symbols("p theta", real=True)
    T = RigidTransform.from_screw(e3, [p, 0, 0], angle)
    x, y, _ = T.translation.components
    assert sympy.simplify(x - p * (1 - sympy.cos(angle))) == 0
    assert sympy.simplify(y + p * sympy.sin(angle)) == 0


def test_screws_of_symbols():
    sympy = pytest.importorskip("sympy")
    angle = sympy.Rational(1, 2)
    x = ph.vector([sympy.Integer(k) for k in (1, 2, 3)])
    T = RigidTransform(ph.Rotor.from_axis_angle([0, 0, 1], angle), x)
    floats = RigidTransform(ph.Rotor.from_axis_angle([0, 0, 1], 0.5), [1, 2, 3])
    found = np.array([float(x) for x in T.as_exp_coords()])
    np.testing.assert_allclose(found, floats.as_exp_coords(), rtol=0, atol=16 * EPS)
    matrix = (T**2).as_matrix().astype(float)
    np.testing.assert_allclose(matrix, (floats**2).as_matrix(), rtol=0, atol=64 * EPS)


@pytest.mark.parametrize("name", ["jax.numpy", "array_api_strict"])
def test_screws_of_other_arrays(name, transforms):
    xp = pytest.importorskip(name)
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True) if name == "jax.numpy" else contextlib.nullcontext():
        theirs = RigidTransform.from_matrix(xp.asarray(transforms.as_matrix()))
        coords = theirs.as_exp_coords()
        assert type(coords) is type(xp.asarray(0.0))
        # The inverse Jacobian and the logarithm of a motor differ by rounding, up to turns of 3 rad here.
        np.testing.assert_allclose(np.asarray(coords), transforms.as_exp_coords(), rtol=0, atol=64 * EPS)
        for ours, found in (
            (transforms**0.3, theirs**0.3),
            (transforms[0].interpolate(transforms, 0.5), theirs[0].interpolate(theirs, 0.5)),
        ):
            assert np.allclose(np.asarray(found.as_matrix()), ours.as_matrix(), rtol=0, atol=64 * EPS)
        moved = RigidTransform.from_translation(xp.asarray([1.0, 2.0, 3.0]))  # beside a rotor of NumPy
        np.testing.assert_array_equal(np.asarray(moved.as_exp_coords()), [0, 0, 0, 1, 2, 3])
        with pytest.raises(ValueError, match="last row"):
            RigidTransform.from_matrix(xp.ones((4, 4)))


def test_jax_differentiates_screws():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        coords = jax.numpy.array([0.1, 0.2, 0.3, 1.0, 2.0, 3.0])

        def moved(x):
            return RigidTransform.from_exp_coords(x).apply(jax.numpy.ones(3))

        found = np.asarray(jax.jacobian(moved)(coords))
        h = 1e-5
        for k in range(6):
            step = np.zeros(6)
            step[k] = h
            slope = (moved(coords + step) - moved(coords - step)) / (2 * h)
            # The third derivatives are some 10, so central differences are off by h²/6 of that.
            np.testing.assert_allclose(found[:, k], slope, rtol=0, atol=10 * h * h)


def test_states_are_displacements():
    R = ph.Rotor.random(rng=5)
    state = ph.State(R, [0, 0, 1], position=[1, 2, 3])
    assert state.transform == RigidTransform(R, [1, 2, 3])
