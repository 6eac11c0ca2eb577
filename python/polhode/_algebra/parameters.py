"""Rotors from axis and angle, Rodrigues parameters, Davenport angles and multivectors."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _generic, _native
from polhode._algebra.angles import DEGREE, in_degrees, to_degrees, to_radians
from polhode._algebra.coefficients import as_coefficients, kind_of, number_like
from polhode._algebra.constructors import from_axial, one_grade, vector
from polhode._algebra.grades import held, with_grades
from polhode._algebra.masking import Errors, masked
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import (
    Array,
    as_floats,
    at_index,
    first_index,
    is_float,
    power_of_two,
    require_components,
)
from polhode._support.calls import explains_calls

if TYPE_CHECKING:
    from polhode._algebra.rotor import Rotor
else:  # the same type; `polhode._algebra.rotor` adds its methods
    from polhode._native import Rotor

_EVEN = 0b0101
# How far from a right angle neighbouring axes may be, as in SciPy.
_RIGHT_ANGLE = 1e-7


# --- axis and angle


def from_axis_angle(axis: Any, angle: Any, degrees: bool = False, *, errors: Errors = "raise") -> Rotor:
    """Turn by `angle` about `axis`, in the right-handed sense: ``exp(−I n θ/2)``, n of length 1.

    A ValueError for an axis of zero length, with its batch index, or NaN with ``errors="mask"``.

    Parameters
    ----------
    axis
        Vectors, or an array (..., 3); their length is ignored.
    angle
        Angles (...) in radians, or degrees; batch shapes broadcast. Of any size: a rotor distinguishes turns
        up to 4π.

    Examples
    --------
    >>> R = ph.Rotor.from_axis_angle([0, 0, 1], 60, degrees=True)
    >>> R(ph.e1)
    0.5 e1 + 0.8660254 e2
    >>> ph.Rotor.from_axis_angle(ph.e3, [0, np.pi / 3])(ph.e1)
    Multivector of shape (2,):
    [e1,
     0.5 e1 + 0.8660254 e2]
    """
    if errors != "raise":
        return masked(errors, lambda n, theta: from_axis_angle(n, theta, degrees), (axis, 1), (angle, 0))
    scale = 1.0 if degrees is False or not in_degrees(degrees) else DEGREE
    if (found := _native.rotor_from_turn(axis, 1, angle, scale)) is not None:
        return found
    if isinstance(axis, Real) and isinstance(angle, list | tuple | np.ndarray):
        raise ValueError(f"the axis comes first: write Rotor.from_axis_angle({angle!r:.60}, {axis!r})")
    given = (
        one_grade(axis, 1, "the axis") if isinstance(axis, Multivector) else vector(_triples(axis, "an axis"))
    )
    if is_float(given._data):
        unusable = ~np.isfinite(given._data).all(axis=-1) | (given._data == 0).all(axis=-1)
        if unusable.any():
            index = first_index(unusable)
            found = given._data[index].tolist()
            raise ValueError(f"the axis{at_index(index)} is {found}; it must be finite and not zero")
    turn = _radians(angle, degrees) if degrees else number_like(angle, "angle", given._data)
    return Rotor.from_plane_angle(from_axial(given), turn)


def angle(R: Rotor) -> Any:
    """The angle of the rotation in [0, π], in radians: the same for R and −R.

    A float, or an array of the batch shape; accurate for small angles and near π, too. `plane_angle` returns
    the angle of the rotor, to 2π.

    Examples
    --------
    >>> R = ph.Rotor.from_axis_angle(ph.e3, [30, 330], degrees=True)
    >>> np.degrees(R.angle).round(6)
    array([30., 30.])
    """
    if (found := _native.rotor_to("angle", R)) is not None:
        return found[()]
    if not is_float(R._data):
        return _generic.rotors.angle(kind_of(R._data), R._data)
    return R.canonical().plane_angle()[1]


@explains_calls(degrees="np.degrees(R.angle)")
def magnitude(R: Rotor) -> Any:
    """Return the angle of the rotation in [0, π], as SciPy's method of this name: `angle`.

    Examples
    --------
    >>> print(ph.Rotor.from_rotation_vector([0, 0, 0.5]).magnitude().round(6))
    0.5
    """
    return angle(R)


# --- modified Rodrigues parameters


def from_mrp(mrp: Any, *, errors: Errors = "raise") -> Rotor:
    """From modified Rodrigues parameters (..., 3), ``tan(θ/4)`` along the axis; an array or vectors.

    The rotor is the square of ``1 − I p`` divided by its norm, which turns by θ/2. A ValueError for NaN and
    infinity, or NaN with ``errors="mask"``.

    Examples
    --------
    >>> R = ph.Rotor.from_mrp([0, 0, np.tan(np.pi / 12)])
    >>> print(np.degrees(R.angle).round(6))
    60.0
    """
    if errors != "raise":
        return masked(errors, from_mrp, (mrp, 1))
    p = one_grade(mrp, 1, "the parameters")._data if isinstance(mrp, Multivector) else mrp
    p = _triples(p, "modified Rodrigues parameters")
    kind = kind_of(p)
    x, y, z = (p[..., k] for k in range(3))
    half = Rotor.from_components(kind.stack([kind.zeros_like(x) + 1, -x, -y, -z]))
    return half * half


def to_mrp(R: Rotor) -> Any:
    """Return modified Rodrigues parameters (..., 3), ``tan(θ/4)`` along the axis, of length at most 1.

    Examples
    --------
    >>> R = ph.Rotor.from_rotation_vector([0.1, 0.2, 0.2])
    >>> R.to_mrp().round(6)
    array([0.025047, 0.050094, 0.050094])
    >>> print(np.tan(0.3 / 4).round(6))
    0.075141
    """
    data = R.canonical()._data
    s, x, y, z = (data[..., k] for k in range(4))
    kind = kind_of(s)
    return kind.stack([kind.divide(-part, 1 + s) for part in (x, y, z)])


# --- Davenport angles


def from_davenport(axes: Any, order: str, angles: Any, degrees: bool = False) -> Rotor:
    """From Davenport angles: turns about one to three axes, neighbours perpendicular; named as in SciPy.

    Parameters
    ----------
    axes
        Vectors (..., n) or an array (..., n, 3), n = 1 to 3, or (3,) for a single axis; lengths are ignored.
    order
        ``"extrinsic"`` or ``"e"``: the axes are fixed in space; ``"intrinsic"`` or ``"i"``: they turn with
        the body.
    angles
        Array (..., n) in radians, or degrees, one for each axis; for one axis a single angle need not be an
        array. Batch shapes broadcast with those of the axes.

    Examples
    --------
    >>> R = ph.Rotor.from_davenport([ph.e3, ph.e1, ph.e3], "intrinsic", [0.1, 0.2, 0.3])
    >>> bool(R.is_close(ph.Rotor.from_euler("ZXZ", [0.1, 0.2, 0.3])))
    True
    """
    unit, intrinsic = _davenport_axes(axes, (1, 2, 3)), _intrinsic(order)
    theta = _radians(angles, degrees)
    if not theta.shape:
        theta = theta[None]
    count = unit.shape[-2]
    if theta.shape[-1] != count:
        needed = "1 axis needs 1 angle" if count == 1 else f"{count} axes need {count} angles"
        raise ValueError(f"{needed} in the last axis, got shape {tuple(theta.shape)}")
    turns = [from_axis_angle(unit[..., k, :], theta[..., k]) for k in range(count)]
    # Turns about axes of the body are the same turns about fixed axes in the opposite order.
    total, *others = turns[::-1] if intrinsic else turns
    for turn in others:
        total = turn * total
    return total.astype(theta.dtype) if is_float(theta) else total


def to_davenport(R: Rotor, axes: Any, order: str, degrees: bool = False) -> Any:
    """Return Davenport angles (..., 3), in radians or degrees, about three axes as in `from_davenport`.

    The first and third lie in [−π, π], the second in [−λ, π − λ] for the angle λ in [−π, π] from the first
    axis to the third about the second (for turns about fixed axes: from the third to the first), or, where
    λ < 0, in [−π − λ, −λ]. At the ends of its range, in gimbal lock, the third angle is 0. There the three
    angles still give the attitude, so there is no warning.

    Examples
    --------
    >>> axes = [ph.e3, ph.e1, ph.e3]
    >>> R = ph.Rotor.from_davenport(axes, "intrinsic", [0.1, 0.2, 0.3])
    >>> R.to_davenport(axes, "intrinsic").round(6)
    array([0.1, 0.2, 0.3])
    """
    first, second, third = np.moveaxis(_davenport_axes(axes, (3,)), -2, 0)
    intrinsic = _intrinsic(order)
    if not intrinsic:  # the same turns about axes of the body, in the opposite order
        first, third = third, first
    # The third axis is the first one turned by λ about the second, so that R times this turn is a product of
    # turns about the first, second and first axis.
    sine, cosine = (second * np.cross(first, third)).sum(axis=-1), (first * third).sum(axis=-1)
    lead: Any = np.arctan2(sine, cosine)
    sign: Any = np.where(lead < 0, -1.0, 1.0)
    symbolic = kind_of(R._data).exact and any(map(_generic.exact.is_symbolic, R._data.flat))
    if symbolic:
        numbers = (first, second, third, sine, cosine, sign)
        first, second, third, sine, cosine, sign = map(_as_symbols, numbers)
        lead = np.frompyfunc(_generic.exact.atan2, 2, 1)(sine, cosine)
    second, lead = sign[..., np.newaxis] * second, sign * lead
    frame = Rotor.from_matrix(np.stack([np.cross(second, first), second, first], axis=-1))
    proper = ~frame * R * from_axis_angle(second, lead) * frame
    angles = proper.to_euler("ZYZ" if intrinsic else "zyz")
    alpha, beta, gamma = (angles[..., k] for k in range(3))
    if not symbolic and not lead.shape:
        sign, lead = float(sign), float(lead)
    elif not isinstance(angles, np.ndarray):
        sign, lead = map(kind_of(angles).asarray, (sign, lead))
    found = kind_of(angles).stack([alpha, sign * (beta - lead), gamma])
    if is_float(R._data):
        found = found.astype(R.dtype)
    return to_degrees(found) if in_degrees(degrees) else found


def _as_symbols(x: Any) -> Any:
    """Return whole numbers as SymPy's; a TypeError for others, with which angles would not be exact."""
    import sympy

    if (np.round(x) != x).any():
        raise TypeError(
            "Davenport angles of SymPy expressions need axes along e1, e2 and e3; for others substitute "
            "numbers and convert the rotor with .astype(float)"
        )
    return np.asarray(np.frompyfunc(lambda value: sympy.Integer(int(value)), 1, 1)(x), dtype=object)


