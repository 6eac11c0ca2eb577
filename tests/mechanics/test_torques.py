"""Torque laws against their formulas in 40 digits and their potentials, and laws as values."""

import inspect
import math
import pickle

import mpmath as mp
import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0, START, moments
from polhode._mechanics.registry import FORCES, TORQUES

BODY = moments(1, 2, 2.5)
I = np.array([1, 2, 2.5])  # noqa: E741
OMEGA = START.omega_body.components
REST = ph.Rotor.from_components([1, 0.2, 0.3, -0.1])
LAWS = {
    "heavy": ph.torque.heavy([0.5, 0.25, 1.0]),
    "gravity_gradient": ph.torque.gravity_gradient(0.7, 0.3, 0.2),
    "magnetic": ph.torque.magnetic([0.3, -0.7, 0.2], [0.2, -0.4, 1.1]),
    "radiation_pressure": ph.torque.radiation_pressure(2.0, [0.3, -0.7, 0.2], [0.2, -0.4, 1.1], 1.5, 0.25),
    "larmor": ph.torque.larmor([0.125, 0.5, 1.0]),
    "damping": ph.torque.damping(0.125),
    "viscous_damping": ph.torque.viscous_damping([0.1, 0.2, 0.4]),
    "quadratic_damping": ph.torque.quadratic_damping(0.3),
    "torsion_spring": ph.torque.torsion_spring(1.5, REST),
    "pd_control": ph.torque.pd_control([1.0, 2.0, 4.0], [0.5, 0.25, 2.0], REST),
    "gyrostat": ph.torque.gyrostat([0.4, -0.3, 0.8]),
    "constant_body": ph.torque.constant_body([0.1, 0.2, 0.3]),
    "constant_space": ph.torque.constant_space([0.1, 0.2, 0.3]),
    "tabulated": ph.torque.tabulated([0, 1, 3], [[0.1, 0, 0], [0, 0.5, 0], [1, 2, 3]]),
    "tabulated in space": ph.torque.tabulated([0, 1, 3], np.eye(3), frame="space", kind="cubic"),
    "formula": ph.torque.formula("a ∧ (~R e3 R) − k I(Ω) + (t/s) Ω", a=2 * ph.e1, k=0.5, s=3),
    "formula in space": ph.torque.formula("L × B − Ω + ⟨R e1 ~R Ω_S I⟩_2", frame="space", B=ph.e1 ^ ph.e2),
}


def torque(law, body=BODY, state=START, t=0.0):
    return law.at(body, state, t).components


def mp_rotor(rotor):
    """Return the components as 40-digit numbers of norm 1."""
    c = [mp.mpf(x) for x in rotor.components.tolist()]
    size = mp.sqrt(sum(x * x for x in c))
    return [x / size for x in c]


def mp_product(a, b):
    """Return the rotor a b over (1, e2e3, e3e1, e1e2), whose products are −δ − ε."""
    s, x, y, z = a
    p, u, v, w = b
    return [
        s * p - x * u - y * v - z * w,
        s * u + x * p - (y * w - z * v),
        s * v + y * p - (z * u - x * w),
        s * w + z * p - (x * v - y * u),
    ]


def mp_back(rotor, v):
    """Return ~R v R for a vector v of space: v seen from the body."""
    s, *b = rotor
    bivector = mp_product(mp_product([s, *(-x for x in b)], [mp.mpf(0), *map(mp.mpf, v)]), rotor)
    return bivector[1:]


def turned(rotor, k, angle):
    """Return R exp(−½ angle I e_k): the body turned about its own axis k."""
    half = [mp.cos(angle / 2), mp.mpf(0), mp.mpf(0), mp.mpf(0)]
    half[k + 1] = -mp.sin(angle / 2)
    return mp_product(rotor, half)


def from_potential(V, rotor):
    """Return the torque of a potential: minus its derivative along turns about the body's axes."""
    with mp.workdps(40):
        start = mp_rotor(rotor)
        return np.array([float(-mp.diff(lambda a, k=k: V(turned(start, k, a)), 0)) for k in range(3)])


