"""Documents for the viewer: written scenes give the same motion, recordings have the computed states."""

import dataclasses
import json
import re
import shutil

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES, ROOT, SCENE
from polhode._mechanics.problem import Problem
from polhode._scene.writer import UnwritableError, scene_text
from polhode._support.packing import packed, unpacked
from polhode._viewer import document, recording
from polhode.torque import Torque

RNG = np.random.default_rng(20)
MOMENTS = ph.Inertia.from_principal_moments(1, 2, 2.5)
START = ph.State(ph.Rotor.random((), RNG), [0.1, -1e-7, 1 / 3])


def turned(body):
    return body.moved(ph.Rotor.random((), RNG), RNG.normal(size=3))


def read_back(problem, tmp_path):
    path = tmp_path / "written.toml"
    path.write_text(scene_text(problem), encoding="utf-8")
    return ph.Scene.read(path)


def problem(body=MOMENTS, state=START, torque=None, force=None, times=(0.0, 2.0), **others):
    return Problem(body, state, torque, force, np.array(times), **others)


# --- scenes written from numbers

BODIES = {
    "moments in any order": ph.Inertia.from_principal_moments(3, 1 / 3, 2.9),
    "matrix": turned(ph.Body.box([0.1, 0.2, 0.3], mass=1.7)).inertia,
    "body": ph.Body(0.1, ph.Inertia.from_principal_moments(1, 2, 3), [1e-300, 0.1, -7e22]),
    "turned body": turned(ph.Body.ellipsoid([0.1, 0.2, 0.3], density=7850)),
    "sum": turned(ph.Body.cone(0.1, 0.3, mass=2)) + ph.Body.sphere(0.1, mass=1),
    "points": ph.Body.from_points(RNG.uniform(1, 2, 5), RNG.normal(size=(5, 3))),
}


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_a_body_is_read_back_to_the_last_bit(body, tmp_path):
    found = read_back(problem(body), tmp_path).body
    if isinstance(body, ph.Body):
        assert found == body
    else:
        assert found.inertia == body
    # Moments of a turned body are recovered from its matrix, to the rounding of its entries.
    moments = np.sort((body.inertia if isinstance(body, ph.Body) else body).principal_moments)
    rounding = 8 * np.finfo(float).eps * moments[2]
    np.testing.assert_allclose(np.sort(found.inertia.principal_moments), moments, rtol=0, atol=rounding)


def test_a_start_is_read_back_to_the_last_bit(tmp_path):
    for _ in range(50):
        rows = RNG.normal(size=(3, 3)) * 10.0 ** RNG.integers(-200, 200, size=(3, 1))
        state = ph.State(ph.Rotor.random((), RNG), *rows)
        found = read_back(problem(state=state), tmp_path).state
        for name in ("rotor", "omega_body", "position", "velocity"):
            assert getattr(found, name) == getattr(state, name)


