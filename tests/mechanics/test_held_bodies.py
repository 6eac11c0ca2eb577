"""Bodies held at a pivot under gravity."""

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3
from polhode._scene.writer import scene_text

G = 9.81
# The gyroscope of the README; the pivot lies 0.2 N m of weight below its centre.
TOP = ph.Body.cylinder(radius=0.05, height=0.01, mass=0.5)
PIVOT = np.array([0, 0, -0.2 / (0.5 * G)])
TILTED = ph.Rotor.from_plane_angle(e2 ^ e3, 0.5)
START = ph.State(TILTED, [0.1, 0, 20.0])
TIMES = np.linspace(0, 2, 11)
# A body without any symmetry, its centre of mass off all axes.
BENT = ph.Body.box([0.1, 0.2, 0.3], mass=2.0).moved(ph.Rotor.random(rng=1), [0.3, -0.1, 0.2])
BENT_PIVOT = np.array([0.1, 0.05, -0.4])


def moment(body, g, pivot):
    """Return ``m g (centre of mass − pivot)``."""
    return body.mass * g * (body.center_of_mass - ph.vector(pivot))


def test_the_gyroscope_of_the_readme_has_its_moments():
    motion = ph.simulate(TOP, START, TIMES, ph.torque.gravity(TOP, pivot=PIVOT))
    # m (3 r² + h²)/12 + m d² and ½ m r²; the moment about the centre alone is 3.17e-4.
    transverse = 0.5 * (3 * 0.05**2 + 0.01**2) / 12 + 0.5 * PIVOT[2] ** 2
    np.testing.assert_allclose(
        np.diag(motion.inertia.matrix), [transverse, transverse, 0.5 * 0.5 * 0.05**2], rtol=1e-15
    )
    assert round(transverse, 6) == 1.148e-3
    exact = ph.LagrangeTop(
        ph.Inertia.from_matrix(np.diag([transverse, transverse, 6.25e-4])), TILTED, [0.1, 0, 20], [0, 0, 0.2]
    ).at(TIMES)
    # Rounding of the moments, seen after 40 rad.
    assert (motion.rotor - exact.rotor).norm().max() < 1e-13


@pytest.mark.parametrize("pivot", [(0, 0, 0), BENT_PIVOT])
def test_gravity_equals_heavy_with_the_inertia_about_the_pivot(pivot):
    motion = ph.simulate(BENT, START, TIMES, ph.torque.gravity(BENT, 1.6, pivot))
    c = moment(BENT, 1.6, pivot)
    expected = ph.simulate(BENT.inertia_about(pivot), START, TIMES, ph.torque.heavy(c))
    # Both are stepped to 1e-10.
    assert (motion.rotor - expected.rotor).norm().max() < 1e-9
    assert motion.certificate.conserved.keys() == expected.certificate.conserved.keys()
    law = ph.torque.gravity(BENT, 1.6, pivot)
    assert law.at(BENT, START).is_close((~TILTED)(e3).wedge(c), rtol=1e-14)


def test_a_small_pendulum_swings_with_its_period():
    body = ph.Body.rod(1.0, mass=3.0) + ph.Body.sphere(0.1, mass=1.0)
    law = ph.torque.gravity(body, G, pivot=[0, 0, 0.5])
    tilt = 1e-4
    start = ph.State(ph.Rotor.from_plane_angle(e2 ^ e3, tilt), [0, 0, 0])
    about = body.inertia_about([0, 0, 0.5]).matrix[0, 0]
    period = 2 * np.pi * np.sqrt(about / (4 * G * 0.5))
    motion = ph.simulate(body, start, [0.25 * period, 0.5 * period], law)
    swung = motion.rotor.to_rotation_vector()[:, 0]
    # The period grows by tilt²/16 of itself.
    np.testing.assert_allclose(swung, [0, -tilt], rtol=0, atol=tilt**3)


def test_laws_add_up_and_are_values():
    law = ph.torque.gravity(TOP, pivot=PIVOT)
    assert law == ph.torque.gravity(TOP, G, ph.vector(PIVOT))
    assert hash(law) == hash(ph.torque.gravity(TOP, pivot=PIVOT))
    assert law != ph.torque.gravity(TOP, 1.6, PIVOT)
    assert law.holds
    assert "pivot=[0.0, 0.0, -0.04" in repr(law)
    damped = law + ph.torque.formula("-k Ω", k=1e-3)
    motion = ph.simulate(TOP, START, TIMES, damped)
    heavy = ph.torque.heavy([0, 0, 0.2]) + ph.torque.formula("-k Ω", k=1e-3)
    expected = ph.simulate(TOP.inertia_about(PIVOT), START, TIMES, heavy)
    assert (motion.rotor - expected.rotor).norm().max() < 1e-9  # both are stepped to 1e-10


