"""Parameters of a fit, their order, and the principal axes that are chosen among equivalent ones."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from polhode._algebra.rotor import Rotor
from polhode._mechanics.inertia import Inertia
from polhode._support.arrays import Array

# A second moment of mass is at least e^−25 of another: a flat body or a needle, to rounding.
_FLATTEST = 25.0


@dataclass(frozen=True, eq=False)
class Parameters:
    """A point of the fit.

    `shape` has the logarithms of two second moments of mass relative to the third: any numbers are a
    physical body. The attitude at the start is `rotor`, None where the motion does not depend on it; `omega`
    and `rotor` are those of the axes of the data, which `axes` turns to principal axes. The largest moment
    is ``exp(scale)``, `torque` has parameters of laws.
    """

    shape: Array
    omega: Array
    rotor: Rotor | None
    bias: Array
    offset: float = 0.0
    axes: Rotor = field(default_factory=Rotor.identity)
    scale: float = 0.0
    torque: Array = field(default_factory=lambda: np.empty(0))

    @property
    def fractions(self) -> Array:
        """Second moments of mass (integrals of x², y², z²) relative to their sum."""
        logs = np.clip(np.append(self.shape, 0.0), -_FLATTEST, _FLATTEST)
        parts = np.exp(logs - logs.max())
        return np.asarray(parts / parts.sum())

    @property
    def moments(self) -> Array:
        """Principal moments relative to the sum of the second moments, so that their sum is 2."""
        x, y, z = self.fractions
        return np.array([y + z, z + x, x + y])

    @property
    def ratios(self) -> Array:
        """Principal moments relative to the largest."""
        return np.asarray(self.moments / self.moments.max())

    def moments_by_shape(self) -> Array:
        """Derivatives (3, 2) of `moments` by `shape`."""
        x = self.fractions
        return np.asarray(-(np.diag(x) - np.outer(x, x))[:, :2])

    @property
    def inertia(self) -> Inertia:
        """Inertia on the axes of the data, with the largest moment ``exp(scale)``."""
        moments = self.ratios * np.exp(self.scale)
        if self.axes == Rotor.identity():
            return Inertia.from_principal_moments(*moments.tolist())
        turned = self.axes.to_matrix()
        matrix = turned.T @ np.diag(moments) @ turned
        return Inertia.from_matrix(0.5 * (matrix + matrix.T))

    def in_order(self) -> Parameters:
        """Return the same body with ascending moments, on the principal axes nearest to those of the data.

        Axes of a body may be numbered and reversed: 24 rotations describe the same body.
        """
        order = np.argsort(self.moments, kind="stable")
        turned = self.axes.to_matrix()
        candidates = []
        for signs in itertools.product((1.0, -1.0), repeat=3):
            permuted = np.zeros((3, 3))
            permuted[np.arange(3), order] = signs
            if np.linalg.det(permuted) > 0:
                candidates.append(permuted @ turned)
        nearest = max(candidates, key=lambda matrix: float(np.trace(matrix)))
        return replace(self, shape=shape_of(self.fractions[order]), axes=Rotor.from_matrix(nearest))


def shape_of(fractions: Array) -> Array:
    """Return the parameter `shape` of second moments of mass."""
    return np.asarray(np.log(fractions[:2] / fractions[2]))


@dataclass(frozen=True)
class Layout:
    """Which parameters are fitted, and how many of the torque; the others are fixed."""

    attitude: bool
    bias: bool
    offset: bool
    axes: bool = False
    scale: bool = False
    torque: int = 0

    @cached_property
    def places(self) -> dict[str, slice]:
        """Places of the parameters in a step: first those of the motion, then those of the sensors."""
        sizes = {
            "shape": 2,
            "omega": 3,
            "attitude": 3 * self.attitude,
            "axes": 3 * self.axes,
            "scale": int(self.scale),
            "torque": self.torque,
            "bias": 3 * self.bias,
            "offset": int(self.offset),
        }
        ends = np.cumsum([0, *sizes.values()]).tolist()
        return {name: slice(*ends[k : k + 2]) for k, name in enumerate(sizes)}

    @property
    def motion(self) -> int:
        """Number of the parameters of the motion."""
        return int(self.places["torque"].stop)

    @property
    def size(self) -> int:
        """Number of all parameters."""
        return int(self.places["offset"].stop)

    def moved(self, base: Parameters, step: Array) -> Parameters:
        """Return parameters moved by a step.

        The attitude turns by a rotation vector in space axes, the axes by one in principal axes. A step may
        end after the parameters of the motion.
        """
        of, rotor = self.places, base.rotor
        if rotor is not None and self.attitude:
            rotor = Rotor.from_rotation_vector(step[of["attitude"]]) * rotor
        more = len(step) == self.size
        return Parameters(
            base.shape + step[of["shape"]],
            base.omega + step[of["omega"]],
            rotor,
            base.bias + step[of["bias"]] if self.bias and more else base.bias,
            base.offset + float(step[of["offset"]][0]) if self.offset and more else base.offset,
            Rotor.from_rotation_vector(step[of["axes"]]) * base.axes if self.axes else base.axes,
            base.scale + float(step[of["scale"]][0]) if self.scale else base.scale,
            base.torque + step[of["torque"]] if self.torque else base.torque,
        )
