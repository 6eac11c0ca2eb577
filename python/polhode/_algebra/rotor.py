"""Rotors: unit even elements, which turn any multivector by ``X ↦ R X ~R``."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from polhode import _generic, _native
from polhode._algebra import groups as _groups
from polhode._algebra import matrices as _matrices
from polhode._algebra import parameters as _parameters
from polhode._algebra import quaternions as _quaternions
from polhode._algebra import signs as _signs
from polhode._algebra.angles import DEGREE, in_degrees, to_degrees, to_radians
from polhode._algebra.coefficients import as_coefficients, kind_of, number_like, taken
from polhode._algebra.foreign_values import remedy_for
from polhode._algebra.masking import Errors, masked
from polhode._algebra.multivector import Multivector
from polhode._algebra.names_of_rotors import add_to
from polhode._algebra.native import joins
from polhode._algebra.products import aligned, common_algebra, result_array
from polhode._algebra.quaternions import QuaternionOrder
from polhode._algebra.rotor_rows import components, computed, triples
from polhode._support.arrays import (
    Array,
    Shape,
    batch_shape,
    common_batch,
    is_float,
    new,
    normal_numbers,
)
from polhode._support.calls import explains_calls, explains_calls_of
from polhode._support.memory import require_array

_BIVECTOR, _EVEN = 0b0100, 0b0101


@joins(_native.Rotor)
@explains_calls_of
class Rotor(_native.Rotor, Multivector):
    """A rotation, or an array of them: ``R = exp(−Bθ/2)`` turns by θ in the plane and sense of B.

    Active: ``R(X) = R X ~R`` for X of any grade; ``S*R`` turns by R first. Components
    ``(1, e2e3, e3e1, e1e2)``, always of norm 1. R and −R are the same rotation but different rotors, so that
    a motion's rotor is continuous. The quaternion ``w + xi + yj + zk`` has the rotor
    ``w − x e2e3 − y e3e1 − z e1e2``.

    A derivative with respect to a rotor by JAX has the type Rotor, but is not a rotor: only its `components`
    are meaningful. Differentiate with respect to a bivector, a rotation vector or components instead.

    Examples
    --------
    A quarter turn in the plane e1∧e2, in its sense from e1 to e2:

    >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 2)
    >>> R
    0.70710678 - 0.70710678 e1∧e2
    >>> bool(R(ph.e1).is_close(ph.e2))
    True

    A batch of two rotors turns one vector into two. The turn by 60° after that by 30° is the quarter turn:

    >>> S = ph.Rotor.from_axis_angle(ph.e3, [30, 60], degrees=True)
    >>> S(ph.e1)
    Multivector of shape (2,):
    [0.8660254 e1 + 0.5 e2,
     0.5 e1 + 0.8660254 e2]
    >>> bool((S[1] * S[0]).is_close(R))
    True
    """

    __slots__ = ()

    # --- constructors

    def _like(self, data: Any) -> Rotor:
        return Rotor._from_rows(data)

    @staticmethod
    def _restored(data: Any, _mask: int, _algebra: Any) -> Rotor:
        return Rotor._from_rows(data)

    @staticmethod
    def identity(shape: int | Shape = ()) -> Rotor:
        """Return the rotor 1, the identity rotation, or a batch of it of this shape.

        Examples
        --------
        >>> ph.Rotor.identity()(ph.e1)
        e1
        """
        rows = (*batch_shape(shape), 4)
        require_array(rows, "rotors")
        return Rotor._from_rows(np.broadcast_to([1.0, 0.0, 0.0, 0.0], rows).copy())

    @staticmethod
    def from_components(c4: Any, *, errors: Errors = "raise") -> Rotor:
        """From components (..., 4) over ``(1, e2e3, e3e1, e1e2)``, divided by their norm.

        A ValueError, with the batch index, where they are 0 or not finite. With ``errors="mask"``, here and
        in the other constructors, such rows are NaN, and `is_finite` finds them; the other rows have the same
        bits as without these.

        Examples
        --------
        >>> ph.Rotor.from_components([1, 0, 0, -1])
        0.70710678 - 0.70710678 e1∧e2
        """
        if errors != "raise":
            return masked(errors, Rotor.from_components, (c4, 1))
        if (found := _native.rotor_from("components", c4)) is not None:
            return found
        return Rotor._from_rows(computed("from_components", components(c4, 4, "rotor")))

    @staticmethod
    def from_plane_angle(B: Any, theta: Any, degrees: bool = False, *, errors: Errors = "raise") -> Rotor:
        """``exp(−Bθ/2)``: turn by theta, in radians, in the plane and sense of B, whose norm is ignored.

        B is a bivector, or an array or list (..., 3) of its components over ``(e2e3, e3e1, e1e2)``, which are
        those of the axis: ``[0, 0, 1]`` is the plane e1∧e2.

        Examples
        --------
        >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 3)
        >>> R
        0.8660254 - 0.5 e1∧e2
        >>> R(ph.e1), R(ph.e3)
        (0.5 e1 + 0.8660254 e2, e3)
        """
        if errors != "raise":
            return masked(
                errors, lambda b, angle: Rotor.from_plane_angle(b, angle, degrees), (B, 1), (theta, 0)
            )
        scale = 1.0 if degrees is False or not in_degrees(degrees) else DEGREE
        if (found := _native.rotor_from_turn(B, 2, theta, scale)) is not None:
            return found
        plane = triples(B, 2, "the plane")
        angle = number_like(theta, "angle", plane)
        if degrees:
            angle = to_radians(angle)
        if is_float(plane) and is_float(angle):
            angle = angle[..., np.newaxis]  # a column, beside the plane
        return Rotor._from_rows(computed("from_plane_angle", plane, angle))

    @staticmethod
    def from_vectors(a: Any, b: Any, *, errors: Errors = "raise") -> Rotor:
        """Turn the direction of a into that of b, the short way; lengths are ignored.

        Each is a vector, or an array or list (..., 3): ``from_vectors([1, 0, 0], [0, 1, 0])``.
        For opposite directions the plane is not unique; it is taken through a and the basis vector farthest
        from a. `ph.align` finds the best rotation for many pairs.

        Examples
        --------
        >>> R = ph.Rotor.from_vectors([1, 0, 0], [3, 4, 0])
        >>> R(ph.e1)
        0.6 e1 + 0.8 e2
        """
        if errors != "raise":
            return masked(errors, Rotor.from_vectors, (a, 1), (b, 1))
        if (found := _native.rotor_between(a, b)) is not None:
            return found
        first, second = triples(a, 1, "the first direction"), triples(b, 1, "the second direction")
        return Rotor._from_rows(computed("from_vectors", first, second))

    @staticmethod
    def from_rotation_vector(v: Any, degrees: bool = False, *, errors: Errors = "raise") -> Rotor:
        """From vectors (..., 3) along the axis, whose length is the angle in radians; an array or vectors.

        In degrees with ``degrees=True``.

        Examples
        --------
        >>> R = ph.Rotor.from_rotation_vector([0, 0, np.pi / 3])
        >>> R(ph.e1)
        0.5 e1 + 0.8660254 e2
        >>> bool(R.is_close(ph.Rotor.from_rotation_vector([0, 0, 60], degrees=True)))
        True
        """
        if errors != "raise":
            return masked(errors, lambda rows: Rotor.from_rotation_vector(rows, degrees), (v, 1))
        converts = degrees is not False and in_degrees(degrees)
        if not converts and (found := _native.rotor_from("rotation vector", v)) is not None:
            return found
        given = triples(v, 1, "a rotation vector")
        if converts:
            given = to_radians(given)
        return Rotor._from_rows(computed("from_rotation_vector", given))

    @staticmethod
    def from_euler(seq: str, angles: Any, degrees: bool = False, *, errors: Errors = "raise") -> Rotor:
        """From Euler angles (..., n) about n = 1 to 3 axes, in radians; named as SciPy names them.

        ``"xyz"`` turns about the fixed axes e1, then e2, then e3; ``"XYZ"`` about the axes of the body,
        so that ``from_euler("XYZ", [a, b, c]) == from_euler("zyx", [c, b, a])``. Neighbours in `seq` differ.
        For one axis a single angle need not be an array. Angles are numbers, SymPy expressions, or arrays of
        any library.

        Examples
        --------
        Yaw, pitch and roll of an aircraft, about the axes of the body:

        >>> R = ph.Rotor.from_euler("ZYX", [60, 0, 0], degrees=True)
        >>> R(ph.e1)
        0.5 e1 + 0.8660254 e2
        >>> R = ph.Rotor.from_euler("ZYX", [60, 20, 10], degrees=True)
        >>> R.to_euler("ZYX", degrees=True).round(6)
        array([60., 20., 10.])
        """
        scale = 1.0 if degrees is False or not in_degrees(degrees) else DEGREE
        if errors == "raise" and (found := _native.rotor_from_euler(seq, angles, scale)) is not None:
            return found
        from polhode._algebra import euler

        if errors != "raise":
            last = 1 if np.ndim(angles) else 0
            return masked(errors, lambda rows: Rotor.from_euler(seq, rows, degrees), (angles, last))
        axes = euler.axes_of(seq, (1, 2, 3))
        theta = as_coefficients(angles, "angles")
        if not theta.shape:
            theta = theta[None]
        euler.require_angles(seq, theta.shape)
        if degrees:
            theta = to_radians(theta)
        planes = np.eye(3)[axes]
        turns = [
            Rotor.from_plane_angle(Multivector._of(plane, _BIVECTOR), theta[..., k])
            for k, plane in enumerate(planes)
        ]
        # Turns about axes of the body are the same turns about fixed axes in the opposite order.
        total, *others = turns[::-1] if seq.isupper() else turns
        for turn in others:
            total = turn * total
        return total.astype(theta.dtype) if is_float(theta) else total

    @staticmethod
    def random(shape: int | Shape = (), rng: np.random.Generator | int | None = None) -> Rotor:
        """Return rotors (*shape), uniform over all attitudes; `rng` is a NumPy generator or a seed.

        Examples
        --------
        >>> R = ph.Rotor.random(1000, rng=0)
        >>> R.shape
        (1000,)
        >>> bool((np.abs(R.norm() - 1) < 1e-12).all())
        True
        """
        return Rotor.from_components(normal_numbers((*batch_shape(shape), 4), rng, "rotors"))

    from_matrix = staticmethod(_matrices.from_matrix)
    from_quaternion = staticmethod(_quaternions.from_quaternion)
    from_scipy = staticmethod(_quaternions.from_scipy)
    from_numpy_quaternion = staticmethod(_quaternions.from_numpy_quaternion)
    from_axis_angle = staticmethod(_parameters.from_axis_angle)
    from_mrp = staticmethod(_parameters.from_mrp)
    from_davenport = staticmethod(_parameters.from_davenport)
    from_multivector = staticmethod(_parameters.from_multivector)
    group = staticmethod(_groups.group)

    def exp(self: Any, *, errors: Errors = "raise") -> Any:
        """``exp R``, which is not a rotor; those are ``B.exp()`` of a bivector B, and `from_rotation_vector`.

        Examples
        --------
        >>> ph.Rotor.identity().exp()
        2.7182818
        """
        if not isinstance(self, Rotor) and not (isinstance(self, Multivector) and self.grades == (2,)):
            raise TypeError(
                f"Rotor.exp takes a bivector, got {type(self).__name__}; write Rotor.from_rotation_vector(v) "
                "for a rotation vector v, a.exp() for the exponential of any multivector a"
            )
        return Multivector.exp(self, errors=errors)

    # --- converters

    angle = property(_parameters.angle)
    magnitude = _parameters.magnitude
    to_matrix = _matrices.to_matrix
    to_scipy = _quaternions.to_scipy
    to_numpy_quaternion = _quaternions.to_numpy_quaternion
    to_mrp = _parameters.to_mrp
    to_davenport = _parameters.to_davenport

    @explains_calls
    def to_quaternion(self, *, order: QuaternionOrder) -> Any:
        """Return quaternions (..., 4), Hamilton's and active; `order` is required, "wxyz" or "xyzw".

        Examples
        --------
        >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 2)
        >>> R.to_quaternion(order="wxyz")
        array([0.70710678, 0.        , 0.        , 0.70710678])
        >>> R.to_quaternion(order="xyzw")
        array([0.        , 0.        , 0.70710678, 0.70710678])
        """
        if order in ("wxyz", "xyzw") and (found := _native.rotor_to(order, self)) is not None:
            return found
        wxyz_first = _quaternions.places_of_wxyz(order)[0] == 0
        wxyz = computed("to_quaternion", self._data)
        return wxyz if wxyz_first else taken(wxyz, [1, 2, 3, 0])

    def to_rotation_vector(self, degrees: bool = False) -> Any:
        """Return vectors (..., 3) along the axis whose length is the angle in radians, at most π.

        In degrees with ``degrees=True``.

        Examples
        --------
        >>> R = ph.Rotor.from_rotation_vector([0.1, 0.2, 0.3])
        >>> (R * R).to_rotation_vector()
        array([0.2, 0.4, 0.6])
        """
        if (found := _native.rotor_to("rotation vector", self)) is None:
            found = computed("to_rotation_vector", self._data)
        return found if degrees is False or not in_degrees(degrees) else to_degrees(found)

    @explains_calls
    def to_euler(self, seq: str, degrees: bool = False) -> Any:
        """Return Euler angles (..., 3) in radians about the three axes `seq`, named as in `from_euler`.

        The first and third lie in [−π, π]; the second in [0, π] if the first and third axes are the same
        ("zxz"), in [−π/2, π/2] if all differ. At the ends of its range, in gimbal lock, only a sum or
        difference of the others is determined: the third angle is then 0. The three angles still give the
        attitude, so there is no warning.

        Examples
        --------
        The same attitude by turns about the axes of the body, and about fixed axes in the opposite order:

        >>> R = ph.Rotor.from_euler("ZYX", [60, 20, 10], degrees=True)
        >>> R.to_euler("ZYX", degrees=True).round(6)
        array([60., 20., 10.])
        >>> R.to_euler("xyz", degrees=True).round(6)
        array([10., 20., 60.])
        """
        if (found := _native.rotor_to_euler(seq, self)) is None:
            from polhode._algebra import euler

            found = euler.angles_of(self.to_quaternion(order="wxyz"), seq)
        return found if degrees is False or not in_degrees(degrees) else to_degrees(found)

    def plane_angle(self, degrees: bool = False) -> tuple[Multivector, Any]:
        """Return the unit plane B and the angle θ in [0, 2π] with ``R = exp(−Bθ/2)``; for R = ±1, e1∧e2.

        θ is in degrees with ``degrees=True``.

        Examples
        --------
        >>> B, theta = ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True).plane_angle(degrees=True)
        >>> B
        e1∧e2
        >>> print(theta.round(6))
        60.0
        """
        if is_float(self._data):
            pairs = computed("plane_angle", self._data)
            plane, angle = pairs[..., :3], pairs[..., 3][()]
        else:
            plane, angle = _generic.rotors.plane_angle(kind_of(self._data), self._data)
        return Multivector._of(plane, _BIVECTOR), to_degrees(angle) if in_degrees(degrees) else angle

    def distance(self, other: Rotor) -> Any:
        """Return the angle in [0, π] of the rotation from this attitude to the other.

        A float, or an array of the batch shape; accurate for close attitudes, too. Derivatives at 0, where
        there are none, are 0; ``4 * (~R * S).log().norm_squared()`` is the square, smooth at 0.

        Examples
        --------
        >>> R, S = ph.Rotor.from_axis_angle(ph.e3, [10, 50], degrees=True)
        >>> print(np.degrees(R.distance(S)).round(6))
        40.0
        """
        if not isinstance(other, Rotor):
            raise TypeError(
                f"distance needs another rotor, got {type(other).__name__}{remedy_for(other, 'T.rotor')}"
            )
        if (found := _native.distance_between(self, other)) is not None:
            return found[()]
        # Half the angle has the cosine |⟨~R S⟩| and the sine |⟨~R S⟩₂| = |⟨~R (S ∓ R)⟩₂|, since ~R R is a
        # scalar; between close attitudes that difference has no rounding.
        R, S, kind = self, other, kind_of(self._data, other._data)
        if kind.native or kind.exact:  # arrays of another library stay theirs, with their derivatives
            return computed("distance", R.astype(float)._data, S.astype(float)._data)[..., 0][()]
        cosine = (~R).scalar_product(S).components[..., 0]
        nearer = S * kind.where(cosine < 0, kind.zeros_like(cosine) - 1.0, 1.0)
        sine = (~R * (nearer - R)).grade(2).norm()
        return 2 * kind.atan2(sine, kind.abs(cosine))

    def astype(self, dtype: Any) -> Rotor:
        """Return the rotor with components of another type, of norm 1 in its precision.

        Examples
        --------
        >>> ph.Rotor.random(3, rng=0).astype(np.float32).dtype
        dtype('float32')
        """
        return Rotor.from_components(Multivector.astype(self, dtype)._data)

    # --- signs and symmetries

    canonical = _signs.canonical
    continuous = _signs.continuous
    reduce = _groups.reduce

    # --- action and algebra

    def _misapplied(self, *more: Any, **named: Any) -> NoReturn:
        """Raise the TypeError for arguments that `apply` does not have."""

        def apply(self: Rotor, x: Any, *, out: Any = None) -> None: ...

        apply.__qualname__ = "Rotor.apply"
        # Of SciPy's arguments, `inverse` is the second.
        inverts = "inverse" in named or (more and isinstance(more[0], bool))
        explained = explains_calls(inverse="(~R)(x)")(apply) if inverts else explains_calls(apply)
        explained(self, None, *more, **named)
        raise AssertionError("the arguments fit")

    def _turn(self, X: Any, out: Any = None) -> Multivector:
        """``R X ~R``, for values that the native method does not cover."""
        if not isinstance(X, Multivector):  # an array would be a batch of scalars, which do not turn
            raise TypeError(
                f"a rotor acts on multivectors, got {type(X).__name__}; wrap arrays with ph.vector: "
                "R(ph.vector(x)).components"
            )
        common_algebra(self, X)
        a, b = self._data, X._data
        if not (is_float(a) and is_float(b)):
            if out is not None:
                raise TypeError(f"out needs operands of floats, got {self.dtype} and {X.dtype}")
            common_batch(self.shape, X.shape)
            kind = kind_of(a, b)
            return X._like(_generic.rotors.apply(kind, kind.asarray(a), kind.asarray(b), X._mask))
        batch, a, b = aligned(a, b)
        result = result_array((*batch, b.shape[-1]), a.dtype, (a, b), out)
        _native.rotor_apply(a, b, X._mask, result)
        return X._like(result)

    def _log(self) -> Multivector:
        """Return the logarithm, for values that the native method does not cover."""
        data = self._data
        if not is_float(data):
            return Multivector._of(_generic.rotors.log(kind_of(data), data), _BIVECTOR)
        result = new((*self.shape, 3), data.dtype)
        _native.rotor_log(data, result)
        return Multivector._of(result, _BIVECTOR)

    def inverse(self, *, errors: Errors = "raise") -> Rotor:
        """Return the rotor that turns back, ``~R``.

        Examples
        --------
        >>> R = ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True)
        >>> a = ph.vector([1, 2, 3])
        >>> bool(R.inverse()(R(a)).is_close(a))
        True
        """
        return ~self

    def sqrt(self, *, errors: Errors = "raise") -> Rotor:
        """Return the rotor of half the angle, whose square is R.

        Examples
        --------
        >>> R = ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True)
        >>> print(np.degrees(R.sqrt().angle).round(6))
        30.0
        """
        return self**0.5 if errors == "raise" else masked(errors, lambda R: R**0.5, (self, 1))

    def normalized(self, *, errors: Errors = "raise") -> Rotor:
        """Return the rotor itself, which has norm 1.

        Examples
        --------
        >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 0.5)
        >>> R.normalized() == R
        True
        """
        return self

    def grade_involution(self) -> Rotor:
        """Return the rotor itself, which is even.

        Examples
        --------
        >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 0.5)
        >>> R.grade_involution() == R
        True
        """
        return self

    def __pow__(self, n: Any) -> Rotor:
        """``exp(n log R)``: turns by n times the angle, for any real n or array of them."""
        if (found := _native.rotor_to_power(self, n)) is not None:
            return found
        if isinstance(n, int) and not is_float(self._data):
            return Rotor._from_rows(_generic.rotors.power(kind_of(self._data), self._data, n))
        powers = number_like(n, "the power of a rotor", self._data)
        if is_float(self._data) and is_float(powers):
            return _powers(self, powers)
        turn = self.log() * powers
        power: Rotor = turn.exp()
        return power


add_to(Multivector, Rotor)


def _powers(R: Rotor, n: Array) -> Rotor:
    if not np.isfinite(n).all():
        raise ValueError(f"the power of a rotor must be finite, got {n[~np.isfinite(n)][0]}")
    batch, data, exponents = aligned(R._data, n[..., np.newaxis])
    result = new((*batch, 4), data.dtype)
    _native.rotor_power(data, exponents, result)
    return Rotor._from_rows(result)


def check_rotor(value: Any, what: str) -> None:
    """Raise a TypeError for values that are not rotors."""
    if not isinstance(value, Rotor):
        raise TypeError(
            f"{what} must be a Rotor, got {type(value).__name__}; see Rotor.from_quaternion, from_matrix, "
            "from_scipy"
        )
