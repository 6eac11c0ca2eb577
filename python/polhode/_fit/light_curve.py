"""The rotations that two periods of a light curve leave possible, of one body or of all."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._fit.periods import Mode, omega_from_periods
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.inertia import Inertia
from polhode._report.summary import number
from polhode._support.arrays import Array

MODES: tuple[Mode, ...] = ("long", "short")
# Moment ratios of bodies that are tried where no moments are given: steps of 1/_STEPS of the largest.
_STEPS = 25


@dataclass(frozen=True)
class Rotation:
    """A mode of rotation with these periods in s, of a body or of a family of bodies.

    Of one body: angular velocity in rad/s on its principal axes (None if it has no such motion), the extremes
    in rad of the angle between the angular momentum and the encircled axis, and the energy relative to that
    of the rotation about the axis of the largest moment with the same angular momentum. Of a family: the
    ranges of its moments relative to the largest.
    """

    mode: Mode
    rotation_period: float
    precession_period: float
    omega_body: list[float] | None = None
    wobble: list[float] | None = None
    energy_ratio: float | None = None
    ranges: list[list[float]] | None = None

    @property
    def is_possible(self) -> bool:
        """Whether a body has this rotation."""
        return self.omega_body is not None or self.ranges is not None

    def text(self) -> str:
        """Return the rotation as a line."""
        if self.omega_body is not None and self.wobble is not None:
            rates = ", ".join(number(float(np.degrees(x))) for x in self.omega_body)
            low, high = (number(float(np.degrees(x))) for x in self.wobble)
            return f"omega {rates} deg/s, wobble {low} to {high} deg, energy ratio {self.energy_ratio:.4f}"
        if self.ranges is not None:
            small, middle = ("{:.2f} to {:.2f}".format(*row) for row in self.ranges)
            return f"bodies with i1/i3 of {small} and i2/i3 of {middle}, i1 <= i2 <= i3"
        return "not possible"


def rotations(moments: Any, first: float, second: float) -> list[Rotation]:
    """Return both modes for both orders of the periods, of a body or, without moments, of all bodies."""
    found = []
    for rotation, precession in ((first, second), (second, first)):
        for mode in MODES:
            if moments is None:
                found.append(_family(rotation, precession, mode))
            else:
                found.append(_of_body(moments, rotation, precession, mode))
    return found


def statements(moments: Any, found: list[Rotation]) -> list[str]:
    """Return what the periods do not determine."""
    count = sum(x.is_possible for x in found)
    if moments is not None and min(moments) == max(moments):
        return ["the motion: a ball rotates steadily, without precession, and has no such two periods"]
    texts = ["overall scale of the moments: free motion depends on their ratios only"]
    if moments is None:
        texts.append("moments: two periods leave a family of bodies for each mode; give --moments of a shape")
    if count > 1:
        texts.append(
            f"mode: {count} rotations have these periods; amplitudes of the light curve or a shape decide"
        )
    return [*texts, "directions in space, and the phases: periods do not contain them"]


def as_dict(found: list[Rotation]) -> list[dict[str, Any]]:
    """Return the rotations for a JSON file."""
    return [{**asdict(x), "is_possible": x.is_possible} for x in found]


def _of_body(moments: Any, rotation: float, precession: float, mode: Mode) -> Rotation:
    omega = omega_from_periods(moments, rotation, precession, mode=mode)
    if not np.isfinite(omega.components).all():
        return Rotation(mode, rotation, precession)
    body = Inertia.from_principal_moments(*moments)
    about = FreeMotion(body, Rotor.identity(), omega).describe()
    ratio = 2 * about["energy"] * max(moments) / about["angular_momentum"] ** 2
    wobble = [about["wobble_min"], about["wobble_max"]]
    return Rotation(mode, rotation, precession, omega.components.tolist(), wobble, ratio)


def _family(rotation: float, precession: float, mode: Mode) -> Rotation:
    """Return the ranges of the moments of bodies that have these periods."""
    ratios = np.array(_ratios())
    omega = omega_from_periods(ratios, rotation, precession, mode=mode).components
    inside: Array = ratios[np.isfinite(omega).all(axis=1)]
    ranges = [[float(x.min()), float(x.max())] for x in inside.T[:2]] if len(inside) else None
    return Rotation(mode, rotation, precession, ranges=ranges)


def _ratios() -> list[tuple[float, float, float]]:
    """Return moments relative to the largest, i1 < i2 < i3 and i1 + i2 > i3, of a grid of bodies."""
    half = 0.5 / _STEPS
    levels = [k / _STEPS + half for k in range(_STEPS)]
    return [(a, b, 1.0) for a in levels for b in levels if a < b and a + b > 1]
