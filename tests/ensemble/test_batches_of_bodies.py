"""Ensembles: bodies as alone, failures, and results independent of blocks and threads."""

import pickle
import re
import signal
import sys
import time

import numpy as np
import pytest

import polhode as ph
import processes
from motions import ASYMMETRIC, EPS, R0, START, moments

T = np.linspace(-1.0, 3.0, 9)
RNG = np.random.default_rng(11)
N = 5
STATES = ph.State(ph.Rotor.random(N, rng=RNG), RNG.normal(size=(N, 3)))
BODIES = [moments(1, 1 + k / 5, 1.5 + k / 8) for k in range(N)]
C = RNG.normal(size=(N, 3))
PARTS = ("rotor", "omega_body", "momentum_space", "position", "velocity")


def state_of(k, states=STATES):
    def one(value):
        return value[k] if value.shape else value

    return ph.State(one(states.rotor), one(states.omega_body), one(states.position), one(states.velocity))


def assert_same(a, b, atol=0.0):
    for part in PARTS:
        x, y = getattr(a, part).components, getattr(b, part).components
        np.testing.assert_allclose(x, y, rtol=0, atol=atol, err_msg=part)
    np.testing.assert_allclose(a.energy, b.energy, rtol=0, atol=atol)
    assert np.array_equal(a.time, b.time)


@pytest.mark.parametrize(
    "how",
    [
        {"method": "rk4", "step": 1 / 64},
        {"method": "kahan_li8", "step": 1 / 16},
        {"method": "dop853"},
        {"method": "rkn6", "rtol": 1e-8},
        {},
    ],
    ids=lambda how: how.get("method", "auto"),
)
def test_batch_members_equal_single_runs(how):
    motion = ph.simulate(BODIES, STATES, T, ph.torque.heavy(C), **how)
    assert motion.shape == motion.ok.shape == (N,)
    assert motion.rotor.shape == motion.energy.shape == (N, len(T))
    assert motion.failures == ()
    for k in range(N):
        alone = ph.simulate(BODIES[k], state_of(k), T, ph.torque.heavy(C[k]), **how)
        proof, own = motion[k].certificate, alone.certificate
        if "step" in how:
            assert (proof.method, proof.steps, proof.evaluations) == (own.method, own.steps, own.evaluations)
            assert proof.step == own.step
            # Side by side the same steps are rounded in another order.
            apart = 64 * 4 * EPS * 10
        else:
            # In lanes by dop853, alone by the method of `auto`; each within its estimate.
            assert proof.method == how.get("method", "dop853")
            apart = proof.error_estimate + own.error_estimate
        assert_same(motion[k], alone, apart * largest(alone))
        assert proof.conserved.keys() == own.conserved.keys()
        assert motion.inertia[k] == alone.inertia


def largest(motion):
    """The largest magnitude in a motion, at least 1."""
    sizes = [np.abs(getattr(motion, part).components).max() for part in PARTS[1:]]
    return max(1.0, np.abs(motion.energy).max(), *sizes)


def test_closed_forms_are_found_body_by_body():
    spheres = [moments(2, 2, 2), ASYMMETRIC, moments(2, 2, 2)]
    law = ph.torque.larmor([0.1, 0.2, 0.3])
    motion = ph.simulate(spheres, START, T, law, rtol=1e-8)
    assert motion.certificate.method.tolist()[::2] == ["exact", "exact"]
    assert motion.certificate.method[1] != "exact"
    assert motion[1].certificate.method == motion.certificate.method[1]
    assert "2 methods" in repr(motion)
    free = ph.simulate(spheres, START, T, method="exact")
    assert free.certificate.method == "exact"
    assert_same(free[1], ph.simulate(ASYMMETRIC, START, T), 16 * EPS)
    with pytest.raises(ValueError, match=r"index \(1,\).*closed form"):
        ph.simulate(spheres, START, T, law, method="exact")


@pytest.mark.parametrize("count", [1, 3, 60])
@pytest.mark.parametrize("law", [ph.torque.heavy([0, 0, 1.5]), ph.torque.damping(0.125)])
def test_many_closed_forms_have_the_bits_of_each_alone(law, count):
    """Among them are a steady, an asymmetric and a slow body, and the last lanes are not full."""
    bodies = [moments(1, 1, x) for x in np.linspace(0.5, 1.75, 70)]
    bodies[40] = ASYMMETRIC
    rates = RNG.normal(size=(70, 3))
    rates[[3, 20, 33]] = [0, 0, 0], [0, 0, 2], [1e-9, 0, 1]
    rotors, times = ph.Rotor.random(70, rng=RNG), np.linspace(0.25, 5, count)
    together = ph.simulate(bodies, ph.State(rotors, rates), times, law)
    for k in set(range(70)) - {40}:
        alone = ph.simulate(bodies[k], ph.State(rotors[k], rates[k]), times, law)
        assert alone.certificate.method == "exact"
        for part in PARTS:
            assert np.array_equal(getattr(together[k], part).components, getattr(alone, part).components)


