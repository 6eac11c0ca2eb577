"""Bodies and their inertia: textbook formulas, convergence of meshes, sums over points."""

import pickle

import numpy as np
import pytest

import polhode as ph
from meshes import (
    capsule_profile,
    cube,
    sphere_profile,
    surface_of_revolution,
    torus_profile,
    write_ascii_stl,
    write_binary_stl,
    write_obj,
    write_ply,
)

EPS = np.finfo(float).eps
# A closed form or a short sum of products rounds a few dozen times.
ROUNDING = 32 * EPS


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


def radius_of_lump(u):
    """Radius in unit directions (..., 3) of a body of two lobes with a neck, like an asteroid."""
    x, y, z = np.moveaxis(u, -1, 0)
    return 0.6 + 0.9 * z**2 + 0.3 * x * y + 0.2 * x * z**2 - 0.1 * y


def lump(n):
    """Mesh of the lump; its corners lie on the surface."""
    directions = surface_of_revolution(sphere_profile(n), 2 * n)
    return directions * radius_of_lump(directions)[..., None]


def body_of_lump():
    """Mass, centre and inertia of the smooth lump of density 1, by integrals over directions.

    ∫dV = ∫r³/3 dΩ, ∫x dV = ∫r⁴/4 u dΩ, ∫x xᵀ dV = ∫r⁵/5 u uᵀ dΩ. The integrands are polynomials in u of
    degree 17 at most, for which 12 Gauss nodes in z times 24 angles are exact.
    """
    z, weights = np.polynomial.legendre.leggauss(12)
    angles = 2 * np.pi * np.arange(24) / 24
    across, ones = np.sqrt(1 - z**2), np.ones(24)
    u = np.stack(
        [np.outer(across, np.cos(angles)), np.outer(across, np.sin(angles)), np.outer(z, ones)], axis=-1
    )
    area, r = np.outer(weights, 2 * np.pi / 24 * ones), radius_of_lump(u)
    mass = np.sum(area * r**3 / 3)
    center = np.einsum("ij,ijk->k", area * r**4 / 4, u) / mass
    second = np.einsum("ij,ijk,ijl->kl", area * r**5 / 5, u, u) - mass * np.outer(center, center)
    return mass, center, np.trace(second) * np.eye(3) - second


def test_a_lump_against_integrals_over_directions(tmp_path):
    mass, center, inertia = body_of_lump()
    exact = np.array([mass, *center, *inertia.ravel()])
    found = []
    for n in (24, 48, 96):
        body = ph.Body.from_mesh(write_obj(tmp_path / "lump.obj", lump(n)), density=1.0)
        found.append([body.mass, *body.center_of_mass.components, *body.inertia.matrix.ravel()])
    coarse, middle, fine = np.array(found)
    # Flat faces cut off as much as the square of their size: a quarter at half the size, to the next order,
    # which is the fourth and leaves a share of about (π/24)² = 0.017, times a constant.
    size = np.abs(coarse - exact)
    np.testing.assert_allclose(middle - exact, (coarse - exact) / 4, rtol=0, atol=0.05 * size.max() / 4)
    # Without the second order a difference of the fourth is left: (π/48)⁴ = 1.8e-5, times a constant below 1.
    np.testing.assert_allclose((4 * fine - middle) / 3, exact, rtol=0, atol=2e-5 * mass)


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
    """At 2²⁰ m these coordinates are exact, and the sums must be."""
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
    """Its axes are eigenvectors, right-handed, with ascending moments, and it is a rotor near 1."""
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
    """The copy has the same properties, including the order of the principal axes."""
    copy = pickle.loads(pickle.dumps(body))
    assert copy.mass == body.mass
    assert copy.center_of_mass == body.center_of_mass
    assert copy.inertia == body.inertia
    np.testing.assert_array_equal(copy.inertia.principal_moments, body.inertia.principal_moments)
    np.testing.assert_allclose(
        copy.inertia.principal_frame.components, body.inertia.principal_frame.components, atol=ROUNDING
    )


def test_arrays_of_moments_and_matrices_give_arrays_of_inertias():
    i3 = np.linspace(2.2, 2.9, 6).reshape(2, 3)
    many = ph.Inertia.from_principal_moments(1, [[1.5], [2]], i3)
    assert many.shape == (2, 3)
    for (i, j), one in np.ndenumerate(many):
        assert type(one) is ph.Inertia
        assert one == ph.Inertia.from_principal_moments(1, 1.5 + i / 2, i3[i, j])
    turns = ph.Rotor.random((2, 3), rng=np.random.default_rng(3)).to_matrix()
    tensors = turns @ np.stack([one.matrix for one in many.flat]).reshape(2, 3, 3, 3) @ turns.swapaxes(-1, -2)
    assert ph.Inertia.from_matrix(np.zeros((0, 3, 3))).shape == (0,)
    for index, one in np.ndenumerate(ph.Inertia.from_matrix(tensors)):
        alone = ph.Inertia.from_matrix(tensors[index])
        assert one == alone
        np.testing.assert_array_equal(one.principal_moments, alone.principal_moments)
        np.testing.assert_array_equal(one.principal_frame.components, alone.principal_frame.components)
    # Enough rows for several threads, in their order.
    column = np.linspace(1, 2, 40_000)
    several = ph.Inertia.from_principal_moments(column, 2, 2.5)
    assert [several[k].principal_moments[0] for k in (0, 19_999, -1)] == [1, column[19_999], 2]


def test_inertias_compare_and_hash_by_value():
    a, b = ph.Inertia.from_principal_moments(1, 2, 3), ph.Inertia.from_matrix(np.diag([1.0, 2.0, 3.0]))
    assert a == b
    assert hash(a) == hash(b)
    assert a != ph.Inertia.from_principal_moments(1, 3, 2)
    assert a != "a"


def test_repr():
    assert "1, 2, 3 kg m²" in repr(ph.Inertia.from_principal_moments(1, 2, 3))
    # A rounding error beside a component of the centre is left out.
    moved = ph.Body.sphere(1, mass=2).moved(position=[3.0, 1e-16, 0.0])
    assert "centre of mass 3 e1 m" in repr(moved)
    text = repr(ph.Body.sphere(1, mass=2))
    assert "2 kg" in text
    assert "0.8" in text


def test_principal_moments_come_one_by_one_or_as_an_array():
    batch = np.array([[1.0, 2.0, 2.5], [2.0, 2.0, 3.0]])
    assert ph.Inertia.from_principal_moments([1, 2, 2.5]) == ph.Inertia.from_principal_moments(1, 2, 2.5)
    for found, expected in zip(ph.Inertia.from_principal_moments(batch), batch, strict=True):
        assert found == ph.Inertia.from_principal_moments(*expected)
    with pytest.raises(TypeError, match="i3 is missing"):
        ph.Inertia.from_principal_moments(1, 2)
    with pytest.raises(ValueError, match="an array of principal moments needs 3 components"):
        ph.Inertia.from_principal_moments([1, 2])
