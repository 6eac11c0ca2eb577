"""SciPy's `Rotation` and `Slerp` as a thin layer over `ph.Rotor`, for SciPy's own tests of them.

Every result is computed by Polhode; the layer translates names, argument orders and the shapes of lists.
"""

from __future__ import annotations

import copy
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

import polhode as ph

FIRST, LAST = "wxyz", "xyzw"


def _order(scalar_first: bool) -> Any:
    return FIRST if scalar_first else LAST


def _shape(num: int | None, shape: Any) -> Any:
    if num is not None and shape is not None:
        raise ValueError("give one of num and shape")
    if isinstance(shape, float):
        raise ValueError("a shape is a whole number or a tuple of them")
    return shape if shape is not None else () if num is None else num


def _angles(values: Any, degrees: bool) -> Any:
    return np.rad2deg(values) if degrees else values


class Rotation:
    """A rotation or an array of rotations, without the sign of the rotor."""

    __array_priority__ = 20

    def __init__(self, quat: Any, normalize: bool = True, copy: bool = True, scalar_first: bool = False):
        self.rotor = ph.Rotor.from_quaternion(np.asarray(quat, dtype=float), order=_order(scalar_first))

    @classmethod
    def of(cls, rotor: ph.Rotor) -> Rotation:
        """The rotation of a rotor."""
        self = cls.__new__(cls)
        self.rotor = rotor
        return self

    # --- from and to numbers

    @classmethod
    def from_quat(cls, quat: Any, *, scalar_first: bool = False) -> Rotation:
        return cls(quat, scalar_first=scalar_first)

    def as_quat(self, canonical: bool = False, *, scalar_first: bool = False) -> Any:
        rotor = self.rotor.canonical() if canonical else self.rotor
        return rotor.to_quaternion(order=_order(scalar_first))

    @classmethod
    def from_matrix(cls, matrix: Any, *, assume_valid: bool = False) -> Rotation:
        return cls.of(ph.Rotor.from_matrix(np.asarray(matrix, dtype=float), nearest=not assume_valid))

    def as_matrix(self) -> Any:
        return self.rotor.to_matrix()

    @classmethod
    def from_rotvec(cls, rotvec: Any, degrees: bool = False) -> Rotation:
        given = np.asarray(rotvec, dtype=float)
        return cls.of(ph.Rotor.from_rotation_vector(np.deg2rad(given) if degrees else given))

    def as_rotvec(self, degrees: bool = False) -> Any:
        return _angles(self.rotor.to_rotation_vector(), degrees)

    @classmethod
    def from_mrp(cls, mrp: Any) -> Rotation:
        return cls.of(ph.Rotor.from_mrp(np.asarray(mrp, dtype=float)))

    def as_mrp(self) -> Any:
        return self.rotor.to_mrp()

    @classmethod
    def from_euler(cls, seq: str, angles: Any, degrees: bool = False) -> Rotation:
        return cls.of(ph.Rotor.from_euler(seq, angles, degrees))

    def as_euler(self, seq: str, degrees: bool = False, *, suppress_warnings: bool = False) -> Any:
        angles = self.rotor.to_euler(seq, degrees)
        middle = np.deg2rad(angles[..., 1]) if degrees else angles[..., 1]
        apart = np.sin(middle) if seq[0] == seq[2] else np.cos(middle)
        if np.any(np.abs(apart) < 1e-7) and not suppress_warnings:
            warnings.warn("Gimbal lock detected.", UserWarning, stacklevel=2)
        return angles

    @classmethod
    def from_davenport(cls, axes: Any, order: str, angles: Any, degrees: bool = False) -> Rotation:
        return cls.of(ph.Rotor.from_davenport(axes, order, angles, degrees))

    def as_davenport(
        self, axes: Any, order: str, degrees: bool = False, *, suppress_warnings: bool = False
    ) -> Any:
        return self.rotor.to_davenport(axes, order, degrees)

    # --- operations

    def apply(self, vectors: Any, inverse: bool = False) -> Any:
        rotor = ~self.rotor if inverse else self.rotor
        return rotor(ph.vector(np.asarray(vectors, dtype=float))).components

    def __mul__(self, other: Any) -> Any:
        if not isinstance(other, Rotation):
            return NotImplemented
        return Rotation.of(self.rotor * other.rotor)

    def __pow__(self, n: float, modulus: None = None) -> Rotation:
        if modulus is not None:
            raise NotImplementedError("modulus not supported")
        if np.size(n) != 1:
            raise ValueError("the exponent must be a single number")
        return Rotation.of(self.rotor.canonical() ** np.ravel(n)[0])

    def inv(self) -> Rotation:
        return Rotation.of(~self.rotor)

    def magnitude(self) -> Any:
        return self.rotor.magnitude()

    def approx_equal(self, other: Rotation, atol: float | None = None, degrees: bool = False) -> Any:
        if atol is None and degrees:
            warnings.warn("atol must be set to use the degrees flag", UserWarning, stacklevel=2)
        atol = 1e-8 if atol is None else np.deg2rad(atol) if degrees else atol
        return self.rotor.distance(other.rotor) < atol

    def mean(self, weights: Any = None, axis: Any = None) -> Rotation:
        return Rotation.of(ph.mean(self.rotor, weights, axis))

    def reduce(self, left: Any = None, right: Any = None, return_indices: bool = False) -> Any:
        given = (None if group is None else group.rotor for group in (left, right))
        result = self.rotor.reduce(*given, return_indices=return_indices)
        return (Rotation.of(result[0]), *result[1:]) if return_indices else Rotation.of(result)

    @classmethod
    def create_group(cls, group: str, axis: str = "Z") -> Rotation:
        return cls.of(ph.Rotor.group(group, axis.lower() if isinstance(axis, str) else axis))

    @classmethod
    def align_vectors(cls, a: Any, b: Any, weights: Any = None, return_sensitivity: bool = False) -> Any:
        a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
        if a.shape == b.shape == (3,) or a.shape == b.shape == (1, 3):
            if return_sensitivity:
                raise ValueError("a single pair has no sensitivity")
            rotor = ph.Rotor.from_vectors(b.ravel(), a.ravel())
            return cls.of(rotor), float(np.linalg.norm(a - rotor(ph.vector(b)).components))
        found = ph.align(b, a, weights)
        result = (cls.of(found.rotor), found.residual)
        mean = 1.0 if weights is None else np.mean(weights)
        return (*result, mean * found.covariance) if return_sensitivity else result

    @classmethod
    def identity(cls, num: int | None = None, *, shape: Any = None) -> Rotation:
        return cls.of(ph.Rotor.identity(_shape(num, shape)))

    @classmethod
    def random(
        cls, num: int | None = None, rng: Any = None, *, shape: Any = None, random_state: Any = None
    ) -> Rotation:
        rng = np.random.default_rng(rng if random_state is None else random_state)
        return cls.of(ph.Rotor.random(_shape(num, shape), rng))

    @classmethod
    def concatenate(cls, rotations: Any) -> Rotation:
        each = [rotations] if isinstance(rotations, Rotation) else list(rotations)
        if not all(isinstance(rotation, Rotation) for rotation in each):
            raise TypeError("input must contain Rotation objects only")
        return cls.of(ph.concatenate([r.rotor if r.shape else r.rotor.reshape(1) for r in each]))

    # --- arrays

    @property
    def shape(self) -> tuple[int, ...]:
        return self.rotor.shape

    @property
    def single(self) -> bool:
        return self.shape == ()

    def __len__(self) -> int:
        if self.single:
            raise TypeError("Single rotation has no len().")
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Rotation]:
        if self.single:
            raise TypeError("Single rotation is not iterable.")
        return (self[k] for k in range(len(self)))

    def __getitem__(self, index: Any) -> Rotation:
        if self.single:
            raise TypeError("Single rotation is not subscriptable.")
        if isinstance(index, list):
            index = np.asarray(index, dtype=None if index else int)
        return Rotation.of(self.rotor[index])

    @property
    def _quat(self) -> Any:
        return self.as_quat()

    def __setitem__(self, index: Any, value: Any) -> None:
        if self.single:
            raise TypeError("Single rotation is not subscriptable.")
        if not isinstance(value, Rotation):
            raise TypeError("value must be a Rotation object")
        rows = np.array(self.rotor.components)
        rows[index] = value.rotor.components
        self.rotor = ph.Rotor.from_components(rows)

    def __copy__(self) -> Rotation:
        return Rotation.of(self.rotor)

    def __deepcopy__(self, memo: Any) -> Rotation:
        return Rotation.of(copy.deepcopy(self.rotor, memo))

    def __repr__(self) -> str:
        lines = repr(self.as_matrix()).splitlines()
        return ("\n" + " " * 21).join(["Rotation.from_matrix(" + lines[0], *lines[1:]]) + ")"