def test_all_shapes_broadcast():
    rotors, rates = ph.Rotor.random((3, 1), rng=RNG), RNG.normal(size=(4, 3))
    places = ph.vector(RNG.normal(size=(2, 1, 1, 3)))
    table = np.array([[BODIES[0]], [BODIES[1]], [BODIES[2]]], dtype=object)
    motion = ph.simulate(table, ph.State(rotors, rates, places), T, ph.torque.heavy(C[:4]))
    assert motion.shape == (2, 3, 4)
    assert len(motion) == 2
    assert motion.inertia.shape == (2, 3, 4)
    for index in ((0, 0, 0), (1, 2, 3), (0, 1, 2)):
        i, j, k = index
        state = ph.State(rotors[j, 0], rates[k], places[i, 0, 0])
        alone = ph.simulate(BODIES[j], state, T, ph.torque.heavy(C[k]))
        # Each meets the tolerance 1e-10.
        assert_same(motion[index], alone, 2e-10 * largest(alone))
    one = ph.simulate([ASYMMETRIC], START, T)
    assert one.shape == (1,)
    assert_same(one[0], ph.simulate(ASYMMETRIC, START, T), 16 * EPS)
    assert ph.simulate(ASYMMETRIC, START, T).shape == ()
    assert ph.simulate(ASYMMETRIC, START, T, ph.torque.damping([0.1])).shape == (1,)
    nothing = ph.simulate(ASYMMETRIC, ph.State(R0, np.zeros((0, 3))), T)
    assert nothing.rotor.shape == nothing.position.shape == (0, len(T))
    assert nothing.failures == ()
    never = ph.simulate(BODIES, STATES, [])
    assert never.rotor.shape == never.energy.shape == never.position.shape == (N, 0)
    assert never.certificate.steps.shape == (N,)


LAWS = {
    "heavy": lambda x: ph.torque.heavy(ph.vector(x)),
    "gravity_gradient": lambda x: ph.torque.gravity_gradient(0.5 + x[..., 0] ** 2, 0.2, x[..., 1]),
    "magnetic": lambda x: ph.torque.magnetic(x, [0.1, 0.2, 0.3]),
    "larmor": lambda x: ph.torque.larmor(x),
    "damping": lambda x: ph.torque.damping(x[..., 0] ** 2 / 8),
    "viscous_damping": lambda x: ph.torque.viscous_damping(x**2),
    "quadratic_damping": lambda x: ph.torque.quadratic_damping(x[..., 0] ** 2),
    "torsion_spring": lambda x: ph.torque.torsion_spring(1.5, ph.Rotor.from_components(x @ np.eye(3, 4))),
    "pd_control": lambda x: ph.torque.pd_control(
        x[..., :1] ** 2 if x.ndim > 1 else x[0] ** 2, [0.1, 0.2, 0.3], R0
    ),
    "gyrostat": lambda x: ph.torque.gyrostat(ph.bivector(x)),
    "constant_body": lambda x: ph.torque.constant_body(x),
    "constant_space": lambda x: ph.torque.constant_space(x),
    "formula": lambda x: ph.torque.formula("k c ∧ (~R e3 R)", c=ph.vector(x), k=ph.scalar(x[..., 0])),
    "formula of rotors": lambda x: ph.torque.formula(
        "P (e1∧e2) ~P", frame="space", P=ph.Rotor.from_components(x @ np.eye(3, 4))
    ),
}


@pytest.mark.parametrize("name", LAWS)
def test_laws_take_batches(name):
    law = LAWS[name](C)
    assert law.shape == (N,)
    assert law == LAWS[name](C)
    assert law != LAWS[name](C + 1)
    assert hash(law) == hash(LAWS[name](C))
    again = pickle.loads(pickle.dumps(law))
    assert again == law
    assert again.shape == (N,)
    assert "(5,)" in repr(law)
    assert len(repr(law)) < 100
    motion = ph.simulate(ASYMMETRIC, START, T[:6], law, rtol=1e-6)
    assert motion.ok.all()
    for k in range(N):
        alone = ph.simulate(ASYMMETRIC, START, T[:6], LAWS[name](C[k]), rtol=1e-6)
        assert_same(motion[k], alone, 2e-6 * largest(alone))
    with pytest.raises(ValueError, match=r"single.*\(5,\)"):
        law.at(ASYMMETRIC, START)


