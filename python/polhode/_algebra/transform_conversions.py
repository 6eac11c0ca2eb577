"""Transforms from and to matrices, exponential coordinates, dual quaternions, motors and SciPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.algebra import Algebra, algebra
from polhode._algebra.angles import to_radians
from polhode._algebra.coefficients import as_coefficients, common, kind_of, namespace, number_like
from polhode._algebra.constructors import cross, vector
from polhode._algebra.motors import columns, is_motor, of_columns, places
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._algebra.rotor_rows import triples
from polhode._support.arrays import is_float, power_of_two
from polhode._support.extras import optional

if TYPE_CHECKING:
    from scipy.spatial.transform import RigidTransform as ScipyTransform

    from polhode._algebra.transform import RigidTransform

_MOTORS = algebra(3, 0, 1)

# The rotor of a transform, and its translation (..., 3).
Parts = tuple[Rotor, Any]


# --- parts of a transform


def parts_of_matrix(matrix: Any, nearest: bool) -> Parts:
    """Return the parts of matrices (..., 4, 4)."""
    given = as_coefficients(matrix, "transformation matrix")
    if tuple(given.shape[-2:]) != (4, 4):
        rotates = tuple(given.shape[-2:]) == (3, 3)
        remedy = "; write RigidTransform(Rotor.from_matrix(M), x)" if rotates else ""
        raise ValueError(f"a transformation matrix has shape (..., 4, 4), got {tuple(given.shape)}{remedy}")
    last, row = given[..., 3, :], np.array([0.0, 0.0, 0.0, 1.0])
    message = "the last row of a transformation matrix must be (0, 0, 0, 1)"
    if isinstance(given, np.ndarray):
        wrong = (last != row).any(axis=-1)
        if wrong.any():
            raise ValueError(f"{message}, got {last[wrong][0].tolist()}")
    else:
        kind = kind_of(given)
        kind.require(kind.xp.all(last == kind.asarray(row), axis=-1), message)
    return Rotor.from_matrix(given[..., :3, :3], nearest), given[..., :3, 3]


def parts_of_exp_coords(exp_coords: Any) -> Parts:
    """Return the parts of the exponential of coordinates (..., 6)."""
    given = as_coefficients(exp_coords, "exponential coordinates")
    if not given.shape or given.shape[-1] != 6:
        raise ValueError(
            f"exponential coordinates need 6 components in the last axis, got shape {tuple(given.shape)}"
        )
    kind = kind_of(given)
    a, b, c, x, y, z = (kind.divide(given[..., k], -2 if k < 3 else 2) for k in range(6))
    zero = kind.zeros_like(a)
    # −½ of the plane of rotation and ½ v∧e4.
    motor = of_columns(_MOTORS, [zero, a, b, c, x, y, z, zero]).grade(2).exp()
    return _parts(motor, "the rotation of exponential coordinates")


def parts_of_screw(axis: Any, point: Any, angle: Any, distance: Any, degrees: bool) -> Parts:
    """Return the parts of a turn about the axis through a point with a translation along it."""
    rotor = Rotor.from_axis_angle(axis, angle, degrees)
    direction = vector(triples(axis, 1, "the axis")).normalized()
    theta = number_like(angle, "angle", direction._data)
    theta = to_radians(theta) if degrees else theta
    moved = number_like(distance, "distance", direction._data)
    # The velocity of the origin, if the motion takes unit time; its integral loses no digits at small angles.
    velocity = cross(vector(triples(point, 1, "the point")), direction) * theta + direction * moved
    parts = common((direction * theta)._data, velocity._data)
    xp = namespace(parts[0])
    return rotor, parts_of_exp_coords(xp.concat(xp.broadcast_arrays(*parts), axis=-1))[1]


def parts_of_dual_quat(dual_quat: Any, scalar_first: bool) -> Parts:
    """Return the parts of dual quaternions (..., 8) of any norm."""
    given = as_coefficients(dual_quat, "dual quaternion")
    if not given.shape or given.shape[-1] != 8:
        raise ValueError(f"a dual quaternion needs 8 components, got shape {tuple(given.shape)}")
    real, dual = ([given[..., k + i] for i in range(4)] for k in (0, 4))
    if not scalar_first:
        real, dual = [real[3], *real[:3]], [dual[3], *dual[:3]]
    (w, i, j, k), (a, b, c, d) = real, dual
    motor = of_columns(_MOTORS, [w, -i, -j, -k, b, c, d, a])
    return _parts(motor, "the real part of a dual quaternion")


def parts_of_motor(M: Multivector) -> Parts:
    """Return the parts of a motor of any norm."""
    if not isinstance(M, Multivector) or places(M.algebra) is None:
        raise TypeError("a motor is an even element of ph.algebra(3, 0, 1)")
    if not is_motor(M):
        raise ValueError(f"a motor is an even element, got the grades {M.grades}")
    return _parts(M, "the rotation part of a motor")


def _parts(M: Multivector, part: str) -> Parts:
    """Return the parts of an even element that need not have norm 1; `part` must not be 0."""
    w, yz, zx, xy, *_ = columns(M)
    kind = kind_of(w)
    if is_float(M._data):
        scale = power_of_two(np.stack([w, yz, zx, xy]), 0)[0]
        M, w, yz, zx, xy = M._like(M._data / scale[..., None]), *(x / scale for x in (w, yz, zx, xy))
    turn = of_columns(M.algebra, [w, yz, zx, xy, *[kind.zeros_like(w)] * 4])
    # M = (1 + ½ x0∧e4) R, with R of any norm.
    size = turn.norm_squared()
    if not kind.exact:
        positive = kind.asarray(size) > 0
        kind.require(positive & (kind.asarray(size) < np.inf), f"{part} must be finite and not 0")
    _, _, _, _, x, y, z, _ = columns(M * ~turn / size)
    rotor = Rotor.from_components(kind.stack([w, yz, zx, xy]))
    return rotor, kind.stack([2 * x, 2 * y, 2 * z])


# --- methods of transforms


def as_matrix(self: RigidTransform) -> Any:
    """Return matrices (..., 4, 4) that act on columns (x, y, z, 1).

    Examples
    --------
    >>> R = ph.Rotor.from_quaternion([1, 1, 1, 1], order="wxyz")
    >>> ph.RigidTransform(R, [5, 6, 7]).as_matrix()
    array([[0., 0., 1., 5.],
           [1., 0., 0., 6.],
           [0., 1., 0., 7.],
           [0., 0., 0., 1.]])
    """
    turn, moved = common(self.rotor.to_matrix(), self.translation._data)
    xp, kind = namespace(turn), kind_of(turn)
    upper = xp.concat([turn, moved[..., None]], axis=-1)
    zero = kind.zeros_like(upper[..., :1, :])
    one = kind.stack([zero[..., 0], zero[..., 0], zero[..., 0], zero[..., 0] + 1])
    return xp.concat([upper, one], axis=-2)


def as_exp_coords(self: RigidTransform) -> Any:
    """Return exponential coordinates (..., 6): rotation vector of at most π, then the velocity.

    Examples
    --------
    >>> ph.RigidTransform.from_exp_coords([0.1, 0.2, 0.3, 4, 5, 6]).as_exp_coords()
    array([0.1, 0.2, 0.3, 4. , 5. , 6. ])
    """
    screw = self._nearer().to_motor().log()
    _, a, b, c, x, y, z, _ = columns(screw)
    # Zeros are positive.
    return kind_of(screw._data).stack([0 - 2 * a, 0 - 2 * b, 0 - 2 * c, 2 * x, 2 * y, 2 * z])


def as_dual_quat(self: RigidTransform, *, scalar_first: bool = False) -> Any:
    """Return unit dual quaternions (..., 8): see `from_dual_quat`; R and −R give opposite ones.

    Examples
    --------
    >>> ph.RigidTransform.from_translation([2, 4, 6]).as_dual_quat(scalar_first=True).round(6) + 0
    array([1., 0., 0., 0., 0., 1., 2., 3.])
    """
    w, yz, zx, xy, x4, y4, z4, xyz4 = columns(self.to_motor())
    real, dual = [w, -yz, -zx, -xy], [xyz4, x4, y4, z4]
    if not scalar_first:
        real, dual = [*real[1:], real[0]], [*dual[1:], dual[0]]
    return kind_of(w).stack([*real, *dual])


def to_motor(self: RigidTransform, algebra: Algebra = _MOTORS) -> Multivector:
    """Return the motor ``M = (1 + ½ x0∧e4) R`` of ``ph.algebra(3, 0, 1)``, whose null vector is e4.

    ``M X ~M`` moves planes ``n + d e4``, those with ``n·x + d = 0``, and their intersections.
    ``M = exp(−½ B + ½ v∧e4)`` is a screw: a rotation vector dual to B, and the velocity v of the origin.
    `algebra` may be another one of three generators of square 1 and one of square 0, in any order, which
    then plays the role of e4.

    Examples
    --------
    >>> ph.RigidTransform.from_translation([2, 0, 0]).to_motor()
    1 + e1∧e4
    """
    if places(algebra) is None:
        raise ValueError(f"a motor needs an algebra of the signature (3, 0, 1), got {algebra}")
    turn, moved = common(self.rotor._data, self.translation._data)
    kind = kind_of(turn)
    w, yz, zx, xy = (turn[..., k] for k in range(4))
    shift = kind.divide(moved, 2)
    half = [shift[..., k] for k in range(3)]
    zero = kind.zeros_like(w)
    rotor = of_columns(algebra, [w, yz, zx, xy, *[zero] * 4])
    return of_columns(algebra, [zero + 1, *[zero] * 3, *half, zero]) * rotor


def to_scipy(self: RigidTransform) -> ScipyTransform:
    """Return a ``scipy.spatial.transform.RigidTransform`` (SciPy 1.16 or later).

    Examples
    --------
    >>> ph.RigidTransform.from_translation([1, 2, 3]).to_scipy().translation
    array([1., 2., 3.])
    """
    transform = optional("scipy.spatial.transform", "scipy", "to_scipy")
    if not hasattr(transform, "RigidTransform"):
        raise ImportError("to_scipy needs SciPy 1.16 or later, which has RigidTransform")
    result: ScipyTransform = transform.RigidTransform.from_components(
        self.translation.components, self.rotor.to_scipy()
    )
    return result
