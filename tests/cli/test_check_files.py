"""`polhode check` of robot files and meshes: a line for each link, places, doubts about units, exit codes."""

import functools
import json
import re
import shutil

import pytest

import polhode as ph
from command_line import EXAMPLES, ROOT, polhode
from meshes import cube, write_binary_stl


@pytest.fixture
def check(command):
    """Return a function that runs the subcommand in this process, in a folder of its own."""
    return functools.partial(command, "check")


GOOD = '<inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial>'
BAD = GOOD.replace('"2.5"', '"4"')
IMPROBABLE = GOOD.replace('mass value="2"', 'mass value="2e6"')


def robot(folder, *inertials, name="robot.urdf"):
    links = "".join(f'<link name="link{k}">\n{text}</link>\n' for k, text in enumerate(inertials))
    (folder / name).write_text(f'<robot name="r">\n{links}</robot>\n')
    return name


def test_each_link_has_a_line(tmp_path):
    done = polhode("check", robot(tmp_path, GOOD, ""), cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    body = ph.read_urdf(tmp_path / "robot.urdf")["link0"]
    assert done.stdout.splitlines() == [
        f"robot.urdf: link0: ok, {body!r}",
        "robot.urdf: link1: ok, no inertial element",
    ]


def test_a_bad_link_has_its_place_and_the_others_are_checked(tmp_path, check):
    done = check(robot(tmp_path, GOOD, BAD, IMPROBABLE))
    assert done.returncode == 3
    good, bad, improbable = done.stdout.splitlines()
    assert good.startswith("robot.urdf: link0: ok, Body(mass 2 kg")
    assert bad == "robot.urdf: link1: error, see line 4"
    assert improbable.startswith("robot.urdf: link2: ok")
    assert "robot.urdf:5:28: error: no body has this inertia: principal moments 1, 2, 4 kg m²" in done.stderr
    assert "by 1 kg m² (25 %). Probable slip: " in done.stderr
    assert (
        "robot.urdf:7:30: warning: a body of 2e+06 kg with this inertia is denser than osmium" in done.stderr
    )
    assert "^^^^^^^^" in done.stderr


def test_warnings_do_not_fail(tmp_path, check):
    done = check(robot(tmp_path, IMPROBABLE))
    assert done.returncode == 0
    assert "warning" in done.stderr


def test_the_format_follows_from_the_root_element(tmp_path, check):
    (tmp_path / "a.xml").write_text(
        '<mujoco><worldbody><body name="a"><geom size="1"/></body></worldbody></mujoco>'
    )
    (tmp_path / "b.sdf").write_text('<sdf version="1.9"><model name="m"><link name="b"/></model></sdf>')
    robot(tmp_path, GOOD, name="c.xml")
    (tmp_path / "d.xml").write_text("<html/>")
    done = check("--json", *(f"{x}" for x in ("a.xml", "b.sdf", "c.xml", "d.xml")))
    assert done.returncode == 3
    *good, bad = json.loads(done.stdout)
    assert [(one["format"], one["ok"], one["links"][0]["name"]) for one in good] == [
        ("MJCF", True, "a"),
        ("SDF", True, "b"),
        ("URDF", True, "link0"),
    ]
    assert good[1]["links"][0]["body"] is None
    assert not bad["ok"]
    assert bad["errors"].startswith(
        "d.xml:1:1: error: the root element must be <robot> (URDF) or <mujoco> (MJCF) or <sdf> (SDF)"
    )


def test_the_guide_shows_what_is_printed(tmp_path, check):
    guide = (ROOT / "docs/motion.md").read_text()
    (text,) = re.findall(r"<robot .*?</robot>\n", guide, flags=re.DOTALL)
    (shown,) = re.findall(r"\$ polhode check arm.urdf\n(.*?)```", guide, flags=re.DOTALL)
    (tmp_path / "arm.urdf").write_text(text.replace('izz="0.04"', 'izz="0.4"'))
    done = check("arm.urdf")
    assert done.stdout + done.stderr == shown


@pytest.mark.parametrize("name", ["absent.urdf", "absent.stl"])
def test_missing_files(name, tmp_path, check):
    done = check(name)
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == f"{name}: error: no such file\n"


# --- meshes


@pytest.mark.parametrize(
    ("side", "options", "parts"),
    [
        (0.2, (), []),
        (0.2, ("--mass", "8"), []),
        # 1 g to 1 kg in mm, read as metres.
        (150, (), ["150 x 150 x 150 m, longer than 100 m", 'length_unit = "mm"', "scale=0.001"]),
        (50, ("--mass", "0.1"), ["8e-07 kg/m³, less than"]),
        (0.02, ("--mass", "1"), ["1.25e+05 kg/m³, more than osmium (22590 kg/m³)"]),
    ],
)
def test_meshes_of_improbable_size_are_questioned(side, options, parts, tmp_path, check):
    write_binary_stl(tmp_path / "cube.stl", side * cube())
    done = check("cube.stl", *options)
    assert done.returncode == 0
    assert done.stdout.startswith("cube.stl: ok, ")
    assert f"a box of {side:g} x {side:g} x {side:g} m" in done.stdout
    assert done.stderr.count("cube.stl: warning: mesh") == bool(parts)
    for part in parts:
        assert part in done.stderr


def test_a_mesh_that_is_not_closed_is_an_error(tmp_path, check):
    write_binary_stl(tmp_path / "cube.stl", cube()[1:])
    done = check("cube.stl")
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.startswith("cube.stl: error: ")
    assert "open" in done.stderr


@pytest.mark.parametrize("mass", ["0", "-1", "nan", "1 kg"])
def test_a_mass_is_a_positive_number(mass, tmp_path, check):
    done = check("cube.stl", f"--mass={mass}")
    assert done.returncode == 2
    assert f"mass must be a positive number of kg, got '{mass}'" in done.stderr


@pytest.mark.parametrize(
    ("unit", "amount", "parts"),
    [
        ('length_unit = "mm"', 'density = "7.85 g/cm^3"', []),
        ("", 'density = "7.85 g/cm^3"', ["mesh is 120 x 86 x 24 m, longer", "which is now the metre"]),
        ("length_unit = 0.01 # cm", "mass = 0.3", []),
        ('length_unit = "km"', "mass = 1e14", []),
        ('length_unit = "um"', "mass = 0.3", ["more than osmium", 'length_unit, which is now "um"']),
        ('length_unit = "mm"', "density = 7.85e6", ["7.85e+06 kg/m³, more than osmium"]),
    ],
)
def test_meshes_of_scenes_name_the_key_of_the_unit(unit, amount, parts, tmp_path, check):
    shutil.copy(EXAMPLES / "t-handle.stl", tmp_path)
    (tmp_path / "a.toml").write_text(
        f'# mesh = "x"\n[body]\nmesh = "t-handle.stl"\n{unit}\n{amount}\n'
        "[initial]\nspin = { vector = [1, 0, 0] }\n[run]\nduration = 1\nsamples = 2\n"
    )
    done = check("a.toml")
    assert done.returncode == 0
    assert done.stdout.startswith("a.toml: ok, ")
    for part in parts:
        assert part in done.stderr
    assert done.stderr.count("a.toml:3:1: warning: mesh ") == bool(parts)
    assert ("\n3 | mesh = " in done.stderr) == bool(parts)
    (facts,) = json.loads(check("--json", "a.toml").stdout)
    assert len(facts.get("warnings", [])) == bool(parts)


def test_a_mass_that_is_not_given_is_not_shown(tmp_path, check):
    scene = "[body]\nmoments = [1, 2, 2.5]\n{}\n[initial]\nspin.vector = [0, 0, 1]\n[run]\nduration = 1\n"
    (tmp_path / "free.toml").write_text(scene.format(""))
    (tmp_path / "heavy.toml").write_text(scene.format("mass = 1"))
    free, heavy = check("free.toml", "heavy.toml").stdout.splitlines()
    assert free.startswith("free.toml: ok, Inertia(principal moments 1, 2, 2.5 kg m²) without a mass, ")
    assert heavy.startswith("heavy.toml: ok, Body(mass 1 kg, centre of mass 0 m, moments 1, 2, 2.5 kg m²), ")


def test_bare_angles_beyond_a_turn_are_doubted(tmp_path, check):
    scene = (
        "[body]\nmoments = [1, 2, 2.5]\n[initial]\n"
        'attitude = { plane = "e1e2", angle = 30 }  # angle = 40\n'
        'spin = { vector = [0, 0, 1] }\n[run]\nduration = "1 s"\n'
    )
    (tmp_path / "degrees.toml").write_text(scene)
    (tmp_path / "radians.toml").write_text(scene.replace("30", "-3.1"))
    done = check("degrees.toml", "radians.toml")
    assert done.returncode == 0
    assert 'degrees.toml:4:38: warning: 30 rad is more than a turn; for degrees write "30 deg"' in done.stderr
    assert done.stderr.count("warning") == 1