def test_laws_of_batches_are_checked():
    with pytest.raises(ValueError, match=r"index \(2,\).*nan"):
        ph.torque.heavy([[0, 0, 1], [0, 0, 1], [0, np.nan, 1]])
    with pytest.raises(ValueError, match=r"index \(1,\).*-1.*negative"):
        ph.torque.quadratic_damping([1, -1])
    with pytest.raises(ValueError, match=r"\(2,\).*\(3,\)"):
        ph.torque.magnetic(np.ones((2, 3)), np.ones((3, 3)))
    with pytest.raises(ValueError, match=r"index \(1,\)"):
        ph.torque.gravity_gradient(1.0, [0.1, 2.0])
    with pytest.raises(ValueError, match=r"`a`.*`b`|\(2,\).*\(3,\)"):
        ph.torque.formula("a∧b", a=ph.vector(np.eye(3)[:2]), b=ph.vector(np.eye(3)))
    with pytest.raises(TypeError, match=r"ph\.scalar"):
        ph.torque.formula("k Ω", k=[1.0, 2.0])
    with pytest.raises(ValueError, match=r"\(4,\) of the angular velocity.*\(5,\) of the torque"):
        ph.simulate(ASYMMETRIC, ph.State(R0, np.ones((4, 3))), T, ph.torque.heavy(C))
    with pytest.raises(TypeError, match=r"index \(1,\).*int"):
        ph.simulate([ASYMMETRIC, 3], START, T)
    with pytest.raises(ValueError, match=r"index \(1,\).*thickness"):
        ph.simulate([ASYMMETRIC, ph.Body.rod(1.0, mass=1.0)], START, T)
    with pytest.raises(ValueError, match=r"batch shape \(5,\)"):
        ph.simulate(BODIES, STATES, T, events=ph.event.spin(ph.e1 ^ ph.e2))
    for threads, error in ((0, ValueError), (1.5, TypeError)):
        with pytest.raises(error, match="threads"):
            ph.simulate(BODIES, STATES, T, threads=threads)
    with pytest.raises(ValueError, match=r"times\[1\]"):
        ph.simulate(BODIES, STATES, [1.0, 0.0])


def test_tables_and_functions_are_shared():
    table = ph.torque.tabulated([-2, 0, 4], [[0, 0, 1], [1, 0, 0], [0, 2, 0]])
    function = ph.torque.function(lambda t, R, omega: [t, 0, 0.5])
    for law in (table, function):
        motion = ph.simulate(BODIES, STATES, T, law, rtol=1e-8, threads=2)
        for k in (0, 4):
            alone = ph.simulate(BODIES[k], state_of(k), T, law, rtol=1e-8)
            assert_same(motion[k], alone, 2e-8 * largest(alone))


def test_the_centre_of_mass_moves():
    bodies = [ph.Body(1.0 + k, BODIES[k], [0.1 * k, 0, 0]) for k in range(N)]
    states = ph.State(STATES.rotor, STATES.omega_body, RNG.normal(size=(N, 3)), [1.0, 2.0, 3.0])
    drifting = ph.simulate(bodies, states, T)
    place, rate = states.position.components[:, np.newaxis], np.array([1.0, 2.0, 3.0])
    assert np.array_equal(drifting.position.components, place + rate * T[:, np.newaxis])
    assert drifting.velocity.shape == (N, len(T))
    resting = ph.simulate(bodies, STATES, T)
    assert not {"position", "velocity"} & vars(resting).keys()  # they take no memory
    assert resting.position.shape == resting.velocity.shape == (N, len(T))
    assert not resting.position.components.any()
    with pytest.raises(AttributeError, match="places"):
        _ = resting.places
    for force in ([0, 0, -9.81], ph.force.drag(0.5) + ph.force.thrust([1, 0, 0], at=[0, 1, 0])):
        motion = ph.simulate(bodies, states, T, force=force, rtol=1e-8)
        for k in (0, 3):
            alone = ph.simulate(bodies[k], state_of(k, states), T, force=force, rtol=1e-8)
            assert_same(motion[k], alone, 64 * EPS)


