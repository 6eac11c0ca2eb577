"""Ensembles: free and heavy tops by classical Runge-Kutta steps, and free tops in closed form.

Times are per body and step, or per state. The other libraries use the same method written over arrays; MuJoCo
uses its own method of order 4, with all bodies in one model, or one model rolled out from many states.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import machine
import polhode as ph
from contest import Pace, Row
from integrators import GRAVITY, rates

MOMENTS = (1.0, 2.0, 2.5)
WEIGHT = (0.0, 0.0, 0.5)
STEP = 0.01
FLIP = np.array([1.0, -1, -1, -1])  # of a quaternion (w, x, y, z) to a rotor


def rows(rng: np.random.Generator, pace: Pace) -> Iterator[Row]:
    """Yield all rows of ensembles."""
    steps = max(pace.batch // 500, 10)
    for one_core in (True, False):
        yield stepped(rng, "free, rk4", (0.0, 0.0, 0.0), steps, one_core)
        yield stepped(rng, "heavy, rk4", WEIGHT, steps, one_core)
    yield by_method(rng, "heavy, strang", "strang", steps)
    yield by_method(rng, "heavy, kahan_li8", "kahan_li8", steps // 8)
    for one_core in (True, False):
        yield exact_outer(rng, pace.batch, one_core)
        yield exact_paired(rng, pace.batch // 10, one_core)


def starts(rng: np.random.Generator, n: int) -> tuple[ph.Rotor, Any]:
    """Return attitudes and angular velocities about 1 rad/s, of all regimes."""
    return ph.Rotor.random(n, rng=rng), rng.normal(size=(n, 3))


def stepped(rng: np.random.Generator, what: str, c: tuple[float, ...], steps: int, one_core: bool) -> Row:
    """Steps of 1024 bodies."""
    n = 1024
    cores = "one core" if one_core else "all cores"
    row = Row(
        f"{what}, {cores}, {n} bodies, {steps} steps",
        goal="" if any(c) else "2.5 ns" if one_core else "1.25 ns",
        count=n * steps,
        # Formulations differ in their errors of about (ωh)⁵/120 a step: MuJoCo integrates quaternions by
        # exponentials, and ours keeps L. The fastest bodies turn with 4.5 rad/s: 3e-6 in 2000 steps.
        tolerance=1e-5,
        one_core=one_core,
    )
    rotor, omega = starts(rng, n)
    names = {
        "simulate": ph.simulate,
        "body": ph.Inertia.from_principal_moments(*MOMENTS),
        "states": ph.State(rotor, omega),
        "law": ph.torque.heavy(c) if any(c) else None,
        "times": [steps * STEP],
    }
    code = f"simulate(body, states, times, torque=law, method='rk4', step={STEP})"
    with row.planned():
        row.enter("polhode", code, names, lambda motion: motion.rotor.components[:, -1])
    start = np.concatenate([rotor.components * FLIP, omega], axis=-1).T.copy()
    peers = {"NumPy": _numpy, "JAX": _jax, "MuJoCo": _mujoco, "MuJoCo, rollout": _rollout}
    for library, build in peers.items():
        with row.peer(library):
            row.enter(library, "f(start)", {"f": build(c, n, steps), "start": start}, _rotors)
    return row


def by_method(rng: np.random.Generator, what: str, method: str, steps: int) -> Row:
    """Steps of 1024 heavy bodies by another method, on all cores."""
    n = 1024
    row = Row(f"{what}, all cores, {n} bodies, {steps} steps", count=n * steps)
    names = {
        "simulate": ph.simulate,
        "body": ph.Inertia.from_principal_moments(*MOMENTS),
        "states": ph.State(*starts(rng, n)),
        "law": ph.torque.heavy(WEIGHT),
        "times": [steps * STEP],
    }
    code = f"simulate(body, states, times, torque=law, method={method!r}, step={STEP})"
    with row.planned():
        row.enter("polhode", code, names, lambda motion: motion.rotor.components[:, -1])
    return row


def exact_outer(rng: np.random.Generator, n: int, one_core: bool) -> Row:
    """Free bodies, each at the same times."""
    cores = "one core" if one_core else "all cores"
    bodies = 1000
    row = Row(
        f"exact, {bodies} bodies at {n // bodies} times, {cores}",
        goal="100 ns" if one_core else "",
        count=n,
        traffic=7 * 8,
        one_core=one_core,
    )
    motion = ph.FreeMotion(ph.Inertia.from_principal_moments(*MOMENTS), *starts(rng, bodies))
    names = {"m": motion, "t": rng.uniform(-1e9, 1e9, n // bodies)}
    row.enter("polhode", "m.at(t)", names, lambda state: state.rotor.components.reshape(-1, 4))
    return row


def exact_paired(rng: np.random.Generator, n: int, one_core: bool) -> Row:
    """Free bodies, each at its own time."""
    cores = "one core" if one_core else "all cores"
    row = Row(
        f"exact, {n} bodies, each at its time, {cores}",
        goal="100 ns" if one_core else "",
        count=n,
        one_core=one_core,
    )
    motion = ph.FreeMotion(ph.Inertia.from_principal_moments(*MOMENTS), *starts(rng, n))
    names = {"m": motion, "t": rng.uniform(-1e9, 1e9, n)}
    with row.planned():
        row.enter("polhode", "m.at_each(t)", names, lambda state: state.rotor.components)
    return row


def _rotors(state: Any) -> Any:
    """Rotors (n, 4) from columns of quaternions and rates (7, n)."""
    rotors = np.asarray(state)[:4].T * FLIP
    return rotors / np.linalg.norm(rotors, axis=-1, keepdims=True)


def _steps(stack: Callable[[list[Any]], Any], c: tuple[float, ...], state: Any) -> Any:
    """One classical step of all bodies, columns (7, n)."""

    def slope(y: Any) -> Any:
        return stack(rates(y, (MOMENTS, c)))

    k1 = slope(state)
    k2 = slope(state + 0.5 * STEP * k1)
    k3 = slope(state + 0.5 * STEP * k2)
    k4 = slope(state + STEP * k3)
    return state + STEP / 6 * (k1 + 2 * (k2 + k3) + k4)


def _numpy(c: tuple[float, ...], _: int, steps: int) -> Callable[[Any], Any]:
    def run(state: Any) -> Any:
        for _ in range(steps):
            state = _steps(np.stack, c, state)
        return state

    return run


def _jax(c: tuple[float, ...], _: int, steps: int) -> Callable[[Any], Any]:
    import jax

    jax.config.update("jax_enable_x64", True)
    step = partial(_steps, jax.numpy.stack, c)
    compiled = jax.jit(lambda state: jax.lax.fori_loop(0, steps, lambda _, y: step(y), state))
    return lambda state: jax.block_until_ready(compiled(state))


def _model(c: tuple[float, ...], bodies: int) -> Any:
    """Bodies of mass 1 on ball joints, without contacts and constraints."""
    import mujoco

    place = np.array(c) / GRAVITY
    central = np.array(MOMENTS) - (place @ place - place**2)  # parallel axis theorem

    def words(numbers: Any) -> str:
        return " ".join(repr(float(x)) for x in numbers)

    body = f"""<body><joint type="ball"/>
        <inertial mass="1" pos="{words(place)}" diaginertia="{words(central)}"/></body>"""
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="{STEP}" gravity="0 0 {-GRAVITY}" integrator="RK4">
            <flag contact="disable" constraint="disable" autoreset="disable"/>
          </option>
          <worldbody>{body * bodies}</worldbody>
        </mujoco>""")


def _mujoco(c: tuple[float, ...], bodies: int, steps: int) -> Callable[[Any], Any]:
    """All bodies in one model."""
    import mujoco

    model = _model(c, bodies)
    data = mujoco.MjData(model)

    def run(state: Any) -> Any:
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = state[:4].T.ravel(), state[4:].T.ravel()
        mujoco.mj_step(model, data, nstep=steps)
        return np.concatenate([data.qpos.reshape(-1, 4), data.qvel.reshape(-1, 3)], axis=-1).T

    return run


def _rollout(c: tuple[float, ...], bodies: int, steps: int) -> Callable[[Any], Any]:
    """One model, rolled out from many states by as many threads as there are cores."""
    import mujoco
    from mujoco.rollout import Rollout

    model = _model(c, 1)
    threads = machine.cores()
    datas = [mujoco.MjData(model) for _ in range(threads)]
    roll = Rollout(nthread=threads if threads > 1 else 0)

    def run(state: Any) -> Any:
        full = np.zeros((bodies, 8))  # time, place and rates
        full[:, 1:] = state.T
        states, _ = roll.rollout(model, datas, full, nstep=steps)
        return states[:, -1, 1:].T

    return run
