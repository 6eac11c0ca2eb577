"""The core as WebAssembly against the core in Python: the same states, errors and changes."""

import json

import numpy as np
import pytest

import polhode as ph
from node_core import Problem, packed
from viewer_scenes import FILES, METHODS, PRESETS, RUN, SCENES, TUMBLING

EVERY = [*FILES, *PRESETS, *SCENES]


def agree(found, expected, followed):
    """Hold states to 1e-12 of the size of each quantity."""
    for name, values in expected.items():
        # A quantity that is zero throughout is zero in both.
        tolerance = 1e-12 * followed.scale(name)
        np.testing.assert_allclose(found[name], values, rtol=0, atol=tolerance, err_msg=name)


def files_of(followed):
    return {} if followed.mesh is None else {followed.mesh.name: packed(followed.mesh)}


@pytest.mark.parametrize("name", EVERY)
def test_states_are_those_of_python(name, core, follow):
    followed = follow(name)
    for times, expected in (followed.outputs(), followed.between()):
        _, found = core.motion(followed.text, times, files=files_of(followed))
        np.testing.assert_array_equal(found["time"], times)
        agree(found, expected, followed)


def test_what_is_known_of_a_motion(core, follow):
    followed = follow("t-handle")
    about, _ = core.motion(followed.text, [], files=files_of(followed))
    free = ph.FreeMotion(
        followed.scene.body.inertia, followed.scene.state.rotor, followed.scene.state.omega_body
    )
    told = free.describe()
    assert (about["title"], about["duration"], about["samples"]) == ("T-handle in free flight", 12, 6001)
    assert (about["method"], about["exact"], about["held"], about["ensemble"]) == ("exact", True, False, None)
    assert about["free"]["regime"] == told["regime"]
    for ours, theirs in (("modulus", "modulus"), ("period", "period"), ("flip_time", "flip_time")):
        assert about["free"][ours] == pytest.approx(told[theirs], rel=1e-12)
    assert about["body"]["mass"] == pytest.approx(followed.scene.body.mass, rel=1e-14)
    np.testing.assert_allclose(
        about["body"]["moments"], followed.scene.body.inertia.principal_moments, rtol=1e-13
    )
    assert {entry["name"] for entry in about["conserved"]} == set(followed.motion.certificate.drift)


@pytest.mark.parametrize("name", METHODS)
def test_methods_by_name_step_alike(name, core, follow):
    followed = follow(f"by {name}")
    times, expected = followed.outputs()
    about, found = core.motion(followed.text, times)
    assert about["method"] == name
    assert about["steps"] == followed.motion.certificate.steps
    agree(found, expected, followed)


def test_an_exact_motion_is_known_before_and_after(core, follow):
    followed = follow("asymmetric")
    times = np.array([-1e6, -3.0, 1e3, 1e9])
    expected = ph.FreeMotion(
        followed.scene.body.inertia, followed.scene.state.rotor, followed.scene.state.omega_body
    ).at(times)
    _, found = core.motion(followed.text, times)
    # Errors in R and ω stay at rounding up to 1e12 s, and so do those between two builds of the same code.
    np.testing.assert_allclose(found["rotor"], expected.rotor.components, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found["omega_body"], expected.omega_body.components, rtol=0, atol=1e-13)


def test_a_stepped_motion_is_known_up_to_its_end(core, follow):
    with pytest.raises(Problem, match="5"):
        core.motion(follow("magnetic").text, [5.001])
    with pytest.raises(Problem):
        core.motion(follow("magnetic").text, [-0.001])


@pytest.mark.parametrize(
    ("written", "instead"),
    [
        ("duration", "durration"),
        ("[1, 2, 3]", "[1, 2, 30]"),
        ("[0.3, 1, 0.2]", '[0.3, "1 rev/kg", 0.2]'),
        ("[run]", "[run"),
        ("[run]", '[torque]\ntorque_body = "e1 ∧ ∧ e2"\n[run]'),
        ("[run]", "[torque]\ndamping = 0.1\nwind = 2\n[run]"),
        ("moments = [1, 2, 3]", 'mesh = "nowhere.stl"\ndensity = 1'),
    ],
)
def test_mistakes_are_told_as_python_tells_them(written, instead, core, tmp_path):
    text = (TUMBLING + RUN).replace(written, instead)
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(ph.SceneError) as python:
        ph.Scene.read(path)
    with pytest.raises(Problem) as page:
        core.motion(text, [], name="scene.toml")
    assert "scene.toml:" in str(page.value)
    if "mesh" not in instead:
        assert str(page.value) == str(python.value).replace(str(path), "scene.toml")


def test_a_motion_that_takes_too_long_is_given_up(core):
    slow = (
        TUMBLING
        + '[torque]\nquadratic_damping = 0.1\n[run]\nduration = "9 d"\n[method]\nname = "rk4"\nstep = "1 ms"'
    )
    with pytest.raises(Problem, match="takes too long"):
        core.motion(slow, [], budget=0.2)


def test_surfaces_are_the_files(core, follow):
    followed = follow("t-handle")
    surface = core.ask("surface", scene=followed.text, files=files_of(followed))
    vertices = np.array(surface["vertices"]).reshape(-1, 3)
    faces = np.array(surface["faces"]).reshape(-1, 3)
    assert faces.min() == 0
    assert faces.max() == len(vertices) - 1
    # The volume that the triangles enclose, times the density of steel, in body axes at the centre of mass.
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    mass = 7850 * np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert mass == pytest.approx(followed.scene.body.mass, rel=1e-6)
    assert core.ask("surface", scene=TUMBLING + RUN) is None


def test_the_first_bodies_of_an_ensemble(core, follow):
    path = FILES["toutatis-uncertain"]
    scene = ph.Scene.read(path)
    time = 3e6
    rotors = np.array(core.ask("bodies", scene=path.read_text(), time=time, count=20)).reshape(-1, 4)
    state, bodies, _ = scene.ensemble.draw(count=20)
    expected = ph.simulate(bodies, state, [time]).rotor.components[:, 0]
    np.testing.assert_allclose(rotors, expected, rtol=0, atol=1e-12)


def test_recordings_pass_through_their_rows(core, follow):
    followed = follow("magnetic")
    times = np.linspace(0, 5, 51)
    about, states = core.motion(followed.text, times)
    rows = core.ask("motion", scene=followed.text, times=list(times))["rows"]
    told = core.ask(
        "recorded", about=json.dumps({**about, "method": "recorded"}), rows=rows, times=list(times)
    )
    np.testing.assert_array_equal(told["rows"], rows)
    assert states["time"][-1] == 5


class TestMerged:
    scene = "# A box.\n" + TUMBLING + "# How long.\n" + RUN

    def test_tables_are_replaced_and_the_rest_stays(self, core):
        changed = core.ask("merged", scene=self.scene, change="[initial]\nspin = { vector = [0, 2, 0] }\n")
        assert changed == self.scene.replace("[0.3, 1, 0.2]", "[0, 2, 0]")

    def test_tables_come_and_go(self, core):
        damped = core.ask("merged", scene=self.scene, change="[torque]\ndamping = 0.1\n")
        about, _ = core.motion(damped, [])
        assert [law["name"] for law in about["laws"]] == ["damping"]
        free = core.ask("merged", scene=damped, change="[torque]\n")
        assert core.motion(free, [])[0]["laws"] == []

    def test_what_is_no_toml_is_told(self, core):
        with pytest.raises(Problem, match="change"):
            core.ask("merged", scene=self.scene, change="[torque\n")