class Slerp:
    """Interpolation along the shortest arcs between rotations at rising times."""

    def __init__(self, times: Any, rotations: Rotation):
        if not isinstance(rotations, Rotation):
            raise TypeError("`rotations` must be a `Rotation` instance.")
        if rotations.single or len(rotations) <= 1:
            raise ValueError("`rotations` must be a sequence of at least 2 rotations.")
        if len(rotations.shape) > 1:
            raise ValueError("Rotations with more than 1 leading dimension are not supported.")
        self.times = np.asarray(times)
        if self.times.ndim != 1:
            raise ValueError("Expected times to be specified in a 1 dimensional array")
        if self.times.shape[0] != len(rotations):
            raise ValueError("Expected number of rotations to be equal to number of timestamps given")
        if np.any(np.diff(self.times) <= 0):
            raise ValueError("Times must be in strictly increasing order.")
        self.rotors = rotations.rotor

    def __call__(self, times: Any) -> Rotation:
        at = np.asarray(times)
        if at.ndim > 1:
            raise ValueError("`times` must be at most 1-dimensional.")
        if np.any((at < self.times[0]) | (at > self.times[-1])):
            raise ValueError("Interpolation times must be within the range of times")
        k = np.clip(np.searchsorted(self.times, at, side="right") - 1, 0, len(self.times) - 2)
        parts = (at - self.times[k]) / (self.times[k + 1] - self.times[k])
        return Rotation.of(ph.slerp(self.rotors[k], self.rotors[k + 1], parts))


