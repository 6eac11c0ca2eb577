"""Multiples, differences and values of laws."""

import math
import pickle
from array import array
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from polhode._mechanics.registry import FORCES, TORQUES

F, T = ph.force, ph.torque
EPS = np.finfo(float).eps
BODY = ph.Body(1.5, ph.Inertia.from_principal_moments(1, 2, 2.5), [0.3, -0.2, 0.5])
REST = ph.Rotor.from_components([1, 0.2, 0.3, -0.1])
STATE = ph.State(REST**2, [0.4, 2.0, 0.3], [1.0, -2.0, 0.5], [0.3, 0.1, -1.2], time=0.5)


def push(t, position, velocity, rotor):
    return rotor(ph.e1) * (1 + t) - 0.25 * velocity + position


def turn(t, rotor, omega_body):
    return [t, 2.0, 3.0]


ORBIT = T.KeplerOrbit(1e-3, 0.1, mu=1.0)
TORQUES_OF_EACH_KIND = {
    "constant_body": T.constant_body([0.1, 0.2, 0.3]),
    "constant_space": T.constant_space([0.1, 0.2, 0.3]),
    "damping": T.damping(0.125),
    "formula": T.formula("a ∧ (~R e3 R) − k I(Ω)", a=2 * ph.e1, k=0.5),
    "formula in space": T.formula("L × B − Ω", frame="space", B=ph.e1 ^ ph.e2),
    "function": T.function(turn),
    "gravity": T.gravity(BODY, pivot=[0, 0, 1]),
    "gyrostat": T.gyrostat([0.4, -0.3, 0.8]),
    "heavy": T.heavy([0.5, 0.25, 1.0]),
    "larmor": T.larmor([0.125, 0.5, 1.0]),
    "magnetic": T.magnetic([0.3, -0.7, 0.2], [0.2, -0.4, 1.1]),
    "magnetic on an orbit": T.magnetic([0.3, -0.7, 0.2], lambda t, x: ph.e1 + 2 * ph.e3, orbit=ORBIT),
    "pd_control": T.pd_control([1.0, 2.0, 4.0], [0.5, 0.25, 2.0], REST),
    "quadratic_damping": T.quadratic_damping(0.3),
    "radiation_pressure": T.radiation_pressure(2.0, [0.3, -0.7, 0.2], [0.2, -0.4, 1.1], 1.5, 0.25),
    "tabulated": T.tabulated([0, 1, 3], [[0.1, 0, 0], [0, 0.5, 0], [1, 2, 3]]),
    "torsion_spring": T.torsion_spring(1.5, REST),
    "viscous_damping": T.viscous_damping([0.1, 0.2, 0.4]),
}
FORCES_OF_EACH_KIND = {
    "central": F.central(2.0),
    "constant": F.constant([0.1, 0.2, 0.3]),
    "drag": F.drag(0.4),
    "formula": F.formula("-k v + m x + ⟨R e1 ~R⟩_1 t", k=0.3),
    "function": F.function(push),
    "quadratic_drag": F.quadratic_drag(0.3),
    "spring": F.spring(2.0, [0.5, 0.25, 1.0]),
    "thrust": F.thrust([0.3, -0.7, 0.2]),
    "thrust at a point": F.thrust([0.3, -0.7, 0.2], at=[1, 0, 0]),
}
LAWS = {**TORQUES_OF_EACH_KIND, **FORCES_OF_EACH_KIND}


def value(law):
    # `heavy` is checked against the centre of mass of a Body, not of an Inertia.
    return law.at(BODY.inertia if isinstance(law, T.Torque) else BODY, STATE)


def test_every_law_has_a_case():
    assert {*TORQUES} - {"gravity_gradient"} <= {*TORQUES_OF_EACH_KIND}
    assert {*FORCES} <= {*FORCES_OF_EACH_KIND}


@pytest.mark.parametrize("name", LAWS)
def test_a_multiple_exerts_a_multiple(name):
    law = LAWS[name]
    one = value(law)
    assert float(one.norm()) > 0.1
    for factor in (2, 0.7, Fraction(1, 3), np.float64(3.5)):
        many = factor * law
        # A torque is at most a sum of three products, each rounded a few times.
        size = float(factor) * float(one.norm())
        assert float((value(many) - float(factor) * one).norm()) <= 16 * EPS * size
        assert many == law * factor
        assert pickle.loads(pickle.dumps(many)) == many if "orbit" not in name else True
    assert value(law / 4).is_close(0.25 * one, rtol=16 * EPS)
    assert value(2 * (3 * law)).is_close(6 * one, rtol=16 * EPS)


