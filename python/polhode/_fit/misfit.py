"""Bodies that do not fit the data: residuals that noise does not explain."""

from __future__ import annotations

import numpy as np

from polhode._fit.samples import Samples
from polhode._support.arrays import Array

# Reduced chi-square above which given standard deviations do not explain the residuals.
_WORST = 10.0
# Without standard deviations: rms of residuals that is hopeless by itself, in rad or relative to the rates.
_HOPELESS = 0.8
# Autocorrelation from sample to sample that noise does not have, and the least rms that goes with it:
# relative to the variation of the rates and to the rates, because a sensor has small systematic errors, and
# in rad.
_SMOOTH, _OF_VARIATION, _OF_RATES, _OF_ATTITUDE = 0.5, 0.03, 0.01, 0.1


def misfit(
    data: dict[str, Samples], differences: dict[str, Array], noise: dict[str, float], reduced: float | None
) -> str | None:
    """Return that the body does not fit, and what to check; None if it fits.

    `differences` are measured minus computed values, `noise` their rms, and `reduced` is the reduced
    chi-square, None if standard deviations were not given.
    """
    if reduced is None:
        is_bad = any(_is_signal(x, differences[name], noise[name]) for name, x in data.items())
    else:
        is_bad = reduced > _WORST
    if not is_bad:
        return None
    found = [] if reduced is None else [f"reduced chi-square {reduced:.3g}"]
    checks = ["the unit of the times"]
    if "attitude" in data:
        found.append(f"rms of attitude {np.degrees(noise['attitude']):.3g}°")
        checks.append("the order of the quaternions and their direction (from body to space axes)")
    if "rates" in data:
        found.append(f"rms of rates {noise['rates']:.3g} rad/s")
        checks.append("the unit and the axes of the rates")
    checks += ["the torque", "the sensor axes"] + ["sigma and outliers"] * (reduced is not None)
    return f"the body does not fit these data ({', '.join(found)}): check {', '.join(checks)}"


def _is_signal(samples: Samples, differences: Array, rms: float) -> bool:
    """Whether residuals are as large as the motion, or smooth as the motion is and not small."""
    if samples.values is samples.rates:
        size = float(np.sqrt(np.mean(samples.rates**2)))
        variation = float(np.sqrt(np.mean(np.var(samples.rates, axis=0))))
        least = max(_OF_VARIATION * variation, _OF_RATES * size)
    else:
        size, least = 1.0, _OF_ATTITUDE
    together = float(np.sum(differences[1:] * differences[:-1]))
    is_smooth = together > _SMOOTH * float(np.sum(differences**2))
    return rms > _HOPELESS * size or (is_smooth and rms > least)
