"""Batches: shapes, output arrays, shared memory, precision, threads and the memory pool."""

import itertools
import math

import numpy as np
import pytest

import polhode as ph
from naive import GRADE_SETS, eight_of, ph_value
from polhode import I, e1, e2
from values import numbers

NAMES = [
    "geometric_product",
    "wedge",
    "dot",
    "commutator",
    "left_contraction",
    "right_contraction",
    "scalar_product",
]


def batch(shape, seed=1, grades=(0, 1, 2, 3), dtype=np.float64):
    return ph_value(numbers((*shape, 8), seed), grades).astype(dtype)


# --- shapes


@pytest.mark.parametrize("grades", GRADE_SETS, ids=str)
def test_reshape_stack_and_concatenate_match_numpy(grades):
    A, B = batch((2, 3), 1, grades), batch((2, 3), 2, grades)
    a, b = eight_of(A), eight_of(B)
    assert np.array_equal(eight_of(A.reshape(3, 2)), a.reshape(3, 2, 8))
    assert np.array_equal(eight_of(A.reshape((-1,))), a.reshape(6, 8))
    assert np.array_equal(eight_of(A.reshape(1, -1, 2)), a.reshape(1, 3, 2, 8))
    for axis in range(-3, 3):
        at = axis if axis >= 0 else axis - 1  # the component axis comes last
        assert np.array_equal(eight_of(ph.stack([A, B], axis=axis)), np.stack([a, b], axis=at))
    for axis in range(-2, 2):
        at = axis if axis >= 0 else axis - 1
        assert np.array_equal(eight_of(ph.concatenate([A, B], axis)), np.concatenate([a, b], axis=at))


def test_values_of_different_grades_and_precision_join():
    joined = ph.stack([e1, e1 * e2, I.astype(np.float32)])
    assert joined.grades == (0, 1, 2, 3)
    assert joined.dtype == np.float64
    assert [joined[k] == value for k, value in enumerate([e1, e1 * e2, I])] == [True] * 3
    assert ph.concatenate([joined.astype(np.float32)] * 2).dtype == np.float32


def test_stacks_of_rotors_are_rotors():
    R = ph.Rotor.random((3,), 1)
    assert type(ph.stack([R, R])) is ph.Rotor
    assert type(ph.concatenate([R, R])) is ph.Rotor
    assert type(R.reshape(3, 1)) is ph.Rotor
    assert type(ph.stack([R, 2 * R])) is ph.Multivector
    assert type(ph.stack(list(R))) is ph.Rotor


@pytest.mark.parametrize(
    ("operate", "error", "message"),
    [
        (lambda A: A.reshape(4), ValueError, r"shape \(2, 3\) cannot be reshaped to \(4,\)"),
        (lambda A: A.reshape(-1, -1), ValueError, "cannot be reshaped"),
        (lambda A: A.reshape(-1, 4), ValueError, "cannot be reshaped"),
        (lambda A: A.reshape(-1, 0), ValueError, "cannot be reshaped"),
        (lambda A: A.reshape(-6), ValueError, "cannot be reshaped"),
        (lambda A: A.reshape(-2, -3), ValueError, ""),
        (lambda A: A.reshape(6.0), TypeError, ""),
        (lambda A: ph.stack([]), ValueError, "at least one"),
        (lambda A: ph.stack([A, A[0]]), ValueError, r"one batch shape, got \(2, 3\) and \(3,\)"),
        (lambda A: ph.stack([A, 1]), TypeError, "item 1 is int"),
        (lambda A: ph.stack([A, A], axis=3), ValueError, "axis 3 is out of range for 3"),
        (lambda A: ph.stack([A, A], axis=-4), ValueError, "axis -4 is out of range"),
        (lambda A: ph.concatenate([e1, e1]), ValueError, "got single values; join them with ph.stack"),
        (lambda A: ph.concatenate([A, A[0]]), ValueError, "equal numbers of batch axes"),
        (lambda A: ph.concatenate([A, A], axis=2), ValueError, "axis 2 is out of range for 2"),
        (lambda A: ph.concatenate([A, A[:, :2]]), ValueError, "must agree except in axis 0"),
        (lambda A: A[0, 0, 0], IndexError, r"batch shape \(2, 3\)"),
        (lambda A: A * batch((4,)), ValueError, "broadcast"),
    ],
)
def test_incompatible_shapes_raise(operate, error, message):
    with pytest.raises(error, match=message or None):
        operate(batch((2, 3)))


