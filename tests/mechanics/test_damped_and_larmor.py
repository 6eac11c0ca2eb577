"""`DampedTop` and `LarmorSphere`."""

import json

import numpy as np
import pytest

import polhode as ph
from motions import EPS, REFERENCE, moments

CASES = {c["name"]: c for c in json.loads(REFERENCE.read_text())["torqued"]}
R0 = ph.Rotor.from_components([4, -2, 1, 2])


def check(motion, case):
    states = motion.at([float(x["t"]) for x in case["results"]])
    for k, result in enumerate(case["results"]):
        r, w = np.array(result["R"], float), np.array(result["omega"], float)
        assert np.abs(states.rotor.components[k] - r).max() <= 8 * EPS
        assert np.abs(states.omega_body.components[k] - w).max() <= 8 * EPS * np.linalg.norm(w)


def test_damped_reference():
    case = CASES["isotropic_damping"]
    check(ph.DampedTop(moments(1, 2, 3), R0, [0.5, 1, 0.25], float(case["params"]["g"])), case)


def test_larmor_reference():
    case = CASES["sphere_larmor"]
    check(ph.LarmorSphere(moments(2, 2, 2), R0, [0.5, 1, 0.25], [0.125, 0.5, 1]), case)


@pytest.mark.parametrize("g", [0.5, -0.25])
def test_damping_agrees_with_steps(g):
    times = np.linspace(0, 5, 6)
    state = ph.State(R0, [0.5, 1, 0.25])
    exact = ph.DampedTop(moments(1, 2, 3), R0, [0.5, 1, 0.25], g).at(times)
    steps = ph.simulate(moments(1, 2, 3), state, times, ph.torque.damping(g), rtol=1e-11)
    assert np.abs(exact.rotor.components - steps.rotor.components).max() <= 1e-10
    assert np.abs(exact.omega_body.components - steps.omega_body.components).max() <= 1e-9


def test_a_damped_body_comes_to_rest():
    top = ph.DampedTop(moments(1, 2, 3), R0, [0.5, 1, 0.25], 0.125)
    free = ph.FreeMotion(moments(1, 2, 3), R0, [0.5, 1, 0.25])
    assert (top.at(1e300).rotor - free.at(8.0).rotor).norm() <= 8 * EPS
    with pytest.raises(ValueError, match="is beyond"):
        top.at(-1e6)


def test_bad_input_is_refused():
    with pytest.raises(ValueError, match="damping g is NaN"):
        ph.DampedTop(moments(1, 2, 3), R0, [1, 0, 0], np.nan)
    with pytest.raises(ValueError, match="not a sphere"):
        ph.LarmorSphere(moments(1, 1, 1.5), R0, [1, 0, 0], [0, 0, 1])
    with pytest.raises(TypeError, match="Inertia"):
        ph.LarmorSphere([1, 1, 1], R0, [1, 0, 0], [0, 0, 1])
    with pytest.raises(ValueError, match=r"\(2,\) of the rotor, .* and \(3,\) of b do not broadcast"):
        ph.LarmorSphere(moments(1, 1, 1), ph.Rotor.identity((2,)), [1, 0, 0], np.ones((3, 3)))
    with pytest.raises(ValueError, match="time inf at index 1"):
        ph.LarmorSphere(moments(1, 1, 1), R0, [1, 0, 0], [0, 0, 1]).at([0, np.inf])
