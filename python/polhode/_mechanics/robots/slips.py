"""Inertias that no body has, and the slips that lead to them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation

import numpy as np

from polhode._support.arrays import Array

# Density of osmium, the densest element at normal pressure, in kg/m³.
OSMIUM = 22_590.0

# Links with a larger root mean square distance of mass from its centre, in m, are questioned; so are centres
# of mass further from the origin.
_WIDE, _FAR = 10.0, 100.0

_NAMES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
_PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))

# Relative tolerance of a corrected inertia.
_ROUNDING = 1e-12

# Largest violation, relative to the largest moment, that counts as lost digits.
_MOST_ROUNDING = 0.05

_FACTORS = {3: " (g instead of kg?)", 6: " (mm instead of m?)", 9: " (g and mm instead of kg and m?)"}


@dataclass(frozen=True)
class Case:
    """An inertia (3, 3) about the centre of mass, with mass and centre of mass in the axes of the inertia.

    `texts` are the six entries as in the file; `in_rows` if a reader may take them for rows of the matrix.
    """

    matrix: Array
    mass: float
    center: Array
    texts: list[str]
    in_rows: bool

    @property
    def moments(self) -> Array:
        """The principal moments, ascending."""
        return np.asarray(np.linalg.eigvalsh(self.matrix), float)

    @property
    def entries(self) -> list[float]:
        """The entries xx, yy, zz, xy, xz, yz."""
        return [float(self.matrix[place]) for place in _PLACES]

    @property
    def spread(self) -> float:
        """Root mean square distance of the mass from its centre, in m: ``∫r² dm = tr(I)/2``."""
        return math.sqrt(0.5 * float(np.trace(self.matrix)) / self.mass)


def explain(case: Case) -> str:
    """Return by how much an impossible inertia is wrong, and the probable slip."""
    a, b, c = case.moments.tolist()
    moments = f"principal moments {a:.6g}, {b:.6g}, {c:.6g} kg m²"
    if a < -_ROUNDING * abs(c):
        words = f"inertia is not positive definite: {moments}; none may be negative"
    else:
        excess = c - a - b
        words = (
            f"no body has this inertia: {moments}; the largest exceeds the sum of the others "
            f"by {excess:.3g} kg m² ({100 * excess / c:.3g} %)"
        )
    slip = next(filter(None, (find(case) for find in _SLIPS)), None)
    return f"{words}. Probable slip: {slip}" if slip else words


def is_possible(matrix: Array) -> bool:
    """Whether a body has this inertia: no moment negative, none above the sum of the others."""
    a, b, c = np.linalg.eigvalsh(matrix).tolist()
    return bool(a >= -_ROUNDING * abs(c) and c - a - b <= _ROUNDING * abs(c))


# --- slips, the most certain first: each function returns its words, or None


def _placeholder(case: Case) -> str | None:
    if len({*case.entries}) == 1:
        return f"all six entries are {case.entries[0]:g}, a placeholder; compute the inertia"
    return None


def _negative(case: Case) -> str | None:
    wrong = [name for name, value in zip(_NAMES[:3], case.entries, strict=False) if value < 0]
    return f"sign of {' and '.join(wrong)}, which cannot be negative" if wrong else None


def _rounded(case: Case) -> str | None:
    """Rounding of all digits by half a unit in the last place changes ``i3 − i1 − i2`` by at most `bound`."""
    halves = [_half_unit(text) for text in case.texts]
    bound = sum(halves[:3]) + 4 * sum(halves[3:])
    if any(halves[3:]):
        bound += 2 * max(halves[:3])
    a, b, c = case.moments.tolist()
    if max(c - a - b, -a) <= min(bound * (1 + 1e-9), _MOST_ROUNDING * c):
        return "digits lost by rounding, as for a flat part; write more digits"
    return None


def _half_unit(text: str) -> float:
    """Return half a unit in the last digit of a number as written; 0 for zero."""
    try:
        number = Decimal(text)
    except InvalidOperation:
        return 0.0
    exponent = number.as_tuple().exponent
    return 0.5 * 10.0**exponent if number and isinstance(exponent, int) else 0.0


def _order(case: Case) -> str | None:
    xx, xy, xz, yy, yz, zz = case.entries
    if case.in_rows and is_possible(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])):
        return "fullinertia is in the order of URDF; MJCF has xx yy zz xy xz yz"
    return None


def _sign(case: Case) -> str | None:
    flipped = 2 * np.diag(np.diag(case.matrix)) - case.matrix
    if any(case.entries[3:]) and is_possible(flipped):
        return "sign of the products of inertia: ixy is -∫xy dm here, but +∫xy dm in some CAD programs"
    return None


def _products_in_another_unit(case: Case) -> str | None:
    diagonal, products = max(map(abs, case.entries[:3])), max(map(abs, case.entries[3:]))
    if diagonal > 0 and products > 30 * diagonal and is_possible(np.diag(np.diag(case.matrix))):
        return (
            f"the products of inertia are {products / diagonal:.4g} times the moments: "
            "another unit (g or mm instead of kg or m), or another order of the entries"
        )
    return None


def _other_point(case: Case) -> str | None:
    d = case.center
    steiner = case.mass * (d @ d * np.eye(3) - np.outer(d, d))
    # Any impossible inertia is possible with a large term: this one must be needed by more than half.
    if is_possible(case.matrix + steiner) and not is_possible(case.matrix + 0.5 * steiner):
        return (
            "inertia about another point than the centre of mass: it is possible with the term m d² of the "
            f"origin ({np.max(np.diag(steiner)):.3g} kg m²), which was subtracted once too often"
        )
    return None


def _product(case: Case) -> str | None:
    """``|∫xy dm| ≤ ½∫(x² + y²) dm``: half of izz."""
    for (i, j), name in zip(_PLACES[3:], _NAMES[3:], strict=True):
        k = 3 - i - j
        value, moment = float(case.matrix[i, j]), float(case.matrix[k, k])
        if abs(value) > 0.5 * moment * (1 + _ROUNDING):
            return (
                f"product of inertia too large: {name} = {value:g} kg m², but no body has more than "
                f"{_NAMES[k]}/2 = {0.5 * moment:g} kg m²"
            )
    return None


def _power_of_ten(case: Case) -> str | None:
    for k in range(3):
        own = float(case.matrix[k, k])
        others = float(np.trace(case.matrix)) - own
        if not others / 5 < own < others * 5:
            sign = -1 if own > others else 1
            for power in range(1, 10):
                corrected = case.matrix.copy()
                corrected[k, k] = own * 10.0 ** (sign * power)
                if is_possible(corrected):
                    size = "large" if sign < 0 else "small"
                    factor = "10" if power == 1 else f"10^{power}"
                    words = f"{_NAMES[k]} = {own:g} is too {size} by a factor of about {factor}"
                    return words + _FACTORS.get(power, "") + "; check exponent and unit"
    return None


def _second_moments(case: Case) -> str | None:
    if case.moments[0] >= 0:
        return "entries are ∫x² dm, … along the axes instead of ∫(y² + z²) dm, … about them"
    return None


_SLIPS: tuple[Callable[[Case], str | None], ...] = (
    *(_placeholder, _rounded, _order, _other_point, _negative, _sign, _products_in_another_unit),
    *(_product, _power_of_ten, _second_moments),
)


# --- inertias that a body may have, but hardly this one


def doubts(case: Case) -> Iterator[str]:
    """Yield warnings of improbable values of a possible inertia."""
    distance = float(np.linalg.norm(case.center))
    if distance > _FAR:
        yield f"centre of mass is {distance:.3g} m from the origin of the link; is it in mm instead of m?"
    xx, yy, zz, *products = case.entries
    if not np.any(case.matrix):
        yield "inertia is 0, as of a point mass, which has no rotational motion"
        return
    if xx == yy == zz and not any(products) and math.log10(xx).is_integer():
        yield f"all moments are {xx:g} kg m²; is this a placeholder?"
    densest = math.sqrt(0.6) * (case.mass / (OSMIUM * 4 / 3 * math.pi)) ** (1 / 3)
    if case.spread < densest * (1 - 1e-9):
        yield (
            f"a body of {case.mass:g} kg with this inertia is denser than osmium: its mass has a root mean "
            f"square distance of {case.spread:.3g} m from its centre, a ball of osmium {densest:.3g} m; "
            "is the mass in g instead of kg?"
        )
    if case.spread > _WIDE:
        yield (
            f"mass of {case.mass:g} kg has a root mean square distance of {case.spread:.3g} m from its "
            "centre; is the inertia in kg mm² or g mm² instead of kg m²?"
        )
