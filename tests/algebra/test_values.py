"""Values: constructors, comparison, indexing, copies, text, immutability."""

import copy
import pickle

import numpy as np
import pytest

import polhode as ph
from naive import GRADE_SETS, eight_of, ph_value
from polhode import I, e1, e2, e3
from values import EPS, SHAPES, numbers

# --- comparison


def test_equality_is_exact_and_over_all_grades():
    assert e1 == ph.multivector([0, 1, 0, 0, 0, 0, 0, 0])
    assert e1 != e1 * (1 + EPS)
    assert (e1 == e2) == np.False_
    assert 0 * e1 == 0 * I
    assert ph.scalar(0.0) == ph.scalar(-0.0)
    assert ph.vector([np.nan, 0, 0]) != ph.vector([np.nan, 0, 0])
    assert e1 * e2 == ph.bivector([0, 0, 1])


def test_equality_of_batches():
    A = ph.vector([[1, 0, 0], [0, 1, 0]])
    assert np.array_equal(e1 == A, [True, False])
    assert np.array_equal(e1 != A, [False, True])
    assert np.array_equal(e1 == A, [True, False])


def test_is_close_is_relative_to_the_larger_norm():
    assert (e1 * (1 + 0.9e-9)).is_close(e1)
    assert not (e1 * (1 + 1.1e-9)).is_close(e1)
    # |A − B| = 1e-12 in a component that is zero in one of them; the norm is 1.
    assert (e1 + 1e-12 * e2).is_close(e1)
    assert (e1 + 1e-12 * I).is_close(e1)
    assert not (1e-12 * e2).is_close(0)  # relative to its own norm it is far
    assert (1e-12 * e2).is_close(0, atol=1e-11)
    assert ph.scalar(0.0).is_close(0)
    assert not (2 * e1).is_close(e1, rtol=0.49)
    assert (2 * e1).is_close(e1, rtol=0.5)
    assert (1e-300 * e1).is_close(1e-300 * e1 * (1 + 1e-10))


def test_is_close_of_batches_and_non_finite_values():
    A = ph.vector([[1, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0], [-np.inf, 0, 0]])
    assert np.array_equal(A.is_close(A), [True, False, True, True])
    assert np.array_equal(A.is_close(-A), [False, False, False, False])
    assert np.array_equal(A.is_close(e1, atol=np.inf), [True, False, False, False])


def test_is_close_at_the_end_of_the_range():
    big = 1.7e308
    assert not ph.vector([big, big, 0]).is_close(ph.vector([big, 0.9 * big, 0]))
    assert not ph.vector([big, 0, 0]).is_close(ph.vector([-big, 0, 0]))


def test_is_close_rejects_other_types():
    with pytest.raises(TypeError, match="cannot compare a multivector with str"):
        e1.is_close("e1")


# --- batches as sequences


def test_indexing():
    eight = numbers((2, 3, 4, 8), 19)
    A = ph.multivector(eight)
    mask = eight[..., 0] > 0
    for index in [
        0,
        -1,
        (1, 2),
        (1, 2, 3),
        slice(None, None, 2),
        (slice(None), 1),
        (..., 0),
        (0, ..., 1),
        None,
        (slice(None), None, 2),
        [1, 0, 1],
        (slice(None), [0, 2]),
        (..., [3, 1]),
        ([0, 1], slice(None), [2, 3]),
        np.array([[0, 1], [1, 0]]),
        mask,
        (slice(None), slice(None, None, -1)),
        (),
        ...,
    ]:
        parts = index if isinstance(index, tuple) else (index,)
        full = parts if any(part is Ellipsis for part in parts) else (*parts, Ellipsis)
        expected = eight[(*full, slice(None))]
        picked = A[index]
        assert picked.shape == expected.shape[:-1]
        assert np.array_equal(eight_of(picked), expected)


