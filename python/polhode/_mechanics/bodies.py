"""`Inertia` and `Body`, from numbers, solids, point masses and meshes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any, overload

import numpy as np

from polhode import _native
from polhode._algebra.algebra import Algebra
from polhode._algebra.algebra import algebra as algebra_of
from polhode._algebra.constructors import as_point, as_vectors, bivector, pure, vector
from polhode._algebra.linear_map import LinearMap
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Array, as_components, as_float, as_floats

_G3 = algebra_of(3)


def matrices(inertias: Iterable[Inertia]) -> Array:
    """Return the matrices (n, 3, 3) of inertias."""
    return _native.Inertia.matrices([inertia._core for inertia in inertias]).reshape(-1, 3, 3)


class Inertia(LinearMap):
    """The inertia map ``I(B) = ∫ρ x∧(x·B) d³x`` of bivectors to bivectors (handout eq. 4.18).

    It maps the plane of rotation to the plane of angular momentum, both in body axes, in kg m². It is about
    the centre of mass unless stated otherwise. Its matrix over ``(e2e3, e3e1, e1e2)`` is the inertia tensor
    over axial vectors. A symmetric `LinearMap` of grade 2.

    Create one with `from_principal_moments`, `from_matrix`, `from_function` or `from_points`. Moments that no
    body has (``i1 + i2 < i3``, or negative) raise a ValueError.
    """

    __slots__ = ("_core",)

    def __init__(self, *core: _native.Inertia) -> None:
        if len(core) != 1 or not isinstance(core[0], _native.Inertia):
            raise TypeError("use Inertia.from_principal_moments, from_matrix, from_function or from_points")
        self._core = core[0]

    @staticmethod
    def from_principal_moments(i1: float, i2: float, i3: float) -> Inertia:
        """Return the inertia with moments (kg m²) about e1, e2, e3, i.e. in the planes e2e3, e3e1, e1e2."""
        moments = as_components([i1, i2, i3], 3, "moments")
        return Inertia(_native.Inertia.from_principal_moments(moments))

    @staticmethod
    def from_matrix(J: Any) -> Inertia:  # type: ignore[override]  # an inertia has one grade
        """Return the inertia with a symmetric 3x3 matrix (kg m²) in body axes; principal moments ascend."""
        matrix = as_floats(J, "inertia matrix")
        if matrix.shape != (3, 3):
            raise ValueError(f"inertia matrix must have shape (3, 3), got {matrix.shape}")
        return Inertia(_native.Inertia.from_matrix(np.ascontiguousarray(matrix).reshape(9)))

    @staticmethod
    def from_function(f: Callable[[Multivector], Multivector]) -> Inertia:  # type: ignore[override]
        """Return the inertia of a function, as ``I(B) = i1 B + (i3 − i1) (B∧e3) e3`` (handout eq. 4.25)."""
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
        """Return the inertia of masses (n,) in kg at positions (n, 3) in m, about their centre of mass."""
        return Inertia(_native.Inertia.from_points(*_points(masses, positions)))

    def __call__(self, B: Any) -> Multivector:
        """``I(B)``: the angular momentum of a rotation with angular velocity B, both in body axes."""
        return bivector(self._core.apply(pure(B, 2, "the plane of rotation")), copy=False)

    @overload
    def inverse(self) -> LinearMap: ...
    @overload
    def inverse(self, L: Multivector) -> Multivector: ...
    def inverse(self, L: Multivector | None = None) -> LinearMap | Multivector:
        """Return the angular velocity with angular momentum L; a ValueError if a principal moment is 0.

        Without L, return the map from momenta to velocities.
        """
        if L is None:
            return LinearMap.from_function(self.inverse, grade=2)
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
        """Return the principal planes ``F(I e_k)``, F the `principal_frame`, and the principal moments."""
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


def _restored(matrix: Array, moments: Array, frame: Array) -> Inertia:
    return Inertia(_native.Inertia.restored(matrix, moments, frame))


class Body:
    """A rigid body: mass (kg), centre of mass (m) and inertia about the centre of mass, in body axes.

    ``a + b`` joins two bodies rigidly in the same body axes; place them with `moved` first. Solids are
    uniform and centred on the origin, with their axis along e3 (a cone has its base in the plane e1e2); give
    `mass` in kg or `density` in kg/m³.
    """

    __slots__ = ("_core",)

    def __init__(self, mass: float, inertia: Inertia, center_of_mass: Any = 0) -> None:
        if not isinstance(inertia, Inertia):
            raise TypeError(
                f"inertia must be an Inertia, got {type(inertia).__name__}; see Inertia.from_matrix"
            )
        center = as_point(center_of_mass, "the centre of mass")
        self._core = _native.Body(as_float(mass, "the mass"), inertia._core, center)

    @classmethod
    def _of(cls, core: _native.Body) -> Body:
        self = object.__new__(cls)
        self._core = core
        return self

    # --- constructors

    @staticmethod
    def _solid(kind: str, sizes: Any, mass: float | None, density: float | None) -> Body:
        lengths = np.ravel(as_floats(sizes, f"the sizes of a {kind}")).tolist()
        return Body._of(_native.Body.solid(kind, lengths, *_amount(mass, density)))

    @staticmethod
    def box(lengths: Any, *, mass: float | None = None, density: float | None = None) -> Body:
        """Return a box with sides `lengths` (3,) along e1, e2, e3."""
        return Body._solid("box", as_components(lengths, 3, "the lengths of a box"), mass, density)

    @staticmethod
    def ellipsoid(semi_axes: Any, *, mass: float | None = None, density: float | None = None) -> Body:
        """Return an ellipsoid with `semi_axes` (3,) along e1, e2, e3."""
        sizes = as_components(semi_axes, 3, "the semi-axes of an ellipsoid")
        return Body._solid("ellipsoid", sizes, mass, density)

    @staticmethod
    def sphere(radius: float, *, mass: float | None = None, density: float | None = None) -> Body:
        """Return a solid sphere."""
        return Body._solid("sphere", [radius], mass, density)

    @staticmethod
    def hollow_sphere(
        outer_radius: float,
        inner_radius: float,
        *,
        mass: float | None = None,
        density: float | None = None,
    ) -> Body:
        """Return a spherical shell; equal radii give a thin shell, which requires `mass`."""
        return Body._solid("hollow_sphere", [outer_radius, inner_radius], mass, density)

    @staticmethod
    def cylinder(
        radius: float, height: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a cylinder about e3."""
        return Body._solid("cylinder", [radius, height], mass, density)

    @staticmethod
    def cone(
        radius: float, height: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a cone about e3, its base on the plane e1e2 and its apex at `height`."""
        return Body._solid("cone", [radius, height], mass, density)

    @staticmethod
    def rod(length: float, *, mass: float) -> Body:
        """Return a thin rod along e3; it has no moment about e3."""
        return Body._solid("rod", [length], mass, None)

    @staticmethod
    def disc(radius: float, *, mass: float) -> Body:
        """Return a thin disc in the plane e1e2."""
        return Body._solid("disc", [radius], mass, None)

    @staticmethod
    def torus(
        major_radius: float, minor_radius: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a torus about e3: a tube of `minor_radius` whose centre line has `major_radius`."""
        return Body._solid("torus", [major_radius, minor_radius], mass, density)

    @staticmethod
    def capsule(
        radius: float, height: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a cylinder of `height` about e3 with a hemisphere on each end."""
        return Body._solid("capsule", [radius, height], mass, density)

    @staticmethod
    def from_points(masses: Any, positions: Any) -> Body:
        """Return the body of point masses (n,) in kg at positions (n, 3) in m."""
        return Body._of(_native.Body.from_points(*_points(masses, positions)))

    @staticmethod
    def from_mesh(
        path: str | os.PathLike[str],
        *,
        density: float | None = None,
        mass: float | None = None,
        scale: float = 1.0,
    ) -> Body:
        """Return the body enclosed by a triangle mesh (STL, OBJ or PLY), exactly; `scale` is its unit in m.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            For a corrupt file, or a mesh that is open, inconsistently wound, inside-out or degenerate; the
            message gives the place.
        """
        if not os.path.lexists(path):
            raise FileNotFoundError(f"{os.fspath(path)}: no such file")
        return Body._of(
            _native.Body.from_mesh(os.fspath(path), as_float(scale, "the scale"), *_amount(mass, density))
        )

    # --- properties

    @property
    def mass(self) -> float:
        """Mass in kg."""
        return self._core.mass()

    @property
    def center_of_mass(self) -> Multivector:
        """Centre of mass in body axes, a vector in m."""
        return vector(self._core.center_of_mass())

    @property
    def inertia(self) -> Inertia:
        """Inertia about the centre of mass, in body axes."""
        return Inertia(self._core.inertia())

    def inertia_about(self, point: Any) -> Inertia:
        """Return the inertia about a point fixed in the body (a vector or (3,), in m)."""
        return Inertia(self._core.inertia_about(as_point(point, "the point")))

    def moved(self, rotor: Rotor | None = None, position: Any = 0) -> Body:
        """Return the body moved rigidly: its points x go to ``R x ~R + position``."""
        turn = Rotor.identity() if rotor is None else rotor
        if not isinstance(turn, Rotor) or turn.shape:
            raise TypeError(
                f"rotor must be a single Rotor, got {turn!r}; see Rotor.from_quaternion, from_matrix"
            )
        return Body._of(self._core.moved(turn._data, as_point(position, "the position")))

    def __add__(self, other: Body) -> Body:
        if not isinstance(other, Body):
            return NotImplemented
        return Body._of(self._core.combine(other._core))

    def __radd__(self, other: object) -> Body:
        """``0 + body``, so that ``sum(bodies)`` works."""
        return self if other == 0 else NotImplemented

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Body):
            return NotImplemented
        return (self.mass, self.inertia) == (other.mass, other.inertia) and bool(
            self.center_of_mass == other.center_of_mass
        )

    def __hash__(self) -> int:
        return hash((self.mass, self.inertia))

    def __repr__(self) -> str:
        moments = ", ".join(f"{i:.8g}" for i in self.inertia.principal_moments)
        return (
            f"Body(mass {self.mass:.8g} kg, centre of mass {self.center_of_mass!r} m, "
            f"moments {moments} kg m²)"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return Body, (self.mass, self.inertia, self.center_of_mass)


def _amount(mass: float | None, density: float | None) -> tuple[float | None, float | None]:
    """Return mass and density, of which exactly one is given."""
    if (mass is None) == (density is None):
        raise TypeError("give exactly one of mass= (kg) and density= (kg/m³)")
    return (
        None if mass is None else as_float(mass, "the mass"),
        None if density is None else as_float(density, "the density"),
    )


def _points(masses: Any, positions: Any) -> tuple[Array, Array]:
    m = np.ascontiguousarray(as_floats(masses, "masses"))
    x = as_vectors(positions, "positions")
    if m.ndim != 1 or x.shape != (m.size, 3):
        raise ValueError(f"from_points needs masses (n,) and positions (n, 3), got {m.shape} and {x.shape}")
    return m, x


# --- arrays of bodies


def bodies_of(body: Any) -> Any:
    """Return an object array of bodies or inertias from one or a nested sequence of them."""
    return objects_of(body, (Body, Inertia), "body must be a Body or an Inertia")


def objects_of(values: Any, kinds: tuple[type, ...], what: str, remedy: str = "") -> Any:
    """Return an object array of one value or a nested sequence of values; a TypeError for other types."""
    array: Any = np.empty((), dtype=object)
    if not isinstance(values, list | tuple | np.ndarray):
        array[()] = values
    elif not isinstance(values, np.ndarray) and values and {*map(type, values)} <= {*kinds}:
        # np.array would look for sequences in each.
        array = np.fromiter(values, object, len(values))
    else:
        array = np.array(values, dtype=object)
    if not {*map(type, array.flat)} <= {*kinds}:
        for index, one in np.ndenumerate(array):
            if not isinstance(one, kinds):
                where, rest = (f"at index {index}: ", "") if index else ("", remedy)
                raise TypeError(f"{where}{what}, got {type(one).__name__}{rest}")
    return array


def inertia_of(body: Any, held: bool) -> Any:
    """Return the inertia of a body, if it is held about the origin of its axes; anything else unchanged."""
    if not isinstance(body, Body):
        return body
    return body.inertia_about(0) if held else body.inertia


def mapped_objects(f: Callable[[Any], Any], array: Any) -> Any:
    """Return the object array of f(x) for each object x of an array."""
    result: Any = np.empty(array.shape, dtype=object)
    result.ravel()[:] = [f(one) for one in array.flat]
    return result
