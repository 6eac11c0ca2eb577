"""Torques that depend on position and velocity of the centre of mass."""

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import polhode as ph

SPHERE = ph.Body.sphere(1.0, mass=2.0)  # moments 0.8 kg m²
MOMENT = 0.8
TIMES = np.linspace(0.0, 3.0, 7)


def _flying(velocity: list[float], position: tuple[float, ...] = (0.0, 0.0, 0.0)) -> ph.State:
    return ph.State(ph.Rotor.identity(), [0.0, 0.0, 0.0], position=position, velocity=velocity)


def _pull_of_air(t, rotor, omega_body, position, velocity):
    return rotor.reverse()(velocity ^ ph.e3)


@pytest.mark.parametrize("method", ["auto", "dop853", "rk4"])
def test_a_sphere_spins_up_with_the_integral_of_its_velocity(method: str) -> None:
    """Under drag v falls as exp(-kt/m), and so does the torque v∧e3: ω = (m/kJ)(1 - exp(-kt/m)) v0∧e3."""
    law = ph.torque.formula("v∧e3", frame="space")
    motion = ph.simulate(
        SPHERE, _flying([3.0, 0, 0]), TIMES, law, force=ph.force.drag(0.5), method=method, rtol=1e-9
    )
    expected = 3.0 * 2.0 / (0.5 * MOMENT) * -np.expm1(-0.25 * TIMES)
    error = np.abs((motion.omega_space | (ph.e1 ^ ph.e3)).components[:, 0] + expected).max()
    assert error <= max(motion.certificate.error_estimate, 1e-14) * expected.max()
    assert motion.certificate.error_estimate <= 1e-9


def test_position_and_mass_act_without_a_force() -> None:
    """With x = vt the torque m x∧e3 gives ω = m t²/(2J) v∧e3, also from a rate and a place at the start."""
    law = ph.torque.formula("m x∧e3", frame="space")
    motion = ph.simulate(SPHERE, _flying([0, 1.5, 0], (0, 0.25, 7)), TIMES, law)
    expected = 2.0 / MOMENT * (0.25 * TIMES + 0.75 * TIMES**2)
    error = np.abs((motion.omega_space | (ph.e2 ^ ph.e3)).components[:, 0] + expected).max()
    assert error <= motion.certificate.error_estimate * expected.max()
    assert motion.position[-1].is_close(ph.vector([0, 0.25 + 4.5, 7]))


def test_the_tide_of_a_centre_is_the_gravity_gradient() -> None:
    """3μ/r⁵ x × I(x) on a circular orbit about the centre is the law gravity_gradient of the orbit's rate."""
    mu, radius = 2.0, 1.25
    rate = math.sqrt(mu / radius**3)
    moments = np.array([1.0, 1.5, 1.8])
    body = ph.Body(1.0, ph.Inertia.from_matrix(np.diag(moments)))

    def tide(t, rotor, omega_body, position, velocity):
        u = rotor.reverse()(position).components
        return 3.0 * mu / np.linalg.norm(u) ** 5 * np.cross(u, moments * u)

    start = ph.State(
        ph.Rotor.exp(ph.bivector([0.1, 0.2, -0.3])),
        [0.1, 0.3, rate],
        position=[radius, 0, 0],
        velocity=[0, rate * radius, 0],
    )
    options = {"rtol": 1e-11, "method": "dop853"}
    law = ph.torque.function(tide, center=True)
    found = ph.simulate(body, start, TIMES, law, force=ph.force.central(mu), **options)
    known = ph.simulate(body, start, TIMES, ph.torque.gravity_gradient(rate), **options)
    bound = found.certificate.error_estimate + known.certificate.error_estimate
    assert np.abs((found.rotor - known.rotor).components).max() <= bound
    assert bound < 1e-10


THROWN = ph.State(ph.Rotor.identity(), [0.3, 0, -20], position=[0, 0, 1], velocity=[10, 0, 1])
DISC = ph.Body.disc(0.135, mass=0.175)
AIR = ph.force.formula("-m g e3 + k cross(cross(v, R e3 ~R), v)", g=9.81, k=0.012)
PITCHING = ph.torque.formula("k (v·(R e3 ~R)) v∧(R e3 ~R)", frame="space", k=4e-3)


def test_formulas_functions_and_steppers_agree() -> None:
    def pitching(t, rotor, omega_body, position, velocity):
        axis = rotor(ph.e3)
        return rotor.reverse()(4e-3 * velocity.dot(axis) * (velocity ^ axis))

    times = [0.0, 0.25, 0.5]
    by_formula = ph.simulate(DISC, THROWN, times, PITCHING, force=AIR, rtol=1e-10)
    law = ph.torque.function(pitching, center=True)
    by_function = ph.simulate(DISC, THROWN, times, law, force=AIR, rtol=1e-10)
    bound = by_formula.certificate.error_estimate + by_function.certificate.error_estimate
    assert np.abs((by_formula.rotor - by_function.rotor).components).max() <= bound
    stepper = ph.Stepper(DISC, THROWN, PITCHING, force=AIR, method="dop853")
    for _ in range(50):
        stepper.step(0.01)
    assert stepper.state.rotor.is_close(by_formula.rotor[-1], atol=1e-8)
    assert stepper.state.position.is_close(by_formula.position[-1], atol=1e-8)


