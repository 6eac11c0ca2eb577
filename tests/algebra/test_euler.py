"""Euler angles in SciPy's notation, gimbal lock included; quaternions of numpy-quaternion."""

import itertools
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import polhode as ph
from polhode import e1, e2, e3
from samples import EPS, SHAPES, angles, close, random_rotors, rotors

FIXED = ["".join(s) for s in itertools.product("xyz", repeat=3) if s[0] != s[1] != s[2]]
SEQUENCES = FIXED + [s.upper() for s in FIXED]
sequences = st.sampled_from(SEQUENCES)
SHORT = ["x", "Y", "z", "xy", "ZX", "yz"]


def some_angles(seq, shape=(), seed=1):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (*shape, len(seq)))


@pytest.mark.parametrize("seq", SEQUENCES + SHORT)
def test_from_euler_agrees_with_scipy(seq):
    theta = some_angles(seq, (50,))
    scipys = Rotation.from_euler(seq, theta)
    # Three products of rotors and four roundings of each turn, on either side.
    assert np.all(abs(ph.Rotor.from_euler(seq, theta).to_matrix() - scipys.as_matrix()) <= 32 * EPS)
    degrees = ph.Rotor.from_euler(seq, np.rad2deg(theta), degrees=True)
    assert np.all(abs(degrees.to_matrix() - scipys.as_matrix()) <= 48 * EPS)


@pytest.mark.parametrize("seq", SEQUENCES)
def test_to_euler_agrees_with_scipy(seq):
    scipys = Rotation.random(50, rng=2)
    ours, theirs = ph.Rotor.from_scipy(scipys).to_euler(seq), scipys.as_euler(seq)
    # The outer angles are directions in planes whose radius is the cosine or sine of half the middle one.
    middle = theirs[:, 1] + (np.pi / 2 if len(set(seq)) == 3 else 0)
    radius = np.minimum(np.sin(middle / 2), np.cos(middle / 2))
    assert np.all(abs(ours - theirs) <= 16 * EPS * (np.pi + 1 / radius[:, np.newaxis]))
    in_degrees = ph.Rotor.from_scipy(scipys).to_euler(seq, degrees=True)
    assert np.all(abs(in_degrees - np.rad2deg(ours)) <= 4 * EPS * 180)


@given(rotors, sequences)
def test_angles_restore_the_attitude(R, seq):
    theta = R.to_euler(seq)
    assert R.distance(ph.Rotor.from_euler(seq, theta)) <= 32 * EPS
    assert np.all(abs(theta) <= np.pi)
    if len(set(seq)) == 3:
        assert abs(theta[1]) <= np.pi / 2 + 2 * EPS
    else:
        assert theta[1] >= 0


@given(st.tuples(angles, angles, angles), sequences)
def test_angles_near_gimbal_lock_restore_the_attitude(theta, seq):
    # `angles` crowd around 0, π and 2π; a quarter turn more gives gimbal lock for the other sequences.
    for quarter in (0, np.pi / 2):
        R = ph.Rotor.from_euler(seq, np.add(theta, [0, quarter, 0]))
        assert R.distance(ph.Rotor.from_euler(seq, R.to_euler(seq))) <= 48 * EPS


@pytest.mark.parametrize("seq", SEQUENCES)
@pytest.mark.parametrize("end", [0, 1])
def test_in_gimbal_lock_the_third_angle_is_zero(seq, end):
    theta = some_angles(seq, (20,), 3)
    theta[:, 1] = [-np.pi / 2, np.pi / 2][end] if len(set(seq)) == 3 else [0, np.pi][end]
    R = ph.Rotor.from_euler(seq, theta)
    found = R.to_euler(seq)
    assert np.all(found[:, 2] == 0)
    assert np.all(R.distance(ph.Rotor.from_euler(seq, found)) <= 32 * EPS)
    with pytest.warns(UserWarning, match="Gimbal lock"):
        theirs = R.to_scipy().as_euler(seq)
    assert np.all(theirs[:, 2] == 0)
    # The same first angle, which may be −π on one side and π on the other.
    assert np.all(abs(np.remainder(found[:, 0] - theirs[:, 0] + 1, 2 * np.pi) - 1) <= 32 * EPS)


