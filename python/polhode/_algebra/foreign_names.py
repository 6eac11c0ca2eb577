"""Names of other libraries: attributes that do not exist, with errors that name ours."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import NoReturn, TypeVar

T = TypeVar("T")

# As in clifford, kingdon and galgebra.
_MULTIVECTOR = {
    "angle": "Rotor.from_vectors(a, b).angle for the angle between two vectors",
    "conjugate": "clifford_conjugate()",
    "coordinates": "coordinates(P) of its algebra, as in ph.pga(3).coordinates(P)",
    "cp": "commutator(B)",
    "cross": "ph.cross(a, b)",
    "gradeInvol": "grade_involution()",
    "inv": "inverse()",
    "involute": "grade_involution()",
    "lc": "left_contraction(B)",
    "mag2": "norm_squared()",
    "normal": "normalized()",
    "normsq": "norm_squared()",
    "proj": "project(B)",
    "rc": "right_contraction(B)",
    "rev": "reverse()",
    "rotate": "R(a) for a rotor R",
    "sp": "scalar_product(B)",
    "value": "dense() or components",
    "x": 'A["e1"]',
    "y": 'A["e2"]',
    "z": 'A["e3"]',
    **{name: f'A["{name}"]' for name in ("e1", "e2", "e3", "e12", "e13", "e23", "e31", "e123")},
}

# As in SciPy, numpy-quaternion and other libraries of rotations.
_ROTOR = {
    "align": "ph.align(a, b), or Rotor.from_vectors(a, b) for two directions",
    "align_vectors": "ph.align(a, b), which takes the target last",
    "approx_equal": "distance(S) or is_close(S, rtol, atol)",
    "as_davenport": "to_davenport(axes, order)",
    "as_dcm": "to_matrix()",
    "as_euler": "to_euler(seq)",
    "as_euler_angles": 'to_euler("ZYZ")',
    "as_float_array": 'to_quaternion(order="wxyz")',
    "as_matrix": "to_matrix()",
    "as_mrp": "to_mrp()",
    "as_quat": 'to_quaternion(order="xyzw")',
    "as_rotation_matrix": "to_matrix()",
    "as_rotation_vector": "to_rotation_vector()",
    "as_rotvec": "to_rotation_vector()",
    "axis": "to_rotation_vector(), or plane_angle() for the plane and the angle",
    "between": "Rotor.from_vectors(a, b)",
    "concatenate": "ph.stack([R, S]), or ph.concatenate([R, S]) of batches",
    "euler": "to_euler(seq)",
    "create_group": "group(name)",
    "from_dcm": "from_matrix(M)",
    "from_euler_angles": 'from_euler("ZYZ", angles)',
    "from_float_array": 'from_quaternion(q, order="wxyz")',
    "from_quat": 'from_quaternion(q, order="xyzw")',
    "from_rotation_matrix": "from_matrix(M)",
    "from_rotvec": "from_rotation_vector(v)",
    "from_two_vectors": "from_vectors(a, b)",
    "inv": "~R or inverse()",
    "matrix": "to_matrix()",
    "plane": "plane_angle()",
    "quaternion": 'to_quaternion(order="wxyz")',
    "rotate": "R(a)",
    "slerp": "ph.slerp(R, S, t)",
    "to_dcm": "to_matrix()",
    "to_quat": 'to_quaternion(order="xyzw")',
    "to_rotvec": "to_rotation_vector()",
    **dict.fromkeys("wxyz", 'to_quaternion(order="wxyz")'),
}

# Of complex coefficients, which rotors do not have. Elsewhere the names are of quaternions.
_PARTS = {
    "conj": "~R",
    "imag": 'grade(2), or to_quaternion(order="xyzw")[..., :3]',
    "real": 'R["1"]',
}

# Of plane-based algebras, as in kingdon, ganja.js and text books.
PGA = {
    "distance": "(L & P).norm() for a line or plane L of norm 1 and a point P",
    "ideal_point": "direction(x)",
    "join": "P & Q",
    "meet": "X ^ Y",
    "project": "(X | Y) / Y",
    "rotor": "(-θ/2 * L).exp() for the rotation by θ about a line L of norm 1",
    "translation": "translator(t)",
}


class ForeignName:
    """A name that a class does not have: an AttributeError, also for `hasattr`, that says what to write."""

    __slots__ = ("name", "ours")

    def __init__(self, name: str, ours: str) -> None:
        self.name, self.ours = name, ours

    def __get__(self, value: object, kind: type) -> NoReturn:
        article = "an" if kind.__name__[0] in "AEIOU" else "a"
        raise AttributeError(f"{article} {kind.__name__} has no attribute {self.name!r}; write {self.ours}")


def add_to(multivector: type, rotor: type) -> None:
    """Give both classes the names of other libraries."""
    _add(multivector, _MULTIVECTOR)
    _add(rotor, _ROTOR)
    for name, ours in _PARTS.items():
        setattr(rotor, name, ForeignName(name, ours))


def with_foreign_names(names: Mapping[str, str]) -> Callable[[type[T]], type[T]]:
    """Give a class names of other libraries, which ``dir`` of its values does not list."""

    def named(kind: type[T]) -> type[T]:
        _add(kind, names)
        setattr(kind, "__dir__", listed)  # noqa: B010, a type checker knows the original
        return kind

    return named


def _add(kind: type, names: Mapping[str, str]) -> None:
    for name, ours in names.items():
        if not hasattr(kind, name):
            setattr(kind, name, ForeignName(name, ours))


def listed(value: object) -> Iterable[str]:
    """Return the names for ``dir(value)``, without those of other libraries."""
    kinds = type(value).__mro__
    names = {name: member for kind in reversed(kinds) for name, member in vars(kind).items()}
    own = {name for name, member in names.items() if not isinstance(member, ForeignName)}
    return sorted(own | getattr(value, "__dict__", {}).keys())