def test_batches_are_their_bodies_alone() -> None:
    starts = ph.State(
        ph.Rotor.identity(), np.array([[0.3, 0, -20], [0.1, 0, -30], [0, 0.2, 10]]), velocity=[10, 0, 1]
    )
    strengths = ph.scalar([1e-3, 2e-3, 4e-3])
    law = ph.torque.formula("k (v·(R e3 ~R)) v∧(R e3 ~R)", frame="space", k=strengths)
    many = ph.simulate(DISC, starts, [0.0, 0.5], law, force=ph.force.drag(0.01))
    for k in range(3):
        law = ph.torque.formula("k (v·(R e3 ~R)) v∧(R e3 ~R)", frame="space", k=float(strengths[k]))
        one = ph.simulate(DISC, starts[k], [0.0, 0.5], law, force=ph.force.drag(0.01))
        assert np.array_equal(many.rotor[k].components, one.rotor.components)
        assert np.array_equal(many.position[k].components, one.position.components)


def test_the_mass_alone_needs_no_other_method() -> None:
    law = ph.torque.formula("m g e1∧e2", g=2.0)
    bodies = [ph.Body.sphere(1.0, mass=1.0), SPHERE]
    for body in bodies:
        motion = ph.simulate(body, _flying([0, 0, 0]), [2.0], law, method="kahan_li8")
        expected = 4.0 * body.mass / body.inertia.principal_moments[0]
        assert motion.omega_body["e12"] == pytest.approx([expected], rel=1e-12)
    many = ph.simulate(bodies, _flying([0, 0, 0]), [2.0], law)
    assert many.omega_body["e12"].ravel() == pytest.approx([10.0, 10.0], rel=1e-9)
    stepper = ph.Stepper(SPHERE, _flying([0, 0, 0]), law)
    stepper.step(0.1)
    assert stepper.state.omega_body["e12"] == pytest.approx(0.5, rel=1e-12)


def test_values_hide_the_names_of_the_motion() -> None:
    law = ph.torque.formula("m v∧x", m=2.0, v=ph.e1, x=ph.e2)
    state = _flying([0, 0, 5.0], (0, 0, 3.0))
    assert law.at(SPHERE, state).is_close(2 * (ph.e1 ^ ph.e2))


def test_at_knows_the_centre_of_mass() -> None:
    law = ph.torque.formula("m x∧v")
    state = _flying([0, 3.0, 0], (2.0, 0, 0))
    assert law.at(SPHERE, state).is_close(12 * (ph.e1 ^ ph.e2))
    inertia = ph.Inertia.from_principal_moments(1, 1, 1)
    with pytest.raises(ValueError, match="`m` is not known"):
        law.at(inertia, state)
    assert ph.torque.formula("x∧v").at(inertia, state).is_close(6 * (ph.e1 ^ ph.e2))


@pytest.mark.parametrize("method", ["kahan_li8", "midpoint", "dmv", "rkn6"])
def test_methods_that_do_not_follow_the_centre_refuse(method: str) -> None:
    with pytest.raises(ValueError, match=r"depend on position or velocity; use auto, dop853 or rk4"):
        ph.simulate(DISC, THROWN, [1.0], PITCHING, method=method)


def test_functions_of_the_centre_are_laws_like_others() -> None:
    law = ph.torque.function(_pull_of_air, center=True)
    assert repr(law) == "function(_pull_of_air, center=True)"
    state = _flying([2.0, 0, 0])
    for same in (pickle.loads(pickle.dumps(law)), 0.5 * (2 * law), -1 * -law):
        assert same.at(SPHERE, state).is_close(2 * (ph.e1 ^ ph.e3))
    with pytest.raises(TypeError, match="center must be True or False, got 'yes'"):
        ph.torque.function(_pull_of_air, center="yes")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="position and velocity, which <lambda> does not take"):
        ph.torque.function(lambda t, rotor, omega_body: omega_body, center=True)


def test_events_and_later_times_follow_the_centre() -> None:
    ground = ph.event.position(ph.e3, 1.1)
    motion = ph.simulate(DISC, THROWN, [0.0, 0.6], PITCHING, force=AIR, events=ground, rtol=1e-9)
    (fall,) = motion.events
    assert fall.position["e3"] == pytest.approx([1.1, 1.1], abs=1e-9)
    later = motion.at(fall.time)
    assert later.position.is_close(fall.position, atol=1e-9).all()
    assert later.rotor.is_close(fall.rotor, atol=1e-8).all()


def test_scenes_have_the_names_of_the_centre(tmp_path: Path) -> None:
    """After a number `m` is the metre; names of `[define]` come first."""
    scene = """
torque_space = "k (2 m) m v∧e3"
[define]
k = "0.25"
[body]
solid = "sphere"
radius = "1 m"
mass = "2 kg"
[initial]
spin = { vector = [0, 0, 0] }
velocity = ["3 m/s", 0, 0]
[run]
duration = "2 s"
"""
    (tmp_path / "a.toml").write_text(scene, encoding="utf-8")
    motion = ph.Scene.read(tmp_path / "a.toml").run()
    # k · 2 · m v∧e3 = 0.25 · 2 · 2 kg · 3 e1∧e3
    expected = 3.0 * 2.0 / MOMENT
    assert (motion.omega_space[-1] | (ph.e1 ^ ph.e3)).components == pytest.approx(-expected, rel=1e-12)
    (tmp_path / "a.toml").write_text(scene.replace('"0.25"', '"0.25"\nv = "e2"'), encoding="utf-8")
    motion = ph.Scene.read(tmp_path / "a.toml").run()
    expected = 2.0 / MOMENT
    assert (motion.omega_space[-1] | (ph.e2 ^ ph.e3)).components == pytest.approx(-expected, rel=1e-12)