T = ph.torque
ATTITUDE = ph.Rotor.random((), RNG)
LAWS = {
    "heavy": T.heavy([0.1, 1 / 3, 2]),
    "gradient": T.gravity_gradient(1e-3, 0.1, 1.0),
    "magnetic": T.magnetic([0.1, 0, 1e-9], [1, 2, 3]),
    "larmor": T.larmor([0, 0, -0.1]),
    "dampings": T.damping(0.1) + T.viscous_damping([0.1, 0.2, 0.3]) + T.quadratic_damping(1e-5),
    "spring": T.torsion_spring(0.3, ATTITUDE),
    "control": T.pd_control([1, 2, 3], 0.1, ATTITUDE),
    "wheel": T.gyrostat([0, 25, 1 / 7]),
    "constant": T.constant_space([1, 0, 0]) + T.constant_body([0, 1e-8, 0]),
    "table": T.tabulated([0, 1.5, 3], RNG.normal(size=(3, 3)), "space", "cubic"),
    "order": T.gyrostat([1, 2, 3]) + T.heavy([0, 0, 1]) + T.damping(0.1),
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_laws_are_read_back_as_equal_values(law, tmp_path):
    assert read_back(problem(torque=law), tmp_path).torque == law


def test_forces_are_read_back_as_the_same_values(tmp_path):
    F = ph.force
    pushes = F.constant([0, 0, -9.81]) + F.drag(0.1) + F.quadratic_drag(1 / 3) + F.spring(2, [1, 2, 3])
    pushes += F.central(3.986e14)
    for force in (pushes, F.thrust([1, 2, 3]), F.thrust([1, 2, 3], [0.1, 0, 1e-9])):
        found = read_back(
            problem(ph.Body.disc(0.1, mass=0.2) + ph.Body.sphere(0.1, mass=1), force=force), tmp_path
        )
        assert found.force == force


def test_formulas_are_read_back_with_the_values_of_their_names(tmp_path):
    values = {
        "c": 0.3e-7 * ph.e1 + 2 * ph.e3,
        "k": 0.5e-9,
        "Ω_0": 1e-6 * (ph.e1 ^ ph.e2),
        "M": ph.multivector(RNG.normal(size=8)),
        "s": ph.scalar(1 / 3),
        "quote": 1.0,
    }
    body = T.formula("-c ∧ (~R e3 R) + k Ω + s Ω_0 + quote ⟨M Ω⟩_2", **values)
    space = T.formula("-k L", frame="space", k=0.5e-9)
    found = read_back(problem(torque=body + space), tmp_path).torque
    # The spelling of names may differ; the torque is equal in every bit.
    assert found.at(MOMENTS, START, 0.7) == (body + space).at(MOMENTS, START, 0.7)
    # A rotor is read back as an even multivector, whose products are rounded in another order.
    turn = T.formula("~S Ω S", S=ATTITUDE)
    found = read_back(problem(torque=turn), tmp_path).torque
    apart = found.at(MOMENTS, START) - turn.at(MOMENTS, START)
    assert apart.norm() < 8 * np.finfo(float).eps * START.omega_body.norm()


def test_a_written_scene_is_the_same_motion(tmp_path):
    times = np.arange(11) * 2.0 / 10
    law = T.viscous_damping(0.1) + T.constant_body([0, 0, 1])
    trajectory = ph.simulate(MOMENTS, START, times, law, method="rk4", step=0.01)
    path = tmp_path / "a.toml"
    path.write_text(scene_text(trajectory._origin))
    again = ph.Scene.read(path).run()
    assert again.certificate == trajectory.certificate
    assert (again.rotor == trajectory.rotor).all()
    assert (again.omega_body == trajectory.omega_body).all()


def test_the_method_is_written(tmp_path):
    found = read_back(problem(method="dop853", step=0.01), tmp_path)
    assert (found.method, found.step, found.rtol, found.atol) == ("dop853", 0.01, None, None)
    found = read_back(problem(method="exact", tolerance=1e-7), tmp_path)
    assert (found.method, found.step, found.rtol) == ("auto", None, 1e-7)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"torque": T.function(lambda t, R, W: -W)}, "Python callables cannot be written"),
        ({"force": ph.force.function(lambda t, x, v, R: -x)}, "Python callables cannot be written"),
        ({"torque": T.damping(1) + T.damping(2)}, "two"),
        ({"torque": T.formula("k Ω", k=1) + T.formula("k Ω", k=2, frame="space")}, "`k` has two values"),
        ({"torque": T.formula("F(Ω)", F=MOMENTS)}, "linear map"),
        ({"times": [-2.0, 0.0]}, "needs an output time after its start"),
        ({"tolerance": 2.0}, "tolerance"),
    ],
)
def test_problems_that_no_scene_describes_are_refused(given, why):
    body = ph.Body.sphere(1, mass=1)
    with pytest.raises(UnwritableError, match=why):
        scene_text(problem(body, **given))


# --- documents


def test_an_exact_motion_is_a_scene_alone():
    scene = ph.Scene.read(EXAMPLES / "toutatis.toml")
    expected = {"format": 1, "scene": scene.text, "name": "toutatis.toml"}
    assert document.document(scene) == expected
    assert document.document(scene.run()) == expected
    assert document.document(EXAMPLES / "toutatis.toml") == expected
    free = ph.FreeMotion(MOMENTS, START.rotor, START.omega_body)
    assert set(document.document(free)) == {"format", "scene", "name"}


