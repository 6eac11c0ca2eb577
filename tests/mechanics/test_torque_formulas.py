"""Torques given by formulas and functions: equality with built-in laws, checks and errors."""

import json
import pickle

import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0, REFERENCE, START, moments

BODY = moments(1, 2, 2.5)
T = ph.torque
C = ph.vector([0.5, 0.25, 1.0])
REST = ph.Rotor.from_components([1, 0.2, 0.3, -0.1])

# A built-in law and its formula.
SAME = {
    "heavy": (T.heavy(C), T.formula("(~R e3 R) ∧ c", c=C)),
    "heavy, as the axial vector": (T.heavy(C), T.formula("-(c ⨯ (~R e3 R)) I", c=C)),
    "magnetic": (
        T.magnetic(C, [0.2, -0.4, 1.1]),
        T.formula("m ∧ (~R B R)", m=C, B=ph.vector([0.2, -0.4, 1.1])),
    ),
    "constant_space": (T.constant_space([1, 2, 3]), T.formula("N", N=ph.bivector([1, 2, 3]), frame="space")),
    "damping": (T.damping(0.3), T.formula("-g I(Ω_B)", g=0.3)),
    "damping in space": (T.damping(0.3), T.formula("-g L", g=0.3, frame="space")),
    "quadratic_damping": (T.quadratic_damping(0.3), T.formula("-k norm(Ω) Ω", k=0.3)),
    "viscous_damping": (T.viscous_damping(0.3), T.formula("-d Omega_S", d=0.3, frame="space")),
    "torsion_spring": (T.torsion_spring(1.5, REST), T.formula("2k log(~Q R)", k=1.5, Q=REST)),
    "larmor": (
        T.larmor([0.125, 0.5, 1]),
        T.formula("dual(L) ∧ b", b=ph.vector([0.125, 0.5, 1]), frame="space"),
    ),
    "gyrostat": (T.gyrostat([0.4, -0.3, 0.8]), T.formula("Ω × h", h=ph.bivector([0.4, -0.3, 0.8]))),
    "gravity_gradient": (
        T.gravity_gradient(1.0),
        T.formula("3 u_B ∧ (-I I(I u_B))", u_B=(~R0)(ph.e1)),
    ),
}


@pytest.mark.parametrize("name", SAME)
def test_a_formula_equals_the_built_in_law(name):
    law, formula = SAME[name]
    F = ph.Rotor.from_components([1, 2, 3, 4])
    for state, body in ((START, BODY), (START, BODY), (START, ph.Body(1.0, BODY).moved(F).inertia)):
        expected, found = law.at(body, state), formula.at(body, state)
        size = max(1.0, expected.norm())
        # Products of a few factors; turned to the principal axes and back where those are others.
        np.testing.assert_allclose(found.components, expected.components, rtol=0, atol=24 * EPS * size)


def test_a_motion_under_a_formula_is_that_of_the_law():
    """The same steps, to the rounding of the torque, which the motion amplifies little in this time."""
    law, formula = SAME["heavy"]
    t = np.linspace(0, 5, 11)
    expected = ph.simulate(BODY, START, t, law, step=1 / 64)
    found = ph.simulate(BODY, START, t, formula, step=1 / 64)
    np.testing.assert_allclose(found.rotor.components, expected.rotor.components, rtol=0, atol=1000 * EPS)
    assert found.certificate.drift.keys() == set()


def test_all_names_that_the_motion_defines():
    t, R, w = 1.25, R0, START.omega_body
    h = ph.bivector([0.4, -0.3, 0.8])
    m = BODY(w) + h
    given = {
        "t e1e2": t * (ph.e1 ^ ph.e2),
        "⟨R e1e2⟩_2": (R * (ph.e1 ^ ph.e2)).grade(2),
        "Ω_B": w,
        "Omega_B": w,
        "Ω": w,
        "Ω_S": R(w),
        "L": R(m),
        "L_B": m,
        "I(Ω)": BODY(w),
        "I e3": ph.I * ph.e3,
    }
    wheel = T.gyrostat(h)
    own = wheel.at(BODY, START, t)
    for text, value in given.items():
        found = (T.formula(text) + wheel).at(BODY, START, t) - own
        assert found.is_close(value, rtol=16 * EPS, atol=16 * EPS), text
    found = (T.formula("Ω", frame="space") + wheel).at(BODY, START, t) - own
    assert found.is_close(w, rtol=16 * EPS)