def test_masks_and_empty_selections():
    A = batch((2, 3))
    mask = np.array([[True, False, True], [False, False, True]])
    assert np.array_equal(eight_of(A[mask]), eight_of(A)[mask])
    nothing = A[np.zeros((2, 3), bool)]
    assert nothing.shape == (0,)
    assert (nothing * e1).shape == (0,)
    assert nothing.grade(2).exp().shape == (0,)
    assert len(list(nothing)) == 0
    assert nothing.norm().shape == (0,)
    assert ph.concatenate([nothing, A[mask]]).shape == (3,)


# --- out=


def shapes_of_product(name, grades):
    A, B = batch((2, 1), 1, grades), batch((3,), 2, grades)
    return A, B, getattr(A, name)(B)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize(("name", "grades"), list(itertools.product(NAMES, [(1,), (0, 2), (0, 1, 2, 3)])))
def test_results_are_written_to_out(name, grades, dtype):
    A, B = batch((2, 1), 1, grades, dtype), batch((3,), 2, grades, dtype)
    expected = getattr(A, name)(B)
    out = np.full(expected.components.shape, np.nan, dtype)
    result = getattr(A, name)(B, out=out)
    assert np.array_equal(out, expected.components)
    assert np.all(result == expected)
    assert result.grades == expected.grades
    assert np.shares_memory(result._data, out)
    assert not result._data.flags.writeable
    assert out.flags.writeable
    out[...] = 7  # the caller's array is not frozen
    assert np.all(result.components == 7)


@pytest.mark.parametrize("name", NAMES)
def test_out_of_single_values(name):
    expected = getattr(e1 + I, name)(e2 + 2)
    out = np.empty(expected.components.shape)
    result = getattr(e1 + I, name)(e2 + 2, out=out)
    assert np.array_equal(out, expected.components)
    assert result == expected
    with pytest.raises(ValueError, match="out must be"):
        getattr(e1, name)(e2, out=np.empty((1, *out.shape)))


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_rotor_apply_writes_to_out(dtype):
    R, X = ph.Rotor.random((2, 1), 1).astype(dtype), batch((3,), 2, dtype=dtype)
    out = np.empty((2, 3, 8), dtype)
    result = R.apply(X, out=out)
    assert np.array_equal(out, R(X).components)
    assert np.shares_memory(result._data, out)
    S = ph.Rotor.random((3,), 2).astype(dtype)
    composed = R.geometric_product(S, out=np.empty((2, 3, 4), dtype))
    assert type(composed) is ph.Rotor
    assert np.all(composed == R * S)
    with pytest.raises(ValueError, match="out must be"):
        R.apply(X, out=np.empty((2, 3, 3), dtype))


def read_only():
    array = np.empty((3, 8))
    array.flags.writeable = False
    return array


@pytest.mark.parametrize(
    ("out", "error", "message"),
    [
        (lambda a: np.empty((2, 8)), ValueError, r"out must be float64 .*, got float64 of shape \(2, 8\)"),
        (lambda a: np.empty((3, 4)), ValueError, r"of shape \(3, 8\), got float64 of shape \(3, 4\)"),
        (lambda a: np.empty((1, 3, 8)), ValueError, "out must be"),
        (lambda a: np.empty((3, 8), np.float32), ValueError, "out must be float64 .* got float32"),
        (lambda a: np.empty((3, 8), np.int64), ValueError, "got int64"),
        (lambda a: np.empty((3, 8), object), ValueError, "got object"),
        (lambda a: np.empty((3, 8), ">f8"), ValueError, "got >f8"),
        (lambda a: np.empty((3, 8), order="F"), ValueError, "C order"),
        (lambda a: np.empty((3, 16))[:, ::2], ValueError, "C order"),
        (lambda a: read_only(), ValueError, "writable"),
        (lambda a: a, ValueError, "overlaps"),
        (lambda a: [[0.0] * 8] * 3, TypeError, "must be a NumPy array, got list"),
        (lambda a: e1, TypeError, "must be a NumPy array, got Multivector"),
    ],
)
def test_invalid_out_arrays_raise(out, error, message):
    a = numbers((3, 8), 1)
    A = ph.multivector(a, copy=False)
    kept = a.copy()
    with pytest.raises(error, match=message):
        A.geometric_product(e1 + I, out=out(a))
    with pytest.raises(error, match=message):
        ph.Rotor.identity(3).apply(A, out=out(a))
    assert np.array_equal(a, kept)


