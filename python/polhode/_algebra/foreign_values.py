"""Values of other libraries where a multivector is expected, and what to pass instead."""

from __future__ import annotations

from typing import Any

# Of arrays with labels, which no value can keep.
LABELLED = "a multivector does not combine with {}; pass its numbers, x.values"

_CONVERTED = {
    ("scipy", "Rotation"): "Rotor.from_scipy(x)",
    ("scipy", "RigidTransform"): "RigidTransform.from_scipy(x)",
    ("quaternion", "quaternion"): "Rotor.from_numpy_quaternion(x)",
}


def remedy_for(value: Any, of_transforms: str = "") -> str:
    """Return the end of an error for a value of another library, or a RigidTransform; empty for others.

    `of_transforms` is what to write for a RigidTransform.
    """
    library, name = _origin(value)
    ours = of_transforms if (library, name) == ("polhode", "RigidTransform") else ""
    ours = ours or _CONVERTED.get((library, name), "")
    return f"; write {ours}" if ours else ""


def is_foreign(value: Any) -> bool:
    """Whether a value of another library is not an array: a rotation or a quaternion."""
    return _origin(value) in _CONVERTED


def has_reflected(value: Any, method: str) -> bool:
    """Whether a class of a user or of an unknown library defines the operator with us at its left."""
    library, _ = _origin(value)
    known = library in ("builtins", "numpy", "polhode") or is_foreign(value)
    return not known and hasattr(type(value), method)


def refuse_operand(value: Any) -> None:
    """Raise a TypeError for an operand of another library that operators would misread or not explain."""
    library, name = _origin(value)
    if library in ("pandas", "xarray") and hasattr(value, "values"):
        raise TypeError(LABELLED.format(f"{library}.{name}"))
    if remedy := remedy_for(value):
        raise TypeError(f"a multivector does not combine with a {name} of {library}{remedy}")


def _origin(value: Any) -> tuple[str, str]:
    kind = type(value)
    return kind.__module__.partition(".")[0], kind.__name__
