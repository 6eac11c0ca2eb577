"""`KeplerOrbit`, and the magnetic field of a dipole at positions along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_vectors, vector
from polhode._algebra.multivector import Multivector
from polhode._mechanics.laws import number
from polhode._mechanics.parameters import vectors
from polhode._support.arrays import as_floats, lengths
from polhode._support.calls import explains_calls_of

_EARTH = 3.986004418e14
# The polar radius of the Earth, in m, rounded down.
_RADIUS = 6.35e6


@explains_calls_of
@dataclass(frozen=True)
class KeplerOrbit:
    """A Kepler orbit in the plane e1e2 of space, from e1 towards e2, with the periapsis on e1.

    Space axes are those of the orbit: give directions such as that of a planet's axis in them.

    Parameters
    ----------
    semi_major_axis
        a in m, from the centre of the planet: at an altitude of 500 km above the Earth, 6.878e6.
    eccentricity
        e, at least 0 and below 1.
    mean_anomaly
        The mean anomaly at time 0, in rad.
    mu
        The gravitational parameter of the planet in m³/s², by default that of the Earth.

    Examples
    --------
    The International Space Station goes round in about 93 minutes:

    >>> orbit = ph.torque.KeplerOrbit(6.793e6)
    >>> round(orbit.period / 60, 1)
    92.9
    >>> orbit.position(0).components / 1e6
    array([6.793, 0.   , 0.   ])
    """

    semi_major_axis: float
    eccentricity: float = 0.0
    mean_anomaly: float = 0.0
    mu: float = _EARTH

    def __post_init__(self) -> None:
        for name in ("semi_major_axis", "eccentricity", "mean_anomaly", "mu"):
            object.__setattr__(self, name, number(getattr(self, name), name))
        if self.mu == _EARTH and 0 < self.semi_major_axis < _RADIUS:
            raise ValueError(
                f"semi_major_axis is {self.semi_major_axis:g} m, inside the Earth; it is in m from the "
                "centre, such as 6378137 + altitude; give mu for another body"
            )
        if not 0 < self.rate < np.inf:
            raise ValueError(
                f"the mean motion of a semi-major axis of {self.semi_major_axis:g} m is {self.rate:g} rad/s, "
                "beyond the range of floating point; check the units"
            )

    @property
    def rate(self) -> float:
        """The mean motion ``√(μ/a³)``, in rad/s."""
        return _native.orbit_positions(self._numbers, np.zeros(0))[0]

    @property
    def period(self) -> float:
        """The time of a turn, in s."""
        return 2 * np.pi / self.rate

    def position(self, t: Any) -> Multivector:
        """Return the position relative to the planet at times (...), vectors in m.

        Examples
        --------
        >>> orbit = ph.torque.KeplerOrbit(1e7)
        >>> print(f"{orbit.position(orbit.period / 4).norm():.0f}")
        10000000
        """
        times = as_floats(t, "t")
        _, rows = _native.orbit_positions(self._numbers, np.ascontiguousarray(times.ravel()))
        return vector(rows.reshape(*times.shape, 3))

    def velocity(self, t: Any) -> Multivector:
        """Return the velocity relative to the planet at times (...), vectors in m/s.

        With the true anomaly ν it is ``√(μ/(a (1 − e²))) (−sin ν e1 + (e + cos ν) e2)``, where
        ``e + cos ν = (1 − e²) (x/a + e) a/r``, which does not cancel far out on a long ellipse.

        Examples
        --------
        A satellite that moves along the orbit, by `polhode.force.central`:

        >>> orbit = ph.torque.KeplerOrbit(1e7, eccentricity=0.2)
        >>> moving = {"position": orbit.position(0), "velocity": orbit.velocity(0)}
        >>> start = ph.State(ph.Rotor.identity(), [0, 0, orbit.rate], **moving)
        >>> satellite = ph.Body.box([1, 1, 2], mass=50)
        >>> path = ph.simulate(satellite, start, [600.0], force=ph.force.central(orbit.mu))
        >>> bool((path.position[-1] - orbit.position(600)).norm() < 1e-2)
        True
        """
        a, e = self.semi_major_axis, self.eccentricity
        place = self.position(t).components / a
        r, breadth = lengths(place), np.sqrt((1 - e) * (1 + e))
        x, y = place[..., 0], place[..., 1]
        direction = np.stack([-y / r / breadth, breadth * (x + e) / r, np.zeros_like(r)], axis=-1)
        return vector(np.sqrt(self.mu / a) * direction)

    @property
    def _numbers(self) -> tuple[float, float, float, float]:
        return self.semi_major_axis, self.eccentricity, self.mean_anomaly, self.mu


@dataclass(frozen=True)
class DipoleField:
    """The magnetic field of a planet's dipole; `moment` are the components in space in A m²."""

    moment: tuple[float, ...]

    def __repr__(self) -> str:
        return f"dipole_field({list(self.moment)})"

    def __call__(self, t: float, position: Any) -> Multivector:
        """Return the field in T at positions (..., 3) in m relative to the planet; t does not matter."""
        places = as_vectors(position, "position")
        rows = np.ascontiguousarray(places.reshape(-1, 3))
        fields = _native.dipole_fields(np.array(self.moment), rows)
        return vector(fields.reshape(places.shape))


def dipole_field(moment: Any) -> DipoleField:
    """Return the field of a dipole M at the centre of a planet, for `magnetic` along an orbit.

    ``B(x) = μ0/4π (3 (M·u) u − M)/r³`` at ``x = r u``, in T. M is a vector or (3,) in space in A m²; that of
    the Earth is about 7.7e22 A m² and points to the south.

    Examples
    --------
    The field of the Earth points north at the equator, and is twice as strong at the north pole:

    >>> field = ph.torque.dipole_field([0, 0, -7.7e22])
    >>> field(0, [[6.371e6, 0, 0], [0, 0, 6.371e6]])["e3"] * 1e6  # in µT
    array([ 29.77..., -59.55...])
    """
    given = vectors(moment, "moment")
    if not isinstance(given, tuple):
        raise ValueError(f"moment must be a single vector, got batch shape {given.shape}")
    return DipoleField(given)