def _davenport_axes(axes: Any, lengths: tuple[int, ...]) -> Array:
    """Return unit axes (..., n, 3); a ValueError unless neighbours are perpendicular."""
    given = one_grade(axes, 1, "the axes")._data if isinstance(axes, Multivector) else axes
    if isinstance(given, list | tuple):
        given = [row.components if isinstance(row, Multivector) else row for row in given]
    array = np.atleast_2d(as_floats(given, "the axes"))
    count = "three" if lengths == (3,) else "one to three"
    if array.shape[-1] != 3 or array.shape[-2] not in lengths:
        raise ValueError(f"Davenport angles need {count} axes, an array (..., n, 3), got shape {array.shape}")
    usable = np.isfinite(array).all(axis=-1) & array.any(axis=-1)
    if not usable.all():
        *batch, k = first_index(~usable)
        found = array[(*batch, k)].tolist()
        raise ValueError(f"axis {k}{at_index(tuple(batch))} is {found}; it must be finite and not zero")
    scaled = array / power_of_two(array, -1)
    unit: Array = scaled / np.linalg.norm(scaled, axis=-1, keepdims=True)
    cosines = (unit[..., :-1, :] * unit[..., 1:, :]).sum(axis=-1)
    oblique = np.abs(cosines) > _RIGHT_ANGLE
    if oblique.any():
        *batch, k = index = first_index(oblique)
        raise ValueError(
            f"axes {k} and {k + 1}{at_index(tuple(batch))} must be perpendicular; the cosine of their angle "
            f"is {cosines[index]:.3g}"
        )
    return unit