def test_sense_and_order_of_turns():
    quarter = np.pi / 2
    assert close(ph.Rotor.from_euler("z", quarter)(e1), e2, 4)
    # About e1, then about e2: e2 -> e3 -> e1. About axes of the body, the opposite order.
    assert close(ph.Rotor.from_euler("xy", [quarter, quarter])(e2), e1, 8)
    assert close(ph.Rotor.from_euler("XY", [quarter, quarter])(e2), e3, 8)
    theta = some_angles("xyz", (5,), 4)
    assert np.all(ph.Rotor.from_euler("XYZ", theta) == ph.Rotor.from_euler("zyx", theta[:, ::-1]))
    # The rotor is continuous in the angles: a whole turn is −1.
    assert close(ph.Rotor.from_euler("z", 2 * np.pi), -1, 8)


@pytest.mark.parametrize("shape", SHAPES)
def test_batches(shape):
    R = random_rotors(shape)
    theta = R.to_euler("zxz")
    assert theta.shape == (*shape, 3)
    assert ph.Rotor.from_euler("zxz", theta).shape == shape
    assert np.all(R.distance(ph.Rotor.from_euler("zxz", theta)) <= 32 * EPS)
    assert ph.Rotor.from_euler("x", np.zeros((*shape, 1))).shape == shape
    assert ph.Rotor.from_euler("x", 0.5).shape == ()


@pytest.mark.parametrize(
    "seq", ["", "xyzx", "abc", "xYz", "xx", "xzz", "XYZ ", None, 3, ["x", "y", "z"], "1"]
)
def test_invalid_sequences_raise(seq):
    with pytest.raises(ValueError, match="one to three of x, y, z") as caught:
        ph.Rotor.from_euler(seq, [0, 0, 0])
    assert repr(seq) in str(caught.value)
    with pytest.raises(ValueError, match="is three of x, y, z") as caught:
        ph.Rotor.identity().to_euler(seq)
    assert repr(seq) in str(caught.value)


def test_bad_angles_are_errors():
    with pytest.raises(ValueError, match="is three of"):
        ph.Rotor.identity().to_euler("xy")
    with pytest.raises(ValueError, match=r"'xyz' needs 3 angles in the last axis, got shape \(2,\)"):
        ph.Rotor.from_euler("xyz", [1, 2])
    with pytest.raises(ValueError, match=r"'z' needs 1 angle .*; write x\[..., None\] for an array x"):
        ph.Rotor.from_euler("z", [1, 2])
    with pytest.raises(ValueError, match=r"got shape \(3, 5\); write x.T for columns x"):
        ph.Rotor.from_euler("xyz", np.ones((3, 5)))
    with pytest.raises(TypeError, match="angles must be real numbers"):
        ph.Rotor.from_euler("z", "90")
    with pytest.raises(ValueError, match=r"index \(1,\)"):
        ph.Rotor.from_euler("z", [[1], [np.nan]])


# --- numpy-quaternion


def test_quaternions_of_the_package_numpy_quaternion():
    quaternion = pytest.importorskip("quaternion")
    R = random_rotors((3, 2), 5)
    q = R.to_numpy_quaternion()
    assert q.shape == (3, 2)
    assert q.dtype == np.dtype(quaternion.quaternion)
    assert close(ph.Rotor.from_numpy_quaternion(q), R, 4)
    assert close(ph.Rotor.from_numpy_quaternion(3 * q), R, 8)
    # The same sense of rotation.
    turned = quaternion.rotate_vectors(q[2, 1], [1.0, 2.0, 3.0])
    assert np.all(abs(R[2, 1](e1 + 2 * e2 + 3 * e3).components - turned) <= 32 * EPS * 4)
    one = ph.Rotor.from_numpy_quaternion(quaternion.quaternion(1, 0, 0, 1))
    assert close(one(e1), e2, 8)
    assert close(ph.Rotor.from_numpy_quaternion(q[0] * q[1]), R[0] * R[1], 16)
    with pytest.raises(TypeError, match="dtype quaternion, got float64"):
        ph.Rotor.from_numpy_quaternion(np.ones(4))
    with pytest.raises(ValueError, match=r"index \(1,\)"):
        ph.Rotor.from_numpy_quaternion(np.array([quaternion.one, quaternion.zero]))


def test_its_euler_angles_are_about_z_y_z_of_the_moving_axes():
    quaternion = pytest.importorskip("quaternion")
    angles = some_angles("ZYZ", (50,))
    R = ph.Rotor.from_euler("ZYZ", angles)
    assert close(ph.Rotor.from_numpy_quaternion(quaternion.from_euler_angles(angles)), R, 8)
    found = R.to_euler("ZYZ") - quaternion.as_euler_angles(R.to_numpy_quaternion())
    # Theirs of the outer angles may differ by whole turns; near gimbal lock half of the digits are lost.
    assert np.abs(np.sin(found / 2)).max() < 1e-7
    with pytest.raises(AttributeError, match=r'write to_euler\("ZYZ"\)'):
        R.as_euler_angles()