@pytest.mark.parametrize(
    "index",
    [
        (slice(None), [0, 2]),
        (..., [1, 0]),
        (slice(None), slice(None, None, -1)),
        ([1, 0], slice(None)),
        (..., 1),
    ],
    ids=str,
)
@pytest.mark.parametrize("grades", GRADE_SETS)
def test_indexed_values_compute_like_others(index, grades):
    # For any memory order of the selection.
    eight = numbers((2, 3, 8), 20)
    eight[..., 0] += 40
    A = ph_value(eight, grades)[index]
    fresh = ph_value(np.ascontiguousarray(eight[(*index, slice(None))]), grades)
    assert np.all(fresh == A)
    assert np.array_equal(A.norm(), fresh.norm())
    assert np.all(fresh * fresh == A * A)
    assert np.all(A.exp() == fresh.exp())
    assert np.all((A + 50).inverse() == (fresh + 50).inverse())
    assert np.array_equal(ph.to_pauli(A), ph.to_pauli(fresh))
    R = ph.Rotor.random(A.shape, 1)
    assert np.all(R(A) == R(fresh))
    last, fresh_last = A[(-1,) * len(A.shape)], fresh[(-1,) * len(A.shape)]
    assert last * last == fresh_last * fresh_last
    assert last.dual() == fresh_last.dual()
    a, b = A.grade(1), fresh.grade(1)
    B = ph.bivector(np.ones(3))
    assert np.all(ph.Rotor.from_vectors(a + e1 * 40, e2) == ph.Rotor.from_vectors(b + e1 * 40, e2))
    angle = A.grade(0).components[..., 0]
    assert np.all(ph.Rotor.from_plane_angle(B, angle) == ph.Rotor.from_plane_angle(B, angle.copy()))


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("grades", GRADE_SETS)
@pytest.mark.parametrize("name", ["exp", "inverse", "log", "sqrt", "norm", "normalized", "__neg__"])
def test_functions_of_a_batch_are_those_of_its_values(name, grades, order):
    eight = numbers((2, 3, 8), 21) / 8
    eight[..., 0] += 5
    A = ph_value(np.array(eight, order=order), grades)
    if name in ("inverse", "log", "sqrt") and 0 not in grades and len(grades) > 1:
        A = A + 5  # away from null elements
    batch = getattr(A, name)()
    for index in np.ndindex(2, 3):
        single = getattr(A[index], name)()
        assert np.all(batch[index] == single), index


def test_indexing_errors_name_the_batch_shape():
    A = ph.vector(np.zeros((2, 3, 3)))
    for index in [2, (0, 3), (0, 0, 0), 1.5]:
        with pytest.raises(IndexError, match=r"batch shape \(2, 3\)"):
            A[index]
    with pytest.raises(IndexError, match=r"no batch to index, got \[0\]; .*components"):
        e1[0]


def test_iteration_and_length():
    A = ph.vector(numbers((3, 2, 3), 22))
    assert len(A) == 3
    items = list(A)
    assert len(items) == 3
    assert all(np.all(item == A[i]) and item.shape == (2,) for i, item in enumerate(items))
    assert len(ph.vector(np.zeros((0, 3)))) == 0
    assert list(ph.vector(np.zeros((0, 3)))) == []
    for operate in (lambda: len(e1), lambda: list(e1)):
        with pytest.raises(TypeError, match="no length"):
            operate()


def test_items_of_rotors_are_rotors():
    R = ph.Rotor.random((3,), 1)
    assert isinstance(R[0], ph.Rotor)
    assert all(isinstance(item, ph.Rotor) for item in R)


def test_float_of_a_scalar():
    assert float(ph.scalar(2.5)) == 2.5
    # The square of a vector holds a bivector, which is exactly 0.
    assert float((2 * e1 + e2) * (2 * e1 + e2)) == 5
    assert float(ph.multivector([1.0, 0, 0, 0, 0, 0, 0, 0])) == 1
    for value in (e1, ph.scalar([1.0, 2.0]), 1 + e1, 1 + 1e-300 * e1):
        with pytest.raises(TypeError, match="only a single scalar converts to float"):
            float(value)


# --- copies and immutability


