"""Forces on the centre of mass for `polhode.simulate`: ``x' = v``, ``v' = F/m``, the x0 of handout eq. (4.1).

Forces add up and are multiplied by numbers, and a vector or an array (..., 3) is a constant force in N:
``ph.vector([0, 0, -9.81]) + 2 * ph.force.drag(0.1)``.

Arguments may be batches of any shape, with a value for each of many bodies that `simulate` moves at once: an
array of numbers, or batched vectors. Python functions are shared by all bodies.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from polhode._mechanics.forces import Force, force_of, native_force
from polhode._mechanics.laws import function_of, law_of_formula
from polhode._mechanics.parameters import named_together
from polhode._support.calls import explains_calls
from polhode._support.package_names import missing_law

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


# Names that are not ours, and what to write instead.
_FOREIGN = {
    "gravity": "force.constant(-9.81 * m * ph.e3), or of a centre force.central(mu)",
    "damping": "force.drag(k)",
    **dict.fromkeys(("kepler", "newton", "point_mass"), "force.central(mu)"),
    **dict.fromkeys(("thruster", "body_force"), "force.thrust(F)"),
}


def __dir__() -> list[str]:
    return __all__


if not TYPE_CHECKING:

    def __getattr__(name: str) -> None:
        raise missing_law("force", name, _FOREIGN)


@explains_calls
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
    return force_of("constant", F)


@explains_calls
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
    return force_of("thrust", force) if at is None else force_of("thrust", force, at)


@explains_calls
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
    return force_of("drag", k)


@explains_calls
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
    return force_of("quadratic_drag", k)


@explains_calls
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
    return force_of("spring", stiffness, anchor)


@explains_calls
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
    return force_of("central", mu)


@explains_calls
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
        return native_force("formula", text, named_together(given))

    return law_of_formula(law, text, values, batches=True)


@explains_calls
def function(f: Callable[..., Any], *, omega_body: bool = False) -> Force:
    """Return the force of a Python function ``f(t, position, velocity, rotor)``.

    Its arguments are the time in s, the position and the velocity of the centre of mass, vectors in space in
    m and m/s, and the rotor from body axes to space; it returns the force in space in N, a vector or (3,).
    Its exceptions pass through `simulate`. It is slower than a `formula`; the force can be pickled if f can.

    Parameters
    ----------
    f
        The function.
    omega_body
        Whether to call ``f(t, position, velocity, rotor, omega_body)``, with the angular velocity in body
        axes, a bivector in rad/s, such as for the lift of a spinning ball.

    Examples
    --------
    >>> ball = ph.Body.sphere(0.1, mass=2)
    >>> thrown = ph.State(ph.Rotor.identity(), [0, 0, 0], velocity=[1, 0, 0])
    >>> law = ph.force.function(lambda t, position, velocity, rotor: -1.0 * velocity)
    >>> ph.simulate(ball, thrown, [0, 1, 2], force=law).velocity["e1"].round(4)  # exp(-t/2)
    array([1.    , 0.6065, 0.3679])
    """
    if not isinstance(omega_body, bool):
        raise TypeError(f"omega_body must be True or False, got {omega_body!r}")
    spin = ("omega_body",) if omega_body else ()
    return native_force("function", function_of(f, "t", "position", "velocity", "rotor", *spin), omega_body)
