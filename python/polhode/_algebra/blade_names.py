"""Names of basis elements: ``e12``, ``e1e2``, ``e1^e2`` and the printed ``e1∧e2``."""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from polhode._algebra.coefficients import kind_of

if TYPE_CHECKING:
    from polhode._algebra.algebra import Algebra
    from polhode._algebra.multivector import Multivector


class Blades(dict[str, "Multivector"]):
    """Basis elements by their printed names; other spellings and orders are found, too."""

    def __init__(self, algebra: Algebra, elements: dict[str, Multivector]) -> None:
        super().__init__(elements)
        self._algebra = algebra

    def __contains__(self, name: object) -> bool:
        return self.get(name) is not None

    def get(self, name: Any, default: Any = None) -> Any:
        """Return an element by any of its names, or the default."""
        try:
            return self[name]
        except KeyError:
            return default

    def __getattr__(self, name: str) -> NoReturn:
        if name.startswith("_"):  # while a copy is built
            raise AttributeError(name)
        remedy = f'; write blades["{name}"]' if name in self else ""
        raise AttributeError(f"the blades of {self._algebra} have no attribute {name!r}{remedy}")

    def __missing__(self, name: Any) -> Multivector:
        named = self._algebra._named()
        if name in named:
            return named[name]
        try:
            place, sign = place_of(self._algebra, name)
        except IndexError as error:
            raise KeyError(str(error)) from None
        element = list(self.values())[place]
        return -element if sign < 0 else element


def component(value: Multivector, name: str) -> Any:
    """Return the component of a basis element: a number, or an array of the batch shape."""
    place, sign = place_of(value.algebra, name)
    held, data = value.algebra._indices(value._mask), value._data
    if place not in held:
        zero = data[..., 0]
        zeros = np.zeros_like(zero) if isinstance(data, np.ndarray) else kind_of(data).zeros_like(zero)
        return zeros[()] if isinstance(zeros, np.ndarray) else zeros
    found = data[..., held.index(place)]
    if isinstance(found, np.ndarray):
        return -found if sign < 0 else found.copy() if found.ndim else found[()]
    return -found if sign < 0 else found


@functools.cache
def place_of(algebra: Algebra, name: str) -> tuple[int, int]:
    """Return the place of a basis element among all, and the sign of the order written: −1 for ``e13``.

    An IndexError for a text that is not the name of a basis element.
    """
    if name == "1":
        return 0, 1
    if name == "I":
        return algebra.size - 1, 1
    generators = _generators(algebra, name)
    if len(set(generators)) < len(generators):
        raise IndexError(f"{name!r} names a generator twice; name each once, as in e12")
    swaps = sum(a > b for i, a in enumerate(generators) for b in generators[i + 1 :])
    bits = sum(1 << k for k in generators)
    for place, (blade, sign) in enumerate(algebra._blades()):
        if blade == bits:
            return place, -sign if swaps % 2 else sign
    raise AssertionError(f"{algebra} has no basis element of the bits {bits}")


def generators_of(bits: int, sign: int) -> list[int]:
    """Return the generators of a basis element, from 0, in the order of its name: of ``e31`` 2 and 0.

    A negative sign swaps the last two.
    """
    rising = [i for i in range(bits.bit_length()) if bits >> i & 1]
    return rising if sign > 0 else [*rising[:-2], rising[-1], rising[-2]]


def _generators(algebra: Algebra, name: Any) -> list[int]:
    """Return the generators in the order written, from 0."""
    places = {generator: k for k, generator in enumerate(algebra._names(1 << 1))}
    found: list[str] = []
    for part in re.split("[∧^]", name) if isinstance(name, str) else [""]:
        if part in places:
            found.append(part)
        else:
            found += (
                [f"e{digit}" for digit in part if digit != "e"] if re.fullmatch(r"(e\d+)+", part) else [part]
            )
    if not set(found) <= set(places):
        known = ", ".join(places) or "none"
        raise IndexError(
            f"{name!r} is not a basis element of {algebra}; write 1, I, or generators ({known}) as in e1, "
            "e12, e1e2, e1^e2"
        )
    return [places[generator] for generator in found]
