"""Residuals of measured attitudes and rates as a function of the parameters, and their derivatives."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from polhode._algebra.jacobians import left_jacobian, right_jacobian
from polhode._fit.free_flow import FreeFlow
from polhode._fit.laws import Laws
from polhode._fit.parameters import Layout, Parameters
from polhode._fit.samples import Samples
from polhode._fit.torqued_flow import TorquedFlow
from polhode._support.arrays import Array

# Number of samples of an arc under a torque, which only gives a start for the next.
_MOST = 100


@dataclass(frozen=True, eq=False)
class Model:
    """Residuals of measured attitudes and rates, in standard deviations, as a function of parameters."""

    attitudes: Samples | None
    rates: Samples | None
    start: float
    layout: Layout
    laws: Laws | None = None

    def before(self, end: float) -> Model:
        """Return the model of the data up to a time; of those under a torque, of some of them."""
        most = None if self.laws is None else _MOST
        attitudes, rates = (x and x.before(end, most) for x in (self.attitudes, self.rates))
        return replace(self, attitudes=attitudes, rates=rates)

    def with_noise(self, factor: float) -> Model:
        """Return the model of data whose standard deviations are larger by a factor."""
        attitudes, rates = (x and replace(x, sigma=factor * x.sigma) for x in (self.attitudes, self.rates))
        return replace(self, attitudes=attitudes, rates=rates)

    @property
    def size(self) -> int:
        """Number of parameters."""
        return self.layout.size

    @property
    def samples(self) -> list[Samples]:
        """The attitudes and the rates, of which one may be missing."""
        return [x for x in (self.attitudes, self.rates) if x is not None]

    @property
    def source(self) -> Samples:
        """The rates, or the attitudes without rates."""
        source = self.rates or self.attitudes
        assert source is not None
        return source

    @property
    def rate(self) -> float:
        """Root mean square of the measured angular velocity in rad/s; 1 for a body at rest."""
        return float(np.sqrt(3 * np.mean(self.source.rates**2))) or 1.0

    @property
    def flow(self) -> FreeFlow | TorquedFlow:
        """The motion at the times of the data."""
        return TorquedFlow(self.layout, self.laws, self.start) if self.laws else FreeFlow(self.layout)

    def scale(self, at: Parameters) -> Array:
        """Return sizes (k,) of steps after which the motion is quite another one."""
        sizes, of = np.ones(self.size), self.layout.places
        sizes[of["omega"]] = self.rate
        sizes[of["torque"]] = self.torque_sizes(at)
        sizes[of["bias"]] = 0.1 * self.rate
        sizes[of["offset"]] = 1 / self.rate
        return sizes

    def torque_sizes(self, at: Parameters) -> Array:
        """Return sizes (q,) of the parameters of the torque."""
        if self.laws is None:
            return np.empty(0)
        return self.laws.sizes(at.torque, np.exp(at.scale), self.rate, float(self.source.turn()[-1]))

    def _times(self, at: Parameters) -> tuple[Array, Array]:
        """Return the times of attitudes and rates from the start on, on the clock of the attitudes."""
        none = np.empty(0)
        return (
            none if self.attitudes is None else self.attitudes.times - self.start,
            none if self.rates is None else self.rates.times + at.offset - self.start,
        )

    def differences(self, at: Parameters) -> list[Array]:
        """Return measured minus computed values in rad and rad/s, (n, 3) of attitudes, (m, 3) of rates."""
        rotors, rates = self.flow.states(at, *self._times(at))
        found = []
        if self.attitudes is not None:
            found.append((self.attitudes.values * ~rotors).to_rotation_vector())
        if self.rates is not None:
            found.append(self.rates.values - rates - at.bias)
        return found

    def residuals(self, at: Parameters) -> Array:
        """Return the differences in standard deviations, flat: attitudes, then rates."""
        pairs = zip(self.differences(at), self.samples, strict=True)
        return np.concatenate([(difference / x.sigma).ravel() for difference, x in pairs])

    def jacobian(self, at: Parameters, step: Array | None = None) -> Array:
        """Return derivatives of the residuals by the parameters, in the order of the layout.

        Turns of the attitude and the axes count from `at`; with `step`, from the base of this step, of which
        they are rotation vectors (see `Layout.moved`).
        """
        turns, by_motion, by_time = self.flow.derivatives(at, *self._times(at))
        of, blocks = self.layout.places, []
        if self.attitudes is not None:
            computed = self.flow.states(at, self._times(at)[0], np.empty(0))[0]
            off = (self.attitudes.values * ~computed).to_rotation_vector()
            block = np.zeros((len(off), 3, self.size))
            block[..., : turns.shape[-1]] = -right_jacobian(off, inverse=True) @ turns
            blocks.append(block / self.attitudes.sigma[:, :, np.newaxis])
        if self.rates is not None:
            block = np.zeros((len(self.rates), 3, self.size))
            block[..., : by_motion.shape[-1]] = -by_motion
            if self.layout.bias:
                block[..., of["bias"]] = -np.eye(3)
            if self.layout.offset:
                block[..., of["offset"]] = -by_time[..., np.newaxis]
            blocks.append(block / self.rates.sigma[:, :, np.newaxis])
        rows = np.concatenate([x.reshape(-1, self.size) for x in blocks])
        if step is not None:
            for name in ("attitude", "axes"):
                if step[of[name]].size:
                    rows[:, of[name]] = rows[:, of[name]] @ left_jacobian(step[of[name]])
        return rows
