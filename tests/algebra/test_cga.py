"""`ph.cga`: points, flats and rounds of conformal space, their versors, and back."""

import copy
import json
import pickle
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph

EPS = 2.0**-52
C = ph.cga(3)
SPACES = pytest.mark.parametrize("n", [1, 2, 3, 4])


def on(X, points):
    """How far points are from an object: the largest component of the wedge."""
    return np.abs((C.up(points) ^ X).components).max()


def points_of(center, radius, blade, count=5, seed=0):
    """Points at a distance from the center, in the span of some unit vectors."""
    way = np.random.default_rng(seed).normal(size=(count, len(blade))) @ blade
    return center + radius * way / np.linalg.norm(way, axis=-1, keepdims=True)


# --- the algebra


@SPACES
def test_null_vectors(n):
    space = ph.cga(n)
    eo, einf = space.eo, space.einf
    plus, minus = space.basis_vectors[-2:]
    assert eo == (minus - plus) / 2
    assert einf == minus + plus
    assert eo * eo == 0
    assert einf * einf == 0
    assert (eo | einf) == -1
    assert space.signature == (n + 1, 1, 0)
    assert repr(space) == f"cga({n})"
    assert space.blades["eo"] == eo
    assert space.blades["einf"] == einf
    assert len(space.blades) == space.size


def test_values_keep_their_algebra():
    X = C.up(np.eye(3))
    for again in (
        pickle.loads(pickle.dumps(X)),
        copy.deepcopy(X),
        ph.from_dict(json.loads(json.dumps(ph.to_dict(X)))),
    ):
        assert again.algebra is C
        assert np.all(again == X)
    assert pickle.loads(pickle.dumps(C)) is C is ph.cga()
    with pytest.raises(TypeError, match=r"different algebras, cga\(3\) and Cl\(4,1\)"):
        C.eo + ph.algebra(4, 1).basis_vectors[0]


def test_formulas_know_the_null_vectors():
    X = C.up([1.0, 2.0, 3.0])
    f = ph.formula("-X/(X·einf)")
    assert f(X=2 * X) == X
    assert ph.formula("eo + e1 + ½ einf", algebra=C)() == C.up([1.0, 0, 0])
    assert ph.formula("X∧einf").grades(X=X) == (2,)
    exact = C.vector([Fraction(1, 3), 0, 0, 0, 1])
    assert ph.formula("eo X + X eo")(X=exact) == Fraction(-1)
    assert ph.formula("eo X")(X=X, eo=C.einf) == C.einf * X  # a given value comes first
    with pytest.raises(ph.FormulaError, match="einf"):
        ph.formula("einf + a")(a=ph.e1)


# --- points


@SPACES
def test_points_come_back(n):
    space, x = ph.cga(n), np.random.default_rng(n).normal(size=(4, 5, n))
    X = space.up(x)
    assert np.abs((X * X).components).max() < 100 * EPS
    assert np.allclose(space.down(-2 * X).components, x, rtol=0, atol=20 * EPS)
    assert np.all(space.point(ph.algebra(n).vector(x)) == X)
    y = x[::-1]
    want = -0.5 * ((x - y) ** 2).sum(axis=-1)
    assert np.allclose((X | space.up(y)).components[..., 0], want, atol=200 * EPS)


@pytest.mark.slow  # clifford compiles its products
def test_points_are_those_of_clifford():
    clifford = pytest.importorskip("clifford")
    _, blades, names = clifford.conformalize(clifford.Cl(3)[0])
    theirs = names["up"](1 * blades["e1"] + 2 * blades["e2"] - 3 * blades["e3"])
    assert np.array_equal(theirs.value[1:6], C.up([1.0, 2.0, -3.0]).components)
    for name in ("eo", "einf"):
        assert np.array_equal(names[name].value[1:6], getattr(C, name).components)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3, 1e6])
def test_coordinates_lose_the_square_of_the_distance(size):
    x = size * np.random.default_rng(9).normal(size=(100, 3))
    back = C.down(C.up(x)).components
    s2 = (x * x).sum(-1, keepdims=True)
    # ½ s² ± ½ are rounded by half an ε each, and their difference is 1.
    assert np.all(np.abs(back - x) <= (EPS * (2 + s2)) * np.abs(x))