def turn_angle(rotor, rest):
    """Return |Θ| <= π of the turn between two attitudes."""
    s, x, y, z = mp_product([rest[0], *(-c for c in rest[1:])], rotor)
    return 2 * mp.atan2(mp.sqrt(x * x + y * y + z * z), abs(s))


def dot(a, b):
    return sum(mp.mpf(x) * y for x, y in zip(a, b, strict=True))


# --- potentials


def test_gravity_and_magnetic_torques_come_from_their_potentials():
    for rotor in (R0, REST, ph.Rotor.identity()):
        state = ph.State(rotor, OMEGA)
        N = from_potential(lambda R: dot([0.5, 0.25, 1.0], mp_back(R, [0, 0, 1])), rotor)
        np.testing.assert_allclose(torque(LAWS["heavy"], state=state), N, rtol=0, atol=4 * EPS)
        N = from_potential(lambda R: -dot([0.3, -0.7, 0.2], mp_back(R, [0.2, -0.4, 1.1])), rotor)
        np.testing.assert_allclose(torque(LAWS["magnetic"], state=state), N, rtol=0, atol=4 * EPS)


def test_radiation_pressure_is_that_of_the_cannonball():
    """The force −C P A s of light from the direction s of the Sun, at the centre of pressure."""
    offset, sun = ph.vector([0.3, -0.7, 0.2]), ph.vector([0.2, -0.4, 1.1])
    force = -1.5 * 0.25 * 2.0 * sun.normalized()
    found = LAWS["radiation_pressure"].at(BODY, START)
    assert found.is_close(offset ^ (~R0)(force), rtol=0, atol=8 * EPS)
    # By default the pressure at 1 au on a body that absorbs all light; the size of `sun` is ignored.
    found = ph.torque.radiation_pressure(2.0, ph.e1, 150e9 * ph.e2).at(
        BODY, ph.State(ph.Rotor.identity(), OMEGA)
    )
    assert found.is_close(-2 * 4.56e-6 * (ph.e1 ^ ph.e2), rtol=8 * EPS)
    times = np.linspace(0, 20, 11)
    motion = ph.simulate(BODY, START, times, LAWS["radiation_pressure"], rtol=1e-10)
    about = motion.momentum_space.dual().components @ sun.normalized().components
    np.testing.assert_allclose(about, about[0], rtol=0, atol=1e-9 * abs(about[0]))
    V = -(offset | (~motion.rotor)(force)).components[:, 0]
    kinetic = 0.5 * np.sum(I * motion.omega_body.components**2, axis=1)
    np.testing.assert_allclose(kinetic + V, motion.energy, rtol=0, atol=64 * EPS * kinetic.max())
    assert {"energy", "axial_angular_momentum"} <= set(motion.certificate.conserved)
    assert max(motion.certificate.drift.values()) < 1e-9


@pytest.mark.parametrize("rotor", [R0, -R0, REST, ph.Rotor.from_components([0, 1, 2, 3])], ids=str)
def test_spring_torque_is_the_gradient_of_its_potential(rotor):
    """R and −R are the same attitude; the shorter rotation counts."""
    with mp.workdps(40):
        rest = mp_rotor(REST)
    N = from_potential(lambda R: mp.mpf("0.75") * turn_angle(R, rest) ** 2, rotor)
    found = torque(LAWS["torsion_spring"], state=ph.State(rotor, OMEGA))
    # A few roundings of an angle up to π times the stiffness.
    np.testing.assert_allclose(found, N, rtol=0, atol=8 * EPS * 1.5 * np.pi)


def test_spring_torque_is_discontinuous_at_half_a_turn():
    half = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, math.pi)
    for rotor in (half, -half):
        found = torque(ph.torque.torsion_spring(2.0), state=ph.State(rotor, [0, 0, 0]))
        np.testing.assert_allclose(np.abs(found), [0, 0, 2 * np.pi], atol=8 * EPS)
    beyond = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, math.pi + 0.5)
    found = torque(ph.torque.torsion_spring(2.0), state=ph.State(beyond, [0, 0, 0]))
    np.testing.assert_allclose(found, [0, 0, 2 * (np.pi - 0.5)], rtol=8 * EPS)


