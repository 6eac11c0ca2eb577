"""Motion: the heavy top by integration, the free top in closed form."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import polhode as ph
from contest import Pace, Row

SciPyRight = Callable[[float, Any], Any]


def rows(rng: np.random.Generator, pace: Pace) -> Iterator[Row]:
    """Yield all rows of motion."""
    yield lagrange_top()
    yield free_top_setup(rng)
    yield free_top_once(rng)
    yield free_top_batch(rng, pace.batch // 10)


def lagrange_top() -> Row:
    """The heavy top of i = (1, 1, 1/2), c = 2 e3 to t = 100."""
    row = Row("Lagrange top to t = 100, 1e-9 or better", goal="1 ms", unit="ms", tolerance=1e-8)
    moments, spin, c = np.array([1.0, 1.0, 0.5]), np.array([0.25, -0.5, 6.0]), np.array([0.0, 0.0, 2.0])
    rotor = ph.Rotor.from_components([4.0, 2.0, 1.0, 0.0])
    names = {
        "simulate": ph.simulate,
        "body": ph.Inertia.from_principal_moments(*moments),
        "state": ph.State(rotor, spin),
        "law": ph.torque.heavy(c),
    }
    row.enter("polhode", "simulate(body, state, [100.0], torque=law)", names, _last)
    with row.peer("SciPy"):
        _dop853(row, rotor, spin, _right_side(moments, lambda up: np.cross(up, c)), 100.0)
    return row


def _free_top(rng: np.random.Generator) -> tuple[ph.Inertia, ph.Rotor, Any]:
    return (
        ph.Inertia.from_principal_moments(1.0, 2.0, 2.5),
        ph.Rotor.random(rng=rng),
        np.array([0.3, 1.0, 0.2]),
    )


def free_top_setup(rng: np.random.Generator) -> Row:
    """Construction of a motion from inertia and state."""
    row = Row("free top, set-up", goal="5 us", unit="us")
    inertia, rotor, omega = _free_top(rng)
    names = {"new": ph.FreeMotion, "inertia": inertia, "rotor": rotor, "omega": omega}
    row.enter("polhode", "new(inertia, rotor, omega)", names, lambda m: m.at(0.0).rotor.components)
    return row


def free_top_once(rng: np.random.Generator) -> Row:
    """The state of a free asymmetric top at one time."""
    row = Row("free top, state at t = 100", goal="0.12 us", unit="us", tolerance=1e-8)
    inertia, rotor, omega = _free_top(rng)
    names = {"m": ph.FreeMotion(inertia, rotor, omega)}
    row.enter(
        "polhode", "m.at(100.0)", names, lambda s: np.hstack([s.rotor.components, s.omega_body.components])
    )
    with row.peer("SciPy"):
        moments = np.array(inertia.principal_moments)
        _dop853(row, rotor, omega, _right_side(moments, lambda up: 0.0), 100.0)
    return row


def free_top_batch(rng: np.random.Generator, n: int) -> Row:
    """The states of a free asymmetric top at many times, up to 1e12 of either sign."""
    row = Row("free top, states at any t", goal="20 ns", count=n, traffic=8 * 8)
    names = {"m": ph.FreeMotion(*_free_top(rng)), "t": rng.uniform(-1e12, 1e12, n)}
    row.enter("polhode", "m.at(t)", names, lambda s: s.rotor.components)
    return row


def _last(trajectory: Any) -> Any:
    return np.hstack([trajectory.rotor.components[-1], trajectory.omega_body.components[-1]])


def _right_side(moments: Any, torque: Callable[[Any], Any]) -> SciPyRight:
    """Euler's equations and the rate of a quaternion for SciPy; `torque` takes the vertical in body axes."""

    def right_side(_: float, y: Any) -> Any:
        w, x, y_, z, *omega = y
        up = np.array([2 * (x * z - w * y_), 2 * (y_ * z + w * x), 1 - 2 * (x * x + y_ * y_)])
        rate = np.array(omega)
        quaternion = [np.array([-x, -y_, -z]) @ rate, *(w * rate + np.cross([x, y_, z], rate))]
        acceleration = (torque(up) - np.cross(rate, moments * rate)) / moments
        return np.concatenate([0.5 * np.array(quaternion), acceleration])

    return right_side


def _dop853(row: Row, rotor: ph.Rotor, omega: Any, right_side: SciPyRight, time: float) -> None:
    """Add SciPy's method of order 8 at tolerances that give an error of 1e-9."""
    from scipy.integrate import solve_ivp

    names = {
        "solve_ivp": solve_ivp,
        "f": right_side,
        "start": np.concatenate([rotor.to_quaternion(order="wxyz"), omega]),
    }
    code = f"solve_ivp(f, (0, {time}), start, 'DOP853', rtol=1e-10, atol=1e-12)"
    row.enter("SciPy", code, names, lambda s: s.y[:, -1] * [1, -1, -1, -1, 1, 1, 1])
