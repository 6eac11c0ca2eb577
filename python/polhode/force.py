"""Forces on the centre of mass for `polhode.simulate`: ``x' = v``, ``v' = F/m``, the x0 of handout eq. (4.1).

Forces add up and are multiplied by numbers, and a vector or an array (..., 3) is a constant force in N:
``ph.vector([0, 0, -9.81]) + 2 * ph.force.drag(0.1)``.

Arguments may be batches of any shape, with a value for each of many bodies that `simulate` moves at once: an
array of numbers, or batched vectors. Python functions are shared by all bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from polhode import _native
from polhode._algebra.constructors import as_points, vector
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._mechanics.bodies import Body
from polhode._mechanics.laws import finite, function_of, law_of_formula, shown
from polhode._mechanics.parameters import Batch, named_together, numbers, rows, together
from polhode._mechanics.registry import FORCES
from polhode._mechanics.sums import Sum, multiple, require_single
from polhode._support.arrays import Array, as_float

if TYPE_CHECKING:
    from polhode._mechanics.state import State

__all__ = [
    "Force",
    "central",
    "constant",
    "drag",
    "formula",
    "function",
    "quadratic_drag",
    "spring",
    "thrust",
]

# What counts as a constant force in a sum.
_VECTORS = (Multivector, np.ndarray)


@dataclass(frozen=True, repr=False)
class Force(Sum):
    """A sum of forces, returned by the functions of this module.

    Forces are immutable values: equal if their arguments are equal, hashable, and picklable.

    Examples
    --------
    Forces add up, and a vector is a constant force in N:

    >>> ph.force.constant([0, 0, -9.81]) + ph.force.drag(0.1)
    constant([0.0, 0.0, -9.81]) + drag(0.1)
    >>> ph.force.drag(0.1) - 9.81 * ph.e3
    drag(0.1) + constant([0.0, 0.0, -9.81])

    A number times a force is a force with other arguments:

    >>> 2 * ph.force.drag(0.1)
    drag(0.2)
    """

    laws: tuple[_native.Force, ...]
    _constant = "for a constant force write constant(F) or a vector"

    def __add__(self, other: Force | Multivector | Array) -> Force:
        return super().__add__(constant(other) if isinstance(other, _VECTORS) else other)

    def __radd__(self, other: int | Multivector | Array) -> Force:
        return constant(other) + self if isinstance(other, _VECTORS) else super().__radd__(other)

    def __sub__(self, other: Force | Multivector | Array) -> Force:
        return super().__sub__(constant(other) if isinstance(other, _VECTORS) else other)

    def __rsub__(self, other: int | Multivector | Array) -> Force:
        return constant(other) - self if isinstance(other, _VECTORS) else super().__rsub__(other)

    def _multiple(self, law: _native.Force, factor: float, done: str) -> _native.Force:
        return multiple(law, factor, (0,), done)

    def at(self, body: Body, state: State, t: float | None = None) -> Multivector:
        """Return the force at a single state and time, a vector in space in N.

        In formulas, L excludes the momentum of `gyrostat` wheels. The time t is in s, by default that of the
        state.

        Examples
        --------
        Weight and drag of a ball that moves at 2 m/s along e1:

        >>> ball = ph.Body.sphere(0.1, mass=0.5)
        >>> state = ph.State(ph.Rotor.identity(), [0, 0, 0], velocity=[2, 0, 0])
        >>> (ph.force.constant([0, 0, -5]) + ph.force.drag(0.1)).at(ball, state)
        -0.2 e1 - 5 e3
        """
        # Here, for simulations need not import formulas.
        from polhode._mechanics.force_values import names_of_motion, value_of
        from polhode._mechanics.state import require_single_state

        require_single(self)
        if not isinstance(body, Body):
            raise TypeError(f"a force needs a Body, which has a mass, got {type(body).__name__}")
        require_single_state(state)
        motion = names_of_motion(body, state, finite(as_float(state.time if t is None else t, "t"), "t"))
        return sum((value_of(law, motion) for law in self.laws), vector([0.0, 0.0, 0.0]))

    def __repr__(self) -> str:
        return " + ".join(map(_shown, self.laws)) or "Force(())"


def __dir__() -> list[str]:
    return __all__


def constant(F: Any) -> Force:
    """Return a force constant in space, a vector or (..., 3) in N.

    Examples
    --------
    A ball that falls for 2 s at 10 m/s²:

    >>> ball = ph.Body.sphere(0.1, mass=0.5)
    >>> still = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> fall = ph.simulate(ball, still, [2.0], force=ph.force.constant([0, 0, -5]))
    >>> round(float(fall.position[-1]["e3"]), 9)  # −½ g t²
    -20.0
    """
    return _force("constant", F)


def thrust(force: Any, at: Any = None) -> Force:
    """Return a force F constant in body axes, a vector or (..., 3) in N, such as a thruster's.

    It acts at the point `at` of the body, (..., 3) in body axes in m, and so exerts the torque
    ``(at − c)∧F`` about the centre of mass c; by default it acts at the centre of mass.

    Examples
    --------
    A thruster of 2 N, 1 m off the centre of mass, spins the body, with the torque 2 N m:

    >>> ball = ph.Body(4, ph.Inertia.from_principal_moments(4, 4, 4))
    >>> still = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> motion = ph.simulate(ball, still, [1.0], force=ph.force.thrust([0, 2, 0], at=[1, 0, 0]))
    >>> round(float(motion.omega_body[-1]["e12"]), 9)
    0.5
    """
    return _force("thrust", force) if at is None else _force("thrust", force, at)


def drag(k: Any) -> Force:
    """Return ``−k v``, k (...) in N s/m. The centre of mass moves in closed form.

    A negative k drives the body: alone, its speed grows as ``exp(−k t/m)``.

    Examples
    --------
    >>> ball = ph.Body.sphere(0.1, mass=2)
    >>> thrown = ph.State(ph.Rotor.identity(), [0, 0, 0], velocity=[1, 0, 0])
    >>> motion = ph.simulate(ball, thrown, [0, 1, 2], force=ph.force.drag(1))
    >>> motion.velocity["e1"].round(4)  # exp(-k t/m)
    array([1.    , 0.6065, 0.3679])

    Three balls, each with its own drag:

    >>> motion = ph.simulate(ball, thrown, [1], force=ph.force.drag([0, 1, 2]))
    >>> motion.velocity["e1"].round(4)
    array([[1.    ],
           [0.6065],
           [0.3679]])
    """
    return _force("drag", k)


def quadratic_drag(k: Any) -> Force:
    """Return ``−k |v| v``, k (...) in N s²/m², ``k >= 0``.

    Examples
    --------
    A ball that falls in air reaches the speed ``√(m g/k)``, here 7 m/s:

    >>> ball = ph.Body.sphere(0.1, mass=0.5)
    >>> dropped = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> forces = ph.force.constant([0, 0, -4.9]) + ph.force.quadratic_drag(0.1)
    >>> ph.simulate(ball, dropped, [0, 10, 20], force=forces).velocity["e3"].round(4)
    array([ 0., -7., -7.])
    """
    return _force("quadratic_drag", k)


def spring(stiffness: Any, anchor: Any = 0) -> Force:
    """Return ``−k (x − anchor)``, the stiffness k (...) in N/m, the anchor a point in space, (..., 3) in m.

    The centre of mass moves in closed form. A negative k repels from the anchor.

    Examples
    --------
    A mass on a spring is on the other side after half a period, ``π √(m/k)``:

    >>> ball = ph.Body.sphere(0.1, mass=4)
    >>> pulled = ph.State(ph.Rotor.identity(), [0, 0, 0], position=[1, 0, 0])
    >>> swing = ph.simulate(ball, pulled, [2 * np.pi], force=ph.force.spring(1))
    >>> round(float(swing.position[-1]["e1"]), 9)
    -1.0
    """
    return _force("spring", stiffness, anchor)


def central(mu: Any) -> Force:
    """Return ``−μ m x/|x|³``: attraction by a centre at the origin of space, μ = G M (...) in m³/s².

    A negative μ repels.

    Examples
    --------
    A circular orbit of radius 1 around ``μ = 1`` has the period 2π:

    >>> moon = ph.Body.sphere(0.1, mass=1)
    >>> start = ph.State(ph.Rotor.identity(), [0, 0, 0], position=[1, 0, 0], velocity=[0, 1, 0])
    >>> orbit = ph.simulate(moon, start, [np.pi, 2 * np.pi], force=ph.force.central(1))
    >>> orbit.position["e1"].round(9)
    array([-1.,  1.])
    """
    return _force("central", mu)


def formula(text: str, /, **values: Any) -> Force:
    """Return the force of a formula in the handout's notation: ``formula("-k v", k=0.5)``.

    The formula is checked at once: its value must be a vector, the force in space in N. The motion defines

    - ``x`` and ``v``, the position and the velocity of the centre of mass, vectors in space in m and m/s
      (a cross product is ``cross(a, b)``), and ``m``, the mass in kg,
    - ``R``, the rotor from body axes to space, and ``t``, the time in s,
    - ``Ω_B`` and ``Ω_S`` (or ``Omega_B``, ``Omega_S``), the angular velocity in body axes and in space,
      bivectors in rad/s, ``L`` and ``L_B``, the angular momentum in space and in body axes, and ``I(…)``,
      the inertia map of the body.

    Parameters
    ----------
    text
        The formula.
    values
        Values of the other names: multivectors and rotors, single or batched, numbers, single linear maps.
        Write a batch of numbers as `ph.scalar`.

    Raises
    ------
    FormulaError
        If the text is not a formula or its value is not a vector, with the place. If the formula has no
        value at some point of a motion, `simulate` raises and names the part of the formula.

    Examples
    --------
    Weight and drag in one formula; the speed approaches ``m g/k``, here 5 m/s:

    >>> ball = ph.Body.sphere(0.1, mass=0.5)
    >>> dropped = ph.State(ph.Rotor.identity(), [0, 0, 0])
    >>> law = ph.force.formula("-m g e3 - k v", g=10, k=1)
    >>> ph.simulate(ball, dropped, [0, 10, 20], force=law).velocity["e3"].round(4)
    array([ 0., -5., -5.])
    """

    def law(given: tuple[tuple[str, Any], ...]) -> Force:
        return _native_force("formula", text, named_together(given))

    return law_of_formula(law, text, values, batches=True)


def function(f: Callable[[float, Multivector, Multivector, Rotor], Any]) -> Force:
    """Return the force of a Python function ``f(t, position, velocity, rotor)``.

    Its arguments are the time in s, the position and the velocity of the centre of mass, vectors in space,
    and the rotor from body axes to space; it returns the force in space in N, a vector or (3,). Its
    exceptions pass through `simulate`. It is slower than a `formula`; the force can be pickled if f can.

    Examples
    --------
    >>> ball = ph.Body.sphere(0.1, mass=2)
    >>> thrown = ph.State(ph.Rotor.identity(), [0, 0, 0], velocity=[1, 0, 0])
    >>> law = ph.force.function(lambda t, position, velocity, rotor: -1.0 * velocity)
    >>> ph.simulate(ball, thrown, [0, 1, 2], force=law).velocity["e1"].round(4)  # exp(-t/2)
    array([1.    , 0.6065, 0.3679])
    """
    return _native_force("function", function_of(f, "t", "position", "velocity", "rotor"))


def _force(name: str, *values: Any) -> Force:
    """Return the force of the registry with these values for its arguments."""
    entries = FORCES[name].arguments
    convert: dict[str, Any] = {"scalar": numbers, "vector": _vectors}
    arguments = [convert[x.shape](value, x.name) for x, value in zip(entries, values, strict=False)]
    return _native_force(name, *arguments, names=[x.name for x in entries])


def _native_force(name: str, *arguments: Any, names: Sequence[str] = ()) -> Force:
    return Force((_native.Force(name, *together(arguments, name, names)),))


def _vectors(value: Any, name: str) -> tuple[float, ...] | Batch:
    return rows(as_points(value, f"the force's {name}"), f"the force's {name}")


def _shown(law: _native.Force) -> str:
    if law.name == "formula":
        text, values = law.arguments
        return shown("formula", [text], dict(values))
    if law.name == "thrust" and len(law.arguments) == 2:
        F, at = law.arguments
        return shown("thrust", [F], {"at": at})
    return shown(law.name, law.arguments, {})