def test_what_is_not_a_point():
    with pytest.raises(ValueError, match="at infinity"):
        C.down(C.einf)
    with pytest.raises(ValueError, match=r"index \(1,\).*X² = 0"):
        C.down(ph.stack([C.eo, C.eo + C.basis_vectors[0]]))
    with pytest.raises(TypeError, match="of grade 1"):
        C.down(C.sphere([0.0, 0, 0], 1))
    with pytest.raises(TypeError, match=r"a value of cga\(3\)"):
        C.down(ph.e1)
    with pytest.raises(TypeError, match=r"a vector of Cl\(3\)"):
        C.up(C.einf)


# --- rounds


def test_spheres_and_circles_contain_their_points():
    rng = np.random.default_rng(1)
    center, radius = rng.normal(size=(6, 3)), rng.uniform(0.5, 2, 6)
    normal = rng.normal(size=(6, 3))
    spheres, circles = C.sphere(center, radius), C.circle(center, normal, radius)
    assert spheres.grades == (4,)
    assert circles.grades == (3,)
    for i in range(6):
        basis = np.linalg.svd(normal[i][None])[2]
        assert on(spheres[i], points_of(center[i], radius[i], np.eye(3))) < 1e-13  # sizes to 30
        assert on(circles[i], points_of(center[i], radius[i], basis[1:])) < 1e-13
        assert on(circles[i], points_of(center[i], radius[i], basis[:1])) > 0.1
    for rounds in (spheres, -3 * circles):
        assert np.allclose(C.center(rounds).components, center, atol=1e-13)
        assert np.allclose(C.radius(rounds), radius, rtol=1e-13)
    unit, distance = C.normal_and_distance(circles ^ C.einf)
    unit_normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    assert np.allclose(unit.components, unit_normal, atol=1e-13)
    assert np.allclose(distance, (center * unit_normal).sum(-1), atol=1e-13)


def test_rounds_of_points_have_the_same_sense():
    a, b, c, d = C.up(np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 1]]))
    circle, sphere = a ^ b ^ c, a ^ b ^ c ^ d
    assert circle.is_close(2 * C.circle([0.0, 0, 0], [0, 0, 1], 1), atol=4 * EPS)
    assert sphere.is_close(2 * C.sphere([0.0, 0, 0], 1), atol=4 * EPS)
    pair = a ^ c
    assert np.allclose([x.components for x in C.points(pair)], [[1, 0, 0], [-1, 0, 0]], atol=4 * EPS)
    assert C.radius(pair) == 1.0


def test_point_pairs_come_back():
    x, y = np.random.default_rng(2).normal(size=(2, 7, 3))
    first, second = C.points(3 * C.point_pair(x, C.up(y)))
    assert np.allclose(first.components, x, atol=1e-12)
    assert np.allclose(second.components, y, atol=1e-12)


def test_spheres_in_the_plane_are_circles():
    P = ph.cga(2)
    circle = P.sphere([1.0, 2.0], 3)
    assert (
        np.abs((P.up([[4.0, 2.0], [1.0, 5.0], [1 + 3 * 0.6, 2 - 3 * 0.8]]) ^ circle).components).max() < 1e-13
    )
    assert np.allclose(P.center(circle).components, [1, 2])
    assert np.isclose(P.radius(circle), 3)
    with pytest.raises(TypeError, match=r"ph.cga\(3\) only"):
        P.circle([0, 0], [0, 1], 1)


def test_the_meet_of_spheres():
    one, two = C.sphere([0.0, 0, 0], 1), C.sphere([1.0, 0, 0], 1)
    meet = one & two
    assert np.allclose(C.center(meet).components, [0.5, 0, 0], atol=8 * EPS)
    assert np.isclose(C.squared_radius(meet), 0.75)
    apart = one & C.sphere([4.0, 0, 0], 1)  # d/2 = 2 from both: r² = 1 − 4
    assert np.isclose(C.squared_radius(apart), -3)
    with pytest.raises(ValueError, match="imaginary"):
        C.radius(apart)
    with pytest.raises(ValueError, match="positive"):
        C.sphere([0.0, 0, 0], 0)


# --- flats


