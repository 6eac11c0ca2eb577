"""Reaction wheels: momentum and energy of body and wheels, limits, closed forms and SciPy."""

import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import polhode as ph
from motions import EPS, R0
from polhode._report.output import is_own

T = ph.torque
BODY = ph.Inertia.from_matrix([[10, 0.5, 0.2], [0.5, 12, -0.3], [0.2, -0.3, 8]])
AXES = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]) / np.sqrt([[1], [1], [1], [3]])
INERTIAS = np.array([0.02, 0.03, 0.02, 0.05])
SPEEDS = np.array([100, -50, 20, 200.0])
TIMES = np.array([0.0, 10, 25, 40])
ROWS = 0.1 * np.random.default_rng(0).standard_normal((4, 4))
SPIN = np.array([0.1, -0.2, 0.05])
START = ph.State(R0, SPIN)
WHEN = np.linspace(0, 60, 61)


def wheels(**options):
    given = {"times": TIMES, "speeds": SPEEDS, "omega_body": SPIN} | options
    return T.reaction_wheels(AXES, INERTIAS, given.pop("torques", ROWS), **given)


def test_the_momentum_of_body_and_wheels_is_constant():
    motion = ph.simulate(BODY, START, WHEN, wheels())
    L = motion.momentum_space.components
    # It is carried, and rounded only by the turn to the body and back: a few ulps of body and wheels.
    assert np.abs(L - L[0]).max() <= 20 * EPS * np.linalg.norm(L[0])
    assert motion.certificate.method == "dop853"
    assert motion.certificate.drift["angular_momentum"] <= 20 * EPS
    # Its parts: the inertia includes the wheels, which turn relative to it.
    own = BODY.matrix @ SPIN + (INERTIAS * SPEEDS) @ AXES
    np.testing.assert_allclose(
        L[0], R0(ph.bivector(own)).components, atol=1e-14 * np.linalg.norm(own), rtol=0
    )
    parts = BODY(motion.omega_body).components + (INERTIAS * motion.wheel_speed) @ AXES
    np.testing.assert_allclose(parts, motion.momentum_body.components, atol=1e-13, rtol=0)


def test_the_energy_is_the_work_of_the_motors():
    # Simpson's rule between the jumps, on which u is constant: ∫ Σ u Ω dt.
    steps = np.concatenate([np.linspace(a, b, 201) for a, b in zip(TIMES, [*TIMES[1:], 60], strict=True)])
    motion = ph.simulate(BODY, START, steps, wheels())
    power = np.einsum("...k,...k->...", motion.wheel_speed, np.repeat(ROWS, 201, axis=0))
    work = 0.0
    for part, span in zip(power.reshape(4, 201), np.diff([*TIMES, 60]), strict=True):
        weights = np.tile([2.0, 4.0], 100)
        weights[0] = 1
        work += span / 600 * (weights @ part[:-1] + part[-1])
    relative = motion.energy[-1] - motion.energy[0] - work
    # The power turns by some rad in an interval of 200: an error of (0.01)⁴/180 of it.
    assert abs(relative) <= 1e-9 * np.abs(power).max() * 60
    # The energy: of the body without the wheels' moments about their axes, and of the wheels.
    kinetic = 0.5 * SPIN @ (BODY.matrix - (AXES.T * INERTIAS) @ AXES) @ SPIN
    own = kinetic + 0.5 * np.sum(INERTIAS * (SPEEDS + AXES @ SPIN) ** 2)
    assert motion.energy[0] == pytest.approx(own, rel=1e-14)


def test_idle_wheels_are_a_gyrostat_of_the_lighter_body():
    # H is constant: a gyrostat of the body without J a aᵀ. Its speeds relative to the body change.
    motion = ph.simulate(BODY, START, WHEN, wheels(torques=0.0, times=None))
    carrier = ph.Inertia.from_matrix(BODY.matrix - (AXES.T * INERTIAS) @ AXES)
    h = (INERTIAS * (SPEEDS + AXES @ SPIN)) @ AXES
    same = ph.simulate(carrier, START, WHEN, T.gyrostat(h), rtol=1e-11)
    assert float(np.max((motion.rotor - same.rotor).norm())) <= 1e-9
    np.testing.assert_allclose(motion.omega_body.components, same.omega_body.components, atol=1e-9, rtol=0)
    assert motion.certificate.drift["energy"] <= 1e-10