def mp_orbit(n, e, M0, t):
    """Return u and (a/r)³ by the definition: true anomaly from Kepler's equation, to 60 digits."""
    M = (mp.mpf(n) * mp.mpf(t) + mp.mpf(M0)) % (2 * mp.pi)
    E = mp.findroot(
        lambda E: E - mp.mpf(e) * mp.sin(E) - M,
        (mp.mpf(0), 2 * mp.pi),
        solver="anderson",
        tol=mp.mpf(10) ** -80,
    )
    f = 2 * mp.atan2(mp.sqrt(1 + mp.mpf(e)) * mp.sin(E / 2), mp.sqrt(1 - mp.mpf(e)) * mp.cos(E / 2))
    nearness = (1 + mp.mpf(e) * mp.cos(f)) / (1 - mp.mpf(e) ** 2)
    return [mp.cos(f), mp.sin(f), mp.mpf(0)], nearness**3


@pytest.mark.parametrize("e", [0.0, 1e-9, 0.1, 0.7, 0.99])
@pytest.mark.parametrize("t", [0.0, 1.5, -40.0, 1e6 + 0.125, -1e12])
def test_the_gravity_gradient_on_any_orbit(e, t):
    n, M0 = 0.7, 0.2
    with mp.workdps(60):
        u, nearness = mp_orbit(n, e, M0, t)
        size = 3 * mp.mpf(n) ** 2 * nearness

        def V(R):
            return size / 2 * sum(mp.mpf(i) * x * x for i, x in zip(I.tolist(), mp_back(R, u), strict=True))

        N = from_potential(V, R0)
    found = torque(ph.torque.gravity_gradient(n, e, M0), t=t)
    # One rounding of M moves the position by dE/dM = a/r of it, and (a/r)³ by e sin E (a/r)² thrice that.
    slope = 1 + 3 * (1 + e) * float(nearness) ** (2 / 3)
    np.testing.assert_allclose(found, N, rtol=0, atol=8 * EPS * slope * float(size) * I.max())


# --- torques of the rate, and of the time


def test_rate_dependent_torques_against_their_formulas():
    m, w = I * OMEGA, OMEGA
    expected = {
        "damping": -0.125 * m,
        "viscous_damping": -np.array([0.1, 0.2, 0.4]) * w,
        "quadratic_damping": -0.3 * np.linalg.norm(w) * w,
        "gyrostat": np.cross([0.4, -0.3, 0.8], w),
    }
    for name, N in expected.items():
        np.testing.assert_allclose(torque(LAWS[name]), N, rtol=4 * EPS, atol=2 * EPS, err_msg=name)


def test_the_larmor_torque_is_that_of_the_reference_case():
    """In space L x b, L the whole momentum: L turns about b by −|b| per second."""
    b = ph.vector([0.125, 0.5, 1.0])
    L = R0(ph.bivector(I * OMEGA))
    expected = (~R0)(ph.I * ph.cross(L.dual(), b))
    assert LAWS["larmor"].at(BODY, START).is_close(expected, rtol=8 * EPS)
    h = ph.bivector([0.4, -0.3, 0.8])
    with_wheel = LAWS["larmor"] + LAWS["gyrostat"]
    L = R0(ph.bivector(I * OMEGA) + h)
    expected = (~R0)(ph.I * ph.cross(L.dual(), b)) + START.omega_body.commutator(h)
    assert with_wheel.at(BODY, START).is_close(expected, rtol=8 * EPS)


