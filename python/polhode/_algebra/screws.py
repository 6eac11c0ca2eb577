"""Screws of motors and transforms: axis, angle and distance, and the adjoint matrix."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from polhode import _generic
from polhode._algebra.coefficients import kind_of
from polhode._algebra.constructors import cross, vector
from polhode._algebra.motors import is_motor, rows
from polhode._algebra.multivector import Multivector


class Screw(NamedTuple):
    """The screw of a displacement, a turn about an axis and a translation along it (Chasles' theorem).

    Attributes
    ----------
    axis
        Unit vector of 3-d space along the axis; of a pure translation its direction, of the identity e3.
    point
        The point of the axis nearest to the origin; of a pure translation the origin.
    angle
        Angle of the turn in [0, π], in radians, right-handed about `axis`.
    distance
        Translation along `axis`, of either sign, in the units of the points.

    Examples
    --------
    A quarter turn about the axis through e1 along e3, which climbs by 2, so by 8 in a full turn:

    >>> R = ph.Rotor.from_axis_angle(ph.e3, 90, degrees=True)
    >>> screw = ph.screw_parameters(ph.RigidTransform(R, [1, -1, 2]))
    >>> screw.axis, screw.point.components.round(6) + 0
    (e3, array([1., 0., 0.]))
    >>> print(np.degrees(screw.angle).round(6), screw.distance.round(6))
    90.0 2.0
    >>> print((2 * np.pi * screw.pitch).round(6))
    8.0
    """

    axis: Multivector
    point: Multivector
    angle: Any
    distance: Any

    @property
    def moment(self) -> Multivector:
        """The moment ``point × axis`` of the axis, the second half of its Plücker coordinates.

        Examples
        --------
        The axis through 2 e1 along e3:

        >>> shift = ph.RigidTransform.from_translation([2, 0, 0])
        >>> turn = ph.RigidTransform(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True))
        >>> screw = ph.screw_parameters(shift * turn * shift.inv())
        >>> screw.moment.components.round(6) + 0
        array([ 0., -2.,  0.])
        """
        return cross(self.point, self.axis)

    @property
    def pitch(self) -> Any:
        """Distance per angle, per radian; infinite for a pure translation, NaN where nothing moves.

        Examples
        --------
        A bolt that moves by 2 in half a turn moves by 4 in a full one:

        >>> T = ph.RigidTransform(ph.Rotor.from_axis_angle(ph.e3, 180, degrees=True), [0, 0, 2])
        >>> print((2 * np.pi * ph.screw_parameters(T).pitch).round(6))
        4.0
        """
        if kind_of(self.angle, self.distance).exact:
            return np.frompyfunc(_pitch, 2, 1)(self.distance, self.angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.distance / self.angle


def _pitch(distance: Any, angle: Any) -> Any:
    if _generic.exact.is_zero(angle):
        return float("nan") if _generic.exact.is_zero(distance) else float("inf")
    return _generic.exact.divide(distance, angle)


def screw_parameters(M: Any) -> Screw:
    """Return the screw of a motor or a `RigidTransform`: axis, its point, angle and distance.

    M moves by `distance` along the axis and turns by `angle` about it, right-handed: Chasles' theorem. M and
    −M have the same screw. Batches give batches; floats, SymPy expressions and arrays of JAX are kept.
    Derivatives of what the identity and pure translations do not determine are 0 there.

    A TypeError for any other value; a ValueError, with the batch index, where M is not a multiple of a motor.

    Examples
    --------
    >>> T = ph.RigidTransform.from_translation([0, 0, 3])
    >>> screw = ph.screw_parameters(T)
    >>> print(screw.axis, screw.distance)
    e3 3.0
    """
    kind, rows = _rows(M, "screw_parameters")
    axis, point, angle, distance = _generic.motors.screw(kind, rows)
    if kind.native:
        angle, distance = angle[()], distance[()]
    return Screw(vector(axis), vector(point), angle, distance)


def adjoint_matrix(M: Any) -> Any:
    """Return the matrices (..., 6, 6) by which a motor or a `RigidTransform` moves twists and screws.

    They act on rows of an angular velocity (or rotation vector) ω, then a velocity v of the origin: the
    order of `RigidTransform.as_exp_coords`, ``X = −½ I3 ω + ½ v∧n ↦ M X ~M`` with the null vector n. For
    ``y = R x ~R + x0`` they are ``[[R, 0], [[x0]ₓ R, R]]``: twists in body axes become twists in space.
    Wrenches, a moment and then a force, move by the inverse transpose. Errors and coefficients as in
    `screw_parameters`.

    Examples
    --------
    A spin of 1 rad/s about e3 through the point 2 e1 moves the origin at ``x0 × ω = −2 e2``:

    >>> T = ph.RigidTransform.from_translation([2, 0, 0])
    >>> ph.adjoint_matrix(T) @ [0, 0, 1, 0, 0, 0]
    array([ 0.,  0.,  1.,  0., -2.,  0.])
    """
    return _generic.motors.adjoint(*_rows(M, "adjoint_matrix"))


def _rows(M: Any, name: str) -> tuple[Any, Any]:
    """Return the arithmetic and the components (..., 8) of a motor."""
    value = M.to_motor() if hasattr(M, "to_motor") else M
    if not is_motor(value):
        raise TypeError(
            f"{name} needs a motor, an even element of ph.algebra(3, 0, 1), or a RigidTransform, got "
            + (f"{value!r}" if isinstance(value, Multivector) and not value.shape else type(value).__name__)
        )
    kind = kind_of(value._data)
    if kind.native and value.dtype == np.float32:
        kind = _generic.numeric.Numeric(np, np.float32)  # whose rounding M ~M may show
    return kind, kind.asarray(rows(value))