def test_the_equations_of_wheels_with_states_of_their_own():
    # Schaub & Junkins: I ω' + Σ J Ω' a = −ω x (I ω + Σ J Ω a) + N and J (Ω' + a·ω') = u.
    size = np.eye(7)
    size[:3, :3], size[:3, 3:], size[3:, :3] = BODY.matrix, AXES.T * INERTIAS, AXES

    def slope(t, y, u):
        omega, speeds = y[4:7], y[7:]
        momentum = BODY.matrix @ omega + (INERTIAS * speeds) @ AXES
        pull = np.array([0.3, -0.1, 0.2]) - 0.4 * omega
        rates = np.linalg.solve(size, [*(np.cross(momentum, omega) + pull), *(u / INERTIAS)])
        # q' = ½ q ω, scalar last.
        turn = [*(y[3] * omega + np.cross(y[:3], omega)), -y[:3] @ omega]
        return np.concatenate([0.5 * np.array(turn), rates])

    y = np.concatenate([START.rotor.to_quaternion(order="xyzw"), SPIN, SPEEDS])
    for begin, end, u in zip(TIMES, [*TIMES[1:], 60], ROWS, strict=True):
        y = solve_ivp(slope, (begin, end), y, "DOP853", args=(u,), rtol=1e-12, atol=1e-12).y[:, -1]
    law = wheels() + T.constant_body([0.3, -0.1, 0.2]) + T.viscous_damping(0.4)
    motion = ph.simulate(BODY, START, [60.0], law)
    np.testing.assert_allclose(motion.omega_body.components[0], y[4:7], atol=1e-8, rtol=0)
    np.testing.assert_allclose(motion.wheel_speed[0], y[7:], rtol=1e-8)
    turn = motion.rotor[0] * ~ph.Rotor.from_quaternion(y[:4] / np.linalg.norm(y[:4]), order="xyzw")
    assert turn.magnitude() <= 1e-8


def test_limits_of_torque_and_speed():
    # Along an axis of the body all is linear in time: the command of 0.5 is cut to 0.2, and the wheel of the
    # momentum 0.1 * 30 reaches its speed after 10 s; then the reverse command acts at once.
    body = ph.Inertia.from_principal_moments(2, 3, 4)
    law = T.reaction_wheels(
        [[0, 0, 2]], 0.1, [[0.5], [-0.3]], times=[0, 20], speeds=10.0, max_torque=0.2, max_speed=30.0
    )
    rest = ph.State(ph.Rotor.identity(), [0, 0, 0])
    when = np.array([0, 5, 10, 12, 20, 25.0])
    motion = ph.simulate(body, rest, when, law)
    H = np.array([1, 2, 3, 3, 3, 2])
    np.testing.assert_allclose(motion.wheel_momentum[:, 0], H, rtol=0, atol=4 * EPS)
    omega = -(H - 1) / 3.9
    np.testing.assert_allclose(motion.omega_body.components[:, 2], omega, rtol=0, atol=40 * EPS)
    np.testing.assert_allclose(motion.wheel_speed[:, 0], H / 0.1 - omega, rtol=20 * EPS)
    # The angle, by the areas under the rate.
    angle = -np.array([0, 2.5, 10, 14, 30, 37.5]) / 3.9
    expected = ph.Rotor.from_rotation_vector(np.stack([0 * angle, 0 * angle, angle], axis=1))
    assert float(np.max((motion.rotor - expected).norm())) <= 100 * EPS


@pytest.mark.parametrize(
    ("method", "order", "longest"), [("rk4", 4, 1.0), ("midpoint", 2, 0.1), ("dop853", 8, 1.0)]
)
def test_methods_keep_their_order(method, order, longest):
    exact = ph.simulate(BODY, START, [30.0], wheels(), rtol=1e-12).final
    errors = []
    for step in (longest, longest / 2):
        found = ph.simulate(BODY, START, [30.0], wheels(), method=method, step=step).final
        errors.append(float((found.omega_body - exact.omega_body).norm()))
    assert np.log2(errors[0] / errors[1]) > order - 0.6


def test_a_motion_continues_with_its_wheels():
    law = wheels(max_speed=260)
    whole = ph.simulate(BODY, START, [17.0, 45.0], law)
    rest = ph.simulate(BODY, whole.at(17.0), [45.0], law)
    assert float((rest.omega_body[0] - whole.omega_body[1]).norm()) <= 1e-9
    np.testing.assert_allclose(rest.wheel_speed[0], whole.wheel_speed[1], rtol=1e-9)