def test_lines_and_planes():
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(2, 5, 3))
    line = C.line(a, b)
    way = b - a
    size = np.linalg.norm(way, axis=-1)
    assert line.is_close((C.up(a) ^ C.up(b) ^ C.einf) / size, atol=1e-14 * 100).all()
    assert line.is_close(C.line(C.up(a), direction=way), atol=1e-13).all()
    foot, along = C.point_and_direction(2 * line)
    unit = way / size[:, None]
    assert np.allclose(along.components, unit, atol=1e-13)
    assert np.allclose(foot.components, a - (a * unit).sum(-1, keepdims=True) * unit, atol=1e-13)
    distance = np.linspace(-1, 2, 5)
    plane = C.plane(way, distance)
    for i in range(5):
        basis = np.linalg.svd(unit[i][None])[2]
        assert on(plane[i], distance[i] * unit[i] + rng.normal(size=(4, 2)) @ basis[1:]) < 1e-13
    normal, back = C.normal_and_distance(0.5 * plane)
    assert np.allclose(normal.components, unit, atol=1e-13)
    assert np.allclose(back, distance, atol=1e-13)
    turning = C.up(np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0]]))
    x, y, z = turning
    assert (x ^ y ^ z ^ C.einf).is_close(2 * C.plane([0, 0, 1]), atol=4 * EPS)


def test_flats_and_rounds_are_told_apart():
    with pytest.raises(ValueError, match="flat"):
        C.center(C.plane([0, 0, 1.0]))
    with pytest.raises(ValueError, match="einf"):
        C.normal_and_distance(C.sphere([0.0, 0, 0], 1))
    with pytest.raises(ValueError, match="einf"):
        C.point_and_direction(C.circle([1.0, 0, 0], [0, 0, 1], 1))
    # Neither answer depends on the weight of the element.
    plane, sphere = C.plane([0.6, 0, 0.8], 2.0), C.sphere([1.0, 2, 3], 1)
    for weight in (1e-12, 1e12):
        normal, distance = C.normal_and_distance(weight * plane)
        np.testing.assert_allclose([*normal.components, distance], [0.6, 0, 0.8, 2], rtol=0, atol=16 * EPS)
        with pytest.raises(ValueError, match="einf"):
            C.normal_and_distance(weight * sphere)
    with pytest.raises(TypeError, match=r"the value must be a value of cga\(3\), got float"):
        C.center(1.0)
    with pytest.raises(ValueError, match="the vector to the point `through`"):
        C.line([1.0, 0, 0], [1.0, 0, 0])


# --- versors


def test_versors_move_points():
    rng = np.random.default_rng(4)
    x, t, f = rng.normal(size=(9, 3)), rng.normal(size=(9, 3)), rng.uniform(0.2, 5, 9)
    R = ph.Rotor.random(9, rng=5)
    X, atol = C.up(x), 1e-12  # points of size up to 5·|x|, squared
    assert np.allclose(C.down(C.translator(t) >> X).components, x + t, atol=atol)
    assert (C.down(C.rotor(R) >> X)).is_close(R(ph.vector(x)), atol=atol).all()
    assert np.allclose(C.down(C.dilator(f) >> X).components, f[:, None] * x, atol=atol)
    assert np.allclose(C.down(C.dilator(f, t) >> X).components, t + f[:, None] * (x - t), atol=atol)
    T = ph.RigidTransform(R, t)
    assert np.allclose(C.down(C.motor(T) >> X).components, T.apply(x), atol=atol)
    assert np.all(C.motor(T) == C.motor(R, t))
    for V in (C.translator(t), C.rotor(R), C.dilator(f, t), C.motor(T)):
        assert (V * ~V).is_close(1, atol=1e-13).all()
    with pytest.raises(TypeError, match="a rotor must be of grade 0 or 2"):
        C.rotor(ph.e1)
    with pytest.raises(ValueError, match="positive factor"):
        C.dilator([1.0, 0.0])


def test_versors_move_spheres():
    sphere = C.sphere([1.0, 2.0, 3.0], 0.5)
    V = C.dilator(3.0) * C.motor(ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 2), [1.0, 0, 0])
    moved = V >> sphere
    assert np.allclose(C.center(moved).components, [3 * (1 - 2), 3, 9], atol=1e-12)
    assert np.isclose(C.radius(moved), 1.5)
    mirrored = C.plane([1.0, 0, 0], 2.0).dual() >> sphere  # a vector: a reflection
    assert np.allclose(C.center(mirrored).components, [3, 2, 3], atol=1e-12)
    inverted = sphere.dual() >> C.up([1.0, 2.0, 4.0])  # an inversion: distances 1 and r²/1
    assert np.allclose(C.down(inverted).components, [1, 2, 3.25], atol=1e-12)


