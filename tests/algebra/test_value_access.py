"""Values in Python: abs, format, np.asarray, components by name, several grades, versors that act."""

import pickle
from fractions import Fraction

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.linalg
import sympy
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

import polhode as ph
from polhode import I, e1, e2, e3
from values import EPS, numbers

M = ph.multivector([1, 2, 3, 4, 5, 6, 7, 8])
MANY = ph.multivector(numbers((2, 3, 8), 40))


# --- abs, format and print options


def test_abs_is_the_norm():
    a = ph.vector([[3.0, 4.0, 0.0], [0.0, 0.0, -2.0]])
    assert np.array_equal(abs(a), [5.0, 2.0])
    assert abs(ph.vector([3, 4, 0], dtype=object)) == 5
    assert abs(ph.Rotor.identity()) == 1


@pytest.mark.parametrize(
    ("value", "spec", "text"),
    [
        (ph.vector([1, -2.5, 1 / 3]), ".3f", "1.000 e1 - 2.500 e2 + 0.333 e3"),
        (ph.vector([1, -2.5, 0]), "8.2f", "    1.00 e1 -     2.50 e2"),
        (ph.vector([-1, 2.5, 0]), "+.1e", "-1.0e+00 e1 + 2.5e+00 e2"),
        (ph.vector([1, 2, 0]), "g", "e1 + 2 e2"),
        (0 * e1, ".2f", "0.00"),
        (1e-9 * e1 - 2 * I, ".1f", "0.0 e1 - 2.0 I"),
        (ph.vector([Fraction(1, 3), 1, 0]), ".3f", "0.333 e1 + 1.000 e2"),
        (ph.vector([np.float32(0.1), 0, 0], dtype=np.float32), ".4f", "0.1000 e1"),
        (ph.vector([[1, 0, 0], [0, -2, 0]]), ".1f", "Multivector of shape (2,):\n[1.0 e1,\n -2.0 e2]"),
        (M, "", str(M)),
    ],
)
def test_format_applies_to_each_component(value, spec, text):
    assert format(value, spec) == text


def test_format_errors():
    with pytest.raises(ValueError, match="'q'"):
        format(e1, "q")
    with pytest.raises(TypeError, match=r"format '.2f' needs numbers, got the component x; use str"):
        format(sympy.Symbol("x") * e1, ".2f")


def test_text_follows_the_print_options_of_numpy():
    a = ph.vector([1 / 3, 2e-7 / 3, -1e5 / 3])
    assert str(a) == "0.33333333 e1 + 6.6666667e-08 e2 - 33333.333 e3"
    with np.printoptions(precision=3):
        assert str(a) == "0.333 e1 + 6.67e-08 e2 - 3.33e+04 e3"
        assert a._repr_latex_() == r"$0.333 e_{1} + 6.67 {\times} 10^{-8} e_{2} - 3.33 {\times} 10^{4} e_{3}$"
    with np.printoptions(precision=3, suppress=True):
        assert str(a) == "0.333 e1 - 33333.333 e3"
        assert str(1e-9 * a) == "0"
        assert str(ph.vector([1e20, np.nan, np.inf])) == "100000000000000000000 e1 + nan e2 + inf e3"
    with np.printoptions(suppress=True):
        assert str(M) == "1 + 2 e1 + 3 e2 + 4 e3 + 5 e2∧e3 + 6 e3∧e1 + 7 e1∧e2 + 8 I"


# --- arrays


def test_a_value_of_one_grade_converts_to_an_array():
    for value in (e1, MANY.grade(2), ph.scalar([1.0, 2.0]), ph.vector([Fraction(1, 3), 1, 0])):
        array = np.asarray(value)
        assert array.flags.writeable
        assert array.dtype == value.dtype
        assert np.array_equal(array, value.components)
        array[...] = 9
        assert np.any(value.components != 9)
    assert np.array([e1, e2, e3]).tolist() == np.eye(3).tolist()
    assert np.asarray(e1, dtype=np.float32).dtype == np.float32
    assert np.asarray(ph.vector(jnp.ones(3))).flags.writeable
    with pytest.raises(ValueError, match="is a copy"):
        np.asarray(e1, copy=False)


@pytest.mark.parametrize("value", [M, e1 * e2, ph.Rotor.identity(3), 1 + e1])
def test_a_value_of_several_grades_does_not(value):
    with pytest.raises(TypeError, match=r"\.components .*\.dense\(\) for all 8"):
        np.asarray(value)


