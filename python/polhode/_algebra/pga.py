"""`pga`: plane-based geometric algebra, with points, lines, planes and motors."""

from __future__ import annotations

import functools
from typing import Any, Self

import numpy as np

from polhode._algebra.algebra import Algebra, algebra, no_constructor
from polhode._algebra.coefficients import common, kind_of, number_like
from polhode._algebra.euclidean import (
    columns,
    dimension_of,
    point_and_unit,
    require,
    require_value,
    unit_in,
    vector_in,
)
from polhode._algebra.foreign_tables import PGA as PGA_NAMES
from polhode._algebra.functions import as_precise
from polhode._algebra.multivector import Multivector
from polhode._algebra.relabel import embedded, relabelled
from polhode._algebra.rotor import Rotor
from polhode._algebra.transform import RigidTransform
from polhode._algebra.versors import small
from polhode._support.arrays import common_batch, copied, is_float, new, power_of_two
from polhode._support.calls import takes_components


class PGA(Algebra):
    """The plane-based geometric algebra Cl(n, 0, 1) of n-dimensional Euclidean space, created by `pga`.

    The null generator e0 comes first. Vectors are hyperplanes: ``a e1 + b e2 + c e3 + d e0`` is the plane
    ``a x + b y + c z + d = 0``. Their wedge is the intersection, and ``A & B`` joins points:

    - a plane with the unit normal n at the distance d is ``n − d e0``;
    - a point is ``e123 + x e032 + y e013 + z e021``, of grade n; without e123 it is a direction;
    - the line from P to Q is ``P & Q``; that through the origin along e1 is e23.

    In three dimensions the basis is that of bivector.net and ganja.js: 1, e0, e1, e2, e3, e01, e02, e03, e12,
    e31, e23, e021, e013, e032, e123, e0123. In any dimension the second half of the basis are the complements
    of the first in reverse order. Motors move all of them: ``M >> X``.

    Points, directions and normals are given as arrays (..., n) or vectors of ``ph.algebra(n)``, with leading
    batch axes and any coefficients.

    Examples
    --------
    The line through two points, and its intersection with the plane x = 3:

    >>> A = ph.pga()
    >>> P, Q = A.point([0, 0, 0]), A.point([1, 2, 0])
    >>> A.coordinates((P & Q) ^ A.plane([1, 0, 0], 3))
    array([3., 6., 0.])

    A motor moves points, lines and planes:

    >>> M = A.motor(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True), [0, 0, 5])
    >>> A.coordinates(M >> A.point([1, 0, 0]))
    array([0.5      , 0.8660254, 5.       ])
    """

    __slots__ = ()

    _foreign_names = PGA_NAMES

    # Not `__init__`, for the native `__new__` requires arguments.
    def __new__(cls, *_arguments: Any, **_named: Any) -> Self:
        raise no_constructor(cls, "pga(n)")

    def __repr__(self) -> str:
        return f"pga({self.dimension - 1})"

    def __reduce__(self) -> tuple[Any, ...]:
        return pga, (self.dimension - 1,)

    def _key(self) -> Any:
        return repr(self)

    @property
    @functools.cache  # noqa: B019  # algebras live as long as the process
    def _space(self) -> Algebra:
        """The algebra of Euclidean vectors."""
        return algebra(self.dimension - 1)

    @property
    def e0(self) -> Multivector:
        """The null generator, the hyperplane at infinity."""
        return self.basis_vectors[0]

    # --- points, planes and lines

    @takes_components
    def point(self, x: Any) -> Multivector:
        """Return points at the positions x, of weight 1.

        Examples
        --------
        >>> ph.pga().point([1, 2, 3])
        3 e0∧e2∧e1 + 2 e0∧e1∧e3 + e0∧e3∧e2 + e1∧e2∧e3
        """
        v = vector_in(self._space, x, "the position")
        return self._vector(kind_of(v._data).zeros_like(v._data[..., :1]) + 1, v).right_complement()

    @takes_components
    def direction(self, x: Any) -> Multivector:
        """Return points at infinity in the directions x; a motion turns, but does not shift them.

        Examples
        --------
        >>> A = ph.pga()
        >>> bool(A.translator([5, 5, 5]) >> A.direction([1, 0, 0]) == A.direction([1, 0, 0]))
        True
        """
        v = vector_in(self._space, x, "the direction")
        return self.embed(v).right_complement()

    def plane(self, normal: Any, distance: Any = 0.0) -> Multivector:
        """Return the hyperplane ``n·x = distance``, with the unit vector n along `normal`.

        It is ``n − distance e0``, with the distance from the origin in the sense of the normal, a number or
        an array. In two dimensions it is a line. A ValueError for a normal of zero.

        Examples
        --------
        >>> ph.pga().plane([0, 0, 1], 2)
        -2 e0 + e3
        """
        n = unit_in(self._space, normal, "the normal")
        return self._vector(-number_like(distance, "the distance", n._data)[..., None], n)

    def line(self, point: Any, through: Any = None, *, direction: Any = None) -> Multivector:
        """Return the line from `point` to the point `through`, or along `direction`, of norm 1.

        Points are positions, or points of this algebra. ``exp(−θ/2 L)`` of a line turns about it by θ in the
        right-handed sense. A ValueError for two equal points and for a direction of zero.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.line([0, 0, 0], direction=[1, 0, 0])
        e2∧e3
        >>> bool(A.line([0, 0, 0], [1, 0, 0]) == A.line([7, 0, 0], [8, 0, 0]))
        True
        """
        start, along = point_and_unit(self, point, through, direction)
        return self.point(start).vee(self.direction(along))

    # --- back

    def coordinates(self, P: Multivector) -> Any:
        """Return the coordinates (..., n) of points; a ValueError, with the batch index, at infinity.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.coordinates(5 * A.point([1, 2, 3]))
        array([1., 2., 3.])
        """
        weight, *parts = columns(require_value(self, P, "a point", (self.dimension - 1,)).left_complement())
        require(weight != 0, P, "the point is at infinity, without coordinates; it is a direction")
        kind = kind_of(P._data)
        return copied(kind.stack([kind.divide(x, weight) for x in parts]))

    def down(self, P: Multivector) -> Multivector:
        """Return the positions of points as vectors of ``ph.algebra(n)``, the inverse of `point`.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.down(5 * A.point([1, 2, 3]))
        e1 + 2 e2 + 3 e3
        """
        return self._space.vector(self.coordinates(P))

    def normal_and_distance(self, plane: Multivector) -> tuple[Multivector, Any]:
        """Return the unit normal and the distance of hyperplanes, the inverse of `plane`.

        Examples
        --------
        >>> A = ph.pga()
        >>> normal, distance = A.normal_and_distance(A.plane([0, 3, 4], 2))
        >>> print(normal, distance)
        0.6 e2 + 0.8 e3 2.0
        """
        unit = self._unit(require_value(self, plane, "a plane", (1,)))
        distance, *_ = columns(-unit)
        return self._space.vector(kind_of(unit._data).stack(columns(unit)[1:])), distance[()]

    def point_and_direction(self, line: Multivector) -> tuple[Multivector, Multivector]:
        """Return the point of lines nearest to the origin and the unit direction, as vectors.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.point_and_direction(A.line([5, 2, 0], direction=[1, 0, 0]))
        (2 e2, e1)
        """
        unit = self._unit(require_value(self, line, "a line", (self.dimension - 2,)))
        # The line meets the plane at infinity in its direction.
        _, *parts = columns(-as_precise(self.e0, unit).wedge(unit).left_complement())
        along = self._space.vector(kind_of(unit._data).stack(parts))
        return self.down(self.embed(along).wedge(unit)), along

    def normalized(self, X: Multivector) -> Multivector:
        """Return planes, lines, points and motors of unit norm, with checks.

        Points get the weight 1, planes and lines the norm 1, and motors M become ``M (M ~M)^(−1/2)``, with
        the dual number ``M ~M``. A ValueError, with the batch index, for values at infinity, which have the
        norm 0, and for a bivector that is not a line, such as a screw.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.normalized(2 * A.plane([0, 0, 1], 3))
        -3 e0 + e3
        """
        X = require_value(self, X, "the value")
        held = X._held() or X._mask
        if held.bit_count() > 1:
            return self._unit_motor(X)
        X = X._part(held)
        if held == 1 << self.dimension - 1:
            return self.point(self.coordinates(X))
        return self._unit(X)

    def _unit(self, X: Multivector) -> Multivector:
        """Return planes and lines of norm 1."""
        X = _near_unit(X)
        square = X.norm_squared()
        require(square != 0, X, "the value has the norm 0: it is at infinity")
        if X._mask == 0b100:
            blade = small(X.wedge(X)._data, X)
            require(blade, X, "X∧X is not 0: the bivector is not an intersection of two planes, but a screw")
        return X / self.scalar(kind_of(X._data).sqrt(square))

    def _unit_motor(self, M: Multivector) -> Multivector:
        """Return ``M (M ~M)^(−1/2)``, where ``M ~M = a + b I`` and ``I² = 0``."""
        M = _near_unit(M)
        product = M * ~M
        square = product.grade(0)._data[..., 0]
        require(square != 0, M, "the motor has the norm 0")
        dual = product.grade(self.dimension) if self.dimension == 4 else product.grade(0) * 0
        rest = product - product.grade(0) - dual
        require(small(rest._data, M), M, "M ~M is not a number or a dual number: not a motor")
        root = self.scalar(kind_of(M._data).sqrt(square))
        return M / root - M * dual / (2 * self.scalar(square) * root)

    # --- motors

    def translator(self, displacement: Any) -> Multivector:
        """Return motors that shift by vectors t: ``1 − ½ e0 t``.

        Examples
        --------
        >>> A = ph.pga()
        >>> T = A.translator([1, 2, 3])
        >>> A.down(T >> A.point([0, 0, 0]))
        e1 + 2 e2 + 3 e3
        """
        t = vector_in(self._space, displacement, "the displacement")
        return 1 - as_precise(self.e0, t) * self.embed(t) / 2

    def motor(self, rotor: Rotor | RigidTransform | None = None, translation: Any = None) -> Multivector:
        """Return the motor ``M = (1 − ½ e0 x0) R`` of a rotor and a translation, or of a `RigidTransform`.

        ``M >> X`` is ``R x ~R + x0`` for points. In three dimensions only; see `translator` for others.

        Examples
        --------
        >>> A = ph.pga()
        >>> M = A.motor(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True), [0, 0, 5])
        >>> A.down(M >> A.point([1, 0, 0]))
        0.5 e1 + 0.8660254 e2 + 5 e3
        """
        self._require_3d("a motor of a rotor")
        if isinstance(rotor, RigidTransform):
            if translation is not None:
                raise TypeError("a RigidTransform has a translation; omit the other")
            move = rotor
        else:
            move = RigidTransform(rotor, (0.0, 0.0, 0.0) if translation is None else translation)
        return move.to_motor(self)

    def transform(self, M: Multivector) -> RigidTransform:
        """Return the `RigidTransform` of a motor, the inverse of `motor`, divided by its norm.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.transform(A.translator([1, 2, 3])).translation
        e1 + 2 e2 + 3 e3
        """
        self._require_3d("a RigidTransform")
        return RigidTransform.from_motor(require_value(self, M, "a motor", (0, 2, 4)))

    # --- other algebras

    def embed(self, X: Multivector) -> Multivector:
        """Return a value of ``ph.algebra(n)`` or of ``ph.algebra(n, 0, 1)`` in this algebra.

        In three dimensions the null generator e4 there is e0 here; the inverse is `null_last`.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.embed(ph.e1 ^ ph.e2)
        e1∧e2
        """
        n = self.dimension - 1
        places = {self._space: range(1, n + 1), algebra(n, 0, 1): (*range(1, n + 1), 0)}
        return embedded(X, self, places)

    def null_last(self, X: Multivector) -> Multivector:
        """Return a value in ``ph.algebra(n, 0, 1)``, whose null generator is the last.

        Examples
        --------
        >>> A = ph.pga()
        >>> A.null_last(A.plane([0, 0, 1], 2))
        e3 - 2 e4
        """
        n = self.dimension - 1
        return relabelled(require_value(self, X, "the value"), algebra(n, 0, 1), (n, *range(n)))

    # --- helpers

    def _require_3d(self, what: str) -> None:
        if self.dimension != 4:
            raise TypeError(f"{what} exists in ph.pga(3) only, not in {self}")

    def _vector(self, first: Any, rest: Multivector) -> Multivector:
        """Return the vector with these components (..., 1) of e0, and the others of a Euclidean vector."""
        weight, rows = common(first, rest._data)
        if is_float(rows):
            batch = common_batch(weight.shape[:-1], rows.shape[:-1])
            data = new((*batch, self.dimension), np.result_type(weight, rows))
            data[..., :1], data[..., 1:] = weight, rows
            return Multivector._of(data, 1 << 1, self)
        parts = [rows[..., k] for k in range(rows.shape[-1])]
        return Multivector._of(kind_of(rows).stack([weight[..., 0], *parts]), 1 << 1, self)


def _near_unit(X: Multivector) -> Multivector:
    """Return floats divided by a power of two near the norm, whose square might over- or underflow.

    Not by the largest component: those with e0 may be far larger than the norm, to which they do not count.
    """
    if not is_float(X._data):
        return X
    return X._like(X._data / power_of_two(np.asarray(X.norm(), X._data.dtype)[..., None], -1))


def pga(n: int = 3) -> PGA:
    """Return the plane-based algebra Cl(n, 0, 1) of n-dimensional space, the same object for the same n.

    Its null generator is e0 and comes first; ``ph.algebra(n, 0, 1)`` is the same algebra with the null
    generator last. n is 1 to 7.

    Examples
    --------
    Two lines of the plane, y = 1 and x = 3, meet in a point:

    >>> A = ph.pga(2)
    >>> A.coordinates(A.plane([0, 1], 1) ^ A.plane([1, 0], 3))
    array([3., 1.])
    """
    return _pga(dimension_of(n, 7, "pga"))


@functools.cache
def _pga(n: int) -> PGA:
    return Algebra.__new__(PGA, n, 0, 1, True)
