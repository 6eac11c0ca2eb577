"""Bodies, starts and tolerances shared by tests of motions."""

from pathlib import Path

import numpy as np

import polhode as ph

EPS = np.finfo(float).eps
REFERENCE = Path(__file__).parents[1] / "reference" / "motion_cases.json"
# By default a free body moves exactly; this selects steps.
STEPS = "kahan_li8"
METHODS = {
    "strang": 2,
    "yoshida4": 4,
    "yoshida6": 6,
    "kahan_li6": 6,
    "kahan_li8": 8,
    "rkn6": 6,
    "rk4": 4,
    "dop853": 8,
    "midpoint": 2,
    "dmv": 2,
}
# A step forth and the same step back return; so the energy does not drift.
SYMMETRIC = [method for method in METHODS if method not in ("rk4", "dop853")]
# Turns in one step of each: two axes make three, as many times as the composition has stages.
TURNS = {
    "strang": 3,
    "yoshida4": 9,
    "yoshida6": 21,
    "kahan_li6": 27,
    "kahan_li8": 51,
    "rkn6": 33,
    "rk4": 4,
    "dop853": 12,
    "midpoint": 3,
    "dmv": 3,
}


def order_of(method, problem):
    """Its order for one of `SLOPES`; None where it is exact or not fit."""
    if method == "rkn6" and problem in ("free", "damping"):
        return None
    # Without kicks its modified moments make it of order 4.
    return 4 if method == "dmv" and problem == "free" else METHODS[method]


moments = ph.Inertia.from_principal_moments
R0 = ph.Rotor.from_components([4, -2, 1, 2])
ASYMMETRIC = moments(1, 2, 3)
START = ph.State(R0, [0.25, -0.5, 1.0])


def random_walk(steps, method="kahan_li8"):
    """Four standard deviations of the sum of one relative rounding, EPS/2, in every turn, signs at random."""
    return 2 * EPS * np.sqrt(TURNS[method] * steps)


def apart(motion, rotors, omegas):
    """The largest difference from rotors (n, 4) and angular velocities (n, 3), the latter relative."""
    turn = np.linalg.norm(motion.rotor.components - rotors, axis=-1).max()
    spin = np.linalg.norm(motion.omega_body.components - omegas, axis=-1).max()
    return max(turn, spin / np.linalg.norm(omegas, axis=-1).max())


# Motions to measure orders on: inertia, start, torque and time.
SLOPES = {
    "free": (ASYMMETRIC, START, None, 8.0),
    "heavy": (
        moments(1, 2, 2.5),
        ph.State(ph.Rotor.from_components([4, 1, -2, 1]), [0.5, 0.25, 3.0]),
        ph.torque.heavy([0.5, 0.25, 1.0]),
        4.0,
    ),
    "Lagrange": (
        moments(1, 1, 0.5),
        ph.State(ph.Rotor.from_components([4, 2, 1, 0]), [0.25, -0.5, 3.0]),
        ph.torque.heavy([0, 0, 2]),
        4.0,
    ),
    "gravity gradient": (
        moments(1, 2, 2.5),
        ph.State(ph.Rotor.from_components([8, 1, 0.5, 1]), [0.0625, 0.03125, 1.125]),
        ph.torque.gravity_gradient(1.0),
        8.0,
    ),
    "damping": (ASYMMETRIC, START, ph.torque.damping(0.25), 6.0),
}
