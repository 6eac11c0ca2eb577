"""Functions of PyTorch3D, transformations.py and others, and what to write instead."""

from __future__ import annotations

from polhode._support.package_conversions import (
    AXIS,
    MATRIX,
    MOVED,
    RPY,
    TO_MATRIX,
    TO_MOVED,
    TO_VECTOR,
    TO_WXYZ,
    VECTOR,
    WXYZ,
)

_ROTATED = "ph.RigidTransform.from_rotation"
# From two directions, of which the first is kept: v for e1 and w for e2, or for e3 and e2.
_FIRST_TWO = "ph.align([ph.e1, ph.e2], [v, w], [np.inf, 1]).rotor"
_LAST_TWO = "ph.align([ph.e3, ph.e2], [v, w], [np.inf, 1]).rotor"

# Of rotations, as in PyTorch3D, which has rows (x, y, z, 1) and the translation first in logarithms.
_PYTORCH3D = {
    **dict.fromkeys(("quaternion_multiply", "quaternion_raw_multiply"), "R * S"),
    "quaternion_invert": "~R",
    "quaternion_apply": "R(ph.vector(x)).components",
    "standardize_quaternion": f"R.canonical(){TO_WXYZ}",
    "so3_exp_map": VECTOR + TO_MATRIX,
    "so3_log_map": MATRIX + TO_VECTOR,
    "so3_rotation_angle": f"{MATRIX}.angle",
    "so3_relative_angle": "R.distance(S)",
    "se3_exp_map": "ph.RigidTransform.exp(xi).as_matrix().T, with the rotation vector first",
    "se3_log_map": "ph.RigidTransform.from_matrix(H.T).log(), with the rotation vector first",
    "random_quaternions": f"ph.Rotor.random(shape){TO_WXYZ}",
    **dict.fromkeys(("random_rotation", "random_rotations"), f"ph.Rotor.random(shape){TO_MATRIX}"),
    "rotation_6d_to_matrix": f"{_FIRST_TWO}{TO_MATRIX}.T, with the six numbers as v and w",
    "matrix_to_rotation_6d": "M[:2].ravel(), the first two rows",
}

# Of rotations and displacements, as in transformations.py, which ROS has too.
_TRANSFORMATIONS = {
    **dict.fromkeys(("quaternion_conjugate", "quaternion_inverse"), "~R"),
    "quaternion_matrix": f'{_ROTATED}({WXYZ}){TO_MOVED}, with order="xyzw" as in ROS',
    "quaternion_about_axis": AXIS + TO_WXYZ,
    "quaternion_real": 'R["1"]',
    "quaternion_imag": f"R{TO_WXYZ}[..., 1:]",
    "random_rotation_matrix": f"ph.Rotor.random(){TO_MATRIX}",
    "euler_matrix": f"{_ROTATED}({RPY}){TO_MOVED}",
    "translation_matrix": f"ph.RigidTransform.from_translation(x){TO_MOVED}",
    "translation_from_matrix": f"{MOVED}.translation",
    "rotation_from_matrix": f"{MOVED}.rotor.plane_angle()",
    **dict.fromkeys(("compose", "compose_matrix"), f"ph.RigidTransform(R, x){TO_MOVED}"),
    **dict.fromkeys(("decompose", "decompose_matrix"), "T.as_components()"),
    "concatenate_matrices": "U * T, which moves by T first",
    "inverse_matrix": "T.inverse()",
    "is_same_transform": "T.is_close(U)",
    **dict.fromkeys(
        ("affine_matrix_from_points", "superimposition_matrix"),
        "ph.align(a - a.mean(), b - b.mean()).rotor, with the translation b.mean() - R(a.mean())",
    ),
    "reflection_matrix": "a.reflect(b), with the normal b",
    "vector_norm": "a.norm()",
    "vector_product": "ph.cross(a, b)",
}

