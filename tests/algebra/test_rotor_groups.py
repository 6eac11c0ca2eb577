"""Signs of rotors, groups of rotations and reduction by them, with SciPy as peer."""

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import Rotation

import polhode as ph
from polhode import Rotor, e1, e2, e3
from samples import EPS, SHAPES, close, random_rotors, rotors

NAMES = {"I": 60, "O": 24, "T": 12, "C1": 1, "C5": 5, "D1": 2, "D2": 4, "D6": 12}


# --- signs


@given(rotors)
def test_canonical_rotors_are_those_of_scipy(R):
    found = R.canonical()
    assert found in (R, -R)
    assert found.components[0] >= 0
    assert found == (-R).canonical() == found.canonical()
    np.testing.assert_array_equal(found.to_quaternion(order="xyzw"), R.to_scipy().as_quat(canonical=True))


def test_half_turns_have_one_canonical_rotor():
    planes = np.array([[1, 2, 2], [0, -3, 4], [0, 0, -1]]) / np.array([[3], [5], [1]])
    halves = Rotor.from_components(np.insert(planes, 0, 0.0, axis=-1))
    found = halves.canonical()
    assert np.all(found == (-halves).canonical())
    assert np.all(found.to_quaternion(order="wxyz") == halves.to_scipy().as_quat(True, scalar_first=True))
    assert Rotor.from_axis_angle([0, 0, 1], np.pi).canonical().is_close(-(e1 * e2), atol=EPS)


@pytest.mark.parametrize("shape", [shape for shape in SHAPES if shape])
def test_continuous_rotors_are_near_their_neighbours(shape):
    R = random_rotors(shape)
    for axis in range(-len(shape), len(shape)):
        found = R.continuous(axis=axis)
        assert found.shape == shape
        assert np.all((found == R) | (found == -R))
        rows = np.moveaxis(found.components, axis if axis >= 0 else axis - 1, 0)
        assert np.all((rows[1:] * rows[:-1]).sum(axis=-1) >= 0)
        assert np.all(rows[0] == np.moveaxis(R.components, axis if axis >= 0 else axis - 1, 0)[0])


def test_motions_keep_their_signs():
    top = ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 3), Rotor.identity(), [0.1, 2, 0.1])
    motion = top.at(np.linspace(0, 30, 400)).rotor
    mixed = Rotor.from_components(motion.components * np.random.default_rng(1).choice([1, -1], (400, 1)))
    found = mixed.continuous()
    assert np.all(found == (motion if mixed[0] == motion[0] else -motion))
    # The canonical signs of the same motion jump.
    assert (motion.canonical() != motion).any()


def test_signs_need_an_axis_in_range():
    with pytest.raises(ValueError, match="axis 0 is out of range for a single rotor"):
        Rotor.identity().continuous()
    with pytest.raises(ValueError, match=r"axis 1 is out of range for rotors of batch shape \(3,\)"):
        Rotor.identity(3).continuous(axis=1)
    assert Rotor.identity(0).continuous().shape == (0,)


def test_signs_of_other_coefficients():
    sympy, jax = pytest.importorskip("sympy"), pytest.importorskip("jax")
    R = random_rotors((6, 2), 5)
    with jax.enable_x64(True):
        theirs = Rotor.from_components(jax.numpy.asarray(R.components))
        for found, expected in (
            (theirs.canonical(), R.canonical()),
            (theirs.continuous(axis=0), R.continuous(axis=0)),
        ):
            np.testing.assert_allclose(found.components, expected.components, rtol=0, atol=EPS)
    exact = Rotor.from_components(
        np.array([[sympy.Rational(-3, 5), 0, 0, sympy.Rational(4, 5)], [1, 0, 0, 0]])
    )
    assert (exact.canonical().components[0] == [sympy.Rational(3, 5), 0, 0, -sympy.Rational(4, 5)]).all()
    half_turn = Rotor.from_components(np.array([0, 0, sympy.Rational(3, 5), sympy.Rational(-4, 5)]))
    assert half_turn.canonical() == -half_turn
    assert (exact.continuous() == ph.stack([exact[0], -exact[1]])).all()
    t = sympy.Symbol("t", real=True)
    unknown = Rotor.from_axis_angle(e3, t)
    assert unknown.canonical() == unknown


