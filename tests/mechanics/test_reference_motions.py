"""Motion against 40-digit references, its error estimate against the error, and the promised orders."""

import json

import numpy as np
import pytest

import polhode as ph
from motions import (
    ASYMMETRIC,
    EPS,
    METHODS,
    REFERENCE,
    SLOPES,
    START,
    STEPS,
    SYMMETRIC,
    apart,
    moments,
    order_of,
    random_walk,
)
from references import law as law_of

# --- reference states

# To 17 digits, of two independent computations with 60 and more: (name, moments, torque, ω0, R0, t, R, ω).
CASES = [
    (
        "short-axis mode",
        (1, 2, 3),
        None,
        [0.25, -0.5, 1.0],
        [4, -2, 1, 2],
        100.0,
        [-0.56890136528237989, 0.049328916585751233, -0.64890548546109417, 0.50283154784363115],
        [0.55435823171026055, -0.072020489689206699, 1.0400020911941998],
    ),
    (
        "long-axis mode, unsorted moments",
        (2, 3, 1),
        None,
        [-0.25, 0.125, -1.5],
        [-1, 3, 2, 1],
        25.0,
        [-0.09388236650726868, 0.31094910238222551, 0.93957356723068741, 0.10815853525304396],
        [0.17317457253366569, -0.16267100482034505, -1.5107979902779134],
    ),
    (
        "needle",
        (1, 1000, 1000.5),
        None,
        [2.0, 0.5, 0.25],
        [4, -2, 1, 2],
        10.0,
        [0.34957585890685988, -0.59738037156060908, 0.66078109931484585, 0.29034763531309105],
        [2.0112137410777113, 0.40010443150843955, -0.39029034051595307],
    ),
    (
        "Lagrange's top",
        (1, 1, 0.5),
        ph.torque.heavy([0, 0, 2]),
        [0.25, -0.5, 6.0],
        [4, 2, 1, 0],
        5.0,
        [-0.83646752676582603, 0.31611845751857293, 0.37858553168163173, 0.2388811266795195],
        [-0.38756163688950951, 0.45121740293377838, 6.0],
    ),
    (
        "heavy asymmetric top",
        (1, 2, 2.5),
        ph.torque.heavy([0.5, 0.25, 1.0]),
        [0.5, 0.25, 3.0],
        [4, 1, -2, 1],
        10.0,
        [-0.57886584600346536, -0.4844782942282847, -0.23899203842235983, -0.61080104806972069],
        [0.061092866215364715, -1.0135764388903867, 2.7879526602814955],
    ),
    (
        "gravity gradient",
        (1, 2, 2.5),
        ph.torque.gravity_gradient(1.0),
        [0.0625, 0.03125, 1.125],
        [8, 1, 0.5, 1],
        10.0,
        [0.30365006998377836, 0.1213202822633259, -0.3194943671344459, 0.88938257992820691],
        [-0.21435819291044553, -0.63814606563180487, 0.4806956025045242],
    ),
    (
        "damping",
        (1, 2, 3),
        ph.torque.damping(0.125),
        [0.5, 1.0, 0.25],
        [4, -2, 1, 2],
        10.0,
        [-0.46506138998930496, 0.71292159296070612, -0.50655785425115729, -0.13733115497966294],
        [0.27182016725365488, 0.16946989394600029, -0.15138900324639526],
    ),
]


def growth(inertia, state, t, torque):
    """How much the motion magnifies a small change of its start: the size of its derivative, at least 1."""
    delta = 1e-9
    step = ph.simulate(inertia, state, [t], torque, method=STEPS, rtol=1e-5).certificate.step

    def end(rotor, omega):
        return ph.simulate(inertia, ph.State(rotor, omega), [t], torque, step=step)

    omega = state.omega_body.components
    same = end(state.rotor, omega)
    changes = []
    for axis in np.eye(3):
        faster = end(state.rotor, omega + delta * np.linalg.norm(omega) * axis)
        turned = end(state.rotor * ph.Rotor.from_rotation_vector(2 * delta * axis), omega)
        for other in (faster, turned):
            changes.append(apart(other, same.rotor.components, same.omega_body.components) / delta)
    return max(1.0, np.linalg.norm(changes))


def assert_reaches(inertia, state, t, torque, R, omega):
    """Truncation is bounded by the certificate's estimate, rounding by a random walk times the growth."""
    motion = ph.simulate(inertia, state, [t], torque, method=STEPS)
    # The last pass took at most two thirds of all steps.
    rounding = random_walk(motion.certificate.steps) * growth(inertia, state, t, torque)
    error = apart(motion, np.array([R]), np.array([omega]))
    assert error <= rounding + motion.certificate.error_estimate


@pytest.mark.parametrize("case", CASES, ids=[case[0] for case in CASES])
def test_reference_states(case):
    _, i, torque, omega0, rotor, t, R, omega = case
    state = ph.State(ph.Rotor.from_components(rotor), omega0)
    assert_reaches(moments(*i), state, t, torque, R, omega)
    if torque is None:
        exact = ph.simulate(moments(*i), state, [t])
        assert apart(exact, np.array([R]), np.array([omega])) <= 5e-15


def reference_cases():
    data = json.loads(REFERENCE.read_text())
    # STEPS is a splitting, which has no Larmor torque (b).
    steps_fit = [c for c in data["torqued"] if "b" not in c.get("params", {})]
    ours = [c for c in steps_fit if "omega0" in c and law_of(c) is not None]
    return [
        pytest.param(case, result, id=f"{case['name']}-{result['t']}")
        for case in data["free_top"] + ours
        for result in case["results"]
        if float(result["t"]) <= (40 if case["name"].startswith("near_sep") else 100)
    ]


