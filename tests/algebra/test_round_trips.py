"""Values are restored bit for bit from pickles, copies, arrays and JSON; malformed ones raise."""

import copy
import json
import pickle
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from polhode import I, e1, e2

CGA = ph.algebra(4, 1)
AWKWARD = [-0.0, np.nan, np.inf, -np.inf, 5e-324, 1.7976931348623157e308, 0.1, -1 / 3]
F = Fraction

VALUES = {
    "vector": e1,
    "awkward": ph.multivector(AWKWARD),
    "batch": ph.multivector(np.arange(48.0).reshape(2, 3, 8) / 7),
    "empty": ph.vector(np.zeros((0, 3))),
    "empty in another axis": ph.bivector(np.zeros((2, 0, 3))),
    "single precision": ph.vector(np.array([[0.1, -0.0, np.nan]], dtype=np.float32)),
    "one of single precision": ph.bivector(np.array([0.1, 2, 3], dtype=np.float32)),
    "sparse": 2 + e1 * e2 + 3 * I,
    "rotor": ph.Rotor.random(rng=1),
    "rotors": ph.Rotor.random((2, 3), 2),
    "no rotors": ph.Rotor.identity((0,)),
    "rotors of single precision": ph.Rotor.random((3,), 3).astype(np.float32),
    "fractions": ph.vector([F(1, 3), 2, -F(10**40, 7)]),
    "whole numbers": ph.multivector(np.array([10**30, 0, -1, 2, 3, 4, 5, 6], dtype=object)),
    "exact and floats": ph.vector(np.array([F(1, 3), 0.1, -0.0], dtype=object)),
    "fraction batch": ph.scalar(np.array([[F(1, 3)], [F(2, 7)]], dtype=object)),
    "no fractions": ph.vector(np.zeros((0, 3), dtype=object)),
    "exact rotor": ph.Rotor.from_components([F(1), F(2), F(2), F(4)]),
    "conformal": CGA.multivector(np.arange(32.0)),
    "conformal batch": CGA.k_vector(3, np.arange(20.0).reshape(2, 10) / 3),
    "of no generators": ph.algebra(0).scalar(0.1),
    "no grade but I": ph.algebra(8).pseudoscalar([1.5, -0.0]),
}
each = pytest.mark.parametrize("A", VALUES.values(), ids=VALUES)


def bits(M):
    """A key that is equal only for values equal to the bit."""
    data = M.components
    if data.dtype == object:
        return [(type(x), repr(x)) for x in data.flat]
    return data.tobytes()


def require_own_components(A):
    """The caller may change the array of components."""
    handed_out = A.components
    handed_out[...] = 0
    assert handed_out.flags.writeable
    assert not np.shares_memory(handed_out, A._data)


def require_same(twin, A):
    assert type(twin) is type(A)
    assert twin.algebra is A.algebra
    assert twin.grades == A.grades
    assert twin.shape == A.shape
    assert twin.dtype == A.dtype
    assert bits(twin) == bits(A)
    require_own_components(twin)


@each
@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickle(A, protocol):
    require_same(pickle.loads(pickle.dumps(A, protocol)), A)


@each
def test_copies(A):
    require_same(copy.copy(A), A)
    require_same(copy.deepcopy(A), A)
    require_same(copy.deepcopy([A, {"A": A}])[1]["A"], A)


@each
def test_pickled_slices_contain_only_the_slice(A):
    large = ph.multivector(np.ones((10_000, 8)))
    assert len(pickle.dumps(large[:2], 5)) < 1000
    assert len(pickle.dumps(large[5], 5)) < 1000


@each
def test_arrays_on_disk(A, tmp_path):
    if A.dtype == object:
        pytest.skip("NumPy pickles objects")
    np.save(tmp_path / "a.npy", A.components)
    data = np.load(tmp_path / "a.npy")
    assert data.flags.writeable
    again = A._of(data, A._mask, A.algebra)
    assert bits(again) == bits(A)
    mapped = np.load(tmp_path / "a.npy", mmap_mode="r") if data.size else data
    assert bits(A._of(mapped, A._mask, A.algebra) * 1) == bits(again * 1)


@each
def test_json(A):
    text = json.dumps(ph.to_dict(A))
    require_same(ph.from_dict(json.loads(text)), A)
    assert json.dumps(ph.to_dict(ph.from_dict(json.loads(text)))) == text


