"""Formulas equal the same computation by method calls, for all kinds of values, shapes and algebras."""

from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from kinds import kinds
from polhode import I, e1, e2, e3
from samples import EPS, PAIRS_OF_SHAPES, SHAPES, random_rotors

kind = kinds()
RNG = np.random.default_rng(7)
GRADES = {"A": (0, 1, 2, 3), "a": (1,), "b": (1,), "c": (1,), "B": (2,), "t": (3,), "s": (0,)}
INDICES = {0: [0], 1: [1, 2, 3], 2: [4, 5, 6], 3: [7]}

# Text, its names, and the same by method calls; J is I in the precision of the values.
POLYNOMIAL = {
    "½(a b + b a)": ("ab", lambda a, b, J: (a * b + b * a) / 2),
    "a b - a·b - a∧b + A": ("abA", lambda a, b, A, J: a * b - a.dot(b) - a.wedge(b) + A),
    "-I a∧b": ("ab", lambda a, b, J: -(J * a.wedge(b))),
    "a⨯b + dual(B) - undual(t)": ("abBt", lambda a, b, B, t, J: ph.cross(a, b) + B.dual() - t.undual()),
    "(a∧b)·c": ("abc", lambda a, b, c, J: a.wedge(b).dot(c)),
    "a∧b∧c t": ("abct", lambda a, b, c, t, J: a.wedge(b).wedge(c) * t),
    "A×B + A⌋B - B⌊A": (
        "AB",
        lambda A, B, J: A.commutator(B) + A.left_contraction(B) - B.right_contraction(A),
    ),
    "⟨A B⟩_{0,2} + ⟨A⟩": (
        "AB",
        lambda A, B, J: (A * B).grade(0) + (A * B).grade(2) + A.grade(0),
    ),
    "~A B A~ + 2 s": ("ABs", lambda A, B, s, J: ~A * B * ~A + 2 * s),
    "A² - 3 a³ + B^2": ("AaB", lambda A, a, B, J: A * A - 3 * a * a * a + B * B),
    "Σ_k e_k B e_k": ("B", lambda B, J: -B),
    "a/2 + 0.25 b": ("ab", lambda a, b, J: a / 2 + b / 4),
}


def given(kind, names, shape):
    """Values of a kind for some names, and I in their precision."""
    values = {name: kind.random(k, shape, GRADES[name]) for k, name in enumerate(names)}
    return values, kind.own(I)


def checked(kind, got, expected):
    """Whether the components are equal up to the rounding of the kind."""
    grades = {*got.grades, *expected.grades}
    got, expected = got - 0 * expected, expected - 0 * got
    assert set(got.grades) == set(expected.grades) == grades
    assert got.shape == expected.shape
    if kind.exact:
        return kind.equal(got, expected)
    return kind.near(got, expected, 64, 5000)  # products of three numbers up to 4.5, summed


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("text", POLYNOMIAL)
def test_polynomials_of_every_kind(kind, text, shape):
    if kind.name.startswith("sympy") and shape == (3, 1, 2):
        pytest.skip("the same as a single value, six times")
    names, calls = POLYNOMIAL[text]
    values, J = given(kind, names, shape)
    f = ph.formula(text)
    got = kind.evaluate(lambda *data: f(dict(zip(names, data, strict=True))), *values.values())
    assert kind.holds(got)
    assert checked(kind, got, calls(*values.values(), J))


FUNCTIONS = {
    "exp(B) a": lambda a, b, B, s: B.exp() * a,
    "a⁻¹ b/a": lambda a, b, B, s: a.inverse() * b * a.inverse(),
    "norm(a) b/norm(b)": lambda a, b, B, s: a.norm() * b / b.norm(),
    "e^(-B/2) a e^(B/2)": lambda a, b, B, s: (B / -2).exp() * a * (B / 2).exp(),
    "sqrt(a b)": lambda a, b, B, s: (a * b).sqrt(),
    "log(a b)": lambda a, b, B, s: (a * b).log(),
    "sin(s) + cos(s) I": lambda a, b, B, s: trigonometric(s, "sin") + trigonometric(s, "cos") * I,
    "tan(s/8) + s/π": lambda a, b, B, s: trigonometric(s / 8, "tan") + s / np.pi,
}


def trigonometric(s, name):
    return s.map(getattr(np, name))