def _intrinsic(order: str) -> bool:
    if order not in ("e", "extrinsic", "i", "intrinsic"):
        raise ValueError(f'order must be "extrinsic" ("e") or "intrinsic" ("i"), got {order!r}')
    return order[0] == "i"


# --- multivectors


def from_multivector(M: Multivector, *, tolerance: float = 0.1, errors: Errors = "raise") -> Rotor:
    """From an even multivector of 3-d space whose norm is near 1, divided by its norm.

    For sums and products that were rotors but for rounding or a small step, such as ``R − ½ R Ω dt``. Odd
    grades must be absent or zero. A ValueError if the norm differs from 1 by more than `tolerance`, which is
    mostly a mistake: pass ``M.normalized()`` if it is not. With ``errors="mask"`` such rows are NaN.

    Examples
    --------
    One step of ``R' = −½ R Ω``, which leaves the norm near 1:

    >>> R, Omega, dt = ph.Rotor.identity(), ph.e1 ^ ph.e2, 0.01
    >>> M = R - R * Omega * dt / 2
    >>> print(M.norm().round(8))
    1.0000125
    >>> print(ph.Rotor.from_multivector(M).angle.round(6))
    0.01
    """
    if errors != "raise":
        return masked(errors, lambda x: from_multivector(x, tolerance=tolerance), (M, 1))
    if isinstance(M, Rotor):
        return M
    if not isinstance(M, Multivector):
        raise TypeError(f"from_multivector needs a multivector, got {type(M).__name__}")
    if M.algebra.signature != (3, 0, 0):
        raise TypeError(f"a rotor is a value of 3-d space, got one of {M.algebra}")
    if held(M) & ~_EVEN:
        odd = [k for k in M.grades if k % 2]
        raise ValueError(f"a rotor is even, with the grades 0 and 2; got grades {M.grades}; remove {odd}")
    even = Multivector._of(with_grades(M, _EVEN), _EVEN)
    _require_near_one(even, tolerance)
    return Rotor.from_components(even._data)


