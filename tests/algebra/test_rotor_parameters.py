"""Axis and angle, modified Rodrigues parameters, Davenport angles and multivectors, with SciPy as peer."""

import jax
import numpy as np
import pytest
import sympy
from hypothesis import given
from scipy.spatial.transform import Rotation

import polhode as ph
from polhode import Rotor, e1, e2, e3
from samples import EPS, SHAPES, close, random_rotors, rotors, vectors

# --- axis and angle


def test_axis_and_angle():
    assert close(Rotor.from_axis_angle(e3, np.pi / 2)(e1), e2, 4)
    assert close(Rotor.from_axis_angle([0, 0, 7], 90, degrees=True)(e1), e2, 4)
    # A list of axes, a list of angles, both.
    turns = Rotor.from_axis_angle([[1, 0, 0], [0, 1, 0]], [[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]])
    assert turns.shape == (3, 2)
    assert close(turns[2, 1], Rotor.from_plane_angle(e3 ^ e1, 0.6), 2)
    # The rotor counts turns to 4π.
    assert close(Rotor.from_axis_angle(e3, 2 * np.pi), -Rotor.identity(), 4)
    with pytest.raises(ValueError, match=r"the axis at index \(1,\) is .* not zero"):
        Rotor.from_axis_angle([[1, 0, 0], [0, 0, 0]], 1.0)
    with pytest.raises(ValueError, match=r"3 components in the last axis, got shape \(2,\)"):
        Rotor.from_axis_angle([1, 0], 1.0)
    with pytest.raises(ValueError, match=r"the axis is \[nan, 0.0, 1.0\]; it must be finite"):
        Rotor.from_axis_angle([np.nan, 0, 1], 1.0)
    with pytest.raises(TypeError, match="the axis must be a vector"):
        Rotor.from_axis_angle(e1 ^ e2, 1.0)


@given(rotors)
def test_the_angle_is_that_of_the_rotation(R):
    # The chordal distance of a turn by θ from none is 2 sin(θ/4) in the nearer rotor.
    nearer = min(float((R - 1).norm()), float((R + 1).norm()))
    assert abs(R.angle - 4 * np.arcsin(nearer / 2)) <= 8 * EPS
    assert R.angle == (-R).angle == R.magnitude()
    assert 0 <= R.angle <= np.pi


@pytest.mark.parametrize("size", [1e-300, 1e-12, 1e-3, 1.0, np.pi - 1e-9])
def test_small_angles_are_accurate(size):
    v = size * np.array([2.0, -1.0, 2.0]) / 3
    for R in (Rotor.from_rotation_vector(v), -Rotor.from_rotation_vector(v)):
        assert abs(R.angle - size) <= 4 * EPS * size


@pytest.mark.parametrize("shape", SHAPES)
def test_angles_of_batches(shape):
    R = random_rotors(shape)
    assert np.shape(R.angle) == shape
    assert np.all(abs(R.angle - R.distance(Rotor.identity())) <= 8 * EPS)
    assert R.astype(np.float32).angle.dtype == np.float32


# --- modified Rodrigues parameters


def test_mrp_agree_with_scipy():
    R = random_rotors((50,))
    peer = R.to_scipy()
    np.testing.assert_allclose(R.to_mrp(), peer.as_mrp(), rtol=0, atol=4 * EPS)
    p = np.random.default_rng(2).standard_normal((50, 3)) * np.logspace(-3, 3, 50)[:, None]
    expected = Rotation.from_mrp(p).as_matrix()
    np.testing.assert_allclose(Rotor.from_mrp(p).to_matrix(), expected, rtol=0, atol=16 * EPS)
    assert Rotor.from_mrp(ph.vector(p)).shape == (50,)


@given(rotors)
def test_mrp_restore_the_rotor(R):
    p = R.to_mrp()
    assert np.linalg.norm(p) <= 1 + 4 * EPS
    assert abs(np.linalg.norm(p) - np.tan(R.angle / 4)) <= 8 * EPS
    assert close(Rotor.from_mrp(p), R.canonical(), 8)


