"""Names that other libraries have at module level, and what to write instead."""

from __future__ import annotations

import sys
from collections.abc import Mapping

# Names of ours.
SEE = {
    **dict.fromkeys(("Cl", "Ga", "Layout"), "algebra"),
    "KeplerOrbit": "torque.KeplerOrbit",
    "MultiVector": "multivector",
    **dict.fromkeys(("Quaternion", "Rotation", "SO3", "UnitQuaternion"), "Rotor"),
    "RigidBody": "Body",
    "RotationSpline": "RotorSpline",
    **dict.fromkeys(("SE3", "UnitDualQuaternion"), "RigidTransform"),
    "Slerp": "slerp",
    "Twist3": "Screw",
    **dict.fromkeys(("animate", "film"), "view and Trajectory.film"),
    **dict.fromkeys(("plot", "show"), "Trajectory.plot and view"),
    "interpolate": "RotorSpline and slerp",
    **dict.fromkeys(("odeint", "propagate", "solve_ivp"), "simulate"),
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
_RPY = 'ph.Rotor.from_euler("xyz", angles)'
_TURN = "(ph.vector(x)).components"
_AXIS, _VECTOR = "ph.Rotor.from_axis_angle(v, theta)", "ph.Rotor.from_rotation_vector(v)"
_TO_WXYZ, _MATRIX, _TO_MATRIX = '.to_quaternion(order="wxyz")', "ph.Rotor.from_matrix(M)", ".to_matrix()"
_MOVED, _TO_MOVED = "ph.RigidTransform.from_matrix(H)", ".as_matrix()"

# Conversions of pytransform3d: ``matrix_from_quaternion`` and others.
_ROTATIONS = {
    "axis_angle": (_AXIS, ".to_rotation_vector()"),
    "compact_axis_angle": (_VECTOR, ".to_rotation_vector()"),
    "euler": ("ph.Rotor.from_euler(seq, angles)", ".to_euler(seq)"),
    "matrix": (_MATRIX, _TO_MATRIX),
    "mrp": ("ph.Rotor.from_mrp(v)", ".to_mrp()"),
    "quaternion": (_WXYZ, _TO_WXYZ),
    "rotor": ("R", ""),
}
_TRANSFORMS = {
    "dual_quaternion": (
        "ph.RigidTransform.from_dual_quat(D, scalar_first=True)",
        ".as_dual_quat(scalar_first=True)",
    ),
    "exponential_coordinates": ("ph.RigidTransform.from_exp_coords(xi)", ".as_exp_coords()"),
    "pq": (f"ph.RigidTransform({_WXYZ}, x)", ".as_components()"),
    "transform": (_MOVED, _TO_MOVED),
}

# Expressions, as of numpy-quaternion, clifford, pytransform3d, spatialmath, Basilisk and MATLAB.
WRITE = {
    **{
        f"{target}_from_{source}": start + end
        for table in (_ROTATIONS, _TRANSFORMS)
        for source, (start, _) in table.items()
        for target, (_, end) in table.items()
        if source != target
    },
    "e12": "ph.e1 ^ ph.e2",
    "e13": "ph.e1 ^ ph.e3",
    "e21": "ph.e2 ^ ph.e1",
    "e23": "ph.e2 ^ ph.e3",
    "e31": "ph.e3 ^ ph.e1",
    "e32": "ph.e3 ^ ph.e2",
    "e123": "ph.I",
    **dict.fromkeys(("ps", "pseudoscalar", "pss"), "ph.I"),
    **dict.fromkeys(("Bivector", "bivec"), "ph.bivector(v), with the components over e2e3, e3e1, e1e2"),
    **dict.fromkeys(("Vector", "np_to_euc_mv", "vec"), "ph.vector(x)"),
    "euc_mv_to_np": "a.components",
    **dict.fromkeys(("geometric_product", "gp"), "A * B"),
    **dict.fromkeys(("inner", "ip"), "A.dot(B)"),
    **dict.fromkeys(("op", "outer"), "A.wedge(B)"),
    **dict.fromkeys(("apply_rotor", "rotate", "rotor_apply", "sandwich"), "R(a)"),
    **dict.fromkeys(("angle", "angle_between_vectors"), "ph.Rotor.from_vectors(a, b).angle"),
    "euc_cross_prod": "ph.cross(a, b)",
    "blades": "ph.algebra(3).blades",
    "layout": "ph.algebra(3)",
    "MVArray": "ph.stack([A, B])",
    "randomMV": "ph.algebra(3).random()",
    "conformalize": "ph.cga(3)",
    "up": "ph.cga(3).up(x)",
    "down": "ph.cga(3).down(P)",
    "log_rotor": "R.log()",
    **dict.fromkeys(("orthoFrames2Versor", "orthoMat2Versor", "rotation_matrix_to_rotor"), _MATRIX),
    "rotor_to_rotation_matrix": f"R{_TO_MATRIX}",
    "quaternion_to_rotor": _WXYZ,
    "rotor_to_quaternion": f"R{_TO_WXYZ}",
    **dict.fromkeys(
        ("generate_rotation_rotor", "rotor", "rotor_from_plane_angle"), "ph.Rotor.from_plane_angle(B, theta)"
    ),
    **dict.fromkeys(("rotor_from_two_directions", "rotor_vector_to_vector"), "ph.Rotor.from_vectors(a, b)"),
    **dict.fromkeys(("rotor_align_vecs", "optimal_alignment_in_Euclidean_metric"), "ph.align(a, b)"),
    **dict.fromkeys(("random_rotation_rotor", "random_quaternion"), "ph.Rotor.random()"),
    "random_matrix": f"ph.Rotor.random(){_TO_MATRIX}",
    "SO2": "ph.Rotor.from_axis_angle(ph.e3, theta)",
    "SE2": "ph.RigidTransform(ph.Rotor.from_axis_angle(ph.e3, theta), x)",
    "normalize": "A.normalized()",
    **dict.fromkeys(("Motor", "motor"), "ph.RigidTransform(R, x), or ph.pga(3).motor(R, x)"),
    **dict.fromkeys(("as_quat_array", "from_float_array", "quaternion"), _WXYZ),
    "one": "ph.Rotor.identity()",
    "as_euler_angles": 'R.to_euler("ZYZ")',
    "as_spherical_coords": 'R.to_euler("ZYZ")[..., 1::-1]',
    "from_spherical_coords": 'ph.Rotor.from_euler("ZY", [phi, theta])',
    "as_vector_part": f"R{_TO_WXYZ}[..., 1:]",
    **dict.fromkeys(("quaternion_dist", "rotation_intrinsic_distance"), "R.distance(S)"),
    "rotor_intrinsic_distance": "2 * (~R * S).log().norm()",
    "rotor_chordal_distance": "(R - S).norm()",
    "mean_rotor_in_chordal_metric": "ph.mean([R, S])",
    "unflip_rotors": "ph.stack([R, S]).continuous()",
    **dict.fromkeys(("quaternion_slerp", "rotor_slerp", "slerp_evaluate", "qslerp"), "ph.slerp(R, S, t)"),
    "average": "ph.mean([R, S])",
    **dict.fromkeys(("dcm", "from_dcm"), f"{_MATRIX}, or R.to_matrix()"),
    **dict.fromkeys(("euler", "from_euler"), f'{_ZYX}, or R.to_euler("ZYX")'),
    "squad": "ph.RotorSpline(times, [R, S])(t)",
    "angular_velocity": "ph.RotorSpline(times, [R, S]).omega_body(t)",
    **dict.fromkeys(
        ("integrate_angular_velocity", "quaternion_integrate"), "ph.attitude_from_rates(times, omega)"
    ),
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
    **dict.fromkeys(
        ("concatenate_quaternions", "concatenate_rotors", "qmult", "qqmul", "quatmultiply"), "R * S"
    ),
    **dict.fromkeys(
        ("q_conj", "qconj", "qconjugate", "qinverse", "quatconj", "quatinv", "rotor_reverse"), "~R"
    ),
    **dict.fromkeys(("q_prod_vector", "qvmul"), f"R{_TURN}"),
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
    **dict.fromkeys(("active_matrix_from_extrinsic_roll_pitch_yaw", "rpy2r"), f"{_RPY}{_TO_MATRIX}"),
    "tr2rpy": f'{_MATRIX}.to_euler("xyz")',
    "eul2r": 'ph.Rotor.from_euler("ZYZ", angles).to_matrix()',
    "tr2eul": f'{_MATRIX}.to_euler("ZYZ")',
    "angvec2r": f"{_AXIS}{_TO_MATRIX}",
    "tr2angvec": f"{_MATRIX}.to_rotation_vector()",
    "q2r": f"{_WXYZ}{_TO_MATRIX}",
    "r2q": f"{_MATRIX}{_TO_WXYZ}",
    "cross_product_matrix": "ph.from_axial(v), as a matrix np.cross(np.eye(3), v)",
    "transl": f"ph.RigidTransform.from_translation(x){_TO_MOVED}",
    **dict.fromkeys(("rt2tr", "transform_from"), f"ph.RigidTransform(R, x){_TO_MOVED}"),
    **dict.fromkeys(("invert_transform", "trinv"), "T.inverse()"),
    **dict.fromkeys(("adjoint_from_transform", "tr2adjoint"), "T.adjoint(), the rotation first"),
    "trexp": "ph.RigidTransform.from_exp_coords(xi), the rotation vector first",
    "trlog": "T.as_exp_coords(), the rotation vector first",
    # Basilisk's matrices turn components from space to the body: the transposes of ours.
    "MRP2C": "ph.Rotor.from_mrp(v).to_matrix().T",
    "C2MRP": "ph.Rotor.from_matrix(M.T).to_mrp()",
    "EP2C": f"{_WXYZ}.to_matrix().T",
    "C2EP": f"ph.Rotor.from_matrix(M.T){_TO_WXYZ}",
    "PRV2C": f"{_VECTOR}.to_matrix().T",
    "C2PRV": "ph.Rotor.from_matrix(M.T).to_rotation_vector()",
    "euler3212C": f"{_ZYX}.to_matrix().T",
    "C2Euler321": 'ph.Rotor.from_matrix(M.T).to_euler("ZYX")',
    "MRP2Euler321": 'ph.Rotor.from_mrp(v).to_euler("ZYX")',
    "rotx": "ph.Rotor.from_axis_angle(ph.e1, theta).to_matrix()",
    "roty": "ph.Rotor.from_axis_angle(ph.e2, theta).to_matrix()",
    "rotz": "ph.Rotor.from_axis_angle(ph.e3, theta).to_matrix()",
}


def missing_law(module: str, name: str, laws: Mapping[str, str]) -> AttributeError:
    """Return the error for a name that the module of torques or that of forces does not have."""
    remedy = f"; write ph.{laws[name]}" if name in laws else f"; the laws are listed by dir(ph.{module})"
    return AttributeError(f"module 'polhode.{module}' has no attribute {name!r}{remedy}")


def missing(name: str) -> Exception:
    """Return the error for a name that the package does not have."""
    remedy = f"see polhode.{SEE[name]}" if name in SEE else f"write {WRITE[name]}" if name in WRITE else ""
    # Of ``from polhode import name`` Python shows no AttributeError; its frame asks for the name first.
    importing = sys._getframe(2).f_globals.get("__name__") == "importlib._bootstrap"
    if remedy and importing:
        return ImportError(f"cannot import name {name!r} from 'polhode'; {remedy}", name="polhode")
    return AttributeError(f"module 'polhode' has no attribute {name!r}{remedy and f'; {remedy}'}")
