"""Whether the intervals of fits cover the truth as often as they say."""

import numpy as np


def check_coverage(fit, errors, draws):
    """Check that intervals of 68 and 95 % contain the truth in these shares of the draws.

    `fit()` draws noise and fits; `errors(fit)` are values minus true values (k,). The number of hits among n
    draws is binomial: each bound is left by chance with probability 2e-5, for each parameter and level. The
    squared errors in the metric of the covariance have mean k and variance 2k per draw: their average is
    within 4 standard deviations.
    """
    from scipy import stats

    hits, distances = {0.68: 0, 0.95: 0}, []
    for _ in range(draws):
        found = fit()
        off = errors(found)
        distances.append(off @ np.linalg.solve(found.covariance, off))
        for level in hits:
            half = np.diff(found.interval(level), axis=1)[:, 0] / 2
            hits[level] = hits[level] + (np.abs(off) <= half)
    for level, count in hits.items():
        low, high = stats.binom.ppf([1e-5, 1 - 1e-5], draws, level)
        assert np.all((count >= low) & (count <= high)), (level, count)
    k = len(off)
    assert abs(np.mean(distances) - k) < 4 * np.sqrt(2 * k / draws)
