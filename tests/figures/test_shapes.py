"""Bodies as they are drawn: their surfaces, and that what is behind them is hidden."""

import numpy as np
import pytest

import polhode as ph
from command_line import EXAMPLES

pytest.importorskip("matplotlib")
from polhode._figures import painter as _painter
from polhode._figures import shapes
from polhode._figures.camera import View


def free(i):
    inertia = ph.Inertia.from_principal_moments(*i)
    return ph.simulate(inertia, ph.State(ph.Rotor.identity(), [0.25, -0.5, 1.0]), np.linspace(0, 10, 201))


def top():
    inertia = ph.Inertia.from_principal_moments(1, 1, 0.5)
    state = ph.State(ph.Rotor.identity(), [0.25, -0.5, 6.0])
    return ph.simulate(inertia, state, np.linspace(0, 10, 401), ph.torque.heavy([0, 0, 2]))


def test_the_surface_is_that_of_the_scene():
    scene = ph.Scene.read(EXAMPLES / "t-handle.toml")
    surface = shapes.surface_of(scene.run())
    a, b, c = (surface.vertices[surface.faces[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6
    assert 7850 * volume == pytest.approx(scene.body.mass, rel=1e-9)
    # About its centre of mass: the mean of the tetrahedra's middles.
    weights = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    np.testing.assert_allclose(weights @ (a + b + c) / 4 / volume, 0, atol=1e-12)


@pytest.mark.parametrize(
    ("body", "size"),
    [
        ('solid = "box"\nlengths = ["10 cm", 0.2, 0.3]', (0.05, 0.1, 0.15)),
        ('solid = "ellipsoid"\nsemi_axes = [1, 2, 3]', (1, 2, 3)),
        ('solid = "sphere"\nradius = "20 mm"', (0.02,) * 3),
        ('solid = "hollow_sphere"\nouter_radius = 2\ninner_radius = 1', (2,) * 3),
        ('solid = "cylinder"\nradius = 1\nheight = 6', (1, 1, 3)),
        ('solid = "capsule"\nradius = 1\nheight = 2', (1, 1, 2)),
        ('solid = "cone"\nradius = 1\nheight = 4', (1, 1, 3)),
        ('solid = "torus"\nmajor_radius = 2\nminor_radius = 0.5', (2.5, 2.5, 0.5)),
        ('solid = "disc"\nradius = 2', (2, 2, 0.025)),
    ],
)
def test_every_solid_is_drawn_about_its_centre_of_mass(body, size, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(
        f"[body]\n{body}\nmass = 1\n[initial]\nspin = {{ vector = [0, 0, 1] }}\n"
        "[run]\nduration = 1\nsamples = 5\n"
    )
    motion = ph.Scene.read(path).run()
    vertices, faces, *_, told = shapes.surface_of(motion)
    assert told == f"the {motion._origin.solid['kind'].replace('_', ' ')}"
    np.testing.assert_allclose(np.abs(vertices).max(axis=0), size, rtol=1e-12)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    weights = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    assert weights.sum() > 0  # the faces look outwards
    # The cone has as many sides as are drawn, so that its middle is off by none along the axis.
    np.testing.assert_allclose(weights @ (a + b + c) / 4 / weights.sum(), 0, atol=1e-9 * max(size))


def test_held_bodies_are_drawn_about_the_fixed_point():
    motion = ph.Scene.read(EXAMPLES / "gyroscope.toml").run()
    heights = shapes.surface_of(motion).vertices[:, 2]
    np.testing.assert_allclose([heights.min(), heights.max()], [0.035, 0.045], rtol=1e-12)


def test_a_rod_is_drawn_as_a_rod(tmp_path):
    """Held beside its line, for about that line it has no moment."""
    path = tmp_path / "scene.toml"
    path.write_text(
        '[body]\nsolid = "rod"\nlength = 2\nmass = 1\n[initial]\nspin = { vector = [0, 0, 1] }\n'
        "[gravity]\nacceleration = 9.81\npivot = [0.5, 0, 0]\n[run]\nduration = 1\nsamples = 5\n"
    )
    surface = shapes.surface_of(ph.Scene.read(path).run())
    assert surface.told == "the rod"
    np.testing.assert_allclose(np.ptp(surface.vertices, axis=0), [0.12, 0.12, 2], rtol=1e-12)
    np.testing.assert_allclose(surface.vertices.mean(axis=0), [-0.5, 0, 0], atol=1e-12)


def test_unknown_bodies_have_their_ratios_of_moments():
    box = shapes.surface_of(free((1, 2, 2.5)))
    lengths = np.ptp(box.vertices, axis=0)
    moments = (lengths**2).sum() - lengths**2
    np.testing.assert_allclose(moments / moments[0], [1, 2, 2.5], rtol=1e-12)
    ball = shapes.surface_of(free((1, 1.01, 1.02)))
    assert "ball" in ball.told


def test_unknown_held_bodies_stand_on_the_fixed_point():
    spinning = shapes.surface_of(top())
    assert spinning.told == "drawn as a spinning top"
    np.testing.assert_array_equal(spinning.center, [0, 0, 2])
    # Its tip is the fixed point, and it goes up along the axis to the centre of mass and beyond.
    np.testing.assert_allclose(spinning.vertices[:, 2].min(), 0, atol=1e-12)
    assert np.linalg.norm(spinning.vertices, axis=1).min() == 0
    assert spinning.vertices[:, 2].max() == pytest.approx(1.63 * 2)
    box = shapes.surface_of(ph.Scene.read(EXAMPLES / "kovalevskaya.toml").run())
    np.testing.assert_allclose(box.vertices.mean(axis=0), [3, 0, 0], atol=1e-12)
    np.testing.assert_array_equal(box.center, [3, 0, 0])


def test_faces_are_told_apart():
    """A box has a tint for the two sides across each axis; what is round has quadrants."""
    vertices, faces = shapes.box(np.array([1.0, 2.0, 3.0]))
    tints = shapes._sides(vertices, faces)
    for k in range(3):
        corners = vertices[faces[tints == 2 + k]]
        assert len(corners) == 4
        np.testing.assert_array_equal(np.abs(corners[..., k]), (k + 1) / 2)
    vertices, faces = shapes.cone(radius=1.0, height=2.0)
    assert shapes._quadrants(vertices, faces).mean() == pytest.approx(0.5)


def test_what_is_behind_the_body_is_not_drawn():
    """Points behind, within, beside and before a box, by a ray through the box itself."""
    view = View(20, 30)
    painter = _painter.Painter(view)
    vertices, faces = shapes.box(np.array([1.0, 2.0, 0.5]))
    corners = vertices[faces]
    painter.faces(corners, np.ones((len(corners), 3)), corners)
    points = np.random.default_rng(0).uniform(-1.5, 1.5, (4000, 3))
    hidden = painter.hidden(points)
    steps = np.linspace(0, 6, 3001)
    on_ray = points[:, np.newaxis] + steps[:, np.newaxis] * view.toward
    expected = (np.abs(on_ray) <= [0.5, 1.0, 0.25]).all(axis=2).any(axis=1)
    # Rays that graze an edge, or points at a hair from a face, are decided either way.
    assert (hidden != expected).mean() < 0.01
    assert 200 < expected.sum() < 3000


def test_cutting_by_a_plane_keeps_areas_and_sides():
    corners = np.random.default_rng(1).normal(size=(200, 3, 3))
    normal = np.array([0.6, 0.0, 0.8])
    cut, origin = _painter._split(corners, np.arange(200), normal)

    def areas(t):
        return 0.5 * np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1)

    np.testing.assert_allclose(np.bincount(origin, areas(cut)), areas(corners), rtol=1e-10)
    heights = cut @ normal
    assert ((heights >= -1e-12).all(axis=1) | (heights <= 1e-12).all(axis=1)).all()
    assert len(cut) > 300
