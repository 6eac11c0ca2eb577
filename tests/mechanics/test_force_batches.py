"""Parameters of forces with a value for each body of a batch."""

import pickle

import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0

F = ph.force
BODY = ph.Body.box([1, 2, 3], mass=2.0)
START = ph.State(R0, [0.25, -0.5, 1.0], position=[1, 2, 3], velocity=[-1, 0.5, 0.25])
TIMES = np.linspace(-0.5, 2.0, 6)
VECTORS = np.array([[0.5, 0.0, -3.0], [0.0, 0.0, 0.0], [1.0, 2.0, -1.0]])
NUMBERS = np.array([0.0, 0.5, 2.0])

# Of each: the law of all bodies, and that of the body k.
LAWS = {
    "constant": (F.constant(VECTORS), lambda k: F.constant(VECTORS[k])),
    "constant vectors": (F.constant(ph.vector(VECTORS)), lambda k: F.constant(VECTORS[k])),
    "thrust": (F.thrust(VECTORS), lambda k: F.thrust(VECTORS[k])),
    "thrust at points": (F.thrust([0, 0, 1], VECTORS), lambda k: F.thrust([0, 0, 1], VECTORS[k])),
    "thrusts at a point": (F.thrust(VECTORS, ph.e1), lambda k: F.thrust(VECTORS[k], ph.e1)),
    "drag": (F.drag(NUMBERS), lambda k: F.drag(NUMBERS[k])),
    "quadratic_drag": (F.quadratic_drag(NUMBERS), lambda k: F.quadratic_drag(NUMBERS[k])),
    "spring": (F.spring(NUMBERS, [0, 1, 0]), lambda k: F.spring(NUMBERS[k], [0, 1, 0])),
    "spring at points": (F.spring(2, VECTORS), lambda k: F.spring(2, VECTORS[k])),
    "central": (F.central(1 + NUMBERS), lambda k: F.central(1 + NUMBERS[k])),
    "formula": (
        F.formula("q cross(v, B) - k x", q=ph.scalar(NUMBERS), B=ph.vector(VECTORS), k=0.5),
        lambda k: F.formula("q cross(v, B) - k x", q=NUMBERS[k], B=ph.vector(VECTORS[k]), k=0.5),
    ),
    "sum": (
        -9.81 * ph.e3 + F.drag(NUMBERS) - ph.vector(VECTORS),
        lambda k: F.constant([0, 0, -9.81]) + F.drag(NUMBERS[k]) - ph.vector(VECTORS[k]),
    ),
}
PARTS = ("position", "velocity", "omega_body", "rotor")


def assert_same(many, one):
    """Bodies take the same steps as alone; their sums may be rounded otherwise."""
    for part in PARTS:
        a, b = (getattr(motion, part).components for motion in (many, one))
        np.testing.assert_allclose(a, b, rtol=0, atol=64 * EPS * np.abs(b).max())


@pytest.mark.parametrize("name", LAWS)
def test_each_body_has_its_own_force(name):
    law, of_body = LAWS[name]
    assert law.shape == (3,)
    many = ph.simulate(BODY, START, TIMES, force=law)
    assert many.shape == (3,)
    for k in range(3):
        assert_same(many[k], ph.simulate(BODY, START, TIMES, force=of_body(k)))


def test_an_array_of_vectors_is_a_force_for_each_body():
    assert VECTORS + F.drag(1) == F.constant(VECTORS) + F.drag(1)
    assert F.drag(1) + VECTORS == F.drag(1) + F.constant(VECTORS)
    assert F.drag(1) - VECTORS == F.drag(1) + F.constant(0.0 - VECTORS)
    many = ph.simulate(BODY, START, TIMES, force=VECTORS)
    assert_same(many, ph.simulate(BODY, START, TIMES, force=F.constant(VECTORS)))


@pytest.mark.parametrize("module", ["force", "torque"])
def test_laws_of_one_kind_broadcast(module):
    """The batch shape of a sum is that of all its laws, in any order."""
    make = ph.force.drag if module == "force" else ph.torque.damping
    one, few, column = make(0.25), make([0.1, 0.2, 0.3]), make([[1.0], [2.0]])
    alone = make(2.0) + make(0.3) + make(0.25)
    for law in (few + column + one, one + column + few, column + few + one):
        assert law.shape == (2, 3)
        many = ph.simulate(BODY, START, TIMES, **{module: law})
        assert many.shape == (2, 3)
        assert_same(many[1, 2], ph.simulate(BODY, START, TIMES, **{module: alone}))
    with pytest.raises(ValueError, match=r"the laws do not broadcast .*\(3,\) of \w+, \(2,\) of \w+ \(2\)"):
        ph.simulate(BODY, START, TIMES, **{module: few + make([1.0, 2.0])})


