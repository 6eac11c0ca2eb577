"""`ph.pga`: the basis with e0 first against Cl(n, 0, 1), and points, planes, lines and motors."""

import copy
import json
import pickle
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph

EPS = 2.0**-52
A = ph.pga(3)
LAST = ph.algebra(3, 0, 1)
PRODUCTS = ("geometric_product", "wedge", "dot", "commutator", "left_contraction", "right_contraction", "vee")
SPACES = pytest.mark.parametrize("n", [1, 2, 3, 4])


def matrix(n):
    """Columns are the basis of ph.pga(n) in that of ph.algebra(n, 0, 1): products of the generators."""
    first, last = ph.pga(n), ph.algebra(n, 0, 1)
    *others, null = last.basis_vectors
    generators = [null, *others]
    found = []
    for name in first.blades:
        element = last.scalar(1.0)
        for g in range(n + 1) if name == "I" else [int(part[1:]) for part in name.split("∧") if part != "1"]:
            element = element * generators[g]
        found.append(element.dense())
    return np.array(found).T


def numbers(n, seed, shape=()):
    return np.random.default_rng(seed).integers(-5, 6, (*shape, 2 ** (n + 1))).astype(float)


# --- the algebra


def test_the_basis_is_that_of_bivector_net():
    assert list(ph.pga(2).blades) == ["1", "e0", "e1", "e2", "e0∧e1", "e2∧e0", "e1∧e2", "I"]
    names = [
        "1",
        "e0",
        "e1",
        "e2",
        "e3",
        "e01",
        "e02",
        "e03",
        "e12",
        "e31",
        "e23",
        "e021",
        "e013",
        "e032",
        "e123",
        "e0123",
    ]
    numbers = np.arange(1.0, 17.0)
    M = A.multivector(numbers)
    assert [M[name] for name in names] == numbers.tolist()
    assert M["e13"] == -10
    assert M["e012"] == -12
    assert M["e1^e3^e0"] == 13
    assert M["I"] == 16
    assert str(A.point([2.0, 3.0, 4.0])) == "4 e0∧e2∧e1 + 3 e0∧e1∧e3 + 2 e0∧e3∧e2 + e1∧e2∧e3"
    assert A.blades["e20"] == -A.blades["e02"] == A.basis_vectors[2] * A.e0
    assert repr(A) == "pga(3)"
    assert A.signature == (3, 0, 1)
    assert A.e0 * A.e0 == 0
    with pytest.raises(IndexError, match=r"'e4' is not a basis element of pga\(3\); .*\(e0, e1, e2, e3\)"):
        M["e4"]