@pytest.mark.parametrize("text", FUNCTIONS)
def test_functions(text):
    a, b = ph.vector(RNG.standard_normal((2, 7, 3)))
    B, s = ph.bivector(RNG.standard_normal((7, 3))), ph.scalar(RNG.standard_normal(7))
    values = {"a": a, "b": b, "B": B, "s": s}
    used = {name: value for name, value in values.items() if name in text.replace("cos(s) I", "cos(s)")}
    names = {node for node in used if node in names_of(text)}
    used = {name: values[name] for name in sorted(names)}
    expected = FUNCTIONS[text](a, b, B, s)
    batch = ph.evaluate(text, used)
    # Well-conditioned functions of numbers of size 1 to 10, each rounded a few times.
    assert np.all((batch - expected).norm() <= 128 * EPS * (1 + expected.norm()))
    for i in range(7):
        single = ph.evaluate(text, {name: value[i] for name, value in used.items()})
        assert single == batch[i]


def names_of(text):
    """The one-letter names among a, b, B and s in a text, functions left out."""
    for word in ("exp", "norm", "sqrt", "log", "sin", "cos", "tan", "e^", "π"):
        text = text.replace(word, "")
    return {letter for letter in text if letter in "abBs"}


@pytest.mark.parametrize(("left", "right"), PAIRS_OF_SHAPES)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_batches_broadcast(left, right, dtype):
    R = random_rotors(left).astype(dtype)
    a, b = (ph.vector(RNG.standard_normal((*shape, 3)), dtype=dtype) for shape in (right, left))
    got = ph.evaluate("R a ~R + ⟨a b⟩_2·b - 2b", R=R, a=a, b=b)
    expected = R(a) + a.wedge(b).dot(b) - 2 * b
    assert (got.shape, got.dtype) == (expected.shape, expected.dtype)
    size = 8 * 2.0 ** (-52 if dtype == np.float64 else -23)
    assert np.all((got - expected).norm() <= size * (1 + 4 * a.norm() * b.norm_squared()))


def test_rotors_stay_rotors():
    R, S = random_rotors((5,)), random_rotors((), 2)
    for text in ("R S", "~R", "R⁻¹", "R²", "R S ~R", "exp(½ log(R)) S"):
        values = {name: value for name, value in {"R": R, "S": S}.items() if name in text}
        got = ph.evaluate(text, values)
        assert isinstance(got, ph.Rotor)
        assert np.all(abs(got.norm() - 1) <= 4 * EPS)
    assert not isinstance(ph.evaluate("R + S", R=R, S=S), ph.Rotor)
    assert not isinstance(ph.evaluate("½ R", R=R[0]), ph.Rotor)


def test_numbers_take_the_precision_of_other_values():
    a = ph.vector(RNG.standard_normal((4, 3)), dtype=np.float32)
    assert ph.evaluate("s a + π e1", s=0.1, a=a).dtype == np.float32
    assert ph.evaluate("s a", s=np.array([0.1, 0.2, 0.3, 0.4]), a=a).dtype == np.float64
    assert ph.evaluate("s a", s=np.float32(0.1), a=a).dtype == np.float32
    assert ph.evaluate("s a", s=0.1, a=e1).dtype == np.float64


def test_arrays_are_batches_of_numbers():
    s = np.arange(6.0).reshape(2, 3)
    assert np.all(ph.evaluate("s e1", s=s) == s * e1)
    assert ph.evaluate("s e1", s=s[:, :0]).shape == (2, 0)
    assert ph.evaluate("1 + 1") == 2


def test_numbers_are_exact_among_exact_values():
    sympy = pytest.importorskip("sympy")
    mpmath = pytest.importorskip("mpmath")
    third = ph.vector([Fraction(1, 3), 0, 0])
    assert list(ph.evaluate("0.1 a + ½ a", a=third).components) == [Fraction(1, 5), 0, 0]
    x = sympy.Symbol("x")
    (half_turn,) = ph.evaluate("½ π x", x=x).components
    assert half_turn == sympy.pi * x / 2
    with mpmath.workdps(40):
        one = ph.scalar(mpmath.mpf(1))
        assert abs(float(ph.evaluate("0.1 s π", s=one).components[0] - mpmath.pi / 10)) < 1e-39


@pytest.mark.parametrize("whole", [3, 2**53, 2**53 + 1, 2**60, 10**18])
def test_whole_numbers_stay_whole_among_exact_values(whole):
    x = Fraction(whole + 1)
    assert ph.evaluate("n - x", n=whole, x=x).components[0] == -1
    assert not ph.evaluate("n = x", n=whole, x=x)
    assert (ph.scalar(x) * whole).components[0] == x * whole
    assert ph.evaluate("n = x - 1", n=whole, x=x).rtol == 0