def test_constructors_still_reject_values():
    # A bivector has three components as well, but is not a vector.
    B = e1 ^ e2
    for make in (
        lambda: ph.RigidTransform(ph.Rotor.identity(), B),
        lambda: ph.Inertia.from_matrix([e1, e2, e3]),
        lambda: ph.Inertia.from_principal_moments(e1, 1, 1),
        lambda: ph.vector([e1, e2, e3]),
        lambda: ph.Rotor.from_rotation_vector(B),
        lambda: ph.State(ph.Rotor.identity(), [0, 0, 1], position=B),
        lambda: ph.FreeMotion(ph.Inertia.from_principal_moments(1, 2, 3), ph.Rotor.identity(), B).at(e1),
    ):
        with pytest.raises((TypeError, ValueError)):
            make()


def test_arrays_suit_scipy():
    # SciPy's compiled functions refuse arrays that are read-only. The large batch takes pooled memory.
    for R in (ph.Rotor.random(rng=1), ph.Rotor.random(5, rng=2), ph.Rotor.random(50_000, rng=3)):
        made = [
            Rotation.from_quat(R.to_quaternion(order="xyzw")),
            Rotation.from_matrix(R.to_matrix()),
            Rotation.from_rotvec(R.to_rotation_vector()),
            Rotation.from_euler("xyz", R.to_euler("xyz")),
            Rotation.from_rotvec(np.asarray(ph.vector(R.to_rotation_vector()))),
        ]
        for rotation in made:
            # Of Euler angles near gimbal lock the last half of the digits may be lost.
            assert np.max((made[0] * rotation.inv()).magnitude()) < 1e-7
        turned = made[0].apply(e1.components)
        assert np.allclose(turned, np.asarray(R(e1)), rtol=0, atol=16 * EPS)
    R = ph.Rotor.random(5, rng=2)
    assert CubicSpline(np.arange(5.0), R.components)(2.0) == pytest.approx(R[2].components, abs=8 * EPS)
    assert scipy.linalg.det(R[0].to_matrix()) == pytest.approx(1, abs=8 * EPS)


# --- components by name


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["1"], 1),
        (["e1"], 2),
        (["e23", "e2e3", "e2^e3", "e2∧e3"], 5),
        (["e31", "e3e1", "e3^e1", "e3∧e1"], 6),
        (["e13", "e1e3", "e1^e3", "e1∧e3"], -6),
        (["e12", "e1^e2"], 7),
        (["e21", "e2∧e1"], -7),
        (["I", "e123", "e1e2e3", "e12^e3", "e231"], 8),
        (["e132", "e321"], -8),
    ],
)
def test_components_by_name(names, expected):
    for name in names:
        assert M[name] == expected
        assert np.array_equal((MANY * 0 + M)[name], np.full((2, 3), expected))


def test_components_by_name_fit_the_basis_of_any_algebra():
    for signature in [(3,), (2,), (1,), (4,), (3, 0, 1), (4, 1), (2, 2)]:
        A = ph.algebra(*signature)
        X = A.multivector(np.arange(1.0, A.size + 1))
        for k, (name, element) in enumerate(A.blades.items()):
            assert X[name] == k + 1
            assert element[name] == 1
            assert X[name.replace("∧", "")] == X[name.replace("∧", "^")] == k + 1
        if A.dimension > 1:
            assert A.blades["e21"] == -A.blades["e12"] == -A.blades["e1^e2"]


def test_named_components_of_a_grade_not_held_are_zero():
    assert e1["e12"] == 0
    assert np.array_equal(MANY.grade(1)["I"], np.zeros((2, 3)))
    x = sympy.Symbol("x")
    assert (x * e1)["e1"] == x
    assert (x * e1)["e12"] == 0
    assert jax.jit(lambda c: ph.vector(c)["e2"] + ph.vector(c)["e21"])(jnp.arange(3.0)) == 1


def test_named_components_are_copies():
    A = ph.vector(np.ones((2, 3)))
    A["e1"][:] = 5
    assert np.all(A["e1"] == 1)


@pytest.mark.parametrize("name", ["x", "", "e", "e4", "e0", "e14", "e1e4", "12", "e1^", "e1*e2", "E1"])
def test_unknown_names_are_errors(name):
    with pytest.raises(IndexError, match=r"is not a basis element of Cl\(3\); write 1, I, or generators"):
        M[name]
    with pytest.raises(KeyError, match="is not a basis element"):
        M.algebra.blades[name]


