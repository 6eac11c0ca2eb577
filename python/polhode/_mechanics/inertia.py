"""`Inertia`: maps of angular velocities to angular momenta."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from itertools import repeat
from typing import Any, overload

import numpy as np

from polhode import _native
from polhode._algebra.algebra import Algebra
from polhode._algebra.algebra import algebra as algebra_of
from polhode._algebra.constructors import as_vectors, bivector, pure
from polhode._algebra.linear_map import LinearMap
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.foreign_tables import INERTIA
from polhode._mechanics.parameters import common
from polhode._support.arrays import Array, Shape, as_components, as_floats
from polhode._support.calls import explains_calls_of
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names
from polhode._support.memory import require_array

_G3 = algebra_of(3)
_BYTES = 800  # of an inertia, in Python and in the core


def matrices(inertias: Iterable[Inertia]) -> Array:
    """Return the matrices (n, 3, 3) of inertias."""
    return _native.Inertia.matrices(list(inertias)).reshape(-1, 3, 3)


def _three(i1: Any, i2: Any, i3: Any) -> Iterable[Any]:
    """Return the three moments, which may be one array (..., 3)."""
    if i2 is None and i3 is None:
        return np.moveaxis(as_components(i1, 3, "an array of principal moments"), -1, 0)
    if i2 is None or i3 is None:
        missing = "i2" if i2 is None else "i3"
        raise TypeError(
            f"give three moments i1, i2 and i3, or one array (..., 3) of them; {missing} is missing"
        )
    return i1, i2, i3


@with_foreign_names(INERTIA)
@explains_calls_of
class Inertia(LinearMap, metaclass=ListsOwnNames):
    """The inertia map ``I(B) = ∫ρ x∧(x·B) d³x`` of bivectors to bivectors (handout eq. 4.18).

    It maps the plane of rotation to the plane of angular momentum, both in body axes, in kg m². It is about
    the centre of mass unless stated otherwise. Its matrix over ``(e2e3, e3e1, e1e2)`` is the inertia tensor
    over axial vectors. A symmetric `LinearMap` of grade 2.

    Create one with `from_principal_moments`, `from_matrix`, `from_function` or `from_points`. Moments that no
    body has (``i1 + i2 < i3``, or negative) raise a ValueError.

    Examples
    --------
    The angular velocity and the momentum are parallel along a principal axis only:

    >>> inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    >>> inertia(ph.e1 ^ ph.e2)
    3 e1∧e2
    >>> inertia((ph.e1 ^ ph.e2) + (ph.e2 ^ ph.e3))
    e2∧e3 + 3 e1∧e2
    >>> inertia.matrix
    array([[1., 0., 0.],
           [0., 2., 0.],
           [0., 0., 3.]])
    """

    __slots__ = ("_core",)

    def __init__(self, *_core: _native.Inertia) -> None:
        if len(_core) != 1 or not isinstance(_core[0], _native.Inertia):
            raise TypeError("use Inertia.from_principal_moments, from_matrix, from_function or from_points")
        self._core = _core[0]

    @staticmethod
    def from_principal_moments(i1: Any, i2: Any = None, i3: Any = None) -> Inertia:
        """Return the inertia with moments (kg m²) about e1, e2, e3, i.e. in the planes e2e3, e3e1, e1e2.

        Arrays of moments (...), which broadcast, give an array (...) of inertias, for a batch of bodies::

            bodies = ph.Inertia.from_principal_moments(1, 2, np.linspace(2.2, 2.9, 8))

        A single argument is an array (..., 3) of all three.

        Examples
        --------
        >>> ph.Inertia.from_principal_moments(1, 2, 3)
        Inertia(principal moments 1, 2, 3 kg m²)
        """
        parts = [as_floats(x, f"moment i{k}") for k, x in enumerate(_three(i1, i2, i3), 1)]
        if not any(part.ndim for part in parts):
            return Inertia(_native.Inertia.from_principal_moments(np.array(parts)))
        shape = common({f"i{k}": part.shape for k, part in enumerate(parts, 1)}, "the moments")
        require_array(shape, "inertias", _BYTES)
        moments = np.stack(np.broadcast_arrays(*parts), axis=-1)
        # Typed as one inertia, which numbers give.
        many: Inertia = _many(_native.Inertia.all_from_principal_moments(moments), moments.shape[:-1])
        return many

    @staticmethod
    def from_matrix(J: Any) -> Inertia:  # type: ignore[override]  # an inertia has one grade
        """Return the inertia with a symmetric 3x3 matrix (kg m²) in body axes; principal moments ascend.

        Matrices (..., 3, 3) give an array (...) of inertias, for a batch of bodies.

        Examples
        --------
        A product of inertia turns the principal axes, here by 45° in the plane e1e2:

        >>> inertia = ph.Inertia.from_matrix([[2, -1, 0], [-1, 2, 0], [0, 0, 3]])
        >>> inertia.principal_moments.round(12)
        array([1., 3., 3.])
        >>> inertia.principal_frame(ph.e1).components.round(3)
        array([0.707, 0.707, 0.   ])
        """
        matrix = np.ascontiguousarray(as_floats(J, "inertia matrix"))
        if matrix.shape[-2:] != (3, 3):
            raise ValueError(f"inertia matrix must have shape (3, 3) or (..., 3, 3), got {matrix.shape}")
        batch = matrix.shape[:-2]
        require_array(batch, "inertias", _BYTES)
        rows = matrix.reshape(*batch, 9)
        if not batch:
            return Inertia(_native.Inertia.from_matrix(rows))
        # Typed as one inertia, which one matrix gives.
        many: Inertia = _many(_native.Inertia.all_from_matrices(rows), batch)
        return many

    @staticmethod
    def from_function(f: Callable[[Multivector], Multivector]) -> Inertia:  # type: ignore[override]
        """Return the inertia of a function, as ``I(B) = i1 B + (i3 − i1) (B∧e3) e3`` (handout eq. 4.25).

        Examples
        --------
        >>> i1, i3 = 2, 1
        >>> top = ph.Inertia.from_function(lambda B: i1 * B + (i3 - i1) * (B ^ ph.e3) * ph.e3)
        >>> top.principal_moments
        array([...])
        """
        return Inertia.from_matrix(LinearMap.from_function(f, grade=2).matrix)

    @staticmethod
    def identity(*_: Any, **__: Any) -> LinearMap:
        """Raise a TypeError: an inertia has moments, such as ``from_principal_moments(1, 1, 1)``."""
        raise TypeError(
            "an inertia has moments; use Inertia.from_principal_moments(1, 1, 1), or "
            "LinearMap.identity(grade=2)"
        )

    @staticmethod
    def from_points(masses: Any, positions: Any) -> Inertia:
        """Return the inertia of masses (n,) in kg at positions (n, 3) in m, about their centre of mass.

        Examples
        --------
        Masses of 3 kg and 1 kg, 4 m apart, have the moment ``μ d²`` with the reduced mass 3/4 kg:

        >>> ph.Inertia.from_points([3, 1], [[0, 0, 0], [0, 0, 4]])
        Inertia(principal moments 0, 12, 12 kg m²)
        """
        return Inertia(_native.Inertia.from_points(*point_masses(masses, positions)))

    def __call__(self, B: Any) -> Multivector:
        """``I(B)``: the angular momentum of a rotation with angular velocity B, both in body axes."""
        if _foreign(B):
            return super().__call__(B)
        return bivector(self._core.apply(pure(B, 2, "the plane of rotation")), copy=False)

    @overload
    def inverse(self) -> LinearMap: ...
    @overload
    def inverse(self, L: Multivector) -> Multivector: ...
    def inverse(self, L: Multivector | None = None) -> LinearMap | Multivector:
        """Return the angular velocity with angular momentum L; a ValueError if a principal moment is 0.

        Without L, return the map from momenta to velocities.

        Examples
        --------
        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 3)
        >>> inertia.inverse(ph.bivector([1, 2, 3]))
        e2∧e3 + e3∧e1 + e1∧e2
        """
        if L is None:
            return LinearMap.from_function(self.inverse, grade=2)
        if _foreign(L):
            return self.inverse()(L)
        return bivector(self._core.inverse(pure(L, 2, "the angular momentum")), copy=False)

    @property
    def algebra(self) -> Algebra:
        """The algebra of 3-d space."""
        return _G3

    @property
    def grade(self) -> int:
        """2: it maps bivectors."""
        return 2

    @property
    def matrix(self) -> Array:
        """The symmetric 3x3 matrix in body axes, kg m²."""
        return self._core.matrix().reshape(3, 3)

    @property
    def principal_moments(self) -> Array:
        """Principal moments (3,) in kg m², in the order of the axes of `principal_frame`."""
        return self._core.principal_moments()

    @property
    def principal_frame(self) -> Rotor:
        """Return the rotor F whose axes ``F(e1), F(e2), F(e3)`` are the principal axes in body axes."""
        return Rotor._from_rows(self._core.principal_frame())

    def eigenplanes(self) -> tuple[Multivector, Array]:
        """Return the principal planes ``F(I e_k)``, F the `principal_frame`, and the principal moments.

        Examples
        --------
        >>> planes, moments = ph.Inertia.from_principal_moments(1, 2, 2.5).eigenplanes()
        >>> planes[0], float(moments[0])
        (e2∧e3, 1.0)
        """
        return self.principal_frame(bivector(np.eye(3))), self.principal_moments

    def __repr__(self) -> str:
        i1, i2, i3 = self.principal_moments
        return f"Inertia(principal moments {i1:.8g}, {i2:.8g}, {i3:.8g} kg m²)"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Inertia):
            return NotImplemented
        return bool(np.array_equal(self.matrix, other.matrix))

    def __hash__(self) -> int:  # type: ignore[override]  # a single map
        return hash(self.matrix.tobytes())

    def __reduce__(self) -> tuple[Any, ...]:
        core = self._core
        return _restored, (core.matrix().ravel(), core.principal_moments(), core.principal_frame())


def _foreign(value: Any) -> bool:
    """Whether a value has the arrays of another library, such as JAX, which may take derivatives."""
    return isinstance(value, Multivector) and not isinstance(value._data, np.ndarray)


def _many(cores: list[_native.Inertia], shape: Shape) -> Any:
    """Return an object array (...) of inertias; loops in C, because there may be millions."""
    inertias = list(map(object.__new__, repeat(Inertia, len(cores))))
    deque(map(Inertia.__dict__["_core"].__set__, inertias, cores), maxlen=0)
    return np.fromiter(inertias, object, len(inertias)).reshape(shape)


def _restored(matrix: Array, moments: Array, frame: Array) -> Inertia:
    return Inertia(_native.Inertia.restored(matrix, moments, frame))


def point_masses(masses: Any, positions: Any) -> tuple[Array, Array]:
    """Return masses (n,) and positions (n, 3), checked."""
    m = np.ascontiguousarray(as_floats(masses, "masses"))
    x = as_vectors(positions, "positions")
    if m.ndim != 1 or x.shape != (m.size, 3):
        raise ValueError(f"from_points needs masses (n,) and positions (n, 3), got {m.shape} and {x.shape}")
    return m, x