# As in transforms3d, pytransform3d and spatialmath.
_OF_ROBOTS = {
    "axangle2aff": f"{_ROTATED}({AXIS}){TO_MOVED}",
    "aff2axangle": "T.screw_parameters()",
    "nearly_equivalent": "R.distance(S)",
    "qeye": "ph.Rotor.identity()",
    "optimal_alignment_in_chordal_metric": "ph.mean(R * ~S)",
    "qlog": "R.log()",
    "qexp": "A.exp()",
    "qinner": '(~R * S)["1"]',
    "qpositive": "R.canonical()",
    **dict.fromkeys(("from_vector_part", "qpure"), "-ph.bivector(v)"),
    **dict.fromkeys(("check_quaternion", "check_quaternions", "qunit"), WXYZ),
    **dict.fromkeys(
        ("check_matrix", "is_rotation_matrix", "isrot"), f"{MATRIX}, with an error unless M is a rotation"
    ),
    **dict.fromkeys(
        ("check_transform", "check_transforms", "ishom"), f"{MOVED}, with an error unless H is one"
    ),
    "matrix_from_two_vectors": f"{_FIRST_TWO}{TO_MATRIX}",
    "matrix_from_rotation_6d": f"{_FIRST_TWO}{TO_MATRIX}, with the six numbers as v and w",
    "rotation_6d_from_matrix": "M[:, :2].T.ravel(), the first two columns",
    "oa2r": f"{_LAST_TWO}{TO_MATRIX}, with the approach v and the orientation w",
    "oa2tr": f"{_ROTATED}({_LAST_TWO}){TO_MOVED}, with the approach v and the orientation w",
    **dict.fromkeys(
        ("dual_quaternion_from_screw_parameters", "dual_quaternions_from_screw_parameters"),
        "ph.RigidTransform.from_screw(a, b, theta, k), with the distance k, not the pitch",
    ),
    "screw_axis_from_screw_parameters": "ph.RigidTransform.from_screw(a, b, theta, k).log()",
    "swing_twist_composition": "R * S",
    "norm_axis_angle": AXIS + TO_VECTOR,
    "norm_compact_axis_angle": VECTOR + TO_VECTOR,
    "norm_euler": "ph.Rotor.from_euler(seq, angles).to_euler(seq)",
    "norm_mrp": "ph.Rotor.from_mrp(v).to_mrp()",
    **dict.fromkeys(("perpendicular_to_vector", "plane_basis_from_normal"), "a.undual().factor()"),
    **dict.fromkeys(("random_unit_vector", "random_vector"), "ph.Rotor.random()(ph.e1)"),
    **dict.fromkeys(("unitx", "unity", "unitz"), "ph.e1, ph.e2, ph.e3"),
    "rotate_transform": "ph.RigidTransform(R, T.translation), with another rotation",
    "translate_transform": "ph.RigidTransform(T.rotor, x), with another translation",
    **dict.fromkeys(
        ("e2h", "h2e", "vector_to_point", "vectors_to_points"), "T.apply(x), with three components"
    ),
    **dict.fromkeys(("TransformManager", "UrdfTransformManager"), "U * T, which moves by T first"),
    "transform_log_from_transform": "T.log(), the rotation vector first",
    "transform_from_transform_log": f"ph.RigidTransform.exp(xi){TO_MOVED}, the rotation vector first",
    "delta2tr": f"ph.RigidTransform.exp(xi){TO_MOVED}, the rotation vector first",
    "tr2delta": "(U.inverse() * T).log(), the rotation vector first",
    "tr2jac": f"{_ROTATED}(R).adjoint()",
    "cartesian_from_spherical": "ph.direction(phi, theta), with the latitude theta",
    "spherical_from_cartesian": "ph.longitude_latitude(a)",
    "BSplineSE3": "ph.RotorSpline(times, [R, S])",
    "Line3": "ph.pga(3).line([0, 0, 0], v)",
    "Plane3": "ph.pga(3).plane(v)",
}

# Of multivectors, as in galgebra and clifford.
_OF_MULTIVECTORS = {
    "com": "A.commutator(B)",
    "rev": "~A",
    **dict.fromkeys(("hitzer_inverse", "inv", "shirokov_inverse"), "A.inverse()"),
    "proj": "a.project(B)",
    "refl": "a.reflect(b), with the normal b",
    "sp": "A.scalar_product(B)",
    "mag": "A.norm()",
    **dict.fromkeys(("mag2", "norm2", "normsq"), "A.norm_squared()"),
    "even": "A.grade(0, 2)",
    "odd": "A.grade(1, 3)",
    "g_invol": "A.grade_involution()",
    "ccon": "A.clifford_conjugate()",
    "isclose": "A.is_close(B, rtol, atol)",
    **dict.fromkeys(("pretty", "print_precision", "ugly"), 'f"{A:.3f}"'),
}

FUNCTIONS = {**_PYTORCH3D, **_TRANSFORMATIONS, **_OF_ROBOTS, **_OF_MULTIVECTORS}
