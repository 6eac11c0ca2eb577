"""Invalid bodies and meshes: the message has the value and a remedy."""

import struct

import numpy as np
import pytest

import polhode as ph
from meshes import cube, write_binary_stl, write_obj


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (lambda: ph.Inertia.from_principal_moments(1, 1, 3), ["1.0, 1.0, 3.0", "i3", "2.0"]),
        (lambda: ph.Inertia.from_principal_moments(5, 1, 3), ["5.0, 1.0, 3.0", "i1", "4.0"]),
        (lambda: ph.Inertia.from_principal_moments(1, -2, 3), ["-2.0", "i2", "negative"]),
        (lambda: ph.Inertia.from_principal_moments(1, np.nan, 3), ["i2", "NaN"]),
        (lambda: ph.Inertia.from_matrix(np.diag([1.0, 1.0, 3.0])), ["3.0", "exceeds", "2.0"]),
        (
            lambda: ph.Inertia.from_matrix([[1, 2, 0], [0, 1, 0], [0, 0, 1]]),
            ["symmetric", "row 1, column 2", "2.0"],
        ),
        (lambda: ph.Inertia.from_matrix(np.eye(2)), ["(3, 3)", "(2, 2)"]),
        (lambda: ph.Inertia.from_principal_moments(1, [2, 1], 3), ["at index (1,)", "1.0, 1.0, 3.0", "i3"]),
        (lambda: ph.Inertia.from_principal_moments([1, 2], [1, 2, 3], 3), ["(2,) of i1", "(3,) of i2"]),
        (
            lambda: ph.Inertia.from_matrix([np.eye(3), np.diag([1, 1, -1])]),
            ["at index (1,)", "-1.0", "negative"],
        ),
        (lambda: ph.Inertia.from_points([1, 2], [[0, 0, 0]]), ["(2,)", "(1, 3)"]),
        (lambda: ph.Inertia.from_points([1, -2], np.eye(3)[:2]), ["masses[1]", "-2.0 kg"]),
        (lambda: ph.Inertia.from_points([1, 2], [[0, 0, 0], [0, np.inf, 0]]), ["positions[1]", "inf"]),
        (lambda: ph.Inertia.from_points([], np.zeros((0, 3))), ["at least one point"]),
        (lambda: ph.Body.box([1, 2, -3], mass=1), ["lengths[2]", "-3.0 m"]),
        (lambda: ph.Body.box([1, 2], mass=1), ["3 components", "(2,)"]),
        (lambda: ph.Body.sphere(1, mass=-1), ["-1.0 kg"]),
        (lambda: ph.Body.sphere(1, density=0), ["0.0 kg/m³"]),
        (lambda: ph.Body.sphere(np.nan, mass=1), ["radius", "NaN"]),
        (
            lambda: ph.Body.hollow_sphere(1, 2, mass=1),
            ["inner_radius must be", "2.0 m", "outer_radius = 1.0 m"],
        ),
        (lambda: ph.Body.hollow_sphere(1, 1, density=1), ["volume", "mass"]),
        (lambda: ph.Body.torus(1, 2, mass=1), ["minor_radius = 2.0 m", "major_radius = 1.0 m"]),
        (lambda: ph.Body(0.0, ph.Inertia.from_principal_moments(1, 1, 1)), ["0.0 kg"]),
        (
            lambda: ph.Body(1.0, ph.Inertia.from_principal_moments(1, 1, 1), [0, np.nan, 0]),
            ["centre of mass", "nan"],
        ),
    ],
)
def test_impossible_bodies_are_refused(make, parts):
    with pytest.raises(ValueError) as error:
        make()
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: ph.Body.sphere(1),
        lambda: ph.Body.sphere(1, mass=1, density=1),
        lambda: ph.Body(1.0, np.eye(3)),
        lambda: ph.Inertia(3),
        lambda: ph.Inertia.from_principal_moments("1", 2, 3),
        lambda: ph.Inertia.from_principal_moments(1, 2, 3)(ph.e1),
        lambda: ph.Inertia.from_principal_moments(1, 2, 3)([1, 0, 0]),
        lambda: ph.Body.box([1, 2, 3], mass=1) + 1,
    ],
)
def test_wrong_types_are_type_errors(make):
    with pytest.raises(TypeError):
        make()


def flipped_one(t):
    return np.concatenate([t[:1, ::-1], t[1:]])


def doubled(t):
    return np.concatenate([t, t[:1]])


MESH_ERRORS = {
    "open": (lambda t: t[1:], ["open", "3 edges"]),
    "inside-out": (lambda t: t[:, ::-1], ["inside-out", "-1"]),
    "winding": (flipped_one, ["winding", "3 edges"]),
    "degenerate": (lambda t: np.concatenate([t, t[:1, [0, 0, 1]]]), ["degenerate", "triangle 12"]),
    "repeated face": (doubled, ["1 repeated triangle", "triangle 12", "triangle 0"]),
    "flat": (lambda t: np.concatenate([t[:2], t[:2, ::-1]]), ["volume"]),
}


@pytest.mark.parametrize("name", MESH_ERRORS)
@pytest.mark.parametrize(("extension", "write"), [("obj", write_obj), ("stl", write_binary_stl)])
def test_meshes_that_enclose_no_body_are_refused(name, extension, write, tmp_path):
    change, parts = MESH_ERRORS[name]
    path = write(tmp_path / f"a part.{extension}", change(cube()))
    with pytest.raises(ValueError) as error:
        ph.Body.from_mesh(path, density=1.0)
    for part in [*parts, "a part"]:
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("name", "content", "parts"),
    [
        ("empty.stl", b"", ["empty"]),
        ("note.txt", b"hello", ["txt", "stl, obj or ply"]),
        ("short.stl", b"x" * 80 + struct.pack("<I", 12) + b"\0" * 100, ["byte"]),
        ("huge.stl", b"x" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 100, ["byte", "4294967295"]),
        ("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ["4"]),
        ("number.obj", b"v 0 0 zero\n", ["line 1", "zero"]),
        ("nan.obj", b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", ["not finite"]),
        ("none.obj", b"v 0 0 0\n", ["no triangles"]),
        ("header.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n", []),
        ("cut.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n", []),
        ("noise.ply", bytes(range(256)) * 4, []),
        ("noise.obj", bytes(range(256)) * 4, []),
    ],
)
def test_corrupt_files_are_refused_by_name(name, content, parts, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError) as error:
        ph.Body.from_mesh(tmp_path / name, density=1.0)
    for part in [*parts, name]:
        assert part in str(error.value)


def test_a_missing_mesh_is_named_once(tmp_path):
    with pytest.raises((ValueError, OSError)) as error:
        ph.Body.from_mesh(tmp_path / "absent.stl", density=1.0)
    assert str(error.value).count("absent.stl") == 1
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises((ValueError, OSError), match="regular file"):
        ph.Body.from_mesh(tmp_path / "folder.stl", density=1.0)


@pytest.mark.parametrize("scale", [0.0, -1.0, np.nan, np.inf])
def test_a_scale_must_be_positive_and_finite(scale, tmp_path):
    path = write_obj(tmp_path / "box.obj", cube())
    with pytest.raises(ValueError, match="scale"):
        ph.Body.from_mesh(path, density=1.0, scale=scale)