# --- failures


@pytest.mark.parametrize("how", [{"method": "rk4", "step": 1 / 32}, {"method": "dop853", "rtol": 1e-8}])
def test_a_failure_does_not_stop_the_others(how):
    t = np.linspace(0, 4, 9)
    pole = ph.scalar([1e3, 2.0, 1e4])
    law = ph.torque.formula("(e1∧e2)/(t - p)", p=pole)
    motion = ph.simulate(ASYMMETRIC, START, t, law, **how)
    (failure,) = motion.failures
    assert failure.index == (1,)
    assert 1.9 <= failure.time <= 2.0
    assert re.search(r"at t = (1\.9|2)", failure.message)
    assert motion.ok.tolist() == [True, False, True]
    assert np.isnan(motion.rotor.components[1, -1]).all()
    assert np.isnan(motion.energy[1, -1])
    assert not np.isnan(motion.rotor.components[::2]).any()
    for k, p in ((0, 1e3), (2, 1e4)):
        alone = ph.simulate(ASYMMETRIC, START, t, ph.torque.formula("(e1∧e2)/(t - p)", p=p), **how)
        assert_same(motion[k], alone, 256 * EPS)
    assert "1 failed" in repr(motion)
    assert "(1,)" in repr(motion)
    assert motion.certificate.worst == max(motion[0].certificate.worst, motion[2].certificate.worst)
    assert np.isnan(motion.certificate.norm_drift[1])
    assert np.isnan(motion[1].certificate.worst)
    assert [f.index for f in motion[1:].failures] == [(0,)]
    assert motion[1].failures[0].index == ()
    assert motion[::2].failures == ()
    assert [f.index for f in motion[motion.ok == False].failures] == [(0,)]  # noqa: E712


def test_failures_have_the_index_of_their_body():
    law = ph.torque.constant_body(np.array([[0.1, 0.1, 1e308], [1e308, 0.1, 0.1]])[..., None] * [1, 1, 0])
    motion = ph.simulate(ASYMMETRIC, START, [0.0, 1.0], law, method="rk4", step=0.1)
    assert [failure.index for failure in motion.failures] == [(0, 2), (1, 0)]
    assert [failure.index for failure in motion[1].failures] == [(0,)]


def test_overflow_is_a_failure():
    law = ph.torque.constant_body([[1e308, 1e308, 0], [0.1, 0, 0]])
    motion = ph.simulate(ASYMMETRIC, START, [0.0, 1.0], law, method="rk4", step=0.1)
    assert motion.ok.tolist() == [False, True]
    assert np.isfinite(motion.certificate.worst)
    every = ph.simulate(ASYMMETRIC, START, [0.0, 1.0], ph.torque.constant_body([[1e308] * 3]))
    assert not every.ok.any()
    assert np.isnan(every.certificate.worst)
    assert every.certificate.method == "dop853"


def test_exceptions_of_functions_propagate():
    def torque(t, rotor, omega):
        if omega.components[2] > 0.9:
            raise RuntimeError("too fast")
        return [0, 0, 0.1]

    rates = [[0, 0, 0.1], [0, 0, 0.85]]
    motion = ph.simulate(moments(1, 1, 1), ph.State(R0, rates), [0, 1], torque, method="rk4", step=0.1)
    assert motion.ok.tolist() == [True, False]
    assert "too fast" in motion.failures[0].message

    def stop(t, rotor, omega):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ph.simulate(moments(1, 1, 1), ph.State(R0, rates), [0, 1], stop, step=0.1)


# --- bits, memory, blocks


