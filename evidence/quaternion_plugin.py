"""Pytest plugin: numpy-quaternion's tests find Polhode's rotors behind the names of its module."""

from __future__ import annotations

import sys

import numpy as np

import quaternion_adapter

sys.modules["quaternion"] = quaternion_adapter
# As the import of numpy-quaternion adds to NumPy.
np.quaternion = quaternion_adapter.quaternion
np.norm = np.frompyfunc(quaternion_adapter.quaternion.norm, 1, 1)
for _name in ("parity_conjugate", "x_parity_conjugate", "y_parity_conjugate", "z_parity_conjugate"):
    setattr(np, _name, quaternion_adapter.parity)
