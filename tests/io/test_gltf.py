"""glTF animations, read by an independent reader: structure, tracks, mesh, errors."""

import json
import struct

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES
from motions import ASYMMETRIC, START
from polhode._cli.main import main

TIMES = np.linspace(2, 4, 21)
MOTION = ph.simulate(ASYMMETRIC, START, TIMES)
MOVING = ph.simulate(
    ASYMMETRIC, ph.State(START.rotor, START.omega_body, position=[1, 2, 3], velocity=[0, 0, 1]), TIMES
)
TRIANGLE = ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def numbers_of(gltf, index):
    """The numbers of an accessor, by the rules of the specification."""
    accessor = gltf.accessors[index]
    view = gltf.bufferViews[accessor.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
    kind = {5126: "<f4", 5125: "<u4"}[accessor.componentType]
    data = gltf.get_data_from_buffer_uri(gltf.buffers[0].uri) if gltf.buffers[0].uri else gltf.binary_blob()
    rows = np.frombuffer(data, kind, accessor.count * width, view.byteOffset).reshape(-1, width)
    if accessor.min:
        np.testing.assert_array_equal(rows.min(axis=0), np.array(accessor.min, kind))
        np.testing.assert_array_equal(rows.max(axis=0), np.array(accessor.max, kind))
    return rows


def tracks_of(gltf):
    (animation,) = gltf.animations
    found = {}
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        assert gltf.nodes[channel.target.node].name == "body"
        found["time"] = numbers_of(gltf, sampler.input)[:, 0]
        found[channel.target.path] = numbers_of(gltf, sampler.output)
    return found


@pytest.mark.parametrize("form", ["glb", "gltf"])
def test_another_reader_finds_the_tracks(form, tmp_path):
    """pygltflib; a quaternion x, y, z, w of glTF turns from the node to its parent."""
    library = pytest.importorskip("pygltflib")
    ph.io.write_gltf(MOVING, tmp_path / f"a.{form}", surface=TRIANGLE)
    gltf = library.GLTF2().load(str(tmp_path / f"a.{form}"))
    assert gltf.asset.version == "2.0"
    tracks = tracks_of(gltf)
    # 32-bit floats of numbers below 8.
    near = {"rtol": 0, "atol": 8 * 2**-24}
    np.testing.assert_allclose(tracks["time"], TIMES - 2, **near)
    np.testing.assert_allclose(tracks["rotation"], MOVING.rotor.to_quaternion(order="xyzw"), **near)
    np.testing.assert_allclose(tracks["translation"], MOVING.position.components, **near)
    primitive = gltf.meshes[0].primitives[0]
    np.testing.assert_array_equal(numbers_of(gltf, primitive.attributes.POSITION), TRIANGLE[0])
    np.testing.assert_array_equal(numbers_of(gltf, primitive.indices).ravel(), [0, 1, 2])
    # Space is turned so that its e3 is up, +Y in glTF.
    up = ph.Rotor.from_quaternion(gltf.nodes[0].rotation, order="xyzw")
    assert up(ph.e3).is_close(ph.e2, atol=1e-15)


def test_the_box_has_the_moments_of_the_body(tmp_path):
    """trimesh computes the inertia of the mesh in the file."""
    library = pytest.importorskip("trimesh")
    turned = ph.Rotor.from_axis_angle(ph.vector([1, 2, 2.0]).normalized(), 0.7)
    matrix = turned.to_matrix()
    inertia = ph.Inertia.from_matrix(matrix @ ph.Body.box([1, 2, 3], mass=5).inertia.matrix @ matrix.T)
    motion = ph.simulate(inertia, START, TIMES)
    ph.io.write_gltf(motion, tmp_path / "a.glb", mass=5)
    (mesh,) = library.load(tmp_path / "a.glb").geometry.values()
    assert mesh.is_watertight
    mesh.density = 5 / mesh.volume
    # Vertices are 32-bit floats.
    np.testing.assert_allclose(mesh.moment_inertia, inertia.matrix, atol=1e-5)
    assert mesh.volume == pytest.approx(6, rel=1e-6)


def test_chunks_of_glb_are_aligned(tmp_path):
    ph.io.write_gltf(MOTION, tmp_path / "a.glb")
    data = (tmp_path / "a.glb").read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    tree = json.loads(data[20 : 20 + size])
    assert (kind, size % 4) == (b"JSON", 0)
    rest, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    assert rest == len(data) - 28 - size == tree["buffers"][0]["byteLength"]


def test_the_command_takes_the_mesh_of_a_scene(tmp_path, capsys):
    """The vertices are those of the scene about its centre of mass."""
    library = pytest.importorskip("pygltflib")
    path = str(EXAMPLES / "t-handle.toml")
    scene = ph.Scene.read(path)
    scene.run().save(tmp_path / "a.nc")
    assert main(["convert", str(tmp_path / "a.nc"), str(tmp_path / "a.glb"), "--scene", path]) == 0
    gltf = library.GLTF2().load(str(tmp_path / "a.glb"))
    vertices = numbers_of(gltf, gltf.meshes[0].primitives[0].attributes.POSITION)
    expected = scene.surface()[0] - scene.body.center_of_mass.components
    np.testing.assert_allclose(vertices, expected, atol=1e-7)
    assert gltf.scenes[0].name == scene.title
    # Ours is replaced; a foreign file is not.
    assert main(["convert", str(tmp_path / "a.nc"), str(tmp_path / "a.glb")]) == 0
    (tmp_path / "b.glb").write_bytes(b"glTF mine")
    assert main(["convert", str(tmp_path / "a.nc"), str(tmp_path / "b.glb")]) == 1
    with pytest.raises(SystemExit):
        main(["convert", str(tmp_path / "a.nc"), str(tmp_path / "a.csv"), "--scene", path])
    assert "--scene does not apply from .nc to .csv" in capsys.readouterr().err


def test_the_command_draws_the_solid_of_a_scene(tmp_path, monkeypatch):
    """trimesh finds a cylinder about its centre of mass, and one that hangs from its end about the end."""
    library = pytest.importorskip("trimesh")
    monkeypatch.chdir(tmp_path)
    text = (
        "[body]\nsolid = 'cylinder'\nradius = '5 cm'\nheight = '40 cm'\nmass = 1\n"
        "[initial]\nspin = { vector = [0.1, 0, 1] }\n[run]\nduration = 1\nsamples = 11\n"
    )
    held = text + "[gravity]\nacceleration = 9.81\npivot = [0, 0, '20 cm']\n"
    for name, content, middle in (("free", text, 0), ("held", held, -0.2)):
        (tmp_path / f"{name}.toml").write_text(content)
        ph.Scene.read(f"{name}.toml").run().save(f"{name}.nc")
        assert main(["convert", f"{name}.nc", f"{name}.glb", "--scene", f"{name}.toml"]) == 0
        (mesh,) = library.load(tmp_path / f"{name}.glb").geometry.values()
        assert mesh.is_watertight
        # Vertices are 32-bit floats; the cylinder has 64 faces.
        np.testing.assert_allclose(mesh.extents, [0.1, 0.1, 0.4], rtol=1e-6)
        np.testing.assert_allclose(mesh.center_mass, [0, 0, middle], atol=1e-7)
        assert mesh.volume == pytest.approx(np.sinc(2 / 64) * np.pi * 0.05**2 * 0.4, rel=1e-6)


def test_turns_that_an_animation_cannot_show_are_warned_of(tmp_path):
    fast = ph.simulate(ASYMMETRIC, ph.State(ph.Rotor.identity(), [0, 0, 5.0]), [0, 1, 2])
    with pytest.warns(UserWarning, match="turns by 286° between output times 0 and 1"):
        ph.io.write_gltf(fast, tmp_path / "a.glb")


@pytest.mark.parametrize(
    ("motion", "name", "options", "expected"),
    [
        (MOTION, "a.obj", {}, "an animation is saved as FILE.glb or FILE.gltf"),
        (ph.io.AttitudeHistory(TIMES, MOTION.rotor), "a.glb", {}, "give surface="),
        (
            ph.io.AttitudeHistory([0], ph.Rotor.identity((1,))),
            "a.glb",
            {"surface": TRIANGLE},
            "two output times",
        ),
        (MOTION, "a.glb", {"surface": ([[0, 0]], [[0, 0, 0]])}, "vertices must be"),
        (
            MOTION,
            "a.glb",
            {"surface": (TRIANGLE[0], [[0, 1, 3]])},
            "triangles must be numbers of the 3 vertices",
        ),
        (MOTION, "a.glb", {"surface": (TRIANGLE[0], [[0.5, 1, 2]])}, "triangles must be integers"),
        (
            ph.io.AttitudeHistory([0, 1, 1 + 1e-12], ph.Rotor.identity((3,))),
            "a.glb",
            {"surface": TRIANGLE},
            "too close for the 32-bit floats",
        ),
    ],
)
def test_errors(motion, name, options, expected, tmp_path):
    with pytest.raises(ValueError, match=expected):
        ph.io.write_gltf(motion, tmp_path / name, **options)
    assert not list(tmp_path.iterdir())
