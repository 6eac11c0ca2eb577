"""Integrators of a top's motion: ours and those of other libraries, each at several settings.

Each tool has a generator that yields its settings for one top. The preparation, such as compiling a function
or building a model, happens there and is not timed. Quaternions (w, x, y, z) are rotors (w, −x, −y, −z).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from time import process_time
from typing import Any

import numpy as np

import polhode as ph
from contest import OURS
from polhode._mechanics.arguments import METHODS
from truth import Top

TOLERANCES = (1e-6, 1e-9, 1e-12)
STRICTEST = 3e-14  # SciPy accepts no less than 100 units in the last place
STEPS = (0.4, 0.2, 0.1, 0.05)
PATIENCE = 5.0  # factor on the time limit of a run, for settings that matter
Solution = tuple[Any, int]  # rotor components at the end, and the steps taken
GRAVITY = 20.0  # in MuJoCo: mass 1 at c/20, so that the inertia about the centre of mass is valid


@dataclass(frozen=True)
class Setting:
    """One way to run a tool: `solve` goes from time 0 to a time.

    `patience` is the factor by which it may exceed the time limit of a run.
    """

    tool: str
    label: str
    solve: Callable[[float], Solution]
    patience: float = 1.0


def polhode(top: Top, _: dict[str, str]) -> Iterator[Setting]:
    """Polhode: to a tolerance, in closed form where there is one, and by fixed steps of each method."""
    body = ph.Inertia.from_principal_moments(*top.moments)
    state = ph.State(ph.Rotor.from_components(np.array(top.rotor, dtype=float)), np.array(top.omega))
    law = ph.torque.heavy(np.array(top.c)) if any(top.c) else None

    def solve(time: float, **options: Any) -> Solution:
        motion = ph.simulate(body, state, [time], torque=law, **options)
        return motion.rotor.components[-1], motion.certificate.steps

    yield Setting(OURS, "auto", solve)
    for rtol in TOLERANCES:
        yield Setting(OURS, f"auto, {rtol:g}", partial(solve, rtol=rtol))
    for method in METHODS[1:]:
        if method == "exact":
            if not any(top.c) or _runs(partial(solve, 0.0, method=method)):
                yield Setting(OURS, method, partial(solve, method=method))
            continue
        for step in STEPS:
            yield Setting(OURS, f"{method}, h = {step:g}", partial(solve, method=method, step=step))


def _runs(call: Callable[[], object]) -> bool:
    """Return whether there is a closed form for this top."""
    try:
        call()
    except ValueError:
        return False
    return True


def rates(state: Any, top: Any) -> list[Any]:
    """Euler's equations and the rate of a quaternion, for integrators of differential equations."""
    w, x, y, z, p, q, r = state
    (i1, i2, i3), (c1, c2, c3) = top
    u1, u2, u3 = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    return [
        -0.5 * (x * p + y * q + z * r),
        0.5 * (w * p + y * r - z * q),
        0.5 * (w * q + z * p - x * r),
        0.5 * (w * r + x * q - y * p),
        ((i2 - i3) * q * r + u2 * c3 - u3 * c2) / i1,
        ((i3 - i1) * r * p + u3 * c1 - u1 * c3) / i2,
        ((i1 - i2) * p * q + u1 * c2 - u2 * c1) / i3,
    ]


def _start(top: Top) -> Any:
    return np.concatenate([_to_quaternion(np.array(top.rotor) / np.linalg.norm(top.rotor)), top.omega])


def _to_quaternion(four: Any) -> Any:
    return np.asarray(four) * [1, -1, -1, -1]


def _to_rotor(quaternion: Any) -> Any:
    return _to_quaternion(quaternion) / np.linalg.norm(quaternion)