@pytest.mark.parametrize("name", LAWS)
def test_a_law_minus_itself_exerts_nothing(name):
    law = LAWS[name]
    quadratic = ("quadratic_damping", "quadratic_drag")
    if name in ("viscous_damping", "pd_control", "radiation_pressure", *quadratic):
        with pytest.raises(ValueError, match=rf"{name} cannot be subtracted: .* formula takes any sign"):
            law - law
        return
    none = value(law - law)
    assert float(none.norm()) <= 16 * EPS * float(value(law).norm())
    assert (0 - law) == -law
    assert (law - 0) == (law + 0) == law


def test_multiples_of_batches_and_of_scalars():
    assert 2 * T.damping([0.1, 0.2]) == T.damping([0.2, 0.4])
    assert -F.drag([0.1, 0.2]) == F.drag([-0.1, -0.2])
    assert (ph.e1 | (3 * ph.e1)) * F.drag(1) == F.drag(3)
    assert repr(-F.constant([0, 0, 1])) == "constant([0.0, 0.0, -1.0])"
    assert repr(3 * (2 * T.function(turn))) == "function(6.0 * turn)"


def test_the_multiple_of_a_gyrostat_is_that_of_its_wheel():
    """Two equal wheels beside each other, and one that is twice as heavy."""
    wheel = T.gyrostat([0.4, -0.3, 0.8])
    twice, both = (ph.simulate(BODY, STATE, [3.0], law) for law in (2 * wheel, wheel + wheel))
    assert twice.momentum_space.is_close(both.momentum_space, rtol=1e-12).all()


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        (
            lambda: 2 * T.gravity_gradient(1.0),
            r"gravity_gradient cannot be multiplied by 2: it is not .* formula",
        ),
        (lambda: -T.reaction_wheels([[0, 0, 1]], 1.0), r"reaction_wheels cannot be multiplied by -1"),
        (lambda: T.damping(1) * T.damping(1), r"is multiplied by one number, got Torque; join laws by \+"),
        (
            lambda: np.ones(2) * F.drag(1),
            r"a Force is multiplied by one number, got ndarray; for many bodies",
        ),
        (lambda: ph.e1 * F.drag(1), r"a Force is multiplied by one number, got Multivector"),
        (lambda: T.damping(1) / "2", r"a Torque is divided by one number, got str"),
        (lambda: T.damping(1) @ T.damping(1), r"write law1 \+ law2"),
        (lambda: T.damping(1) + ph.e1, r"got Multivector; for a constant torque write constant_body\(N\)"),
        (lambda: 1 - T.damping(1), r"a Torque can only be added to a Torque, got int; for a constant"),
        (
            lambda: F.drag(1) + turn,
            r"a Force can only be added to a Force, got function; write function\(f\)",
        ),
        (
            lambda: F.drag(1) - T.damping(1),
            r"cannot add a torque and a force; pass them as torque= and force=",
        ),
    ],
)
def test_other_operations_name_what_to_write(operation, message):
    with pytest.raises(TypeError, match=message):
        operation()


def test_a_factor_must_be_finite():
    with pytest.raises(ValueError, match=r"a Torque cannot be multiplied by nan; give a finite number"):
        math.nan * T.damping(1)
    with pytest.raises(ZeroDivisionError, match=r"a Force cannot be divided by 0"):
        F.drag(1) / 0
    with pytest.raises(ValueError, match=r"a Torque cannot be multiplied by inf; give a finite number"):
        10**400 * T.damping(1)
    with pytest.raises(ValueError, match=r"a Force cannot be divided by 3e-320, whose reciprocal is not fin"):
        F.drag(1) / 3e-320


def test_errors_name_what_was_done_to_a_law():
    with pytest.raises(
        ValueError, match=r"viscous_damping cannot be subtracted: .*; a formula takes any sign"
    ):
        T.viscous_damping(2) - T.viscous_damping(1)
    with pytest.raises(
        ValueError, match=r"viscous_damping cannot be divided by -2: .* formula takes any sign"
    ):
        T.viscous_damping(2) / -2
    with pytest.raises(ValueError, match=r"viscous_damping cannot be multiplied by 1e\+308: ") as error:
        1e308 * T.viscous_damping(1e10)
    assert "any sign" not in str(error.value)