@pytest.mark.parametrize("eccentricity", [0.0, 0.3])
def test_the_gradient_acts_on_the_wheels_too(eccentricity):
    # Idle wheels with H = 0 turn freely about their axes, and belong to the mass on which the field acts.
    # A wheel along the only axis of rotation: I* ω' = 3n² (a/r)³ (i1 − i2) u1 u2 with all of I, and for the
    # true anomaly Kepler's second law, f' = n √(1 − e²) (a/r)².
    rate, body = 0.5, ph.Inertia.from_principal_moments(2, 3, 4)
    axes, J = [[0, 0, 1], [1, 0, 0]], [1.0, 0.8]
    law = T.reaction_wheels(axes, J) + T.gravity_gradient(rate, eccentricity)
    state = ph.State(ph.Rotor.from_rotation_vector([0, 0, 0.3]), [0, 0, 0])
    motion = ph.simulate(body, state, np.linspace(0, 5, 11), law)

    def slope(t, y):
        u = np.array([np.cos(y[2] - y[0]), np.sin(y[2] - y[0])])
        near = (1 + eccentricity * np.cos(y[2])) / (1 - eccentricity**2)
        push = 3 * rate**2 * near**3 * (3 - 2) * u[0] * u[1] / (4 - 1.0)
        return [y[1], push, rate * np.sqrt(1 - eccentricity**2) * near**2]

    y = solve_ivp(slope, (0, 5), [0.3, 0.0, 0.0], "DOP853", rtol=1e-12, atol=1e-12, t_eval=motion.time).y
    np.testing.assert_allclose(motion.omega_body.components[:, 2], y[1], atol=1e-9, rtol=0)


def test_laws_of_wheels_add_up():
    both = T.reaction_wheels(AXES[:2], INERTIAS[:2], ROWS[:, :2], times=TIMES) + T.reaction_wheels(
        AXES[2:], INERTIAS[2:], ROWS[:, 2:], times=TIMES
    )
    apart = ph.simulate(BODY, START, WHEN, both)
    one = ph.simulate(BODY, START, WHEN, T.reaction_wheels(AXES, INERTIAS, ROWS, times=TIMES))
    assert float(np.max((apart.omega_body - one.omega_body).norm())) <= 1e-9
    np.testing.assert_allclose(apart.wheel_speed, one.wheel_speed, atol=1e-7)


def test_batches_and_copies_of_motions_keep_their_wheels():
    spins = np.stack([SPIN, -SPIN, 2 * SPIN])
    many = ph.simulate(BODY, ph.State(R0, spins), WHEN[:5], wheels())
    assert many.wheel_speed.shape == (3, 5, 4)
    for k, spin in enumerate(spins):
        one = ph.simulate(BODY, ph.State(R0, spin), WHEN[:5], wheels())
        np.testing.assert_array_equal(many[k].wheel_speed, one.wheel_speed)
        np.testing.assert_array_equal(many.momentum_space[k].components, one.momentum_space.components)
    again = pickle.loads(pickle.dumps(one))
    np.testing.assert_array_equal(again.wheel_speed, one.wheel_speed)
    assert ph.simulate(BODY, START, [1.0]).wheel_speed.shape == (1, 0)


@pytest.mark.parametrize("method", ["rk4", "dop853"])
def test_a_stepper_commands_the_motors(method):
    # Commands at each step are rows of a table.
    rows = 0.2 * np.random.default_rng(4).standard_normal((8, 4))
    law = T.reaction_wheels(AXES, INERTIAS, speeds=SPEEDS, max_torque=0.3)
    table = T.reaction_wheels(AXES, INERTIAS, rows, times=0.25 * np.arange(8), speeds=SPEEDS, max_torque=0.3)
    stepper = ph.Stepper(BODY, START, law, method=method)
    motion = ph.simulate(BODY, START, 0.25 * np.arange(1, 9), table, method=method, step=0.25)
    for k, row in enumerate(rows):
        state = stepper.step(0.25, wheel_torque=row)
        assert float((state.omega_body - motion.omega_body[k]).norm()) <= 100 * EPS
        np.testing.assert_allclose(stepper.wheel_speed, motion.wheel_speed[k], rtol=1e-13)
    stepper.reset(START)
    np.testing.assert_allclose(stepper.wheel_speed, SPEEDS - AXES @ SPIN, rtol=1e-14)
    many = ph.Stepper(BODY, ph.State(R0, np.stack([SPIN, SPIN])), law, method=method)
    many.step(0.25, wheel_torque=rows[:2])
    assert many.wheel_speed.shape == (2, 4)
    np.testing.assert_allclose(many.wheel_speed[0], motion.wheel_speed[0], rtol=1e-13)


