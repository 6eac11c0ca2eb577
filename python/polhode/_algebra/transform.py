"""`RigidTransform`: rotations with translations, ``y = R x ~R + x0``."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Never, NoReturn

import numpy as np

from polhode._algebra import transform_conversions as _conversions
from polhode._algebra.coefficients import (
    as_coefficients,
    common,
    namespace,
    number_like,
    register_pytrees,
)
from polhode._algebra.constructors import scalar
from polhode._algebra.estimation import mean
from polhode._algebra.foreign_tables import TRANSFORM
from polhode._algebra.foreign_values import has_reflected
from polhode._algebra.grades import concatenate, stack
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._algebra.screws import adjoint_matrix, screw_parameters
from polhode._algebra.transform_arguments import as_rotor, as_vector, not_a_rotor, refuse, required, spread
from polhode._algebra.transform_batches import TransformBatch
from polhode._support.arrays import Array, Shape, common_batch, is_float, power_of_two
from polhode._support.calls import explains_calls_of
from polhode._support.extras import register_pytree
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names

if TYPE_CHECKING:
    from scipy.spatial.transform import RigidTransform as ScipyTransform
    from scipy.spatial.transform import Rotation


@with_foreign_names(TRANSFORM)
@explains_calls_of
class RigidTransform(TransformBatch, metaclass=ListsOwnNames):
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

    Examples
    --------
    Turn by a quarter about e3, then move by 10 along e1; twice this, and back:

    >>> R = ph.Rotor.from_axis_angle(ph.e3, 90, degrees=True)
    >>> T = ph.RigidTransform(R, [10, 0, 0])
    >>> T.apply(ph.e1)
    10 e1 + e2
    >>> (T * T).apply(ph.e1)
    9 e1 + 10 e2
    >>> bool((T.inv() * T).is_close(ph.RigidTransform(), atol=1e-12))
    True
    """

    __slots__ = ()
    __array_ufunc__ = None  # NumPy leaves operators to transforms

    def __init__(self, rotor: Rotor | None = None, translation: Any = (0.0, 0.0, 0.0)) -> None:
        if rotor is None:
            rotor = Rotor.identity()
        if not isinstance(rotor, Rotor):
            raise not_a_rotor(rotor, translation)
        moved = as_vector(translation, "the translation")
        try:
            shape = np.broadcast_shapes(rotor.shape, moved.shape)
        except ValueError:
            raise ValueError(
                f"batch shapes do not broadcast: the rotor has {rotor.shape}, the translation {moved.shape}"
            ) from None
        self._set(spread(rotor, shape), spread(moved, shape))
        _register_pytrees()

    def _like(self, rotor: Rotor, translation: Multivector) -> RigidTransform:
        return RigidTransform(rotor, translation)

    def __reduce__(self) -> tuple[Any, ...]:
        return RigidTransform, (self.rotor, self.translation)

    # --- constructors

    @staticmethod
    def identity(shape: int | Shape = ()) -> RigidTransform:
        """Return transforms that move nothing.

        Examples
        --------
        >>> ph.RigidTransform.identity(5).shape
        (5,)
        """
        return RigidTransform(Rotor.identity(shape))

    @staticmethod
    def from_rotation(rotation: Rotor | Rotation) -> RigidTransform:
        """From a rotor, or a ``scipy.spatial.transform.Rotation``.

        Examples
        --------
        >>> T = ph.RigidTransform.from_rotation(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True))
        >>> T.apply(ph.e1)
        0.5 e1 + 0.8660254 e2
        """
        return RigidTransform(as_rotor(rotation))

    @staticmethod
    def from_translation(translation: Any) -> RigidTransform:
        """From a vector, or an array (..., 3).

        Examples
        --------
        >>> ph.RigidTransform.from_translation([1, 2, 3]).apply(ph.e1)
        2 e1 + 2 e2 + 3 e3
        """
        return RigidTransform(translation=translation)

    @staticmethod
    def from_components(translation: Any, rotation: Rotor | Rotation) -> RigidTransform:
        """From a translation and a rotation, in SciPy's order.

        Examples
        --------
        >>> R = ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True)
        >>> ph.RigidTransform.from_components([0, 0, 5], R).apply(ph.e1)
        0.5 e1 + 0.8660254 e2 + 5 e3
        """
        if isinstance(translation, Rotor) or hasattr(translation, "as_quat"):
            raise TypeError(
                "the translation comes first: write RigidTransform.from_components(x, R), or with the rotor "
                "first RigidTransform(R, x)"
            )
        return RigidTransform(as_rotor(rotation), translation)

    @staticmethod
    def from_matrix(matrix: Any, nearest: bool = False) -> RigidTransform:
        """From matrices (..., 4, 4) that act on columns (x, y, z, 1), with the last row (0, 0, 0, 1).

        The rotation is made exact as by `Rotor.from_matrix`, with its errors; with ``nearest=True`` it is the
        nearest one to any 3x3 part.

        Examples
        --------
        >>> T = ph.RigidTransform.from_matrix([[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]])
        >>> T.translation
        5 e1 + 6 e2 + 7 e3
        >>> T.apply(ph.e1)
        5 e1 + 7 e2 + 7 e3
        """
        return RigidTransform(*_conversions.parts_of_matrix(matrix, nearest))

    @staticmethod
    def from_exp_coords(exp_coords: Any) -> RigidTransform:
        """From exponential coordinates (..., 6): rotation vector (rad), then the velocity of the origin.

        The transform after unit time of a motion with this constant twist in space: a screw. It is the
        exponential of a bivector of Cl(3,0,1), see `to_motor`.

        Examples
        --------
        A turn of 60° about e3 while moving by 2 along it:

        >>> T = ph.RigidTransform.from_exp_coords([0, 0, np.pi / 3, 0, 0, 2])
        >>> T.translation
        2 e3
        >>> T.apply(ph.e1)
        0.5 e1 + 0.8660254 e2 + 2 e3
        """
        return RigidTransform(*_conversions.parts_of_exp_coords(exp_coords))

    @staticmethod
    def exp(exp_coords: Any) -> RigidTransform:
        """Return `from_exp_coords`: the exponential of a screw, its rotation vector first.

        Examples
        --------
        >>> T = ph.RigidTransform.from_components([1, 2, 3], ph.Rotor.from_axis_angle(ph.e3, 0.5))
        >>> bool(ph.RigidTransform.exp(T.log()).is_close(T, atol=1e-15))
        True
        """
        return RigidTransform.from_exp_coords(exp_coords)

    @staticmethod
    def from_screw(
        axis: Any, point: Any, angle: Any, distance: Any = 0.0, degrees: bool = False
    ) -> RigidTransform:
        """Turn by `angle` about the axis through `point`, and move by `distance` along it.

        The inverse of `screw_parameters`: ``from_screw(*T.screw_parameters())`` is T. A ValueError for an
        axis of zero length.

        Parameters
        ----------
        axis, point
            Vectors, or arrays (..., 3): the direction of the axis, whose length is ignored, and any point of
            it; with an angle of 0 the point does not matter.
        angle, distance
            Numbers (...): radians, or degrees, right-handed about the axis, and units of the points. Batch
            shapes broadcast.

        Examples
        --------
        A quarter turn about the axis through e1 along e3, and the same with a climb of 2:

        >>> T = ph.RigidTransform.from_screw(ph.e3, ph.e1, 90, degrees=True)
        >>> T.apply([0, 0, 0]).round(6) + 0
        array([ 1., -1.,  0.])
        >>> ph.RigidTransform.from_screw(ph.e3, ph.e1, np.pi / 2, distance=2).apply([0, 0, 0]).round(6) + 0
        array([ 1., -1.,  2.])
        """
        return RigidTransform(*_conversions.parts_of_screw(axis, point, angle, distance, degrees))

    @staticmethod
    def from_dual_quat(dual_quat: Any, *, scalar_first: bool = False) -> RigidTransform:
        """From unit dual quaternions (..., 8): the real part, then the dual part, each ``(x, y, z, w)``.

        With `scalar_first`, each is ``(w, x, y, z)``. Both are divided by the norm of the real part, and the
        component of the dual part along the real part is dropped. A ValueError for a real part 0.

        Examples
        --------
        >>> T = ph.RigidTransform.from_dual_quat([1, 0, 0, 0, 0, 1, 2, 3], scalar_first=True)
        >>> T.translation
        2 e1 + 4 e2 + 6 e3
        """
        return RigidTransform(*_conversions.parts_of_dual_quat(dual_quat, scalar_first))

    @staticmethod
    def from_motor(M: Multivector) -> RigidTransform:
        """From a motor, an even element of ``ph.algebra(3, 0, 1)``, divided by its norm: see `to_motor`.

        Examples
        --------
        >>> M = ph.RigidTransform.from_translation([2, 0, 0]).to_motor()
        >>> ph.RigidTransform.from_motor(M * M).translation
        4 e1
        """
        return RigidTransform(*_conversions.parts_of_motor(M))

    @staticmethod
    def from_scipy(transform: ScipyTransform) -> RigidTransform:
        """From a ``scipy.spatial.transform.RigidTransform``.

        Examples
        --------
        >>> from scipy.spatial.transform import RigidTransform
        >>> ph.RigidTransform.from_scipy(RigidTransform.from_translation([1, 2, 3])).translation
        e1 + 2 e2 + 3 e3
        """
        if not hasattr(transform, "as_components"):
            raise TypeError(
                "from_scipy needs a scipy.spatial.transform.RigidTransform, got " + type(transform).__name__
            )
        return RigidTransform.from_components(*transform.as_components())

    @staticmethod
    def concatenate(transforms: RigidTransform | Iterable[RigidTransform]) -> RigidTransform:
        """Join transforms and batches of them along the first axis; a transform itself stays as it is.

        Examples
        --------
        >>> T = ph.RigidTransform.from_translation([[1, 0, 0], [2, 0, 0]])
        >>> ph.RigidTransform.concatenate([T, ph.RigidTransform()]).shape
        (3,)
        """
        if isinstance(transforms, RigidTransform):
            return transforms
        given = [required(part, f"item {i} of concatenate") for i, part in enumerate(transforms)]
        parts = [part if part.shape else part._reshaped((1,)) for part in given]
        rotor, translation = ([getattr(part, name) for part in parts] for name in ("rotor", "translation"))
        return RigidTransform(concatenate(rotor), concatenate(translation))

    @staticmethod
    def stack(transforms: Iterable[RigidTransform]) -> RigidTransform:
        """Join transforms of one batch shape along a new first axis.

        Examples
        --------
        >>> T = ph.RigidTransform.from_translation([[1, 0, 0], [2, 0, 0]])
        >>> ph.RigidTransform.stack([T, T, T]).shape
        (3, 2)
        """
        parts = [required(part, f"item {i} of stack") for i, part in enumerate(transforms)]
        return RigidTransform(stack(part.rotor for part in parts), stack(part.translation for part in parts))

    # --- converters

    @property
    def rotation(self) -> Rotor:
        """The rotor, under SciPy's name."""
        return self.rotor

    def as_components(self) -> tuple[Array, Rotor]:
        """Return the translation, an array (..., 3), and the rotor, in SciPy's order.

        Examples
        --------
        >>> translation, R = ph.RigidTransform.from_translation([1, 2, 3]).as_components()
        >>> translation, R
        (array([1., 2., 3.]), 1)
        """
        return self.translation.components, self.rotor

    as_matrix = _conversions.as_matrix
    as_exp_coords = _conversions.as_exp_coords
    as_dual_quat = _conversions.as_dual_quat
    to_motor = _conversions.to_motor
    to_scipy = _conversions.to_scipy

    def to_matrix(self) -> Any:
        """Return `as_matrix`, by the name that rotors have for it.

        Examples
        --------
        >>> ph.RigidTransform.from_translation([5, 6, 7]).to_matrix()[:3, 3]
        array([5., 6., 7.])
        """
        return self.as_matrix()

    def log(self) -> Any:
        """Return `as_exp_coords`, the logarithm of a displacement: a screw, whose `exp` it is.

        Examples
        --------
        >>> ph.RigidTransform.from_translation([5, 6, 7]).log()
        array([0., 0., 0., 5., 6., 7.])
        """
        return self.as_exp_coords()

    screw_parameters = screw_parameters
    adjoint = adjoint_matrix

    # --- action and algebra

    def apply(self, points: Any, inverse: bool = False) -> Any:
        """Move points: vectors to vectors, arrays (..., 3) to arrays; batch shapes broadcast.

        With `inverse`, move them back, ``~R (y − x0) R``.

        Examples
        --------
        >>> T = ph.RigidTransform.from_translation([1, 0, 0])
        >>> T.apply(ph.e2)
        e1 + e2
        >>> T.apply([[0, 0, 0], [0, 0, 5]])
        array([[1., 0., 0.],
               [1., 0., 5.]])
        >>> T.apply(ph.e2, inverse=True)
        -e1 + e2
        """
        given = isinstance(points, Multivector)
        x = as_vector(points, "points")
        moved = (~self.rotor)(x - self.translation) if inverse else self.rotor(x) + self.translation
        return moved if given else moved.components

    def __call__(self, points: Any) -> Any:
        return self.apply(points)

    def __mul__(self, other: RigidTransform) -> RigidTransform:
        if has_reflected(other, "__rmul__"):
            return NotImplemented
        if not isinstance(other, RigidTransform):
            refuse(self, "*", other)
        return RigidTransform(self.rotor * other.rotor, self.apply(other.translation))

    # Nothing but a transform is a factor, for type checkers too.
    def __rmul__(self, other: Never) -> NoReturn:
        refuse(other, "*", self)

    def __matmul__(self, other: Never) -> Any:
        if has_reflected(other, "__rmatmul__"):
            return NotImplemented
        return refuse(self, "@", other)

    def __rmatmul__(self, other: Never) -> NoReturn:
        refuse(other, "@", self)

    def __rshift__(self, other: Never) -> Any:
        if has_reflected(other, "__rrshift__"):
            return NotImplemented
        return refuse(self, ">>", other)

    def inv(self) -> RigidTransform:
        """Return the transform that moves back.

        Examples
        --------
        >>> ph.RigidTransform.from_translation([1, 2, 3]).inv().translation
        -e1 - 2 e2 - 3 e3
        """
        back = ~self.rotor
        return RigidTransform(back, -back(self.translation))

    def inverse(self) -> RigidTransform:
        """Return the transform that moves back.

        Examples
        --------
        >>> move = ph.RigidTransform.from_translation([1, 0, 0])
        >>> move.inverse().apply(ph.e1 + ph.e2)
        e2
        """
        return self.inv()

    def __invert__(self) -> RigidTransform:
        return self.inv()

    def __pow__(self, n: Any) -> RigidTransform:
        """``exp(n log T)``: n times the screw of at most half a turn, for any real n or array of them."""
        powers = number_like(n, "the power of a transform", self.rotor._data)
        common_batch(self.shape, powers.shape)
        coords = self.as_exp_coords()
        if not is_float(coords):
            coords, powers = common(coords, powers)
        with np.errstate(invalid="ignore"):  # infinite powers of 0: from_exp_coords reports them
            return RigidTransform.from_exp_coords(coords * powers[..., None])

    def interpolate(self, other: RigidTransform, t: Any) -> RigidTransform:
        """Return the transforms on the screw from this one (t = 0) to another (t = 1), the short way.

        Examples
        --------
        >>> start, end = ph.RigidTransform(), ph.RigidTransform.from_translation([4, 0, 0])
        >>> start.interpolate(end, 0.25).translation
        e1
        """
        required(other, "the other transform")
        step: RigidTransform = (self.inv() * other) ** t
        return self * step

    def mean(self, weights: Any = None, axis: int | tuple[int, ...] | None = None) -> RigidTransform:
        """Return the mean over batch axes, by default all: of rotations as by `ph.mean`, and of translations.

        `weights` are numbers >= 0 that broadcast to the batch shape. A ValueError as of `ph.mean`.

        Examples
        --------
        >>> T = ph.RigidTransform.from_translation([[1, 0, 0], [2, 0, 0]])
        >>> T.mean().translation
        1.5 e1
        """
        turn = mean(self.rotor, weights, axis)
        if weights is None:
            return RigidTransform(turn, self.translation.mean(axis))
        given = as_coefficients(weights, "weights")
        if is_float(given):  # so that no product overflows
            given = given / power_of_two(given, tuple(range(given.ndim)))
        w = scalar(namespace(given).broadcast_to(given, self.shape))
        return RigidTransform(turn, (self.translation * w).sum(axis) / w.sum(axis))

    def is_close(self, other: RigidTransform, rtol: float = 1e-9, atol: float = 0.0) -> Any:
        """Return whether two transforms are close: angle in rad below `rtol`, translations as vectors are.

        Examples
        --------
        >>> T = ph.RigidTransform(ph.Rotor.from_axis_angle(ph.e3, 60, degrees=True), [1, 2, 3])
        >>> bool((T * T.inv()).is_close(ph.RigidTransform(), atol=1e-12))
        True
        """
        required(other, "the other transform")
        near = self.rotor.distance(other.rotor) <= rtol
        return near & self.translation.is_close(other.translation, rtol, atol)

    def _nearer(self) -> RigidTransform:
        """Return the same transform with the rotor of a turn of at most π."""
        return RigidTransform(self.rotor.canonical(), self.translation)


def _of_leaves(_: None, leaves: Iterable[Any]) -> RigidTransform:
    """Return a transform with parts of any kind, unchecked."""
    self = object.__new__(RigidTransform)
    self._set(*leaves)
    return self


def _register_pytrees() -> None:
    """Register transforms, with rotor and translation as children, as pytrees of JAX if it is imported."""
    if "jax" in sys.modules:
        register_pytrees()
        register_pytree(RigidTransform, lambda T: ((T.rotor, T.translation), None), _of_leaves)


_register_pytrees()
