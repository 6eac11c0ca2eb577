"""Arrays of bodies and inertias."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from polhode import _native
from polhode._mechanics.bodies import Body
from polhode._mechanics.inertia import Inertia


def bodies_of(body: Any) -> Any:
    """Return an object array of bodies or inertias from one or a nested sequence of them."""
    remedy = (
        "; for principal moments write ph.Inertia.from_principal_moments(i1, i2, i3), for a matrix "
        "ph.Inertia.from_matrix(J)"
    )
    return objects_of(body, (Body, Inertia), "body must be a Body or an Inertia", remedy)


def objects_of(values: Any, kinds: tuple[type, ...], what: str, remedy: str = "") -> Any:
    """Return an object array of one value or a nested sequence of values; a TypeError for other types."""
    array: Any = np.empty((), dtype=object)
    if isinstance(values, np.ndarray) and values.dtype != object:
        raise TypeError(f"{what}, got an array of {values.dtype}{remedy}")
    if not isinstance(values, list | tuple | np.ndarray):
        array[()] = values
    elif not isinstance(values, np.ndarray) and values and {*map(type, values)} <= {*kinds}:
        # np.array would look for sequences in each.
        return np.fromiter(values, object, len(values))
    else:
        array = np.array(values, dtype=object)
    if not types_of(array) <= {*kinds}:
        for index, one in np.ndenumerate(array):
            if not isinstance(one, kinds):
                where = f"at index {index}: " if index else ""
                raise TypeError(f"{where}{what}, got {type(one).__name__}{remedy}")
    return array


def types_of(array: Any) -> set[type]:
    """Return the types of the objects of an array."""
    return {*_native.types_of(array.ravel().tolist())}


def has(kind: type, array: Any) -> bool:
    """Return whether an array of objects has one of this type."""
    return any(issubclass(one, kind) for one in types_of(array))


def inertia_of(body: Any, held: bool) -> Any:
    """Return the inertia of a body, if it is held about the origin of its axes; anything else unchanged."""
    if not isinstance(body, Body):
        return body
    return body.inertia_about(0) if held else body.inertia


def mapped_objects(f: Callable[[Any], Any], array: Any) -> Any:
    """Return the object array of f(x) for each object x of an array."""
    result: Any = np.empty(array.shape, dtype=object)
    result.ravel()[:] = [f(one) for one in array.flat]
    return result
