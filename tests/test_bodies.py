"""Bodies and their inertia: closed forms from textbooks, meshes made here, sums over points, and refusals."""

import pickle
import struct
from pathlib import Path

import numpy as np
import pytest

import polhode as ph

EPS = np.finfo(float).eps
# A closed form or a short sum of products rounds a few dozen times.
ROUNDING = 32 * EPS

DATA = Path(__file__).parents[2] / "shared" / "data"

# --- meshes of solids, written here


def surface_of_revolution(profile, n):
    """Triangles (k, 3, 3) of a profile (m, 2) of (radius, height), from bottom to top, turned about e3."""
    angles = 2 * np.pi * np.arange(n) / n
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = np.array([np.column_stack([r * circle, np.full(n, z)]) for r, z in profile])
    lower, upper = rings[:-1].reshape(-1, 3), rings[1:].reshape(-1, 3)
    lower_next, upper_next = (np.roll(x, -1, axis=1).reshape(-1, 3) for x in (rings[:-1], rings[1:]))
    triangles = np.concatenate(
        [np.stack([lower, lower_next, upper_next], axis=1), np.stack([lower, upper_next, upper], axis=1)]
    )
    a, b, c = triangles.transpose(1, 0, 2)
    # At a pole one of the two has no area.
    return triangles[(a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)]


def arc(n, radius, start, end, center=(0.0, 0.0)):
    """Points of a circle in the (radius, height) plane; the poles exactly on the axis."""
    s = np.linspace(start, end, n + 1)
    points = np.stack([center[0] + radius * np.cos(s), center[1] + radius * np.sin(s)], axis=1)
    points[np.abs(points[:, 0]) < 1e-12 * radius, 0] = 0.0
    return points


def sphere_profile(n, radius=1.0):
    return arc(n, radius, -np.pi / 2, np.pi / 2)


def torus_profile(n, major, minor):
    closed = arc(n, minor, -np.pi, np.pi, (major, 0.0))
    closed[-1] = closed[0]
    return closed


def capsule_profile(n, radius, height):
    lower, upper = arc(n // 2, radius, -np.pi / 2, 0.0), arc(n // 2, radius, 0.0, np.pi / 2)
    shift = np.array([0.0, height / 2])
    return np.concatenate([lower - shift, upper + shift])


def cube(lengths=(1.0, 1.0, 1.0)):
    """The 12 triangles of a box, counterclockwise seen from outside."""
    corners = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]) * lengths
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners[[t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])]]


