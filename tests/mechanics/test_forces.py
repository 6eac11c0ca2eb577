"""Forces on the centre of mass: closed forms, values and errors."""

import pickle
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0

F = ph.force
BODY = ph.Body.box([1, 2, 3], mass=2.0)
M = 2.0
TIMES = np.linspace(-3.0, 10.0, 27)


def start(position=(0, 0, 0), velocity=(0, 0, 0), omega=(0.25, -0.5, 1.0), rotor=R0):
    return ph.State(rotor, omega, ph.vector(position), ph.vector(velocity))


def falling_up(t, position, velocity, rotor):
    return -M * position


def lifted(t, position, velocity, rotor, omega_body):
    return 0.5 * velocity.dot(rotor(omega_body))


# --- values


VALUES = [
    F.constant([1, 2, 3]),
    F.thrust([0, 0, 1]),
    F.thrust([0, 0, 1], at=[0.5, 0, 0]),
    F.drag(0.5),
    F.quadratic_drag(0.5),
    F.spring(2, [0, 1, 0]),
    F.central(3.5),
    F.formula("q cross(v, B) - k x", q=2, B=ph.e3, k=0.5),
    F.function(falling_up),
    F.function(lifted, omega_body=True),
    F.constant([0, 0, -9.81]) + F.drag(0.1),
]


@pytest.mark.parametrize("force", VALUES, ids=repr)
def test_forces_are_values(force):
    again = pickle.loads(pickle.dumps(force))
    assert again == force
    assert repr(again) == repr(force)
    assert sum(one == force for one in VALUES) == 1


def test_repr_of_forces():
    assert hash(F.spring(2, [0, 1, 0])) == hash(F.spring(2.0, ph.e2))
    assert repr(F.constant([0, 0, -9.81]) + F.drag(0.1)) == "constant([0.0, 0.0, -9.81]) + drag(0.1)"
    assert repr(F.thrust([0, 0, 1], at=[0.5, 0, 0])) == "thrust([0.0, 0.0, 1.0], at=[0.5, 0.0, 0.0])"
    assert repr(F.formula("-k x", k=2.0)) == "formula('-k x', k=2.0)"
    assert repr(F.function(falling_up)) == "function(falling_up)"
    assert repr(F.function(lifted, omega_body=True)) == "function(lifted, omega_body=True)"
    assert sum([F.drag(0.1), F.drag(0.2)]) == F.drag(0.1) + F.drag(0.2)
    assert -2 * ph.e3 + F.drag(0.1) == F.constant([0, 0, -2]) + F.drag(0.1)
    assert F.drag(0.1) - 2 * ph.e3 == F.drag(0.1) + F.constant([0, 0, -2])
    for other in (ph.e1 ^ ph.e2, 3.0, "drag"):
        with pytest.raises(TypeError):
            F.drag(0.1) + other
        with pytest.raises(TypeError):
            other + F.drag(0.1)
    assert F.drag(0.5) - F.drag(0.25) == F.drag(0.5) + F.drag(-0.25)


# --- closed forms


@pytest.mark.parametrize(
    "torque",
    [None, ph.torque.constant_space([0, 0.25, 0.5]), ph.torque.viscous_damping(0.01)],
    ids=["exact", "splitting", "dop853"],
)
def test_under_a_constant_force_the_centre_is_in_closed_form(torque):
    """``x + v t + ½ a t²`` to rounding, at any time and under any torque."""
    x, v, force = [1.0, -2.0, 0.5], [0.1, 3.0, -7.0], [0.3, 0.0, -19.62]
    times = np.array([-5.0, 0.0, 0.1, 20.0] if torque else [-1e6, -0.3, 0.0, 1e3, 12345678.9])
    motion = ph.simulate(BODY, start(x, v), times, torque, force)
    for k, t in enumerate(map(Fraction, times)):
        for i in range(3):
            a = Fraction(force[i]) / Fraction(M)
            terms = [Fraction(x[i]), Fraction(v[i]) * t, a * t * t / 2]
            # Four roundings of the terms and two of the sums.
            bound = 3 * EPS * float(sum(map(abs, terms)))
            assert abs(float(Fraction(motion.position.components[k, i]) - sum(terms))) <= bound
            ends = [Fraction(v[i]), a * t]
            bound = 2 * EPS * float(sum(map(abs, ends)))
            assert abs(float(Fraction(motion.velocity.components[k, i]) - sum(ends))) <= bound


