"""The WebAssembly core against the core in Python: the same states, errors and changes."""

import json
import re

import numpy as np
import pytest

import polhode as ph
from node_core import Problem, packed
from viewer_scenes import FILES, HELD, METHODS, PRESETS, ROOT, RUN, SCENES, TUMBLING

EVERY = [*FILES, *PRESETS, *SCENES]


def agree(found, expected, followed):
    """Compare states to 1e-12 of the size of each quantity."""
    for name, values in expected.items():
        # A quantity that is zero throughout is zero in both.
        tolerance = 1e-12 * followed.scale(name)
        np.testing.assert_allclose(found[name], values, rtol=0, atol=tolerance, err_msg=name)


def files_of(followed):
    return {} if followed.mesh is None else {followed.mesh.name: packed(followed.mesh)}


@pytest.mark.parametrize("name", EVERY)
def test_states_equal_those_of_python(name, core, follow):
    followed = follow(name)
    for times, expected in (followed.outputs(), followed.between()):
        _, found = core.motion(followed.text, times, files=files_of(followed))
        np.testing.assert_array_equal(found["time"], times)
        agree(found, expected, followed)


def test_properties_of_a_motion(core, follow):
    followed = follow("t-handle")
    about, _ = core.motion(followed.text, [], files=files_of(followed))
    free = ph.FreeMotion(
        followed.scene.body.inertia, followed.scene.state.rotor, followed.scene.state.omega_body
    )
    described = free.describe()
    assert (about["title"], about["duration"], about["samples"]) == ("T-handle in free flight", 12, 6001)
    assert (about["method"], about["exact"], about["held"], about["ensemble"]) == ("exact", True, False, None)
    assert about["free"]["regime"] == described["regime"]
    for ours, theirs in (("modulus", "modulus"), ("period", "period"), ("flip_time", "flip_time")):
        assert about["free"][ours] == pytest.approx(described[theirs], rel=1e-12)
    assert about["body"]["mass"] == pytest.approx(followed.scene.body.mass, rel=1e-14)
    np.testing.assert_allclose(
        about["body"]["moments"], followed.scene.body.inertia.principal_moments, rtol=1e-13
    )
    assert {entry["name"] for entry in about["conserved"]} == set(followed.motion.certificate.drift)


@pytest.mark.parametrize("name", METHODS)
def test_methods_take_the_same_steps(name, core, follow):
    followed = follow(f"by {name}")
    times, expected = followed.outputs()
    about, found = core.motion(followed.text, times)
    assert about["method"] == name
    assert about["steps"] == followed.motion.certificate.steps
    agree(found, expected, followed)


def test_exact_motion_is_known_before_and_after_its_run(core, follow):
    followed = follow("asymmetric")
    times = np.array([-1e6, -3.0, 1e3, 1e9])
    expected = ph.FreeMotion(
        followed.scene.body.inertia, followed.scene.state.rotor, followed.scene.state.omega_body
    ).at(times)
    _, found = core.motion(followed.text, times)
    # Errors of R and ω are rounding errors up to 1e12 s, and so are differences between two builds.
    np.testing.assert_allclose(found["rotor"], expected.rotor.components, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found["omega_body"], expected.omega_body.components, rtol=0, atol=1e-13)


def test_stepped_motion_is_known_up_to_its_end(core, follow):
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
def test_errors_of_scenes_equal_those_of_python(written, instead, core, tmp_path):
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


def test_motion_that_takes_too_long_is_an_error(core):
    slow = (
        TUMBLING
        + '[torque]\nquadratic_damping = 0.1\n[run]\nduration = "9 d"\n[method]\nname = "rk4"\nstep = "1 ms"'
    )
    with pytest.raises(Problem, match="takes too long"):
        core.motion(slow, [], budget=0.2)


def surface(core, scene, **options):
    """Return vertices (n, 3) and triangles (m, 3) of a surface, and the answer."""
    found = core.ask("surface", scene=scene, **options)
    vertices = np.array(found["vertices"]).reshape(-1, 3)
    faces = np.array(found["faces"]).reshape(-1, 3)
    assert (faces.min(), faces.max()) == (0, len(vertices) - 1)
    assert len(found["tints"]) == len(faces)
    np.testing.assert_allclose(found["extents"], np.ptp(vertices, axis=0), rtol=1e-15)
    return vertices, faces, found


def test_surface_of_a_mesh_is_its_file(core, follow):
    followed = follow("t-handle")
    vertices, faces, _ = surface(core, followed.text, files=files_of(followed))
    # The volume that the triangles enclose, times the density of steel, in body axes at the centre of mass.
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    mass = 7850 * np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert mass == pytest.approx(followed.scene.body.mass, rel=1e-6)


def test_surface_of_known_moments_is_a_box(core):
    vertices, faces, found = surface(core, TUMBLING + RUN)
    assert len(vertices) == 8
    # For a mass of 1 the sides squared are 6 (i2 + i3 - i1) and so on; the plate is 3% as thick as long.
    np.testing.assert_allclose(found["extents"], np.sqrt([24, 12, 24 * 0.03**2]), rtol=1e-12)
    assert sorted(set(found["tints"])) == [2, 3, 4]
    assert len(faces) == 12


def test_surface_of_a_top_stands_on_its_tip(core):
    vertices = np.array(core.ask("surface", scene=HELD + RUN, arm=[0, 0, 0.5])["vertices"]).reshape(-1, 3)
    np.testing.assert_array_equal(vertices[0], 0)
    assert vertices[:, 2].min() == 0
    assert vertices[:, 2].max() == pytest.approx(0.5 * 1.63, rel=1e-12)


