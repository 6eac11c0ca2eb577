"""Formulas with names of given kinds in several algebras, whose code is tested."""

from typing import NamedTuple

import numpy as np

import polhode as ph

ROWS = 5


class Case(NamedTuple):
    """A formula of an algebra, and the kinds of its names in the order of the arguments."""

    text: str
    kinds: dict
    algebra: tuple = (3,)

    def formula(self):
        return ph.formula(self.text, algebra=ph.algebra(*self.algebra))

    def values(self):
        """Random values by name: for a scalar an array of numbers."""
        rng = np.random.default_rng(len(self.text))
        return {name: _value(rng, self.algebra, kind) for name, kind in self.kinds.items()}


def _value(rng, algebra, kind):
    if kind == "rotor":
        return ph.Rotor.from_components(rng.normal(size=(ROWS, 4)))
    if kind == "map of vectors":
        return ph.LinearMap.from_matrix(rng.normal(size=(3, 3)))
    if kind == "map of bivectors":
        return ph.Inertia.from_principal_moments(1, 2, 3)
    if kind == 0:
        return rng.uniform(0.5, 2, ROWS)
    grades = (kind,) if isinstance(kind, int) else kind
    space = ph.algebra(*algebra)
    parts = []
    for k in grades:
        size = int(np.sum(np.asarray(space._grade_of) == k))
        # A large scalar keeps inverses away from singular values.
        parts.append(rng.uniform(-1, 1, (ROWS, size)) + (3.0 if k == 0 else 0.0))
    mask = sum(1 << k for k in grades)
    return ph.Multivector._of(np.concatenate(parts, axis=-1), mask, space)


CASES = [
    Case("R x ~R", {"R": "rotor", "x": 1}),
    Case("R M ~R", {"R": "rotor", "M": (0, 1, 2, 3)}),
    Case("R S (x·Ω) ~S ~R", {"x": 1, "Ω": 2, "S": "rotor", "R": "rotor"}),
    Case("R³ + log(R) + sqrt(S)", {"R": "rotor", "S": "rotor"}),
    Case("exp(B) + R⁻¹", {"B": 2, "R": "rotor"}),
    Case("exp(-θ/2 e12) x", {"θ": 0, "x": 1}),
    Case("exp(a) + exp(t)", {"a": 1, "t": 3}),
    Case("exp(M) + log(M) sqrt(M)", {"M": (0, 2)}),
    Case("log(a·a) + sqrt(a·a)", {"a": 1}),
    Case("sin(s) e1 + cos(s) e2 + tan(s) e3", {"s": 0}),
    Case("a⁻¹ b + B⁻¹", {"a": 1, "b": 1, "B": 2}),
    Case("M⁻¹ norm(M)", {"M": (0, 1, 2, 3)}),
    Case("⟨A B⟩_2 + A×B - A⌋B", {"A": (0, 1, 2, 3), "B": (1, 2)}),
    Case("dual(B) - undual(a)/s", {"a": 1, "B": 2, "s": 0}),
    Case("½ inertia(Ω)·~Ω", {"Ω": 2, "inertia": "map of bivectors"}),
    Case("F(a) + F(a∧b) + F(a∧b∧c)", {"F": "map of vectors", "a": 1, "b": 1, "c": 1}),
    Case("a∧b + b∧a + Ω_B R' loop", {"loop": 0, "R'": 0, "Ω_B": 1, "a": 1, "b": 1}),
    Case("2π e1", {}),
    Case("A⁻¹ B", {"A": (0, 1, 2), "B": (0, 1, 2)}, (2,)),
    Case("M P ~M", {"M": (0, 2, 4), "P": 1}, (3, 0, 1)),
    Case("M⁻¹ norm(M) + P⁻¹", {"M": (0, 2, 4), "P": 1}, (3, 0, 1)),
    Case("exp(θ e14)", {"θ": 0}, (3, 0, 1)),
    Case("A⁻¹", {"A": (0, 1, 2, 3, 4)}, (1, 3)),
    Case("M P ~M", {"M": (0, 2, 4), "P": 1}, (4, 1)),
    Case("exp(a) + A⁻¹", {"a": 1, "A": (0, 1, 2, 3, 4, 5)}, (4, 1)),
    Case("exp(a) + a⁻¹", {"a": 1}, (2, 2)),
    Case("a b + a·b", {"a": 1, "b": 1}, (6,)),
]