def test_weights_about_one_pivot_add_up():
    half, whole = (ph.torque.gravity(TOP, g, PIVOT) for g in (G / 2, G))
    twice, once = (ph.simulate(TOP, START, TIMES, law, rtol=1e-10) for law in (half + half, whole))
    assert twice.rotor.distance(once.rotor).max() <= 1e-8
    with pytest.raises(ValueError, match="hold the body at different points"):
        ph.simulate(TOP, START, TIMES, half + ph.torque.gravity(TOP, G / 2))


def test_batches_of_bodies_accelerations_and_pivots():
    bodies = [TOP, BENT, TOP + BENT]
    g = np.array([[G], [1.6]])
    pivots = np.array([[0, 0, -0.1], BENT_PIVOT, [0.2, 0, 0]])
    law = ph.torque.gravity(bodies, g, pivots)
    assert law.shape == (2, 3)
    motion = ph.simulate(bodies, START, [0.5], law)
    assert motion.shape == (2, 3)
    assert motion.ok.all()
    blocks = ph.simulate_blocks(bodies, START, [0.5], law, block=1)
    for i, (_, part) in enumerate(blocks):
        for k, body in enumerate(bodies):
            alone = ph.simulate(body, START, [0.5], ph.torque.gravity(body, g[i, 0], pivots[k]))
            assert (motion[i, k].rotor - alone.rotor).norm().max() < 1e-9  # both to 1e-10
            assert np.all(part.rotor[0, k] == motion.rotor[i, k])
    # One body at several pivots has several inertias.
    spread = ph.simulate(TOP, START, [0.5], ph.torque.gravity(TOP, pivot=pivots))
    assert spread.inertia.shape == (3,)
    assert spread.inertia[0] == TOP.inertia_about(pivots[0])


def test_a_scene_gives_the_same_motion(tmp_path):
    path = tmp_path / "top.toml"
    path.write_text(
        "[body]\nsolid = 'cylinder'\nradius = 0.05\nheight = 0.01\nmass = 0.5\n"
        "[initial]\nattitude = { plane = 'e2e3', angle = 0.5 }\nspin = { vector = [0.1, 0, 20] }\n"
        f"[gravity]\nacceleration = {G}\npivot = [0, 0, {float(PIVOT[2])!r}]\n"
        "[run]\nduration = 2\nsamples = 11\n"
    )
    scene = ph.Scene.read(path)
    law = ph.torque.gravity(TOP, G, PIVOT)
    motion = ph.simulate(TOP, scene.state, scene.times, law)
    assert np.all(scene.run().rotor == motion.rotor)
    # The law of a page is written as the weight on the body about the pivot.
    again = tmp_path / "again.toml"
    again.write_text(scene_text(motion._origin))
    assert np.all(ph.Scene.read(again).run().rotor == motion.rotor)


CONTRADICTIONS = {
    "at the centre": (TOP, [0, 0, 0.2]),
    "beside the centre": (BENT, (moment(BENT, G, [0, 0, 0]) + 0.1 * e2).components),
    "upside down": (BENT, -moment(BENT, G, [0, 0, 0]).components),
}


@pytest.mark.parametrize("name", CONTRADICTIONS)
def test_a_weight_that_contradicts_the_body_raises(name):
    body, c = CONTRADICTIONS[name]
    law = ph.torque.heavy(c)
    remedy = r"centre of mass.*ph\.torque\.gravity\(body, g, pivot\)"
    with pytest.raises(ValueError, match=remedy):
        ph.simulate(body, START, TIMES, law)
    with pytest.raises(ValueError, match=remedy):
        law.at(body, START)
    with pytest.raises(ValueError, match=r"at index \(1,\): .*" + remedy):
        ph.simulate([BENT, body], START, TIMES, ph.torque.heavy([moment(BENT, G, [0, 0, 0]).components, c]))
    with pytest.raises(ValueError, match=r"at index \(2,\): .*" + remedy):
        ph.simulate([body], START, TIMES, ph.torque.heavy([np.zeros(3), np.zeros(3), c]))
    # An inertia leaves the centre of mass open.
    assert ph.simulate(body.inertia, START, [0.1], law).certificate.conserved.keys() >= {"energy"}


