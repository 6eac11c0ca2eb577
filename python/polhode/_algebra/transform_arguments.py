"""Arguments of transforms: parts, points and other transforms, and the errors for anything else."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from polhode._algebra.algebra import algebra
from polhode._algebra.coefficients import namespace, require_real
from polhode._algebra.constructors import one_grade
from polhode._algebra.euclidean import vector_in
from polhode._algebra.foreign_values import remedy_for
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._algebra.transform_batches import TransformBatch
from polhode._support.arrays import Shape


def required(value: Any, what: str) -> TransformBatch:
    """Return a transform; a TypeError, with the function that converts, for anything else."""
    if isinstance(value, TransformBatch):
        return value
    if isinstance(value, Rotor):
        remedy = "; write RigidTransform.from_rotation(R)"
    elif _is_matrix(value):
        remedy = "; write RigidTransform.from_matrix(M)"
    else:
        remedy = remedy_for(value)
    raise TypeError(f"{what} must be a RigidTransform, got {type(value).__name__}{remedy}")


def refuse(left: object, operator: str, right: object) -> NoReturn:
    """Raise a TypeError for an operator whose operands are not two transforms joined by ``*``."""
    named = [_named(left, "S"), _named(right, "T")]
    if None not in named:
        raise TypeError(f"transforms are joined by *, of two transforms; write {named[0]} * {named[1]}")
    other = left if named[0] is None else right
    remedy = remedy_for(other) or "; write T.apply(x) to move points"
    raise TypeError(f"{operator} of a RigidTransform needs another one, got {type(other).__name__}{remedy}")


def _named(value: object, name: str) -> str | None:
    """Return what to write for an operand that is a transform or converts to one."""
    if isinstance(value, TransformBatch):
        return name
    if isinstance(value, Rotor):
        return "RigidTransform.from_rotation(R)"
    return "RigidTransform.from_matrix(M)" if _is_matrix(value) else None


def _is_matrix(value: object) -> bool:
    shape = getattr(value, "shape", None)
    return not isinstance(value, Multivector) and isinstance(shape, tuple) and shape[-2:] == (4, 4)


def as_vector(value: Any, what: str) -> Multivector:
    """Return real vectors of 3-d space from vectors or an array (..., 3)."""
    given = (
        one_grade(value, 1, what) if isinstance(value, Multivector) else vector_in(algebra(3), value, what)
    )
    require_real(given._data, what)
    return given


def spread(value: Any, shape: Shape) -> Any:
    """Return a rotor or a vector repeated over a batch shape."""
    if value.shape == shape:
        return value
    data = namespace(value._data).broadcast_to(value._data, (*shape, value._data.shape[-1]))
    return value._like(np.ascontiguousarray(data) if isinstance(data, np.ndarray) else data)


def not_a_rotor(rotor: Any, translation: Any) -> TypeError:
    """Return the error for a transform whose first argument is not a rotor."""
    if isinstance(translation, Rotor):
        return TypeError("the rotor comes first: write RigidTransform(R, x)")
    return TypeError(
        f"rotor must be a Rotor, got {type(rotor).__name__}; write Rotor.from_matrix(M) for matrices "
        "(..., 3, 3), RigidTransform.from_matrix(M) for (..., 4, 4), from_translation(x) without a rotor; "
        "see from_components and from_scipy for values of SciPy"
    )


def as_rotor(rotation: Any) -> Rotor:
    """Return a rotor from itself or a Rotation of SciPy."""
    if isinstance(rotation, Rotor):
        return rotation
    if not hasattr(rotation, "as_quat"):
        raise TypeError(
            f"the rotation must be a Rotor or a Rotation of SciPy, got {type(rotation).__name__}; write "
            "Rotor.from_matrix(M) for matrices (..., 3, 3)"
        )
    return Rotor.from_scipy(rotation)
