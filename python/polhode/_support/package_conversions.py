"""Conversions of other libraries: functions such as ``matrix_from_quaternion``, and what to write instead."""

from __future__ import annotations

from itertools import permutations
from typing import NamedTuple

WXYZ, TO_WXYZ = 'ph.Rotor.from_quaternion(q, order="wxyz")', '.to_quaternion(order="wxyz")'
XYZW, TO_XYZW = 'ph.Rotor.from_quaternion(q, order="xyzw")', '.to_quaternion(order="xyzw")'
AXIS, VECTOR = "ph.Rotor.from_axis_angle(v, theta)", "ph.Rotor.from_rotation_vector(v)"
MATRIX, TO_MATRIX, TO_VECTOR = "ph.Rotor.from_matrix(M)", ".to_matrix()", ".to_rotation_vector()"
MOVED, TO_MOVED = "ph.RigidTransform.from_matrix(H)", ".as_matrix()"
RPY = 'ph.Rotor.from_euler("xyz", angles)'

# Of Euler angles, about three axes or two.
SEQUENCES = ["".join(x) for x in permutations("xyz")] + [f"{i}{j}{i}" for i, j in permutations("xyz", 2)]


class Form(NamedTuple):
    """Numbers of a rotation or of a displacement: what reads them, and what writes them."""

    read: str
    write: str


# As in pytransform3d, for one and for many: ``matrix_from_quaternion``, ``matrices_from_quaternions``.
_ROTATIONS = {
    ("axis_angle", "axis_angles"): Form(AXIS, TO_VECTOR),
    ("compact_axis_angle", "compact_axis_angles"): Form(VECTOR, TO_VECTOR),
    ("euler", ""): Form("ph.Rotor.from_euler(seq, angles)", ".to_euler(seq)"),
    ("matrix", "matrices"): Form(MATRIX, TO_MATRIX),
    ("mrp", ""): Form("ph.Rotor.from_mrp(v)", ".to_mrp()"),
    ("quaternion", "quaternions"): Form(WXYZ, TO_WXYZ),
    ("rotor", ""): Form("R", ""),
}
_SCREWS = "exponential_coordinates"
_TRANSFORMS = {
    ("dual_quaternion", "dual_quaternions"): Form(
        "ph.RigidTransform.from_dual_quat(D, scalar_first=True)", ".as_dual_quat(scalar_first=True)"
    ),
    (_SCREWS, _SCREWS): Form("ph.RigidTransform.from_exp_coords(xi)", ".as_exp_coords()"),
    ("pq", "pqs"): Form(f"ph.RigidTransform({WXYZ}, x)", ".as_components()"),
    ("transform", "transforms"): Form(MOVED, TO_MOVED),
}

# As in RoMa: ``rotvec_to_unitquat``.
_ROMA = {
    "euler": Form("ph.Rotor.from_euler(seq, angles)", ".to_euler(seq)"),
    "rotmat": Form(MATRIX, TO_MATRIX),
    "rotvec": Form(VECTOR, TO_VECTOR),
    "unitquat": Form(XYZW, TO_XYZW),
}

# As in transforms3d, Basilisk, AHRS and others: ``quat2mat``, ``rpy2q``.
_SHORT = {
    "axang": Form(AXIS, TO_VECTOR),
    "axangle": Form(AXIS, TO_VECTOR),
    "dcm": Form(MATRIX, TO_MATRIX),
    "euler": Form(RPY, '.to_euler("xyz")'),
    "mat": Form(MATRIX, TO_MATRIX),
    "q": Form(WXYZ, TO_WXYZ),
    "quat": Form(WXYZ, TO_WXYZ),
    "R": Form(MATRIX, TO_MATRIX),
    "rpy": Form(RPY, '.to_euler("xyz")'),
}

# As in PyTorch3D, Kornia and others: ``quaternion_to_matrix``, with Euler angles about the axes of the body.
_WORDS = {
    **dict.fromkeys(("axis_angle", "rotation_vector"), Form(VECTOR, TO_VECTOR)),
    **dict.fromkeys(("euler", "euler_angles"), Form("ph.Rotor.from_euler(seq, angles)", ".to_euler(seq)")),
    **dict.fromkeys(("matrix", "rotation_matrix"), Form(MATRIX, TO_MATRIX)),
    "quaternion": Form(WXYZ, TO_WXYZ),
    "rpy": Form(RPY, '.to_euler("xyz")'),
}

CONVERSIONS = {
    **{f"{a}_to_{b}": x.read + y.write for a, x in _WORDS.items() for b, y in _WORDS.items() if x != y},
    **{f"{a}2{b}": x.read + y.write for a, x in _SHORT.items() for b, y in _SHORT.items() if x != y},
    **{f"{a}_to_{b}": x.read + y.write for a, x in _ROMA.items() for b, y in _ROMA.items() if a != b},
    **{
        f"{b[many]}_from_{a[many]}": x.read + y.write
        for table in (_ROTATIONS, _TRANSFORMS)
        for many in (0, 1)
        for a, x in table.items()
        for b, y in table.items()
        if a != b and a[many] and b[many]
    },
    **{
        f"active_matrix_from_{kind}_euler_{x}": f'ph.Rotor.from_euler("{axes}", angles).to_matrix()'
        for x in SEQUENCES
        for kind, axes in (("intrinsic", x.upper()), ("extrinsic", x))
    },
    **{
        f"{kind}_euler_{x}_from_active_matrix": f'{MATRIX}.to_euler("{axes}")'
        for x in SEQUENCES
        for kind, axes in (("intrinsic", x.upper()), ("extrinsic", x))
    },
    "active_matrices_from_intrinsic_euler_angles": 'ph.Rotor.from_euler("ZYX", angles).to_matrix()',
    "active_matrices_from_extrinsic_euler_angles": 'ph.Rotor.from_euler("zyx", angles).to_matrix()',
    **dict.fromkeys(
        ("quaternion_xyzw_from_wxyz", "batch_quaternion_xyzw_from_wxyz", "quat_wxyz_to_xyzw"), WXYZ + TO_XYZW
    ),
    **dict.fromkeys(
        ("quaternion_wxyz_from_xyzw", "batch_quaternion_wxyz_from_xyzw", "quat_xyzw_to_wxyz"), XYZW + TO_WXYZ
    ),
}
