"""Surfaces of solids and STL files in principal axes, by trimesh and closed forms."""

import struct

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES
from polhode._cli.main import main

trimesh = pytest.importorskip("trimesh")

# The area of a regular polygon of 64 or 32 corners over that of its circle.
ROUND, TUBE = (np.sinc(2 / n) for n in (64, 32))
# Volume of a polyhedron in a sphere of radius 1: 64-gons at the 33 ends of 32 equal arcs from pole to pole.
RADII, HEIGHTS = (f(np.linspace(0, np.pi, 33)) for f in (np.sin, lambda x: -np.cos(x)))
BALL = (
    ROUND * np.pi / 3 * np.sum(np.diff(HEIGHTS) * (RADII[1:] ** 2 + RADII[1:] * RADII[:-1] + RADII[:-1] ** 2))
)
SOLIDS = [
    (("box", [1, 2, 3]), [1, 2, 3], 6),
    (("ellipsoid", [1, 2, 3]), [2, 4, 6], 6 * BALL),
    (("sphere", 2), [4, 4, 4], 8 * BALL),
    (("hollow_sphere", 2, 1), [4, 4, 4], 8 * BALL),
    (("cylinder", 1, 3), [2, 2, 3], ROUND * 3 * np.pi),
    (("cone", 2, 3), [4, 4, 3], ROUND * 4 * np.pi),
    (("rod", 2), [0.06, 0.06, 2], ROUND * np.pi * 0.03**2 * 2),
    (("disc", 1), [2, 2, 0.06], ROUND * np.pi * 0.06),
    (("torus", 3, 1), [8, 8, 2], ROUND * 6 * np.pi * TUBE * np.pi),
    (("capsule", 1, 2), [2, 2, 4], BALL + ROUND * 2 * np.pi),
]


@pytest.mark.parametrize(("solid", "extents", "volume"), SOLIDS, ids=[x[0][0] for x in SOLIDS])
def test_surfaces_have_the_size_of_the_solid(solid, extents, volume):
    vertices, triangles = ph.io.solid_surface(*solid)
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    assert mesh.is_watertight
    # Hundreds of roundings at most, of coordinates up to 4.
    np.testing.assert_allclose(mesh.extents, extents, rtol=1e-13)
    assert mesh.volume == pytest.approx(volume, rel=1e-12)
    constructor = getattr(ph.Body, solid[0])
    if solid[0] not in ("rod", "disc", "hollow_sphere"):
        exact = constructor(*solid[1:], density=1)
        assert exact.mass * 0.99 < volume <= exact.mass * (1 + 1e-15)
        np.testing.assert_allclose(mesh.center_mass, exact.center_of_mass.components, rtol=0, atol=1e-13)


# --- STL

MASS_PROPERTIES = {"density": 2700, "scale": 0.001}
TURN = np.array([[2, -2, 1], [1, 2, 2], [-2, -1, 2]]) / 3
SIDES, CENTER = np.array([10.0, 20.0, 50.0]), np.array([100.0, -30.0, 7.0])


@pytest.fixture
def obj(tmp_path):
    """A box in mm, turned and away from the origin, its moments about its axes in ascending order 3, 2, 1."""
    vertices, triangles = ph.io.solid_surface("box", SIDES)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (vertices @ TURN.T + CENTER).tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]
    (tmp_path / "a.obj").write_text("\n".join(lines))
    return tmp_path / "a.obj"


def test_stl_is_in_principal_axes(obj, tmp_path):
    applied = ph.io.write_stl(obj, tmp_path / "a.stl", scale=0.001)
    data = (tmp_path / "a.stl").read_bytes()
    assert data.startswith(b"Written by polhode ")
    assert struct.unpack_from("<I", data, 80) == (12,)
    mesh = trimesh.load(tmp_path / "a.stl")
    assert mesh.is_watertight
    # Coordinates are 32-bit floats up to 0.025 m.
    error = 2 * 0.025 * 2**-24
    np.testing.assert_allclose(mesh.center_mass, 0, atol=error)
    np.testing.assert_allclose(mesh.extents, sorted(SIDES / 1000, reverse=True), atol=2 * error)
    a, b, c = SIDES / 1000
    moments = a * b * c / 12 * np.array([a**2 + b**2, a**2 + c**2, b**2 + c**2])
    # Relative errors of lengths count five times, three times of those that are smallest.
    tolerance = 8 * error / 0.005 * moments.max()
    np.testing.assert_allclose(mesh.moment_inertia, np.diag(moments), rtol=0, atol=tolerance)
    # The displacement takes the given corners to the written ones: trimesh merges corners, in another order.
    given = trimesh.load(obj, process=False).vertices / 1000
    moved = np.asarray(applied.apply(given))
    distances = np.linalg.norm(moved[:, np.newaxis] - mesh.vertices, axis=-1)
    assert distances.min(axis=1).max() < 2 * error
    assert len(set(distances.argmin(axis=1))) == 8
    # Its axes are the columns of TURN, up to sign: a right-handed frame with e1 along the longest side.
    axes = applied.rotor.to_matrix() @ TURN
    np.testing.assert_allclose(np.abs(axes), np.eye(3)[::-1], rtol=0, atol=1e-13)
    np.testing.assert_allclose(applied.apply(CENTER / 1000), 0, rtol=0, atol=1e-15)
    # Our own reader finds the same body in it.
    np.testing.assert_allclose(
        ph.Body.from_mesh(tmp_path / "a.stl", density=1).inertia.matrix,
        np.diag(moments),
        rtol=0,
        atol=tolerance,
    )