def test_constant_forces_add_up_and_a_vector_is_one():
    one = ph.simulate(BODY, start(), TIMES, force=F.constant([1, 0, 2]) + F.constant([0, 3, -1]))
    other = ph.simulate(BODY, start(), TIMES, force=ph.vector([1, 3, 1]))
    assert np.array_equal(one.position.components, other.position.components)
    assert one.certificate.method == "exact"


def close(motion, position, velocity, factor=1.0):
    """Within the certificate's estimate, relative to the largest distance and speed."""
    estimate = factor * motion.certificate.error_estimate
    x, v = np.array(position), np.array(velocity)
    assert np.abs(motion.position.components - x).max() <= estimate * np.linalg.norm(x, axis=1).max()
    assert np.abs(motion.velocity.components - v).max() <= estimate * np.linalg.norm(v, axis=1).max()


@pytest.mark.parametrize("batch", [(), (3,)])
@pytest.mark.parametrize("end", [5.0, 20.0])
def test_a_body_that_falls_from_rest_reaches_its_terminal_velocity(end, batch):
    """Without spin and speed nothing but the end of a step says how large its error is."""
    k, g, up = 1.0, 10.0, ph.e3
    state = ph.State(ph.Rotor.identity(batch), np.zeros((*batch, 3)))
    linear = F.formula("-m g e3 - k v", g=g, k=k)
    quadratic = F.constant([0, 0, -M * g]) + F.quadratic_drag(k)
    terminal = np.sqrt(M * g / k)
    speeds = M * g / k * -np.expm1(-k * end / M), terminal * np.tanh(g * end / terminal)
    for force, speed in zip((linear, quadratic), speeds, strict=True):
        motion = ph.simulate(BODY, state, [end], force=force)
        error = (motion.velocity + speed * up).norm().max() / speed
        assert error <= 2 * np.max(motion.certificate.error_estimate) + 8 * EPS
        assert error < 1e-9


def test_quadratic_drag_slows_down():
    """For ``−k |v| v`` ``x = (m/k) log(1 + k v0 t/m)``."""
    k, v, times = 0.5, np.array([3.0, 0, 4.0]), np.linspace(0, 20, 11)
    motion = ph.simulate(BODY, start(velocity=v), times, force=F.quadratic_drag(k))
    way = np.log1p(k * 5.0 * times[:, None] / M)
    close(motion, v / 5.0 * M / k * way, v * np.exp(-way))


@pytest.mark.parametrize("eccentricity", [0.0, 0.3, 0.9])
def test_an_orbit_closes_and_keeps_energy_and_angular_momentum(eccentricity):
    """From the pericentre of a Kepler ellipse with semi-major axis 1; ``T = 2π/√μ``."""
    mu = 2.5
    period = 2 * np.pi / np.sqrt(mu)
    x, v = 1 - eccentricity, np.sqrt(mu * (1 + eccentricity) / (1 - eccentricity))
    state = start([x, 0, 0], [0, 0.6 * v, 0.8 * v])
    times = period * np.array([0.0, 0.25, 0.5, 1.0, 3.0])
    motion = ph.simulate(BODY, state, times, force=F.central(mu))
    estimate = motion.certificate.error_estimate
    # At the apocentre and after whole turns; the time of the pericentre is its speed times the error.
    swift = v * period * (1 + eccentricity) * 20
    far = motion.position[2].components - [-(1 + eccentricity), 0, 0]
    assert np.abs(far).max() <= estimate * swift
    assert np.abs(motion.position[3:].components - [x, 0, 0]).max() <= estimate * swift
    energy = 0.5 * motion.velocity.norm() ** 2 - mu / motion.position.norm()
    np.testing.assert_allclose(energy, -0.5 * mu, rtol=20 * estimate / (1 - eccentricity) ** 2)
    momentum = (motion.position ^ motion.velocity).components
    size = np.sqrt(mu * (1 - eccentricity**2))
    np.testing.assert_allclose(
        momentum, np.tile([0, -0.8 * size, 0.6 * size], (5, 1)), atol=20 * estimate * v
    )


