"""`cga`: conformal geometric algebra, with points, spheres, circles, lines and planes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, Self

import numpy as np

from polhode import _generic
from polhode._algebra.algebra import Algebra, algebra, no_constructor
from polhode._algebra.coefficients import as_coefficients, kind_of, number_like
from polhode._algebra.euclidean import (
    columns,
    dimension_of,
    point_and_unit,
    position_in,
    require,
    require_value,
    unit_in,
    vector_in,
)
from polhode._algebra.foreign_tables import CGA as CGA_NAMES
from polhode._algebra.functions import as_precise
from polhode._algebra.multivector import Multivector
from polhode._algebra.relabel import embedded, relabelled
from polhode._algebra.rotor import Rotor
from polhode._algebra.transform import RigidTransform
from polhode._algebra.versors import small
from polhode._support.arrays import is_float, power_of_two
from polhode._support.calls import explains_calls, takes_components


class CGA(Algebra):
    """The conformal geometric algebra Cl(n + 1, 1) of n-dimensional Euclidean space, created by `cga`.

    With the generators ``e+`` and ``e−`` after e1, …, en, in three dimensions e4 and e5 (as in clifford):

    - ``eo = ½ (e− − e+)`` is the origin, ``einf = e− + e+`` infinity: null vectors with ``eo·einf = −1``;
    - a point is ``up(x) = eo + x + ½ x² einf``, and ``up(x)·up(y) = −½ |x − y|²``;
    - objects are direct: wedges of their points, so that P is on X if ``P∧X = 0``. Point pairs, circles and
      spheres are wedges of two, three and four points; with einf in place of one of them lines and planes.

    Versors move all of them: ``T >> X`` with `rotor`, `translator`, `dilator` and `motor`. Points, directions
    and normals are given as arrays (..., n) or vectors of ``ph.algebra(n)``, with leading batch axes and any
    coefficients. `blades` and formulas know the names eo and einf.

    The components of a point at the distance s from the origin grow as ½ s², so its coordinates come back
    with a relative error of about ``ε s²``: choose the unit of length near the size of the scene.

    Examples
    --------
    The circle through three points, the distance of two of them, and a dilation:

    >>> A = ph.cga()
    >>> a, b, c = A.up([1, 0, 0]), A.up([0, 1, 0]), A.up([-1, 0, 0])
    >>> circle = a ^ b ^ c
    >>> print(A.center(circle), A.radius(circle))
    0 1.0
    >>> a | c
    -2
    >>> print(A.radius(A.dilator(3) >> circle).round(6))
    3.0
    """

    __slots__ = ()

    _foreign_names = CGA_NAMES

    # Not `__init__`, for the native `__new__` requires arguments.
    def __new__(cls, *_arguments: Any, **_named: Any) -> Self:
        raise no_constructor(cls, "cga(n)")

    def __repr__(self) -> str:
        return f"cga({self._n})"

    def __reduce__(self) -> tuple[Any, ...]:
        return cga, (self._n,)

    def _key(self) -> Any:
        return repr(self)

    @property
    def _n(self) -> int:
        return self.dimension - 2

    @property
    def _space(self) -> Algebra:
        """The algebra of Euclidean vectors."""
        return algebra(self._n)

    @property
    @functools.cache  # noqa: B019  # algebras live as long as the process
    def eo(self) -> Multivector:
        """The origin ``½ (e− − e+)``."""
        return (self.basis_vectors[-1] - self.basis_vectors[-2]) / 2

    @property
    @functools.cache  # noqa: B019
    def einf(self) -> Multivector:
        """The point at infinity ``e− + e+``."""
        return self.basis_vectors[-1] + self.basis_vectors[-2]

    def _named(self) -> dict[str, Multivector]:
        return {"eo": self.eo, "einf": self.einf}

    # --- points

    @takes_components
    def up(self, x: Any) -> Multivector:
        """Return the points ``eo + x + ½ x² einf`` at the positions x.

        Examples
        --------
        >>> A = ph.cga()
        >>> P = A.up([3, 0, 0])
        >>> P * P, P | A.up([0, 4, 0])
        (0, -12.5)
        """
        v = vector_in(self._space, x, "the position")
        kind, parts = kind_of(v._data), columns(v)
        half = kind.divide(v.norm_squared(), 2)
        one = kind.divide(kind.zeros_like(half) + 1, 2)
        return self.vector(kind.stack([*parts, half - one, half + one]))

    @takes_components
    def point(self, x: Any) -> Multivector:
        """Return `up(x)`.

        Examples
        --------
        >>> C = ph.cga(3)
        >>> C.down(C.point([1, 0, 0]))
        e1
        """
        return self.up(x)

    def down(self, X: Multivector) -> Multivector:
        """Return the positions of points of any weight as vectors of ``ph.algebra(n)``, the inverse of `up`.

        A ValueError, with the batch index, at infinity, and for vectors that are not points: X² must be 0 to
        half of the digits of the sum of the squared components.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.down(2 * A.up([1, 2, 3]))
        e1 + 2 e2 + 3 e3
        """
        P = _scaled(require_value(self, X, "a point", (1,)))
        ok = small(P.scalar_product(P)._data, P)
        require(ok, P, "a point has X² = 0; of a sphere take center(X)")
        return self._down(P)

    def coordinates(self, X: Multivector) -> Any:
        """Return the coordinates (..., n) of points: the components of `down`.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.coordinates(2 * A.up([1, 2, 3]))
        array([1., 2., 3.])
        """
        return self.down(X).components

    def _down(self, P: Multivector) -> Multivector:
        """Return the position of a vector with any square."""
        parts, kind = columns(P), kind_of(P._data)
        weight = parts[-1] - parts[-2]
        require(weight != 0, P, "the point is at infinity, or too far away for the digits of its components")
        return self._space.vector(kind.stack([kind.divide(x, weight) for x in parts[:-2]]))

    # --- flats

    def line(self, point: Any, through: Any = None, *, direction: Any = None) -> Multivector:
        """Return the line ``P∧d∧einf`` from `point` to `through`, or along `direction`, of norm 1.

        Examples
        --------
        >>> A = ph.cga()
        >>> bool(A.line([0, 0, 0], [1, 0, 0]) == A.line([7, 0, 0], direction=[3, 0, 0]))
        True
        """
        start, along = point_and_unit(self, point, through, direction)
        return self.up(start).wedge(self.embed(along)).wedge(as_precise(self.einf, along))

    def plane(self, normal: Any, distance: Any = 0.0) -> Multivector:
        """Return the hyperplane ``n·x = distance``, with the unit vector n along `normal`, of norm 1.

        ``P∧E∧einf`` with the blade E of the plane, ``n∧E = I``: of the normal e3 it is ``e1∧e2``.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.up([5, 6, 2]) ^ A.plane([0, 0, 1], 2)
        0
        """
        n = unit_in(self._space, normal, "the normal")
        foot = self._space.scalar(number_like(distance, "the distance", n._data)) * n
        blade = self.embed(n.right_complement())
        return self.up(foot).wedge(blade).wedge(as_precise(self.einf, n))

    # --- rounds

    def point_pair(self, a: Any, b: Any) -> Multivector:
        """Return the pair ``A∧B`` of two points.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.points(A.point_pair([1, 0, 0], [3, 0, 0]))
        (e1, 3 e1)
        """
        return self.up(position_in(self, a, "the first point")).wedge(
            self.up(position_in(self, b, "the second point"))
        )

    def circle(self, center: Any, normal: Any, radius: Any) -> Multivector:
        """Return circles of a center, a normal and a radius, in three dimensions.

        They are ``(eo + ½ r² einf)∧E``, shifted to the center, with the unit blade E of their plane,
        ``n∧E = I``. The circle through three points is ``A ^ B ^ C``.

        Examples
        --------
        >>> A = ph.cga()
        >>> circle = A.circle([0, 0, 5], [0, 0, 1], 2)
        >>> circle ^ A.up([2, 0, 5])
        0
        """
        if self._n != 3:
            raise TypeError(f"a circle with a normal exists in ph.cga(3) only, not in {self}")
        n = unit_in(self._space, normal, "the normal")
        return self._round(center, n.right_complement(), radius)

    def sphere(self, center: Any, radius: Any) -> Multivector:
        """Return spheres of a center and a radius, ``(eo + ½ r² einf)∧e123`` shifted; for n = 2 circles.

        Examples
        --------
        A sphere, and a point on it:

        >>> A = ph.cga()
        >>> A.sphere([0, 0, 0], 5) ^ A.up([3, 4, 0])
        0
        """
        return self._round(center, self._space.I, radius)

    def _round(self, center: Any, blade: Multivector, radius: Any) -> Multivector:
        place = position_in(self, center, "the center")
        r = number_like(radius, "the radius", place._data)
        kind = kind_of(r)
        kind.require(_positive(r), "a radius must be positive; a sphere of radius 0 is a point, up(x)")
        with np.errstate(over="ignore"):  # IEEE, as in the products
            square = r * r
        core = self._eo_like(r) + self.scalar(kind.divide(square, 2)) * as_precise(self.einf, place)
        shift = self.translator(place)
        moved: Multivector = shift * core.wedge(as_precise(self.embed(blade), place)) * ~shift
        return moved._part(1 << blade.grades[-1] + 1)

    def _eo_like(self, data: Any) -> Multivector:
        """Return eo with coefficients of the kind of `data`: exact ones stay exact."""
        kind = kind_of(data)
        zero = kind.zeros_like(data)
        half = kind.divide(zero + 1, 2)
        return self.vector(kind.stack([*[zero] * self._n, -half, half]))

    # --- back

    def center(self, X: Multivector) -> Multivector:
        """Return the centers of spheres, circles and point pairs as vectors: those of ``X einf X``.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.center(A.sphere([1, 2, 3], 5))
        e1 + 2 e2 + 3 e3
        """
        X = self._require_round(X)
        return self._down((X * as_precise(self.einf, X) * X).grade(1))

    def squared_radius(self, X: Multivector) -> Any:
        """Return r² of spheres, circles, point pairs and points, negative of an imaginary one.

        An imaginary round is the intersection of two spheres that do not meet.

        Examples
        --------
        >>> A = ph.cga()
        >>> print(A.squared_radius(A.sphere([1, 2, 3], 5)).round(6))
        25.0
        """
        X = self._require_round(X)
        k = X.grades[0]
        square = (X * X).grade(0)
        normal = as_precise(self.einf, X).left_contraction(X)
        other = (normal * normal).grade(0)
        ratio = square / other * (-1) ** k
        return ratio._data[..., 0][()]

    def radius(self, X: Multivector) -> Any:
        """Return the radii of spheres, circles and point pairs; a ValueError for imaginary ones.

        Examples
        --------
        >>> A = ph.cga()
        >>> print(A.radius(A.sphere([1, 2, 3], 5)).round(6))
        5.0
        """
        square = self.squared_radius(X)
        kind = kind_of(as_coefficients(square, "the squared radius"))
        real = ~_each(_generic.exact.is_negative, square) if kind.exact else square >= 0
        kind.require(real, "the round is imaginary, its squared_radius negative")
        return kind.sqrt(square)

    def points(self, pair: Multivector) -> tuple[Multivector, Multivector]:
        """Return the positions of the points of point pairs as vectors, the inverse of `point_pair`.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.points(A.point_pair([1, 0, 0], [3, 0, 0]))
        (e1, 3 e1)
        """
        pair = require_value(self, pair, "a point pair", (2,))
        center, radius = self.center(pair), self.radius(pair)
        _, along = self.point_and_direction(pair.wedge(as_precise(self.einf, pair)))
        arm = self._space.scalar(radius) * along
        return center - arm, center + arm

    def point_and_direction(self, line: Multivector) -> tuple[Multivector, Multivector]:
        """Return the point of lines nearest to the origin and the unit direction, as vectors.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.point_and_direction(A.line([5, 2, 0], direction=[1, 0, 0]))
        (2 e2, e1)
        """
        direction, moment = self._flat(require_value(self, line, "a line", (3,)))
        return moment.right_contraction(direction), direction

    def normal_and_distance(self, plane: Multivector) -> tuple[Multivector, Any]:
        """Return the unit normal and the distance of hyperplanes, the inverse of `plane`.

        Examples
        --------
        >>> A = ph.cga()
        >>> normal, distance = A.normal_and_distance(A.plane([0, 0, 1], 2))
        >>> print(normal, distance)
        e3 2.0
        """
        blade, moment = self._flat(require_value(self, plane, "a plane", (self.dimension - 1,)))
        distance = moment.right_complement()._data[..., 0]
        return blade.left_complement(), distance[()]

    def _flat(self, X: Multivector) -> tuple[Multivector, Multivector]:
        """Return E and ``x∧E`` of the flat ``P∧E∧einf`` in Euclidean space, with the unit blade E."""
        kind, einf = kind_of(X._data), as_precise(self.einf, X)
        eo = self._eo_like(X._data[..., 0]) if kind.exact else as_precise(self.eo, X)
        blade = self._restricted(einf.left_contraction(X).right_contraction(eo))
        size = blade.norm()
        require(size != 0, X, "the value is not a line or a plane: it does not contain einf")
        outside = X.wedge(einf)
        if not kind.exact:
            bound = kind.eps**0.5 * kind.xp.max(kind.xp.abs(X._data), axis=-1)
            flat = kind.xp.max(kind.xp.abs(outside._data), axis=-1) <= bound
            require(flat, X, "the value does not contain einf: for a round take X ^ einf")
        rest = X - eo.wedge(self.embed(blade)).wedge(einf)
        moment = -self._restricted(rest.right_contraction(eo))
        scale = self._space.scalar(size)
        return blade / scale, moment / scale

    def _require_round(self, X: Multivector) -> Multivector:
        X = require_value(self, X, "the value")
        held = X._held() or X._mask
        if held.bit_count() > 1:
            raise TypeError(f"a round has one grade, got the grades {X.grades}")
        X = _scaled(X._part(held))
        inside = as_precise(self.einf, X).left_contraction(X)
        square, kind = (inside * inside).grade(0)._data[..., 0], kind_of(X._data)
        if kind.exact:
            ok = ~small(square[..., None], X, digits=0.9)
        else:
            ok = kind.xp.abs(square) > 64 * kind.eps * kind.xp.sum(X._data * X._data, axis=-1)
        message = (
            "the value is flat, or a round too small beside its distance from the origin: it has no center"
        )
        require(ok, X, f"{message}; for flats see point_and_direction and normal_and_distance")
        return X

    # --- versors

    @explains_calls(angle="A.rotor(ph.Rotor.from_plane_angle(B, angle))")
    def rotor(self, R: Multivector) -> Multivector:
        """Return a rotor of ``ph.algebra(n)`` as an element of this algebra: it turns about the origin.

        Examples
        --------
        >>> A = ph.cga()
        >>> R = A.rotor(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True))
        >>> A.down(R >> A.up([1, 0, 0]))
        0.5 e1 + 0.8660254 e2
        """
        return self.embed(require_value(self._space, R, "a rotor", tuple(range(0, self._n + 1, 2))))

    def translator(self, displacement: Any) -> Multivector:
        """Return versors that shift by vectors t: ``1 − ½ t einf``.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.down(A.translator([1, 2, 3]) >> A.eo)
        e1 + 2 e2 + 3 e3
        """
        t = vector_in(self._space, displacement, "the displacement")
        return 1 - self.embed(t) * as_precise(self.einf, t) / 2

    def dilator(self, factor: Any, center: Any = None) -> Multivector:
        """Return versors that scale lengths by a positive factor f, about the origin or a center.

        ``exp(½ ln f · eo∧einf) = ½ (√f + 1/√f) + ½ (√f − 1/√f) eo∧einf``.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.down(A.dilator(3) >> A.up([1, 2, 0]))
        3 e1 + 6 e2
        """
        f = as_coefficients(factor, "the factor")
        kind = kind_of(f)
        kind.require(_positive(f), "a dilation needs a positive factor")
        root = kind.sqrt(f)
        inverse = kind.divide(kind.zeros_like(f) + 1, root)
        even, odd = kind.divide(root + inverse, 2), kind.divide(root - inverse, 2)
        D = self.scalar(even) + self.scalar(odd) * (self.basis_vectors[-1] * self.basis_vectors[-2])
        if center is None:
            return D
        shift = self.translator(position_in(self, center, "the center"))
        return shift * D * ~shift

    def motor(self, rotor: Rotor | RigidTransform | None = None, translation: Any = None) -> Multivector:
        """Return the versor of ``R x ~R + x0`` for a rotor and a translation, or a `RigidTransform`.

        Examples
        --------
        >>> A = ph.cga()
        >>> M = A.motor(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True), [0, 0, 5])
        >>> A.down(M >> A.up([1, 0, 0]))
        0.5 e1 + 0.8660254 e2 + 5 e3
        """
        if isinstance(rotor, RigidTransform):
            if translation is not None:
                raise TypeError("a RigidTransform has a translation; omit the other")
            return self.motor(rotor.rotor, rotor.translation)
        turn = self.scalar(1.0) if rotor is None else self.rotor(rotor)
        return turn if translation is None else self.translator(translation) * turn

    # --- helpers

    def embed(self, X: Multivector) -> Multivector:
        """Return a value of ``ph.algebra(n)`` or of ``ph.algebra(n + 1, 1)`` in this algebra.

        Examples
        --------
        >>> A = ph.cga()
        >>> A.embed(ph.e1 ^ ph.e2) ^ A.einf
        e1∧e2∧e4 + e1∧e2∧e5
        """
        n = self._n
        return embedded(X, self, {self._space: range(n), algebra(n + 1, 1): range(n + 2)})

    def _restricted(self, value: Multivector) -> Multivector:
        """Return the Euclidean part of a value."""
        return relabelled(value, self._space, [*range(self._n), None, None])


def _positive(x: Any) -> Any:
    """Whether numbers are positive, or expressions may be."""
    return _each(_generic.exact.may_be_positive, x) if kind_of(x).exact else x > 0


def _each(condition: Callable[[Any], bool], x: Any) -> Any:
    """Return a condition of exact elements as an array."""
    return np.asarray(np.frompyfunc(condition, 1, 1)(x), dtype=bool)


def _scaled(X: Multivector) -> Multivector:
    """Return a value of floats divided by a power of two, with which squares neither overflow nor vanish."""
    if not is_float(X._data):
        return X
    require(np.isfinite(X._data).all(axis=-1), X, "a component is NaN or infinite; scale the numbers down")
    return X._like(X._data / power_of_two(X._data, -1))


def cga(n: int = 3) -> CGA:
    """Return the conformal algebra Cl(n + 1, 1) of n-dimensional space, the same object for the same n.

    It has the generators of ``ph.algebra(n + 1, 1)`` and names for the null vectors, `CGA.eo` and `CGA.einf`.
    n is 1 to 6.

    Examples
    --------
    The points of a line, wedged with infinity, span it; another point on it adds nothing:

    >>> A = ph.cga(2)
    >>> A.up([0, 0]) ^ A.up([1, 2]) ^ A.einf ^ A.up([3, 6])
    0
    """
    return _cga(dimension_of(n, 6, "cga"))


@functools.cache
def _cga(n: int) -> CGA:
    return Algebra.__new__(CGA, n + 1, 1, 0)