def test_inexact_numbers_are_refused_among_exact_values():
    for text in ("9007199254740993 x", "x 10^20", "0.3333333333333333333 x", "1e-30 x"):
        with pytest.raises(ph.FormulaError, match="give this one by name"):
            ph.evaluate(text, x=Fraction(1))
        assert ph.evaluate(text, x=1.0).dtype == np.float64


# --- linear maps and functions


@pytest.mark.parametrize("shape", SHAPES)
def test_linear_maps(shape):
    F = ph.LinearMap.from_matrix(RNG.standard_normal((*shape, 3, 3)))
    X = ph.multivector(RNG.standard_normal((3, 1, 2, 8)))
    got, expected = ph.evaluate("F(X)", F=F, X=X), F(X)
    assert got.shape == expected.shape
    assert np.all((got - expected).norm() <= 16 * EPS * (1 + np.linalg.norm(F.matrix) ** 3) * X.norm())


def test_the_inertia_map():
    inertia = ph.Inertia.from_matrix([[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]])
    Ω = ph.bivector(RNG.standard_normal((10, 3)))
    got = ph.evaluate("½ ⟨~Ω inertia(Ω)⟩", inertia=inertia, Ω=Ω)
    assert np.all(abs((got - (~Ω).scalar_product(inertia(Ω)) / 2).components) <= 16 * EPS * 4 * Ω.norm() ** 2)
    # Brackets distinguish a map named I from the pseudoscalar.
    assert ph.evaluate("I(Ω) + I", I=inertia, Ω=Ω[0]).is_close(inertia(Ω[0]) + I)
    assert ph.evaluate("I(Ω) + 3I", Ω=Ω[0], define={"I(B)": "2 B"}).is_close(2 * Ω[0] + 3 * I)


def test_maps_are_exact_among_exact_values():
    F = ph.LinearMap.from_matrix([[1, 2, 0], [0, 1, 0], [3, 0, 1]])
    a = ph.vector([Fraction(1, 3), Fraction(1, 2), 1])
    assert list(ph.evaluate("F(a)", F=F, a=a).components) == [Fraction(4, 3), Fraction(1, 2), 2]


def test_definitions():
    f = ph.formula("V(x) + W(2x)", define={"c": "0.5 e3", "V(x)": "½ x·x", "W(y)": "c·y + V(y)"})
    x = ph.vector(RNG.standard_normal((5, 3)))
    expected = 2.5 * x.dot(x) + e3.dot(x)
    assert np.all(abs((f(x=x) - expected).components) <= 8 * EPS * (1 + 3 * x.norm_squared()[:, None]))
    with pytest.raises(TypeError, match=r"`c` is defined by the formula"):
        f(x=x, c=e1)


# --- other algebras


@pytest.mark.parametrize("signature", [(4, 1, 0), (3, 0, 1), (1, 3, 0), (2, 0, 0)])
@pytest.mark.parametrize("shape", [(), (4,)])
def test_other_algebras(signature, shape):
    algebra = ph.algebra(*signature)
    n = algebra.dimension
    a, b = algebra.vector(RNG.standard_normal((2, *shape, n)))
    M = algebra.multivector(RNG.standard_normal((*shape, algebra.size)))
    got = ph.evaluate("a b M + ⟨M a⟩_1 - ½ e12 a∧b + exp(a∧b/9)", a=a, b=b, M=M)
    half = algebra.basis_vectors[0] * algebra.basis_vectors[1] / 2
    expected = a * b * M + (M * a).grade(1) - half * a.wedge(b) + (a.wedge(b) / 9).exp()
    size = np.sqrt((M.components**2).sum(axis=-1) * (a.components**2).sum(axis=-1))
    size = 1 + size * np.sqrt((b.components**2).sum(axis=-1))
    assert np.all(abs((got - expected).components).max(axis=-1) <= 64 * EPS * algebra.size * size)


def test_without_an_algebra_basis_vectors_are_those_of_the_values():
    p = ph.algebra(4, 1).vector([1, 0, 0, 0, 2])
    *_, e4, e5 = ph.algebra(4, 1).basis_vectors
    assert ph.evaluate("e5 p + e45", p=p) == e5 * p + e4 * e5
    assert ph.formula("⟨e1 e2 e3 e4 p⟩_5")(p=p) == 2 * ph.algebra(4, 1).I
    with pytest.raises(ph.FormulaError, match="e1 to e3"):
        ph.evaluate("e4 a", a=e1)
    with pytest.raises(ph.FormulaError, match="not a basis element"):
        ph.formula("e9")