def test_out_that_overlaps_an_operand_raises():
    memory = np.zeros((5, 8))
    A = ph.multivector(memory[:3], copy=False)
    with pytest.raises(ValueError, match="overlaps"):
        A.geometric_product(e1, out=memory[2:])
    with pytest.raises(ValueError, match="overlaps"):
        e1.geometric_product(A, out=memory[2:])
    assert np.all(A.geometric_product(e1, out=np.ones((3, 8))) == 0)


def test_out_needs_floats():
    A = ph.vector(np.ones((2, 3)), dtype=object)
    with pytest.raises(TypeError, match="out needs factors of floats, got object"):
        A.wedge(e1, out=np.empty((2, 3)))


# --- memory


@pytest.mark.parametrize(
    ("make", "size"), [(ph.vector, 3), (ph.bivector, 3), (ph.multivector, 8), (ph.algebra(4, 1).vector, 5)]
)
def test_views_share_the_callers_array_and_are_read_only(make, size):
    array = np.ones((2, size))
    view, copy = make(array, copy=False), make(array)
    assert np.shares_memory(view._data, array)
    assert not np.shares_memory(copy._data, array)
    assert not view._data.flags.writeable
    assert array.flags.writeable
    view.components[0] = 2
    assert np.all(array == 1)
    array[:] = 5
    assert np.all(view.components == 5)
    assert np.all(copy.components == 1)


def test_results_do_not_share_the_callers_memory():
    array = numbers((4, 8), 3)
    A = ph.multivector(array)
    makers = [
        lambda: A * 1,
        lambda: A + 0,
        lambda: ~A,
        lambda: A.grade(1),
        lambda: A.astype(np.float32),
        lambda: A.astype(float),
        lambda: A.map(lambda x: x),
        lambda: A.map(np.negative),
        lambda: A.reshape(2, 2),
        lambda: ph.stack([A]),
        lambda: ph.scalar(array[:, 0]),
        lambda: ph.scalar(A.norm()),
        lambda: ph.Rotor.from_components(array[:, :4]),
    ]
    for make in makers:
        assert not make()._data.flags.writeable
        assert not np.shares_memory(make()._data, array)
        assert not np.shares_memory(make().components, make()._data)
    array[:] = 0
    assert not np.any(A.norm() == 0)


def test_map_copies_the_array_that_the_function_returns():
    own = numbers((2, 3), 4)
    kept = own.copy()
    A = ph.vector(np.zeros((2, 3))).map(lambda _: own)
    own[:] = 7
    assert np.array_equal(A.components, kept)


# --- precision


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("grades", GRADE_SETS, ids=str)
def test_single_precision_is_double_precision_rounded(name, grades):
    """Whole numbers below 2²⁴ are exact in both."""
    A, B = batch((5,), 5, grades), batch((5,), 6, grades)
    small = getattr(A.astype(np.float32), name)(B.astype(np.float32))
    assert small.dtype == np.float32
    assert np.all(small == getattr(A, name)(B))


@pytest.mark.parametrize("name", ["exp", "log", "inverse", "sqrt", "normalized", "norm", "norm_squared"])
def test_functions_in_single_precision_are_those_of_doubles_rounded(name):
    """They are computed in double precision, except sums of squares."""
    rng = np.random.default_rng(7)
    A = ph.multivector((rng.standard_normal((50, 8)) + 4 * np.eye(8)[0]).astype(np.float32))
    single, double = getattr(A, name)(), getattr(A.astype(float), name)()
    s, d = (getattr(x, "components", x) for x in (single, double))
    assert s.dtype == np.float32
    count = 1 if name in ("exp", "log", "inverse", "sqrt") else 8
    size = np.linalg.norm(d, axis=-1, keepdims=True) if d.ndim > 1 else d
    assert np.all(np.abs(s - d) <= count * 2.0**-24 * size * 1.001)


