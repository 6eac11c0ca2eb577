"""`RigidTransform`: rotations with translations, ``y = R x ~R + x0``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.algebra import algebra
from polhode._algebra.coefficients import as_coefficients, common, kind_of, namespace, number_like
from polhode._algebra.constructors import one_grade, scalar, vector
from polhode._algebra.estimation import mean
from polhode._algebra.grades import concatenate, stack, with_grades
from polhode._algebra.jacobians import left_jacobian
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array, Shape, is_float
from polhode._support.extras import optional

if TYPE_CHECKING:
    from scipy.spatial.transform import RigidTransform as ScipyTransform
    from scipy.spatial.transform import Rotation

# Places of the components of an even element of Cl(3,0,1), whose null vector is e4, as
# (1, e12, e13, e14, e23, e24, e34, e1234).
_MOTORS = algebra(3, 0, 1)
_EVEN = 0b10101
_BIVECTOR = 0b00100


class RigidTransform:
    """A rigid displacement ``y = R x ~R + x0`` (handout eq. 4.1), or a batch of them.

    Named and shaped as ``scipy.spatial.transform.RigidTransform``: ``S * T`` moves by T first, `apply` moves
    points, and the ``as_…`` and ``from_…`` methods have its order of components. Values of any coefficients:
    floats, SymPy expressions, JAX arrays.

    Attributes
    ----------
    rotor
        R, the rotation; its batch shape is that of the transform.
    translation
        x0, a vector in the units of the points: where the origin moves.

    Parameters
    ----------
    rotor, translation
        The attributes, whose batch shapes broadcast. The translation is a vector or an array (..., 3).
        By default there is none of either.
    """

    __slots__ = ("rotor", "translation")

    rotor: Rotor
    translation: Multivector

    def __init__(self, rotor: Rotor | None = None, translation: Any = (0.0, 0.0, 0.0)) -> None:
        if rotor is None:
            rotor = Rotor.identity()
        if not isinstance(rotor, Rotor):
            raise TypeError(
                f"rotor must be a Rotor, got {type(rotor).__name__}; RigidTransform.from_components takes "
                "SciPy's rotations too"
            )
        moved = _as_vector(translation, "the translation")
        try:
            shape = np.broadcast_shapes(rotor.shape, moved.shape)
        except ValueError:
            raise ValueError(
                f"batch shapes do not broadcast: the rotor has {rotor.shape}, the translation {moved.shape}"
            ) from None
        object.__setattr__(self, "rotor", _spread(rotor, shape))
        object.__setattr__(self, "translation", _spread(moved, shape))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a RigidTransform is immutable; make a new one instead of setting {name!r}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError("a RigidTransform is immutable")

    def __reduce__(self) -> tuple[Any, ...]:
        return RigidTransform, (self.rotor, self.translation)

    # --- constructors

    @staticmethod
    def identity(shape: int | Shape = ()) -> RigidTransform:
        """Return transforms that move nothing."""
        return RigidTransform(Rotor.identity(shape))

    @staticmethod
    def from_rotation(rotation: Rotor | Rotation) -> RigidTransform:
        """From a rotor, or a ``scipy.spatial.transform.Rotation``."""
        return RigidTransform(_as_rotor(rotation))

    @staticmethod
    def from_translation(translation: Any) -> RigidTransform:
        """From a vector, or an array (..., 3)."""
        return RigidTransform(translation=translation)

    @staticmethod
    def from_components(translation: Any, rotation: Rotor | Rotation) -> RigidTransform:
        """From a translation and a rotation, in SciPy's order."""
        return RigidTransform(_as_rotor(rotation), translation)

    @staticmethod
    def from_matrix(matrix: Any, nearest: bool = False) -> RigidTransform:
        """From matrices (..., 4, 4) that act on columns (x, y, z, 1), with the last row (0, 0, 0, 1).

        The rotation is made exact as by `Rotor.from_matrix`, with its errors; with ``nearest=True`` it is the
        nearest one to any 3x3 part.
        """
        given = as_coefficients(matrix, "transformation matrix")
        if tuple(given.shape[-2:]) != (4, 4):
            raise ValueError(f"a transformation matrix has shape (..., 4, 4), got {tuple(given.shape)}")
        last, row = given[..., 3, :], np.array([0.0, 0.0, 0.0, 1.0])
        message = "the last row of a transformation matrix must be (0, 0, 0, 1)"
        if isinstance(given, np.ndarray):
            wrong = (last != row).any(axis=-1)
            if wrong.any():
                raise ValueError(f"{message}, got {last[wrong][0].tolist()}")
        else:
            kind = kind_of(given)
            kind.require(kind.xp.all(last == kind.asarray(row), axis=-1), message)
        return RigidTransform(Rotor.from_matrix(given[..., :3, :3], nearest), given[..., :3, 3])

    @staticmethod
    def from_exp_coords(exp_coords: Any) -> RigidTransform:
        """From exponential coordinates (..., 6): rotation vector (rad), then the velocity of the origin.

        The transform after unit time of a motion with this constant twist in space: a screw. It is the
        exponential of a bivector of Cl(3,0,1), see `to_motor`.
        """
        given = as_coefficients(exp_coords, "exponential coordinates")
        if not given.shape or given.shape[-1] != 6:
            raise ValueError(
                f"exponential coordinates need 6 components in the last axis, got shape {tuple(given.shape)}"
            )
        kind = kind_of(given)
        if kind.exact:  # only bivectors whose square is a number have an exact exponential
            v, rate = given[..., :3], given[..., 3:, None]
            return RigidTransform(Rotor.from_rotation_vector(v), np.matmul(left_jacobian(v), rate)[..., 0])
        a, b, c, x, y, z = (given[..., k] / (-2 if k < 3 else 2) for k in range(6))
        # Over (e12, e13, e14, e23, e24, e34): −½ of the plane of rotation and ½ v e4.
        screw = Multivector._of(kind.stack([c, -b, x, a, y, z]), _BIVECTOR, _MOTORS)
        return RigidTransform.from_motor(screw.exp())

    @staticmethod
    def from_dual_quat(dual_quat: Any, *, scalar_first: bool = False) -> RigidTransform:
        """From unit dual quaternions (..., 8): the real part, then the dual part, each ``(x, y, z, w)``.

        With `scalar_first`, each is ``(w, x, y, z)``. Both are divided by the norm of the real part; what of
        the dual part is not orthogonal to it is dropped. A ValueError for a real part 0.
        """
        given = as_coefficients(dual_quat, "dual quaternion")
        if not given.shape or given.shape[-1] != 8:
            raise ValueError(f"a dual quaternion needs 8 components, got shape {tuple(given.shape)}")
        real, dual = ([given[..., k + i] for i in range(4)] for k in (0, 4))
        if not scalar_first:
            real, dual = [real[3], *real[:3]], [dual[3], *dual[:3]]
        (w, i, j, k), (a, b, c, d) = real, dual
        return _of_motor(
            _motor(kind_of(given), [w, -k, j, b, -i, c, d, a]), "the real part of a dual quaternion"
        )

    @staticmethod
    def from_motor(M: Multivector) -> RigidTransform:
        """From a motor, an even element of ``ph.algebra(3, 0, 1)``, divided by its norm: see `to_motor`."""
        if not isinstance(M, Multivector) or M.algebra is not _MOTORS:
            raise TypeError("a motor is an even element of ph.algebra(3, 0, 1)")
        if any(k % 2 for k in M.grades):
            raise ValueError(f"a motor is an even element, got the grades {M.grades}")
        return _of_motor(M, "the rotation part of a motor")

    @staticmethod
    def from_scipy(transform: ScipyTransform) -> RigidTransform:
        """From a ``scipy.spatial.transform.RigidTransform``."""
        if not hasattr(transform, "as_components"):
            raise TypeError(
                "from_scipy needs a scipy.spatial.transform.RigidTransform, got " + type(transform).__name__
            )
        return RigidTransform.from_components(*transform.as_components())

    @staticmethod
    def concatenate(transforms: Iterable[RigidTransform]) -> RigidTransform:
        """Join transforms and batches of them along the first axis."""
        parts = [part if part.shape else part._reshaped((1,)) for part in transforms]
        rotor, translation = ([getattr(part, name) for part in parts] for name in ("rotor", "translation"))
        return RigidTransform(concatenate(rotor), concatenate(translation))

    @staticmethod
    def stack(transforms: Iterable[RigidTransform]) -> RigidTransform:
        """Join transforms of one batch shape along a new first axis."""
        parts = list(transforms)
        return RigidTransform(stack(part.rotor for part in parts), stack(part.translation for part in parts))

    # --- converters

    @property
    def rotation(self) -> Rotor:
        """The rotor, under SciPy's name."""
        return self.rotor

    def as_components(self) -> tuple[Array, Rotor]:
        """Return the translation, an array (..., 3), and the rotor, in SciPy's order."""
        return self.translation.components, self.rotor

    def as_matrix(self) -> Any:
        """Return matrices (..., 4, 4) that act on columns (x, y, z, 1)."""
        turn, moved = common(self.rotor.to_matrix(), self.translation._data)
        xp, kind = namespace(turn), kind_of(turn)
        upper = xp.concat([turn, moved[..., None]], axis=-1)
        zero = kind.zeros_like(upper[..., :1, :])
        one = kind.stack([zero[..., 0], zero[..., 0], zero[..., 0], zero[..., 0] + 1])
        return xp.concat([upper, one], axis=-2)

    def as_exp_coords(self) -> Any:
        """Return exponential coordinates (..., 6): rotation vector of at most π, then the velocity."""
        nearer = self._nearer()
        given = nearer.rotor._data, nearer.translation._data
        if not all(map(is_float, given)):  # the motor of these has no logarithm
            v = nearer.rotor.to_rotation_vector()
            inverse, v, moved = common(left_jacobian(v, inverse=True), v, given[1])
            xp = namespace(inverse)
            return xp.concat([v, xp.matmul(inverse, moved[..., None])[..., 0]], axis=-1)
        screw = nearer.to_motor().log()
        xy, xz, x4, yz, y4, z4 = _columns(screw, _BIVECTOR)
        return kind_of(screw._data).stack([-2 * yz, 2 * xz, -2 * xy, 2 * x4, 2 * y4, 2 * z4])

    def as_dual_quat(self, *, scalar_first: bool = False) -> Any:
        """Return unit dual quaternions (..., 8): see `from_dual_quat`; R and −R give opposite ones."""
        w, xy, xz, x4, yz, y4, z4, xyz4 = _columns(self.to_motor())
        real, dual = [w, -yz, xz, -xy], [xyz4, x4, y4, z4]
        if not scalar_first:
            real, dual = [*real[1:], real[0]], [*dual[1:], dual[0]]
        return kind_of(w).stack([*real, *dual])

    def to_motor(self) -> Multivector:
        """Return the motor ``M = (1 + ½ x0∧e4) R`` of ``ph.algebra(3, 0, 1)``, whose null vector is e4.

        ``M X ~M`` moves planes ``n + d e4``, those with ``n·x + d = 0``, and their intersections.
        ``M = exp(−½ B + ½ v∧e4)`` is a screw: a rotation vector dual to B, and the velocity v of the origin.
        """
        turn, moved = common(self.rotor._data, self.translation._data)
        kind = kind_of(turn)
        w, yz, zx, xy = (turn[..., k] for k in range(4))
        x, y, z = (moved[..., k] for k in range(3))
        zero = kind.zeros_like(w)
        rotor = _motor(kind, [w, xy, -zx, zero, yz, zero, zero, zero])
        return _motor(kind, [zero + 1, zero, zero, x / 2, zero, y / 2, z / 2, zero]) * rotor

    def to_scipy(self) -> ScipyTransform:
        """Return a ``scipy.spatial.transform.RigidTransform`` (SciPy 1.16 or later)."""
        transform = optional("scipy.spatial.transform", "scipy", "to_scipy")
        if not hasattr(transform, "RigidTransform"):
            raise ImportError("to_scipy needs SciPy 1.16 or later, which has RigidTransform")
        result: ScipyTransform = transform.RigidTransform.from_components(
            self.translation.components, self.rotor.to_scipy()
        )
        return result

    # --- action and algebra

    def apply(self, points: Any, inverse: bool = False) -> Any:
        """Move points: vectors to vectors, arrays (..., 3) to arrays; batch shapes broadcast.

        With `inverse`, move them back, ``~R (y − x0) R``.
        """
        given = isinstance(points, Multivector)
        x = _as_vector(points, "points")
        moved = (~self.rotor)(x - self.translation) if inverse else self.rotor(x) + self.translation
        return moved if given else moved.components

    def __call__(self, points: Any) -> Any:
        return self.apply(points)

    def __mul__(self, other: RigidTransform) -> RigidTransform:
        if not isinstance(other, RigidTransform):
            return NotImplemented
        return RigidTransform(self.rotor * other.rotor, self.apply(other.translation))

    def inv(self) -> RigidTransform:
        """Return the transform that moves back."""
        back = ~self.rotor
        return RigidTransform(back, -back(self.translation))

    def inverse(self) -> RigidTransform:
        """Return the transform that moves back."""
        return self.inv()

    def __invert__(self) -> RigidTransform:
        return self.inv()

    def __pow__(self, n: Any) -> RigidTransform:
        """``exp(n log T)``: n times the screw of at most half a turn, for any real n or array of them."""
        powers = number_like(n, "the power of a transform", self.rotor._data)
        coords = self.as_exp_coords()
        return RigidTransform.from_exp_coords(coords * namespace(coords).asarray(powers)[..., None])

    def interpolate(self, other: RigidTransform, t: Any) -> RigidTransform:
        """Return the transforms on the screw from this one (t = 0) to another (t = 1), the short way."""
        step: RigidTransform = (self.inv() * other) ** t
        return self * step

    def mean(self, weights: Any = None, axis: int | tuple[int, ...] | None = None) -> RigidTransform:
        """Return the mean over batch axes, by default all: of rotations as by `ph.mean`, and of translations.

        `weights` are numbers >= 0 that broadcast to the batch shape. A ValueError as of `ph.mean`.
        """
        turn = mean(self.rotor, weights, axis)
        if weights is None:
            return RigidTransform(turn, self.translation.mean(axis))
        given = as_coefficients(weights, "weights")
        w = scalar(namespace(given).broadcast_to(given, self.shape))
        return RigidTransform(turn, (self.translation * w).sum(axis) / w.sum(axis))

    # --- batches

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for one transform."""
        return self.rotor.shape

    @property
    def single(self) -> bool:
        """Whether this is one transform, not a batch."""
        return not self.shape

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single transform has no length; only batches have")
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __getitem__(self, index: Any) -> RigidTransform:
        return RigidTransform(self.rotor[index], self.translation[index])

    def __iter__(self) -> Iterator[RigidTransform]:
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> Any:
        """Return whether rotors and translations are equal, by element."""
        if not isinstance(other, RigidTransform):
            return NotImplemented
        return (self.rotor == other.rotor) & (self.translation == other.translation)

    __hash__ = None  # type: ignore[assignment]  # equality is by element

    def is_close(self, other: RigidTransform, rtol: float = 1e-9, atol: float = 0.0) -> Any:
        """Return whether two transforms are close: angle in rad below `rtol`, translations as vectors are."""
        near = self.rotor.distance(other.rotor) <= rtol
        return near & self.translation.is_close(other.translation, rtol, atol)

    def __repr__(self) -> str:
        if self.shape:
            return f"RigidTransform(batch {self.shape})"
        return f"RigidTransform(rotor={self.rotor}, translation={self.translation})"

    def _reshaped(self, shape: Sequence[int]) -> RigidTransform:
        return RigidTransform(self.rotor.reshape(*shape), self.translation.reshape(*shape))

    def _nearer(self) -> RigidTransform:
        """Return the same transform with the rotor of a turn of at most π."""
        return RigidTransform(self.rotor.canonical(), self.translation)


def _as_vector(value: Any, what: str) -> Multivector:
    return one_grade(value, 1, what) if isinstance(value, Multivector) else vector(value)


def _spread(value: Any, shape: Shape) -> Any:
    if value.shape == shape:
        return value
    data = namespace(value._data).broadcast_to(value._data, (*shape, value._data.shape[-1]))
    return value._like(np.ascontiguousarray(data) if isinstance(data, np.ndarray) else data)


def _as_rotor(rotation: Any) -> Rotor:
    return rotation if isinstance(rotation, Rotor) else Rotor.from_scipy(rotation)


def _columns(value: Multivector, mask: int = _EVEN) -> list[Any]:
    data = with_grades(value, mask)
    return [data[..., k] for k in range(data.shape[-1])]


def _motor(kind: Any, columns: list[Any]) -> Multivector:
    return Multivector._of(kind.stack(columns), _EVEN, _MOTORS)


def _of_motor(M: Multivector, part: str) -> RigidTransform:
    """Return the transform of an even element that need not have norm 1; `part` must not be 0."""
    w, xy, xz, _, yz, *_ = _columns(M)
    kind = kind_of(w)
    zero = kind.zeros_like(w)
    turn = _motor(kind, [w, xy, xz, zero, yz, zero, zero, zero])
    # M = (1 + ½ x0∧e4) R, with R of any norm.
    size = turn.norm_squared()
    if not kind.exact:
        kind.require(kind.asarray(size) > 0, f"{part} must be finite and not 0")
    _, _, _, x, _, y, z, _ = _columns(M * ~turn / size)
    rotor = Rotor.from_components(kind.stack([w, yz, -xz, xy]))
    return RigidTransform(rotor, kind.stack([2 * x, 2 * y, 2 * z]))