def test_a_stepped_motion_is_recorded_too():
    trajectory = ph.simulate(MOMENTS, START, np.linspace(0, 5, 101), T.heavy([0.1, 0.2, 0.3]))
    shown = document.document(trajectory)
    rows = rows_of(shown)
    assert rows.shape == (101, 24)
    R, L = trajectory.rotor, trajectory.momentum_space
    columns = [
        trajectory.time[:, np.newaxis],
        R.components,
        trajectory.omega_body.components,
        R(trajectory.omega_body).components,
        (~R)(L).components,
        L.components,
        trajectory.energy[:, np.newaxis],
        trajectory.position.components,
        trajectory.velocity.components,
    ]
    assert np.array_equal(rows, np.concatenate(columns, axis=1))
    # Momenta in the body are those of the inertia map, to the rounding of two rotations.
    np.testing.assert_allclose(rows[:, 11:14], rows[:, 5:8] * [1, 2, 2.5], rtol=0, atol=1e-14)
    about = json.loads(shown["recorded"]["about"])
    assert about["held"]
    assert about["heavy"] == [0.1, 0.2, 0.3]
    assert about["laws"] == [{"name": "heavy", "text": "(0.1, 0.2, 0.3)"}]
    assert about["start"]["rotor"] == START.rotor.components.tolist()
    assert [entry["name"] for entry in about["conserved"]] == list(trajectory.certificate.conserved)


def rows_of(shown):
    return np.frombuffer(unpacked(shown["recorded"]["rows"]), "<f8").reshape(-1, 24)


def interface(name):
    """The names of the fields of an interface in TypeScript, nested ones included."""
    text = (ROOT / "viewer/src/core/core.ts").read_text()
    body = re.search(rf"export interface {name} {{\n(.*?)\n}}", text, flags=re.DOTALL)[1]
    return re.findall(r"^  (\w+)\??:", body, flags=re.MULTILINE), {
        outer: re.findall(r"^    (\w+):", inner, flags=re.MULTILINE)
        for outer, inner in re.findall(r"^  (\w+): {\n(.*?)^  }", body, flags=re.MULTILINE | re.DOTALL)
    }


def test_the_format_is_that_of_the_viewer():
    scene = ph.Scene.read(EXAMPLES / "kovalevskaya.toml")
    about = json.loads(document.document(scene.run())["recorded"]["about"])
    fields, inner = interface("About")
    assert sorted(about) == sorted(fields)
    assert sorted(about["body"]) == sorted(inner["body"])
    trajectory = ph.simulate(MOMENTS, START, [0, 1], method="rk4", step=0.1)
    about = json.loads(document.document(trajectory)["recorded"]["about"])
    # The page uses some of the facts.
    assert set(inner["free"]) <= set(about["free"])
    top = ph.Inertia.from_principal_moments(1, 1, 0.5)
    trajectory = ph.simulate(top, START, [0, 1], T.heavy([0, 0, 1]), method="rk4", step=0.1)
    about = json.loads(document.document(trajectory)["recorded"]["about"])
    assert set(inner["top"]) <= set(about["top"])
    text = (ROOT / "viewer/src/core/core.ts").read_text()
    assert "export const ROW = 24;" in text
    offsets = dict(re.findall(r"^  (\w+): (\d+),$", text, flags=re.MULTILINE))
    assert [int(offsets[name]) for name in ("time", "rotor", "omegaBody", "omegaSpace", "momentumBody")] == [
        *(0, 1, 5, 8, 11)
    ]
    assert [int(offsets[name]) for name in ("momentumSpace", "energy", "position", "velocity")] == [
        *(14, 17, 18, 21)
    ]


def test_rows_are_close_where_a_body_turns_fast():
    trajectory = ph.simulate(MOMENTS, ph.State(START.rotor, [0, 30, 1]), [1.0, 2.0], T.viscous_damping(0.1))
    rows = rows_of(document.document(trajectory))
    assert rows[0, 0] == 0
    assert rows[-1, 0] == 2
    turns = 2 * np.arccos(np.abs(np.einsum("ij,ij->i", rows[1:, 1:5], rows[:-1, 1:5])).clip(max=1))
    # Under damping alone the rate is largest at the start.
    assert turns.max() <= recording._TURN
    assert rows[:, 1:5] == pytest.approx(trajectory.at(rows[:, 0]).rotor.components, abs=1e-12)


def test_a_long_motion_is_thinned():
    times = np.linspace(0, 100, 50_001)
    trajectory = ph.simulate(MOMENTS, START, times, T.viscous_damping(0.1), method="rk4", step=0.01)
    rows = rows_of(document.document(trajectory))
    assert len(rows) == 20_000
    assert (rows[0, 0], rows[-1, 0]) == (0, 100)
    assert np.isin(rows[:, 0], times).all()
    # Evenly: intervals differ by one output time at most.
    assert set(np.diff(np.searchsorted(times, rows[:, 0]))) == {2, 3}