def test_signs_of_exact_half_turns():
    sympy = pytest.importorskip("sympy")
    t = sympy.Symbol("t", positive=True)
    given = Rotor.from_components(np.array([0, 0, sympy.Rational(3, 5), sympy.Rational(-4, 5)]))
    wanted = Rotor.from_components([0, 0, 0.6, -0.8]).canonical()
    assert given.canonical().astype(float) == wanted
    assert (-given).canonical().astype(float) == wanted
    unit = sympy.sqrt(1 + t**2)
    symbolic = Rotor.from_components(np.array([0, 1 / unit, t / unit, 0]))
    assert symbolic.canonical() == -symbolic
    assert (-symbolic).canonical() == -symbolic


# --- groups


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("axis", ["x", "Y", "z"])
def test_groups_are_those_of_scipy(name, axis):
    ours = Rotor.group(name, axis=axis)
    theirs = Rotor.from_scipy(Rotation.create_group(name, axis=axis))
    assert ours.shape == (NAMES[name],)
    assert ours[0] == 1
    assert np.all(ours.components[:, 0] >= 0)
    distances = ours[:, None].distance(theirs)
    # A product of two rounded rotors, on either side.
    assert distances.min(axis=0).max() <= 16 * EPS
    assert distances.min(axis=1).max() <= 16 * EPS


@pytest.mark.parametrize("name", NAMES)
def test_groups_are_closed(name):
    G = Rotor.group(name)
    products = (G[:, None] * G).reshape(-1)
    assert products[:, None].distance(G).min(axis=1).max() <= 32 * EPS
    apart = G[:, None].distance(G) + 4 * np.eye(len(G))
    assert apart.min() > 0.5


def test_a_cube_is_the_same_after_a_turn():
    corners = ph.vector([[x, y, z] for x in (1, -1) for y in (1, -1) for z in (1, -1)])
    for R in Rotor.group("O"):
        moved = np.round(R(corners).components).astype(int)
        assert len({tuple(row) for row in moved.tolist()}) == 8
        np.testing.assert_allclose(R(corners).components, moved, rtol=0, atol=8 * EPS)


@pytest.mark.parametrize("name", ["O", "D6", "I"])
def test_reduced_angles_are_those_of_scipy(name):
    R, G = random_rotors((40,), 6), Rotor.group(name)
    H = Rotor.group("T")
    peer, theirs, others = R.to_scipy(), G.to_scipy(), H.to_scipy()
    for left, right, *peers in (
        (G, G, theirs, theirs),
        (G, None, theirs, None),
        (None, H, None, others),
        (H, G, others, theirs),
    ):
        found = R.reduce(left, right)
        assert np.all(abs(found.angle - peer.reduce(*peers).magnitude()) <= 16 * EPS)
        assert np.all(found.components[:, 0] >= 0)
        again, i, j = R.reduce(left, right, return_indices=True)
        made = R
        made = made if left is None else left[i] * made
        made = made if right is None else made * right[j]
        assert np.all(made.distance(again) <= 16 * EPS)
        assert (i is None) == (left is None)
        assert (j is None) == (right is None)


def test_disorientations_of_cubes_are_bounded():
    """The angle between two cubes is at most 62.8° (Mackenzie, Biometrika 45 (1958))."""
    G = Rotor.group("O")
    angles = Rotor.random(20_000, rng=7).reduce(G, G).angle
    largest = np.arccos((2 * np.sqrt(2) - 1) / 4)
    assert angles.max() <= largest + 16 * EPS
    assert np.degrees(angles.max()) > 60
    assert close(G[5].reduce(G), Rotor.identity(), 8)
    assert Rotor.random((2, 3), rng=1).reduce(G).shape == (2, 3)


def test_wrong_groups_raise():
    for bad in ("O4", "C0", "C", "x", 3):
        with pytest.raises(ValueError, match='a group is "I", "O", "T"'):
            Rotor.group(bad)
    with pytest.raises(ValueError, match='axis must be "x", "y" or "z", got \'w\''):
        Rotor.group("C2", axis="w")
    for axis in ("xy", "", 1):
        with pytest.raises(ValueError, match=f'axis must be "x", "y" or "z", got {axis!r}'):
            Rotor.group("C2", axis=axis)
    with pytest.raises(ValueError, match=r"left must be rotors .* got Multivector"):
        Rotor.identity().reduce(e1)
    with pytest.raises(ValueError, match=r"right must be rotors .* batch shape \(0,\)"):
        Rotor.identity().reduce(right=Rotor.identity(0))