def test_mrp_at_the_ends():
    assert Rotor.from_mrp([0, 0, 0]) == 1
    assert close(Rotor.from_mrp([0, 0, 1]), Rotor.from_axis_angle(e3, np.pi), 2)
    # tan(θ/4) grows without bound towards a full turn, which is the rotor −1.
    assert close(Rotor.from_mrp([0, 0, 1e200]), -Rotor.identity(), 2)
    with pytest.raises(ValueError, match="modified Rodrigues parameters needs 3 components"):
        Rotor.from_mrp([1.0, 2.0])


# --- Davenport angles

AXES = [
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[0, 0, 3], [0, 1, 0], [1, 0, 0]],
    [[0, 0, 1], [1, 0, 0], [0, 0, 1]],
    [[1, 0, 0], [0, 1, 0], [1, 0, 1]],
    [[1, 0, 0], [0, 2, 0], [1, 0, -3]],
    [[1, 0, 0], [0, 1, 0], [-1, 0, -1]],
]


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("order", ["e", "extrinsic", "i", "intrinsic"])
def test_davenport_angles_agree_with_scipy(axes, order):
    R = random_rotors((40,), 3)
    theirs = R.to_scipy().as_davenport(axes, order)
    ours = R.to_davenport(axes, order)
    # Outer angles are as sharp as the middle one is far from gimbal lock, in these samples 0.02 or more.
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1000 * EPS)
    again = Rotor.from_davenport(axes, order, ours)
    assert np.all(again.distance(R) <= 32 * EPS)
    expected = Rotation.from_davenport(axes, order, theirs).as_matrix()
    np.testing.assert_allclose(again.to_matrix(), expected, rtol=0, atol=1000 * EPS)
    degrees = R.to_davenport(axes, order, degrees=True)
    np.testing.assert_allclose(np.radians(degrees), ours, rtol=0, atol=8 * EPS)
    assert np.all(Rotor.from_davenport(axes, order, degrees, degrees=True).distance(R) <= 32 * EPS)


@pytest.mark.parametrize("order", ["e", "i"])
def test_davenport_angles_in_gimbal_lock(order):
    axes = [e1, e2, e1 + e3]
    lead = np.pi / 4
    for middle in (-lead, np.pi - lead):
        R = Rotor.from_davenport(axes, order, [0.4, middle if order == "e" else -middle, 0.3])
        found = R.to_davenport(axes, order)
        assert found[2] == 0
        assert Rotor.from_davenport(axes, order, found).distance(R) <= 32 * EPS


def test_euler_angles_are_davenport_angles():
    angles = [0.3, -0.2, 0.1]
    for seq, order in (("zxy", "e"), ("ZXY", "i")):
        R = Rotor.from_euler(seq, angles)
        assert close(Rotor.from_davenport([e3, e1, e2], order, angles), R, 8)
        np.testing.assert_allclose(R.to_davenport([e3, e1, e2], order), angles, rtol=0, atol=8 * EPS)
    assert Rotor.from_davenport([0, 0, 1], "e", 0.5) == Rotor.from_axis_angle(e3, 0.5)
    assert Rotor.from_davenport([e3, e1], "i", np.zeros((5, 2))).shape == (5,)


@pytest.mark.parametrize("order", ["e", "i"])
def test_davenport_axes_of_batches(order):
    frames = random_rotors((4, 1), 7)(ph.vector(np.eye(3)))  # the axes of four frames
    R = random_rotors((1, 5), 8)
    angles = R.to_davenport(frames.reshape(4, 1, 3), order)
    assert angles.shape == (4, 5, 3)
    for k in range(4):
        np.testing.assert_allclose(angles[k], R[0].to_davenport(frames[k], order), rtol=0, atol=8 * EPS)
    again = Rotor.from_davenport(frames.components[:, None], order, angles)
    # Three turns about axes that are perpendicular to rounding.
    assert np.all(again.distance(R) <= 32 * EPS)


