"""The free motion as a function of the parameters of a fit: residuals and their exact derivatives."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from polhode._algebra.constructors import bivector, multivector
from polhode._algebra.jacobians import left_jacobian, right_jacobian
from polhode._algebra.rotor import Rotor
from polhode._fit.samples import Samples
from polhode._mechanics.bodies import Inertia
from polhode._mechanics.free_motion import FreeMotion
from polhode._support.arrays import Array

# A second moment of mass is at least e^−25 of another: a flat body or a needle, to rounding.
_FLATTEST = 25.0


@dataclass(frozen=True, eq=False)
class Parameters:
    """A point of the fit.

    `shape` has the logarithms of two second moments of mass relative to the third: any numbers are a
    physical body. The attitude at the start is `rotor`; None without attitudes.
    """

    shape: Array
    omega: Array
    rotor: Rotor | None
    bias: Array
    offset: float = 0.0

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

    def moments_by_shape(self) -> Array:
        """Derivatives (3, 2) of `moments` by `shape`."""
        x = self.fractions
        return np.asarray(-(np.diag(x) - np.outer(x, x))[:, :2])


def shape_of(fractions: Array) -> Array:
    """Return the parameter `shape` of second moments of mass."""
    return np.asarray(np.log(fractions[:2] / fractions[2]))


@dataclass(frozen=True, eq=False)
class Model:
    """Residuals of measured attitudes and rates, in standard deviations, as a function of parameters."""

    attitudes: Samples | None
    rates: Samples | None
    start: float
    has_bias: bool
    has_offset: bool

    def before(self, end: float) -> Model:
        """Return the model of the data up to a time."""
        attitudes, rates = (x and x.before(end) for x in (self.attitudes, self.rates))
        return replace(self, attitudes=attitudes, rates=rates)

    @property
    def size(self) -> int:
        """Number of parameters."""
        return 5 + 3 * (self.attitudes is not None) + 3 * self.has_bias + self.has_offset

    @property
    def rate(self) -> float:
        """Root mean square of the measured angular velocity in rad/s; 1 for a body at rest."""
        source = self.rates or self.attitudes
        assert source is not None
        return float(np.sqrt(3 * np.mean(source.rates**2))) or 1.0

    def scale(self) -> Array:
        """Return sizes (k,) of steps after which the motion is quite another one."""
        sizes = [1.0] * 2 + [self.rate] * 3 + [1.0] * 3 * (self.attitudes is not None)
        return np.array(sizes + [0.1 * self.rate] * 3 * self.has_bias + [1 / self.rate] * self.has_offset)

    def moved(self, base: Parameters, step: Array) -> Parameters:
        """Return parameters moved by a step: the attitude turns by a rotation vector in space axes."""
        k, rotor, bias, offset = 5, base.rotor, base.bias, base.offset
        if rotor is not None:
            rotor, k = Rotor.from_rotation_vector(step[5:8]) * rotor, 8
        if self.has_bias:
            bias, k = bias + step[k : k + 3], k + 3
        if self.has_offset:
            offset += float(step[k])
        return Parameters(base.shape + step[:2], base.omega + step[2:5], rotor, bias, offset)

    def motion(self, at: Parameters) -> FreeMotion:
        """Return the free motion; its time 0 is `start`."""
        inertia = Inertia.from_principal_moments(*at.moments.tolist())
        rotor = Rotor.identity() if at.rotor is None else at.rotor
        return FreeMotion(inertia, rotor, bivector(at.omega))

    def differences(self, at: Parameters) -> list[Array]:
        """Return measured minus computed values in rad and rad/s, (n, 3) of attitudes, (m, 3) of rates."""
        motion, found = self.motion(at), []
        if self.attitudes is not None:
            computed = motion.at(self.attitudes.times - self.start).rotor
            found.append((self.attitudes.values * ~computed).to_rotation_vector())
        if self.rates is not None:
            rates = motion.at(self.rates.times + at.offset - self.start).omega_body.components
            found.append(self.rates.values - rates - at.bias)
        return found

    def residuals(self, at: Parameters) -> Array:
        """Return the differences in standard deviations, flat: attitudes, then rates."""
        sigmas = [x.sigma for x in (self.attitudes, self.rates) if x is not None]
        return np.concatenate([(d / s).ravel() for d, s in zip(self.differences(at), sigmas, strict=True)])

    def jacobian(self, at: Parameters, turn: Array | None = None) -> Array:
        """Return derivatives of the residuals, by moments (3), omega (3), attitude (3), bias (3), offset.

        The attitude counts by its small turn in space axes; with `turn`, by the rotation vector `turn` of
        a step (see `moved`).
        """
        motion, blocks = self.motion(at), []
        if self.attitudes is not None:
            t = self.attitudes.times - self.start
            computed, d = motion.at(t).rotor, motion.derivatives(t)
            columns = np.concatenate([d.d_rotor_d_moments, d.d_rotor_d_omega, d.d_rotor_d_attitude], axis=-1)
            turns = _turns(columns, computed)
            if turn is not None:
                turns[..., 6:] = turns[..., 6:] @ left_jacobian(turn)
            off = (self.attitudes.values * ~computed).to_rotation_vector()
            block = -right_jacobian(off, inverse=True) @ turns
            blocks.append(self._rows(block / self.attitudes.sigma[:, :, np.newaxis], 9))
        if self.rates is not None:
            d = motion.derivatives(self.rates.times + at.offset - self.start)
            parts = [d.d_omega_d_moments, d.d_omega_d_omega]
            parts += [np.zeros((len(self.rates), 3, 3))] * (self.attitudes is not None)
            parts += [np.broadcast_to(np.eye(3), (len(self.rates), 3, 3))] * self.has_bias
            parts += [d.d_omega_dt[..., np.newaxis]] * self.has_offset
            block = -np.concatenate(parts, axis=-1)
            blocks.append(self._rows(block / self.rates.sigma[:, :, np.newaxis], block.shape[-1]))
        return np.concatenate(blocks)

    def _rows(self, block: Array, filled: int) -> Array:
        """Return a block (n, 3, filled) as rows of all derivatives."""
        rows = np.zeros((3 * len(block), self.size + 1))
        rows[:, :filled] = block.reshape(-1, filled)
        return rows


def _turns(columns: Array, rotors: Rotor) -> Array:
    """Return the turns in space axes (n, 3, k) of changes of rotors (n, 4, k): ``−2 dR ~R``."""
    even = np.zeros((*columns.shape[:-2], columns.shape[-1], 8))
    even[..., [0, 4, 5, 6]] = np.swapaxes(columns, -1, -2)
    turned = -2 * multivector(even) * ~rotors[..., np.newaxis]
    return np.swapaxes(turned.grade(2).components, -1, -2)
