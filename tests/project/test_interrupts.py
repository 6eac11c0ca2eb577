"""Ctrl-C is handled within long calls of the compiled core, not only after them."""

import itertools
import signal

import numpy as np
import pytest

import polhode as ph

RNG = np.random.default_rng(1)
INERTIA = ph.Inertia.from_principal_moments(1, 1.5, 2)
MANY = 1_000_000


def state(*shape):
    return ph.State(ph.Rotor.identity(), RNG.standard_normal((*shape, 3)))


def _products():
    A = ph.algebra(8)
    a = A.random(20_000, rng=1)
    return lambda: a * a


def _exponentials():
    a = 0.1 * ph.algebra(8).random(300, rng=1)
    return a.exp


def _powers():
    R = ph.Rotor.random(10 * MANY, 1)
    return lambda: R**0.3


def _inertias():
    moments = RNG.uniform(1, 1.5, (3, MANY // 4))
    return lambda: ph.Inertia.from_principal_moments(*moments)


def _states():
    motion, times = ph.FreeMotion(INERTIA, ph.Rotor.identity(), [0.1, 2, 0.1]), np.linspace(0, 100, 3 * MANY)
    return lambda: motion.at(times)


def _exact_motion():
    start, times = state(), np.linspace(0, 100, MANY // 2)
    return lambda: ph.simulate(INERTIA, start, times)


def _short_formula_runs():
    start, times = state(8000), np.linspace(0, 100, 5)
    return lambda: ph.simulate(INERTIA, start, times, ph.torque.formula("-k Ω", k=0.1), threads=1)


def _one_body_in_many_steps():
    stepper = ph.Stepper(INERTIA, state(), ph.torque.heavy([0, 0, 1]), step=1e-6)
    return lambda: stepper.step(1.0)


def _bodies_in_many_steps():
    stepper = ph.Stepper(INERTIA, state(1000), ph.torque.damping(0.1), method="rk4", step=1e-4)
    return lambda: stepper.step(1.0)


def _orbit():
    orbit, times = ph.torque.KeplerOrbit(7e6, 0.5), np.linspace(0, 1e6, MANY)
    return lambda: orbit.position(times)


def _formula():
    a, b = ph.vector(RNG.standard_normal((2, 3 * MANY, 3)))
    formula = ph.formula("exp(a∧b) a log(exp(a∧b))")
    return lambda: formula(a=a, b=b)


WORK = [
    _products,
    _exponentials,
    _powers,
    _inertias,
    _states,
    _exact_motion,
    _short_formula_runs,
    _one_body_in_many_steps,
    _bodies_in_many_steps,
    _orbit,
    _formula,
]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="the system has no interval timer")
@pytest.mark.parametrize("work", WORK)
def test_signals_are_handled_within_a_call(work, monkeypatch):
    """A signal comes every few milliseconds; several in a row are handled at one place of the program."""
    monkeypatch.setenv("POLHODE_NUM_THREADS", "1")
    call, places = work(), []

    def note(_, frame):
        places.append((frame.f_code, frame.f_lasti))

    before = signal.signal(signal.SIGALRM, note)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.002, 0.002)
        call()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    runs = [len(list(run)) for _, run in itertools.groupby(places)]
    assert max(runs, default=0) >= 3


def test_an_interrupted_step_changes_nothing():
    for stepper in (
        ph.Stepper(INERTIA, state(), ph.torque.heavy([0, 0, 1]), step=1e-9),
        ph.Stepper(INERTIA, state(50), ph.torque.damping(0.1), method="rk4", step=1e-9),
    ):
        before = stepper.state

        def interrupt(*_):
            raise KeyboardInterrupt

        kept = signal.signal(signal.SIGALRM, interrupt)
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            with pytest.raises(KeyboardInterrupt):  # an hour of steps
                stepper.step(1.0)
        finally:
            signal.signal(signal.SIGALRM, kept)
        assert stepper.state == before
        assert stepper.time == 0