@pytest.mark.parametrize(
    "A", [e1, 2 + e1 * e2, ph.vector(np.ones((2, 3))), ph.Rotor.random((2,), 2)], ids=repr
)
def test_pickle_and_copy(A):
    for twin in (
        *(pickle.loads(pickle.dumps(A, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)),
        copy.copy(A),
        copy.deepcopy(A),
    ):
        assert type(twin) is type(A)
        assert twin.grades == A.grades
        assert np.all(twin == A)
        assert np.array_equal(twin.components, A.components)


def test_values_are_immutable():
    A = ph.vector(np.ones((2, 3)))
    with pytest.raises(AttributeError, match="immutable"):
        A.shape = (3,)
    with pytest.raises(AttributeError, match="immutable"):
        A.e4 = 1
    A.components[0] = 5
    A[0].components[0] = 5
    with pytest.raises(TypeError):
        A[0] = e1
    assert np.all(ph.vector([1, 1, 1]) == A)


def test_values_do_not_share_the_callers_array():
    numbers_in = np.ones((2, 3))
    A, s, R = ph.vector(numbers_in), ph.scalar(numbers_in), ph.Rotor.from_components(np.ones((2, 4)))
    numbers_in[:] = 7
    assert numbers_in.flags.writeable
    assert np.all(ph.vector([1, 1, 1]) == A)
    assert np.all(s == 1)
    assert np.all(ph.Rotor.from_components([1, 1, 1, 1]) == R)


def test_a_mapped_value_has_coefficients():
    A = ph.vector([[1.5, 2, 3]])
    assert A.map(np.rint).dtype == A.map(lambda c: c.astype(int)).dtype == np.float64
    for f in (np.isnan, lambda c: c.astype(str)):
        with pytest.raises(TypeError, match="what the function returns must be real numbers"):
            A.map(f)
    exact = ph.vector([1, 2, 3], dtype=object)
    for f in (lambda _: 1j, str, lambda _: None):
        with pytest.raises(TypeError, match=r"what the function returns must be real numbers .*index \(0,\)"):
            exact.map(f)


def test_numpy_functions_reject_values():
    A, R = ph.vector(np.ones((2, 3))), ph.Rotor.identity()
    for name, f, *given in (
        ("sum", np.sum, A),
        ("dot", np.dot, R, e1),
        ("array_equal", np.array_equal, A, A),
        ("allclose", np.allclose, A, np.ones(2)),
        ("stack", np.stack, [e1, e2]),
        ("linalg.norm", np.linalg.norm, A),
    ):
        with pytest.raises(TypeError, match=rf"^np\.{name} does not accept multivectors.*components"):
            f(*given)


def test_in_place_operators_create_new_values():
    value = before = e1
    value += e2
    assert before == e1
    assert value == e1 + e2
    array = np.array([1.0, 2.0])
    with pytest.raises(TypeError):  # the array would have to become a multivector
        array += value


def test_multivectors_have_neither_hash_nor_constructor():
    with pytest.raises(TypeError, match="unhashable"):
        hash(e1)
    with pytest.raises(TypeError, match=r"use ph\.scalar, ph\.vector"):
        ph.Multivector()
    with pytest.raises(TypeError, match=r"Rotor has no public constructor; use Rotor\.from_") as refused:
        ph.Rotor([1, 0, 0, 0])
    assert "ph.vector" not in str(refused.value)


# --- text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (2 * e1 + 3 * e2 * e3, "2 e1 + 3 e2∧e3"),
        (e1, "e1"),
        (-e1, "-e1"),
        (e1 - e2, "e1 - e2"),
        (-1 - I, "-1 - I"),
        (ph.scalar(1.0), "1"),
        (ph.scalar(-2.5), "-2.5"),
        (0 * e1, "0"),
        (-0.0 * e1, "0"),
        (
            ph.multivector([1, 2, 3, 4, 5, 6, 7, 8]),
            "1 + 2 e1 + 3 e2 + 4 e3 + 5 e2∧e3 + 6 e3∧e1 + 7 e1∧e2 + 8 I",
        ),
        (-0.5 * e3 * e1 + 1e-20 * I, "-0.5 e3∧e1 + 1e-20 I"),
        (ph.scalar(1 / 3) - 2e10 / 3 * e1, "0.33333333 - 6.6666667e+09 e1"),
        (ph.vector([np.nan, np.inf, -np.inf]), "nan e1 + inf e2 - inf e3"),
        (ph.Rotor.identity(), "1"),
        (ph.vector([[1, 0, 0], [0, -2, 0]]), "Multivector of shape (2,):\n[e1,\n -2 e2]"),
        (ph.vector(np.zeros((0, 3))), "Multivector of shape (0,):\n[]"),
        (ph.scalar(np.arange(6.0)), "Multivector of shape (6,):\n[0,\n 1,\n 2,\n 3,\n 4,\n 5]"),
        (ph.scalar(np.arange(9.0)), "Multivector of shape (9,):\n[0,\n 1,\n 2,\n 3,\n 4,\n …,\n 8]"),
        (ph.scalar(np.ones((2, 1))), "Multivector of shape (2, 1):\n[1,\n 1]"),
        (ph.Rotor.identity((2,)), "Rotor of shape (2,):\n[1,\n 1]"),
    ],
    ids=repr,
)
def test_repr(value, text):
    assert repr(value) == text
    assert str(value) == text