def test_a_motion_that_an_event_ended_is_shown_to_its_end():
    flip = ph.event.spin(ph.e3 ^ ph.e1, terminal=True)
    start = ph.State(ph.Rotor.identity(), [0.1, 1, 0.1])
    trajectory = ph.simulate(MOMENTS, start, np.linspace(0, 50, 501), events=flip)
    assert trajectory.time[-1] < 50
    scene = document.scene_of(document.document(trajectory))
    assert scene.times[-1] == trajectory.time[-1]
    assert len(scene.times) == len(trajectory.time)


def test_equal_times_are_kept_once():
    trajectory = ph.simulate(MOMENTS, START, [0, 1, 1, 2], T.viscous_damping(0.1))
    trajectory = ph.Trajectory(**{**vars(trajectory), "_motion": None})
    assert rows_of(document.document(trajectory))[:, 0].tolist() == [0, 1, 2]


def test_a_motion_under_a_python_function_is_recorded_alone():
    shown = document.document(MOMENTS, START, lambda t, R, W: -0.1 * W, duration=3)
    assert "scene" not in shown
    assert rows_of(shown)[-1, 0] == 3
    assert json.loads(shown["recorded"]["about"])["laws"] == [{"name": "function", "text": ""}]


def test_the_document_has_the_mesh_of_the_scene(tmp_path):
    path = EXAMPLES / "t-handle.toml"
    shown = document.document(path)
    assert {name: unpacked(x) for name, x in shown["files"].items()} == {
        "t-handle.stl": (EXAMPLES / "t-handle.stl").read_bytes()
    }
    scene = ph.Scene.read(path)
    assert document.scene_of(shown).body == scene.body
    # In a parent folder, and by an absolute path.
    (tmp_path / "scenes/own").mkdir(parents=True)
    shutil.copy(EXAMPLES / "t-handle.stl", tmp_path)
    for name in ("../../t-handle.stl", str(tmp_path / "t-handle.stl")):
        moved = tmp_path / "scenes/own/a.toml"
        moved.write_text(scene.text.replace("t-handle.stl", name))
        shown = document.document(moved)
        assert list(shown["files"]) == [name]
        assert document.scene_of(shown).body == scene.body


def test_a_stepped_mesh_body_is_drawn_as_its_mesh(tmp_path):
    shutil.copy(EXAMPLES / "t-handle.stl", tmp_path)
    path = tmp_path / "a.toml"
    text = (EXAMPLES / "t-handle.toml").read_text()
    path.write_text(text + '\n[method]\nname = "rk4"\nstep = "1 ms"\n')
    about = json.loads(document.document(ph.Scene.read(path).run())["recorded"]["about"])
    assert about["body"]["mesh"] is True


@pytest.mark.parametrize(
    ("body", "solid", "at"),
    [
        ('solid = "box"\nlengths = ["10 cm", 0.05, "2 cm"]', {"lengths": [0.1, 0.05, 0.02]}, 0),
        ('solid = "cone"\nradius = "3 cm"\nheight = "8 cm"', {"radius": 0.03, "height": 0.08}, 0),
        (
            'solid = "torus"\nmajor_radius = 2\nminor_radius = "1 m"',
            {"major_radius": 2, "minor_radius": 1},
            0,
        ),
    ],
)
def test_solids_have_their_sizes(body, solid, at, tmp_path):
    path = tmp_path / "a.toml"
    weight = '[gravity]\nacceleration = 9.81\npivot = [0, 0, "-5 cm"]\n[run]'
    text = SCENE.replace("moments = [1, 2, 3]", f"{body}\nmass = 2").replace("[run]", weight)
    path.write_text(text + 'method = "rk4"\nstep = "10 ms"\n')
    about = json.loads(document.document(ph.Scene.read(path).run())["recorded"]["about"])
    found = dict(about["body"]["solid"])
    assert found.pop("kind") in body
    assert found == solid
    # The origin of the solid is 5 cm above the fixed point.
    assert about["body"]["solid_at"] == pytest.approx([0, 0, 0.05], abs=1e-17)