def scipy(top: Top, _: dict[str, str]) -> Iterator[Setting]:
    """SciPy's method of order 8; the run at the strictest tolerance, its best one, may take longer."""
    from scipy.integrate import solve_ivp

    start, law = _start(top), (top.moments, top.c)

    def right_side(_: float, state: Any) -> list[float]:
        return rates(state.tolist(), law)  # Python floats are faster than NumPy scalars

    def solve(time: float, rtol: float) -> Solution:
        found = solve_ivp(right_side, (0.0, time), start, "DOP853", rtol=rtol, atol=rtol)
        return _to_rotor(found.y[:4, -1]), len(found.t) - 1

    for rtol in (*TOLERANCES, STRICTEST):
        patience = PATIENCE if rtol == STRICTEST else 1.0
        yield Setting("SciPy", f"DOP853, {rtol:g}", partial(solve, rtol=rtol), patience)


def diffrax(top: Top, notes: dict[str, str]) -> Iterator[Setting]:
    """The method of order 8 in diffrax, compiled."""
    compiled, seconds = _diffrax()
    notes["diffrax"] = f"compiled in {seconds:.1f} s of CPU time, which is not counted"
    start, law = _start(top), np.array((top.moments, top.c), dtype=float)

    def solve(time: float, rtol: float) -> Solution:
        state, steps = compiled(start, time, rtol, law)
        return _to_rotor(np.asarray(state)[:4]), int(steps)

    for rtol in TOLERANCES:
        yield Setting("diffrax", f"Dopri8, {rtol:g}", partial(solve, rtol=rtol))


@cache
def _diffrax() -> tuple[Callable[..., Any], float]:
    """Return the compiled solver, the same for all tops, and its compile time in s."""
    import jax
    from diffrax import Dopri8, ODETerm, PIDController, SaveAt, diffeqsolve

    jax.config.update("jax_enable_x64", True)
    term = ODETerm(lambda _, state, top: jax.numpy.stack(rates(state, top)))

    def solve(start: Any, time: Any, rtol: Any, top: Any) -> Any:
        found = diffeqsolve(
            term,
            Dopri8(),
            t0=0.0,
            t1=time,
            dt0=None,
            y0=start,
            args=top,
            saveat=SaveAt(t1=True),
            stepsize_controller=PIDController(rtol=rtol, atol=rtol),
            max_steps=None,
        )
        return found.ys[0], found.stats["num_steps"]

    begin = process_time()
    compiled = jax.jit(solve)
    jax.block_until_ready(compiled(np.eye(7)[0], 1.0, 1e-6, np.eye(2, 3) + 1))
    return compiled, process_time() - begin


def mujoco(top: Top, _: dict[str, str]) -> Iterator[Setting]:
    """MuJoCo: a body of mass 1 on a ball joint at the origin, without contacts and constraints."""
    import mujoco

    place = np.array(top.c) / GRAVITY
    if np.count_nonzero(place) > 1:
        raise ValueError(f"c = {top.c} is not along an axis of the body; the model requires that")
    central = np.array(top.moments) - (place @ place - place**2)  # parallel axis theorem

    def words(numbers: Any) -> str:
        return " ".join(repr(float(x)) for x in numbers)

    def solve(time: float, model: Any, data: Any, step: float) -> Solution:
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = np.split(_start(top), [4])  # a ball joint's rates are in body axes
        mujoco.mj_step(model, data, nstep=round(time / step))
        if any(kind.number for kind in data.warning):
            raise ArithmeticError("unstable, numbers grow without bound")
        return _to_rotor(data.qpos), round(time / step)

    # By default MuJoCo writes a log file into the working directory.
    mujoco.set_mju_user_warning(lambda _: None)
    for integrator, step in (("RK4", 0.01), ("RK4", 0.002), ("implicitfast", 0.01)):
        model = mujoco.MjModel.from_xml_string(f"""
            <mujoco>
              <option timestep="{step}" gravity="0 0 {-GRAVITY}" integrator="{integrator}">
                <flag contact="disable" constraint="disable" autoreset="disable"/>
              </option>
              <worldbody>
                <body>
                  <joint type="ball"/>
                  <inertial mass="1" pos="{words(place)}" diaginertia="{words(central)}"/>
                </body>
              </worldbody>
            </mujoco>""")
        data = mujoco.MjData(model)
        yield Setting(
            "MuJoCo", f"{integrator}, h = {step:g}", partial(solve, model=model, data=data, step=step)
        )


TOOLS = {OURS: polhode, "SciPy": scipy, "diffrax": diffrax, "MuJoCo": mujoco}