def test_wrong_axes_raise():
    R = Rotor.identity()
    axes = np.tile(np.eye(3), (2, 1, 1))
    axes[1, 2] = [0, 1, 1]
    with pytest.raises(ValueError, match=r"axes 1 and 2 at index \(1,\) must be perpendicular"):
        R.to_davenport(axes, "e")
    axes[1, 0] = 0
    with pytest.raises(ValueError, match=r"axis 0 at index \(1,\) is \[0.0, 0.0, 0.0\]"):
        R.to_davenport(axes, "e")
    with pytest.raises(ValueError, match=r"axes 1 and 2 must be perpendicular; .* is 0\.7"):
        R.to_davenport([[1, 0, 0], [0, 1, 0], [0, 1, 1]], "e")
    with pytest.raises(ValueError, match=r"three axes, an array \(\.\.\., n, 3\), got shape \(2, 3\)"):
        R.to_davenport([e1, e2], "e")
    with pytest.raises(ValueError, match=r"axis 1 is .* not zero"):
        Rotor.from_davenport([[1, 0, 0], [0, 0, 0]], "e", [1, 2])
    with pytest.raises(ValueError, match="2 axes need 2 angles"):
        Rotor.from_davenport([e1, e2], "e", [1, 2, 3])
    with pytest.raises(ValueError, match=r"\"extrinsic\" .* got 'x'"):
        R.to_davenport(AXES[0], "x")


# --- multivectors


@given(rotors, vectors)
def test_a_small_step_is_normalised(R, v):
    step = R + 1e-3 * R * v.undual()
    made = Rotor.from_multivector(step)
    assert isinstance(made, Rotor)
    assert close(made, step.normalized(), 4)


def test_what_is_not_a_rotor_raises():
    R = Rotor.from_plane_angle(e1 ^ e2, 0.4)
    assert Rotor.from_multivector(R) is R
    assert close(Rotor.from_multivector(e1 * e2), Rotor.from_components([0, 0, 0, 1]), 1)
    assert close(
        Rotor.from_multivector(ph.multivector([1, 0, 0, 0, 0, 0, 0.01, 0])), 1 + 0.01 * (e1 ^ e2), 1, 1e13
    )
    with pytest.raises(ValueError, match=r"the norm of a rotor is 1, got 2; use M.normalized\(\)"):
        Rotor.from_multivector(2.0 * R)
    assert close(Rotor.from_multivector((2.0 * R).normalized()), R, 4)
    assert close(Rotor.from_multivector(2.0 * R, tolerance=np.inf), R, 4)
    with pytest.raises(ValueError, match=r"at index \(1,\): the norm of a rotor is 1, got 0.5"):
        Rotor.from_multivector(ph.stack([1.0 * R + 0, 0.5 * R]))
    with pytest.raises(ValueError, match=r"a rotor is even, .* got grades \(0, 1, 2\); remove \[1\]"):
        Rotor.from_multivector(R + e1)
    with pytest.raises(TypeError, match="got one of"):
        Rotor.from_multivector(ph.algebra(3, 0, 1).scalar(1.0))
    with pytest.raises(TypeError, match="needs a multivector, got ndarray"):
        Rotor.from_multivector(R.components)
    with pytest.raises(ValueError, match="the norm of a rotor is 1, got nan"):
        Rotor.from_multivector(ph.scalar(np.nan))


# --- other coefficients


def test_symbols():
    sympy = pytest.importorskip("sympy")
    angle = sympy.symbols("theta", positive=True)
    R = Rotor.from_axis_angle(e3, angle)
    assert Rotor.from_plane_angle(e1 ^ e2, angle) == R
    assert sympy.simplify(R.to_mrp()[2] - sympy.sin(angle / 2) / (1 + sympy.cos(angle / 2))) == 0
    values = {angle: 0.7}
    assert abs(float(R.angle.subs(values)) - 0.7) <= 4 * EPS
    p = sympy.Symbol("p", real=True)
    cosine = Rotor.from_mrp([0, 0, p]).components[0]
    assert sympy.simplify(cosine - (1 - p**2) / (1 + p**2)) == 0
    found = Rotor.from_davenport([e3, e1], "e", [angle, 2 * angle])
    assert found == Rotor.from_euler("zx", [angle, 2 * angle])
    assert Rotor.from_multivector(1 + 0 * angle * e1 * e2) == 1
    with pytest.raises(ValueError, match="got 2"):
        Rotor.from_multivector(ph.scalar(sympy.Integer(2)))