@SPACES
def test_complements_are_as_far_from_the_other_end(n):
    space = ph.pga(n)
    elements = list(space.blades.values())
    for k in range(space.size // 2):
        assert elements[k].wedge(elements[-1 - k]) == space.I
        assert elements[k].right_complement() == elements[-1 - k]


@SPACES
@pytest.mark.parametrize("name", PRODUCTS)
def test_products_are_those_with_the_null_generator_last(n, name):
    first, last, T = ph.pga(n), ph.algebra(n, 0, 1), matrix(n)
    a, b = numbers(n, 1, (7, 1)), numbers(n, 2, (20,))
    got = getattr(first.multivector(a), name)(first.multivector(b)).dense() @ T.T
    want = getattr(last.multivector(a @ T.T), name)(last.multivector(b @ T.T)).dense()
    if name == "vee":  # I is e0 e1 e2 e3 there, and e1 e2 e3 e0 here
        want = want * np.linalg.det(np.roll(np.eye(n + 1), 1, axis=0))
    assert np.array_equal(got, want)


@SPACES
@pytest.mark.parametrize("kind", ["single", "float32", "exact", "jax"])
def test_products_of_other_coefficients(n, kind):
    space = ph.pga(n)
    a, b = numbers(n, 3, (5,)), numbers(n, 4, (5,))
    want = (space.multivector(a) * space.multivector(b)).dense()
    if kind == "single":
        got = np.array(
            [(space.multivector(x) * space.multivector(y)).dense() for x, y in zip(a, b, strict=False)]
        )
    elif kind == "jax":
        jnp = pytest.importorskip("jax.numpy")
        got = (space.multivector(jnp.asarray(a)) * space.multivector(jnp.asarray(b))).dense()
    else:
        dtype = np.float32 if kind == "float32" else object
        got = (space.multivector(a, dtype=dtype) * space.multivector(b, dtype=dtype)).dense()
    assert np.array_equal(np.asarray(got, dtype=float), want)


@pytest.mark.parametrize("dtype", [float, np.float32, object, complex])
def test_null_components_do_not_count_in_norms(dtype):
    space = ph.pga(3)
    plane = space.multivector([0, 12, 3, 4, 0, *[0] * 11], dtype=dtype)
    assert plane.norm() == 5
    assert plane.norm_squared() == 25


@SPACES
def test_functions_are_those_with_the_null_generator_last(n):
    first, last, T = ph.pga(n), ph.algebra(n, 0, 1), matrix(n)
    rng = np.random.default_rng(5)
    M = first.multivector(rng.normal(size=(10, first.size)) + 4 * np.eye(first.size)[0])
    other = last.multivector(M.dense() @ T.T)
    for name in ("exp", "inverse", "sinh", "normalized"):
        got, want = getattr(M, name)().dense() @ T.T, getattr(other, name)().dense()
        # The same steps in another order: some hundred roundings of the largest component.
        assert np.abs(got - want).max() <= 1000 * EPS * np.abs(want).max()
    if n < 2:
        return
    V = first.random(10, grades=2, rng=6).exp()
    other = last.multivector(V.dense() @ T.T)
    for name in ("log", "sqrt"):
        got, want = getattr(V, name)().dense() @ T.T, getattr(other, name)().dense()
        assert np.abs(got - want).max() <= 1e4 * EPS * np.abs(want).max()
    assert V.log().exp().is_close(V, atol=1e4 * EPS).all()


@SPACES
def test_subspaces_involutions_and_norms(n):
    first, last, T = ph.pga(n), ph.algebra(n, 0, 1), matrix(n)
    M = first.multivector(numbers(n, 7))
    other = last.multivector(M.dense() @ T.T)
    for name in ("reverse", "grade_involution", "clifford_conjugate"):
        assert np.array_equal(getattr(M, name)().dense() @ T.T, getattr(other, name)().dense())
    assert M.norm_squared() == other.norm_squared()
    assert M.right_complement().left_complement() == M
    with pytest.raises(TypeError, match=r"no inverse in pga"):
        M.dual()
    x, y = first.random(grades=1, rng=1), first.random(grades=1, rng=2)
    both = (x ^ y).dense()
    joined = (x ^ y).join(x).dense()  # of length 1 with every generator as a unit vector
    assert np.abs(joined - (joined @ both) * both / (both @ both)).max() <= 1e-14
    assert abs(np.linalg.norm(joined) - 1) <= 1e-14
    if n > 1:
        one, two = (x ^ y).factor()
        assert (one * two).is_close(x ^ y, atol=1e-12)


def test_exact_inverse_and_exp():
    M = A.multivector(numbers(3, 8) + 20 * np.eye(16)[0], dtype=object)
    assert M * M.inverse() == 1
    B = A.bivector([1, 2, 3, 0, 0, 0], dtype=object)
    assert B.exp() == 1 + B


def test_formulas_know_e0():
    M = A.random(rng=1)
    assert ph.formula("M e0 - 2 e031")(M=M).is_close(M * A.e0 - 2 * A.blades["e031"], atol=1e-15)
    assert ph.formula("e0 e1 = e01", algebra=A)()
    assert ph.formula("I = e0 e1 e2 e3", algebra=A)()
    assert ph.formula("Σ_k e_k e_k", algebra=A)() == 3
    assert ph.formula("e0 + x").latex == "e_{0} + x"
    a, b = A.random(5, grades=2, rng=2), A.random(5, grades=1, rng=3)
    assert ph.formula("a b ~a")(a=a, b=b).is_close(a * b * ~a, atol=1e-13).all()
    with pytest.raises(ph.FormulaError, match="`e4` is not a basis element; the basis vectors are e0 to e3"):
        ph.formula("e4", algebra=A)
    with pytest.raises(ph.FormulaError, match="`e0` is not a basis element"):
        ph.formula("e0", algebra=LAST)
    f = ph.formula("e1 + x")  # one formula, two algebras of one signature
    assert f(x=A.e0) == A.e0 + A.basis_vectors[1]
    assert f(x=LAST.basis_vectors[3])["e4"] == 1


def test_values_keep_their_algebra():
    M = A.random((2, 3), rng=4)
    for again in (
        pickle.loads(pickle.dumps(M)),
        copy.deepcopy(M),
        ph.from_dict(json.loads(json.dumps(ph.to_dict(M)))),
    ):
        assert again.algebra is A
        assert np.all(again == M)
    assert ph.to_dict(M)["algebra"] == "pga(3)"
    assert pickle.loads(pickle.dumps(A)) is A is ph.pga()
    assert A is not LAST
    with pytest.raises(
        TypeError, match=r"different algebras, pga\(3\) and Cl\(3,0,1\); .* ph.pga\(3\).embed"
    ):
        A.e0 + LAST.basis_vectors[0]
    with pytest.raises(ValueError, match="an algebra is three counts"):
        ph.from_dict({**ph.to_dict(M), "algebra": "sta"})


@pytest.mark.parametrize(
    ("n", "error"), [(0, ValueError), (8, ValueError), (True, TypeError), (2.5, TypeError)]
)
def test_dimensions(n, error):
    with pytest.raises(error, match="pga needs"):
        ph.pga(n)


def test_products_are_those_of_kingdon():
    kingdon = pytest.importorskip("kingdon")
    other = kingdon.Algebra.fromname("3DPGA")
    names = ["e", *(name.replace("∧e", "").replace("I", "e0123") for name in list(A.blades)[1:])]

    def theirs(M):
        held = {name: x for name, x in zip(names, M.dense().tolist(), strict=True) if x}
        return other.multivector(keys=tuple(held), values=list(held.values()))

    a, b, M = A.random(rng=1), A.random(rng=2), A.motor(ph.Rotor.random(rng=3), [1.0, 2.0, 3.0])
    plane, point = A.plane([1.0, 2.0, 2.0], 0.5), A.point([3.0, 1.0, -2.0])
    for got, want in [
        (a * b, theirs(a) * theirs(b)),
        (a ^ b, theirs(a) ^ theirs(b)),
        (a | b, theirs(a) | theirs(b)),
        (a & b, theirs(a) & theirs(b)),
        (M >> a, theirs(M) >> theirs(a)),
        (plane >> point, theirs(plane) >> theirs(point)),
    ]:
        expected = np.array([float(getattr(want, name)) for name in names])
        assert np.abs(got.dense() - expected).max() <= 200 * EPS  # components of size up to 10


# --- points, planes and lines


@SPACES
def test_points_come_back(n):
    space = ph.pga(n)
    x = np.random.default_rng(n).normal(size=(4, 5, n))
    P = space.point(x)
    assert P.shape == (4, 5)
    assert P.grades == (n,)
    assert np.array_equal(space.coordinates(P), x)
    assert space.down(3 * P).is_close(ph.algebra(n).vector(x), rtol=4 * EPS).all()
    assert np.all(space.normalized(-2 * P).is_close(P, rtol=4 * EPS))
    assert np.all(space.point(ph.algebra(n).vector(x)) == P)
    with pytest.raises(ValueError, match=r"index \(0, 0\).*at infinity"):
        space.coordinates(space.direction(x))


@SPACES
def test_planes_contain_their_points(n):
    space = ph.pga(n)
    normal = np.random.default_rng(n).normal(size=(6, n))
    unit = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    d = np.linspace(-2, 3, 6)
    plane = space.plane(normal, d)
    # x·n − d of points off the plane, rounded a few times beside numbers of size 10.
    assert (plane ^ space.point(d[:, None] * unit)).is_close(0, atol=100 * EPS).all()
    assert np.allclose((plane ^ space.point((d[:, None] + 1) * unit))["I"], 1, rtol=100 * EPS)
    back, distance = space.normal_and_distance(3 * plane)
    assert np.allclose(back.components, unit, atol=4 * EPS)
    assert np.allclose(distance, d, rtol=8 * EPS)
    with pytest.raises(ValueError, match="broadcast"):
        space.plane(normal, d[:4])
    with pytest.raises(ValueError, match="the normal is not a direction"):
        space.plane(np.zeros(n))
    with pytest.raises(ValueError, match="at infinity"):
        space.normal_and_distance(space.e0)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_lines(n):
    space, rng = ph.pga(n), np.random.default_rng(n)
    a, b = rng.normal(size=(5, n)), rng.normal(size=(5, n))
    line = space.line(a, b)
    assert np.allclose(line.norm(), 1, rtol=8 * EPS)
    assert line.is_close(
        (space.point(a) & space.point(b)) / np.linalg.norm(b - a, axis=-1), atol=50 * EPS
    ).all()
    assert line.is_close(space.line(space.point(a), direction=b - a), atol=50 * EPS).all()
    foot, along = space.point_and_direction(-2 * line)
    unit = (b - a) / np.linalg.norm(b - a, axis=-1, keepdims=True)
    assert np.allclose(along.components, -unit, atol=20 * EPS)
    want = a - (a * unit).sum(-1, keepdims=True) * unit
    assert np.allclose(foot.components, want, atol=100 * EPS)
    # A plane across the line meets it in a point.
    P = space.plane(unit, 1.0) ^ line
    assert np.allclose(space.coordinates(P), want + unit, atol=200 * EPS)


def test_named_lines_of_the_literature():
    e12, e31, e23 = (A.blades[name] for name in ("e12", "e31", "e23"))
    o, x, y, z = A.point(np.zeros(3)), *(A.point(row) for row in np.eye(3))
    assert (o & x, o & y, o & z) == (e23, e31, e12)
    turn = (-np.pi / 4 * A.line(o, z)).exp()  # right-handed about e3
    assert np.allclose(A.coordinates(turn >> x), [0, 1, 0], atol=4 * EPS)
    assert o & x & y == -A.basis_vectors[3] or o & x & y == A.basis_vectors[3]


def test_lines_need_two_things():
    with pytest.raises(TypeError, match="either the point"):
        A.line([0.0, 0, 0])
    with pytest.raises(ValueError, match="the vector to the point `through` is not a direction"):
        A.line([1.0, 2, 3], [1.0, 2, 3])
    with pytest.raises(ValueError, match=r"index \(1,\)"):
        A.line(np.zeros((2, 3)), direction=[[1.0, 0, 0], [0.0, 0, 0]])
    with pytest.raises(TypeError, match="must be a value of pga"):
        A.coordinates(ph.e1)
    with pytest.raises(TypeError, match="of grade 3"):
        A.coordinates(A.e0)
    with pytest.raises(ValueError, match="3 components"):
        A.point([1.0, 2.0])


def test_normalized_checks():
    screw = A.bivector([1.0, 0, 0, 0, 0, 1.0])
    with pytest.raises(ValueError, match="a screw"):
        A.normalized(screw)
    with pytest.raises(ValueError, match="norm 0"):
        A.normalized(A.blades["e01"])
    with pytest.raises(ValueError, match="not a motor"):
        A.normalized(1 + A.e0 + A.basis_vectors[1] * 0.5)
    M = A.motor(ph.Rotor.random(rng=1), [1.0, 2, 3])
    assert A.normalized(-3 * M).is_close(-M, atol=8 * EPS)
    sloppy = A.normalized((1.5 + 0.25 * A.I) * M)  # the same screw: M times a dual number
    assert (sloppy * ~sloppy).is_close(1, atol=16 * EPS)
    assert sloppy.is_close(M, atol=16 * EPS)


# --- motors


def test_motors_move_everything():
    rng = np.random.default_rng(7)
    R, t = ph.Rotor.random(8, rng=8), rng.normal(size=(8, 3))
    T = ph.RigidTransform(R, t)
    M = A.motor(R, t)
    assert np.all(A.motor(T) == M)
    x, y, n = rng.normal(size=(3, 8, 3))
    atol = 64 * EPS * 10
    assert np.allclose(A.coordinates(M >> A.point(x)), T.apply(x), atol=atol)
    assert (M >> A.line(x, y)).is_close(A.line(T.apply(x), T.apply(y)), atol=atol).all()
    assert (M >> A.direction(x)).is_close(A.direction(R(ph.vector(x))), atol=atol).all()
    unit = n / np.linalg.norm(n, axis=-1, keepdims=True)
    moved = R(ph.vector(unit))
    want = A.plane(moved, 0.5 + (moved * ph.vector(t)).grade(0).components[..., 0])
    assert (M >> A.plane(n, 0.5)).is_close(want, atol=atol).all()
    back = A.transform(-2 * M)
    assert back.is_close(T, atol=atol).all()
    translators = A.translator(t)
    assert translators.is_close(A.motor(None, t), atol=0).all()
    assert (A.translator(t) * A.motor(R)).is_close(M, atol=8 * EPS).all()


def test_reflection_in_a_plane():
    plane = A.plane([0, 0, 1], 1.0)
    assert np.allclose(A.coordinates(plane >> A.point([1.0, 2.0, 3.0])), [1, 2, -1])


@SPACES
def test_values_with_the_null_generator_last(n):
    space, last, T = ph.pga(n), ph.algebra(n, 0, 1), matrix(n)
    M = space.random((4,), rng=n)
    assert np.array_equal(space.null_last(M).dense(), M.dense() @ T.T)
    assert np.all(space.embed(space.null_last(M)) == M)
    assert space.null_last(M).algebra is last
    assert space.embed(ph.algebra(n).basis_vectors[0]) == space.basis_vectors[1]
    exact = space.vector(range(n + 1), dtype=object)
    assert space.embed(space.null_last(exact)) == exact
    with pytest.raises(TypeError, match="embed needs a multivector"):
        space.embed(2.0)
    with pytest.raises(TypeError, match=r"contains values of"):
        space.embed(ph.algebra(1, 3).I)


def test_motors_of_other_dimensions():
    space = ph.pga(2)
    t = np.array([1.0, -2.0])
    assert np.allclose(space.coordinates(space.translator(t) >> space.point([3.0, 4.0])), [4, 2])
    with pytest.raises(TypeError, match=r"ph.pga\(3\) only"):
        space.motor(ph.Rotor.identity())


def test_symbols_and_traced_arrays():
    sympy = pytest.importorskip("sympy")
    x, y, z, d = sympy.symbols("x y z d", real=True)
    P = A.point([x, y, z])
    assert list(A.coordinates(3 * P)) == [x, y, z]
    assert (A.plane([0, 0, 1], d) ^ P)["I"] == z - d
    assert list(A.coordinates(A.translator([d, 0, 0]) >> P)) == [x + d, y, z]
    jax = pytest.importorskip("jax")
    place = jax.jit(lambda x: A.coordinates(A.motor(None, x) >> A.point(x)))
    assert np.allclose(place(np.array([1.0, 2.0, 3.0])), [2, 4, 6], rtol=1e-6)


def test_single_precision_stays():
    x = np.ones((4, 3), np.float32)
    found = [A.point(x), A.plane(x, 2.0), A.line(x, direction=x), A.translator(x), A.point(x) ^ A.plane(x)]
    found += [
        A.normalized(3 * A.point(x)),
        A.down(A.point(x)),
        *A.point_and_direction(A.line(x, direction=x)),
    ]
    C = ph.cga(3)
    found += [C.up(x), C.down(C.up(x)), C.plane(x, 2.0), C.line(x, 2 * x), C.sphere(x, 2.0), C.translator(x)]
    found += [C.center(C.sphere(x, 2.0)), *C.points(C.point_pair(x, 2 * x)), C.circle(x, x, 2.0)]
    assert {value.dtype for value in found} == {np.dtype(np.float32)}
    assert np.allclose(C.radius(C.sphere(x, 2.0)), 2, rtol=1e-5)


@pytest.mark.parametrize("factor", [2.0**-1000, 2.0**-520, 2.0**520, 2.0**1000])
def test_values_of_any_size(factor):
    """Their squares over- or underflow. A factor that is a power of two rounds nothing."""
    M = A.motor(ph.Rotor.from_axis_angle(ph.e3, 1.0), [1.0, 2.0, 3.0])
    plane, line = A.plane([0, 0.6, 0.8], 2), A.line([0, 0, 1], direction=[1, 0, 0])
    for X in (plane, line, A.point([1, 2, 3]), M):
        assert np.all(A.normalized(factor * X) == A.normalized(X))
    normal, distance = A.normal_and_distance(factor * plane)
    assert (normal, distance) == A.normal_and_distance(plane)
    point, along = A.point_and_direction(-factor * line)
    assert (point, along) == (ph.e3, -ph.e1)
    assert A.normalized(factor * M).is_close(M, rtol=4 * EPS)


def test_exact_planes_come_back():
    normal, distance = A.normal_and_distance(-5 * A.plane([Fraction(3), Fraction(4), 0], Fraction(2, 3)))
    assert list(normal.components) == [Fraction(-3, 5), Fraction(-4, 5), 0]
    assert distance == Fraction(-2, 3)


# --- operators and random values


def test_operators_are_the_methods():
    a, b = A.random(4, rng=1), A.random(4, rng=2)
    assert np.all((a & b) == a.vee(b))
    assert np.all((2 & a) == A.scalar(2.0).vee(a))
    assert np.all((a & 2) == a.vee(2))
    R, v = ph.Rotor.random(rng=3), ph.vector([1.0, 2, 3])
    assert (R >> v) == R(v)
    assert ((2 * R) >> v).is_close(R(v), rtol=8 * EPS)
    for wrong in (lambda: R >> 2, lambda: 2 >> R, lambda: a & "x"):
        with pytest.raises(TypeError, match="unsupported operand"):
            wrong()


@pytest.mark.parametrize("space", [ph.algebra(3), ph.algebra(1, 3), ph.pga(2), ph.cga(3)], ids=str)
def test_random_values(space):
    M = space.random((2, 3), rng=1)
    assert M.shape == (2, 3)
    assert M.grades == tuple(range(space.dimension + 1))
    assert M.algebra is space
    assert np.all(space.random((2, 3), rng=np.random.default_rng(1)) == M)
    assert space.random(grades=2).grades == (2,)
    assert space.random(4, grades=(2, 0)).grades == (0, 2)
    many = space.random(4000, grades=1, rng=2).components
    assert abs(many.mean()) < 0.1
    assert abs(many.std() - 1) < 0.1
    with pytest.raises(ValueError, match="has grades 0 to"):
        space.random(grades=9)