def test_a_missing_numpy_quaternion_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "quaternion", None)
    for use in (ph.Rotor.identity().to_numpy_quaternion, lambda: ph.Rotor.from_numpy_quaternion([1])):
        with pytest.raises(ImportError, match=r"needs quaternion: pip install 'polhode\[quaternion\]'"):
            use()


@pytest.mark.parametrize("name", ["jax.numpy", "array_api_strict"])
@pytest.mark.parametrize("seq", SEQUENCES)
def test_angles_keep_the_array_type(name, seq):
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        module = pytest.importorskip(name)
        theta = some_angles(seq, (20,), 4)
        R = ph.Rotor.from_euler(seq, module.asarray(theta))
        found, expected = R.to_euler(seq), ph.Rotor.from_euler(seq, theta)
        assert type(R.components) is type(found) is type(module.asarray(theta))
        assert np.all(abs(np.asarray(R.components) - expected.components) <= 8 * EPS)
        again = ph.Rotor.from_euler(seq, np.asarray(found))
        assert np.all(again.distance(expected) <= 32 * EPS)
        degrees = R.to_euler(seq, degrees=True)
        assert np.all(abs(np.asarray(degrees) - np.rad2deg(np.asarray(found))) <= 4 * EPS * 180)


@pytest.mark.parametrize("seq", ["zxz", "XYZ", "zyx"])
def test_jax_differentiates_angles(seq):
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        theta = jax.numpy.asarray([0.3, 0.4, -0.5])

        def there_and_back(theta):
            return ph.Rotor.from_euler(seq, theta).to_euler(seq)

        assert np.all(abs(jax.jit(there_and_back)(theta) - theta) <= 16 * EPS)
        # The derivative of the identity; the middle angle is far from both locks.
        assert np.all(abs(jax.jacobian(there_and_back)(theta) - np.eye(3)) <= 64 * EPS)
        lock = jax.numpy.asarray([0.3, np.pi / 2 if len(set(seq)) == 3 else 0.0, -0.5])
        assert np.all(np.isfinite(jax.jacobian(there_and_back)(lock)))


def test_symbols_are_angles():
    sympy = pytest.importorskip("sympy")
    a, b, c = sympy.symbols("a b c", real=True)
    R = ph.Rotor.from_euler("zxz", [a, b, c])
    values = {a: 0.3, b: 0.7, c: -1.1}
    numbers = np.array([float(x.subs(values)) for x in R.components])
    assert np.all(abs(numbers - ph.Rotor.from_euler("zxz", [0.3, 0.7, -1.1]).components) <= 4 * EPS)
    angles = [float(x.subs(values)) for x in R.to_euler("zxz")]
    assert np.all(abs(np.array(angles) - [0.3, 0.7, -1.1]) <= 16 * EPS)
    quarter = ph.Rotor.from_euler("x", sympy.Integer(90), degrees=True)
    assert list(quarter.components) == [sympy.sqrt(2) / 2, -sympy.sqrt(2) / 2, 0, 0]
    assert quarter.to_euler("xyz")[0] == sympy.pi / 2


def test_multiprecision_angles_keep_their_digits():
    mpmath = pytest.importorskip("mpmath")
    with mpmath.workdps(40):
        theta = [mpmath.mpf(1) / 3, mpmath.mpf(2) / 7, -mpmath.mpf(1) / 9]
        for seq in ("xyz", "ZXZ"):
            found = ph.Rotor.from_euler(seq, theta).to_euler(seq)
            assert max(abs(x - y) for x, y in zip(found, theta, strict=True)) < 1e-38
        degrees = ph.Rotor.from_euler("xyz", theta).to_euler("xyz", degrees=True)
        assert abs(degrees[0] - 60 / mpmath.pi) < 1e-36


def test_single_precision_angles_stay_single():
    theta = some_angles("xyz", (50,), 5).astype(np.float32)
    R = ph.Rotor.from_euler("xyz", theta)
    assert R.dtype == R.to_euler("xyz").dtype == np.float32
    again = ph.Rotor.from_euler("xyz", R.to_euler("xyz"))
    assert np.all(again.distance(R) <= 32 * np.finfo(np.float32).eps)