def test_astype():
    A = batch((2,))
    assert A.astype(np.float32).dtype == np.float32
    assert A.astype("float32").dtype == np.float32
    assert A.astype(np.float32).astype(float).dtype == np.float64
    R = ph.Rotor.random((3,), 1)
    assert type(R.astype(np.float32)) is ph.Rotor
    for bad in (int, np.float16, bool, np.longdouble, np.clongdouble, "U5"):
        with pytest.raises(TypeError, match="float64, float32, complex128, complex64 or object"):
            A.astype(bad)
    with pytest.raises(TypeError, match="quaternion"):
        A.astype("quaternion")


# --- threads: POLHODE_NUM_THREADS sets how many share the rows


ROWS = 210_001  # more rows than one thread takes, and not a multiple of any block


def work():
    rng = np.random.default_rng(8)
    A, B = ph.multivector(rng.standard_normal((ROWS, 8))), ph.multivector(rng.standard_normal((ROWS, 8)))
    a = ph.vector(rng.standard_normal((ROWS, 3)).astype(np.float32))
    R = ph.Rotor.random(ROWS, 9)
    return [
        A * B,
        A.wedge(B),
        a * a,
        R * R,
        R(A),
        R.log(),
        A.grade(2).exp(),
        (A + 9).inverse(),
        ph.scalar(A.norm()),
    ]


def test_results_do_not_depend_on_the_number_of_threads(monkeypatch):
    monkeypatch.setenv("POLHODE_NUM_THREADS", "1")
    alone = [value.components.tobytes() for value in work()]
    for threads in ("2", "7"):
        monkeypatch.setenv("POLHODE_NUM_THREADS", threads)
        for k, value in enumerate(work()):
            assert value.components.tobytes() == alone[k], (threads, k)


@pytest.mark.parametrize("bad", ["0", "-1", "two", "1.5", "", "99999999999999999999999"])
def test_invalid_numbers_of_threads_raise(monkeypatch, bad):
    monkeypatch.setenv("POLHODE_NUM_THREADS", bad)
    A = ph.multivector(np.ones((ROWS, 8)))
    with pytest.raises(ValueError, match=f'POLHODE_NUM_THREADS must be a positive whole number, got "{bad}"'):
        A * A


# --- the pool: memory of large results is reused after they are freed, not before


def large(seed):
    return ph.multivector(np.full((40_000, 8), float(seed)))


def test_results_outlive_later_results():
    A, one = large(1), ph.scalar(1.0)
    held = A * one
    kept = [held[10:20], held.components[5], held.grade(2), (A * 3)[7:9], (A * 5).components[::1000]]
    copies = [np.array(getattr(value, "components", value)) for value in kept]
    whole = np.array(held.components)
    for k in range(2, 60):
        other = large(k) * one
        del other
    for value, copy in zip(kept, copies, strict=True):
        assert np.array_equal(getattr(value, "components", value), copy)
    assert np.array_equal(held.components, whole)
    del held
    for k in range(60, 90):
        large(k) * one
    for value, copy in zip(kept, copies, strict=True):
        assert np.array_equal(getattr(value, "components", value), copy)


def test_live_results_have_separate_memory():
    one = ph.scalar(1.0)
    values = [large(k) * one for k in range(12)]
    for (i, a), (j, b) in itertools.combinations(enumerate(values), 2):
        assert not np.shares_memory(a._data, b._data), (i, j)
    assert [float(value.components[0, 0]) for value in values] == list(map(float, range(12)))
    assert all(math.isclose(value.components.std(), 0) for value in values)


def test_large_results_begin_at_a_cache_line():
    for rows in (40_000, 55_555, 123_457):  # from a megabyte on
        result = ph.vector(np.ones((rows, 3))) * e1
        assert result.components.ctypes.data % 64 == 0
        assert result.components.flags.c_contiguous


def test_sums_over_batch_axes():
    numbers = np.random.default_rng(8).normal(size=(2, 3, 4, 3))
    values = ph.vector(numbers)
    assert values.sum() == ph.vector(numbers.sum(axis=(0, 1, 2)))
    assert (values.sum(axis=1) == ph.vector(numbers.sum(axis=1))).all()
    assert (values.sum(axis=(0, -1)) == ph.vector(numbers.sum(axis=(0, 2)))).all()
    assert ph.e1.sum() == ph.e1
    assert not isinstance(ph.Rotor.random(3, 0).sum(), ph.Rotor)
    with pytest.raises(ValueError, match="batch axis 3 is out of range for 3 batch axes"):
        values.sum(axis=3)
