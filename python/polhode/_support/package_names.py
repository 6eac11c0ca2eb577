"""Names that other libraries have at module level, and what to write instead."""

from __future__ import annotations

import sys

# Names of ours.
SEE = {
    **dict.fromkeys(("Cl", "Ga", "Layout"), "algebra"),
    "KeplerOrbit": "torque.KeplerOrbit",
    "MultiVector": "multivector",
    **dict.fromkeys(("Quaternion", "Rotation", "SO3"), "Rotor"),
    "RigidBody": "Body",
    "RotationSpline": "RotorSpline",
    "SE3": "RigidTransform",
    "Slerp": "slerp",
    **dict.fromkeys(("load", "read"), "io.read, Trajectory.read and Scene.read"),
    **{
        name: f"Multivector.{name}"
        for name in (
            *("commutator", "dot", "dual", "exp", "grade", "inverse", "log", "norm", "project", "reverse"),
            *("sqrt", "wedge"),
        )
    },
}

_WXYZ = 'ph.Rotor.from_quaternion(q, order="wxyz")'
_ZYX = 'ph.Rotor.from_euler("ZYX", angles)'
_TURN = "(ph.vector(x)).components"

# Expressions, as of numpy-quaternion, transforms3d, Pinocchio and MATLAB.
WRITE = {
    "e12": "ph.e1 ^ ph.e2",
    "e13": "ph.e1 ^ ph.e3",
    "e21": "ph.e2 ^ ph.e1",
    "e23": "ph.e2 ^ ph.e3",
    "e31": "ph.e3 ^ ph.e1",
    "e32": "ph.e3 ^ ph.e2",
    "e123": "ph.I",
    "normalize": "A.normalized()",
    "rotor": "ph.Rotor.from_plane_angle(B, theta)",
    **dict.fromkeys(("Motor", "motor"), "ph.RigidTransform(R, x), or ph.pga(3).motor(R, x)"),
    **dict.fromkeys(("as_quat_array", "from_float_array", "quaternion"), _WXYZ),
    "as_euler_angles": 'R.to_euler("ZYZ")',
    "as_float_array": 'R.to_quaternion(order="wxyz")',
    "as_rotation_matrix": "R.to_matrix()",
    "as_rotation_vector": "R.to_rotation_vector()",
    "from_euler_angles": 'ph.Rotor.from_euler("ZYZ", angles)',
    "from_rotation_matrix": "ph.Rotor.from_matrix(M)",
    "from_rotation_vector": "ph.Rotor.from_rotation_vector(v)",
    **dict.fromkeys(("rotate_vector", "rotate_vectors"), f"R{_TURN}"),
    **dict.fromkeys(("hat", "skew"), "ph.from_axial(v), as a matrix np.cross(np.eye(3), v)"),
    "exp3": "ph.Rotor.from_rotation_vector(v)",
    "log3": "R.to_rotation_vector()",
    "exp6": "ph.RigidTransform.from_exp_coords(xi), the rotation vector first",
    "log6": "T.as_exp_coords(), the rotation vector first",
    **dict.fromkeys(("qmult", "quatmultiply"), "R * S"),
    **dict.fromkeys(("qconjugate", "qinverse", "quatconj", "quatinv"), "~R"),
    "quatrotate": f"(~R){_TURN}, as MATLAB turns the frame",
    "angle2quat": f'{_ZYX}.to_quaternion(order="wxyz")',
    "eul2quat": f'{_ZYX}.to_quaternion(order="wxyz")',
    "eul2rotm": f"{_ZYX}.to_matrix()",
    "quat2eul": f'{_WXYZ}.to_euler("ZYX")',
    "rotm2eul": 'ph.Rotor.from_matrix(M).to_euler("ZYX")',
    "euler2mat": 'ph.Rotor.from_euler("xyz", angles).to_matrix()',
    "mat2euler": 'ph.Rotor.from_matrix(M).to_euler("xyz")',
    **dict.fromkeys(("quat2mat", "quat2rotm"), f"{_WXYZ}.to_matrix()"),
    **dict.fromkeys(("mat2quat", "rotm2quat"), 'ph.Rotor.from_matrix(M).to_quaternion(order="wxyz")'),
    **dict.fromkeys(("axangle2mat", "axang2rotm"), "ph.Rotor.from_axis_angle(v, theta).to_matrix()"),
    "rotx": "ph.Rotor.from_axis_angle(ph.e1, theta).to_matrix()",
    "roty": "ph.Rotor.from_axis_angle(ph.e2, theta).to_matrix()",
    "rotz": "ph.Rotor.from_axis_angle(ph.e3, theta).to_matrix()",
}


def missing(name: str) -> Exception:
    """Return the error for a name that the package does not have."""
    remedy = f"see polhode.{SEE[name]}" if name in SEE else f"write {WRITE[name]}" if name in WRITE else ""
    # Of ``from polhode import name`` Python shows no AttributeError; its frame asks for the name first.
    importing = sys._getframe(2).f_globals.get("__name__") == "importlib._bootstrap"
    if remedy and importing:
        return ImportError(f"cannot import name {name!r} from 'polhode'; {remedy}", name="polhode")
    return AttributeError(f"module 'polhode' has no attribute {name!r}{remedy and f'; {remedy}'}")