def test_a_charge_circles_in_a_magnetic_field():
    """``m v' = q v x B``: v turns about B at the rate −qB/m."""
    q, b, v = 3.0, 0.5, np.array([1.0, 0.0, 0.25])
    force = F.formula("q cross(v, B)", q=q, B=b * ph.e3)
    motion = ph.simulate(BODY, start(velocity=v), TIMES, force=force)
    w = q * b / M
    sin, cos = np.sin(w * TIMES), np.cos(w * TIMES)
    position = np.stack([sin / w, (cos - 1) / w, 0.25 * TIMES], axis=1)
    velocity = np.stack([cos, -sin, 0.25 + 0 * TIMES], axis=1)
    close(motion, position, velocity)


def test_a_thruster_that_turns_with_the_body():
    """About e3 at the rate w the thrust along e1 gives ``v = (F/mw) (sin wt, 1 − cos wt)``."""
    w, size = 2.0, 3.0
    state = start(omega=[0, 0, w], rotor=ph.Rotor.identity())
    motion = ph.simulate(BODY, state, TIMES, force=F.thrust([size, 0, 0]))
    t, u = TIMES, size / (M * w)
    velocity = np.stack([u * np.sin(w * t), u * (1 - np.cos(w * t)), 0 * t], axis=1)
    position = np.stack([u / w * (1 - np.cos(w * t)), u * (t - np.sin(w * t) / w), 0 * t], axis=1)
    close(motion, position, velocity)
    other = ph.simulate(BODY, state, TIMES, force=F.formula("f R e1 ~R", f=size))
    close(other, position, velocity)


def test_an_off_centre_thrust_turns_the_body():
    at, push = [0.5, -0.25, 1.0], ph.vector([0.25, 0.5, -0.125])
    body = ph.Body(M, BODY.inertia, center_of_mass=[0.125, 0, 0.25])
    motion = ph.simulate(body, start(), [4.0], force=F.thrust(push, at=at))
    torque = ph.torque.constant_body((ph.vector(at) - body.center_of_mass) ^ push)
    apart = ph.simulate(body, start(), [4.0], torque, F.thrust(push))
    assert motion.rotor[0] == apart.rotor[0]
    assert motion.position[0] == apart.position[0]
    assert motion.omega_body[0] != ph.simulate(body, start(), [4.0], force=F.thrust(push)).omega_body[0]


def test_two_opposite_thrusters_are_a_couple():
    """They turn the body with ``2 r∧F``, wherever its centre is, and do not move it."""
    r, push = ph.vector([0.5, -0.25, 1.0]), ph.vector([0.25, 0.5, -0.125])
    body = ph.Body(M, BODY.inertia, center_of_mass=[0.125, 0, 0.25])
    thrusts = F.thrust(push, at=r) + F.thrust(-push, at=-r)
    motion = ph.simulate(body, start(), [4.0], force=thrusts, rtol=1e-10)
    couple = ph.simulate(body, start(), [4.0], ph.torque.constant_body(2 * (r ^ push)), rtol=1e-10)
    assert motion.rotor[0].distance(couple.rotor[0]) <= 1e-9
    assert motion.omega_body[0].is_close(couple.omega_body[0], rtol=1e-9)
    assert motion.position[0].is_close(couple.position[0], atol=1e-9)