def test_solids_fill_a_box(core):
    given = {"kind": "cylinder", "radius": 1, "height": 3}
    assert core.ask("called", name="solid", given=["cylinder", [2, 2, 3]]) == given
    with pytest.raises(Problem, match="no solid of kind 'cube'"):
        core.ask("called", name="solid", given=["cube", [1, 1, 1]])


def test_second_moments_and_inertia_are_inverse(core):
    frame = ph.Rotor.from_plane_angle(ph.bivector([1, 2, 2]) / 3, 0.7)
    body = ph.Inertia.from_principal_moments(2, 3, 4)
    matrix = frame.to_matrix() @ np.diag([2, 3, 4]) @ frame.to_matrix().T
    given = [body.principal_moments.tolist(), frame.components.tolist()]
    found = core.ask("called", name="secondMoments", given=given)
    # Each moment is the sum of the two other second moments.
    np.testing.assert_allclose(found["spread"], [2.5, 1.5, 0.5], rtol=1e-14)
    inertia = core.ask("called", name="inertia", given=[found["spread"], found["frame"]])
    # Some products of three rotations' entries and moments of up to 4.
    np.testing.assert_allclose(inertia, matrix, rtol=0, atol=1e-14)
    quarter = ph.Rotor.from_plane_angle(ph.bivector([1, 0, 0]), np.pi / 2)
    found = core.ask("called", name="secondMoments", given=[[2, 3, 4], quarter.components.tolist()])
    assert found["frame"] is None
    np.testing.assert_allclose(found["spread"], [2.5, 0.5, 1.5], rtol=1e-14)


@pytest.mark.parametrize("angles", [(0.3, 1.2, -2.0), (3.0, 0.4, 2.5), (0.5, 0.0, 0.0), (0.5, np.pi, 0.0)])
def test_attitude_angles_give_the_rotor(angles, core):
    def rotor(turn, tilt, roll):
        return ph.evaluate(
            "exp(-turn/2 e1e2) exp(-tilt/2 e2e3) exp(-roll/2 e1e2)", turn=turn, tilt=tilt, roll=roll
        ).components

    found = core.ask("called", name="attitude", given=[rotor(*angles).tolist()])
    again = rotor(**found)
    np.testing.assert_allclose(again * np.sign(again @ rotor(*angles)), rotor(*angles), rtol=0, atol=1e-15)


def test_plane_and_angle_of_a_rotor(core):
    rotor = ph.Rotor.from_plane_angle(ph.bivector([1, 2, 2]) / 3, 4.0)
    found = core.ask("called", name="planeAngle", given=[rotor.components.tolist()])
    np.testing.assert_allclose(found["plane"], np.array([1, 2, 2]) / 3, rtol=1e-15)
    assert found["angle"] == pytest.approx(4.0, rel=1e-15)


def test_units_of_the_page_are_those_of_scenes(core):
    text = (ROOT / "viewer/src/format/units.ts").read_text()
    times = re.search(r"TIMES = \[(.*?)\];", text)[1]
    found = re.findall(r'unit\("(\w+)"(?:, ([\d_]+))?\)', times)
    assert len(found) == 5
    for name, size in found:
        about, _ = core.motion(TUMBLING + f'[run]\nduration = "3 {name}"\n', [])
        assert about["duration"] == 3 * float(size.replace("_", "") or 1)


def test_first_bodies_of_an_ensemble(core, follow):
    path = FILES["toutatis-uncertain"]
    scene = ph.Scene.read(path)
    time = 3e6
    rotors = np.array(core.ask("bodies", scene=path.read_text(), time=time, count=20)).reshape(-1, 4)
    state, bodies, _ = scene.ensemble.draw(count=20)
    expected = ph.simulate(bodies, state, [time]).rotor.components[:, 0]
    np.testing.assert_allclose(rotors, expected, rtol=0, atol=1e-12)


def test_recordings_reproduce_their_rows(core, follow):
    followed = follow("magnetic")
    times = np.linspace(0, 5, 51)
    about, states = core.motion(followed.text, times)
    rows = core.ask("motion", scene=followed.text, times=list(times))["rows"]
    found = core.ask(
        "recorded", about=json.dumps({**about, "method": "recorded"}), rows=rows, times=list(times)
    )
    np.testing.assert_array_equal(found["rows"], rows)
    assert states["time"][-1] == 5


class TestMerged:
    scene = "# A box.\n" + TUMBLING + "# How long.\n" + RUN

    def test_tables_are_replaced_and_the_rest_is_kept(self, core):
        changed = core.ask("merged", scene=self.scene, change="[initial]\nspin = { vector = [0, 2, 0] }\n")
        assert changed == self.scene.replace("[0.3, 1, 0.2]", "[0, 2, 0]")

    def test_tables_are_added_and_removed(self, core):
        damped = core.ask("merged", scene=self.scene, change="[torque]\ndamping = 0.1\n")
        about, _ = core.motion(damped, [])
        assert [law["name"] for law in about["laws"]] == ["damping"]
        free = core.ask("merged", scene=damped, change="[torque]\n")
        assert core.motion(free, [])[0]["laws"] == []

    def test_invalid_toml_is_an_error(self, core):
        with pytest.raises(Problem, match="change"):
            core.ask("merged", scene=self.scene, change="[torque\n")
