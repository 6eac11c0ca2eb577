"""Torques, forces and methods of scenes: equality with Python, reports and errors."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

import polhode as ph
from command_line import SCENE, polhode, summary_of
from polhode._report.summary import QUANTITIES, as_text, summary


def with_tables(tables, scene=SCENE):
    return scene.replace("[run]", f"{tables}\n[run]")


def read(tmp_path, text):
    path = tmp_path / "a.toml"
    path.write_text(text)
    return ph.Scene.read(path)


REST = ph.Rotor.from_components([0.6, 0, 0, -0.8])
LAWS = {
    "damping = 0.1": ph.torque.damping(0.1),
    "viscous_damping = [1, 2, 3]": ph.torque.viscous_damping([1, 2, 3]),
    "quadratic_damping = 0.5": ph.torque.quadratic_damping(0.5),
    "gravity_gradient = { rate = 0.5, eccentricity = 0.1, mean_anomaly = 2 }": ph.torque.gravity_gradient(
        0.5, 0.1, 2.0
    ),
    "constant_body = [1, 2, 3]": ph.torque.constant_body([1, 2, 3]),
    "constant_space = [1, 2, 3]": ph.torque.constant_space([1, 2, 3]),
    "magnetic = { dipole = [1, 0, 0], field = [0, 1, 2] }": ph.torque.magnetic([1, 0, 0], [0, 1, 2]),
    'radiation_pressure = { area = "20 m^2", offset = ["50 cm", 0, 0], sun = "e2 + e3", pressure = 0.1 }': (
        ph.torque.radiation_pressure(20, [0.5, 0, 0], ph.e2 + ph.e3, pressure=0.1)
    ),
    "torsion_spring = { stiffness = 2, rest = { rotor = [0.6, 0, 0, -0.8] } }": ph.torque.torsion_spring(
        2, REST
    ),
    "gyrostat = [0, 1, 0]": ph.torque.gyrostat([0, 1, 0]),
    "pd_control = { kp = 1, kd = [1, 2, 3], target = { rotor = [0.6, 0, 0, -0.8] } }": ph.torque.pd_control(
        1, [1, 2, 3], REST
    ),
    "larmor = [0, 0, 1]": ph.torque.larmor([0, 0, 1]),
    "tabulated = { times = [0, 1, 2, 3], torques = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 0]], "
    'frame = "space", kind = "cubic" }': ph.torque.tabulated(
        [0, 1, 2, 3], [[0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 0]], "space", "cubic"
    ),
    'tabulated = { kind = "previous", times = [0, 1, 2], torques = [[0, 0, 1], [1, 0, 0], [0, 0, 0]] }': (
        ph.torque.tabulated([0, 1, 2], [[0, 0, 1], [1, 0, 0], [0, 0, 0]], kind="previous")
    ),
    "heavy = [1, 2, 3]": ph.torque.heavy([1, 2, 3]),
    'torque_space = "-L"': ph.torque.formula("-L", frame="space"),
}


@pytest.mark.parametrize("text", LAWS, ids=lambda text: text.split(" ")[0])
def test_a_law_of_a_scene_equals_that_of_python(text, tmp_path):
    scene = read(tmp_path, with_tables(f"[torque]\n{text}"))
    assert scene.torque == LAWS[text]
    assert repr(scene.torque) == repr(LAWS[text])
    assert pickle.loads(pickle.dumps(scene.torque)) == scene.torque
    body = scene.body.inertia_about(0) if scene.held else scene.body
    again = ph.simulate(body, scene.state, scene.times, LAWS[text])
    np.testing.assert_array_equal(scene.run().rotor.components, again.rotor.components)


def test_a_formula_uses_definitions(tmp_path):
    define = '[define]\nk = "2 N m s"\nc = "e1 + 2 e3"\n"V(a)" = "k a"\n[body]'
    formula = "-V(Ω) - 2 N m c∧(~R e3 R)"
    text = with_tables(f'[torque]\ntorque_body = "{formula}"').replace("[body]", define)
    scene = read(tmp_path, text)
    law = ph.torque.formula("-2*Ω - 2*c∧(~R e3 R)", c=ph.e1 + 2 * ph.e3)
    expected = ph.simulate(scene.body, scene.state, scene.times, law)
    np.testing.assert_allclose(scene.run().rotor.components, expected.rotor.components, rtol=0, atol=1e-12)
    assert scene.formulas == (formula,)


def test_gravity_and_torques_add_up(tmp_path):
    text = SCENE.replace("[1, 2, 3]", "[1, 2, 3]\nmass = 2\ncenter_of_mass = [0, 0, 1]")
    scene = read(tmp_path, with_tables("[gravity]\nacceleration = 5\n[torque]\ndamping = 0.1", text))
    assert scene.torque == ph.torque.heavy([0, 0, 10]) + ph.torque.damping(0.1)
    assert scene.held


def test_forces_move_the_body(tmp_path):
    text = SCENE.replace("[1, 2, 3]", "[1, 2, 3]\nmass = 2").replace(
        "spin", 'position = [1, 2, 3]\nvelocity = ["1 m/s", 0, 0]\nspin'
    )
    table = (
        "[force]\nconstant = [0, 0, 1]\nthrust = { force = [1, 0, 0], at = [0, 1, 0] }\ndrag = 0.1\n"
        "quadratic_drag = 0.2\nspring = { stiffness = 3, anchor = [0, 0, 1] }\ncentral = 4"
    )
    scene = read(tmp_path, with_tables(table, text))
    force = ph.force.constant([0, 0, 1]) + ph.force.thrust([1, 0, 0], at=[0, 1, 0]) + ph.force.drag(0.1)
    force += ph.force.quadratic_drag(0.2) + ph.force.spring(3, [0, 0, 1]) + ph.force.central(4)
    expected = ph.simulate(scene.body, scene.state, scene.times, force=force)
    trajectory = scene.run()
    np.testing.assert_array_equal(trajectory.position.components, expected.position.components)
    np.testing.assert_array_equal(trajectory.rotor.components, expected.rotor.components)
    motion = summary_of(tmp_path / "a.toml")["motion"]
    assert motion["position"]["start"] == [1, 2, 3]
    assert motion["velocity"]["end"] == trajectory.velocity.components[-1].tolist()
    assert "thrust([1.0, 0.0, 0.0], at=[0.0, 1.0, 0.0])" in polhode("run", tmp_path / "a.toml").stdout


def test_the_method_is_read_from_its_table(tmp_path):
    scene = read(tmp_path, SCENE + '[method]\nname = "dop853"\nrtol = 1e-6\natol = 1e-5\n')
    assert (scene.method, scene.rtol, scene.atol) == ("dop853", 1e-6, 1e-5)
    assert scene.run().certificate.method == "dop853"


# --- reports


def test_a_controller_reports_its_distance(tmp_path):
    target = '{ plane = "e1e2", angle = "90 deg" }'
    table = f"[torque]\npd_control = {{ kp = 4, kd = 6, target = {target} }}"
    scene = read(tmp_path, with_tables(table).replace('"1 s"', '"60 s"'))
    result = summary_of(scene.path)
    assert result["motion"]["kind"] == "torqued"
    assert result["motion"]["from_target"]["start"] == pytest.approx(np.pi / 2, rel=1e-12)
    assert result["motion"]["from_target"]["end"] < 1e-6
    page = polhode("run", scene.path).stdout
    assert "from the target   90° at the start" in page
    assert "pd_control        kp = 4 N m; kd = 6 N m s; target = 0.707107, 0, 0, -0.707107" in page


def test_damping_reports_the_free_motion_and_its_half_life(tmp_path):
    read(tmp_path, with_tables("[torque]\ndamping = 0.5"))
    result = summary_of(tmp_path / "a.toml")
    assert result["motion"]["regime"] == "short-axis mode"
    assert result["motion"]["halved_after"] == pytest.approx(np.log(2) / 0.5)
    assert result["run"]["method"] == "exact"
    assert result["motion"]["changes"]["rate"]["end"] < result["motion"]["changes"]["rate"]["start"]
    assert "half-life of ω    1.38629 s" in polhode("run", tmp_path / "a.toml").stdout


def test_negative_damping_reports_the_time_in_which_the_rate_doubles(tmp_path):
    read(tmp_path, with_tables("[torque]\ndamping = -0.5"))
    page = polhode("run", tmp_path / "a.toml").stdout
    assert "free motion, sped up exponentially" in page
    assert "doubling time of ω 1.38629 s" in page
    assert "half-life" not in page
    motion = summary_of(tmp_path / "a.toml")["motion"]
    assert motion["halved_after"] is None
    assert motion["doubled_after"] == pytest.approx(np.log(2) / 0.5)
    read(tmp_path, with_tables("[torque]\ndamping = 0"))
    page = polhode("run", tmp_path / "a.toml").stdout
    assert "half-life" not in page
    assert "none: the rates g add up to 0" in page


# A closed form, a dissipative torque, a wheel and a held body; the other laws have the same kinds of reports.
USUAL = ("damping", "heavy")


@pytest.mark.parametrize(
    "text",
    [
        "",
        *(
            text if text.split(" ")[0] in USUAL else pytest.param(text, marks=pytest.mark.slow)
            for text in LAWS
        ),
    ],
    ids=lambda text: text.split(" ")[0] or "free",
)
def test_every_kind_has_a_page_a_document_and_figures(text, tmp_path):
    pytest.importorskip("xarray")
    read(tmp_path, with_tables(f"[torque]\n{text}" if text else ""))
    done = polhode("run", "a.toml", "-o", "out.nc", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    result = summary_of(tmp_path / "a.toml")
    names = [law["law"] for law in result["torques"]]
    assert names == ([text.split(" ")[0].replace("torque_space", "formula")] if text else [])
    free = names in ([], ["damping"], ["gyrostat"])
    assert (tmp_path / f"out-{'polhode' if free else 'axis'}.png").exists()


# --- errors


@pytest.mark.parametrize("command", ["run", "check"])
def test_an_error_in_a_formula_is_shown_at_its_place(command, tmp_path):
    (tmp_path / "a.toml").write_text(with_tables('[torque]\ntorque_body = "-3 (Ω_B·b) ∧ e3"'))
    done = polhode(command, "a.toml", cwd=tmp_path)
    assert done.returncode == 3
    assert done.stderr.startswith("a.toml:7:24: error: `b` has no value")
    caret = done.stderr.splitlines()[3]
    assert caret.index("^") == done.stderr.splitlines()[2].index("b)")


# Steps that are too long for a conserved quantity. Those of rk4 keep L where the torque is zero.
DRIFTING = [
    ("energy", "heavy = [3, 2, 1]"),
    ("energy", "magnetic = { dipole = [3, 2, 1], field = [1, 0, 0] }"),
    ("energy", "gyrostat = [3, 2, 1]"),
    ("jacobi_integral", "gravity_gradient = { rate = 2 }"),
    ("kovalevskaya_integral", "heavy = [3, 0, 0]"),
]


@pytest.mark.parametrize(("name", "law"), DRIFTING)
def test_a_drift_past_the_bound_exits_with_4(name, law, tmp_path):
    scene = SCENE.replace("[1, 2, 3]", "[2, 2, 1]") if name.startswith("kov") else SCENE
    method = 'drift_bound = 1e-9\n[method]\nname = "rk4"\nstep = "0.1 s"\n'
    (tmp_path / "a.toml").write_text(with_tables(f"[torque]\n{law}", scene) + method)
    done = polhode("run", "a.toml", "--json", cwd=tmp_path)
    assert done.returncode == 4
    result = json.loads(done.stdout)
    assert result["conserved"][name]["drift"] > 1e-9
    assert result["run"]["drift_within_bound"] is False
    assert "FAILED" in polhode("run", "a.toml", cwd=tmp_path).stdout


@pytest.mark.parametrize("drift", [1.0, np.nan])
@pytest.mark.parametrize("name", QUANTITIES)
def test_the_bound_applies_to_every_quantity(name, drift, tmp_path):
    scene = read(tmp_path, SCENE)
    trajectory = scene.run()
    assert summary(scene, trajectory)["run"]["drift_within_bound"]
    proof = trajectory.certificate
    drifts = {"first": 0.0, name: drift, "last": 0.0}
    wrong = replace(trajectory, certificate=replace(proof, conserved={name: 1.0}, drift=drifts))
    failed = summary(scene, wrong)
    assert not failed["run"]["drift_within_bound"]
    assert "FAILED" in as_text(failed)


def test_a_method_that_does_not_fit_exits_with_1(tmp_path):
    (tmp_path / "a.toml").write_text(
        with_tables("[torque]\nquadratic_damping = 1") + 'method = "kahan_li8"\n'
    )
    done = polhode("run", "a.toml", cwd=tmp_path)
    assert done.returncode == 1
    assert "kahan_li8 does not support torques that depend on the angular velocity" in done.stderr


def test_a_short_table_exits_with_1_and_its_times(tmp_path):
    (tmp_path / "a.toml").write_text(
        with_tables("[torque]\ntabulated = { times = [0, 0.5], torques = [[0, 0, 1], [0, 0, 1]] }")
    )
    done = polhode("run", "a.toml", cwd=tmp_path)
    assert done.returncode == 1
    assert "the table of torques spans 0 s to 0.5 s" in done.stderr