def test_control_is_a_spring_and_a_damper():
    spring = ph.torque.torsion_spring(1.0, REST).at(BODY, START).components
    found = torque(LAWS["pd_control"])
    np.testing.assert_allclose(found, [1, 2, 4] * spring - [0.5, 0.25, 2] * OMEGA, rtol=4 * EPS)
    alike = ph.torque.pd_control(1.5, 0, REST).at(BODY, START)
    assert alike.is_close(LAWS["torsion_spring"].at(BODY, START), rtol=4 * EPS)
    # A column holds one number for each body.
    column = ph.torque.pd_control([[1.5], [3.0]], [[0.25], [0.5]], REST)
    rows = ph.torque.pd_control([[1.5] * 3, [3.0] * 3], [[0.25] * 3, [0.5] * 3], REST)
    motions = [ph.simulate(BODY, START, [1.0], law) for law in (column, rows)]
    assert (motions[0].rotor == motions[1].rotor).all()


def test_tables_are_interpolated():
    from scipy.interpolate import CubicSpline

    rng = np.random.default_rng(3)
    for n in (2, 3, 4, 5, 30):
        times = np.cumsum(rng.uniform(0.1, 2, n)) - 3
        rows = rng.normal(size=(n, 3))
        spline = CubicSpline(times, rows)
        linear = ph.torque.tabulated(times, rows)
        cubic = ph.torque.tabulated(times, ph.bivector(rows), kind="cubic")
        size = np.abs(spline.c).max()
        for t in [*times, *rng.uniform(times[0], times[-1], 40)]:
            expected = [np.interp(t, times, rows[:, k]) for k in range(3)]
            np.testing.assert_allclose(torque(linear, t=t), expected, rtol=0, atol=16 * EPS)
            np.testing.assert_allclose(torque(cubic, t=t), spline(t), rtol=0, atol=100 * EPS * size)
        for i, t in enumerate(times):
            np.testing.assert_array_equal(torque(linear, t=t), rows[i])
            np.testing.assert_allclose(torque(cubic, t=t), rows[i], rtol=0, atol=0)


def test_a_table_in_space_turns_back_with_the_body():
    N = ph.bivector(torque(ph.torque.tabulated([0, 1, 3], np.eye(3), kind="cubic"), t=2.2))
    found = LAWS["tabulated in space"].at(BODY, START, 2.2)
    assert found.is_close((~R0)(N), rtol=8 * EPS)


# --- laws as values


# Factors along body axes belong to the axes: see the next test.
@pytest.mark.parametrize("name", sorted(LAWS.keys() - {"viscous_damping", "pd_control"}))
def test_torque_is_covariant_under_rotation_of_body_axes(name):
    """The law's body components turned by F, the rotor R ~F, the inertia moved: the torque is turned."""
    F = ph.Rotor.from_components([1, 2, 3, 4])
    body = ph.Body(1.0, BODY).moved(F).inertia
    state = ph.State(R0 * ~F, F(START.omega_body))
    for t in (0.0, 1.7):
        straight = LAWS[name].at(BODY, START, t)
        found = _turned(LAWS[name], F).at(body, state, t)
        size = 1 + straight.norm()
        np.testing.assert_allclose(found.components, F(straight).components, rtol=0, atol=32 * EPS * size)


def _turned(law, F):
    """Return the law of the same body seen from axes turned by F."""
    (one,) = law.laws
    name, given = one.name, list(one.arguments)
    if name == "magnetic":
        return ph.torque.magnetic(F(ph.vector(given[0])), given[1])
    if name == "radiation_pressure":
        area, offset, *others = given
        return ph.torque.radiation_pressure(area, F(ph.vector(offset)), *others)
    if name == "heavy":
        return ph.torque.heavy(F(ph.vector(given[0])))
    if name in ("gyrostat", "constant_body"):
        return getattr(ph.torque, name)(F(ph.bivector(given[0])))
    if name == "torsion_spring":
        return ph.torque.torsion_spring(1.5, REST * ~F)
    if name == "tabulated" and given[2] == "body":
        return ph.torque.tabulated(given[0], F(ph.bivector(given[1])))
    if name == "formula":
        text, frame, values = given
        if frame == "body":
            return ph.torque.formula(text, **{**dict(values), "a": F(dict(values)["a"])})
        turned = text.replace("e1", "F e1 ~F")
        return ph.torque.formula(turned, frame="space", F=F, **dict(values))
    return law