def test_symbols_and_traced_arrays():
    sympy = pytest.importorskip("sympy")
    x, y, r = sympy.symbols("x y r", positive=True)
    X = C.up([x, y, 0])
    assert (X * X).simplify() == 0
    assert (X | C.up([sympy.Integer(0)] * 3)).simplify() == -(x**2 + y**2) / 2
    circle = C.sphere([x, y, 0], r).simplify()
    assert sympy.simplify(C.squared_radius(circle)) == r**2
    jax = pytest.importorskip("jax")
    jnp = jax.numpy
    radius = jax.jit(lambda c, r: C.radius(C.translator(c) >> C.sphere(c, r)))
    assert np.isclose(radius(jnp.array([0.1, 0.2, 0.3]), jnp.array(0.5)), 0.5, rtol=1e-5)


def test_points_of_symbols_come_back():
    sympy = pytest.importorskip("sympy")
    x, t = sympy.symbols("x t", real=True)
    turned = C.rotor(ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, t)) >> C.up([x, 0, 0])
    position = C.down(turned).map(sympy.simplify)
    assert np.all(position.components == [x * sympy.cos(t), x * sympy.sin(t), 0])
    with pytest.raises(ValueError, match="X² = 0"):
        C.down(C.up([x, 0, 0]) + C.basis_vectors[0])
    with pytest.raises(ValueError, match="is flat"):
        C.center(C.line([x, 0, 0], direction=[0, x**2 + 1, 0]))
    # Radii that may be positive, and squares that may not be negative.
    assert sympy.simplify(C.squared_radius(C.sphere([0, 0, 0], x)) - x**2) == 0
    assert sympy.simplify(C.radius(C.sphere([x, 0, 0], 2)) - 2) == 0
    with pytest.raises(ValueError, match="positive factor"):
        C.dilator(-(t**2))


def test_exact_rounds_and_flats():
    third = Fraction(1, 3)
    normal, distance = C.normal_and_distance(C.plane([3 * third, 4 * third, 0], third))
    assert list(normal.components) == [Fraction(3, 5), Fraction(4, 5), 0]
    assert distance == third
    for radius in (-third, 0 * third):
        with pytest.raises(ValueError, match=r"at index \(1,\): a radius must be positive"):
            C.sphere([[third, 0, 0]], [third, radius])
        with pytest.raises(ValueError, match="positive factor"):
            C.dilator(radius)
    apart = C.sphere([third, 0, 0], third) & C.sphere([5 * third, 0, 0], third)
    assert C.squared_radius(apart) == -third
    with pytest.raises(ValueError, match="imaginary"):
        C.radius(apart)


@pytest.mark.parametrize("digits", [15, 50])
def test_rounding_of_multiprecision_numbers(digits):
    """Rounded points are points, and rounded versors versors, as of floats."""
    mpmath = pytest.importorskip("mpmath")
    with mpmath.workdps(digits):
        x = [mpmath.mpf(1) / 3, mpmath.mpf(1) / 7, mpmath.mpf(0)]
        moved = C.translator(x) * C.dilator(mpmath.mpf(2)) >> C.up(x)
        error = C.down(moved).components - [3 * a for a in x]
        assert max(map(abs, error)) < mpmath.mpf(10) ** (2 - digits)
        with pytest.raises(ValueError, match="X² = 0"):
            C.down(C.up(x) + mpmath.mpf("1e-6") * C.einf)


def test_fractions_and_rounded_numbers_mix():
    M = C.motor(ph.Rotor.from_axis_angle(ph.e3, Fraction(1)), [Fraction(1, 3), 0, 0])
    expected = M.astype(float) >> C.up([1.0, 2, 3])
    assert (M >> C.up([Fraction(1), 2, 3])).astype(float).is_close(expected, rtol=1e-14)


def test_values_of_other_algebras():
    M = ph.algebra(4, 1).random(5, rng=6)
    assert np.all(C.embed(M).dense() == M.dense())
    assert C.embed(M).algebra is C
    B = ph.bivector([1.0, 2.0, 3.0])
    assert C.embed(B)["e31"] == 2.0
    assert C.embed(C.eo) is C.eo
    with pytest.raises(
        TypeError, match=r"cga\(3\) contains values of Cl\(3\) or Cl\(4,1\), got one of Cl\(2\)"
    ):
        C.embed(ph.algebra(2).I)


def test_batches_broadcast():
    spheres = C.sphere(np.zeros((4, 1, 3)), np.array([1.0, 2.0]))
    assert spheres.shape == (4, 2)
    assert C.radius(spheres).shape == (4, 2)
    assert C.plane(np.eye(3), np.ones((2, 1))).shape == (2, 3)