def _require_near_one(even: Multivector, tolerance: float) -> None:
    """Raise a ValueError where the norm is known and too far from 1."""
    size, kind = even.norm(), kind_of(even._data)
    if kind.exact:
        numbers = [x if isinstance(x, float | int) else _known(x) for x in np.ravel(size)]
        size = np.array(numbers, float).reshape(even.shape)
    message = "the norm of a rotor is 1, got {}; use M.normalized() if any norm is meant"
    if isinstance(size, float | np.ndarray):
        far = ~(np.abs(np.asarray(size) - 1) <= tolerance)
        if far.any():
            index = first_index(far)
            found = message.format(f"{np.asarray(size)[index]:.6g}")
            raise ValueError(f"at index {index}: {found}" if index else found)
    else:
        kind.require(kind.abs(size - 1) <= tolerance, message.format("another one"))


def _known(x: Any) -> float:
    """Return a number as a float; 1 for an expression without a value, which passes."""
    try:
        return float(x)
    except TypeError:
        return 1.0


# --- helpers


def _triples(values: Any, what: str) -> Any:
    data = as_coefficients(values, what)
    require_components(data.shape, 3, what)
    return data


def _radians(angle: Any, degrees: bool) -> Any:
    theta = as_coefficients(angle, "angle")
    return to_radians(theta) if in_degrees(degrees) else theta
