"""Rotors from and to quaternions, also those of SciPy and numpy-quaternion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import taken
from polhode._algebra.masking import Errors, masked
from polhode._algebra.rotor_rows import components, computed
from polhode._support.extras import optional

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

    from polhode._algebra.rotor import Rotor
else:  # the same type; `polhode._algebra.rotor` adds its methods
    from polhode._native import Rotor

QuaternionOrder = Literal["wxyz", "xyzw"]


def from_quaternion(q: Any, *, order: QuaternionOrder, errors: Errors = "raise") -> Rotor:
    """From quaternions (..., 4), Hamilton's and active, divided by their norm.

    `order` is required, because libraries differ: "wxyz" (MuJoCo, SPICE) or "xyzw" (SciPy, ROS). A
    ValueError, with the batch index, for 0 and for values that are not finite.

    Examples
    --------
    A quarter turn about e3, ``cos 45° + k sin 45°``; its components need not have norm 1:

    >>> R = ph.Rotor.from_quaternion([1, 0, 0, 1], order="wxyz")
    >>> R
    0.70710678 - 0.70710678 e1∧e2
    >>> R == ph.Rotor.from_quaternion([0, 0, 1, 1], order="xyzw")
    True
    """
    if errors != "raise":
        return masked(errors, lambda rows: from_quaternion(rows, order=order), (q, 1))
    if order in ("wxyz", "xyzw") and (found := _native.rotor_from(order, q)) is not None:
        return found
    given = components(q, 4, "quaternion")
    return Rotor._from_rows(computed("from_quaternion", taken(given, places_of_wxyz(order))))


def from_scipy(rot: Rotation) -> Rotor:
    """From a ``scipy.spatial.transform.Rotation``.

    Examples
    --------
    >>> from scipy.spatial.transform import Rotation
    >>> ph.Rotor.from_scipy(Rotation.from_euler("z", 60, degrees=True))
    0.8660254 - 0.5 e1∧e2
    """
    if not hasattr(rot, "as_quat"):
        raise TypeError(f"from_scipy needs a scipy.spatial.transform.Rotation, got {type(rot).__name__}")
    return Rotor.from_quaternion(rot.as_quat(), order="xyzw")


def from_numpy_quaternion(q: Any) -> Rotor:
    """From quaternions of the package numpy-quaternion, one or an array (...), divided by their norm.

    Examples
    --------
    >>> import quaternion
    >>> ph.Rotor.from_numpy_quaternion(quaternion.x)  # ij = k, but e2e3 e3e1 = −e1e2
    -e2∧e3
    """
    quaternion = optional("quaternion", "quaternion", "from_numpy_quaternion")
    array = np.asarray(q)
    if array.dtype != np.dtype(quaternion.quaternion):
        raise TypeError(f"from_numpy_quaternion needs an array of dtype quaternion, got {array.dtype}")
    return Rotor.from_quaternion(quaternion.as_float_array(array), order="wxyz")


def to_scipy(R: Rotor) -> Rotation:
    """Return a ``scipy.spatial.transform.Rotation``.

    Examples
    --------
    >>> ph.Rotor.from_rotation_vector([0.1, 0.2, 0.3]).to_scipy().as_rotvec()
    array([0.1, 0.2, 0.3])
    """
    transform = optional("scipy.spatial.transform", "scipy", "to_scipy")
    rotation: Rotation = transform.Rotation.from_quat(R.to_quaternion(order="xyzw"))
    return rotation


def to_numpy_quaternion(R: Rotor) -> Any:
    """Return an array (...) of dtype quaternion, of the package numpy-quaternion.

    Examples
    --------
    >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi)
    >>> R.to_numpy_quaternion().vec
    array([0., 0., 1.])
    """
    quaternion = optional("quaternion", "quaternion", "to_numpy_quaternion")
    return quaternion.as_quat_array(R.to_quaternion(order="wxyz"))


def places_of_wxyz(order: str) -> list[int]:
    """Return the places of w, x, y, z in a quaternion of this order."""
    if order == "wxyz":
        return [0, 1, 2, 3]
    if order == "xyzw":
        return [3, 0, 1, 2]
    raise ValueError(f'the quaternion order must be "wxyz" or "xyzw", got {order!r}')