# --- constructors


def test_constructors_and_their_shapes():
    for make, size, grades in [
        (ph.vector, 3, (1,)),
        (ph.bivector, 3, (2,)),
        (ph.multivector, 8, (0, 1, 2, 3)),
    ]:
        for shape in SHAPES:
            value = make(np.ones((*shape, size), dtype=np.int16))
            assert value.shape == shape
            assert value.grades == grades
            assert value.components.shape == (*shape, size)
            assert value.dtype == np.float64
    for make, grades in [(ph.scalar, (0,)), (ph.trivector, (3,))]:
        for shape in SHAPES:
            value = make(np.ones(shape))
            assert value.shape == shape
            assert value.grades == grades
            assert value.components.shape == (*shape, 1)


@pytest.mark.parametrize(
    ("make", "size"), [(ph.vector, 3), (ph.bivector, 3), (ph.multivector, 8), (ph.Rotor.from_components, 4)]
)
def test_wrong_shapes_are_errors(make, size):
    for shape in [(), (size + 1,), (size - 1,), (0,), (size, 1), (2, size + 1)]:
        with pytest.raises(ValueError, match=rf"needs {size} components in the last axis, got shape"):
            make(np.ones(shape))


@pytest.mark.parametrize("make", [ph.scalar, ph.vector, ph.bivector, ph.trivector, ph.multivector])
@pytest.mark.parametrize(
    "bad",
    [
        np.ones(8, dtype=bool),
        np.array([None] * 8),
        ["a", "b", "c"],
        "abc",
        None,
        np.array(["2020-01-01"], dtype="datetime64[D]"),
        [e1, e2, e3],
        e1,
    ],
    ids=lambda bad: type(bad).__name__ + getattr(bad, "dtype", np.dtype(object)).str,
)
def test_wrong_types_are_errors(make, bad):
    with pytest.raises(TypeError, match="must be real numbers"):
        make(bad)


def test_ragged_lists_are_errors():
    with pytest.raises(TypeError, match="unequal lengths"):
        ph.vector([[1, 2, 3], [1, 2]])


def test_fortran_ordered_and_strided_arrays():
    table = numbers((5, 6), 23)
    for array in (np.asfortranarray(table[:, :3]), table[:, ::2], table.T[:3].T, table[::-1, 3:]):
        value = ph.vector(array)
        assert np.array_equal(value.components, array)
        assert np.array_equal((value * 1).components, array)
        assert np.array_equal(value.norm(), np.sqrt(np.sum(array**2, axis=-1)))


@pytest.mark.parametrize("dtype", [np.float32, object, complex])
def test_constructors_take_a_type(dtype):
    space = ph.algebra(3)
    for name, given in {"scalar": 2, "vector": [1, 2, 3], "bivector": [1, 2, 3], "trivector": 2}.items():
        value = getattr(ph, name)(given, dtype=dtype)
        assert value.dtype == dtype, name
        assert value == getattr(ph, name)(given)
    assert ph.multivector(range(8), dtype=dtype).dtype == dtype
    assert space.multivector(range(8), dtype=dtype).dtype == dtype
    assert space.pseudoscalar(1, dtype=dtype).dtype == dtype