class RotationSpline:
    """A smooth curve through rotations at rising times."""

    def __init__(self, times: Any, rotations: Rotation):
        if rotations.single or len(rotations) < 2:
            raise ValueError("a spline needs two rotations or more")
        self.times, self.rotations = np.asarray(times, dtype=float), rotations
        self.spline = ph.RotorSpline(self.times, rotations.rotor, extrapolate=True)

    def __call__(self, times: Any, order: int = 0) -> Any:
        if order not in (0, 1, 2):
            raise ValueError("order must be 0, 1 or 2")
        if np.ndim(times) > 1:
            raise ValueError("times must be at most 1-dimensional")
        if order == 0:
            return Rotation.of(self.spline(times))
        return (self.spline.omega_body if order == 1 else self.spline.alpha_body)(times).components


class RigidTransform:
    """Rotations and translations, `ph.RigidTransform` with SciPy's rotations."""

    __array_priority__ = 20

    def __init__(self, matrix: Any, normalize: bool = True, copy: bool = True):
        self.motion = ph.RigidTransform.from_matrix(np.asarray(matrix, dtype=float), nearest=normalize)

    @classmethod
    def of(cls, motion: ph.RigidTransform) -> RigidTransform:
        self = cls.__new__(cls)
        self.motion = motion
        return self

    @classmethod
    def identity(cls, num: int | None = None, *, shape: Any = None) -> RigidTransform:
        return cls.of(ph.RigidTransform.identity(_shape(num, shape)))

    @classmethod
    def from_matrix(cls, matrix: Any) -> RigidTransform:
        return cls(matrix)

    @classmethod
    def from_rotation(cls, rotation: Rotation) -> RigidTransform:
        if not isinstance(rotation, Rotation):
            raise ValueError("expected a Rotation")
        return cls.of(ph.RigidTransform.from_rotation(rotation.rotor))

    @classmethod
    def from_translation(cls, translation: Any) -> RigidTransform:
        return cls.of(ph.RigidTransform.from_translation(translation))

    @classmethod
    def from_components(cls, translation: Any, rotation: Rotation) -> RigidTransform:
        return cls.of(ph.RigidTransform.from_components(translation, rotation.rotor))

    @classmethod
    def from_exp_coords(cls, coordinates: Any) -> RigidTransform:
        return cls.of(ph.RigidTransform.from_exp_coords(coordinates))

    @classmethod
    def from_dual_quat(cls, dual_quat: Any, *, scalar_first: bool = False) -> RigidTransform:
        return cls.of(ph.RigidTransform.from_dual_quat(dual_quat, scalar_first=scalar_first))

    @classmethod
    def concatenate(cls, transforms: Any) -> RigidTransform:
        each = [transforms] if isinstance(transforms, RigidTransform) else list(transforms)
        if not all(isinstance(transform, RigidTransform) for transform in each):
            raise TypeError("input must contain RigidTransform objects only")
        return cls.of(ph.RigidTransform.concatenate([one.motion for one in each]))

    def as_matrix(self) -> Any:
        return self.motion.as_matrix()

    @property
    def _matrix(self) -> Any:
        return self.as_matrix()

    def as_components(self) -> tuple[Any, Rotation]:
        translation, rotor = self.motion.as_components()
        return translation, Rotation.of(rotor)

    def as_exp_coords(self) -> Any:
        return self.motion.as_exp_coords()

    def as_dual_quat(self, *, scalar_first: bool = False) -> Any:
        return self.motion.as_dual_quat(scalar_first=scalar_first)

    @property
    def rotation(self) -> Rotation:
        return Rotation.of(self.motion.rotation)

    @property
    def translation(self) -> Any:
        return self.motion.as_components()[0]

    def apply(self, vector: Any, inverse: bool = False) -> Any:
        return self.motion.apply(np.asarray(vector, dtype=float), inverse)

    def __mul__(self, other: Any) -> Any:
        if not isinstance(other, RigidTransform):
            return NotImplemented
        return RigidTransform.of(self.motion * other.motion)

    def __pow__(self, n: float) -> RigidTransform:
        return RigidTransform.of(self.motion**n)

    def inv(self) -> RigidTransform:
        return RigidTransform.of(self.motion.inv())

    def mean(self, weights: Any = None, axis: Any = None) -> RigidTransform:
        return RigidTransform.of(self.motion.mean(weights, axis))

    @property
    def shape(self) -> tuple[int, ...]:
        return self.motion.shape

    @property
    def single(self) -> bool:
        return self.motion.single

    def __len__(self) -> int:
        return len(self.motion)

    def __iter__(self) -> Iterator[RigidTransform]:
        return (RigidTransform.of(one) for one in self.motion)

    def __getitem__(self, index: Any) -> RigidTransform:
        if isinstance(index, list):
            index = np.asarray(index, dtype=None if index else int)
        return RigidTransform.of(self.motion[index])

    def __setitem__(self, index: Any, value: Any) -> None:
        if not isinstance(value, RigidTransform):
            raise TypeError("value must be a RigidTransform object")
        if self.single:
            raise TypeError("a single transform has no batch")
        matrices = self.as_matrix()
        matrices[index] = value.as_matrix()
        self.motion = ph.RigidTransform.from_matrix(matrices)

    def __repr__(self) -> str:
        lines = repr(self.as_matrix()).splitlines()
        return ("\n" + " " * 27).join(["RigidTransform.from_matrix(" + lines[0], *lines[1:]]) + ")"
