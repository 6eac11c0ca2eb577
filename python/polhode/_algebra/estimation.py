"""Best attitudes: the mean of rotors, and the rotation between two sets of vectors."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from polhode._algebra.coefficients import as_coefficients, foreign_kind, kind_of
from polhode._algebra.constructors import one_grade, vector
from polhode._algebra.foreign_values import remedy_for
from polhode._algebra.grades import stack
from polhode._algebra.masking import Errors, masked
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Shape, is_float, lengths, power_of_two
from polhode._support.calls import explains_calls

_NO_MEAN = "the rotors have no mean: two attitudes are equally close to all of them"
_PARALLEL = (
    "the directions are all parallel, so the turn about them is not determined; give a second direction, or "
    "use Rotor.from_vectors for the shortest turn"
)
_MIRRORED = "b is a mirror image of a, and two rotations fit it equally well; check the signs of the vectors"

# --- the mean


# Bounds of the ratio of the lengths of a and b with which their differences are computed.
_RATIOS = (2.0**-400, 2.0**400)


@explains_calls
def mean(R: Any, weights: Any = None, axis: int | tuple[int, ...] | None = None) -> Rotor:
    """Return the mean attitude of a batch, for any signs: the Q that minimises ``Σ w |R − Q|²``.

    The eigenvector of the largest eigenvalue of ``Σ w r rᵀ`` over components r (Markley, Cheng, Crassidis &
    Oshman, J. Guid. Control Dyn. 30 (2007)); its scalar part is >= 0.
    A ValueError if a mean is not unique, as for half turns about three axes; while JAX traces, the result is
    then arbitrary. Arrays of other libraries keep their type; derivatives are correct up to third order.

    Parameters
    ----------
    R
        A batch of rotors, or a list of rotors; a single rotor is its own mean.
    weights
        Numbers >= 0 that broadcast to the batch shape; by default all are equal.
    axis
        Batch axis or axes to average over, as in NumPy; by default all of them, none for ``()``. The result
        has the batch shape of the others.

    Examples
    --------
    >>> R = ph.Rotor.from_axis_angle(ph.e3, [10, 30], degrees=True)
    >>> print(np.degrees(ph.mean(R).angle).round(6))
    20.0
    >>> print(np.degrees(ph.mean(R, weights=[3, 1]).angle).round(1))
    15.0
    """
    listed = isinstance(R, list | tuple) and R
    if remedy := remedy_for(R[0] if listed else R, "T.mean() for a batch T of transforms"):
        raise TypeError(f"mean needs rotors, got {type(R[0] if listed else R).__name__}{remedy}")
    rotors = stack(R) if listed else R
    if not isinstance(rotors, Rotor) or not all(rotors.shape):
        found = f"{R!r:.80}; see Rotor.from_quaternion, from_matrix and from_rotation_vector"
        if isinstance(rotors, Multivector) and rotors.algebra.signature == (3, 0, 1):
            found = "values of Cl(3,0,1); write RigidTransform.from_motor(M).mean().to_motor() for motors M"
        if isinstance(rotors, Rotor):
            found = f"a batch of shape {rotors.shape}"
        raise ValueError(f"mean needs rotors, at least one, got {found}")
    kind = _numbers(rotors, weights)
    xp, axes = kind.xp, _batch_axes(axis, len(rotors.shape))
    w = _usable_weights(kind, weights, rotors.shape)
    kept = tuple(k for k in range(len(rotors.shape)) if k not in axes)
    order, rest = (*kept, *axes), tuple(rotors.shape[k] for k in kept)
    rows = kind.asarray(rotors._data)
    rows = xp.reshape(xp.permute_dims(rows, (*order, len(order))), (*rest, -1, 4))
    weighted = rows
    if w is not None:
        column = xp.reshape(xp.permute_dims(w, order), (*rest, -1, 1))
        # By a power of two, so that sums neither overflow nor lose digits.
        weighted = (column / power_of_two(column, -2) if kind.native else column) * rows
    eps = float(np.finfo(rotors.dtype).eps) if is_float(rotors._data) else kind.eps

    def check(values: Any) -> None:
        kind.require(values[..., 3] - values[..., 2] > 8 * eps * values[..., 3], _NO_MEAN)

    best = _largest_eigenvector(kind, xp.matmul(xp.matrix_transpose(weighted), rows), check)
    result = Rotor.from_components(kind.where(best[..., :1] < 0, -best, best))
    return result.astype(rotors.dtype) if kind.native else result


def _numbers(rotors: Rotor, weights: Any) -> Any:
    """Return the arithmetic of rotors and weights; a TypeError for exact numbers."""
    kind = kind_of(rotors._data)
    if kind.exact:
        raise TypeError(
            f"mean needs floats, got rotors of {rotors.dtype}; convert exact numbers with .astype(float)"
        )
    others = None if weights is None else foreign_kind(weights)
    if others is not None and not others.exact:
        return kind_of(rotors._data, weights)
    return kind


def _usable_weights(kind: Any, weights: Any, shape: Shape) -> Any:
    """Return the weights in this shape, None if there are none; a ValueError unless they are >= 0."""
    if weights is None:
        return None
    given = as_coefficients(weights, "weights")
    message = "weights must be finite numbers >= 0, not all 0, that broadcast to {}, got {}"
    try:
        w = kind.xp.broadcast_to(kind.asarray(given), shape)
    except (ValueError, RuntimeError):
        raise ValueError(message.format(shape, f"shape {tuple(given.shape)}")) from None
    xp = kind.xp
    usable = xp.all(xp.isfinite(w) & (w >= 0))
    if math.prod(shape):
        usable = usable & xp.any(w > 0)
    kind.require(usable, message.format(shape, given))
    return w


def _batch_axes(axis: Any, count: int) -> tuple[int, ...]:
    if axis is None:
        return tuple(range(count))
    given = axis if isinstance(axis, tuple) else (axis,)
    try:
        places = tuple(map(operator.index, given))
    except TypeError:
        raise TypeError(f"axis must be a whole number, a tuple of them or None, got {axis!r}") from None
    if not all(-count <= k < count for k in places) or len({k % count for k in places}) < len(places):
        raise ValueError(f"axis {axis} does not name different axes of {count} batch axes")
    return tuple(k % count for k in places)


# --- alignment


class Alignment(NamedTuple):
    """The result of `align`.

    Attributes
    ----------
    rotor
        R, with scalar part >= 0.
    residual
        ``√(Σ w |b − R a ~R|²)``, in the units of the vectors for weights without a unit; without the pair of
        an infinite weight.
    covariance
        Array (..., 3, 3) in rad², in the axes of b: of the small rotation vector ε by which R is off, if the
        errors of each b have the variance 1/w per component. With equal unknown variances, take weights 1 and
        multiply by the variance.

    Examples
    --------
    >>> fit = ph.align(np.eye(3), [[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    >>> print(np.degrees(fit.rotor.angle).round(6), fit.residual.round(12))
    90.0 0.0
    >>> fit.covariance.diagonal().round(6)
    array([0.5, 0.5, 0.5])
    """

    rotor: Rotor
    residual: Any
    covariance: Any


@explains_calls(return_sensitivity="ph.align(a, b).covariance")
def align(a: Any, b: Any, weights: Any = None, *, errors: Errors = "raise") -> Alignment:
    """Return the rotation of a to b: the rotor R that minimises ``Σ w |b − R a ~R|²``.

    Wahba's problem, or Kabsch's for points relative to their centroids. The rotor is the eigenvector of the
    largest eigenvalue of Davenport's matrix (Keat, 1977; Markley & Mortari, J. Astronaut. Sci. 48 (2000)).
    SciPy's ``Rotation.align_vectors`` takes the target first: ``align_vectors(b, a)``.

    A ValueError, with the batch index, if the rotation is not unique: fewer than two directions, or b
    a mirror image of a for which two rotations fit equally well; with ``errors="mask"`` such rows are NaN.
    Arrays of JAX and other libraries keep their type and have derivatives.

    Parameters
    ----------
    a, b
        Vectors (..., n), or arrays (..., n, 3), n >= 2; batch shapes broadcast. Lengths count: a pair of
        twice the length has four times the weight.
    weights
        Numbers >= 0 that broadcast to the batch shape (..., n); 1 by default. Inverse variances make the
        covariance that of the attitude. One of each row (n,) of NumPy floats may be infinite, as in SciPy: R
        turns this a into the direction of its b, and fits the others by the angle about it.

    Returns
    -------
    Alignment
        The rotor (...), the residual (...) and the covariance (..., 3, 3) of the error in axes of b. A large
        covariance flags directions that are almost collinear.

    Examples
    --------
    Two directions on board and in space: the first pair says 40°, the second, with an error, 42°:

    >>> a = ph.vector([[1, 0, 0], [0, 1, 0]])
    >>> b = ph.Rotor.from_axis_angle(ph.e3, [40, 42], degrees=True)(a)
    >>> print(np.degrees(ph.align(a, b).rotor.angle).round(6))
    41.0
    >>> print(np.degrees(ph.align(a, b, weights=[3, 1]).rotor.angle).round(3))
    40.5
    """
    if errors != "raise":
        sets = [(_rows(a, "a"), 2), (_rows(b, "b"), 2)]
        sets += [] if weights is None else [(weights, 1)]
        return masked(errors, align, *sets)
    first, second = _rows(a, "a"), _rows(b, "b")
    given = [] if weights is None else [as_coefficients(weights, "weights")]
    kind = kind_of(first, second, *given)
    if kind.exact:
        raise TypeError("align needs floats; convert exact numbers with .astype(float)")
    xp = kind.xp
    shapes = f"{tuple(first.shape)} and {tuple(second.shape)}"
    if first.shape[-2] != second.shape[-2]:
        raise ValueError(f"a and b need equal numbers of vectors (..., n, 3), got shapes {shapes}")
    try:
        x, y = xp.broadcast_arrays(kind.asarray(first), kind.asarray(second))
    except (ValueError, RuntimeError):
        raise ValueError(f"batch shapes of a and b do not broadcast: (..., n, 3) are {shapes}") from None
    batch = tuple(x.shape[:-1])
    kind.require(xp.all(xp.isfinite(x) & xp.isfinite(y), axis=-1), "a vector is not finite; remove it first")
    if given and isinstance(given[0], np.ndarray) and np.isposinf(given[0].astype(float)).any():
        return _aligned_exactly(kind, x, y, given[0])
    w = _usable_weights(kind, weights, batch)
    weights = kind.zeros(batch) + 1.0 if w is None else w
    ratio: Any = 1.0
    if kind.native:
        # By powers of two, which round nothing, so that no product overflows or vanishes.
        units = [power_of_two(v, (-2, -1)) for v in (x, y)]
        weight = power_of_two(weights, -1)
        x, y, weights = x / units[0], y / units[1], weights / weight
        with np.errstate(over="ignore", under="ignore"):
            ratio = np.clip(units[0] / units[1], *_RATIOS)
    sizes = [xp.sqrt(xp.sum(xp.sum(weights[..., None] * v * v, axis=-1), axis=-1)) for v in (x, y)]

    def check(values: Any) -> None:
        _require_unique(kind, values, sizes[0] * sizes[1])

    rows = _largest_eigenvector(kind, _davenport_matrix(kind, _profile(xp, weights, x, y)), check)
    rotor = Rotor.from_components(rows)
    # The matrix holds squares of small angles between directions; differences recover what these lose.
    for _ in range(3 if kind.native else 0):
        covariance, turned = _linearized(kind, rotor, x, y, weights)
        slope = xp.sum(weights[..., None] * xp.linalg.cross(turned, y - ratio * turned), axis=-2)
        rotor = Rotor.from_rotation_vector(xp.matmul(covariance, slope[..., None])[..., 0]) * rotor
    covariance, turned = _linearized(kind, rotor, x, y, weights)
    if not kind.native:
        off = y - turned
        residual = xp.sqrt(xp.sum(weights * xp.sum(off * off, axis=-1), axis=-1))
        return Alignment(rotor.canonical(), residual, covariance)
    residual, covariance = _in_units(y, turned, weights, covariance, (*units, weight))
    return Alignment(rotor.canonical(), residual, covariance)


def _aligned_exactly(kind: Any, x: Any, y: Any, weights: Any) -> Alignment:
    """Return the alignment of pairs (..., n, 3) where one weight of each row is infinite.

    The turns that map this a to the direction n of its b differ by an angle φ about n. With the parts p of
    the other a, turned by one of them, and q of b perpendicular to n, the best φ is the angle of
    ``Σ w p·q + i Σ w n·(p x q)``, whose size is the curvature.
    """
    if not kind.native:
        raise TypeError("an infinite weight needs vectors of NumPy floats; convert others with np.asarray")
    # Infinite weights as 1: the others are checked below.
    exact = np.isposinf(weights.astype(float))
    checked = _usable_weights(kind, np.where(exact, 1.0, weights.astype(float)), x.shape[:-1])
    exact = np.broadcast_to(exact, checked.shape)
    kind.require(exact.sum(axis=-1) == 1, "if weights are infinite, one of each row must be")
    others = np.where(exact, 0.0, checked)
    first, target = ((v * exact[..., np.newaxis]).sum(axis=-2) for v in (x, y))
    sizes = lengths(np.stack([first, target]))
    kind.require((sizes > 0).all(axis=0), "a vector with an infinite weight is 0 and has no direction")
    axis = target / sizes[1][..., np.newaxis]
    shortest = Rotor.from_vectors(vector(first), vector(target))
    # By powers of two, which round nothing, so that no product overflows or vanishes.
    x, y = (np.where(exact[..., np.newaxis], 0.0, v) for v in (x, y))
    units, weight = [power_of_two(v, (-2, -1)) for v in (x, y)], power_of_two(others, -1)
    (x, y), others = (v / unit for v, unit in zip((x, y), units, strict=True)), others / weight
    n, turned = axis[..., np.newaxis, :], shortest[..., np.newaxis](vector(x)).components
    p, q = (v - (v * n).sum(axis=-1, keepdims=True) * n for v in (turned, y))
    cosine = (others * (p * q).sum(axis=-1)).sum(axis=-1)
    sine = (others * (n * np.cross(p, q)).sum(axis=-1)).sum(axis=-1)
    size = np.sqrt(
        (others * (x * x).sum(axis=-1)).sum(axis=-1) * (others * (y * y).sum(axis=-1)).sum(axis=-1)
    )
    curvature = np.hypot(cosine, sine)
    kind.require(curvature > 32 * kind.eps * size, _PARALLEL)
    rotor = Rotor.from_axis_angle(axis, np.arctan2(sine, cosine)) * shortest
    covariance = axis[..., :, np.newaxis] * axis[..., np.newaxis, :] / curvature[..., np.newaxis, np.newaxis]
    turned = rotor[..., np.newaxis](vector(x)).components
    residual, covariance = _in_units(y, turned, others, covariance, (*units, weight))
    return Alignment(rotor.canonical(), residual, covariance)


def _in_units(y: Any, turned: Any, weights: Any, covariance: Any, units: tuple[Any, ...]) -> tuple[Any, Any]:
    """Return residual and covariance of b and turned a (..., n, 3), and weights, divided by these units."""
    first, second, weight = units
    with np.errstate(over="ignore"):
        unit = np.maximum(first, second)
        off = y * (second / unit) - turned * (first / unit)
        residual = np.sqrt((weights * (off * off).sum(axis=-1)).sum(axis=-1))
        residual = residual * np.sqrt(weight[..., 0]) * unit[..., 0, 0]
        # In one step: the product of the units may be in range where parts of it are not.
        power = sum(np.frexp(size)[1] - 1 for size in (first, second, weight[..., None]))
        return residual, np.ldexp(covariance, -power)


def _rows(values: Any, what: str) -> Any:
    """Return the components (..., n, 3) of vectors, given as values, a list of values or an array."""
    if isinstance(values, list | tuple) and any(isinstance(x, Multivector) for x in values):
        values = stack(values)
    if isinstance(values, Multivector):
        values = one_grade(values, 1, what)._data
    data = as_coefficients(values, what)
    if len(data.shape) < 2 or data.shape[-1] != 3 or not data.shape[-2]:
        raise ValueError(
            f"{what} needs vectors (..., n) or an array (..., n, 3), got shape {tuple(data.shape)}; for one "
            "pair of directions write Rotor.from_vectors(a, b)"
        )
    return data


def _profile(xp: Any, weights: Any, x: Any, y: Any) -> Any:
    """``Σ w b aᵀ``."""
    return xp.matmul(xp.matrix_transpose(weights[..., None] * y), x)


def _davenport_matrix(kind: Any, profile: Any) -> Any:
    """Return the matrix (..., 4, 4) of the form ``Σ w b·(R a ~R)`` in the components of R."""
    (a, b, c), (d, e, f), (g, h, i) = ([profile[..., k, m] for m in range(3)] for k in range(3))
    # The bivector of a rotor is minus the axis of the quaternion, whose product with Σ w a x b appears here.
    p, q, r = f - h, g - c, b - d
    rows = [
        [a + e + i, p, q, r],
        [p, a - e - i, b + d, c + g],
        [q, b + d, e - a - i, f + h],
        [r, c + g, f + h, i - a - e],
    ]
    matrix: Any = kind.xp.stack([kind.stack(row) for row in rows], axis=-2)
    return matrix


def _linearized(kind: Any, rotor: Rotor, x: Any, y: Any, weights: Any) -> tuple[Any, Any]:
    """Return the inverse second derivative of ``½ Σ w |b − exp(ε) R a|²`` at ε = 0, and ``R a``."""
    xp = kind.xp
    turned = xp.matmul(x, xp.matrix_transpose(rotor.to_matrix()))
    gain = _profile(xp, weights, turned, y)
    symmetric = 0.5 * (gain + xp.matrix_transpose(gain))
    identity = xp.eye(3, dtype=kind.dtype, **kind.placed)
    trace = xp.sum(xp.sum(symmetric * identity, axis=-1), axis=-1)
    return xp.linalg.inv(trace[..., None, None] * identity - symmetric), turned


def _require_unique(kind: Any, values: Any, size: Any) -> None:
    """Raise a ValueError where the eigenvalues (..., 4) do not determine the rotation.

    With the singular values s1 >= s2 >= |s3| of ``Σ w b aᵀ``, the last with the sign of its determinant, they
    are s1 + s2 + s3, s1 − s2 − s3, s2 − s1 − s3 and s3 − s1 − s2.
    """
    rounding = 32 * kind.eps * size
    first, second, third = (values[..., k] for k in (3, 2, 1))
    kind.require(first + third > rounding, _PARALLEL)
    kind.require(first - second > rounding, _MIRRORED)


# --- eigenvectors


def _largest_eigenvector(d: Any, matrix: Any, check: Callable[[Any], None]) -> Any:
    """Return the unit eigenvector (..., n) of the largest eigenvalue; `check` sees them all, ascending.

    A library's own derivatives of eigenvectors need all eigenvalues to differ. Newton's method for
    ``K v = λ v, vᵀv = 1``, from a solution that counts as constant, needs it of the largest only. After k
    steps the derivatives are right up to the order 2^k − 1.
    """
    xp = d.xp
    values, vectors = xp.linalg.eigh(d.constant(matrix))
    check(values)
    v, value = vectors[..., -1], values[..., -1]
    if d.native:
        return v
    n = int(values.shape[-1])
    identity = xp.eye(n, dtype=matrix.dtype, **d.placed)
    for _ in range(2):
        image = xp.sum(matrix * v[..., None, :], axis=-1)
        column, zero = v[..., None], value[..., None, None] * 0.0
        upper = xp.concat([matrix - value[..., None, None] * identity, -column], axis=-1)
        lower = xp.concat([xp.matrix_transpose(column), zero], axis=-1)
        short = 0.5 * (1.0 - xp.sum(v * v, axis=-1))
        error = xp.concat([value[..., None] * v - image, short[..., None]], axis=-1)
        step = xp.linalg.solve(xp.concat([upper, lower], axis=-2), error[..., None])[..., 0]
        v, value = v + step[..., :n], value + step[..., n]
    return v
