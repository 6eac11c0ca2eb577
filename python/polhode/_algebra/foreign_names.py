"""Names of other libraries: attributes that do not exist, with errors that name ours."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NoReturn

# As in clifford, kingdon and galgebra.
_MULTIVECTOR = {
    "conjugate": "clifford_conjugate()",
    "cp": "commutator(B)",
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
    "sp": "scalar_product(B)",
    "value": "dense() or components",
    **{name: f'A["{name}"]' for name in ("e1", "e2", "e3", "e12", "e13", "e23", "e31", "e123")},
}

# As in SciPy.
_ROTOR = {
    "align_vectors": "ph.align(a, b), which takes the target last",
    "approx_equal": "distance(S) or is_close(S, rtol, atol)",
    "as_davenport": "to_davenport(axes, order)",
    "as_euler": "to_euler(seq)",
    "as_matrix": "to_matrix()",
    "as_mrp": "to_mrp()",
    "as_quat": 'to_quaternion(order="xyzw")',
    "as_rotvec": "to_rotation_vector()",
    "concatenate": "ph.concatenate([R, S])",
    "create_group": "group(name)",
    "from_quat": 'from_quaternion(q, order="xyzw")',
    "from_rotvec": "from_rotation_vector(v)",
    "inv": "~R or inverse()",
}


class ForeignName:
    """A name that a class does not have: an AttributeError, also for `hasattr`, that says what to write."""

    __slots__ = ("name", "ours", "owner")

    def __init__(self, owner: str, name: str, ours: str) -> None:
        self.owner, self.name, self.ours = owner, name, ours

    def __get__(self, value: object, kind: type) -> NoReturn:
        raise AttributeError(f"a {self.owner} has no attribute {self.name!r}; write {self.ours}")


def add_to(multivector: type, rotor: type) -> None:
    """Give both classes the names of other libraries."""
    for kind, title, names in ((multivector, "Multivector", _MULTIVECTOR), (rotor, "Rotor", _ROTOR)):
        for name, ours in names.items():
            if not hasattr(kind, name):
                setattr(kind, name, ForeignName(title, name, ours))


def listed(value: object) -> Iterable[str]:
    """Return the names for ``dir(value)``, without those of other libraries."""
    kinds = type(value).__mro__
    names = {name: member for kind in reversed(kinds) for name, member in vars(kind).items()}
    return sorted(name for name, member in names.items() if not isinstance(member, ForeignName))