@pytest.mark.parametrize(
    "force",
    [
        lambda turn: F.thrust(turn(ph.vector([1, 2, -1])), at=turn(ph.vector([0.5, 0.25, 0]))),
        lambda turn: F.formula("R f ~R + k Ω_S·x - v", f=turn(ph.e1), k=0.5),
        lambda turn: F.formula("R (I I(Ω_B)) ~R"),
        lambda turn: F.function(lambda t, x, v, R: R(turn(ph.e1)) - 0.5 * x + t * v),
        lambda turn: F.function(lambda t, x, v, R, omega: R(turn(ph.e1).dot(omega)), omega_body=True),
    ],
    ids=["thrust", "formula", "map", "function", "function of the spin"],
)
def test_motion_does_not_depend_on_body_axes(force):
    turn = ph.Rotor.from_components([1, 2, 3, 4])
    here = start([1, 0, 2], [0, 0.5, 0])
    there = start([1, 0, 2], [0, 0.5, 0], turn(here.omega_body), here.rotor * ~turn)
    one = ph.simulate(BODY, here, TIMES, force=force(lambda a: a), step=0.01)
    other = ph.simulate(BODY.moved(turn), there, TIMES, force=force(turn), step=0.01)
    # 1,300 steps of a dozen roundings that grow with the motion.
    for name in ("position", "velocity"):
        a, b = getattr(one, name).components, getattr(other, name).components
        np.testing.assert_allclose(b, a, rtol=0, atol=1e-11 * np.abs(a).max())


@pytest.mark.parametrize(
    ("law", "text", "function"),
    [
        (F.drag(0.5), "-k v", lambda t, x, v, R: -0.5 * v),
        (F.quadratic_drag(0.5), "-k norm(v) v", lambda t, x, v, R: -0.5 * v.norm() * v),
        (F.spring(0.5), "-k x", lambda t, x, v, R: [-0.5 * c for c in x.components]),
        (F.central(0.5), "-k m x/norm(x)^3", lambda t, x, v, R: -M * 0.5 * x / x.norm() ** 3),
        (F.thrust([0, 0, 0.5]), "k R e3 ~R", lambda t, x, v, R: (0.5 * R(ph.e3)).components),
    ],
    ids=["drag", "quadratic", "spring", "central", "thrust"],
)
def test_formulas_and_functions_equal_built_in_forces(law, text, function):
    state = start([1, 2, 0], [0, 0.5, 0.25])
    law, formula, given = (
        ph.simulate(BODY, state, TIMES, force=force, step=1 / 16)
        for force in (law, F.formula(text, k=0.5), function)
    )
    for other in (formula, given):
        assert np.all(other.position.is_close(law.position, rtol=1e-12, atol=1e-12))
        assert np.all(other.velocity.is_close(law.velocity, rtol=1e-12, atol=1e-12))
    assert given.certificate.evaluations == formula.certificate.evaluations
    # The method of the rotation differs where the centre of mass has a closed form.
    if law.certificate.method == formula.certificate.method:
        assert law.certificate.evaluations == formula.certificate.evaluations
    else:
        assert text in ("-k v", "-k x")


def test_functions_of_the_spin_equal_formulas():
    """The lift of a spinning ball, ``k v·Ω``: it turns the velocity in the plane of the rotation."""
    state = start([1, 2, 0], [0, 0.5, 0.25])
    formula = F.formula("k v·Ω_S", k=0.5)
    function = F.function(lifted, omega_body=True)
    one, other = (ph.simulate(BODY, state, TIMES, force=force, step=1 / 16) for force in (formula, function))
    np.testing.assert_allclose(other.position.components, one.position.components, rtol=1e-13, atol=1e-13)
    assert function.at(BODY, state).is_close(formula.at(BODY, state), rtol=1e-14)
    assert (2 * function).at(BODY, state).is_close(2 * formula.at(BODY, state), rtol=1e-14)
    with pytest.raises(TypeError, match="position, velocity, rotor and omega_body"):
        F.function(falling_up, omega_body=True)
    with pytest.raises(TypeError, match="omega_body must be True or False, got 1"):
        F.function(lifted, omega_body=1)


def test_a_formula_knows_time_and_mass():
    """``m x'' = m t e1``: ``x = t³/6``."""
    motion = ph.simulate(BODY, start(), TIMES, force=F.formula("m t e1"))
    np.testing.assert_allclose(motion.position.components[:, 0], TIMES**3 / 6, rtol=1e-13, atol=1e-13)


