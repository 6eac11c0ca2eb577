"""Ensembles of scenes: reproducible bodies, and reports of the command."""

import json

import numpy as np
import pytest

import polhode as ph
from command_line import SCENE, polhode

ENSEMBLE = """
[ensemble]
number = 1000
seed = 5
attitude = "uniform"
spin = { direction = "uniform", relative = 0.1 }
moments = { relative = 0.05 }
velocity = { normal = [1, "2 m/s", 0] }
torque.damping = { relative = 0.3 }
torque.magnetic.field = { uniform = 0.5 }
"""
LAWS = "[torque]\ndamping = 0.2\nmagnetic = { dipole = [1, 0, 0], field = [0, 1, 2] }\ngyrostat = [0, 1, 0]\n"


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(SCENE.replace("[run]", LAWS + "[run]") + ENSEMBLE)
    return path


@pytest.fixture
def spec(path):
    return ph.Scene.read(path).ensemble


def test_a_scene_lists_its_random_parameters(spec):
    assert (spec.number, spec.seed) == (1000, 5)
    assert dict(spec.varied) == {
        "attitude": "uniform",
        "spin.direction": "uniform",
        "spin": "relative, 0.1",
        "moments": "relative, 0.05",
        "velocity": "normal, (1, 2, 0) m/s",
        "torque.damping": "relative, 0.3",
        "torque.magnetic.field": "uniform, 0.5 T",
    }
    assert "_core" not in repr(spec)


def test_bodies_are_drawn(path, spec):
    scene = ph.Scene.read(path)
    state, inertias, torque = spec.draw()
    damping, magnetic, gyrostat = spec.laws()
    assert torque.shape == (1000,)
    assert [law.name for law in torque.laws] == ["damping", "magnetic", "gyrostat"]
    assert state.rotor.shape == state.omega_body.shape == state.velocity.shape == (1000,)
    np.testing.assert_array_equal(state.position.components, np.zeros((1000, 3)))
    np.testing.assert_array_equal(state.velocity.components[:, 2], 0.0)
    assert len(inertias) == 1000
    # This body is flat: its integrals of x² dm are 2, 1 and 0; i1 is the second, i2 the first, i3 their sum.
    moments = np.array([inertia.principal_moments for inertia in inertias])
    spread = np.log(moments / scene.body.inertia.principal_moments).std(axis=0)
    # Of 1000 normal numbers the deviation is off by 1/√2000; five times as much happens once in a million.
    np.testing.assert_allclose(spread / 0.05, [1, 1, 5**0.5 / 3], rtol=5 / 2000**0.5)
    # A law of each body: its name and its arguments.
    assert damping[0] == "damping"
    assert damping[1][0].shape == (1000,)
    name, (dipole, field) = magnetic
    assert name == "magnetic"
    np.testing.assert_array_equal(dipole, np.broadcast_to([1.0, 0, 0], (1000, 3)))
    assert (np.abs(field - [0, 1, 2]) <= 0.5).all()
    assert (field.std(axis=0) > 0.2).all()
    # A law of all.
    assert (gyrostat,) == ph.torque.gyrostat([0, 1, 0]).laws


def test_a_range_of_bodies_equals_that_of_the_whole(spec):
    (whole, inertias, _), laws = spec.draw(), spec.laws()
    (part, part_inertias, _), part_laws = spec.draw(10, 5), spec.laws(10, 5)
    np.testing.assert_array_equal(part.rotor.components, whole.rotor.components[10:15])
    np.testing.assert_array_equal(part.omega_body.components, whole.omega_body.components[10:15])
    assert part_inertias == inertias[10:15]
    np.testing.assert_array_equal(part_laws[0][1][0], laws[0][1][0][10:15])
    (damping, *_) = spec.draw(999)[2].laws
    assert damping.arguments == (laws[0][1][0][999],)


def test_a_range_out_of_bounds_raises(spec):
    with pytest.raises(ValueError, match=r"range 999\.\.1001 is out of bounds for 1000 bodies"):
        spec.draw(999, 2)
    with pytest.raises(ValueError, match=r"range 1000\.\.1000 is out of bounds for 1000 bodies"):
        spec.draw(1000)
    with pytest.raises(ValueError, match="must not be negative, got first = -1, count = 2"):
        spec.draw(-1, 2)


def test_a_scene_without_an_ensemble_has_none(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(SCENE)
    assert ph.Scene.read(path).ensemble is None


def test_check_reports_the_size_of_results(path):
    times = len(ph.Scene.read(path).times)
    done = polhode("check", path)
    assert done.returncode == 0
    # 4 + 3 + 3 + 1 numbers of 8 bytes.
    size = 1000 * times * 88
    assert f"1000 bodies, {size / 1e3:.3g} kB of results" in done.stdout
    (finding,) = json.loads(polhode("check", "--json", path).stdout)
    assert (finding["bodies"], finding["bytes"]) == (1000, size)


def test_errors_have_their_place(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(SCENE + ENSEMBLE.replace("moments", "moment"))
    done = polhode("check", path)
    assert done.returncode == 3
    assert "unknown table `moment`, expected `moments`" in done.stderr
    # All errors are reported at once.
    assert "which has no `damping` in [torque]" in done.stderr
