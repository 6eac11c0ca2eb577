"""Rotors from and to rotation matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import as_coefficients, reshaped
from polhode._algebra.masking import Errors, masked
from polhode._algebra.rotor_rows import computed
from polhode._support.arrays import Array, at_index, first_index, is_float

if TYPE_CHECKING:
    from polhode._algebra.rotor import Rotor
else:  # the same type; `polhode._algebra.rotor` adds its methods
    from polhode._native import Rotor


def from_matrix(m: Any, nearest: bool = False, *, errors: Errors = "raise") -> Rotor:
    """From rotation matrices (..., 3, 3) acting on columns; the nearest rotation, within 1e-4 of one.

    A ValueError for a reflection or anything farther off. The rotor's scalar part is >= 0.

    With ``nearest=True``, from any matrices M of NumPy floats: the rotation Q of the smallest
    ``Σ (M − Q)²``, for a singular value decomposition ``M = U S Vᵀ`` the matrix
    ``U diag(1, 1, det U Vᵀ) Vᵀ`` (Kabsch, Acta Cryst. A 34 (1978)). A ValueError, with the batch index,
    where it is not unique: where the two smallest singular values are 0, or equal in a reflection.

    Examples
    --------
    >>> R = ph.Rotor.from_matrix([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    >>> R(ph.e1)
    0.6 e1 + 0.8 e2
    """
    if errors != "raise":
        return masked(errors, lambda rows: from_matrix(rows, nearest), (m, 2))
    if nearest:
        return _from_any_matrix(m, True)
    try:
        found = _native.rotor_from("matrix", m)
        return found if found is not None else _from_any_matrix(m, False)
    except ValueError as error:
        if "not a rotation matrix" not in str(error):
            raise
        message = f"{error}, or take the nearest rotation with nearest=True"
    raise ValueError(message)


def _from_any_matrix(m: Any, nearest: bool) -> Rotor:
    """Return rotors of matrices that the native function does not cover."""
    matrices = as_coefficients(m, "rotation matrix")
    if tuple(matrices.shape[-2:]) != (3, 3):
        remedy = "; write RigidTransform.from_matrix(M)" if tuple(matrices.shape[-2:]) == (4, 4) else ""
        raise ValueError(f"a rotation matrix has shape (..., 3, 3), got {tuple(matrices.shape)}{remedy}")
    if nearest:
        matrices = _nearest_rotation(matrices)
    if is_float(matrices):
        matrices = matrices.reshape((*matrices.shape[:-2], 9))
    return Rotor._from_rows(computed("from_matrix", matrices))


def to_matrix(R: Rotor) -> Any:
    """Return rotation matrices (..., 3, 3) acting on columns.

    Examples
    --------
    The turn by 120° about e1 + e2 + e3 takes each axis to the next; the columns are the turned axes:

    >>> R = ph.Rotor.from_quaternion([1, 1, 1, 1], order="wxyz")
    >>> R.to_matrix()
    array([[0., 0., 1.],
           [1., 0., 0.],
           [0., 1., 0.]])
    """
    if (found := _native.rotor_to("matrix", R)) is not None:
        return found
    return reshaped(computed("to_matrix", R._data), (*R.shape, 3, 3))


def _nearest_rotation(m: Any) -> Array:
    """Return the nearest rotations to any matrices."""
    if not is_float(m):
        raise TypeError(
            f"the nearest rotation needs NumPy floats, got {type(m).__name__} of {m.dtype}; convert exact "
            "numbers with dtype=float, other arrays with np.asarray"
        )
    finite = np.isfinite(m).all(axis=(-2, -1))
    if not finite.all():
        where = at_index(first_index(~finite))
        raise ValueError(
            f"the matrix{where} has an entry that is NaN or infinite; remove such matrices first"
        )
    u, sizes, v = np.linalg.svd(m.astype(np.float64))
    sign = np.sign(np.linalg.det(u @ v))
    unique = sizes[..., 1] + sign * sizes[..., 2] > 8 * np.finfo(m.dtype).eps * sizes[..., 0]
    if not unique.all():
        index = first_index(~unique)
        kind = "reflection" if sign[index] < 0 else "matrix"
        raise ValueError(
            f"the nearest rotation to the matrix{at_index(index)} is not unique: it is a {kind} of singular "
            f"values {sizes[index].tolist()}"
        )
    u[..., 2] *= sign[..., np.newaxis]
    rotations: Array = (u @ v).astype(m.dtype)
    return rotations
