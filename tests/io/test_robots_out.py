"""URDF and MJCF files of bodies, against closed forms, and as MuJoCo reads them."""

from xml.etree import ElementTree

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES
from polhode._cli.main import main

# A box with sides 1, 2, 3 m, turned by 50° about z, then 40° about y, then 30° about x, and its moments.
MASS, CENTER = 5.0, [1.0, -2.0, 0.25]
MOMENTS = MASS / 12 * np.array([2.0**2 + 3**2, 3.0**2 + 1**2, 1.0**2 + 2**2])


def about(k, degrees):
    """The matrix of a turn about a coordinate axis."""
    (c, s), i, j = (np.cos(np.radians(degrees)), np.sin(np.radians(degrees))), (k + 1) % 3, (k + 2) % 3
    matrix = np.eye(3)
    matrix[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
    return matrix


TURN = about(0, 30) @ about(1, 40) @ about(2, 50)
MATRIX = TURN @ np.diag(MOMENTS) @ TURN.T
BOX = ph.Body.box([1, 2, 3], mass=MASS).moved(ph.Rotor.from_matrix(TURN), CENTER)
# A few roundings of entries up to the largest moment, 5.4 kg m².
CLOSE = {"rtol": 0, "atol": 1e-14 * MOMENTS.max()}


def floats(text):
    return [float(word) for word in text.split()]


def matrix_of(quaternion):
    """The rotation matrix of a quaternion w, x, y, z by the textbook."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_urdf_has_the_closed_form_of_a_tilted_box(tmp_path):
    ph.io.write_urdf(BOX, tmp_path / "a.urdf", name="box & co")
    root = ElementTree.parse(tmp_path / "a.urdf").getroot()
    assert (root.tag, root.get("name")) == ("robot", "box & co")
    (inertial,) = root.iter("inertial")
    assert float(inertial.find("mass").get("value")) == MASS
    assert floats(inertial.find("origin").get("xyz")) == CENTER
    assert floats(inertial.find("origin").get("rpy")) == [0, 0, 0]
    found = {name: float(x) for name, x in inertial.find("inertia").attrib.items()}
    expected = {f"i{'xyz'[i]}{'xyz'[j]}": MATRIX[i, j] for i in range(3) for j in range(i, 3)}
    assert found == pytest.approx(expected, rel=0, abs=CLOSE["atol"])
    # Our own reader finds every bit.
    assert ph.read_urdf(tmp_path / "a.urdf") == {"box & co": BOX}


def test_mjcf_has_the_closed_form_of_a_tilted_box(tmp_path):
    ph.io.write_mjcf(BOX, tmp_path / "a.xml")
    (inertial,) = ElementTree.parse(tmp_path / "a.xml").getroot().iter("inertial")
    assert float(inertial.get("mass")) == MASS
    assert floats(inertial.get("pos")) == CENTER
    moments, turn = floats(inertial.get("diaginertia")), matrix_of(floats(inertial.get("quat")))
    assert sorted(moments) == pytest.approx(sorted(MOMENTS), rel=1e-15)
    np.testing.assert_allclose(turn @ np.diag(moments) @ turn.T, MATRIX, **CLOSE)
    (found,) = ph.read_mjcf(tmp_path / "a.xml").values()
    assert (found.mass, found.center_of_mass) == (BOX.mass, BOX.center_of_mass)
    np.testing.assert_allclose(found.inertia.matrix, MATRIX, **CLOSE)


@pytest.mark.parametrize(("write", "name"), [(ph.io.write_urdf, "a.urdf"), (ph.io.write_mjcf, "a.xml")])
def test_mujoco_loads_the_bodies(write, name, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    # The largest moment of a plate is the sum of the others, or more by rounding, which MuJoCo rejects.
    more = 1 if name == "a.xml" else 0
    plate = ph.Inertia.from_principal_moments(0.1, 0.2, np.nextafter(0.1 + 0.2, more))
    write({"box": BOX, "plate": ph.Body(2, plate)}, tmp_path / name)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / name))
    assert [model.body(k).name for k in range(model.nbody)] == ["world", "box", "plate"]
    assert model.jnt_type.tolist() == 2 * [mujoco.mjtJoint.mjJNT_FREE]
    assert model.body_mass.tolist() == [0, MASS, 2]
    np.testing.assert_allclose(model.body_ipos[1], CENTER, rtol=0, atol=1e-14)
    np.testing.assert_allclose(np.sort(model.body_inertia[1]), np.sort(MOMENTS), rtol=1e-10)
    turn = matrix_of(model.body_iquat[1])
    # MuJoCo's eigenvectors are found to about 1e-12.
    np.testing.assert_allclose(turn @ np.diag(model.body_inertia[1]) @ turn.T, MATRIX, rtol=0, atol=1e-10)
    if name == "a.xml":  # The axes of the box are its principal axes.
        np.testing.assert_allclose(turn, TURN, rtol=0, atol=1e-14)
    np.testing.assert_allclose(np.sort(model.body_inertia[2]), [0.1, 0.2, 0.3], rtol=1e-10)


def test_the_command_converts_scenes_and_robots(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    handle = str(EXAMPLES / "t-handle.toml")
    body = ph.Scene.read(handle).body
    assert main(["convert", handle, "a.urdf"]) == 0
    assert capsys.readouterr().out.startswith("Written\n  a.urdf\n  t-handle: Body(mass 0.35")
    assert ph.read_urdf("a.urdf") == {"t-handle": body}
    assert main(["convert", "a.urdf", "b.xml"]) == 0
    assert ph.read_mjcf("b.xml")["t-handle"].mass == body.mass
    assert main(["convert", "b.xml", "a.urdf"]) == 0  # ours is replaced
    found = ph.read_urdf("a.urdf")["t-handle"].inertia.matrix
    np.testing.assert_allclose(found, body.inertia.matrix, rtol=0, atol=1e-14 * np.trace(body.inertia.matrix))
    mesh = str(EXAMPLES / "t-handle.stl")
    assert main(["convert", mesh, "c.urdf", "--mass", "2", "--scale", "0.001"]) == 0
    assert ph.read_urdf("c.urdf") == {"t-handle": ph.Body.from_mesh(mesh, mass=2, scale=0.001)}


@pytest.mark.parametrize(
    ("arguments", "code", "expected"),
    [
        (("a.stl", "b.urdf"), 2, "a mesh needs --density in kg/m³ or --mass in kg"),
        (("a.urdf", "b.stl"), 2, "a .urdf file has inertias, and no mesh for a .stl file"),
        (("a.nc", "b.urdf"), 2, "files that can be converted to .urdf end in .toml, .stl"),
        (("a.urdf", "b.xml", "--mass", "2"), 2, "--mass does not apply from .urdf to .xml"),
        (("a.stl", "b.stl", "--density", "0"), 2, "density must be a positive number, got '0'"),
        (("bad.urdf", "b.xml"), 3, "bad.urdf:1:1: error: the root element must be"),
        (("moments.toml", "b.xml"), 1, "moments.toml gives no mass, which a robot file needs"),
        (("wrong.toml", "b.xml"), 3, "wrong.toml:1:2: error"),
        (("none.toml", "b.xml"), 3, "none.toml"),
        (("a.urdf", "mine.xml"), 1, "mine.xml exists and was not written by polhode"),
    ],
)
def test_wrong_uses_of_the_command(arguments, code, expected, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    ph.io.write_urdf(BOX, "a.urdf")
    run = "[initial]\nspin = { vector = [0, 0, 1] }\n[run]\nduration = 1\n"
    texts = {"a.stl": "", "bad.urdf": "<html/>", "mine.xml": "<mujoco/>", "wrong.toml": "[corpse]\n" + run}
    texts["moments.toml"] = "[body]\nmoments = [1, 2, 3]\n" + run
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    try:
        found = main(["convert", *arguments])
    except SystemExit as stop:
        found = stop.code
    assert found == code
    assert expected in capsys.readouterr().err
    assert not {x.name for x in tmp_path.iterdir()} - {"a.urdf", *texts}


@pytest.mark.parametrize(
    ("write", "bodies", "options", "error"),
    [
        (
            ph.io.write_mjcf,
            ph.Body.rod(1, mass=1),
            {},
            "'body' has a principal moment of 0 kg m², and MuJoCo",
        ),
        (ph.io.write_mjcf, ph.Body.sphere(1, mass=1e-16), {}, "'body' has mass of 1e-16 kg"),
        (ph.io.write_mjcf, {}, {}, "there is no body to write"),
        (ph.io.write_urdf, {"world": BOX}, {}, "no link may be called 'world'"),
        (ph.io.write_mjcf, {"world": BOX}, {}, "no body may be called 'world'"),
        (ph.io.write_urdf, {"": BOX}, {}, "a name must be printable text that is not empty, got ''"),
        (ph.io.write_urdf, BOX, {"name": "a\x00"}, "a name must be printable"),
    ],
)
def test_errors(write, bodies, options, error, tmp_path):
    with pytest.raises(ValueError) as found:
        write(bodies, tmp_path / "a.xml", **options)
    assert error in str(found.value)
    assert not list(tmp_path.iterdir())
    with pytest.raises(TypeError, match="'a' must be a Body, got int"):
        write({"a": 1}, tmp_path / "a.xml")
