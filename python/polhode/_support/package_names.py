"""Names that other libraries have at module level, and what to write instead."""

from __future__ import annotations

import sys
from collections.abc import Mapping

from polhode._support.package_conversions import (
    AXIS,
    CONVERSIONS,
    MATRIX,
    RPY,
    TO_MATRIX,
    TO_MOVED,
    TO_WXYZ,
    VECTOR,
    WXYZ,
)
from polhode._support.package_functions import FUNCTIONS

# Names of ours.
SEE = {
    **dict.fromkeys(("Cl", "Ga", "Layout"), "algebra"),
    "KeplerOrbit": "torque.KeplerOrbit",
    **dict.fromkeys(("MultiVector", "Mv"), "multivector"),
    **dict.fromkeys(
        (
            "DCM",
            "Quaternion",
            "QuaternionArray",
            "QuaternionicArray",
            "ReferenceFrame",
            "Rot3",
            "Rotation",
            "RotationMatrix",
        ),
        "Rotor",
    ),
    **dict.fromkeys(("SO3", "UnitQuaternion"), "Rotor"),
    "RigidBody": "Body",
    "SpatialInertia": "Inertia",
    "RotationSpline": "RotorSpline",
    **dict.fromkeys(
        (
            *("DualQuaternion", "Isometry", "Pose", "Pose3", "RigidUnitQuat", "SE3", "Transform"),
            *("Transform3d", "UnitDualQuaternion"),
        ),
        "RigidTransform",
    ),
    "Twist3": "Screw",
    **dict.fromkeys(("animate", "film"), "view and Trajectory.film"),
    **dict.fromkeys(("plot", "show"), "Trajectory.plot and view"),
    "herpolhode": "FreeMotion.herpolhode",
    "interpolate": "RotorSpline and slerp",
    "polhode": "FreeMotion.polhode",
    **dict.fromkeys(("ReactionWheel", "ReactionWheels"), "torque.reaction_wheels"),
    **dict.fromkeys(("odeint", "propagate", "solve_ivp"), "simulate"),
    **dict.fromkeys(("load", "read"), "io.read, Trajectory.read and Scene.read"),
    **{
        name: f"Multivector.{name}"
        for name in (
            *("commutator", "dot", "dual", "exp", "grade", "inverse", "log", "norm", "project", "reverse"),
            *("sqrt", "undual", "wedge"),
        )
    },
}

_ZYX = 'ph.Rotor.from_euler("ZYX", angles)'
_TURN = "(ph.vector(x)).components"
_HAT = "ph.from_axial(v), as a matrix np.cross(np.eye(3), v)"
_ROTATED = "ph.RigidTransform.from_rotation"
_DERIVATIVE = "R * ph.bivector(v) / -2, with v the angular velocity in body axes"