def test_an_invalid_scene_is_given_unchanged(tmp_path):
    for text in ("what is this", '[body]\nmesh = "absent.stl"', "body = 3", '[body]\nmesh = "a\\u0000b"'):
        shown = document.of_text(text, tmp_path / "bad.toml")
        assert shown == {"format": 1, "scene": text, "name": "bad.toml"}
        with pytest.raises(ph.SceneError, match=r"^bad.toml:\d+:\d+: error"):
            document.scene_of(shown)


def test_values_that_cannot_be_shown_are_refused():
    def refused(kind, match, *arguments, **named):
        with pytest.raises(kind, match=match):
            document.document(*arguments, **named)

    scene = ph.Scene.read(EXAMPLES / "toutatis.toml")
    refused(TypeError, "cannot show a value of type int", 3)
    refused(TypeError, "give state", MOMENTS)
    refused(TypeError, "torque cannot be given for a Scene", scene, torque=T.damping(1))
    refused(TypeError, "duration cannot be given for a Scene, which has its own", scene, duration=3)
    refused(TypeError, "state and torque cannot be given for 'a.toml'", "a.toml", START, T.damping(1))
    refused(TypeError, "state must be a State, got list", MOMENTS, [0, 0, 1])
    refused(ValueError, "duration is -1", MOMENTS, START, duration=-1)
    refused(ValueError, "batch", MOMENTS, ph.State(START.rotor, np.ones((2, 3))), duration=1)
    refused(ValueError, "batch", MOMENTS, START, T.damping(np.array([1.0, 2.0])))
    refused(ValueError, "batch", ph.FreeMotion(MOMENTS, START.rotor, np.ones((2, 3))))
    many = ph.simulate(MOMENTS, ph.State(START.rotor, np.ones((2, 3))), [0, 1])
    refused(ValueError, "one body", many)
    backwards = ph.simulate(MOMENTS, START, [-1, 0], T.viscous_damping(0.1))
    refused(ValueError, "this one has none", backwards)


def test_a_motion_without_an_end_is_shown_for_20_turns():
    shown = document.document(MOMENTS, ph.State(START.rotor, [0, 0, 4 * np.pi]))
    assert document.scene_of(shown).times[-1] == pytest.approx(10, rel=1e-15)
    rest = document.document(MOMENTS, ph.State(START.rotor, [0, 0, 0]), T.constant_body([1, 0, 0]))
    assert document.scene_of(rest).times[-1] == 10


@pytest.mark.parametrize(
    ("motion", "law"),
    [
        (
            ph.LagrangeTop(ph.Inertia.from_principal_moments(1, 1, 0.5), ATTITUDE, [1, 2, 3], [0, 0, 2]),
            "heavy",
        ),
        (ph.DampedTop(MOMENTS, ATTITUDE, [1, 2, 3], 0.1), "damping"),
        (
            ph.LarmorSphere(ph.Inertia.from_principal_moments(1, 1, 1), ATTITUDE, [1, 2, 3], [0, 1, 0]),
            "larmor",
        ),
    ],
)
def test_closed_forms_are_shown_as_the_scene_they_solve(motion, law):
    scene = document.scene_of(document.document(motion, duration=2))
    assert [one.name for one in scene.torque.laws] == [law]
    trajectory = scene.run()
    assert trajectory.certificate.method == "exact"
    at = motion.at(2.0)
    # Both are exact to the rounding of an angle of about 10 rad.
    assert (trajectory.rotor[-1] - at.rotor).norm() < 1e-14


def test_packed_text_is_unpacked():
    content = RNG.bytes(1000)
    assert unpacked(packed(content)) == content
    assert packed(content) == packed(content)


# --- netCDF files


@pytest.fixture
def saved(tmp_path):
    pytest.importorskip("h5netcdf")
    start = ph.State(START.rotor, [0.1, 1, 0.1])
    flips = ph.event.spin(ph.e3 ^ ph.e1)
    trajectory = ph.simulate(MOMENTS, start, np.linspace(0, 20, 41), T.heavy([0.1, 0.2, 0.3]), events=flips)
    trajectory.attributes["title"] = "Saved"
    trajectory.save(tmp_path / "a.nc")
    return trajectory, tmp_path / "a.nc"