def test_the_fields():
    assert ph.to_dict(ph.vector([F(1, 3), 2, -1])) == {
        "algebra": [3, 0, 0],
        "grades": [1],
        "rotor": False,
        "shape": [],
        "dtype": "object",
        "components": ["1/3", 2, -1],
    }
    fields = ph.to_dict(ph.Rotor.identity((2,)))
    assert fields["rotor"] is True
    assert fields["shape"] == [2]
    assert fields["components"] == [[1, 0, 0, 0], [1, 0, 0, 0]]


def fields(**changed):
    return {**ph.to_dict(2 + e1 * e2), **changed}


@pytest.mark.parametrize(
    ("malformed", "error"),
    [
        ({}, "missing: .*'algebra'"),
        ({k: v for k, v in fields().items() if k != "grades"}, r"missing: \['grades'\]"),
        (fields(algebra=[3, 0]), "three counts"),
        (fields(algebra=[-3, 0, 0]), "counts >= 0"),
        (fields(algebra=[3, 0, 9]), "at most 8"),
        (fields(grades=[]), "grades must rise"),
        (fields(grades=[2, 0]), "grades must rise"),
        (fields(grades=[0, 0]), "grades must rise"),
        (fields(grades=[0, 4]), "grades must rise"),
        (fields(grades=[-1]), "grades must rise"),
        (fields(shape=[2]), "do not fit 4 components"),
        (fields(shape=[0]), "do not fit 4 components"),
        (fields(shape=[-1]), None),
        (fields(shape=[-1, -1]), None),
        (fields(shape=[1.0]), None),
        (fields(shape="()"), None),
        (fields(dtype="int64"), "dtype must be one of float64, float32, complex128, complex64, object"),
        (fields(dtype="O"), "dtype must be one of"),
        (fields(dtype=None), "dtype must be one of"),
        (fields(components=[1, 2, 3]), "do not fit 3 components"),
        (fields(components=[[1, 2], [3]]), None),
        (fields(components=["a", 2, 3, 4]), None),
        (fields(components=["1/0", 2, 3, 4]), None),
        (fields(components=[None, 2, 3, 4]), None),
        (fields(components=[True, 2, 3, 4]), None),
        (fields(components=[{}, 2, 3, 4]), None),
        (fields(components=5), "do not fit 1 components"),
        (fields(rotor=True, components=[0, 0, 0, 0]), None),
        (fields(rotor=True, grades=[1, 3]), r"rotor must have algebra Cl\(3\) and grades \[0, 2\]"),
        (fields(rotor=True, algebra=[2, 0, 0], components=[1, 0]), "a rotor must have"),
        (fields(algebra="300"), None),
        (fields(algebra=None), None),
        (fields(grades=None), None),
        (fields(grades=["0", "2"]), None),
        (fields(rotor="yes"), None),
    ],
)
def test_malformed_fields_raise(malformed, error):
    with pytest.raises(ValueError, match=error):
        ph.from_dict(malformed)


@pytest.mark.parametrize("bad", [None, 3, "text", [1, 2]])
def test_to_dict_rejects_other_types(bad):
    with pytest.raises((TypeError, ValueError)):
        ph.from_dict(bad)
    with pytest.raises(TypeError, match="to_dict needs a multivector"):
        ph.to_dict(bad)


def test_values_that_json_cannot_hold_raise():
    sympy = pytest.importorskip("sympy")
    with pytest.raises(TypeError, match=r"a component is x \(Symbol\), which JSON cannot hold"):
        ph.to_dict(sympy.Symbol("x") * e1)


def test_arrays_of_other_libraries_are_pickled():
    jnp = pytest.importorskip("jax.numpy")
    A = ph.vector(jnp.asarray([1.0, 2.0, 3.0], dtype="float32"))
    twin = pickle.loads(pickle.dumps(A))
    assert type(twin.components) is type(A.components)
    assert bool(twin == A)
    assert ph.from_dict(json.loads(json.dumps(ph.to_dict(A)))) == ph.vector([1, 2, 3])


def test_rotors_are_restored_bit_for_bit():
    R = ph.Rotor.random((5000,), 4)
    for rotors in (R, R * R, R.astype(np.float32)):
        require_same(ph.from_dict(ph.to_dict(rotors)), rotors)


def test_rotors_that_are_not_of_norm_1_are_divided_by_their_norm():
    assert ph.from_dict(fields(rotor=True, components=[0, 0, 0, 2])) == ph.bivector([0, 0, 1])