# Of rotations and transforms, as of pytransform3d, RoMa, spatialmath, AHRS and transforms3d.
_OF_ROTATIONS = {
    **{
        f"{kind}_matrix_from_angle": f"{value}.to_matrix()"
        for kind, value in (
            ("active", "ph.Rotor.from_axis_angle(ph.e3, theta)"),
            ("passive", "(~ph.Rotor.from_axis_angle(ph.e3, theta))"),
        )
    },
    "quaternion_from_angle": f"ph.Rotor.from_axis_angle(ph.e3, theta){TO_WXYZ}",
    "quaternion_from_extrinsic_euler_xyz": f"{RPY}{TO_WXYZ}",
    **dict.fromkeys(
        ("norm_vector", "norm_vectors", "normalized_vector", "unit_vector", "unitvec"), "a.normalized()"
    ),
    "vector_projection": "a.project(b)",
    "perpendicular_to_vectors": "ph.cross(a, b)",
    "plane_normal_from_bivector": "B.dual()",
    **dict.fromkeys(("angdiff", "angle_wrap", "norm_angle", "wrap_mpi_pi"), "np.angle(np.exp(1j * theta))"),
    "angles_between_vectors": "ph.Rotor.from_vectors(a, b).angle",
    "axis_angle_from_two_directions": "ph.Rotor.from_vectors(a, b).to_rotation_vector()",
    **dict.fromkeys(
        ("norm_matrix", "procrustes", "robust_polar_decomposition", "special_procrustes"),
        "ph.Rotor.from_matrix(M, nearest=True).to_matrix()",
    ),
    **dict.fromkeys(("chiaverini", "hughes", "itzhack", "sarabandi", "shepperd"), f"{MATRIX}{TO_WXYZ}"),
    **dict.fromkeys(("axis_angle_slerp", "rotvec_slerp"), "ph.slerp(R, S, t).to_rotation_vector()"),
    **dict.fromkeys(("matrix_slerp", "rotmat_slerp"), "ph.slerp(R, S, t).to_matrix()"),
    **dict.fromkeys(("lerp", "nlerp", "quaternion_slerp_batch", "unitquat_slerp"), "ph.slerp(R, S, t)"),
    "Slerp": (
        "ph.slerp(R, S, t) of two rotors, at a fraction of the way, or ph.RotorSpline(times, [R, S])(t) of "
        "rotors at times"
    ),
    "matrix_power": "(R ** t).to_matrix()",
    "qpow": "R ** t",
    "concatenate_mrp": "(R * S).to_mrp()",
    **dict.fromkeys(
        ("batch_concatenate_quaternions", "q_prod", "quat_composition", "quat_product", "rotvec_composition"),
        "R * S",
    ),
    **dict.fromkeys(("batch_q_conj", "quat_conjugation", "quat_inverse", "rotvec_inverse"), "~R"),
    **dict.fromkeys(("mrp_prod_vector", "q_rot", "quat_action"), f"R{_TURN}"),
    "quaternion_double": "-R",
    "swing_twist_decomposition": (
        "ph.Rotor.from_multivector((R.grade(0) + R.grade(2).project(B)).normalized()), the twist"
    ),
    "allclose": "A.is_close(B, rtol, atol)",
    "squad_evaluate": "ph.RotorSpline(times, [R, S])(t)",
    "rotation_chordal_distance": "np.minimum((R - S).norm(), (R + S).norm())",
    "quaternion_diff": "(R * ~S).to_rotation_vector()",
    "quaternion_gradient": "ph.rates_from_attitude(times, [R, S])",
    **dict.fromkeys(("derivative", "qdotb"), _DERIVATIVE),
    "qdot": "ph.bivector(v) * R / -2, with v the angular velocity in space axes",
    **dict.fromkeys(
        ("pick_closest_quaternion", "smooth_quaternion_trajectory"), "ph.stack([R, S]).continuous()"
    ),
    **dict.fromkeys(
        ("angular_distance", "qad", "qangle", "rotmat_geodesic_distance", "unitquat_geodesic_distance"),
        "R.distance(S)",
    ),
    **dict.fromkeys(("geodesic_distance", "rotvec_geodesic_distance"), "R.distance(S)"),
    **dict.fromkeys(("q_random", "qrand", "random_unitquat"), "ph.Rotor.random()"),
    "random_rotmat": "ph.Rotor.random().to_matrix()",
    **dict.fromkeys(
        ("random_axis_angle", "random_compact_axis_angle", "random_rotvec"),
        "ph.Rotor.random().to_rotation_vector()",
    ),
    **dict.fromkeys(
        ("look_at", "look_rotation"),
        "ph.align([ph.e3, ph.e2], [a, b], weights=[np.inf, 1]).rotor, with e3 along a and e2 towards b",
    ),
    "rotation_matrix_align_vecs": "ph.align(a, b).rotor.to_matrix()",
    "rigid_vectors_registration": "ph.align(a, b).rotor",
    "align_vectors": "ph.align(a, b), which takes the target last",
    **dict.fromkeys(("davenport", "kabsch", "quest", "wahba"), "ph.align(a, b)"),
    "average_quaternions": "ph.mean([R, S])",
    "inertia": "ph.Inertia.from_matrix(M)",
}
_OF_TRANSFORMS = {
    "rplus": "T * ph.RigidTransform.exp(xi)",
    "rminus": "(U.inverse() * T).log()",
    "transform": "T.apply(x)",
    **dict.fromkeys(("batch_dq_prod_vector", "dq_prod_vector"), "T.apply(x)"),
    **dict.fromkeys(
        (
            *("batch_concatenate_dual_quaternions", "concat", "concat_many_to_many", "concat_many_to_one"),
            *("concat_one_to_many", "concatenate_dual_quaternions"),
        ),
        "U * T, which moves by T first",
    ),
    **dict.fromkeys(("batch_dq_conj", "dq_conj", "invert_transforms"), "T.inverse()"),
    **dict.fromkeys(("dual_quaternion_power", "dual_quaternions_power", "transform_power"), "T ** t"),
    **dict.fromkeys(
        ("dual_quaternion_sclerp", "dual_quaternions_sclerp", "transform_sclerp"), "U.interpolate(T, t)"
    ),
    "pq_slerp": "ph.RigidTransform(ph.slerp(R, S, t), (1 - t) * a + t * b)",
    **{
        f"screw_parameters_from_{name}": "T.screw_parameters()"
        for name in ("dual_quaternion", "dual_quaternions", "screw_axis", "transform")
    },
    "random_transform": "ph.RigidTransform(ph.Rotor.random(), x)",
}