def test_our_files_are_read_back_to_the_last_bit(saved):
    trajectory, path = saved
    found = ph.Trajectory.read(path)
    for name in ("rotor", "omega_body", "momentum_space", "position", "velocity"):
        assert (getattr(found, name) == getattr(trajectory, name)).all()
    assert np.array_equal(found.time, trajectory.time)
    assert np.array_equal(found.energy, trajectory.energy)
    assert found.inertia == trajectory.inertia
    assert found.certificate == trajectory.certificate
    assert found.attributes == {"title": "Saved"}
    (event,), (before,) = found.events, trajectory.events
    assert len(before) > 1
    assert event.name == before.name
    assert np.array_equal(event.time, before.time)
    assert np.array_equal(event.rising, before.rising)
    assert (event.rotor == before.rotor).all()


def test_a_file_without_a_scene_is_recorded_alone(saved):
    _, path = saved
    shown = document.document(path)
    assert set(shown) == {"format", "name", "recorded"}
    assert document.title_of(shown) == "Saved"


def test_a_file_contains_its_scene(tmp_path):
    pytest.importorskip("h5netcdf")
    for name, expected in (("kovalevskaya", {"recorded"}), ("toutatis", set())):
        scene = ph.Scene.read(EXAMPLES / f"{name}.toml")
        scene.run().save(tmp_path / "a.nc")
        shown = document.document(tmp_path / "a.nc")
        assert shown["scene"] == scene.text
        assert set(shown) - {"format", "name", "scene"} == expected
    # Its mesh is found only beside it.
    ph.Scene.read(EXAMPLES / "t-handle.toml").run().save(tmp_path / "a.nc")
    assert "scene" not in document.document(tmp_path / "a.nc")
    shutil.copy(EXAMPLES / "t-handle.stl", tmp_path)
    assert "t-handle.stl" in document.document(tmp_path / "a.nc")["files"]


def test_a_motion_that_is_not_finite_is_refused(saved):
    h5py = pytest.importorskip("h5py")
    trajectory, path = saved
    read, energy = ph.Trajectory.read(path), trajectory.energy
    energy[3] = np.nan
    message = f"this motion has others at t = {trajectory.time[3]:g} s"
    with pytest.raises(ValueError, match=message):
        recording.recorded(dataclasses.replace(read, energy=energy), None, False)
    with h5py.File(path, "r+") as file:
        file["energy"][3] = np.nan
    with pytest.raises(ValueError, match="energy must be finite, got nan at row 3"):
        document.document(path)


def test_truncated_files_are_refused(saved):
    _, path = saved
    content = path.read_bytes()
    for length in (0, 100, len(content) // 2, len(content) - 1):
        path.write_bytes(content[:length])
        with pytest.raises(OSError, match=r"a.nc: cannot be read as a netCDF file"):
            ph.Trajectory.read(path)


def test_other_files_are_refused(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    with pytest.raises(FileNotFoundError, match=r"absent.nc: no such file"):
        ph.Trajectory.read(tmp_path / "absent.nc")
    (tmp_path / "folder.nc").mkdir()
    with pytest.raises(OSError, match=r"folder.nc: not a regular file"):
        ph.Trajectory.read(tmp_path / "folder.nc")
    (tmp_path / "noise.nc").write_bytes(b"noise")
    with pytest.raises(OSError, match=r"noise.nc: cannot be read as a netCDF file"):
        ph.Trajectory.read(tmp_path / "noise.nc")
    with pytest.importorskip("h5py").File(tmp_path / "groups.nc", "w") as file:
        file.create_group("attitude")
    with pytest.raises(
        OSError, match=r"groups.nc: cannot be read as a netCDF file: 'attitude' is not a variable"
    ):
        ph.Trajectory.read(tmp_path / "groups.nc")
    xarray.Dataset({"time": ("time", [1.0])}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(ValueError, match=r"other.nc: is not a motion that polhode wrote: .* is missing"):
        ph.Trajectory.read(tmp_path / "other.nc")
    many = ph.simulate(MOMENTS, ph.State(START.rotor, np.ones((2, 4, 3))), [0, 1])
    many.save(tmp_path / "many.nc")
    with pytest.raises(ValueError, match="batch of bodies"):
        ph.Trajectory.read(tmp_path / "many.nc")


def test_the_problem_is_not_pickled():
    import pickle

    trajectory = ph.simulate(MOMENTS, START, [0, 1], lambda t, R, W: -0.1 * W)
    assert pickle.loads(pickle.dumps(trajectory))._origin is None
    assert isinstance(trajectory._origin.torque, Torque)
