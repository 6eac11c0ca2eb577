"""The module `quaternion` of numpy-quaternion as a layer over Polhode, for that library's own tests.

A quaternion w + xi + yj + zk is the even value w − x e2e3 − y e3e1 − z e1e2. Every result is computed by
Polhode; the layer translates names, orders and arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import polhode as ph
from peer_tests import MISSING

ORDER = "wxyz"


def missing(what: str) -> Any:
    """End a test that needs what Polhode does not have."""
    return pytest.skip(MISSING + what)


class quaternion:  # noqa: N801  # the name of the library
    """A quaternion: an even multivector."""

    shape = ()
    ndim = 0
    dtype = np.dtype(object)
    __slots__ = ("value",)

    def __init__(self, *numbers: Any):
        if len(numbers) == 1 and isinstance(numbers[0], quaternion):
            self.value = numbers[0].value
            return
        if len(numbers) not in (0, 1, 3, 4):
            raise TypeError(f"a quaternion has 0, 1, 3 or 4 numbers, got {len(numbers)}")
        w = float(numbers[0]) if len(numbers) in (1, 4) else 0.0
        parts = [float(x) for x in numbers[-3:]] if len(numbers) > 1 else [0.0, 0.0, 0.0]
        self.value = ph.scalar(w) + ph.bivector([-x for x in parts])

    @classmethod
    def of(cls, value: Any) -> quaternion:
        self = cls.__new__(cls)
        self.value = value
        return self

    # --- components

    @property
    def components(self) -> Any:
        return np.array([float(self.value.grade(0)), *(0.0 - self.value.grade(2).components)])

    @components.setter
    def components(self, numbers: Any) -> None:
        self.value = quaternion(*_numbers(numbers, 4)).value

    @property
    def vec(self) -> Any:
        return self.components[1:]

    @vec.setter
    def vec(self, numbers: Any) -> None:
        self.value = quaternion(self.w, *_numbers(numbers, 3)).value

    imag = vec

    w = real = property(lambda self: self.components[0])
    x = property(lambda self: self.components[1])
    y = property(lambda self: self.components[2])
    z = property(lambda self: self.components[3])
    a = property(lambda self: self.w + 1j * self.z)
    b = property(lambda self: self.y + 1j * self.x)

    def copy(self) -> quaternion:
        return quaternion.of(self.value)

    # --- tests

    def nonzero(self) -> bool:
        return bool((self.value != 0) if not self.isnan() else True)

    def isnan(self) -> bool:
        return bool(np.isnan(self.components).any())

    def isinf(self) -> bool:
        return bool(np.isinf(self.components).any())

    def isfinite(self) -> bool:
        return bool(self.value.is_finite())

    __bool__ = nonzero

    def __eq__(self, other: Any) -> Any:
        value = _value(other)
        return NotImplemented if value is None else bool(self.value == value)

    def __ne__(self, other: Any) -> Any:
        value = _value(other)
        return NotImplemented if value is None else bool(self.value != value)

    __hash__ = None  # type: ignore[assignment]

    def _order(self, *_: Any) -> Any:
        return missing("an order of quaternions")

    __lt__ = __le__ = __gt__ = __ge__ = greater = greater_equal = _order

    # --- numbers

    def abs(self) -> float:
        return float(self.value.norm())

    __abs__ = abs

    def norm(self) -> float:
        return float(self.value.norm_squared())

    def angle(self) -> float:
        return 2.0 * float(self.value.normalized().log().norm())

    # --- quaternions

    def conjugate(self) -> quaternion:
        return quaternion.of(~self.value)

    conj = conjugate

    def inverse(self) -> quaternion:
        return quaternion.of(self.value.inverse())

    reciprocal = __invert__ = inverse

    def normalized(self) -> quaternion:
        return quaternion.of(self.value.normalized(errors="mask"))

    def sqrt(self) -> quaternion:
        return quaternion.of(self.value.sqrt())

    def square(self) -> quaternion:
        return quaternion.of(self.value * self.value)

    def exp(self) -> quaternion:
        return quaternion.of(self.value.exp())

    def log(self) -> quaternion:
        return quaternion.of(self.value.log())

    def parity_conjugate(self) -> Any:
        return parity()

    x_parity_conjugate = y_parity_conjugate = z_parity_conjugate = parity_conjugate

    def copysign(self, *_: Any) -> Any:
        return missing("copysign")

    # --- operators

    def __neg__(self) -> quaternion:
        return quaternion.of(-self.value)

    def __pos__(self) -> quaternion:
        return self

    def __pow__(self, n: Any) -> Any:
        if isinstance(n, quaternion):
            return (self.log() * n).exp() if self.nonzero() else self
        return quaternion.of(self.value**n)

    def __rpow__(self, base: float) -> quaternion:
        return quaternion.of(base**self.value)

    def __repr__(self) -> str:
        return "quaternion({})".format(", ".join(map(repr, self.components.tolist())))


def _operator(function: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def method(self: quaternion, other: Any) -> Any:
        value = _value(other)
        return NotImplemented if value is None else quaternion.of(function(self.value, value))

    return method


quaternion.__add__ = quaternion.__radd__ = _operator(lambda p, q: p + q)  # type: ignore[attr-defined]
quaternion.__sub__ = _operator(lambda p, q: p - q)  # type: ignore[attr-defined]
quaternion.__rsub__ = _operator(lambda p, q: q - p)  # type: ignore[attr-defined]
quaternion.__mul__ = _operator(lambda p, q: p * q)  # type: ignore[attr-defined]
quaternion.__rmul__ = _operator(lambda p, q: q * p)  # type: ignore[attr-defined]
quaternion.__truediv__ = quaternion.__floordiv__ = _operator(lambda p, q: p / q)  # type: ignore[attr-defined]
quaternion.__rtruediv__ = _operator(lambda p, q: q / p)  # type: ignore[attr-defined]


def _value(other: Any) -> Any:
    if isinstance(other, quaternion):
        return other.value
    return float(other) if isinstance(other, (int, float, np.integer, np.floating)) else None


def _numbers(numbers: Any, count: int) -> list[float]:
    if isinstance(numbers, str) or len(numbers) != count:
        raise TypeError(f"{count} numbers are needed, got {numbers!r}")
    return [float(x) for x in numbers]


def parity(*_: Any) -> Any:
    """End a test of parity conjugates."""
    return missing("parity conjugates")


zero, one = quaternion(), quaternion(1.0)
x, y, z = (quaternion(*row) for row in np.eye(3))


# --- arrays: objects on the side of the tests, batches on ours


def as_float_array(quaternions: Any) -> Any:
    """Numbers (..., 4) of quaternions (...)."""
    objects = np.asarray(quaternions, dtype=object)
    return np.array([q.components for q in objects.ravel()]).reshape(*objects.shape, 4)


def as_quat_array(numbers: Any) -> Any:
    """Quaternions of numbers whose last axis has length 4 or a multiple."""
    floats = np.asarray(numbers, dtype=float)
    if floats.shape[-1] % 4:
        raise ValueError("the last axis must have a multiple of four numbers")
    rows = floats.reshape(-1, 4)
    objects = np.empty(len(rows), dtype=object)
    objects[:] = [quaternion(*row) for row in rows]
    shape = floats.shape[:-1] if floats.shape[-1] == 4 else (*floats.shape[:-1], floats.shape[-1] // 4)
    return objects.reshape(shape)[()]


from_float_array = as_quat_array


def from_vector_part(vectors: Any, vector_axis: int = -1) -> Any:
    """Quaternions without real part."""
    rows = np.moveaxis(np.asarray(vectors, dtype=float), vector_axis, -1)
    return as_quat_array(np.insert(rows, 0, 0.0, axis=-1))


def as_vector_part(quaternions: Any) -> Any:
    """Vector parts (..., 3)."""
    return as_float_array(quaternions)[..., 1:]


def _rotors(quaternions: Any) -> ph.Rotor:
    return ph.Rotor.from_quaternion(as_float_array(quaternions), order=ORDER)


def _quaternions(rotors: Any) -> Any:
    return as_quat_array(rotors.to_quaternion(order=ORDER))


def as_rotation_matrix(quaternions: Any) -> Any:
    """Matrices (..., 3, 3); zeros have none."""
    try:
        return _rotors(quaternions).to_matrix()
    except ValueError as error:
        raise ZeroDivisionError(str(error)) from error


def from_rotation_matrix(matrices: Any, nonorthogonal: bool = True) -> Any:
    """Quaternions of matrices, of the nearest rotations if `nonorthogonal`."""
    return _quaternions(ph.Rotor.from_matrix(matrices, nearest=nonorthogonal))


def as_rotation_vector(quaternions: Any) -> Any:
    """Axes times angles (..., 3)."""
    return _rotors(quaternions).to_rotation_vector()


def from_rotation_vector(vectors: Any) -> Any:
    """Quaternions of axes times angles."""
    return _quaternions(ph.Rotor.from_rotation_vector(vectors))


def rotate_vectors(quaternions: Any, vectors: Any, axis: int = -1) -> Any:
    """Turn every vector by every quaternion."""
    rows = np.moveaxis(np.asarray(vectors, dtype=float), axis, -1)
    rotors = _rotors(quaternions)
    turned = rotors.reshape(*rotors.shape, *(1,) * (rows.ndim - 1))(ph.vector(rows)).components
    return np.moveaxis(turned, -1, len(rotors.shape) + axis % rows.ndim)


def _angles(*given: Any) -> Any:
    return np.asarray(given[0] if len(given) == 1 else np.stack(np.broadcast_arrays(*given), axis=-1))


def from_euler_angles(*angles: Any) -> Any:
    """Turns by α, β, γ about z, y, z: about the turned axes."""
    return _quaternions(ph.Rotor.from_euler("ZYZ", _angles(*angles)))


def as_euler_angles(quaternions: Any) -> Any:
    """Angles (..., 3) of `from_euler_angles`."""
    return _rotors(quaternions).to_euler("ZYZ")


def from_spherical_coords(*angles: Any) -> Any:
    """The turn that takes z to the direction ϑ, φ."""
    polar = _angles(*angles)
    return from_euler_angles(polar[..., 1], polar[..., 0], 0.0 * polar[..., 0])


def as_spherical_coords(quaternions: Any) -> Any:
    """Direction (ϑ, φ) to which z turns."""
    return as_euler_angles(quaternions)[..., 1::-1]


def rotation_intrinsic_distance(p: Any, q: Any) -> Any:
    """Angle between rotations."""
    return _rotors(p).distance(_rotors(q))


def rotation_chordal_distance(p: Any, q: Any) -> Any:
    """Return the smaller of |p − q| and |p + q|."""
    first, second = _rotors(p), _rotors(q)
    return np.minimum((first - second).norm(), (first + second).norm())


def rotor_chordal_distance(p: Any, q: Any) -> Any:
    """|p − q|."""
    return (_rotors(p) - _rotors(q)).norm()


def rotor_intrinsic_distance(p: Any, q: Any) -> Any:
    """2 |log(p⁻¹ q)|, with the signs of the rotors."""
    return 2.0 * (~_rotors(p) * _rotors(q)).log().norm()


def slerp_evaluate(p: Any, q: Any, part: Any) -> Any:
    """The rotation between p and q at a part of the way."""
    return _quaternions(ph.slerp(_rotors(p), _rotors(q), part))


def slerp(p: Any, q: Any, start: float, end: float, times: Any) -> Any:
    """Rotations at times from `start`, at p, to `end`, at q."""
    return slerp_evaluate(p, q, (np.asarray(times) - start) / (end - start))


def mean_rotor_in_chordal_metric(quaternions: Any, times: Any = None) -> Any:
    """The mean rotation."""
    if times is not None:
        return missing("means of curves")
    return _quaternions(ph.mean(_rotors(quaternions)))


def isclose(
    a: Any, b: Any, rtol: float = 4 * np.finfo(float).eps, atol: float = 0.0, equal_nan: bool = False
) -> Any:
    """Compare quaternions by the norm of their difference."""
    p, q = (ph.multivector(_full(side)) for side in (a, b))
    with np.errstate(invalid="ignore"):
        close = (p == q) | ((p - q).norm() <= atol + rtol * q.norm())
    return close | (np.isnan(p.norm()) & np.isnan(q.norm()) if equal_nan else False)


def _full(quaternions: Any) -> Any:
    numbers = as_float_array(quaternions)
    rows = np.zeros((*numbers.shape[:-1], 8))
    rows[..., 0], rows[..., 4:7] = numbers[..., 0], -numbers[..., 1:]
    return rows


def allclose(a: Any, b: Any, rtol: float = 4 * np.finfo(float).eps, atol: float = 0.0, **options: Any) -> Any:
    """Compare quaternions, or arrays of numbers."""
    options.pop("verbose", None)
    first = np.asarray(a, dtype=object).ravel()
    if first.size and not isinstance(first[0], quaternion):
        return np.allclose(np.asarray(a, dtype=float), np.asarray(b, dtype=float), rtol, atol, **options)
    return np.all(isclose(a, b, rtol, atol, **options))


def __getattr__(name: str) -> Any:
    if name.startswith("__"):
        raise AttributeError(name)
    return lambda *_, **__: missing(f"the function {name}")
