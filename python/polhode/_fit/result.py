"""`Fit`: a body and its motion fitted to data, with their uncertainty."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.inertia import Inertia
from polhode._mechanics.state import State
from polhode._report.summary import number
from polhode._support.arrays import Array, as_float, hands_out_copies
from polhode._support.calls import created_by
from polhode._support.extras import optional
from polhode._support.foreign_names import ListsOwnNames, with_foreign_names
from polhode.torque import Torque

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Parameters that are small rotations from the best fit, and so 0.
_TURNS = ("attitude_", "axes_")
# Reduced chi-square that noise of the given size does not leave with so many degrees of freedom.
_TOO_SMALL, _MANY = 0.1, 10


@with_foreign_names(
    {**dict.fromkeys(("params", "popt", "x"), "values"), **dict.fromkeys(("cov", "pcov"), "covariance")}
)
@created_by("ph.fit")
@hands_out_copies("values", "covariance", "times", "residuals")
@dataclass(frozen=True, eq=False)
class Fit(metaclass=ListsOwnNames):
    """The result of `fit`: body, state and sensor, with their uncertainty.

    Attributes
    ----------
    inertia
        On the axes of the data, with moments relative to the largest, which is 1; in kg m² where a torque
        determines the scale.
    omega_body
        Angular velocity in body axes in rad/s at `time`, a bivector.
    rotor
        Attitude at `time`, from body axes to space axes; None without attitudes.
    time
        The first time of the data in s.
    sensor_axes
        Rotor that turns components in axes of the data to those in principal axes, ``x_principal =
        sensor_axes(x_data)``, where the moments ascend; of the equivalent ones that with the smallest angle.
        None if it is not fitted.
    torque
        The torque with its fitted parameters, relative to the moments of `inertia`; None for free motion.
    bias
        Bias of the gyroscope in rad/s, a bivector in body axes: the rates are ``Ω_B + bias``. None if it is
        not fitted.
    clock_offset
        Time in s to add to the times of the rates to get the times of the attitudes; None if not fitted.
    names
        Names of the parameters: ``i1/i3``, the ratio of two moments; ``omega_1``, ``omega_2``, ``omega_3``;
        ``attitude_1``, …, a small rotation vector in space axes, relative to `rotor`; ``axes_1``, …, one in
        principal axes, relative to `sensor_axes`; ``i3``, the largest moment; ``pd_control.kp``, a
        parameter of a law; ``bias_1``, …; ``clock_offset``.
    units
        Their units.
    values
        Array (k,), their values.
    covariance
        Array (k, k), their covariance, linearised at the best fit. A variance that rounding alone limits is
        huge, not infinite.
    times, residuals
        Dictionaries with ``"attitude"`` and ``"rates"``: times (n,) in s on the clock of the data, and
        measured minus computed values (n, 3) in standard deviations. Those of attitudes are rotation vectors
        in space axes.
    noise
        Dictionary with the rms of these differences per component, in rad and rad/s.
    chi2_reduced
        Sum of the squares of the residuals over `dof`; 1 is expected. None if the standard deviations were
        estimated from the residuals, which makes it 1.
    dof
        Number of measured components minus number of parameters.
    undetermined
        Statements of what the data do not determine, from the singular values of the derivatives: of any free
        motion the overall scale of the moments, and each direction among the parameters whose standard
        deviation exceeds half of their size (1 for ratios, 1 rad, the rms rate for rates; for a parameter of
        a law its value, or if larger what changes the motion by about 1 rad).
    misfit
        That the body does not fit the data, and what to check, if `fit` warned of it; else None.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> inertia = ph.Inertia.from_principal_moments(1, 2, 2.5)
    >>> times = np.linspace(0, 5, 51)
    >>> rates = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.5, 2, 0.5]).at(times).omega_body
    >>> measured = rates.components + 0.01 * rng.normal(size=(51, 3))
    >>> found = ph.fit(rates=(times, measured), sigma_rates=0.01, bias=False)
    >>> found.names
    ('i1/i3', 'i2/i3', 'omega_1', 'omega_2', 'omega_3')
    >>> bool((abs(found.values[:2] - [0.4, 0.8]) < 4 * found.stderr[:2]).all())
    True
    >>> found.dof  # 153 numbers, 5 parameters
    148
    """

    inertia: Inertia
    omega_body: Multivector
    rotor: Rotor | None
    time: float
    sensor_axes: Rotor | None
    torque: Torque | None
    bias: Multivector | None
    clock_offset: float | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: Array
    covariance: Array
    times: dict[str, Array]
    residuals: dict[str, Array]
    noise: dict[str, float]
    chi2_reduced: float | None
    dof: int
    undetermined: tuple[str, ...]
    misfit: str | None

    @property
    def state(self) -> State:
        """State at `time`; without attitudes, axes of space are those of the body at this time."""
        rotor = Rotor.identity() if self.rotor is None else self.rotor
        return State(rotor, self.omega_body, time=self.time)

    @property
    def stderr(self) -> Array:
        """Standard deviations (k,) of the parameters."""
        return np.sqrt(np.diag(self.covariance))

    def interval(self, level: float = 0.95) -> Array:
        """Return intervals (k, 2) that contain each parameter with this probability.

        Quantiles are those of the normal distribution, or of Student's if the standard deviations of the data
        were estimated. A ValueError unless 0 < level < 1.

        Examples
        --------
        >>> rng = np.random.default_rng(1)
        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 2.5)
        >>> times = np.linspace(0, 5, 51)
        >>> rates = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.5, 2, 0.5]).at(times).omega_body
        >>> measured = rates.components + 0.01 * rng.normal(size=(51, 3))
        >>> found = ph.fit(rates=(times, measured), sigma_rates=0.01, bias=False)
        >>> low, high = found.interval(0.99).T
        >>> bool(((low < found.values) & (found.values < high)).all())
        True
        """
        share = as_float(level, "level")
        if not 0 < share < 1:
            raise ValueError(f"level must be between 0 and 1, got {share:g}")
        special: Any = optional("scipy.special", "scipy", "a fit")
        upper = 0.5 * (1 + share)
        reach = special.ndtri(upper) if self.chi2_reduced is not None else special.stdtrit(self.dof, upper)
        half = float(reach) * self.stderr
        return np.stack([self.values - half, self.values + half], axis=1)

    def summary(self) -> str:
        """Return the parameters with their standard deviations and the other findings, as text.

        Small rotations, which are 0 at the best fit, have their standard deviations only: those of
        ``attitude_1``, … turn the attitude, those of ``axes_1``, … the sensor axes.

        Examples
        --------
        >>> rng = np.random.default_rng(1)
        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 2.5)
        >>> times = np.linspace(0, 5, 51)
        >>> rates = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.5, 2, 0.5]).at(times).omega_body
        >>> measured = rates.components + 0.01 * rng.normal(size=(51, 3))
        >>> found = ph.fit(rates=(times, measured), sigma_rates=0.01, bias=False)
        >>> print(found.summary().splitlines()[0])
        i1/i3                 0.3985 ± 0.0012
        """
        lines = [f"{name:<21} {text}" for name, text in self._rows()]
        return "\n".join([*lines, "not determined by the data", *(f"  {x}" for x in self.undetermined)])

    def _rows(self) -> list[tuple[str, str]]:
        rows = []
        for name, unit, value, error in zip(self.names, self.units, self.values, self.stderr, strict=True):
            text = f"± {error:.2g}" if name.startswith(_TURNS) else _with_error(value, error)
            rows.append((name, f"{text} {unit}".rstrip()))
        if self.rotor is not None:
            quaternion = ", ".join(f"{x:.6g}" for x in _wxyz(self.rotor))
            rows.append(("attitude", f"quaternion wxyz {quaternion} from body to space axes"))
        if self.sensor_axes is not None:
            turn = ", ".join(f"{x:.6g}" for x in self.sensor_axes.to_rotation_vector())
            rows.append(("sensor axes", f"rotation vector {turn} rad to principal axes"))
        regime = FreeMotion(self.inertia, Rotor.identity(), self.omega_body).describe()["regime"]
        rows.append(("regime", regime if self.torque is None else f"{regime} at the first time"))
        for name, size in self.noise.items():
            rows.append((f"rms of {name}", f"{number(size)} {'rad' if name == 'attitude' else 'rad/s'}"))
        if self.chi2_reduced is None:
            rows.append(("sigma", f"estimated from the residuals, {self.dof} degrees of freedom"))
        else:
            text = f"{self.chi2_reduced:.3f}, {self.dof} degrees of freedom"
            if self.chi2_reduced < _TOO_SMALL and self.dof >= _MANY:
                text += "; sigma is much larger than the residuals, and so are the standard deviations above"
            rows.append(("reduced chi-square", text))
        if self.misfit is not None:
            rows.append(("misfit", self.misfit))
        return rows

    def _repr_html_(self) -> str:
        """Return the summary as a table for notebooks."""
        rows = [*self._rows(), *(("not determined", text) for text in self.undetermined)]
        cells = "".join(
            f'<tr><th style="text-align: left">{escape(name)}</th>'
            f'<td style="text-align: left">{escape(text)}</td></tr>'
            for name, text in rows
        )
        return f"<table><caption>Fit</caption><tbody>{cells}</tbody></table>"

    def __repr__(self) -> str:
        return f"Fit({self.inertia!r}, parameters {', '.join(self.names)})"

    def to_dict(self) -> dict[str, Any]:
        """Return the fit as numbers, lists and strings, for a JSON file; without the residuals.

        Examples
        --------
        >>> rng = np.random.default_rng(1)
        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 2.5)
        >>> times = np.linspace(0, 5, 51)
        >>> rates = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.5, 2, 0.5]).at(times).omega_body
        >>> measured = rates.components + 0.01 * rng.normal(size=(51, 3))
        >>> found = ph.fit(rates=(times, measured), sigma_rates=0.01, bias=False)
        >>> found.to_dict()['dof']
        148
        """
        return {
            "moments": self.inertia.principal_moments.tolist(),
            "time": self.time,
            "omega_body": self.omega_body.components.tolist(),
            "attitude_wxyz": _wxyz(self.rotor),
            "inertia": self.inertia.matrix.tolist(),
            "sensor_axes_wxyz": _wxyz(self.sensor_axes),
            "torque": None if self.torque is None else repr(self.torque),
            "bias": None if self.bias is None else self.bias.components.tolist(),
            "clock_offset": self.clock_offset,
            "names": list(self.names),
            "units": list(self.units),
            "values": self.values.tolist(),
            "stderr": self.stderr.tolist(),
            "covariance": self.covariance.tolist(),
            "noise": dict(self.noise),
            "chi2_reduced": self.chi2_reduced,
            "dof": self.dof,
            "undetermined": list(self.undetermined),
            "misfit": self.misfit,
        }

    def plot(self, *, ax: Axes | None = None) -> Figure:
        """Return a matplotlib figure of the residuals over time, in standard deviations.

        `ax` are axes to draw on, for data of one kind; None for a new figure.

        Raises
        ------
        ValueError
            If `ax` is given and the data are attitudes and rates.
        ImportError
            Without matplotlib: ``pip install 'polhode[plot]'``.

        Examples
        --------
        >>> rng = np.random.default_rng(1)
        >>> inertia = ph.Inertia.from_principal_moments(1, 2, 2.5)
        >>> times = np.linspace(0, 5, 51)
        >>> rates = ph.FreeMotion(inertia, ph.Rotor.identity(), [0.5, 2, 0.5]).at(times).omega_body
        >>> measured = rates.components + 0.01 * rng.normal(size=(51, 3))
        >>> found = ph.fit(rates=(times, measured), sigma_rates=0.01, bias=False)
        >>> found.plot().savefig("residuals.png")
        """
        from polhode._figures.style import Sheet
        from polhode._fit.figure import residual_figure

        if ax is not None and len(self.times) > 1:
            raise ValueError("the residuals of attitudes and rates need two panels; plot() without ax")
        return residual_figure.on(Sheet(ax), self)


def _wxyz(rotor: Rotor | None) -> Any:
    return None if rotor is None else rotor.to_quaternion(order="wxyz").tolist()


def _with_error(value: float, error: float) -> str:
    """Return a value with its standard deviation to two digits, both to the same decimal place."""
    if not np.isfinite(error) or error <= 0:
        return f"{value:.6g} ± {error:.2g}"
    places = 1 - int(np.floor(np.log10(error)))
    if not 0 <= places <= 12 or abs(value) >= 1e6:
        return f"{value:.6g} ± {error:.2g}"
    return f"{value:.{places}f} ± {error:.{places}f}"