@pytest.mark.parametrize(("case", "result"), reference_cases())
def test_the_reference_file(case, result):
    numbers = [[float(x) for x in case[key]] for key in ("inertia", "R0", "omega0")]
    inertia, state = moments(*numbers[0]), ph.State(ph.Rotor.from_components(numbers[1]), numbers[2])
    expected = ([float(x) for x in result[key]] for key in ("R", "omega"))
    assert_reaches(inertia, state, float(result["t"]), law_of(case), *expected)


def test_a_motion_that_amplifies_rounding_is_rejected_or_accurate():
    """Along a separatrix 1e-12 away, t = 100 magnifies by 1e11: an error, or an accurate result."""
    inertia = moments(1, 2, 2.25)
    state = ph.State(ph.Rotor.identity(), [0.375, 0.5, 0.5 + 2.0**-40])
    with pytest.raises(ValueError, match=r"rtol = 1\.0e-10 was not reached.*shorter time"):
        ph.simulate(inertia, state, [100.0], method=STEPS)
    loose = ph.simulate(inertia, state, [100.0], method=STEPS, rtol=1e-3)
    assert loose.certificate.error_estimate <= 1e-3
    exact = ph.simulate(inertia, state, [100.0])
    assert apart(loose, exact.rotor.components, exact.omega_body.components) <= 1e-3


@pytest.mark.parametrize("case", CASES[:3], ids=[case[0] for case in CASES[:3]])
def test_the_error_estimate_is_no_smaller_than_the_error(case):
    """It may be too large; where rounding dominates it must not be too small."""
    _, i, torque, omega0, rotor, t, R, omega = case
    state = ph.State(ph.Rotor.from_components(rotor), omega0)
    motion = ph.simulate(moments(*i), state, [t], torque, method=STEPS)
    error = apart(motion, np.array([R]), np.array([omega]))
    assert error <= 2 * motion.certificate.error_estimate + 4 * EPS


def test_the_error_estimate_of_a_symmetric_top():
    top = ph.SymmetricTop(moments(2, 2, 1), START.rotor, START.omega_body)
    motion = ph.simulate(moments(2, 2, 1), START, [100.0], method=STEPS)
    exact = top.at([100.0])
    error = apart(motion, exact.rotor.components, exact.omega_body.components)
    assert error <= 2 * motion.certificate.error_estimate + 4 * EPS


# --- orders


@pytest.mark.parametrize(
    ("name", "method"), [(n, m) for n in SLOPES for m in METHODS if order_of(m, n) is not None]
)
def test_every_method_has_its_order(name, method):
    """log(error) against log(step) has the slope of the order, over the last steps before rounding."""
    inertia, state, torque, t = SLOPES[name]
    exact = ph.simulate(inertia, state, [t], torque, method=STEPS, step=t / 512)
    steps, errors = [], []
    # The implicit equation of dmv has solutions for turns below 1 rad.
    for count in (32, 48, 64, 96, 128, 192, 256) if method == "dmv" else (8, 12, 16, 24, 32, 48, 64, 96, 128):
        motion = ph.simulate(inertia, state, [t], torque, method=method, step=t / count)
        assert motion.certificate.method == method
        error = apart(motion, exact.rotor.components, exact.omega_body.components)
        if error > 3e-12:
            steps.append(t / count)
            errors.append(error)
    slope = np.polyfit(np.log(steps[-4:]), np.log(errors[-4:]), 1)[0]
    # What is left of the next term, of either sign, bends the line a little.
    # Of dop853 the terms of the powers 8 and 9 are of one size until both are rounding.
    margin = 0.9 if method == "dop853" else 0.3
    assert abs(slope - order_of(method, name)) < margin, (slope, errors)


def test_a_method_that_does_not_fit_raises():
    with pytest.raises(ValueError, match=r"rkn6 .* damping; use kahan_li8"):
        ph.simulate(ASYMMETRIC, START, [1.0], ph.torque.damping(1), method="rkn6")
    with pytest.raises(ValueError, match=r"step of 4.* s.*use steps of at most"):
        ph.simulate(ASYMMETRIC, START, [8.0], method="dmv", step=4.0)


@pytest.mark.parametrize("method", SYMMETRIC)
@pytest.mark.parametrize("name", ["free", "heavy", "Lagrange"])
def test_a_run_backward_returns(name, method):
    """In steps of the same length, to the amplified rounding of both runs."""
    inertia, state, torque, t = SLOPES[name]
    there = ph.simulate(inertia, state, [t], torque, method=method, step=t / 64)
    end = ph.State(there.rotor[0], there.omega_body[0])
    back = ph.simulate(inertia, end, [-t], torque, method=method, step=t / 64)
    start = state.rotor.components[np.newaxis], state.omega_body.components[np.newaxis]
    assert apart(back, *start) <= 50 * random_walk(128, method)


def test_auto_is_exact_for_a_free_body_and_else_the_highest_order():
    assert ph.simulate(ASYMMETRIC, START, [1.0]).certificate.method == "exact"
    assert ph.simulate(ASYMMETRIC, START, [1.0], step=0.1).certificate.method == "kahan_li8"
    wound = ph.torque.constant_body([0, 0, 1.0])
    assert ph.simulate(ASYMMETRIC, START, [1.0], wound).certificate.method == "kahan_li8"