def test_position_and_velocity_are_in_the_data():
    motion = ph.simulate(BODY, start([1, 0, 0]), TIMES, force=F.spring(1.0))
    data = motion.to_xarray()
    assert np.array_equal(data.position, motion.position.components)
    assert np.array_equal(data.velocity, motion.velocity.components)
    assert data.velocity.attrs["units"] == "m/s"


# --- refusals


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("I v", ["vector, grade 1", "grade 2", "-I B"]),
        ("norm(v)", ["grade 0", "-k v"]),
        ("q v x B", ["grades 1, 3", "cross(a, b)"]),
        ("R x ~R + 3", ["grades 0, 1", "⟨…⟩_1"]),
        ("w x", ["w"]),
        ("x = v", ["one side", "force"]),
        ("-k (x", ["(x"]),
    ],
)
def test_formulas_that_are_not_forces_raise(text, parts):
    with pytest.raises(ph.FormulaError) as error:
        F.formula(text, q=1.0, B=ph.e3, k=1.0)
    for part in parts:
        assert part in str(error.value)


def test_names_of_the_motion_are_reserved():
    for name in ("x", "v", "m", "t"):
        with pytest.raises(ph.FormulaError, match=f"`{name}` is given by the motion"):
            F.formula("-k x", k=1.0, **{name: 1.0})


class OwnError(Exception):
    pass


def failing(t, x, v, R):
    if t > 0.5:
        raise OwnError("enough")
    return -x


@pytest.mark.parametrize(
    ("force", "kind", "parts"),
    [
        (F.function(failing), OwnError, ["enough"]),
        (failing, OwnError, ["enough"]),
        (lambda t: 0, TypeError, ["called with t, position, velocity and rotor", "lambda"]),
        (lambda t, x, v, R: [1, 2], ValueError, ["the force", "t = 0 s", "3 components", "(2,)"]),
        (lambda t, x, v, R: [1, np.nan, 2], ValueError, ["t = 0 s", "force", "[1.0, NaN, 2.0]"]),
        (lambda t, x, v, R: ph.e1 ^ ph.e2, TypeError, ["t = 0 s", "vector"]),
        (lambda t, x, v, R: None, TypeError, ["t = 0 s"]),
        (F.formula("v/t"), ValueError, ["t = 0 s", "division by zero"]),
        (F.central(1.0), ValueError, ["t = 0 s", "centre of attraction"]),
        (F.drag, TypeError, ["drag(k)", "got drag"]),
        (3, ValueError, ["the force"]),
        ("down", TypeError, ["the force"]),
        ([0, np.inf, 0], ValueError, ["the force", "inf"]),
    ],
)
def test_invalid_return_values_raise(force, kind, parts):
    with pytest.raises(kind) as error:
        ph.simulate(BODY, start(velocity=[0, 0, 1]), [1.0], force=force)
    for part in parts:
        assert part in str(error.value)


def test_invalid_arguments_raise():
    for make in (lambda: F.function(3), lambda: F.formula(3), lambda: F.drag("much")):
        with pytest.raises(TypeError):
            make()
    for make in (lambda: F.drag(np.nan), lambda: F.spring(1.0, [0, 0]), lambda: F.constant(np.eye(2))):
        with pytest.raises(ValueError):
            make()


@pytest.mark.parametrize("method", ["strang", "kahan_li8", "rkn6", "midpoint", "dmv", "exact"])
def test_methods_that_do_not_support_forces_raise(method):
    with pytest.raises(ValueError, match=f"{method} .*forces"):
        ph.simulate(BODY, start(velocity=[0, 0, 1]), [1.0], force=F.quadratic_drag(1.0), method=method)


def test_a_force_needs_a_mass_and_a_free_body():
    with pytest.raises(TypeError, match="Body"):
        ph.simulate(BODY.inertia, start(), [1.0], force=F.drag(1.0))
    with pytest.raises(ValueError, match="fix a point of the body; leave force out"):
        ph.simulate(BODY, start(), [1.0], ph.torque.gravity(BODY, pivot=[0, 0, 1]), F.drag(1.0))
