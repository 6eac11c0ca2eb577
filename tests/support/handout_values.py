"""Values of the names in the handout's equations, over four kinds of numbers.

Where an equation defines a name, its value is found in another way: by components, from a matrix, by sine and
cosine. Rotors are rational where the numbers are, so that all but exponentials holds exactly.
"""

import math
from fractions import Fraction
from itertools import count

import numpy as np
import sympy

import polhode as ph

ROWS = 10_000


class Numbers:
    """Random values over one kind of numbers; their names in the handout come from the functions below."""

    def __init__(self, kind):
        self.kind = kind
        self._rng = np.random.default_rng(1)
        self._made = count()

    @property
    def exact(self):
        return self.kind in ("Fraction", "SymPy")

    def numbers(self, count):
        """Components (..., count), none of them near 0."""
        if self.kind == "SymPy":
            return np.array([sympy.Symbol(f"s{next(self._made)}", real=True) for _ in range(count)])
        if self.kind == "Fraction":
            return np.array(
                [
                    Fraction(int(p), int(q))
                    for p, q in self._signed(self._rng.integers((1, 11), (11, 21), (count, 2)))
                ]
            )
        return self._signed(self._rng.uniform(0.1, 1.0, (ROWS, count) if self.kind == "batch" else count))

    def _signed(self, sizes):
        return sizes * self._rng.choice([-1, 1], sizes.shape)

    def each(self, count):
        """Scalars; an array of them is a batch."""
        return tuple(np.moveaxis(self.numbers(count), -1, 0))

    def number(self):
        return self.each(1)[0]

    def positive(self):
        if self.kind == "SymPy":
            return sympy.Symbol(f"p{next(self._made)}", positive=True)
        return abs(self.number())

    def vector(self):
        return ph.vector(self.numbers(3))

    def bivector(self):
        return ph.bivector(self.numbers(3))

    def rotor(self):
        """From the tangents of half angles, so that it is rational where the numbers are.

        R = q²/|q|² for an even q: its components are rational in those of q, and R ~R = 1. Symbols turn
        in a fixed plane by a symbolic angle.
        """
        if self.kind == "SymPy":
            (t,) = self.numbers(1)
            sine = [2 * t / (1 + t**2) * b for b in (_THIRD, 2 * _THIRD, 2 * _THIRD)]
            return ph.Rotor.from_components([(1 - t**2) / (1 + t**2), *sine])
        q = 1 + self.bivector()
        return ph.Rotor.from_components((q * q / q.norm_squared()).components)

    def plane(self):
        """A unit bivector, rational where the numbers are."""
        if self.kind == "SymPy":
            return ph.bivector([2 * _THIRD, -_THIRD, 2 * _THIRD])
        return self.rotor()(_E12)

    @property
    def _functions(self):
        return {"SymPy": (sympy.cos, sympy.sin), "Fraction": (math.cos, math.sin)}.get(
            self.kind, (np.cos, np.sin)
        )

    def turned(self, plane, angle, X):
        """X turned by an angle in a unit plane, without an exponential: the part in the plane turns."""
        cos, sin = self._functions
        along, across = X.project(plane), X.reject(plane)
        return along * cos(angle) + along.dot(plane) * sin(angle) + across

    def rotation(self, plane, angle):
        """The rotor of the turn, without an exponential."""
        cos, sin = self._functions
        return cos(angle / 2) - plane * sin(angle / 2)

    def whole(self, count):
        """The same, but whole if exact: the matrix of a map holds floats, and whole floats are exact."""
        if not self.exact:
            return self.numbers(count)
        return np.array([Fraction(int(n)) for n in self._signed(self._rng.integers(1, 10, count))])

    def exactly(self, n):
        """A whole number, of the kind."""
        return Fraction(n) if self.exact else float(n)


# --- section 1


def frame(v):
    """A turned right-handed frame; over single floats the basis itself."""
    if v.kind == "float":
        return {}
    R = v.rotor()
    return {f"e{k}": R(e) for k, e in enumerate(_BASIS, start=1)}


def values(v):
    """Values of every grade."""
    a, b, c, B = v.vector(), v.vector(), v.vector(), v.bivector()
    return {"a": a, "b": b, "c": c, "B": B, "M": v.number() + v.vector() + v.bivector() + v.number() * ph.I}


def parts(v):
    """A plane B = a∥∧b with b ⟂ a∥, and a vector with a part in it and one across."""
    R = v.rotor()
    parallel, b, across = v.number() * R(ph.e1), v.number() * R(ph.e2), v.number() * R(ph.e3)
    return {"a": parallel + across, "a∥": parallel, "a⊥": across, "b": b, "B": parallel.wedge(b)}