def test_values_of_every_kind():
    stretch = ph.LinearMap.from_function(lambda a: a + ph.e1 * (ph.e1 | a))
    values = {"a": ph.e1, "b": ph.e2, "s": 2, "S": BODY, "B": ph.e1 * ph.e2, "C": ph.e2 * ph.e3}
    law = T.formula("F(a) ∧ b + s S(B) + Q C ~Q", F=stretch, Q=REST, **values)
    expected = 2 * (ph.e1 ^ ph.e2) + 2 * BODY(ph.e1 ^ ph.e2) + REST(ph.e2 ^ ph.e3)
    assert law.at(BODY, START).is_close(expected, rtol=8 * EPS)


def test_the_manufactured_precession_of_the_reference():
    """R(t) = exp(−νt E3/2) exp(−θ E1/2) exp(−st E3/2): the torque for this motion, a formula of t."""
    case = next(
        c
        for c in json.loads(REFERENCE.read_text())["torqued"]
        if c["name"] == "manufactured_steady_precession"
    )
    nu, theta, s = (float(case["params"][key]) for key in ("nu", "theta", "s"))
    # γ = ~P e3 P turns in the body, γ' = −s γ·(e1e2); Ω_B = ν γ I + s e1e2.
    g = "⟨exp(½ s t e1e2) k exp(−½ s t e1e2)⟩_1"
    law = T.formula(
        f"I(−ν s {g}·(e1e2) I) + I(ν {g} I + s e1e2) × (ν {g} I + s e1e2)",
        s=s,
        k=ph.vector([0, np.sin(theta), np.cos(theta)]),
        ν=nu,
    )
    for result in case["results"]:
        t, expected = float(result["t"]), np.array([float(x) for x in result["torque_body"]])
        rotor = ph.Rotor.from_components([float(x) for x in result["R"]])
        state = ph.State(rotor, [float(x) for x in result["omega"]])
        found = law.at(moments(1, 2, 2.5), state, t).components
        np.testing.assert_allclose(found, expected, rtol=0, atol=16 * EPS * (1 + s * t))


# --- rejected formulas and places


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("R e3 ~R", ["vector", "`I v`", "^^^"]),
        ("Ω Ω_S", ["grades 0, 2", "⟨…⟩_2"]),
        ("5", ["grade 0", "a∧b"]),
        ("-c ∧ (~R e3 R", ["never closed", "^"]),
        ("c ∧ q", ["`q` has no value", "^"]),
        ("Ω = c ∧ e1", ["equation", "one side"]),
        ("I", ["grade 3"]),
        ("I(c)", ["^"]),
    ],
)
def test_formulas_that_are_not_torques_raise(text, parts):
    with pytest.raises(ph.FormulaError) as error:
        T.formula(text, c=C)
    for part in parts:
        assert part in str(error.value)
    assert error.value.__cause__ is None
    assert error.value.__context__ is None


def test_names_of_the_motion_are_reserved():
    for name in ("R", "t", "Ω", "Omega_B", "L", "I"):
        with pytest.raises(ph.FormulaError, match=f"`{name}` is given by the motion"):
            T.formula("Ω", **{name: 1.0})
    with pytest.raises(ValueError, match=r"batch.*\(2,\) of `a`.*\(3,\) of `b`"):
        T.formula("a ∧ b", a=ph.vector(np.eye(3)[:2]), b=ph.vector(np.eye(3)))
    with pytest.raises(TypeError, match="k"):
        T.formula("k Ω", k="much")
    with pytest.raises(TypeError, match=r"c is an array of shape \(3,\); .*ph.vector"):
        T.formula("c ∧ e1", c=[1, 2, 3])
    with pytest.raises(ValueError, match="k is nan"):
        T.formula("k Ω", k=np.nan)
    with pytest.raises(ValueError, match=r"c is .*nan.*finite"):
        T.formula("c ∧ e1", c=ph.vector([0, np.nan, 1]))


def test_laws_with_maps_and_exact_values_are_values():
    from fractions import Fraction

    stretch = ph.LinearMap.from_function(lambda a: a + ph.e1 * (ph.e1 | a))
    law = T.formula("F(a) ∧ b", F=stretch, a=ph.vector([Fraction(1, 2), 0, 0]), b=ph.e2)
    again = pickle.loads(pickle.dumps(law))
    assert again == law
    assert again != T.formula("F(a) ∧ b", F=stretch, a=ph.e1, b=ph.e2)
    assert again.at(BODY, START) == ph.e1 ^ ph.e2


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("Ω/(t − 2)", ["Ω/(t − 2)", "zero"]),
        ("e1∧e2 + Ω/(t − 2)", ["`Ω/(t − 2)` in the formula `e1∧e2 + Ω/(t − 2)`"]),
        ("Ω exp(1000 + t)", ["exp(1000 + t)"]),
        ("log(R − R)", ["log(R − R)"]),
    ],
)
def test_a_step_without_a_value_is_reported(text, parts):
    with pytest.raises(ValueError) as error:
        T.formula(text).at(BODY, START, 2.0)
    for part in parts:
        assert part in str(error.value)