def test_a_generator_named_twice_is_an_error():
    for name in ("e11", "e1e1", "e121"):
        with pytest.raises(IndexError, match="names a generator twice"):
            M[name]


def test_dense_components_and_several_grades():
    assert np.array_equal(e2.dense(), [0, 0, 1, 0, 0, 0, 0, 0])
    assert np.array_equal(MANY.grade(1).dense()[..., 1:4], MANY.components[..., 1:4])
    assert ph.Rotor.identity(4).dense().shape == (4, 8)
    assert ph.algebra(4, 1).vector(np.ones(5)).dense().tolist() == [0.0] + [1.0] * 5 + [0.0] * 26
    odd = M.grade(1, 3)
    assert odd.grades == (1, 3)
    assert odd == M.grade(1) + M.grade(3)
    assert M.grade(3, 1) == odd
    assert M.grade(0, 1, 2, 3) == M
    assert e1.grade(0, 2) == 0
    assert not isinstance(ph.Rotor.identity().grade(0, 2), ph.Rotor)


def test_grade_errors():
    with pytest.raises(ValueError, match="3-d space has grades 0 to 3, got 4"):
        M.grade(1, 4)
    with pytest.raises(TypeError, match="at least one grade"):
        M.grade()
    with pytest.raises(TypeError, match=r"as in grade\(1, 3\), got \[1, 3\]"):
        M.grade([1, 3])


# --- versors


def test_a_product_of_two_vectors_turns_by_twice_their_angle():
    a, b, X = ph.vector([1.0, 2, 2]), ph.vector([-3.0, 0, 4]), ph.multivector(numbers((4, 8), 41))
    R = ph.Rotor.from_vectors(a, b) ** 2
    # Three products of values of size 20 round to some 20 EPS each.
    for scale in (1.0, 1e-60, 1e40):
        assert np.all((b * (scale * a))(X).is_close(R(X), rtol=100 * EPS))
    assert (b * a)(e1).grades == (1,)


def test_an_odd_versor_reflects():
    n, X = ph.vector([1.0, -2, 2]), ph.multivector(numbers((4, 8), 42))
    assert np.all(n(X).is_close(X.reflect(n), rtol=100 * EPS))
    assert np.all(I(X).is_close(X.grade_involution()))
    assert n(I) == -I


@pytest.mark.parametrize("signature", [(3,), (1, 3), (3, 0, 1), (4, 1), (6,), (3, 3)])
def test_versors_act_on_batches_in_any_algebra(signature):
    A, rng = ph.algebra(*signature), np.random.default_rng(43)
    rows = rng.normal(size=(3, 5, A.dimension))
    rows[..., 0] += 4  # away from null vectors
    rows[..., 3:] *= 0.3
    a, b, c = map(A.vector, rows)
    X = A.vector(rng.normal(size=(5, A.dimension)))
    V = a * b * c
    # Reflections one after the other; errors grow with the boosts, here of sizes below 100.
    assert np.all(V(X).is_close(a(b(c(X))), rtol=1e-11))
    assert np.allclose(V(X).norm_squared(), X.norm_squared(), rtol=1e-10, atol=1e-10)
    motor = (0.5 * A.blades["e12"] + 0.25 * A.blades["e23"]).exp()
    assert np.all(motor(X).is_close(motor * X * ~motor, rtol=1e-12))


def test_versors_of_other_coefficients():
    x = sympy.Symbol("x", real=True)
    turned = ((e1 + x * e2) * e1)(e1)
    assert sympy.simplify(turned["e2"] - 2 * x / (1 + x**2)) == 0
    assert (Fraction(1, 3) * e1 * e2)(e1) == -e1
    angle = jax.grad(lambda t: (ph.vector(jnp.stack([jnp.cos(t), jnp.sin(t), 0 * t])) * e1)(e1)["e2"])
    assert angle(0.0) == pytest.approx(2, rel=1e-6)


@pytest.mark.parametrize("value", [1 + e1, M, 1 + e1 + I, 0 * e1, ph.algebra(1, 1).vector([1, 1])])
def test_only_versors_act(value):
    with pytest.raises(TypeError, match="only rotors and versors"):
        value(value)