def planes(v):
    """B1, B2, B3."""
    names = frame(v)
    return names | {f"B{k}": plane for k, plane in enumerate(_planes(names), start=1)}


def _planes(names):
    e1, e2, e3 = (names.get(f"e{k}", e) for k, e in enumerate(_BASIS, start=1))
    return e2.wedge(e3), e3.wedge(e1), e1.wedge(e2)


def quaternions(v):
    """A quaternion w + xi + yj + zk with its units."""
    names = planes(v)
    units = {unit: -names[f"B{k}"] for k, unit in enumerate("ijk", start=1)}
    return names | units | {name: v.number() for name in "wxyz"}


def plane_algebra(v):
    """A vector of the plane, whose algebra is Cl(2)."""
    return {"a": ph.algebra(2).vector(v.numbers(2))}


def sum_of_grades(v):
    α, β, a, B = v.number(), v.number(), v.vector(), v.bivector()
    return {"α": α, "β": β, "a": a, "B": B, "M": α + a + B + β * ph.I}


# --- sections 2 and 3


def in_plane(v):
    """A vector of the plane e1e2, an angle, and a rotor of that plane, rational where the numbers are."""
    a, t = v.number() * ph.e1 + v.number() * ph.e2, v.number()
    R = ph.Rotor.from_components(
        np.stack([(1 - t**2) / (1 + t**2), 0 * t, 0 * t, 2 * t / (1 + t**2)], axis=-1)
    )
    return {"a": a, "R": R, "θ": v.number()}


def turn(v):
    """A turn by θ in the unit plane B, and a vector that it turns."""
    a, B, θ = v.vector(), v.plane(), v.number()
    return {"a": a, "B": B, "θ": θ, "R": v.rotation(B, θ), "a'": v.turned(B, θ, a)}


def turned_vector(v):
    """A rotor, and a vector that its matrix turns."""
    R, a = v.rotor(), v.vector()
    return {"R": R, "a": a, "a'": ph.vector((R.to_matrix() @ a.components[..., None])[..., 0])}


def turned_grades(v):
    """A rotor, and values of several grades before and after."""
    R, a, b, α, β = v.rotor(), v.vector(), v.vector(), v.number(), v.number()
    B, turned = a.wedge(b), R(a).wedge(R(b))
    M, turned_M = α + a + B + β * ph.I, α + R(a) + turned + β * ph.I
    return {"R": R, "B": B, "B'": turned, "M": M, "M'": turned_M}


def angular_momentum(v):
    """L over e2e3, e3e1, e1e2, by components."""
    x, p = v.vector(), v.vector()
    (x1, x2, x3), (p1, p2, p3) = _each(x), _each(p)
    L = _bivector([x2 * p3 - x3 * p2, x3 * p1 - x1 * p3, x1 * p2 - x2 * p1])
    return {"x": x, "p": p, "L": L}


def angular_momentum_in_the_plane(v):
    """L in Cl(2), which has one plane and no third axis."""
    G2 = ph.algebra(2)
    x, p = G2.vector(v.numbers(2)), G2.vector(v.numbers(2))
    (x1, x2), (p1, p2) = _each(x), _each(p)
    return {"x": x, "p": p, "L": (x1 * p2 - x2 * p1) * G2.I}


# --- section 4


def motion(v):
    """A moment of a rigid motion: rotor and frame with their rates, a point of the body."""
    R, Ω_B, x, x0, v0 = v.rotor(), v.bivector(), v.vector(), v.vector(), v.vector()
    Ω_S, point = R(Ω_B), R(x)
    ω = Ω_S.dual()
    frame = {f"f{k}": R(e) for k, e in enumerate(_BASIS, start=1)}
    rates = {f"{name}'": ph.cross(ω, f) for name, f in frame.items()}
    names = {"R": R, "R'": R * Ω_B / -2, "Ω_B": Ω_B, "Ω_S": Ω_S, "ω": ω, **frame, **rates}
    names |= {"x": x, "x0": x0, "v0": v0, "R(t)": R, "x0(t)": x0}
    return names | {"y(t)": point + x0, "v(t)": ph.cross(ω, point) + v0}


def spin(v):
    """ω = e3, of a frame."""
    names = frame(v)
    return {"ω": names.get("e3", ph.e3), **names}


def steady(v):
    """A steady turn at the rate λ in one plane."""
    plane, λ, t, R0 = v.plane(), v.positive(), v.positive(), v.rotor()
    return {"Ω_S": λ * plane, "t": t, "R(0)": R0, "R(t)": v.rotation(plane, λ * t) * R0}