@pytest.mark.parametrize(
    "how", [{"method": "rk4", "step": 1 / 16}, {"method": "kahan_li8", "step": 0.25}, {}]
)
def test_results_are_independent_of_threads_and_blocks(how, monkeypatch):
    n = 41
    rng = np.random.default_rng(2)
    states = ph.State(ph.Rotor.random((n, 1), rng=rng), rng.normal(size=(n, 2, 3)))
    law = ph.torque.heavy(rng.normal(size=(n, 1, 3)))
    law += ph.torque.formula(
        "k (e1∧e2) - q R e1∧e3 ~R", k=ph.scalar([0.1, 0.2]), q=ph.scalar(rng.normal(size=(n, 1)))
    )
    bodies = np.array([[BODIES[k % N]] for k in range(n)], dtype=object)
    whole = ph.simulate(bodies, states, T, law, rtol=None if how else 1e-6, **how)
    how = {"rtol": None if how else 1e-6, **how}
    for threads in (1, 3):
        assert_same(ph.simulate(bodies, states, T, law, threads=threads, **how), whole)
    monkeypatch.setenv("POLHODE_NUM_THREADS", "nonsense")
    with pytest.raises(ValueError, match="nonsense"):
        ph.simulate(bodies, states, T, law, **how)
    monkeypatch.delenv("POLHODE_NUM_THREADS")
    seen = []
    for rows, motion in ph.simulate_blocks(bodies, states, T, law, block=17, **how):
        seen.append(rows)
        assert_same(motion, whole[rows])
        assert np.array_equal(motion.certificate.steps, whole.certificate.steps[rows])
        assert np.array_equal(motion.inertia, whole.inertia[rows])
    assert seen == [slice(0, 17), slice(17, 34), slice(34, 41)]
    ((rows, motion),) = ph.simulate_blocks(bodies, states, T, law, **how)
    assert rows == slice(0, 41)
    assert_same(motion, whole)


def test_simulate_blocks_validates_arguments_immediately():
    with pytest.raises(ValueError, match="simulate"):
        ph.simulate_blocks(ASYMMETRIC, START, T)
    with pytest.raises(ValueError, match="block must be at least 1, got 0"):
        ph.simulate_blocks(BODIES, STATES, T, block=0)
    with pytest.raises(ValueError, match="method"):
        ph.simulate_blocks(BODIES, STATES, T, method="euler")


def test_results_that_exceed_memory_are_rejected(monkeypatch):
    monkeypatch.setattr("polhode._support.memory.available", lambda: 3_000_000_000)
    states = ph.State(R0, np.broadcast_to([0, 0, 1.0], (1_000_000, 3)))
    times = np.linspace(0, 1, 1000)
    with pytest.raises(MemoryError) as error:
        ph.simulate(ASYMMETRIC, states, times)
    # 88 bytes for each body and time, and 800 for each body.
    for part in (
        "1000000 bodies at 1000 times",
        "88.8 GB",
        "3 GB are free",
        "simulate_blocks",
        "fewer times",
    ):
        assert part in str(error.value)
    rows, motion = next(ph.simulate_blocks(ASYMMETRIC, states, times[:10]))
    assert motion.shape == (rows.stop,)
    assert 1000 < rows.stop < 1_000_000


# --- as a value


def test_trajectory_indexing_pickling_and_errors():
    motion = ph.simulate(np.array([BODIES[:2], BODIES[2:4]], dtype=object), START, T, ph.torque.heavy(C[0]))
    assert motion[0].shape == (2,)
    assert motion[..., 1].shape == (2,)
    assert_same(motion[..., 1][0], motion[0, 1])
    assert_same(motion[[1, 0], [0, 1]][0], motion[1, 0])
    assert [row.shape for row in motion] == [(2,), (2,)]
    assert motion[0, 1].inertia == BODIES[1]
    with pytest.raises(IndexError, match=r"\(2, 2\)"):
        _ = motion[2]
    with pytest.raises(IndexError):
        _ = motion[0, 0, 0]
    with pytest.raises(TypeError, match="length"):
        len(motion[0, 0])
    again = pickle.loads(pickle.dumps(motion))
    assert_same(again, motion)
    assert again.inertia[1, 1] == BODIES[3]
    assert np.array_equal(again.certificate.drift["energy"], motion.certificate.drift["energy"])
    for call in (motion.drifts, motion.plot, lambda: motion.at(0.5)):
        with pytest.raises(ValueError, match=r"\(2, 2\)"):
            call()


def test_a_batch_to_xarray(tmp_path):
    xr = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    table = np.array([BODIES[:2], BODIES[2:4]], dtype=object)
    law = ph.torque.formula("(e1∧e2)/(t - p)", p=ph.scalar([1e3, 2.0]))
    motion = ph.simulate(table, START, T, law, method="rk4", step=1 / 32)
    path = tmp_path / "motions.nc"
    motion.save(path)
    with xr.open_dataset(path, engine="h5netcdf") as data:
        assert dict(data.sizes)["body"] == 4
        assert data.attrs["batch_shape"].tolist() == [2, 2]
        omega = data["omega_body"].transpose("body", "time", "axis").values.reshape(2, 2, len(T), 3)
        np.testing.assert_array_equal(omega, motion.omega_body.components)
        np.testing.assert_array_equal(data["inertia"].values[3], BODIES[3].matrix)
        assert np.isfinite(data["failure_time"].values).tolist() == [False, True, False, True]
        assert "value" in str(data["failure"].values[1]) or "NaN" in str(data["failure"].values[1])
        np.testing.assert_array_equal(data["steps"].values, motion.certificate.steps.ravel())