class Exerted:
    """A value of three numbers as other libraries have them."""

    def __array__(self, dtype=None, copy=None):
        return np.array([1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    "given",
    [array("d", [1, 2, 3]), Exerted(), [1, 2, 3], np.array([1, 2, 3], dtype=object), np.float32([1, 2, 3])],
    ids=lambda x: type(x).__name__,
)
def test_values_of_functions_of_any_type_are_multiplied(given):
    turned, pushed = 0.1 * T.function(lambda *_: given), 0.1 * F.function(lambda *_: given)
    for law in (turned, pushed):
        np.testing.assert_array_equal(value(law).components, 0.1 * np.array([1.0, 2.0, 3.0]))
    both = (2 * F.function(lambda *_: given), F.constant([2, 4, 6]))
    found, wanted = (ph.simulate(BODY, STATE, [1.0], force=force).velocity[0] for force in both)
    assert found.is_close(wanted)


def test_multiples_report_other_values_as_the_law_does():
    for given in ([True, False, True], [1j, 0, 0], ["1", "2", "3"], None, [[1], [2, 3]]):
        for law in (T.function(lambda *_, given=given: given), F.function(lambda *_, given=given: given)):
            messages = []
            for one in (law, 2 * law):
                with pytest.raises(TypeError) as error:
                    value(one)
                messages.append(str(error.value))
            assert messages[0] == messages[1]


def test_operators_of_other_classes_are_theirs():
    class Other:
        def __radd__(self, law):
            return "theirs"

        __rsub__ = __radd__

    assert T.damping(1) + Other() == "theirs"
    assert F.drag(1) - Other() == "theirs"


# --- values of forces


def test_the_value_of_a_force_is_the_acceleration_at_the_start():
    """``m v' = F``, with v' from a central difference of the motion."""
    law = sum(FORCES_OF_EACH_KIND.values())
    h = 1e-4
    times = STATE.time + np.array([-h, h])
    before, after = (ph.simulate(BODY, STATE, [t], force=law, rtol=1e-13).velocity[0] for t in times)
    found = (after - before) * (BODY.mass / (2 * h))
    # The error of the difference is h²/6 F'', with F'' of the size of F.
    assert found.is_close(law.at(BODY, STATE), rtol=1e-7)


def test_the_names_of_a_formula_of_a_force():
    text = "R e1 ~R + m v + 2 x + (t/s) I(Ω_B)·e1 + Ω_S·e2 + L·e3 + L_B·e1 + Omega_B·e2 + Omega_S·e3"
    found = F.formula(text, s=2).at(BODY, STATE, 4.0)
    R, omega, x, v = STATE.rotor, STATE.omega_body, STATE.position, STATE.velocity
    L = R(BODY.inertia(omega))
    wanted = R(ph.e1) + 1.5 * v + 2 * x + 2 * (BODY.inertia(omega) | ph.e1) + (R(omega) | ph.e2)
    wanted += (L | ph.e3) + (BODY.inertia(omega) | ph.e1) + (omega | ph.e2) + (R(omega) | ph.e3)
    assert found.is_close(wanted, rtol=32 * EPS)


def test_a_force_without_a_value_is_an_error():
    with pytest.raises(ValueError, match=r"division by zero"):
        F.central(1).at(BODY, ph.State(REST, [0, 0, 0]))
    with pytest.raises(ValueError, match=r"the force function at this state is e1 \+ nan e2; it must be fin"):
        F.function(lambda t, x, v, R: [1, np.nan, 0]).at(BODY, STATE)
    with pytest.raises(ValueError, match=r"that the function returned .* 3"):
        F.function(lambda t, x, v, R: [1, 2]).at(BODY, STATE)
    with pytest.raises(ValueError, match=r"function returned must be a single vector, got shape \(2, 3\)"):
        F.function(lambda t, x, v, R: np.ones((2, 3))).at(BODY, STATE)
    for law in (F.drag(1), T.damping(1)):
        with pytest.raises(TypeError, match=r"state must be a State, got int"):
            law.at(BODY, 3)
    with pytest.raises(TypeError, match=r"a force needs a Body, which has a mass, got Inertia"):
        F.drag(1).at(BODY.inertia, STATE)
    with pytest.raises(ValueError, match=r"that of a single body, got batch shape \(2,\)"):
        F.drag([1, 2]).at(BODY, STATE)
    with pytest.raises(ValueError, match=r"the state must be a single one, got batch \(2,\)"):
        F.drag(1).at(BODY, ph.State(REST, np.ones((2, 3))))