def test_wheels_bring_a_body_to_rest():
    # A controller in the loop: all momentum goes to the wheels.
    stepper = ph.Stepper(BODY, START, T.reaction_wheels(np.eye(3), 0.05, omega_body=SPIN, max_torque=1.0))
    for _ in range(400):
        stepper.step(0.25, wheel_torque=2.0 * stepper.state.omega_body.components)
    assert float(stepper.state.omega_body.norm()) < 1e-6
    stored = 0.05 * stepper.wheel_speed
    L = (~stepper.state.rotor)(R0(BODY(START.omega_body))).components
    # rk4 with steps of 0.25 s conserves it to some 1e-7.
    np.testing.assert_allclose(stored, L, atol=1e-5, rtol=0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: T.reaction_wheels([1, 0, 0], 0.1), r"axes needs a vector for each wheel.*\(3,\)"),
        (lambda: T.reaction_wheels([[1, 0, 0], [0, 0, 0]], 0.1), r"axes\[1\] is zero"),
        (lambda: T.reaction_wheels(np.eye(3), [1, 2]), r"inertias must be a number or of shape \(3,\)"),
        (lambda: T.reaction_wheels(np.eye(3), -1), "inertias is -1.0; it must be positive"),
        (lambda: T.reaction_wheels(np.eye(3), 1, [[1, 2, 3]]), r"torques.*\(3,\) without times"),
        (lambda: T.reaction_wheels(np.eye(3), 1, [1, 2], times=[0, 1]), r"torques must be of shape \(2, 3\)"),
        (
            lambda: T.reaction_wheels(np.eye(3), 1, np.zeros((2, 3)), times=[1, 0]),
            r"times\[1\] = 0 is not after",
        ),
        (lambda: T.reaction_wheels(np.eye(3), 1, np.nan), "row of torques is"),
        (lambda: T.reaction_wheels(np.eye(3), 1, speeds=9, max_speed=5), "wheel 0 starts at 9 rad/s"),
        (lambda: T.reaction_wheels(np.eye(3), 1, max_torque=0), "max_torque is 0.0; it must be positive"),
        (
            lambda: T.reaction_wheels(np.eye(3), 1, max_speed=[5, -1, 5]),
            r"max_speed\[1\] is -1.0; it must be positive",
        ),
    ],
)
def test_invalid_wheels_raise(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (T.reaction_wheels(np.eye(3), 20.0), "larger moments about their axes than the body"),
        (wheels() + T.damping(0.1), "cannot be combined with damping"),
        (wheels() + T.larmor([0, 0, 1]), "cannot be combined with damping, larmor"),
        (wheels() + T.formula("-0.1 L_B"), "formulas of L"),
    ],
)
def test_laws_that_do_not_fit_raise(law, message):
    with pytest.raises(ValueError, match=message):
        ph.simulate(BODY, START, [1.0], law)
    with pytest.raises(ValueError, match=message):
        ph.Stepper(BODY, START, law)


def test_splittings_and_steppers_without_wheels_refuse():
    with pytest.raises(ValueError, match="does not support torques that depend on the angular velocity"):
        ph.simulate(BODY, START, [1.0], wheels(), method="kahan_li8")
    with pytest.raises(ValueError, match="no wheels to command"):
        ph.Stepper(BODY, START).step(0.1, wheel_torque=[1.0])
    with pytest.raises(ValueError, match=r"wheel_torque must be of shape \(4,\)"):
        ph.Stepper(BODY, START, wheels()).step(0.1, wheel_torque=[1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match="formulas of L"):
        ph.simulate(BODY, START, [1.0], wheels(), events=ph.event.formula("norm(L) - 1"))


def test_laws_are_values():
    assert wheels() == wheels() != wheels(speeds=0.0)
    assert pickle.loads(pickle.dumps(wheels())) == wheels()
    assert repr(wheels()) == "reaction_wheels(4 wheels, 4 rows of torques)"


def test_tables_have_the_speeds(tmp_path):
    pytest.importorskip("pandas")
    xr = pytest.importorskip("xarray")
    motion = ph.simulate(BODY, START, WHEN[:5], wheels())
    frame = motion.to_dataframe()
    names = [f"wheel_speed_{k}" for k in range(4)]
    np.testing.assert_array_equal(frame[names].to_numpy(), motion.wheel_speed)
    assert frame.attrs["units"]["wheel_speed_3"] == "rad/s"
    motion.save(tmp_path / "motion.csv")
    saved = np.genfromtxt(tmp_path / "motion.csv", delimiter=",", names=True)
    np.testing.assert_array_equal(saved["wheel_speed_2"], motion.wheel_speed[:, 2])
    motion.save(tmp_path / "motion.nc")
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf") as dataset:
        assert dataset["wheel_speed"].dims == ("time", "wheel")
        np.testing.assert_array_equal(dataset["wheel_speed"], motion.wheel_speed)
    assert is_own(tmp_path / "motion.csv")
    many = ph.simulate(BODY, ph.State(R0, np.stack([SPIN, -SPIN])), WHEN[:5], wheels())
    np.testing.assert_array_equal(many.to_xarray()["wheel_speed"], many.wheel_speed)
    np.testing.assert_array_equal(many.to_dataframe()[names].to_numpy(), many.wheel_speed.reshape(-1, 4))