def three_points(v):
    """Three masses about their centre that move as a body, of inertia ``Σ m (|x|² − x xᵀ)``."""
    first, second = v.whole(3), v.whole(3)
    points, masses = [first, second, -2 * first - 3 * second], [v.exactly(m) for m in (2, 3, 1)]
    R, Ω_B, x0, v0 = v.rotor(), v.bivector(), v.vector(), v.vector()
    matrix = sum(m * _inertia(x) for m, x in zip(masses, points, strict=True))
    L = _bivector([sum(matrix[..., i, j] * c for j, c in enumerate(_each(Ω_B))) for i in range(3)])
    inertia = ph.LinearMap.from_matrix(matrix.astype(float), grade=2)
    names = {"m": sum(masses), "I": inertia, "A": v.bivector(), "B": v.bivector()}
    names |= {"R": R, "Ω_B": Ω_B, "x0": x0, "v0": v0, "L": R(L)}
    for k, (m, x) in enumerate(zip(masses, map(ph.vector, points), strict=True), start=1):
        names |= {f"m{k}": m, f"x{k}": x, f"y{k}": R(x) + x0}
        names |= {f"v{k}": ph.cross(R(Ω_B).dual(), R(x)) + v0}
    return names


def _inertia(x):
    """The matrix of a point mass 1 over axial vectors."""
    return (x * x).sum(axis=-1, keepdims=True)[..., None] * np.eye(3, dtype=int) - x[..., :, None] * x[
        ..., None, :
    ]


def heavy_body(v):
    """A body in its principal frame under a torque, which changes Ω_B by Euler's equations."""
    return _body(v, _moments(v), v.each(3))


def free_body(v):
    """A body in its principal frame without a torque."""
    return _body(v, _moments(v), (0, 0, 0))


def symmetric_top(v):
    """A free body with i1 = i2, and the two steady turns of its motion."""
    i1, _, i3 = _moments(v)
    names = _body(v, (i1, i1, i3), (0, 0, 0))
    Ω_r = (i1 - i3) / i1 * names["ω3"] * _E12
    return {**names, "Ω_r": Ω_r, "Ω_l": names["R"](names["Ω_B"] - Ω_r), "B": v.bivector()}


def two_turns(v):
    """A rotor that two steady turns carry along, one in space and one in the body."""
    plane, λ, μ, t, R0 = v.plane(), v.positive(), v.positive(), v.positive(), v.rotor()
    R_t = v.rotation(plane, λ * t) * R0 * v.rotation(_E12, μ * t)
    return {"Ω_l": λ * plane, "Ω_r": μ * _E12, "t": t, "R(0)": R0, "R(t)": R_t}


def _moments(v):
    """Three different moments, whole if exact: the matrix of a map holds floats."""
    return tuple(map(v.exactly, (5, 7, 11))) if v.exact else tuple(1 + abs(x) for x in v.each(3))


def _body(v, moments, torque):
    """The names of a body in its principal frame; the torque by its components in the body."""
    i1, i2, i3 = moments
    ω1, ω2, ω3 = v.each(3)
    τ1, τ2, τ3 = torque
    rates = [
        ((i2 - i3) * ω2 * ω3 + τ1) / i1,
        ((i3 - i1) * ω3 * ω1 + τ2) / i2,
        ((i1 - i2) * ω1 * ω2 + τ3) / i3,
    ]
    R, Ω_B = v.rotor(), _bivector([ω1, ω2, ω3])
    matrix = np.stack([np.asarray(i, dtype=float) for i in moments], axis=-1)[..., None] * np.eye(3)
    names = {"i1": i1, "i2": i2, "i3": i3, "ω1": ω1, "ω2": ω2, "ω3": ω3}
    names |= {f"ω{k}'": rate for k, rate in enumerate(rates, start=1)}
    names |= {"R": R, "R'": R * Ω_B / -2, "Ω_B": Ω_B, "Ω_B'": _bivector(rates), "Ω_S": R(Ω_B)}
    names |= {f"f{k}": R(e) for k, e in enumerate(_BASIS, start=1)}
    J, J_rate = (_bivector([i * x for i, x in zip(moments, xs, strict=True)]) for xs in ((ω1, ω2, ω3), rates))
    L_rate = names["R'"] * J * ~R + R(J_rate) + R * J * ~names["R'"]
    names |= {"L": R(J), "L'": L_rate, "T": R(_bivector(torque))}
    return names | {"I": ph.LinearMap.from_matrix(matrix, grade=2)}


def _bivector(components):
    return ph.bivector(np.stack(components, axis=-1))


def _each(value):
    """The components one by one, each over the batch."""
    return tuple(np.moveaxis(value.components, -1, 0))


_THIRD = sympy.Rational(1, 3)
_BASIS = (ph.e1, ph.e2, ph.e3)
_E12 = ph.e1.wedge(ph.e2)