def test_jax():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        jnp = jax.numpy
        rows = random_rotors((5,), 4).components
        ours, theirs = Rotor.from_components(rows), Rotor.from_components(jnp.asarray(rows))
        axes = [e1, e2, e1 + e3]
        pairs = [
            (ours.to_mrp(), theirs.to_mrp()),
            (ours.angle, theirs.angle),
            (ours.to_davenport(axes, "i"), theirs.to_davenport(axes, "i")),
            (ours.to_davenport(np.eye(3)[None], "e"), theirs.to_davenport(np.eye(3)[None], "e")),
            (ours.components, Rotor.from_mrp(theirs.to_mrp()).components),
        ]
        pairs[-1] = (ours.canonical().components, pairs[-1][1])
        for expected, found in pairs:
            np.testing.assert_allclose(found, expected, rtol=0, atol=64 * EPS)
        # dp/dφ of small turns is a quarter.
        slope = jax.jacobian(lambda v: Rotor.from_rotation_vector(v).to_mrp())(jnp.zeros(3))
        np.testing.assert_allclose(slope, np.eye(3) / 4, rtol=0, atol=EPS)
        turn = jax.grad(lambda t: Rotor.from_axis_angle(e3, t).angle)(jnp.asarray(0.3))
        assert abs(turn - 1) <= 8 * EPS
        with pytest.raises(ValueError, match="the norm of a rotor is 1"):
            Rotor.from_multivector(2.0 * theirs)
        made = Rotor.from_multivector(1.01 * theirs).components
        np.testing.assert_allclose(made, rows, rtol=0, atol=4 * EPS)


# --- degrees

A_ROTOR, BASIS = ph.Rotor.from_rotation_vector([0.1, 0.2, 0.3]), np.eye(3)
IN_DEGREES = [
    lambda x: ph.Rotor.from_euler("ZYX", BASIS[0], x),
    lambda x: A_ROTOR.to_euler("ZYX", x),
    lambda x: ph.Rotor.from_axis_angle(BASIS[0], 1, x),
    lambda x: ph.Rotor.from_plane_angle(BASIS[0], 1, x),
    lambda x: A_ROTOR.plane_angle(x)[1],
    lambda x: ph.Rotor.from_rotation_vector(BASIS[0], x),
    lambda x: A_ROTOR.to_rotation_vector(x),
    lambda x: ph.Rotor.from_davenport(BASIS, "i", BASIS[0], x),
    lambda x: A_ROTOR.to_davenport(BASIS, "i", x),
]


@pytest.mark.parametrize("call", IN_DEGREES)
def test_degrees_is_true_or_false(call):
    for yes, no in ((True, False), (np.True_, np.False_), (1, 0)):
        assert np.all(call(yes) == call(True))
        assert np.all(call(no) == call(False))
    assert not np.all(call(True) == call(False))
    for wrong in ("rad", "deg", None, 2, 1.0, [True]):
        with pytest.raises(TypeError, match=r"^degrees must be True or False, got "):
            call(wrong)


def test_rotation_vectors_and_planes_in_degrees():
    v = np.random.default_rng(1).uniform(-90, 90, (5, 3))
    theirs = Rotation.from_rotvec(v, degrees=True)
    R = ph.Rotor.from_rotation_vector(v, degrees=True)
    assert close(R, ph.Rotor.from_scipy(theirs), 8)
    assert np.allclose(R.to_rotation_vector(degrees=True), theirs.as_rotvec(degrees=True), rtol=16 * EPS)
    B, theta = R.plane_angle(degrees=True)
    assert close(ph.Rotor.from_plane_angle(B, theta, degrees=True), R, 8)
    assert close(ph.Rotor.from_plane_angle(B, theta, True, errors="mask"), R, 8)
    masked = ph.Rotor.from_rotation_vector([[0, 0, 60], [np.nan, 0, 0]], True, errors="mask")
    assert np.degrees(masked[0].angle) == pytest.approx(60)
    exact = ph.Rotor.from_plane_angle(e1 ^ e2, sympy.Integer(60), degrees=True)
    assert exact.plane_angle(degrees=True)[1] == 60
    traced = jax.jit(lambda x: ph.Rotor.from_rotation_vector(x, True).to_rotation_vector(True))(v[0])
    assert np.allclose(traced, v[0], rtol=1e-5)
