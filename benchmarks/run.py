"""Ours against peers, in one run on this machine. Prints a table; ratios count, absolute times are noisy."""

from __future__ import annotations

import platform
import time
from collections.abc import Callable

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import polhode as ph

ROWS = 1_000_000


def seconds(work: Callable[[], object], repeat: int = 5) -> float:
    """Return the best of several runs, each long enough to measure."""
    start = time.perf_counter()
    work()
    once = time.perf_counter() - start
    number = max(1, int(0.1 / max(once, 1e-9)))
    best = float("inf")
    for _ in range(repeat):
        start = time.perf_counter()
        for _ in range(number):
            work()
        best = min(best, (time.perf_counter() - start) / number)
    return best


def row(what: str, ours: float, peer: str, theirs: float, unit: float, name: str) -> None:
    """Print one line of the table."""
    print(
        f"{what:<44}{ours / unit:>10.3g} {name:<6}{peer:<26}{theirs / unit:>10.3g}  {theirs / ours:>8.2f} x"
    )


def products() -> None:
    """Products and sandwiches, single and in batches."""
    rng = np.random.default_rng(1)
    a, b = ph.multivector(rng.standard_normal((2, ROWS, 8)))
    signs = np.zeros((8, 8, 8))
    basis = ph.multivector(np.eye(8))
    for i in range(8):
        signs[i] = (basis[i] * basis).components

    def einsum() -> object:
        return np.einsum("ni,nj,ijk->nk", a.components, b.components, signs, optimize=True)

    row(
        "1M full products, ns each",
        seconds(lambda: a * b),
        "NumPy einsum",
        seconds(einsum, 2),
        1e-9 * ROWS,
        "ns",
    )
    rotors = ph.Rotor.random(ROWS, rng)
    vectors = ph.vector(rng.standard_normal((ROWS, 3)))
    scipy_rotors, points = rotors.to_scipy(), np.array(vectors.components)
    row(
        "1M R v ~R, ns each",
        seconds(lambda: rotors(vectors)),
        "SciPy Rotation.apply",
        seconds(lambda: scipy_rotors.apply(points)),
        1e-9 * ROWS,
        "ns",
    )
    x, one, turn = ph.vector([1.0, 2.0, 3.0]), Rotation.random(rng=rng), ph.Rotor.random(rng=rng)
    point = np.array([1.0, 2.0, 3.0])
    row(
        "R v ~R, one",
        seconds(lambda: turn(x)),
        "SciPy Rotation.apply",
        seconds(lambda: one.apply(point)),
        1e-6,
        "us",
    )


def lagrange_top() -> None:
    """The heavy top of i = (1, 1, 1/2), c3 = 2 to t = 100."""
    moments, spin, c3 = np.array([1.0, 1.0, 0.5]), np.array([0.25, -0.5, 6.0]), 2.0
    rotor = ph.Rotor.from_components([4.0, 2.0, 1.0, 0.0])
    state = ph.State(rotor, spin)
    inertia = ph.Inertia.from_principal_moments(*moments)
    law = ph.torque.heavy([0.0, 0.0, c3])

    def right_side(_: float, y: np.ndarray) -> np.ndarray:
        w, x, y_, z, *omega = y
        up = np.array([2 * (x * z - w * y_), 2 * (y_ * z + w * x), 1 - 2 * (x * x + y_ * y_)])
        rate = np.array(omega)
        q = np.array([-x, -y_, -z]) @ rate, *(w * rate + np.cross([x, y_, z], rate))
        torque = np.cross(up, [0.0, 0.0, c3]) - np.cross(rate, moments * rate)
        return np.concatenate([0.5 * np.array(q), torque / moments])

    start = np.concatenate([rotor.to_quaternion(order="wxyz"), spin])
    ours = seconds(lambda: ph.simulate(inertia, state, [100.0], torque=law))
    theirs = seconds(lambda: solve_ivp(right_side, (0, 100), start, "DOP853", rtol=1e-10, atol=1e-12), 1)
    row("Lagrange top to t = 100, 1e-9 or better", ours, "SciPy DOP853 1e-10", theirs, 1e-3, "ms")
    estimate = ph.simulate(inertia, state, [100.0], torque=law).certificate.error_estimate
    print(f"{'':<44}(our error estimate: {estimate:.1e})")


if __name__ == "__main__":
    print(
        f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, "
        f"NumPy {np.__version__}, SciPy {scipy.__version__}, polhode {ph.__version__}"
    )
    print(f"{'':<44}{'polhode':>10}       {'peer':<26}{'':>10}     ratio")
    products()
    lagrange_top()