# Expressions, as of numpy-quaternion, clifford, pytransform3d, spatialmath, Basilisk and MATLAB.
WRITE = {
    **CONVERSIONS,
    **FUNCTIONS,
    **_OF_ROTATIONS,
    **_OF_TRANSFORMS,
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
    **dict.fromkeys(("angle", "angle_between", "angle_between_vectors"), "ph.Rotor.from_vectors(a, b).angle"),
    "euc_cross_prod": "ph.cross(a, b)",
    "blades": "ph.algebra(3).blades",
    "layout": "ph.algebra(3)",
    **dict.fromkeys(("MVArray", "array"), "ph.stack([A, B])"),
    "randomMV": "ph.algebra(3).random()",
    **dict.fromkeys(("bases", "basis_vectors"), "ph.algebra(3).basis_vectors"),
    "general_exp": "A.exp()",
    "grades_present": "A.grades",
    "I3": "ph.I",
    **dict.fromkeys(("einf", "ninf"), "ph.cga(3).einf"),
    **dict.fromkeys(("eo", "no"), "ph.cga(3).eo"),
    "conformalize": "ph.cga(3)",
    "up": "ph.cga(3).up(x)",
    "down": "ph.cga(3).down(P)",
    "log_rotor": "R.log()",
    **dict.fromkeys(("orthoFrames2Versor", "orthoMat2Versor", "rotation_matrix_to_rotor"), MATRIX),
    "rotor_to_rotation_matrix": f"R{TO_MATRIX}",
    "quaternion_to_rotor": WXYZ,
    "rotor_to_quaternion": f"R{TO_WXYZ}",
    **dict.fromkeys(
        ("generate_rotation_rotor", "rotor", "rotor_from_plane_angle"), "ph.Rotor.from_plane_angle(B, theta)"
    ),
    **dict.fromkeys(("rotor_from_two_directions", "rotor_vector_to_vector"), "ph.Rotor.from_vectors(a, b)"),
    **dict.fromkeys(("rotor_align_vecs", "optimal_alignment_in_Euclidean_metric"), "ph.align(a, b)"),
    **dict.fromkeys(("random_rotation_rotor", "random_quaternion"), "ph.Rotor.random()"),
    "random_matrix": f"ph.Rotor.random(){TO_MATRIX}",
    "SO2": "ph.Rotor.from_axis_angle(ph.e3, theta)",
    "SE2": "ph.RigidTransform(ph.Rotor.from_axis_angle(ph.e3, theta), x)",
    "normalize": "A.normalized()",
    **dict.fromkeys(("Motor", "motor"), "ph.RigidTransform(R, x), or ph.pga(3).motor(R, x)"),
    **dict.fromkeys(("as_quat_array", "from_float_array", "quaternion"), WXYZ),
    "one": "ph.Rotor.identity()",
    "as_euler_angles": 'R.to_euler("ZYZ")',
    "as_spherical_coords": 'R.to_euler("ZYZ")[..., 1::-1]',
    "from_spherical_coords": 'ph.Rotor.from_euler("ZY", [phi, theta])',
    "as_vector_part": f"R{TO_WXYZ}[..., 1:]",
    **dict.fromkeys(("quaternion_dist", "rotation_intrinsic_distance"), "R.distance(S)"),
    "rotor_intrinsic_distance": "2 * (~R * S).log().norm()",
    "rotor_chordal_distance": "(R - S).norm()",
    "mean_rotor_in_chordal_metric": "ph.mean([R, S])",
    "unflip_rotors": "ph.stack([R, S]).continuous()",
    **dict.fromkeys(("quaternion_slerp", "rotor_slerp", "slerp_evaluate", "qslerp"), "ph.slerp(R, S, t)"),
    "average": "ph.mean([R, S])",
    **dict.fromkeys(("dcm", "from_dcm"), f"{MATRIX}, or R.to_matrix()"),
    **dict.fromkeys(("euler", "from_euler"), f'{_ZYX}, or R.to_euler("ZYX")'),
    "squad": "ph.RotorSpline(times, [R, S])(t)",
    "angular_velocity": "ph.RotorSpline(times, [R, S]).omega_body(t)",
    **dict.fromkeys(
        ("integrate_angular_velocity", "quaternion_integrate"), "ph.attitude_from_rates(times, omega)"
    ),
    "as_spinor_array": "ph.to_pauli(R)",
    "as_float_array": 'R.to_quaternion(order="wxyz")',
    "as_rotation_matrix": "R.to_matrix()",
    "as_rotation_vector": "R.to_rotation_vector()",
    "from_euler_angles": 'ph.Rotor.from_euler("ZYZ", angles)',
    "from_rotation_matrix": "ph.Rotor.from_matrix(M)",
    "from_rotation_vector": "ph.Rotor.from_rotation_vector(v)",
    **dict.fromkeys(("rotate_vector", "rotate_vectors"), f"R{_TURN}"),
    **dict.fromkeys(
        ("cross_product_matrices", "cross_product_matrix", "hat", "rot_log_from_compact_axis_angle", "skew"),
        _HAT,
    ),
    **dict.fromkeys(("unhat", "unskew", "vee", "vex"), "M[[2, 0, 1], [1, 2, 0]]"),
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
    "quat2eul": f'{WXYZ}.to_euler("ZYX")',
    "rotm2eul": 'ph.Rotor.from_matrix(M).to_euler("ZYX")',
    "euler2mat": 'ph.Rotor.from_euler("xyz", angles).to_matrix()',
    "mat2euler": 'ph.Rotor.from_matrix(M).to_euler("xyz")',
    **dict.fromkeys(("quat2mat", "quat2rotm"), f"{WXYZ}.to_matrix()"),
    **dict.fromkeys(("mat2quat", "rotm2quat"), 'ph.Rotor.from_matrix(M).to_quaternion(order="wxyz")'),
    **dict.fromkeys(("axangle2mat", "axang2rotm"), "ph.Rotor.from_axis_angle(v, theta).to_matrix()"),
    **dict.fromkeys(("active_matrix_from_extrinsic_roll_pitch_yaw", "rpy2r"), f"{RPY}{TO_MATRIX}"),
    "tr2rpy": f'{MATRIX}.to_euler("xyz")',
    "eul2r": 'ph.Rotor.from_euler("ZYZ", angles).to_matrix()',
    "tr2eul": f'{MATRIX}.to_euler("ZYZ")',
    "angvec2r": f"{AXIS}{TO_MATRIX}",
    "tr2angvec": f"{MATRIX}.to_rotation_vector()",
    "q2r": f"{WXYZ}{TO_MATRIX}",
    "r2q": f"{MATRIX}{TO_WXYZ}",
    "transl": f"ph.RigidTransform.from_translation(x){TO_MOVED}",
    **dict.fromkeys(("rt2tr", "transform_from"), f"ph.RigidTransform(R, x){TO_MOVED}"),
    **dict.fromkeys(("invert_transform", "trinv"), "T.inverse()"),
    **dict.fromkeys(("adjoint_from_transform", "tr2adjoint"), "T.adjoint(), the rotation first"),
    "trexp": "ph.RigidTransform.from_exp_coords(xi), the rotation vector first",
    "trlog": "T.as_exp_coords(), the rotation vector first",
    "trnorm": f"ph.RigidTransform.from_matrix(H, nearest=True){TO_MOVED}",
    "trinterp": (
        "ph.RigidTransform(ph.slerp(U.rotor, T.rotor, t), (1 - t) * U.translation + t * T.translation)"
        f"{TO_MOVED}"
    ),
    **dict.fromkeys(("rotation_matrix", "t2r"), "T.rotor.to_matrix()"),
    "r2t": f"{_ROTATED}({MATRIX}){TO_MOVED}",
    "tr2rt": "T.as_components()",
    "homtrans": "T.apply(x)",
    "rpy2tr": f"{_ROTATED}({RPY}){TO_MOVED}",
    "eul2tr": f'{_ROTATED}(ph.Rotor.from_euler("ZYZ", angles)){TO_MOVED}',
    "angvec2tr": f"{_ROTATED}({AXIS}){TO_MOVED}",
    **{
        f"trot{name}": f"{_ROTATED}(ph.Rotor.from_axis_angle(ph.e{axis}, theta)){TO_MOVED}"
        for axis, name in ((1, "x"), (2, "y"), (3, "z"))
    },
    **dict.fromkeys(("exp2r", "rodrigues"), f"{VECTOR}{TO_MATRIX}"),
    # Basilisk's matrices turn components from space to the body: the transposes of ours.
    "MRP2C": "ph.Rotor.from_mrp(v).to_matrix().T",
    "C2MRP": "ph.Rotor.from_matrix(M.T).to_mrp()",
    "EP2C": f"{WXYZ}.to_matrix().T",
    "C2EP": f"ph.Rotor.from_matrix(M.T){TO_WXYZ}",
    "PRV2C": f"{VECTOR}.to_matrix().T",
    "C2PRV": "ph.Rotor.from_matrix(M.T).to_rotation_vector()",
    "euler3212C": f"{_ZYX}.to_matrix().T",
    "C2Euler321": 'ph.Rotor.from_matrix(M.T).to_euler("ZYX")',
    "MRP2Euler321": 'ph.Rotor.from_mrp(v).to_euler("ZYX")',
    "rotx": "ph.Rotor.from_axis_angle(ph.e1, theta).to_matrix()",
    "roty": "ph.Rotor.from_axis_angle(ph.e2, theta).to_matrix()",
    "rotz": "ph.Rotor.from_axis_angle(ph.e3, theta).to_matrix()",
    **dict.fromkeys(
        ("Jexp3", "exp2jac", "left_jacobian_SO3", "left_jacobian_SO3_series"), "ph.left_jacobian(v)"
    ),
    **dict.fromkeys(("Jexp6", "left_jacobian_SE3", "left_jacobian_SE3_series"), "ph.left_jacobian(xi)"),
    **dict.fromkeys(
        ("left_jacobian_SO3_inv", "left_jacobian_SO3_inv_series"), "ph.left_jacobian(v, inverse=True)"
    ),
    **dict.fromkeys(
        ("left_jacobian_SE3_inv", "left_jacobian_SE3_inv_series"), "ph.left_jacobian(xi, inverse=True)"
    ),
    "Jlog3": "ph.right_jacobian(v, inverse=True)",
    "Jlog6": "ph.right_jacobian(xi, inverse=True), the rotation vector first",
}


def missing_law(module: str, name: str, laws: Mapping[str, str], what: str = "laws") -> AttributeError:
    """Return the error for a name that the module of torques, forces or events does not have."""
    remedy = f"; write ph.{laws[name]}" if name in laws else f"; the {what} are listed by dir(ph.{module})"
    return AttributeError(f"module 'polhode.{module}' has no attribute {name!r}{remedy}")


def missing(name: str) -> Exception:
    """Return the error for a name that the package does not have."""
    remedy = f"see polhode.{SEE[name]}" if name in SEE else f"write {WRITE[name]}" if name in WRITE else ""
    # Of ``from polhode import name`` Python shows no AttributeError; its frame asks for the name first.
    importing = sys._getframe(2).f_globals.get("__name__") == "importlib._bootstrap"
    if remedy and importing:
        return ImportError(f"cannot import name {name!r} from 'polhode'; {remedy}", name="polhode")
    return AttributeError(f"module 'polhode' has no attribute {name!r}{remedy and f'; {remedy}'}")