def test_a_row_of_gains_for_bodies_has_a_remedy():
    with pytest.raises(ValueError, match=r"got shape \(4,\); for a number of each body write kp\[:, None\]"):
        ph.torque.pd_control(np.ones(4), 1.0)


def test_gains_along_body_axes_in_a_body_whose_principal_axes_are_others():
    """`viscous_damping` and `pd_control` act along body axes, for any inertia."""
    F = ph.Rotor.from_components([1, 2, 3, 4])
    body = ph.Body(1.0, BODY).moved(F).inertia
    assert not np.allclose(body.principal_frame.components, [1, 0, 0, 0])
    found = torque(LAWS["viscous_damping"], body)
    np.testing.assert_allclose(found, -np.array([0.1, 0.2, 0.4]) * OMEGA, rtol=0, atol=4 * EPS)
    found = torque(LAWS["pd_control"], body)
    np.testing.assert_allclose(found, torque(LAWS["pd_control"]), rtol=0, atol=64 * EPS)


def test_laws_add_up():
    laws = list(LAWS.values())
    together = sum(laws)
    assert len(together.laws) == len(laws)
    wheel = together.laws[list(LAWS).index("gyrostat")].arguments[0]
    # L includes the wheel for laws that depend on it.
    h = ph.bivector(wheel)
    separate = ph.bivector([0.0, 0, 0])
    for law in laws:
        separate += law.at(BODY, START, 1.0)
    missing = (~R0)(ph.I * ph.cross(R0(h).dual(), ph.vector([0.125, 0.5, 1.0])))
    missing += (~R0)(R0(h).commutator(ph.e1 ^ ph.e2))
    assert together.at(BODY, START, 1.0).is_close(separate + missing, rtol=64 * EPS)
    assert 0 + laws[0] == laws[0]
    with pytest.raises(TypeError):
        laws[0] + 1


@pytest.mark.parametrize("name", LAWS)
def test_laws_are_values(name):
    law = LAWS[name]
    again = pickle.loads(pickle.dumps(law))
    assert again == law
    assert again is not law
    assert again.at(BODY, START, 1.0) == law.at(BODY, START, 1.0)
    assert all(law != other for key, other in LAWS.items() if key != name)
    assert repr(law).startswith(law.laws[0].name + "(")
    with pytest.raises(AttributeError):
        law.laws = ()