def test_the_command_prints_what_it_applied(obj, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["convert", "a.obj", "b.stl", "--scale", "0.001"]) == 0
    applied = ph.io.write_stl(obj, tmp_path / "c.stl", scale=0.001)
    assert (tmp_path / "b.stl").read_bytes() == (tmp_path / "c.stl").read_bytes()
    out = capsys.readouterr().out
    numbers = [float(x) for part in out.split("(")[1:] for x in part.split(")")[0].split(",")]
    np.testing.assert_allclose(numbers[:3], CENTER / 1000, rtol=1e-13)
    np.testing.assert_allclose(numbers[3:], applied.rotor.to_quaternion(order="wxyz"), rtol=0, atol=0)


def test_stl_of_the_solid_of_a_scene(tmp_path):
    """A cone on its tip: its centre of mass is a quarter of the height from the base."""
    (tmp_path / "a.toml").write_text(
        "[body]\nsolid = 'cone'\nradius = '2 cm'\nheight = '4 cm'\nmass = 1\n"
        "[gravity]\nacceleration = 9.81\npivot = [0, 0, '4 cm']\n"
        "[initial]\nspin = { vector = [0, 0, 1] }\n[run]\nduration = 1\n"
    )
    scene = ph.Scene.read(tmp_path / "a.toml")
    vertices, _ = scene.surface()
    assert vertices[:, 2].max() == 0  # the tip is the pivot, the origin of the body axes
    assert vertices[:, 2].min() == pytest.approx(-0.04)
    applied = ph.io.write_stl(scene, tmp_path / "a.stl")
    mesh = trimesh.load(tmp_path / "a.stl")
    np.testing.assert_allclose(mesh.center_mass, 0, atol=1e-8)
    axis = int(np.argmax(np.abs(applied.rotor.to_matrix()[:, 2])))
    np.testing.assert_allclose(sorted(np.abs(mesh.bounds[:, axis])), [0.01, 0.03], rtol=1e-6)


def test_a_scene_of_moments_has_no_surface(tmp_path):
    scene = ph.Scene.read(EXAMPLES / "toutatis.toml")
    assert scene.surface() is None
    with pytest.raises(ValueError, match="has neither a mesh nor a solid"):
        ph.io.write_stl(scene, tmp_path / "a.stl")


def test_read_mesh(obj):
    vertices, triangles = ph.io.read_mesh(obj, scale=0.001)
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    assert mesh.volume == pytest.approx(1e-5, rel=1e-13)


def test_errors(obj, tmp_path):
    with pytest.raises(ValueError, match=r"a mesh is saved as FILE.stl"):
        ph.io.write_stl(obj, tmp_path / "b.ply")
    with pytest.raises(FileNotFoundError, match=r"none.stl: no such file"):
        ph.io.read_mesh("none.stl")
    with pytest.raises(ValueError, match="triangle 0 cannot be written in the 32-bit floats of STL"):
        ph.io.write_stl(obj, tmp_path / "b.stl", scale=1e-50)
    with pytest.raises(ValueError, match="scale must be positive and finite"):
        ph.io.read_mesh(obj, scale=0)
    open_mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"
    (tmp_path / "open.obj").write_text(open_mesh)
    with pytest.raises(ValueError, match=r"open.obj: the mesh is"):
        ph.io.read_mesh(tmp_path / "open.obj")
    with pytest.raises(ValueError, match='"prism" with 2 lengths is not a solid'):
        ph.io.solid_surface("prism", 1, 2)
    with pytest.raises(ValueError, match="radius"):
        ph.io.solid_surface("cylinder", -1, 2)
    assert {x.name for x in tmp_path.iterdir()} == {"a.obj", "open.obj"}
