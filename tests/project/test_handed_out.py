"""Arrays that values hand out: the caller may change them, and the values stay as they are."""

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3

BODY = ph.Inertia.from_principal_moments(1, 2, 3)
TIMES = np.linspace(0, 1, 5)
ALONE = ph.simulate(
    BODY, ph.State(ph.Rotor.identity(), [0.1, 2, 0.1]), TIMES, events=[ph.event.plane(e3, e3)]
)
MANY = ph.simulate(BODY, ph.State(ph.Rotor.random(6, rng=1), [0.1, 2, 0.1]), TIMES)
FREE = ph.FreeMotion(BODY, ph.Rotor.identity(), [0.1, 2, 0.1])
ROTORS = ph.Rotor.random(7, rng=2)
# As large as those that take memory from the pool.
LARGE = ph.vector(np.ones((50_000, 3)))

ARRAYS = {
    "components of a vector": (LARGE[0], "components"),
    "components of vectors": (LARGE, "components"),
    "components in float32": (LARGE.astype(np.float32), "components"),
    "exact components": (ph.vector(np.ones((2, 3), dtype=object)), "components"),
    "components in another algebra": (ph.algebra(3, 0, 1).vector([1, 2, 3, 4]), "components"),
    "components of rotors": (ROTORS, "components"),
    "components of a state": (ALONE.at(0.5).omega_body, "components"),
    "matrix of a map": (ph.LinearMap.from_matrix(np.eye(3)), "matrix"),
    "matrix of an inertia": (BODY, "matrix"),
    "principal moments": (BODY, "principal_moments"),
    "times of a spline": (ph.RotorSpline(np.arange(7), ROTORS), "times"),
    "mean of moments": (ph.Moments().add(np.ones((3, 2))), "mean"),
    "d_rotor_dt": (FREE.derivatives(TIMES), "d_rotor_dt"),
    **{f"{name} of one": (ALONE, name) for name in ("time", "energy")},
    **{f"{name} of many": (MANY, name) for name in ("time", "energy")},
    **{f"{name} of events": (ALONE.events[0], name) for name in ("time", "rising")},
    **{f"{name} in a certificate": (MANY.certificate, name) for name in ("steps", "norm_drift")},
}


@pytest.mark.parametrize("name", ARRAYS)
def test_returned_arrays_can_be_changed(name):
    value, attribute = ARRAYS[name]
    array = getattr(value, attribute)
    before = array.copy()
    assert array.size
    assert array.flags.writeable
    array[...] = 7
    assert np.array_equal(getattr(value, attribute), before)


METHODS = {
    "to_matrix": ROTORS.to_matrix,
    "to_quaternion": lambda: ROTORS.to_quaternion(order="xyzw"),
    "to_rotation_vector": ROTORS.to_rotation_vector,
    "to_euler": lambda: ROTORS.to_euler("ZYX"),
    "plane_angle": lambda: ROTORS.plane_angle()[1],
    "norm": LARGE.norm,
    "norm_squared": LARGE.norm_squared,
    "to_pauli": lambda: ph.to_pauli(LARGE),
    "drifts": lambda: ALONE.drifts()["energy"],
    "eigenplanes": lambda: BODY.eigenplanes()[1],
    "conserved": lambda: MANY.certificate.conserved["energy"],
    "identity": lambda: ph.Rotor.identity().components,
}


@pytest.mark.parametrize("name", METHODS)
def test_arrays_returned_by_methods_are_copies(name):
    array = METHODS[name]()
    before = array.copy()
    assert array.flags.writeable
    array[...] = 7
    assert np.array_equal(METHODS[name](), before)


def test_scipy_takes_them():
    transform = pytest.importorskip("scipy.spatial.transform")
    turns = transform.Rotation.from_rotvec(ALONE.omega_body.components)
    expected = ph.Rotor.from_rotation_vector(ALONE.omega_body.components)
    assert np.abs(turns.as_matrix() - expected.to_matrix()).max() < 1e-15
    assert transform.Rotation.from_quat(ROTORS.to_quaternion(order="xyzw")).as_quat().shape == (7, 4)
    assert transform.Rotation.from_rotvec((e1 ^ e2).components).magnitude() == 1
    assert transform.Slerp(ALONE.time, turns)(ALONE.time).as_quat().shape == (5, 4)


def test_datasets_are_of_their_own_arrays():
    pytest.importorskip("xarray")
    data = ALONE.to_xarray()
    for name in ("omega_body", "energy"):
        data[name].values[...] = 7
    assert ALONE.energy[0] != 7
    assert ALONE.omega_body.components[0, 0] == 0.1