def test_a_run_reports_the_time_of_such_a_step():
    law = T.formula("(e1∧e2)/(t − 1)")
    with pytest.raises(ValueError, match=r"at t = 1 s: .*\(e1∧e2\)/\(t − 1\)") as error:
        ph.simulate(BODY, START, [2.0], law, method="strang", step=0.25)
    assert "zero" in str(error.value)


# --- functions


def test_a_function_gets_body_axes():
    asked = []

    def torque(t, rotor, omega):
        asked.append((t, rotor, omega))
        return -0.5 * omega + t * (ph.e1 ^ ph.e2)

    F = ph.Rotor.from_components([1, 2, 3, 4])
    law = T.function(torque)
    found = law.at(ph.Body(1.0, BODY).moved(F).inertia, START, 2.0)
    ((t, rotor, omega),) = asked
    assert t == 2.0
    assert isinstance(rotor, ph.Rotor)
    assert rotor.is_close(R0, rtol=8 * EPS)
    assert omega.is_close(START.omega_body, rtol=8 * EPS)
    assert found.is_close(-0.5 * START.omega_body + 2 * (ph.e1 ^ ph.e2), rtol=16 * EPS)
    assert repr(law) == "function(torque)"
    assert law == T.function(torque) != T.function(print)


@pytest.mark.parametrize(
    "answer",
    [[1, 2, 3], (1.0, 2.0, 3.0), np.array([1.0, 2, 3]), ph.multivector([0, 0, 0, 0, 1, 2, 3, 0])],
    ids=repr,
)
def test_a_function_may_return_three_numbers(answer):
    found = T.function(lambda t, rotor, omega: answer).at(BODY, START)
    np.testing.assert_array_equal(found.components, [1, 2, 3])


@pytest.mark.parametrize(
    ("answer", "parts"),
    [
        (ph.e1, ["t = 1.5 s", "bivector"]),
        (None, ["t = 1.5 s"]),
        ([1, 2], ["t = 1.5 s", "(2,)"]),
        (np.zeros((2, 3)), ["t = 1.5 s", "[2, 3]"]),
        ([1, np.nan, 0], ["t = 1.5 s", "NaN"]),
    ],
    ids=repr,
)
def test_invalid_return_values_raise(answer, parts):
    with pytest.raises((TypeError, ValueError)) as error:
        T.function(lambda t, rotor, omega: answer).at(BODY, START, 1.5)
    for part in parts:
        assert part in str(error.value)


class SensorError(Exception):
    """An exception that only these tests raise."""


def broken(t, rotor, omega):
    raise SensorError(f"no signal at {t}")


@pytest.mark.parametrize("wrong", [lambda t, state: [0, 0, 1], lambda rotor: None])
def test_a_function_takes_three_arguments(wrong):
    with pytest.raises(TypeError, match="called with t, rotor and omega_body, which <lambda> does not take"):
        ph.torque.function(wrong)
    assert ph.torque.function(max) == ph.torque.function(max)  # a signature that Python does not know


def test_exceptions_of_a_function_pass_through():
    law = T.function(broken)
    for _ in range(2):
        with pytest.raises(SensorError, match=r"no signal at 2\.5"):
            law.at(BODY, START, 2.5)
        with pytest.raises(SensorError, match="no signal at"):
            ph.simulate(BODY, START, [1.0], T.damping(0.5) + law)
    assert pickle.loads(pickle.dumps(law)) == law


def test_a_run_reports_invalid_return_values():
    with pytest.raises(ValueError, match=r"at t = 0.* s: the torque .*NaN"):
        ph.simulate(BODY, START, [1.0], T.function(lambda t, rotor, omega: [np.nan, 0, 0]))


def test_laws_do_not_keep_errors_of_others():
    good, bad = T.heavy(C), T.function(broken)
    with pytest.raises(SensorError):
        (good + bad).at(BODY, START)
    with pytest.raises(ValueError, match="table"):
        (T.tabulated([0, 1], np.zeros((2, 3))) + bad).at(BODY, START, 3.0)