# --- long runs


def test_progress_increases_and_its_exceptions_propagate():
    seen = []
    states = ph.State(R0, RNG.normal(size=(64, 3)))
    law = ph.torque.constant_body([0.1, 0, 0])
    ph.simulate(
        ASYMMETRIC, states, [40.0], law, method="rk4", step=1e-4, progress=lambda *at: seen.append(at)
    )
    assert len(seen) >= 2
    assert {number for number, _ in seen} == {1}
    assert [fraction for _, fraction in seen] == sorted(fraction for _, fraction in seen)
    assert seen[-1][1] <= 1

    # Blocks report the fraction of the whole.
    seen.clear()
    how = {"method": "rk4", "step": 1e-4, "block": 32, "threads": 1}
    for _ in ph.simulate_blocks(ASYMMETRIC, states, [20.0], law, progress=lambda *at: seen.append(at), **how):
        assert {number for number, _ in seen} <= {1}
    assert [fraction for _, fraction in seen] == sorted(fraction for _, fraction in seen)
    assert 0.5 < seen[-1][1] <= 1

    class EnoughError(Exception):
        pass

    def report(number, fraction):
        raise EnoughError

    for how in ({"method": "rk4"}, {"method": "kahan_li8"}):
        with pytest.raises(EnoughError):
            ph.simulate(ASYMMETRIC, states, [1e6], step=1e-3, progress=report, **how)


@pytest.mark.parametrize("method", ["rk4", "kahan_li8"])
def test_ctrl_c_stops_a_run(method):
    program = (
        "import numpy as np, polhode as ph; print('go', flush=True)\n"
        "ph.simulate(ph.Inertia.from_principal_moments(1, 2, 3), ph.State(ph.Rotor.identity(),"
        f"np.ones((40, 3))), [1e6], method={method!r}, step=1e-3)"
    )
    with processes.start([sys.executable, "-c", program]) as process:
        assert process.stdout.readline() == "go\n"
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
    assert "KeyboardInterrupt" in errors
    assert process.returncode != 0


def test_a_table_may_start_at_the_start():
    """And have knots at output times, which may be repeated."""
    law = ph.torque.tabulated([-1, 0, 1, 3], np.ones((4, 3)))
    times = [-0.5, 0, 0, 1, 1, 2]
    for method in ("rk4", "kahan_li8"):
        motion = ph.simulate(BODIES, STATES, times, law, method=method, step=0.05)
        for k in (0, 3):
            alone = ph.simulate(BODIES[k], state_of(k), times, law, method=method, step=0.05)
            assert_same(motion[k], alone, 64 * 4 * EPS * 10 * largest(alone))


def test_input_invalid_for_all_bodies_is_an_error():
    for wrong, match in (
        ({"method": "exact", "step": 0.1}, "exact"),
        ({"method": "rk4", "step": 1e-300}, "more than max_steps = 1e10"),
        ({"step": -1.0}, "step"),
        ({"threads": 0}, "threads"),
    ):
        with pytest.raises(ValueError, match=match):
            ph.simulate(BODIES, STATES, T, ph.torque.heavy(C), **wrong)
        with pytest.raises(ValueError, match=match):
            next(ph.simulate_blocks(BODIES, STATES, T, ph.torque.heavy(C), **wrong))
    with pytest.raises(ValueError, match="threads"):
        ph.simulate(ASYMMETRIC, START, T, threads=0)


def test_a_body_that_cannot_converge_does_not_delay_the_others():
    rates = [[0.1, 0.2, 1.0], [1e100, 1e100, 1.0]]
    motion = ph.simulate(ASYMMETRIC, ph.State(R0, rates), [1.0], ph.torque.heavy([0.1, 0.2, 0.3]))
    assert motion.ok.tolist() == [True, False]
    assert "more than max_steps = 1e8" in motion.failures[0].message


def test_a_failure_before_the_start_keeps_later_times():
    law = ph.torque.tabulated([-1, 2.5], np.ones((2, 3)))
    motion = ph.simulate([ASYMMETRIC], START, [-2, -0.5, 0, 1], law, method="rk4", step=0.1)
    assert np.isnan(motion.energy[0]).tolist() == [True, False, False, False]