def test_e_may_be_a_name():
    assert ph.evaluate("p/(1 + e cos(θ))", p=3.0, e=0.5, θ=0.0) == 2
    assert ph.evaluate("e^(0)") == 1
    f = ph.formula("e∧x + (e)² a")
    assert ph.formula(f.ascii)(e=2.0, x=e1, a=e2) == f(e=2.0, x=e1, a=e2) == 2 * e1 + 4 * e2
    with pytest.raises(ph.FormulaError, match="`e` has no value"):
        ph.evaluate("2 e a", a=e1)


def test_repeated_indices_are_summed_where_they_stand():
    values = {"a1": 1.0, "a2": 2.0, "a3": 3.0, "b1": 4.0, "b2": 5.0, "b3": 6.0}
    for text, value in [
        ("2(a_k b_k + 5)", 74),
        ("(a_k b_k)²", 32**2),
        ("1/(a_k b_k)", 1 / 32),
        ("norm(a_k e_k)²", 14),
        ("1 + 2(1 + a_i b_i)(a_k a_k)", 1 + 2 * 33 * 14),
    ]:
        assert abs(float(ph.evaluate(text, values).components[0]) - value) <= 8 * EPS * value
    with pytest.raises(ph.FormulaError, match="the index k occurs 4 times"):
        ph.evaluate("(a_k b_k)(a_k b_k)", values)


def test_values_of_different_algebras_are_refused():
    p = ph.algebra(4, 1).vector([1, 0, 0, 0, 1])
    with pytest.raises(TypeError, match=r"a of Cl\(3\) and p of Cl\(4,1\)"):
        ph.evaluate("a p", a=e1, p=p)
    with pytest.raises(TypeError, match=r"the formula of Cl\(4,1\) and a of Cl\(3\)"):
        ph.formula("a", algebra=ph.algebra(4, 1))(a=e1)
    f = ph.formula("2 e5", algebra=ph.algebra(4, 1))
    assert f() == 2 * ph.algebra(4, 1).basis_vectors[4]
    assert f({"p": p}) == f()


def test_fractions_in_another_algebra():
    algebra = ph.algebra(3, 0, 1)
    a, b = algebra.vector([Fraction(1, 3), 1, 2, 1]), algebra.vector([1, Fraction(1, 2), 0, 4])
    assert ph.evaluate("½ (a b - b a)", a=a, b=b) == a.wedge(b)


# --- threads, pieces and caches


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_every_number_of_threads_gives_the_same_bits(monkeypatch, dtype):
    rows = 300_000
    R = random_rotors((rows,)).astype(dtype)
    a = ph.vector(RNG.standard_normal((rows, 3)), dtype=dtype)
    f = ph.formula("R a ~R + exp(e12 norm(a)) a")
    results = []
    for threads in ("1", "2", "5"):
        monkeypatch.setenv("POLHODE_NUM_THREADS", threads)
        results.append(f(R=R, a=a))
    assert all(np.array_equal(x.components, results[0].components) for x in results)
    for i in (0, 131_071, 131_072, rows - 1):
        assert np.array_equal(results[0][i].components, f(R=R[i], a=a[i]).components)


def test_strided_and_broadcast_operands():
    a = ph.vector(RNG.standard_normal((6, 4, 3)))
    f = ph.formula("a∧b + ⟨a b⟩")
    turned = ph.vector(np.swapaxes(a.components, 0, 1))
    assert np.array_equal(f(a=a, b=a[:, :1]).components[3, 2], f(a=a[3, 2], b=a[3, 0]).components)
    assert np.array_equal(
        f(a=turned, b=turned[0]).components[3, 2], f(a=turned[3, 2], b=turned[0, 2]).components
    )


def test_more_kinds_of_values_than_are_cached():
    f = ph.formula("a + b")
    values = [ph.multivector(np.arange(8.0))._part(mask) for mask in range(1, 16)]
    for _ in range(2):  # more kinds than are kept
        for a in values:
            for b in values:
                assert f(a=a, b=b) == a + b
    for _ in range(3):  # names from no source are not interned
        assert f(**{"".join(["a"]): e1, "".join(["b"]): 2}) == e1 + 2


def test_values_of_an_earlier_call_are_not_reused():
    f = ph.formula("s a")
    assert f(s=2.0, a=e1) == 2 * e1
    assert f(s=3, a=e2) == 3 * e2
    assert f(s=np.float64(4), a=e2) == 4 * e2
    assert f(a=e3, s=-1.0) == -e3
