"""Convert values to and from other libraries; docs/translations.md gives the signs.

Our components are over ``1, e1, e2, e3, e2e3, e3e1, e1e2, I``; the peers write ``e13 = −e3e1``. Each library
is imported when it is used, so that a missing one leaves its column empty.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import polhode as ph

ROTOR = [0, 4, 5, 6]

# Index of our component, and its sign, over 1, e1, e2, e3, e12, e13, e23, e123 ...
_CANONICAL = [0, 1, 2, 3, 6, 5, 4, 7]
# ... and over 1, e1, e2, e12, e3, e13, e23, e123, where the bits of the index are the generators.
_BITS = [0, 1, 2, 6, 3, 5, 4, 7]
_SIGNS = np.array([1.0, 1, 1, 1, 1, -1, 1, 1])


def eight_of(value: Any) -> Any:
    """All components (..., 8) of a value of ours."""
    return np.concatenate([value.grade(k).components for k in range(4)], axis=-1)


def rotor_of(eight: Any) -> Any:
    """The rotor components among eight."""
    return eight[..., ROTOR]


def even(four: Any) -> Any:
    """Eight components from a rotor's four."""
    eight = np.zeros((*np.shape(four)[:-1], 8))
    eight[..., ROTOR] = four
    return eight


def odd(point: Any) -> Any:
    """Eight components from a vector's three."""
    eight = np.zeros((*np.shape(point)[:-1], 8))
    eight[..., 1:4] = point
    return eight


def table() -> Any:
    """Return the product of G3 as numbers (8, 8, 8): the k-th component of blade i times blade j."""
    basis = ph.multivector(np.eye(8))
    return np.stack([(blade * basis).components for blade in basis])


def _to_canonical(eight: Any) -> Any:
    return np.asarray(eight)[..., _CANONICAL] * _SIGNS


_of_canonical = _to_canonical  # an involution


def _to_bits(eight: Any) -> Any:
    return np.asarray(eight)[..., _BITS] * _SIGNS


def _of_bits(components: Any) -> Any:
    return (np.asarray(components) * _SIGNS)[..., np.argsort(_BITS)]


def clifford(eight: Any) -> Any:
    """Return a clifford MultiVector, or an MVArray of them for a batch."""
    from clifford import MVArray
    from clifford.g3 import layout

    values = _to_canonical(eight)
    if values.ndim == 1:
        return layout.MultiVector(values)
    return MVArray([layout.MultiVector(value) for value in values])


def of_clifford(value: Any) -> Any:
    """Undo `clifford`."""
    return _of_canonical(value.value)


@cache
def kingdon_algebra() -> Any:
    """Return kingdon's algebra of 3-d space, which caches compiled functions."""
    from kingdon import Algebra

    return Algebra(3)


def kingdon(eight: Any, kind: str = "multivector") -> Any:
    """Return a kingdon value of the kind ``multivector``, ``vector``, ``bivector`` or ``bireflection``."""
    held = {"multivector": slice(None), "vector": slice(1, 4), "bivector": slice(4, 7), "bireflection": ROTOR}
    values = np.moveaxis(_to_canonical(eight), -1, 0)[held[kind]]
    data = values.tolist() if values.ndim == 1 else np.ascontiguousarray(values)
    return getattr(kingdon_algebra(), kind)(data)


def of_kingdon(value: Any) -> Any:
    """Undo `kingdon`; its batch axes trail."""
    held = dict(value.items())
    shape = np.shape(next(iter(held.values())))
    order = value.algebra.canon2bin.values()
    return _of_canonical(np.stack([np.broadcast_to(held.get(key, 0.0), shape) for key in order], axis=-1))


@cache
def _galaga_algebra() -> Any:
    from galaga import Algebra

    return Algebra((1, 1, 1))


def galaga(eight: Any) -> Any:
    """Return a galaga Multivector; galaga does not support batches."""
    from galaga import Multivector

    return Multivector(_galaga_algebra(), _to_bits(eight))


def of_galaga(value: Any) -> Any:
    """Undo `galaga`."""
    return _of_bits(value.data)


@cache
def _gasparse_algebra() -> Any:
    from gasparse import GA

    return GA(3)


def gasparse(eight: Any) -> Any:
    """Return a gasparse mvarray of full multivectors."""
    return _gasparse_algebra().mvarray(_to_bits(eight).tolist(), grades=[0, 1, 2, 3])


def of_gasparse(value: Any) -> Any:
    """Undo `gasparse`."""
    return _of_bits(value.tolist()[0])


def quaternion(rotors: ph.Rotor) -> Any:
    """Return a numpy-quaternion, or an array of them for a batch."""
    from quaternion import as_quat_array

    return as_quat_array(rotors.to_quaternion(order="wxyz"))[()]


def pure_quaternion(xyz: Any) -> Any:
    """Return quaternions without a scalar part."""
    from quaternion import from_vector_part

    return from_vector_part(np.asarray(xyz))[()]


def of_quaternion(value: Any) -> Any:
    """Rotor components of numpy-quaternions: ``w − x e2e3 − y e3e1 − z e1e2``."""
    from quaternion import as_float_array

    return as_float_array(value) * np.array([1.0, -1, -1, -1])


def of_scipy(rotation: Any, like: ph.Rotor) -> Any:
    """Rotor components of a SciPy Rotation; it does not keep the sign, which is taken from `like`."""
    rotors = ph.Rotor.from_scipy(rotation).components
    return rotors * np.sign((rotors * like.components).sum(axis=-1, keepdims=True))


def of_pauli(matrices: Any) -> Any:
    """Eight components of 2×2 matrices."""
    return eight_of(ph.from_pauli(matrices))
