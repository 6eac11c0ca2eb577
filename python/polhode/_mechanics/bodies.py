"""`Body`: rigid bodies, from solids, point masses and meshes."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.coefficients import known_floats
from polhode._algebra.constructors import as_point, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.foreign_tables import BODY
from polhode._mechanics.inertia import Inertia, point_masses
from polhode._support.arrays import as_components, as_float, as_floats
from polhode._support.calls import explains_calls_of
from polhode._support.files import loadable
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names


@with_foreign_names(BODY)
@explains_calls_of
class Body(metaclass=ListsOwnNames):
    """A rigid body: mass (kg), centre of mass (m) and inertia about the centre of mass, in body axes.

    ``a + b`` joins two bodies rigidly in the same body axes; place them with `moved` first. Solids are
    uniform and centred on the origin, with their axis along e3 (a cone has its base in the plane e1e2). Give
    sizes in m, and `mass` in kg or `density` in kg/m³.

    Examples
    --------
    A box has the moments ``m (b² + c²)/12``:

    >>> box = ph.Body.box([1, 2, 3], mass=12)
    >>> box.inertia.principal_moments
    array([13., 10.,  5.])

    Two of them, side by side along e1, joined rigidly:

    >>> both = box + box.moved(position=[1, 0, 0])
    >>> both.mass, both.center_of_mass
    (24.0, 0.5 e1)
    >>> both.inertia == ph.Body.box([2, 2, 3], mass=24).inertia
    True
    """

    __slots__ = ("_core",)

    def __init__(self, mass: float, inertia: Inertia, center_of_mass: Any = 0) -> None:
        if not isinstance(inertia, Inertia):
            raise TypeError(
                f"inertia must be an Inertia, got {type(inertia).__name__}; see "
                "Inertia.from_principal_moments, from_matrix"
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
        given = as_floats(sizes, f"the sizes of a {kind}")
        if given.size > 3:
            raise ValueError(f"the sizes of a {kind} are at most three numbers, got shape {given.shape}")
        lengths = np.ravel(given).tolist()
        return Body._of(_native.Body.solid(kind, lengths, *_amount(mass, density)))

    @staticmethod
    def box(lengths: Any, *, mass: float | None = None, density: float | None = None) -> Body:
        """Return a box with sides `lengths` (3,) along e1, e2, e3.

        Examples
        --------
        >>> ph.Body.box([1, 2, 3], mass=12).inertia.principal_moments  # m (b² + c²)/12, …
        array([13., 10.,  5.])
        >>> round(ph.Body.box([0.1, 0.2, 0.3], density=1000).mass, 12)
        6.0
        """
        return Body._solid("box", as_components(lengths, 3, "the array of lengths"), mass, density)

    @staticmethod
    def ellipsoid(semi_axes: Any, *, mass: float | None = None, density: float | None = None) -> Body:
        """Return an ellipsoid with `semi_axes` (3,) along e1, e2, e3.

        Examples
        --------
        >>> ph.Body.ellipsoid([1, 2, 3], mass=5).inertia.principal_moments  # m (b² + c²)/5, …
        array([13., 10.,  5.])
        """
        sizes = as_components(semi_axes, 3, "the array of semi-axes")
        return Body._solid("ellipsoid", sizes, mass, density)

    @staticmethod
    def sphere(radius: float, *, mass: float | None = None, density: float | None = None) -> Body:
        """Return a solid sphere.

        Examples
        --------
        >>> ph.Body.sphere(1, mass=5).inertia.principal_moments  # 2/5 m r²
        array([2., 2., 2.])
        """
        return Body._solid("sphere", [radius], mass, density)

    @staticmethod
    def hollow_sphere(
        outer_radius: float,
        inner_radius: float,
        *,
        mass: float | None = None,
        density: float | None = None,
    ) -> Body:
        """Return a spherical shell; equal radii give a thin shell, which requires `mass`.

        Examples
        --------
        >>> ph.Body.hollow_sphere(1, 1, mass=3).inertia.principal_moments.round(12)  # thin: 2/3 m r²
        array([2., 2., 2.])
        """
        return Body._solid("hollow_sphere", [outer_radius, inner_radius], mass, density)

    @staticmethod
    def cylinder(
        radius: float, height: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a cylinder about e3.

        Examples
        --------
        >>> ph.Body.cylinder(1, 3, mass=4).inertia.principal_moments  # m (3r² + h²)/12, m r²/2
        array([4., 4., 2.])
        """
        return Body._solid("cylinder", [radius, height], mass, density)

    @staticmethod
    def cone(
        radius: float, height: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a cone about e3, its base on the plane e1e2 and its apex at `height`.

        Examples
        --------
        >>> cone = ph.Body.cone(1, 4, mass=10)
        >>> cone.center_of_mass  # a quarter of the height
        e3
        >>> float(cone.inertia.principal_moments[2])  # 3/10 m r²
        3.0
        """
        return Body._solid("cone", [radius, height], mass, density)

    @staticmethod
    def rod(length: float, *, mass: float) -> Body:
        """Return a thin rod along e3; it has no moment about e3.

        Examples
        --------
        >>> ph.Body.rod(2, mass=3).inertia.principal_moments  # m l²/12
        array([1., 1., 0.])
        >>> ph.Body.rod(2, mass=3).inertia_about([0, 0, 1]).principal_moments  # about an end: m l²/3
        array([0., 4., 4.])
        """
        return Body._solid("rod", [length], mass, None)

    @staticmethod
    def disc(radius: float, *, mass: float) -> Body:
        """Return a thin disc in the plane e1e2.

        Examples
        --------
        >>> ph.Body.disc(1, mass=4).inertia.principal_moments  # m r²/4, m r²/2
        array([1., 1., 2.])
        """
        return Body._solid("disc", [radius], mass, None)

    @staticmethod
    def torus(
        major_radius: float, minor_radius: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a torus about e3: a tube of `minor_radius` whose centre line has `major_radius`.

        Examples
        --------
        >>> float(ph.Body.torus(2, 1, mass=4).inertia.principal_moments[2])  # m (R² + 3/4 r²)
        19.0
        """
        return Body._solid("torus", [major_radius, minor_radius], mass, density)

    @staticmethod
    def capsule(
        radius: float, height: float, *, mass: float | None = None, density: float | None = None
    ) -> Body:
        """Return a cylinder of `height` about e3 with a hemisphere on each end.

        Examples
        --------
        >>> round(ph.Body.capsule(1, 2, density=1).mass / np.pi, 12)  # r² h + 4/3 r³
        3.333333333333
        """
        return Body._solid("capsule", [radius, height], mass, density)

    @staticmethod
    def from_points(masses: Any, positions: Any) -> Body:
        """Return the body of point masses (n,) in kg at positions (n, 3) in m.

        Examples
        --------
        >>> dumbbell = ph.Body.from_points([1, 1], [[0, 0, -1], [0, 0, 1]])
        >>> dumbbell.mass, dumbbell.inertia
        (2.0, Inertia(principal moments 0, 2, 2 kg m²))
        """
        return Body._of(_native.Body.from_points(*point_masses(masses, positions)))

    @staticmethod
    def from_mesh(
        path: str | os.PathLike[str],
        *,
        density: float | None = None,
        mass: float | None = None,
        scale: float = 1.0,
    ) -> Body:
        """Return the body enclosed by a triangle mesh (STL, OBJ or PLY), exactly.

        The files have no units: `scale` is the unit of the numbers in m, such as 1e-3 for millimetres. At a
        given density the mass grows with its cube. ``polhode check FILE`` prints the size of the body.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            For a corrupt file, or a mesh that is open, inconsistently wound, inside-out or degenerate; the
            message gives the place.

        Examples
        --------
        >>> surface = '''v 0 0 0
        ... v 1 0 0
        ... v 0 1 0
        ... v 0 0 1
        ... f 1 3 2
        ... f 1 2 4
        ... f 1 4 3
        ... f 2 3 4
        ... '''
        >>> with open("tetrahedron.obj", "w") as file:
        ...     _ = file.write(surface)
        >>> body = ph.Body.from_mesh("tetrahedron.obj", density=6)  # the volume is 1/6 m³
        >>> round(body.mass, 12), body.center_of_mass
        (1.0, 0.25 e1 + 0.25 e2 + 0.25 e3)
        """
        if not os.path.lexists(path):
            raise FileNotFoundError(f"{os.fspath(path)}: no such file")
        return Body._of(
            _native.Body.from_mesh(loadable(path), as_float(scale, "the scale"), *_amount(mass, density))
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
        """Return the inertia about a point fixed in the body (a vector or (3,), in m).

        Examples
        --------
        A rod about its end has the moment m l²/3, four times that about its centre:

        >>> ph.Body.rod(2, mass=3).inertia_about([0, 0, 1])
        Inertia(principal moments 0, 4, 4 kg m²)
        """
        return Inertia(self._core.inertia_about(as_point(point, "the point")))

    def moved(self, rotor: Rotor | None = None, position: Any = 0) -> Body:
        """Return the body moved rigidly: its points x go to ``R x ~R + position``.

        Examples
        --------
        >>> rod = ph.Body.rod(2, mass=3)
        >>> lying = rod.moved(ph.Rotor.from_plane_angle(ph.e3 ^ ph.e1, np.pi / 2), position=[1, 0, 0])
        >>> lying.center_of_mass
        e1
        >>> lying.inertia.matrix.round(12) + 0.0
        array([[0., 0., 0.],
               [0., 1., 0.],
               [0., 0., 1.]])
        """
        turn = Rotor.identity() if rotor is None else rotor
        if not isinstance(turn, Rotor) or turn.shape:
            raise TypeError(
                f"rotor must be a single Rotor, got {turn!r}; see Rotor.from_quaternion, from_matrix, "
                "from_scipy; a displacement is position="
            )
        return Body._of(
            self._core.moved(known_floats(turn._data, "the rotor"), as_point(position, "the position"))
        )

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
        c = self.center_of_mass.components
        # Sums over a mesh leave rounding errors where symmetry makes a component 0.
        center = vector(np.where(np.abs(c) > 1e-12 * np.abs(c).max(), c, 0.0))
        return f"Body(mass {self.mass:.8g} kg, centre of mass {center!r} m, moments {moments} kg m²)"

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
