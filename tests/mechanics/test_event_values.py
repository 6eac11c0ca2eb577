"""Events as values and as data, their cost, and errors."""

import pickle

import numpy as np
import pytest

import polhode as ph
from motions import ASYMMETRIC, START

E = ph.event


def rolling(t, rotor, omega, position, velocity):
    return position.components[0] - 0.5


# --- values


VALUES = [
    E.angle(ph.e3, ph.e3, 0.5),
    E.plane([1, 0, 0], ph.e3),
    E.plane([1, 0, 0], ph.e3, direction=-1, terminal=True),
    E.spin(ph.e3 ^ ph.e1, 2.0),
    E.position(ph.e3, 1.5),
    E.formula("x·n - h", n=ph.e3, h=2.0),
    E.function(rolling, direction=1),
]


@pytest.mark.parametrize("event", VALUES, ids=repr)
def test_events_are_values(event):
    again = pickle.loads(pickle.dumps(event))
    assert again == event
    assert repr(again) == repr(event)
    assert sum(one == event for one in VALUES) == 1


def test_repr_of_events():
    event = E.plane([2, 0, 0], ph.e3, direction=-1, terminal=True)
    assert repr(event) == "plane([1, 0, 0], [0, 0, 1], direction=-1, terminal=True)"
    assert event.name == "plane([1, 0, 0], [0, 0, 1])"
    assert repr(E.formula("x·n - h", direction=1, n=ph.e3, h=2.0)) == (
        "formula('x·n - h', direction=1, n=e3, h=2.0)"
    )
    assert E.function(rolling).name == "function(rolling)"


# --- reports


def test_events_count_evaluations_but_not_steps():
    """Sampling needs evaluations; steps are those of the motion."""
    given = {"times": [10.0], "torque": ph.torque.heavy([0.5, 0.25, 1.0]), "step": 0.125}
    plain = ph.simulate(ASYMMETRIC, START, **given)
    calls = []

    def look(t, *state):
        calls.append(t)
        return 1.0

    watched = ph.simulate(ASYMMETRIC, START, events=E.function(look), **given)
    assert watched.certificate.steps == plain.certificate.steps == 80
    each = plain.certificate.evaluations / 80
    # Samples other than those at the start and the ends of the 80 steps are separate steps.
    assert watched.certificate.evaluations == plain.certificate.evaluations + each * (len(calls) - 81)
    assert watched.rotor[0] == plain.rotor[0]


def test_events_are_in_the_data(tmp_path):
    xarray = pytest.importorskip("xarray")
    events = [E.plane(ph.e1, ph.e3), E.spin(ph.e1 ^ ph.e2, 1e3), E.formula("t - 2.5")]
    motion = ph.simulate(ASYMMETRIC, START, [0.0, 10.0], events=events)
    motion.save(tmp_path / "motion.nc")
    with xarray.open_dataset(tmp_path / "motion.nc") as data:
        total = sum(map(len, motion.events))
        assert data.sizes["event"] == total > 1
        assert data.event_name.values[-1] == "formula('t - 2.5')"
        assert data.event_time.values[-1] == pytest.approx(2.5)
        assert data.event_attitude.shape == (total, 4)
        assert data.event_time.attrs["units"] == "s"
    nothing = ph.simulate(ASYMMETRIC, START, [1.0], events=events[1]).to_xarray()
    assert nothing.sizes["event"] == 0
    assert "event" not in ph.simulate(ASYMMETRIC, START, [1.0]).to_xarray().sizes


class OwnError(Exception):
    pass


def failing(t, *state):
    if t > 0.5:
        raise OwnError("enough")
    return 1.0


@pytest.mark.parametrize(
    ("events", "kind", "parts"),
    [
        (E.function(failing), OwnError, ["enough"]),
        (E.function(lambda *state: "x"), TypeError, ["t = 0 s", "number", "str"]),
        (E.function(lambda *state: ph.e1), TypeError, ["t = 0 s", "number"]),
        (E.function(lambda *state: np.ones(2)), TypeError, ["t = 0 s", "number"]),
        (
            [E.plane(ph.e1, ph.e3), E.function(lambda *state: np.nan)],
            ValueError,
            ["t = 0 s", "events[1]", "NaN"],
        ),
        (E.formula("norm(v)/t - 1"), ValueError, ["t = 0 s", "events[0]", "norm(v)/t", "division"]),
        (E.formula("m - t"), ValueError, ["`m`", "Body", "Inertia"]),
        (3, TypeError, ["polhode.event", "3"]),
        ("plane", TypeError, ["events[0]", "'p'"]),
        ([E.plane(ph.e1, ph.e3), E.plane], TypeError, ["events[1]"]),
        ([lambda *state: 1.0], TypeError, ["events[0]", "event.function(f)"]),
    ],
    ids=lambda value: "",
)
def test_invalid_return_values_raise(events, kind, parts):
    with pytest.raises(kind) as error:
        ph.simulate(ASYMMETRIC, START, [1.0], events=events)
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("x", ["scalar, grade 0", "grade 1", "x·e3"]),
        ("x v", ["grades 0, 2", "⟨…⟩_0"]),
        ("Ω_B", ["grade 2"]),
        ("x·e3 = 2", ["one side"]),
        ("x·q", ["q"]),
    ],
)
def test_formulas_that_are_not_events_raise(text, parts):
    with pytest.raises(ph.FormulaError) as error:
        E.formula(text)
    for part in parts:
        assert part in str(error.value)


def test_invalid_arguments_raise():
    for make in (
        lambda: E.angle(ph.e1, ph.e3, 4.0),
        lambda: E.angle(ph.e1, ph.e3, np.nan),
        lambda: E.plane([0, 0, 0], ph.e3),
        lambda: E.plane(ph.e1, [0, np.inf, 0]),
        lambda: E.spin([0, 0, 0]),
        lambda: E.plane(ph.e1, ph.e3, direction=2),
        lambda: E.formula("t", direction="up"),
    ):
        with pytest.raises(ValueError):
            make()
    for make in (
        lambda: E.spin(ph.e1),
        lambda: E.function(3),
        lambda: E.formula(3),
        lambda: E.plane("x", ph.e3),
    ):
        with pytest.raises(TypeError):
            make()
    with pytest.raises(TypeError, match="called with t, rotor, omega_body, position and velocity"):
        E.function(lambda t: t)