def test_closed_forms_need_the_inertia_about_the_pivot():
    with pytest.raises(TypeError, match=r"see Body\.inertia_about\(pivot\)"):
        ph.LagrangeTop(TOP, TILTED, [0.1, 0, 20], [0, 0, 0.2])


def test_a_weight_with_six_digits_is_accepted():
    c = moment(BENT, G, [0, 0, 0]).components
    typed = [float(f"{x:.7g}") for x in c]
    assert ph.simulate(BENT, START, [0.1], ph.torque.heavy(typed)).certificate.error_estimate < 1e-9
    assert ph.simulate(TOP, START, [0.1], ph.torque.heavy([0, 0, 0])).certificate.method == "exact"


def test_contradictory_scenes_are_reported_at_their_place(tmp_path):
    text = (
        "[body]\nsolid = 'cylinder'\nradius = 0.05\nheight = 0.01\nmass = 0.5\n[initial]\n"
        "spin = { vector = [0.1, 0, 20] }\n[torque]\nheavy = [0, 0, 0.2]\n[run]\nduration = 2\n"
    )
    path = tmp_path / "top.toml"
    path.write_text(text)
    with pytest.raises(ph.SceneError, match=r"top\.toml:9:9: error: .*centre of mass.*\[gravity\]"):
        ph.Scene.read(path)
    # Moments without a centre of mass are those about the fixed point.
    path.write_text(text.replace("solid = 'cylinder'\nradius = 0.05\nheight = 0.01", "moments = [2, 2, 1]"))
    assert ph.Scene.read(path).run().certificate.method == "exact"


def test_gravity_of_another_body_raises():
    law = ph.torque.gravity(TOP, pivot=PIVOT)
    with pytest.raises(ValueError, match=r"made for a body of 0\.5 kg .* this body has 2\.0 kg"):
        ph.simulate(BENT, START, TIMES, law)
    with pytest.raises(ValueError, match=r"body and torque do not broadcast.*\(2,\).*\(3,\)"):
        ph.simulate([TOP] * 2, START, TIMES, ph.torque.gravity([TOP] * 3, pivot=PIVOT))
    with pytest.raises(
        ValueError, match=r"different points, \[0\.0, 0\.0, -0\.04.*\] and \[0\.0, 0\.0, 0\.0\]"
    ):
        ph.simulate(TOP, START, TIMES, law + ph.torque.heavy([0, 0, 0.2]))
    with pytest.raises(TypeError, match=r"gravity needs a Body.*heavy\(c\)"):
        ph.torque.gravity(TOP.inertia)
    with pytest.raises(
        ValueError, match=r"g must be a number, .* got the vector \[0, 0, -9.81\]; write g=9.81"
    ):
        ph.torque.gravity(TOP, [0, 0, -9.81])
    assert ph.torque.gravity(TOP, [9.81, 1.6, 0]).shape == (3,)
    with pytest.raises(ValueError, match=r"the pivot is .*nan"):
        ph.torque.gravity(TOP, pivot=[0, 0, np.nan])
    # An inertia is that about the pivot.
    about = TOP.inertia_about(PIVOT)
    assert np.all(ph.simulate(about, START, TIMES, law).rotor == ph.simulate(TOP, START, TIMES, law).rotor)


def test_the_position_is_that_of_the_pivot():
    start = ph.State(TILTED, [0.1, 0, 20.0], position=[1, 2, 3])
    motion = ph.simulate(TOP, start, TIMES, ph.torque.gravity(TOP, pivot=PIVOT))
    assert np.all(motion.position == e1 + 2 * e2 + 3 * e3)


def test_jax_accepts_held_bodies():
    pytest.importorskip("jax")
    law = ph.torque.gravity(BENT, pivot=BENT_PIVOT)
    rotors, _ = ph.jax.simulate(BENT, TILTED, [0.1, 0, 2.0], [0.5], law, step=0.01)
    expected = ph.simulate(BENT, ph.State(TILTED, [0.1, 0, 2.0]), [0.5], law, method="kahan_li8", step=0.01)
    # The same steps in single precision.
    assert np.abs(np.asarray(rotors) - expected.rotor.components).max() < 1e-5
    for heavy in (ph.torque.heavy([0, 0, 1]), ph.jax.torque.heavy([0, 0, 1.0])):
        with pytest.raises(ValueError, match="centre of mass"):
            ph.jax.simulate(BENT, TILTED, [0.1, 0, 2.0], [0.5], heavy, step=0.01)