def test_bodies_and_thrusts_broadcast():
    class Satellite(ph.Body):
        """A body with a name."""

    bodies = [BODY, BODY.moved(position=[0, 0, 1]), Satellite(3.0, BODY.inertia, [0, 1, 0])]
    law = F.thrust(VECTORS, ph.e1) + F.thrust(VECTORS[:2, np.newaxis], VECTORS)
    many = ph.simulate(bodies, START, TIMES, force=law)
    assert many.shape == (2, 3)
    for j, k in np.ndindex(2, 3):
        own = F.thrust(VECTORS[k], ph.e1) + F.thrust(VECTORS[j], VECTORS[k])
        assert_same(many[j, k], ph.simulate(bodies[k], START, TIMES, force=own))
    with pytest.raises(ValueError, match=r"of body and force do not broadcast together: \(2,\) of the body"):
        ph.simulate(bodies[:2], START, TIMES, force=law)


def test_parameters_and_starts_broadcast():
    starts = ph.State(R0, [0, 0, 1], velocity=VECTORS[:, np.newaxis])
    law, torque = F.spring(NUMBERS + 1, VECTORS[:2, np.newaxis]), ph.torque.damping([0.1, 0.2, 0.3])
    assert law.shape == (2, 3)
    many = ph.simulate(BODY, ph.State(R0, [0, 0, 1]), TIMES, torque, law)
    assert many.shape == (2, 3)
    alone = ph.simulate(
        BODY, ph.State(R0, [0, 0, 1]), TIMES, ph.torque.damping(0.3), F.spring(3.0, VECTORS[1])
    )
    assert_same(many[1, 2], alone)
    with pytest.raises(ValueError, match=r"do not broadcast .*\(2, 3\) of the force"):
        ph.simulate(BODY, starts, TIMES, force=law)


@pytest.mark.parametrize("name", LAWS)
def test_blocks_have_the_bits_of_the_whole(name):
    law, _ = LAWS[name]
    whole = ph.simulate(BODY, START, TIMES, force=law)
    for rows, part in ph.simulate_blocks(BODY, START, TIMES, force=law, block=2):
        for name in PARTS:
            one, other = getattr(whole[rows], name), getattr(part, name)
            np.testing.assert_array_equal(one.components, other.components)


@pytest.mark.parametrize("name", LAWS)
def test_steppers_take_batches_of_forces(name):
    law, of_body = LAWS[name]
    stepper = ph.Stepper(BODY, START, force=law, step=0.01)
    stepper.step(0.5)
    assert stepper.shape == (3,)
    for k in range(3):
        alone = ph.Stepper(BODY, START, force=of_body(k), step=0.01)
        alone.step(0.5)
        for part in PARTS:
            a, b = (getattr(state, part).components for state in (stepper.state[k], alone.state))
            np.testing.assert_allclose(a, b, rtol=0, atol=64 * EPS * np.abs(b).max())


@pytest.mark.parametrize("name", LAWS)
def test_batches_are_values(name):
    law, of_body = LAWS[name]
    again = pickle.loads(pickle.dumps(law))
    assert again == law
    assert hash(again) == hash(law)
    assert law != of_body(0)
    assert "batch (3,)" in repr(law)


def test_errors_name_the_body():
    with pytest.raises(ValueError, match=r"at index \(1,\): k is inf; it must be finite"):
        F.drag([0.1, np.inf])
    with pytest.raises(ValueError, match=r"at index \(1,\): .*F is \[0\.0, nan, 0\.0\]"):
        F.constant([[0, 0, 1], [0, np.nan, 0]])
    with pytest.raises(ValueError, match=r"spring do not broadcast .*\(3,\) of k, \(2,\) of anchor"):
        F.spring(NUMBERS, VECTORS[:2])
    with pytest.raises(ValueError, match=r"of the laws do not broadcast .*\(3,\) of drag, \(2,\) of spring"):
        ph.simulate(BODY, START, TIMES, force=F.drag(NUMBERS) + F.spring([1.0, 2.0]))
    with pytest.raises(ValueError, match=r"events are not supported for batches, got batch shape \(3,\)"):
        ph.simulate(BODY, START, TIMES, force=F.drag(NUMBERS), events=ph.event.position(ph.e3, 0))
    with pytest.raises(ValueError, match=r"at index \(1,\): k is nan; it must be finite"):
        F.formula("-k v", k=ph.scalar([1.0, np.nan]))
    for force in ([F.drag(1), F.drag(2)], ph.torque.damping(1)):
        with pytest.raises(TypeError, match=r"force must be a law of polhode.force, got .*; (add|give) "):
            ph.simulate(BODY, START, TIMES, force=force)
    with pytest.raises(TypeError, match=r"torque must be a law .* got Force; give a force as force="):
        ph.simulate(BODY, START, TIMES, F.drag(1))
    with pytest.raises(TypeError, match=r"a Torque can only be added to a Torque, got ndarray; for a"):
        VECTORS + ph.torque.damping(1)
    with pytest.raises(TypeError, match=r"a force needs a Body"):
        ph.simulate(BODY.inertia, START, TIMES, force=F.drag(NUMBERS))


def test_an_empty_batch_has_no_motions():
    motion = ph.simulate(BODY, START, TIMES, force=F.drag(np.zeros(0)))
    assert motion.shape == (0,)
    assert motion.position.shape == (0, len(TIMES))


def test_the_viewer_shows_one_body():
    with pytest.raises(ValueError, match=r"this is a batch: pick one body"):
        ph.view(BODY, START, force=F.drag(NUMBERS))