def test_repr_of_laws():
    law = ph.torque.heavy([0, 0, 2]) + ph.torque.damping(0.5)
    assert repr(law) == "heavy([0.0, 0.0, 2.0]) + damping(0.5)"
    assert hash(law) == hash(ph.torque.heavy(2 * ph.e3) + ph.torque.damping(0.5))
    assert repr(ph.torque.formula("-k Ω", k=2)) == "formula('-k Ω', k=2.0)"
    assert repr(LAWS["tabulated"]) == "tabulated(3 rows, 0 s to 3 s, frame='body', kind='linear')"


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (lambda T: T.heavy([0, np.nan, 1]), ["c", "nan", "finite"]),
        (lambda T: T.damping(np.inf), ["g", "inf"]),
        (lambda T: T.gravity_gradient(1.0, 1.0), ["eccentricity is 1", "below 1"]),
        (lambda T: T.gravity_gradient(1.0, -0.1), ["eccentricity is -0.1", "at least 0"]),
        (lambda T: T.gravity_gradient(1.0, np.nan), ["eccentricity", "nan"]),
        (lambda T: T.quadratic_damping(-1), ["k is -1", "negative"]),
        (lambda T: T.radiation_pressure([1, -2], ph.e1, ph.e2), ["at index (1,)", "area is -2", "negative"]),
        (lambda T: T.radiation_pressure(1, ph.e1, [0, 0, 0]), ["sun is [0.0, 0.0, 0.0]", "must not be zero"]),
        (lambda T: T.viscous_damping([1, -2, 3]), ["d", "-2", "negative"]),
        (lambda T: T.viscous_damping([1, 2]), ["(2,)", "three"]),
        (lambda T: T.viscous_damping([1]), ["(1,)", "three"]),
        (lambda T: T.pd_control(np.nan, 1), ["kp", "nan"]),
        (lambda T: T.torsion_spring([1, 2, 3], ph.Rotor.identity(2)), ["torsion_spring", "(3,)", "(2,)"]),
        (lambda T: T.larmor([[1, 0]]), ["b", "(1, 2)"]),
        (lambda T: T.tabulated([0, 2, 1], np.eye(3)), ["times[2] = 1", "times[1] = 2", "sort"]),
        (lambda T: T.tabulated([0, 1, 1], np.eye(3)), ["times[2]"]),
        (lambda T: T.tabulated([0, np.nan, 1], np.eye(3)), ["times[1]", "NaN"]),
        (lambda T: T.tabulated([0, 1], [[0, 0, 0], [0, np.inf, 0]]), ["torques[1]", "inf"]),
        (lambda T: T.tabulated([0], [[0, 0, 0]]), ["1 rows", "2"]),
        (lambda T: T.tabulated([0, 1], np.eye(3)), ["(2,)", "(3, 3)"]),
        (lambda T: T.tabulated([0, 1], np.zeros((2, 3)), kind="quintic"), ["kind", "'quintic'", "'cubic'"]),
        (lambda T: T.tabulated([0, 1], np.zeros((2, 3)), frame="orbit"), ["frame", "'orbit'", "'space'"]),
        (lambda T: T.tabulated([0, 1], np.zeros((2, 3))).at(BODY, START, 1.5), ["1.5", "0 s to 1 s"]),
        (lambda T: T.heavy([0, 0, 1]).at(BODY, START, np.nan), ["t", "nan"]),
        (lambda T: T.heavy([0, 0, 1]).at(BODY, ph.State(R0, np.eye(3))), ["single", "(3,)"]),
        (
            lambda T: T.damping(1).at(ph.Body.rod(1.0, mass=1.0), START),
            ["0 kg m² include a zero", "thickness"],
        ),
    ],
)
def test_invalid_arguments_raise_value_errors(make, parts):
    with pytest.raises(ValueError) as error:
        make(ph.torque)
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda T: T.heavy(ph.e1 ^ ph.e2),
        lambda T: T.magnetic(ph.e1, ph.e1 ^ ph.e2),
        lambda T: T.gyrostat(ph.e3),
        lambda T: T.damping("much"),
        lambda T: T.damping([[1], [1, 2]]),
        lambda T: T.torsion_spring(1, [1, 0, 0, 0]),
        lambda T: T.pd_control(1, 1, ph.e1 ^ ph.e2),
        lambda T: T.function(3),
        lambda T: T.formula(3),
        lambda T: T.heavy([0, 0, 1]).at(np.eye(3), START),
    ],
)
def test_wrong_types_raise_type_errors(make):
    with pytest.raises(TypeError):
        make(ph.torque)


@pytest.mark.parametrize("kind", ["torque", "force"])
def test_arguments_have_the_words_of_scenes(kind):
    registry = {"torque": TORQUES, "force": FORCES}[kind]
    module = getattr(ph, kind)
    for name, entry in registry.items():
        names = set(inspect.signature(getattr(module, name)).parameters)
        # An empty field: in scenes the law is this value alone.
        assert {argument.field for argument in entry.arguments if argument.field} <= names, name


def test_defaults_are_those_of_scenes():
    """The registry has the defaults of numbers; a choice of words begins with its default."""
    for laws, module in ((TORQUES, ph.torque), (FORCES, ph.force)):
        for name, entry in laws.items():
            own = inspect.signature(getattr(module, name)).parameters.values()
            for argument, parameter in zip(entry.arguments, own, strict=False):
                if argument.shape == "scalar":
                    expected = argument.default and argument.default[0]
                    default = None if parameter.default is inspect.Parameter.empty else parameter.default
                    assert default == expected, (name, argument.name)
                if argument.shape == "word":
                    assert parameter.default == argument.words[0]
