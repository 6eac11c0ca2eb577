"""Values and tables of trajectories: rates and momenta in both frames, data frames, notebooks."""

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, EPS, START
from polhode import e1, e2, e3

TIMES = np.linspace(0, 2, 5)
# Both sides are one or two products of values of size |x| <= 8.
ROUNDING = 32 * EPS


def alone(torque=None, **named):
    return ph.simulate(ASYMMETRIC, START, TIMES, torque, **named)


def batch(count=6):
    state = ph.State(ph.Rotor.random((2, count // 2), rng=1), [0.25, -0.5, 1.0], velocity=[1, 2, 3])
    return ph.simulate(ASYMMETRIC, state, TIMES)


# --- rates and momenta


@pytest.mark.parametrize("motion", [alone(), batch(), alone(ph.torque.heavy([0.3, 0, 2]))])
def test_momentum_body_is_the_inertia_of_omega_body(motion):
    """~R L R = I(Ω_B), and Ω_S = R Ω_B ~R (4.12)."""
    assert motion.omega_space.shape == motion.momentum_body.shape == (*motion.shape, 5)
    assert motion.omega_space.grades == motion.momentum_body.grades == (2,)
    assert motion.momentum_body.is_close(ASYMMETRIC(motion.omega_body), rtol=0, atol=ROUNDING).all()
    assert motion.omega_space.is_close(
        motion.rotor * motion.omega_body * ~motion.rotor, rtol=0, atol=ROUNDING
    ).all()


def test_momentum_body_includes_wheels():
    h = [0.5, 0.0, 2.0]
    motion = alone(ph.torque.gyrostat(h))
    expected = ASYMMETRIC(motion.omega_body) + ph.bivector(h)
    assert motion.momentum_body.is_close(expected, rtol=0, atol=ROUNDING).all()
    # The total momentum is constant in space.
    L = motion.momentum_space
    assert L.is_close(L[0] + 0 * L, rtol=0, atol=1e-9).all()


def test_omega_space_is_the_rate_of_the_rotor():
    """R' = −½ Ω_S R (4.10), by differences of order 2 with h = 1e-5: h² and ε/h are below 1e-9."""
    h = 1e-5
    motion = ph.simulate(ASYMMETRIC, START, [1 - h, 1, 1 + h])
    rate = (motion.rotor.components[2] - motion.rotor.components[0]) / (2 * h)
    expected = -0.5 * motion.omega_space[1] * motion.rotor[1]
    np.testing.assert_allclose(rate, expected.components, rtol=0, atol=1e-9)


def test_failed_bodies_have_no_values():
    inertia = ph.Inertia.from_principal_moments(1, 2, 3)
    state = ph.State(ph.Rotor.identity((2,)), [[0, 0, 1.0], [0, 0, 1e150]])
    motion = ph.simulate(inertia, state, [0, 1.0], ph.torque.heavy([0.3, 0, 2]), method="rk4", step=0.01)
    assert motion.ok.tolist() == [True, False]
    assert np.isfinite(motion.momentum_body.components[0]).all()
    assert np.isnan(motion.omega_space.components[1, -1]).all()


# --- data frames


COLUMNS = [
    *("attitude_w", "attitude_x", "attitude_y", "attitude_z"),
    *(
        f"{name}_{axis}"
        for name in ("omega_body", "momentum_space", "position", "velocity")
        for axis in "xyz"
    ),
    "energy",
]


def test_a_data_frame_of_one_body():
    pytest.importorskip("pandas")
    motion = alone()
    frame = motion.to_dataframe()
    assert list(frame.columns) == COLUMNS
    assert frame.index.name == "time"
    np.testing.assert_array_equal(frame.index, TIMES)
    np.testing.assert_array_equal(frame.filter(like="omega_body"), motion.omega_body.components)
    np.testing.assert_array_equal(frame.filter(like="attitude"), motion.rotor.to_quaternion(order="wxyz"))
    np.testing.assert_array_equal(frame["energy"], motion.energy)
    units = frame.attrs["units"]
    assert list(units) == ["time", *COLUMNS]
    assert (units["time"], units["momentum_space_z"], units["energy"]) == ("s", "kg m^2/s", "J")
    assert "a_space = R a_body ~R" in frame.attrs["conventions"]
    frame.loc[:, :] = 7
    assert motion.energy[0] != 7


def test_a_data_frame_has_the_values_of_the_dataset():
    pytest.importorskip("xarray")
    motion = batch()
    frame, data = motion.to_dataframe(), motion.to_xarray()
    for name in ("omega_body", "momentum_space", "position", "velocity"):
        for axis in "xyz":
            column = frame[f"{name}_{axis}"].to_numpy().reshape(6, 5)
            np.testing.assert_array_equal(column, data[name].sel(axis=axis))


def test_a_data_frame_of_a_batch_has_the_bodies_in_c_order():
    pytest.importorskip("pandas")
    motion = batch()
    frame = motion.to_dataframe()
    assert frame.index.names == ["body", "time"]
    assert frame.shape == (30, len(COLUMNS))
    for body, index in enumerate(np.ndindex(motion.shape)):
        own = frame.loc[body]
        np.testing.assert_array_equal(own.index, TIMES)
        assert own.equals(motion[index].to_dataframe())


def test_a_data_frame_without_output_times_is_empty():
    pytest.importorskip("pandas")
    frame = ph.simulate(ASYMMETRIC, START, []).to_dataframe()
    assert frame.shape == (0, len(COLUMNS))


# --- notebooks


def test_the_table_of_a_notebook():
    motion = alone(ph.torque.heavy([0.3, 0, 2]), events=[ph.event.plane(e3, e3)])
    shown = motion._repr_html_()
    assert shown.startswith("<table><caption>Trajectory</caption>")
    for words in (
        "5, from 0 s to 2 s",
        "heavy body about a fixed point",
        "kahan_li8, ",
        "error estimate",
        "of energy, vertical angular momentum, rotor norm",
        "event ",
    ):
        assert words in shown, shown
    assert f"{motion.certificate.worst:.1e}" in shown


def test_the_table_of_a_batch_and_of_pickled_motions():
    import pickle

    shown = batch()._repr_html_()
    assert "2 × 3" in shown
    assert ">exact<" in shown
    assert "regime" not in pickle.loads(pickle.dumps(alone()))._repr_html_()


@pytest.mark.parametrize("times", [[], [1.0]])
def test_the_table_of_few_times(times):
    assert f">{len(times)}" in ph.simulate(ASYMMETRIC, START, times)._repr_html_()


def test_a_title_is_escaped():
    motion = alone()
    motion.attributes["title"] = "<script>1 & 2"
    assert "<caption>&lt;script&gt;1 &amp; 2</caption>" in motion._repr_html_()


def test_the_table_of_failed_bodies():
    state = ph.State(ph.Rotor.identity((2,)), [[0, 0, 1.0], [0, 0, 1e150]])
    motion = ph.simulate(
        ASYMMETRIC, state, [0, 1.0], ph.torque.heavy(0.3 * e1 + 2 * e2), method="rk4", step=0.01
    )
    assert "1, the first at index (1,) after" in motion._repr_html_()