def write_obj(path, triangles):
    vertices, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (index.reshape(-1, 3) + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_binary_stl(path, triangles):
    records = np.zeros(
        len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    )
    records["corners"] = triangles
    path.write_bytes(b"test".ljust(80) + struct.pack("<I", len(triangles)) + records.tobytes())
    return path


def write_ascii_stl(path, triangles):
    lines = ["solid test"]
    for triangle in triangles.tolist():
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid test"]) + "\n")
    return path


def write_ply(path, triangles):
    vertices, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3).tolist()
    header = f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\n"
    header += (
        f"property double z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()] + [f"3 {a} {b} {c}" for a, b, c in faces]
    path.write_text(header + "\n".join(rows) + "\n")
    return path


# --- solids

M = 2.5
SOLIDS = {
    "box": (ph.Body.box([1, 2, 3], mass=M), M / 12 * np.array([4 + 9, 9 + 1, 1 + 4]), 6.0),
    "ellipsoid": (
        ph.Body.ellipsoid([1, 2, 3], mass=M),
        M / 5 * np.array([4 + 9, 9 + 1, 1 + 4]),
        4 / 3 * np.pi * 6,
    ),
    "sphere": (ph.Body.sphere(2, mass=M), np.full(3, 2 / 5 * M * 4), 4 / 3 * np.pi * 8),
    "hollow sphere": (
        ph.Body.hollow_sphere(2, 1, mass=M),
        np.full(3, 2 / 5 * M * (32 - 1) / (8 - 1)),
        4 / 3 * np.pi * 7,
    ),
    "thin shell": (ph.Body.hollow_sphere(2, 2, mass=M), np.full(3, 2 / 3 * M * 4), None),
    "cylinder": (
        ph.Body.cylinder(2, 3, mass=M),
        M * np.array([(3 * 4 + 9) / 12, (3 * 4 + 9) / 12, 4 / 2]),
        np.pi * 12,
    ),
    "cone": (
        ph.Body.cone(2, 3, mass=M),
        M * np.array([3 / 80 * (4 * 4 + 9), 3 / 80 * (4 * 4 + 9), 3 / 10 * 4]),
        np.pi / 3 * 12,
    ),
    "rod": (ph.Body.rod(3, mass=M), M * np.array([9 / 12, 9 / 12, 0]), None),
    "disc": (ph.Body.disc(2, mass=M), M * np.array([4 / 4, 4 / 4, 4 / 2]), None),
    "torus": (
        ph.Body.torus(3, 1, mass=M),
        M * np.array([9 / 2 + 5 / 8, 9 / 2 + 5 / 8, 9 + 3 / 4]),
        2 * np.pi**2 * 3,
    ),
}

MESHES = {
    "ellipsoid": lambda n: surface_of_revolution(sphere_profile(n), n) * [1, 2, 3],
    "sphere": lambda n: surface_of_revolution(sphere_profile(n, 2.0), n),
    "hollow sphere": lambda n: np.concatenate(
        [
            surface_of_revolution(sphere_profile(n, 2.0), n),
            surface_of_revolution(sphere_profile(n, 1.0), n)[:, ::-1],
        ]
    ),
    "cylinder": lambda n: surface_of_revolution([(0, -1.5), (2, -1.5), (2, 1.5), (0, 1.5)], n),
    "cone": lambda n: surface_of_revolution([(0, 0), (2, 0), (0, 3)], n),
    "torus": lambda n: surface_of_revolution(torus_profile(n, 3.0, 1.0), n),
    "capsule": lambda n: surface_of_revolution(capsule_profile(n, 1.0, 2.0), n),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_have_their_textbook_moments(name):
    body, moments, _ = SOLIDS[name]
    assert body.mass == M
    np.testing.assert_allclose(body.inertia.principal_moments, moments, rtol=ROUNDING)
    np.testing.assert_allclose(body.inertia.matrix, np.diag(moments), rtol=ROUNDING)
    center = [0, 0, 0.75] if name == "cone" else [0, 0, 0]
    np.testing.assert_array_equal(body.center_of_mass.components, center)


def test_density_times_volume_is_mass():
    makers = {
        "box": lambda **k: ph.Body.box([1, 2, 3], **k),
        "ellipsoid": lambda **k: ph.Body.ellipsoid([1, 2, 3], **k),
        "sphere": lambda **k: ph.Body.sphere(2, **k),
        "hollow sphere": lambda **k: ph.Body.hollow_sphere(2, 1, **k),
        "cylinder": lambda **k: ph.Body.cylinder(2, 3, **k),
        "cone": lambda **k: ph.Body.cone(2, 3, **k),
        "torus": lambda **k: ph.Body.torus(3, 1, **k),
    }
    for name, make in makers.items():
        body = make(density=7.85)
        assert body.mass == pytest.approx(7.85 * SOLIDS[name][2], rel=ROUNDING), name
        expected = SOLIDS[name][1] * (body.mass / M)
        np.testing.assert_allclose(body.inertia.principal_moments, expected, rtol=ROUNDING)


def test_a_capsule_is_a_cylinder_and_two_halves_of_a_sphere():
    """Its moments as integrals of discs, ∫π r² dz and so on, by Gauss–Legendre on each smooth piece."""
    r, h, density = 0.5, 1.5, 3.0
    nodes, weights = np.polynomial.legendre.leggauss(20)
    volume = axial = second = 0.0
    for low, high in ((-h / 2 - r, -h / 2), (-h / 2, h / 2), (h / 2, h / 2 + r)):
        z = (low + high) / 2 + (high - low) / 2 * nodes
        w = weights * (high - low) / 2
        beyond = np.maximum(np.abs(z) - h / 2, 0.0)
        square = r**2 - beyond**2
        volume += np.sum(w * np.pi * square)
        axial += np.sum(w * np.pi / 2 * square**2)
        second += np.sum(w * np.pi * square * z**2)
    body = ph.Body.capsule(r, h, density=density)
    assert body.mass == pytest.approx(density * volume, rel=ROUNDING)
    expected = density * np.array([axial / 2 + second, axial / 2 + second, axial])
    np.testing.assert_allclose(body.inertia.principal_moments, expected, rtol=ROUNDING)


@pytest.mark.parametrize("name", MESHES)
def test_meshes_of_solids_converge_to_them(name, tmp_path):
    """Inscribed facets miss the surface by O(n⁻²): the difference falls by 4, and extrapolates to O(n⁻⁴)."""
    solid = ph.Body.capsule(1.0, 2.0, mass=M) if name == "capsule" else SOLIDS[name][0]
    density = 1.0
    n = 32
    found = []
    for facets in (n, 2 * n):
        path = write_obj(tmp_path / f"{facets}.obj", MESHES[name](facets))
        body = ph.Body.from_mesh(path, density=density)
        heights = body.center_of_mass.components
        assert np.abs(heights[:2]).max() <= 1e3 * EPS
        found.append(np.array([body.mass, *np.diag(body.inertia.matrix), heights[2]]))
    volume = {**{k: v[2] for k, v in SOLIDS.items()}, "capsule": np.pi * (2 + 4 / 3)}[name]
    moments = solid.inertia.principal_moments * volume / M
    exact = np.array([volume, *moments, solid.center_of_mass.components[2]])
    scale = np.array([volume, *moments, 1.0])
    coarse, fine = ((x - exact) / scale for x in found)
    assert np.abs(coarse).max() < 3 * (2 * np.pi / n) ** 2
    curved = np.abs(coarse) > 1e-6
    np.testing.assert_allclose(coarse[curved] / fine[curved], 4.0, rtol=2 * (2 * np.pi / n))
    assert np.abs((4 * fine - coarse) / 3).max() < (2 * np.pi / n) ** 4


@pytest.mark.parametrize(
    ("extension", "write"),
    [
        ("obj", write_obj),
        ("stl", write_binary_stl),
        ("stl", write_ascii_stl),
        ("ply", write_ply),
        ("STL", write_ascii_stl),
    ],
)
def test_a_box_from_each_format_is_the_box(extension, write, tmp_path):
    """A mesh with plane faces is exact; the lengths are exact in single precision too."""
    path = write(tmp_path / f"box.{extension}", cube([1.0, 2.0, 3.0]) + np.array([4.0, -2.0, 1.0]))
    body, box = ph.Body.from_mesh(str(path), density=1000.0), ph.Body.box([1, 2, 3], density=1000.0)
    assert body.mass == pytest.approx(box.mass, rel=ROUNDING)
    np.testing.assert_allclose(body.center_of_mass.components, [4, -2, 1], rtol=ROUNDING)
    np.testing.assert_allclose(body.inertia.matrix, box.inertia.matrix, rtol=0, atol=ROUNDING * 6.5e3)


def test_scale_turns_millimetres_into_metres(tmp_path):
    path = write_obj(tmp_path / "box.obj", cube([10.0, 20.0, 30.0]))
    body = ph.Body.from_mesh(path, density=2700.0, scale=1e-3)
    box = ph.Body.box([0.01, 0.02, 0.03], density=2700.0)
    assert body.mass == pytest.approx(box.mass, rel=ROUNDING)
    np.testing.assert_allclose(np.diag(body.inertia.matrix), box.inertia.principal_moments, rtol=ROUNDING)
    given = ph.Body.from_mesh(path, mass=2.0, scale=1e-3)
    assert given.mass == 2.0
    np.testing.assert_allclose(
        given.inertia.matrix * body.mass, body.inertia.matrix * 2.0, rtol=ROUNDING, atol=1e-20
    )


@pytest.mark.parametrize(
    ("name", "ratios"), [("toutatis", (1, 3.013, 3.190)), ("67p-lowres", (1, 1.869, 2.017))]
)
def test_real_shapes(name, ratios):
    path = DATA / f"{name}.obj"
    if not path.exists():
        pytest.skip("the shape model is not here")
    body = ph.Body.from_mesh(path, density=2000.0)
    moments = body.inertia.principal_moments
    np.testing.assert_allclose(moments / moments[0], ratios, rtol=0, atol=6e-4)


# --- moving, joining, points


def points(n=50, seed=3):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.1, 2, n), rng.normal(size=(n, 3))


def inertia_sum(masses, x, about):
    d = x - about
    return np.einsum(
        "k,kij->ij",
        masses,
        np.einsum("ki,ki->k", d, d)[:, None, None] * np.eye(3) - d[:, :, None] * d[:, None],
    )


def test_points_against_their_sums():
    m, x = points()
    body = ph.Body.from_points(m, x)
    center = m @ x / m.sum()
    assert body.mass == pytest.approx(m.sum(), rel=ROUNDING)
    np.testing.assert_allclose(body.center_of_mass.components, center, rtol=0, atol=ROUNDING)
    expected = inertia_sum(m, x, center)
    np.testing.assert_allclose(body.inertia.matrix, expected, rtol=0, atol=ROUNDING * expected.max())
    assert ph.Inertia.from_points(m, x) == body.inertia
    assert ph.Inertia.from_points(m, ph.vector(x)) == body.inertia


def test_points_far_from_the_origin_lose_no_digits():
    """At 2²⁰ m the coordinates here are still exact, and so must the sums be."""
    m, x = points()
    x = np.round(x * 2**20) / 2**20
    far = ph.Inertia.from_points(m, x + 2.0**20)
    near = ph.Inertia.from_points(m, x)
    np.testing.assert_allclose(far.matrix, near.matrix, rtol=0, atol=ROUNDING * near.matrix.max())


def test_parallel_axes():
    m, x = points()
    body = ph.Body.from_points(m, x)
    for point in ([0.0, 0.0, 0.0], [3.0, -1.0, 2.0], body.center_of_mass):
        about = getattr(point, "components", point)
        expected = inertia_sum(m, x, about)
        found = body.inertia_about(point).matrix
        np.testing.assert_allclose(found, expected, rtol=0, atol=ROUNDING * expected.max())


def test_parallel_axes_of_a_rod():
    """About its end a rod has m l²/3."""
    rod = ph.Body.rod(2.0, mass=3.0)
    np.testing.assert_allclose(np.diag(rod.inertia_about([0, 0, -1]).matrix), [4, 4, 0], rtol=ROUNDING)


def test_joined_bodies_are_the_body_of_all_points():
    (m1, x1), (m2, x2) = points(20, 1), points(30, 2)
    R, shift = ph.Rotor.from_components([4, -2, 1, 2]), np.array([1.0, 2.0, -3.0])
    joined = ph.Body.from_points(m1, x1) + ph.Body.from_points(m2, x2).moved(R, shift)
    moved = x2 @ R.to_matrix().T + shift
    whole = ph.Body.from_points(np.concatenate([m1, m2]), np.concatenate([x1, moved]))
    assert joined.mass == pytest.approx(whole.mass, rel=ROUNDING)
    np.testing.assert_allclose(
        joined.center_of_mass.components, whole.center_of_mass.components, atol=ROUNDING
    )
    largest = whole.inertia.matrix.max()
    np.testing.assert_allclose(joined.inertia.matrix, whole.inertia.matrix, rtol=0, atol=ROUNDING * largest)


def test_two_half_boxes_are_a_box():
    half = ph.Body.box([1, 2, 1.5], density=10.0)
    whole = half.moved(position=[0, 0, 0.75]) + half.moved(position=ph.vector([0, 0, -0.75]))
    box = ph.Body.box([1, 2, 3], density=10.0)
    assert whole.mass == box.mass
    np.testing.assert_allclose(whole.inertia.matrix, box.inertia.matrix, rtol=ROUNDING)
    np.testing.assert_allclose(whole.center_of_mass.components, 0, atol=EPS)


def test_a_turned_body_has_a_turned_map():
    """I'(R B ~R) = R I(B) ~R."""
    m, x = points()
    R, B = ph.Rotor.random(rng=5), ph.bivector([0.3, -0.4, 1.2])
    body = ph.Body.from_points(m, x)
    left, right = body.moved(R).inertia(R(B)), R(body.inertia(B))
    assert left.is_close(right, rtol=ROUNDING)


def test_principal_frame():
    """Its axes are eigenvectors, right-handed, with rising moments, and it is a rotor near 1."""
    J = ph.Body.from_points(*points()).inertia
    F, moments = J.principal_frame, J.principal_moments
    assert np.all(np.diff(moments) > 0)
    for e, moment in zip((ph.e1, ph.e2, ph.e3), moments, strict=True):
        plane = F(e).undual()
        assert J(plane).is_close(moment * plane, rtol=ROUNDING)
    columns = F.to_matrix()
    np.testing.assert_allclose(columns @ np.diag(moments) @ columns.T, J.matrix, atol=ROUNDING * moments[2])
    assert np.linalg.det(columns) == pytest.approx(1)
    # Half turns about the axes change nothing; of the four frames that nearest to 1 is taken.
    assert F.components[0] >= 0.5 - EPS
    given = ph.Inertia.from_principal_moments(3, 1, 2)
    assert given.principal_frame == ph.Rotor.identity()
    np.testing.assert_array_equal(given.principal_moments, [3, 1, 2])


def test_inverse_of_the_map():
    J = ph.Body.from_points(*points()).inertia
    B = ph.bivector(np.random.default_rng(4).normal(size=(10, 3)))
    assert np.all(J.inverse(J(B)).is_close(B, rtol=10 * ROUNDING))
    with pytest.raises(ValueError, match="rod"):
        ph.Body.rod(1.0, mass=1.0).inertia.inverse(ph.e1.undual())


# --- values


@pytest.mark.parametrize(
    "body",
    [
        ph.Body.cone(1, 2, mass=3),
        ph.Body.from_points(*points()),
        ph.Body.box([1, 2, 3], mass=2).moved(ph.Rotor.from_components([4, -2, 1, 2]), [1, 2, 3]),
    ],
    ids=["cone", "points", "turned box"],
)
def test_bodies_survive_pickling(body):
    """Everything that can be asked of the copy is what it was, the order of the principal axes too."""
    copy = pickle.loads(pickle.dumps(body))
    assert copy.mass == body.mass
    assert copy.center_of_mass == body.center_of_mass
    assert copy.inertia == body.inertia
    np.testing.assert_array_equal(copy.inertia.principal_moments, body.inertia.principal_moments)
    np.testing.assert_allclose(
        copy.inertia.principal_frame.components, body.inertia.principal_frame.components, atol=ROUNDING
    )


def test_inertias_compare_and_hash_by_value():
    a, b = ph.Inertia.from_principal_moments(1, 2, 3), ph.Inertia.from_matrix(np.diag([1.0, 2.0, 3.0]))
    assert a == b
    assert hash(a) == hash(b)
    assert a != ph.Inertia.from_principal_moments(1, 3, 2)
    assert a != "a"


def test_what_they_look_like():
    assert "1, 2, 3 kg m²" in repr(ph.Inertia.from_principal_moments(1, 2, 3))
    text = repr(ph.Body.sphere(1, mass=2))
    assert "2 kg" in text
    assert "0.8" in text


# --- refusals: the message has the value, and says what to do


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
        (lambda: ph.Inertia.from_points([1, 2], [[0, 0, 0]]), ["(2,)", "(1, 3)"]),
        (lambda: ph.Inertia.from_points([1, -2], np.eye(3)[:2]), ["masses[1]", "-2.0 kg"]),
        (lambda: ph.Inertia.from_points([1, 2], [[0, 0, 0], [0, np.inf, 0]]), ["positions[1]", "inf"]),
        (lambda: ph.Inertia.from_points([], np.zeros((0, 3))), ["at least one point"]),
        (lambda: ph.Body.box([1, 2, -3], mass=1), ["lengths[2]", "-3.0 m"]),
        (lambda: ph.Body.box([1, 2], mass=1), ["3 components", "(2,)"]),
        (lambda: ph.Body.sphere(1, mass=-1), ["-1.0 kg"]),
        (lambda: ph.Body.sphere(1, density=0), ["0.0 kg/m³"]),
        (lambda: ph.Body.sphere(np.nan, mass=1), ["radius", "NaN"]),
        (lambda: ph.Body.hollow_sphere(1, 2, mass=1), ["inner_radius = 2.0 m", "outer_radius = 1.0 m"]),
        (lambda: ph.Body.hollow_sphere(1, 1, density=1), ["volume", "mass"]),
        (lambda: ph.Body.torus(1, 2, mass=1), ["minor_radius = 2.0 m", "major_radius = 1.0 m"]),
        (lambda: ph.Body(0.0, ph.Inertia.from_principal_moments(1, 1, 1)), ["0.0 kg"]),
        (
            lambda: ph.Body(1.0, ph.Inertia.from_principal_moments(1, 1, 1), [0, np.nan, 0]),
            ["centre of mass", "NaN"],
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
    "extra face": (doubled, ["three or more triangles"]),
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
        ("note.txt", b"hello", ["txt", "stl, obj, ply"]),
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
def test_a_scale_is_positive_and_finite(scale, tmp_path):
    path = write_obj(tmp_path / "box.obj", cube())
    with pytest.raises(ValueError, match="scale"):
        ph.Body.from_mesh(path, density=1.0, scale=scale)