def test_errors_of_versors():
    with pytest.raises(TypeError, match=r"other than 0 at index \(1,\)"):
        ph.vector([[1.0, 0, 0], [0, 0, 0]])(e1)
    with pytest.raises(TypeError, match=r"acts on multivectors, got list; wrap arrays with ph\.vector"):
        (e1 * e2)([1, 2, 3])
    A = ph.algebra(6)
    # U ~U is a number, but U a ~U has grade 5.
    U = A.scalar(1.0) + A.I
    with pytest.raises(TypeError, match="is not a vector for a = e1"):
        U(A.basis_vectors[0])


def test_a_multivector_is_not_a_law():
    body, state = ph.Inertia.from_principal_moments(1, 2, 3), ph.State(ph.Rotor.identity(), [0, 0, 1])
    with pytest.raises(TypeError, match="torque must be a law"):
        ph.simulate(body, state, [1.0], torque=e1 ^ e2)
    with pytest.raises(TypeError, match="expected a function"):
        ph.torque.function(e1 ^ e2)


@pytest.mark.parametrize("kind", [ph.Multivector, ph.Rotor, ph.Algebra, ph.LinearMap])
def test_methods_have_the_names_they_are_called_by(kind):
    for name in dir(kind):
        member = getattr(kind, name, None)  # None for a name of another library
        if not name.startswith("_") and callable(member):
            assert member.__name__ == name
            assert member.__doc__


def test_bound_methods_can_be_pickled():
    values = ph.vector(np.arange(6.0).reshape(2, 3))
    for name in ("sum", "mean", "norm", "dual", "conj"):
        method = pickle.loads(pickle.dumps(getattr(values, name)))
        assert np.all(method() == getattr(values, name)())


def test_the_package_lists_public_names_only():
    assert not [name for name in dir(ph) if name.startswith("_") and name != "__version__"]
    assert set(ph.__all__) == {name for name in dir(ph) if not name.startswith("_")} - {"jax"}
    for module in (ph.torque, ph.force, ph.event):
        listed = {name for name in dir(module) if not name.startswith("_")}
        assert listed == set(module.__all__)


# --- names of other libraries


@pytest.mark.parametrize(
    ("use", "remedy"),
    [
        (lambda: ph.Rotor.from_quat([0, 0, 0, 1]), "from_quaternion"),
        (lambda: ph.Rotor.identity().as_matrix(), "to_matrix"),
        (lambda: ph.Rotor.identity().inv(), "~R"),
        (lambda: (1 + e1).inv(), "inverse"),
        (lambda: (1 + e1).mag2(), "norm_squared"),
        (lambda: (e1 * e2).e12, 'A\\["e12"\\]'),
        (lambda: ph.Rotor.concatenate, "ph.concatenate"),
        (lambda: ph.Rotor.align(e1, e2), "from_vectors"),
        (lambda: ph.Rotor.identity().axis, "to_rotation_vector"),
        (lambda: ph.Rotor.identity().matrix, "to_matrix"),
        (lambda: ph.Rotor.identity().w, "to_quaternion"),
        (lambda: e1.x, 'A\\["e1"\\]'),
        (lambda: e1.angle(e2), r"Rotor\.from_vectors\(a, b\)\.angle"),
        (lambda: e1.cross(e2), "ph.cross"),
        (lambda: ph.pga(3).e12, 'blades\\["e12"\\]'),
        (lambda: ph.pga(3).join, "P & Q"),
        (lambda: ph.Rotation, "polhode.Rotor"),
        (lambda: ph.Quaternion, "polhode.Rotor"),
        (lambda: ph.exp, "polhode.Multivector.exp"),
    ],
)
def test_names_of_other_libraries_are_errors_that_name_ours(use, remedy):
    with pytest.raises(AttributeError, match=f"; (write|see) .*{remedy}"):
        use()


@pytest.mark.parametrize("kind", [ph.Algebra, ph.PGA, ph.CGA])
@pytest.mark.parametrize("signature", [(3,), (3, 0, 1)])
def test_algebras_have_no_public_constructor(kind, signature):
    with pytest.raises(TypeError, match=r"has no public constructor; write (algebra|pga|cga)\("):
        kind(*signature)


def test_names_of_other_libraries_are_not_listed():
    R = ph.Rotor.identity()
    assert not hasattr(R, "as_quat")
    assert {"to_quaternion", "shape"} <= {*dir(R)}
    assert {"as_quat", "inv", "e12"}.isdisjoint(dir(R))
    with pytest.raises(TypeError, match=r"for the part of grade k \.grade\(k\)"):
        (1 + e1)(1)
