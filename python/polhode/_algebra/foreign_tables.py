"""Names of other libraries for values, rotors, transforms and algebras, and what to write instead.

Each text begins with an expression of a value of that class, or with one of A, B (multivectors), a, b
(vectors), R, S (rotors), T (a transform), P (a point), L (a line), X, Y (values of the algebra).
"""

BLADES = ("e1", "e2", "e3", "e12", "e13", "e23", "e31", "e123")
_IMMUTABLE = "which is immutable"

# As in clifford, kingdon, galgebra, ganja.js and SymPy.
MULTIVECTOR = {
    **dict.fromkeys(("allclose", "almost_equal", "isclose"), "is_close(B)"),
    **dict.fromkeys(
        ("angle", "angle_between", "angle_to"),
        "Rotor.from_vectors(a, b).angle, the angle between two vectors",
    ),
    "as_array": "dense()",
    **dict.fromkeys(("asfullmv", "blade_coefs", "get_coefs"), "dense(), with the order of A.algebra.blades"),
    "add": "A + B",
    "sub": "A - B",
    "div": "A / B",
    "neg": "-A",
    **dict.fromkeys(("basis", "blades_list"), "algebra.blades, with the coefficients dense()"),
    **dict.fromkeys(("ccon", "Conjugate", "conjugate"), "clifford_conjugate()"),
    "clean": "map(lambda c: np.where(abs(c) < eps, 0, c))",
    "coordinates": "ph.pga(3).coordinates(P), with the algebra of the value",
    "copy": f"A itself, {_IMMUTABLE}",
    "cp": "commutator(B)",
    "acp": "anticommutator(B)",
    "cross": "ph.cross(a, b)",
    **dict.fromkeys(("doit", "expand", "trigsimp"), "map(sympy.expand), with any function of SymPy"),
    "Dual": "dual(), or right_complement() of a degenerate metric",
    "evalf": "astype(float)",
    "even": "grade(0, 2), the even grades",
    **dict.fromkeys(("factorise", "factorize"), "factor()"),
    **dict.fromkeys(("flatten", "ravel"), "reshape(-1)"),
    "squeeze": "reshape(shape)",
    "get_grade": "grade(2)",
    **dict.fromkeys(("g_invol", "gradeInvol", "involute", "Involute"), "grade_involution()"),
    "gp": "A * B",
    "hodge": "right_complement()",
    "unhodge": "left_complement()",
    "polarity": "dual()",
    "unpolarity": "undual()",
    **dict.fromkeys(("I", "pseudoscalar"), "algebra.I"),
    "invPS": "algebra.I.inverse()",
    "collect": "map(lambda c: sympy.collect(c, x))",
    "integrate": "map(lambda c: sympy.integrate(c, x))",
    **dict.fromkeys(
        ("hitzer_inverse", "inv", "leftLaInv", "rightLaInv", "rightInv", "shirokov_inverse"), "inverse()"
    ),
    "ip": "A | B",
    **dict.fromkeys(("isBlade", "is_blade"), "factor(), with an error unless the value is a blade"),
    **dict.fromkeys(("isScalar", "is_scalar"), "grades == (0,), or A == A.grade(0)"),
    "is_vector": "grades == (1,), or A == A.grade(1)",
    "is_zero": "A == 0",
    "pure_grade": "grades",
    **dict.fromkeys(("pseudoScalar", "ps"), "algebra.I"),
    "items": "dict(zip(A.algebra.blades, A.dense()))",
    "keys": "grades",
    "lc": "left_contraction(B)",
    **dict.fromkeys(("length", "Length", "mag", "magnitude"), "norm()"),
    **dict.fromkeys(("leftInv", "normalInv"), "inverse()"),
    **dict.fromkeys(("mag2", "norm2", "normsq"), "norm_squared()"),
    "ndim": "len(A.shape)",
    **dict.fromkeys(("normal", "normalize", "Normalized", "unit"), "normalized()"),
    "odd": "grade(1, 3), the odd grades",
    "op": "A ^ B",
    **dict.fromkeys(("outerexp", "OuterExp"), "outer_exp()"),
    **dict.fromkeys(("proj", "project_in_blade"), "project(B)"),
    "rc": "right_contraction(B)",
    **dict.fromkeys(("adjoint", "rev", "Reverse"), "reverse()"),
    **dict.fromkeys(("rotate", "rotate_multivector"), "R(a) for a rotor R"),
    "round": "map(np.round)",
    "reflect_in_blade": "-a.project(B) + a.reject(B) of a normal B, or a.reflect(b)",
    "rp": "A & B",
    "scalar": 'A["1"]',
    "size": "math.prod(A.shape)",
    "sp": "scalar_product(B)",
    "sw": "R >> A for a versor R",
    **dict.fromkeys(("T", "transpose"), "components.T"),
    "tolist": "components.tolist()",
    "value": "dense() or components",
    **dict.fromkeys(("values", "numpy"), "components"),
    **{
        name: f'A["e{axis}"], or ph.pga(3).coordinates(P)[..., {axis - 1}] of a point'
        for name, axis in (("x", 1), ("y", 2), ("z", 3))
    },
    **{name: f'A["{name}"]' for name in BLADES},
}

_WXYZ, _XYZW = 'to_quaternion(order="wxyz")', 'to_quaternion(order="xyzw")'
_VECTORS = ("from_two_vectors", "between", "FromTwoVectors", "setFromTwoVectors")
_RPY = "the angles roll, pitch, yaw"
_AXIS = "to_rotation_vector(), or plane_angle() for the plane and the angle"
_DERIVATIVE = "R * ph.bivector(v) / -2, with v the angular velocity in body axes"
_TANGENT = (
    "R * Rotor.from_rotation_vector(v), with v of the whole angle, twice the vector of a quaternion's log"
)
_GIBBS = "-(R.grade(2) / R['1']).components"
_TRIAD = "ph.align([ph.e3, ph.e2], [v, w], [np.inf, 1]).rotor"
_JOINED = "ph.concatenate([R, S]) of batches, which are immutable"

# As in SciPy, numpy-quaternion and other libraries of rotations.
ROTOR = {
    **dict.fromkeys(("abs", "modulus"), "norm(), which is 1"),
    "act": "R(a)",
    "adjoint": "to_matrix()",
    "align": "ph.align(a, b), or Rotor.from_vectors(a, b) for two directions",
    "align_vectors": "ph.align(a, b), which takes the target last",
    **dict.fromkeys(
        ("angdist", "angularDistance", "angle_to", "geodesic_distance"), "distance(S), with the whole angle"
    ),
    **dict.fromkeys(
        ("AngVec", "AngleAxis", "from_axang", "from_axisangle"), "from_axis_angle(v, theta), the axis first"
    ),
    "absolute_distance": "np.minimum((R - S).norm(), (R + S).norm())",
    **dict.fromkeys(("abs2", "absolute_square"), "norm_squared(), which is 1"),
    **dict.fromkeys(("append", "extend", "insert"), _JOINED),
    "average": "ph.mean(R)",
    "angular_velocities": "ph.rates_from_attitude(times, [R, S])",
    "approx_equal": "distance(S) or is_close(S, rtol, atol)",
    "as_davenport": "to_davenport(axes, order)",
    "as_euler": "to_euler(seq)",
    **dict.fromkeys(("as_euler_angles", "eul", "to_euler_angles"), 'to_euler("ZYZ")'),
    "canonicalized": "canonical()",
    "as_mrp": "to_mrp()",
    **dict.fromkeys(("compose", "multiply"), "S * R, which turns by R first"),
    "concatenate": "ph.stack([R, S]), or ph.concatenate([R, S]) of batches",
    "conjugate": "~R",
    "copy": f"R itself, {_IMMUTABLE}",
    "create_group": "group(name)",
    **dict.fromkeys(("degrees", "to_degrees"), "np.degrees(R.angle)"),
    **dict.fromkeys(("Empty", "Alloc"), "identity(shape)"),
    "Exp": "Rotor.from_rotation_vector(v)",
    **dict.fromkeys(("euler", "eulerAngles", "euler_angles"), "to_euler(seq)"),
    "EulerVec": "from_rotation_vector(v)",
    **dict.fromkeys(("derivative", "dotb", "ode"), _DERIVATIVE),
    "exp_map": _TANGENT,
    "increment": "R * Rotor.from_rotation_vector(v)",
    "flattened": "reshape(-1)",
    "from_angles": f'from_euler("xyz", angles), {_RPY}',
    "from_angular_velocity": "ph.attitude_from_rates(times, omega)",
    **dict.fromkeys(("from_dcm", "from_DCM", "from_rotation_matrix", "from_rotmat"), "from_matrix(M)"),
    **dict.fromkeys(("Eul", "from_euler_angles"), 'from_euler("ZYZ", angles)'),
    "from_euler_phases": 'from_euler("ZYZ", np.angle(z))',
    **dict.fromkeys(
        ("from_6d", "from_rotation_6d"),
        "ph.align([ph.e1, ph.e2], [v, w], [np.inf, 1]).rotor, with the six numbers as v and w",
    ),
    **dict.fromkeys(("from_axes", "from_basis", "from_frame"), "from_matrix(M), with the axes as columns"),
    **dict.fromkeys(("from_crp", "from_gibbs", "from_rodrigues"), 'from_quaternion([1, *v], order="wxyz")'),
    "from_ypr": 'from_euler("ZYX", angles), with yaw, pitch, roll',
    **dict.fromkeys(("from_Matrix", "from_q"), 'from_quaternion(q, order="wxyz")'),
    "from_spherical_coordinates": 'from_euler("ZY", [phi, theta])',
    "get_batch_axes": "shape",
    "from_quaternion_xyzw": 'from_quaternion(q, order="xyzw")',
    "from_float_array": 'from_quaternion(q, order="wxyz")',
    "from_quat": 'from_quaternion(q, order="xyzw")',
    **dict.fromkeys(("from_rpy", "from_rpy_radians", "RPY"), f'from_euler("xyz", angles), {_RPY}'),
    "from_rotvec": "from_rotation_vector(v)",
    **dict.fromkeys(_VECTORS, "Rotor.from_vectors(a, b)"),
    **dict.fromkeys(("from_x_radians", "Rx"), "Rotor.from_axis_angle(ph.e1, theta)"),
    **dict.fromkeys(("from_y_radians", "Ry"), "Rotor.from_axis_angle(ph.e2, theta)"),
    **dict.fromkeys(("from_z_radians", "Rz"), "Rotor.from_axis_angle(ph.e3, theta)"),
    "inner": '(~R * S)["1"]',
    **dict.fromkeys(("interp", "interpolate", "intermediates", "slerp"), "ph.slerp(R, S, t)"),
    **dict.fromkeys(("apply_inverse", "inverse_apply", "inv_apply"), "(~R)(a)"),
    "interp1": "R ** t",
    "jlog": "ph.right_jacobian(R.to_rotation_vector(), inverse=True)",
    "log_map": "(~R * S).log()",
    "logarithm": "log()",
    **dict.fromkeys(("inv", "reciprocal"), "~R or inverse()"),
    **dict.fromkeys(("isfinite", "isinf", "isnan"), "is_finite()"),
    **dict.fromkeys(("is_unit", "normalise", "normalised", "normalize"), "R itself, whose norm is 1"),
    **dict.fromkeys(("mul", "product"), "R * S, which turns by S first"),
    **dict.fromkeys(("plane", "polar_decomposition"), "plane_angle()"),
    "polar_angle": "plane_angle()[1] / 2",
    "polar_unit_vector": "plane_angle()[0].dual()",
    "remove_jumps": "continuous()",
    "rotate_by": "S * R, which turns by R first",
    **dict.fromkeys(("radians", "to_radians"), "angle"),
    "rotate": "R(a)",
    **dict.fromkeys(("as_rpy", "as_rpy_radians", "rpy"), f'to_euler("xyz"), {_RPY}'),
    **{f"compute_{name}_radians": f'to_euler("xyz"), {_RPY}' for name in ("roll", "pitch", "yaw")},
    **dict.fromkeys(("qvmul", "rotate_point", "rotate_vector", "rotate_vectors"), "R(a)"),
    **dict.fromkeys(("pow", "power"), "R ** t"),
    "prod": "functools.reduce(operator.mul, R)",
    **dict.fromkeys(("is_identity", "isidentity"), "angle == 0"),
    **dict.fromkeys(
        ("look_at", "look_rotation", "lookat"),
        f"{_TRIAD}, which turns e3 to the direction v and e2 towards w",
    ),
    "OA": f"{_TRIAD}, which turns e3 to the approach v and e2 towards the orientation w",
    "squad": "ph.RotorSpline(times, [R, S])(t)",
    **dict.fromkeys(("Rand", "Random", "UniformRandom", "sample_uniform"), "Rotor.random(shape)"),
    **dict.fromkeys(("RotatedVector", "TwoVectors"), "Rotor.from_vectors(a, b)"),
    "SE3": "RigidTransform.from_rotation(R)",
    "sym_distance": "distance(S), with the whole angle",
    "sym_log_map": "(R**-0.5 * S * R**-0.5).log()",
    **dict.fromkeys(("to_angles", "to_rpy"), f'to_euler("xyz"), {_RPY}'),
    "to_angular_velocity": "ph.rates_from_attitude(times, [R, S])",
    "to_euler_phases": 'np.exp(1j * R.to_euler("ZYZ"))',
    "to_spherical_coordinates": 'to_euler("ZYZ")[..., 1::-1]',
    "to_transformation_matrix": "RigidTransform.from_rotation(R).as_matrix()",
    **dict.fromkeys(("as_spinor_array", "two_spinor"), "ph.to_pauli(R)"),
    **dict.fromkeys(("s", "scalar", "scalar_part", "to_scalar_part"), 'R["1"]'),
    "single": "not R.shape",
    "square": "R * R",
    "stack": "ph.stack([R, S])",
    "T": "~R, the inverse, or R.to_matrix()",
    **dict.fromkeys(
        (
            *("A", "R", "as_dcm", "as_matrix", "as_rotation_matrix", "dcm", "matrix", "rotation_matrix"),
            *("toRotationMatrix", "to_dcm", "to_DCM", "to_rotation_matrix"),
        ),
        "to_matrix()",
    ),
    "transformation_matrix": "RigidTransform.from_rotation(R).as_matrix()",
    **dict.fromkeys(
        ("angvec", "as_axis_angle", "axis", "get_axis", "to_axang", "to_axis_angle", "to_axisangle"), _AXIS
    ),
    **dict.fromkeys(
        ("as_rotation_vector", "as_rotvec", "eulervec", "rotvec", "to_rotvec"), "to_rotation_vector()"
    ),
    **dict.fromkeys(
        (
            *("UnitQuaternion", "as_float_array", "elements", "ndarray", "parameters", "quaternion", "w"),
            *("to_Matrix", "to_array", "to_q", "wxyz", "x", "y", "z"),
        ),
        _WXYZ,
    ),
    **dict.fromkeys(("as_6d", "to_6d", "to_rotation_6d"), "to_matrix()[..., :2], the first two columns"),
    **dict.fromkeys(("as_crp", "as_rodrigues", "to_crp", "to_gibbs", "to_rodrigues"), _GIBBS),
    "to_list": f"{_WXYZ}.tolist()",
    **dict.fromkeys(("as_quat", "as_quaternion_xyzw", "quat", "to_quat", "vec_xyzs", "xyzw"), _XYZW),
    **dict.fromkeys(
        ("imaginary", "to_vector_part", "v", "vec", "vec3", "vector", "vector_part"), f"{_XYZW}[..., :3]"
    ),
    # pyquaternion computes the angles of another sequence than it documents.
    "yaw_pitch_roll": 'to_euler("ZYX"), or to_euler("XYZ")[..., ::-1] for the numbers of pyquaternion',
    **{name: f'to_euler("ZYX")[..., {k}]' for k, name in enumerate(("yaw", "pitch", "roll"))},
}

# Of complex coefficients, which rotors do not have. Elsewhere the names are of quaternions.
PARTS_OF_ROTORS = {
    "conj": "~R",
    "imag": f"grade(2), or {_XYZW}[..., :3]",
    "real": 'R["1"]',
}

# As in SciPy, spatialmath, jaxlie and Pinocchio.
TRANSFORM = {
    **dict.fromkeys(("act", "transform", "transform_point", "transform_points"), "apply(x)"),
    **dict.fromkeys(
        ("actInv", "apply_inverse", "inverse_apply", "inverse_transform"), "apply(x, inverse=True)"
    ),
    **dict.fromkeys(("rotate_vector", "transform_direction", "transform_vector"), "rotor(a)"),
    **dict.fromkeys(("Ad", "Adjoint"), "adjoint()"),
    **dict.fromkeys(("allclose", "approx_equal", "isclose"), "is_close(S)"),
    **dict.fromkeys(("A", "homogeneous", "as_homogeneous", "matrix", "to_homogeneous"), "as_matrix()"),
    "as_euler": "rotor.to_euler(seq)",
    **dict.fromkeys(("AngVec", "AngleAxis"), "RigidTransform.from_rotation(Rotor.from_axis_angle(v, theta))"),
    "angdist": "rotor.distance(S.rotor)",
    **dict.fromkeys(("angvec", "as_rotvec", "eulervec"), "rotor.to_rotation_vector()"),
    "magnitude": "rotor.angle",
    "exp_coords": "as_exp_coords()",
    "from_euler": "RigidTransform.from_rotation(Rotor.from_euler(seq, angles))",
    "from_rotvec": "RigidTransform.from_rotation(Rotor.from_rotation_vector(v))",
    "screw": "screw_parameters()",
    "rotate": "RigidTransform.from_rotation(R) * T",
    "translate": "RigidTransform.from_translation(x) * T",
    **dict.fromkeys(("invert", "inverted"), "inverse()"),
    **dict.fromkeys(("append", "extend", "insert"), f"RigidTransform.concatenate([S, T]), {_IMMUTABLE}"),
    "EulerVec": "RigidTransform.from_rotation(Rotor.from_rotation_vector(v))",
    **dict.fromkeys(("twist", "vee"), "log(), the rotation vector first"),
    "delta": "(~T * S).log(), the rotation vector first",
    "Delta": "RigidTransform.exp(xi), the rotation vector first",
    "OA": f"RigidTransform.from_rotation({_TRIAD})",
    "RotatedVector": "RigidTransform.from_rotation(Rotor.from_vectors(a, b))",
    "get_batch_axes": "shape",
    "jlog": "ph.right_jacobian(T.log(), inverse=True), the rotation vector first",
    **{name: f"rotor(ph.e{axis})" for axis, name in ((1, "n"), (2, "o"), (3, "a"))},
    "interp1": "T ** t",
    **dict.fromkeys(("eul", "Eul"), 'rotor.to_euler("ZYZ"), or Rotor.from_euler("ZYZ", angles)'),
    **dict.fromkeys(("rpy", "RPY"), 'rotor.to_euler("xyz"), or Rotor.from_euler("xyz", angles)'),
    **{
        name: f"RigidTransform.from_rotation(Rotor.from_axis_angle(ph.e{axis}, theta))"
        for name, axis in (("Rx", 1), ("Ry", 2), ("Rz", 3))
    },
    **{
        name: f"RigidTransform.from_translation(t * ph.e{axis})"
        for name, axis in (("Tx", 1), ("Ty", 2), ("Tz", 3))
    },
    "Trans": "RigidTransform.from_translation(x)",
    **{name: f'translation["e{axis}"]' for name, axis in (("x", 1), ("y", 2), ("z", 3))},
    "as_quat": f"rotor.{_XYZW}",
    **dict.fromkeys(("as_rotation", "attitude", "orientation"), "rotor"),
    "components": "as_components()",
    **dict.fromkeys(("compose", "multiply"), "S * T, which moves by T first"),
    "copy": f"T itself, {_IMMUTABLE}",
    "distance": "(~S * T).as_exp_coords()",
    "dual_quaternion": "as_dual_quat()",
    "Exp": "RigidTransform.exp(xi)",
    **dict.fromkeys(("from_pose", "from_rotation_and_translation", "from_rt"), "RigidTransform(R, a)"),
    "from_rotor": "RigidTransform.from_rotation(R)",
    "Identity": "RigidTransform.identity()",
    "interp": (
        "interpolate(S, t), which is a screw motion, or RigidTransform(ph.slerp(T.rotor, S.rotor, t), "
        "(1 - t) * T.translation + t * S.translation)"
    ),
    "slerp": "interpolate(S, t)",
    "Log": "log()",
    "motor": "to_motor()",
    "ndim": "len(T.shape)",
    **dict.fromkeys(("p", "position", "origin", "t", "trans"), "translation"),
    **dict.fromkeys(("get_translation", "pos"), "translation"),
    **dict.fromkeys(("R", "get_rotation", "rotation_matrix"), "rotor, or rotor.to_matrix()"),
    "UnitQuaternion": f"rotor.{_WXYZ}",
    **dict.fromkeys(("norm", "normalize"), f"T itself, {_IMMUTABLE}"),
    **dict.fromkeys(("parameters", "wxyz_xyz"), "as_components()"),
    **dict.fromkeys(("Rand", "random", "sample_uniform"), "RigidTransform(Rotor.random(), a)"),
    "reshape": "RigidTransform(T.rotor.reshape(shape), T.translation.reshape(shape))",
    "Rt": "as_components()",
    "prod": "functools.reduce(operator.mul, T)",
    "size": "math.prod(T.shape)",
    "sum": "mean()",
}

# As in clifford, kingdon and galgebra.
ALGEBRA = {
    **dict.fromkeys(("E", "mv_I"), "I"),
    "basis_names": "blades",
    "frame": "basis_vectors",
    **dict.fromkeys(("com", "commutator"), "X.commutator(Y)"),
    **dict.fromkeys(("dot", "hestenes_dot"), "X | Y"),
    "get_grade": "X.grade(1)",
    **dict.fromkeys(("geometric_product", "mul"), "X * Y"),
    "left_contract": "X.left_contraction(Y)",
    **dict.fromkeys(("mvr", "r_basis_mv", "ReciprocalFrame"), "ph.reciprocal_frame(A.basis_vectors)"),
    "reciprocal_frame": "ph.reciprocal_frame(A.basis_vectors)",
    "right_contract": "X.right_contraction(Y)",
    "scalar_product": "X.scalar_product(Y)",
    "wedge": "X ^ Y",
    **dict.fromkeys(("bases", "basis", "blades_list"), "blades"),
    "basis_vectors_lst": "basis_vectors",
    "bivectors": "bivector(components)",
    **dict.fromkeys(("d", "dims", "n"), "dimension"),
    "evenmv": "multivector(components).grade(0, 2)",
    "gaDims": "size",
    **dict.fromkeys(("mv", "MultiVector"), "multivector(components)"),
    "oddmv": "multivector(components).grade(1, 3)",
    "p": "signature[0]",
    "q": "signature[1]",
    "r": "signature[2]",
    **dict.fromkeys(("pseudoScalar", "pss", "ps"), "I"),
    "purevector": "k_vector(k, components)",
    "randomMV": "random()",
    **dict.fromkeys(("metric", "sig"), "signature"),
    **dict.fromkeys(("randomV", "random_vector"), "random().grade(1)"),
    "trivector": "k_vector(3, components)",
    "gp": "X * Y",
    "op": "X ^ Y",
    "ip": "X | Y",
    "rp": "X & Y",
    "sw": "X >> Y for a versor X",
    "cp": "X.commutator(Y)",
    "acp": "X.anticommutator(Y)",
    "reverse": "~X",
}

# Of plane-based algebras, as in kingdon, ganja.js and text books.
PGA = {
    **ALGEBRA,
    "distance": "(L & P).norm() for a line L and a point P of norm 1",
    "ideal_point": "direction(x)",
    "join": "P & Q",
    "meet": "X ^ Y",
    "origin": "point([0, 0, 0])",
    "project": "(X | Y) / Y",
    "rotor": "(-θ/2 * L).exp() for the rotation by θ about a line L of norm 1",
    "translation": "translator(t)",
}

# Of conformal algebras, as in clifford and text books.
CGA = {
    **ALGEBRA,
    **dict.fromkeys(("e_inf", "n_inf", "ni", "ninf", "einfinity"), "einf"),
    **dict.fromkeys(("e_o", "no", "origin"), "eo"),
    "E0": "A.einf ^ A.eo",
    "distance": "float(-2 * (P | Q)) ** 0.5 for points P, Q of weight 1",
    "en": "basis_vectors[-1]",
    "ep": "basis_vectors[-2]",
    **dict.fromkeys(("dilation", "scale"), "dilator(k)"),
    "homo": "P / -(P | A.einf)",
    **dict.fromkeys(("normalize", "normalized", "normalize_point"), "P / -(P | A.einf)"),
    "join": "P ^ Q",
    "meet": "X & Y",
    "project": "(X | Y) / Y",
    "rotation": "rotor(R)",
    "translation": "translator(t)",
}

# Of splines, as in SciPy and numpy-quaternion.
SPLINE = {
    **dict.fromkeys(("alpha", "angular_acceleration", "acceleration"), "alpha_body(t)"),
    **dict.fromkeys(("angular_rate", "angular_velocity", "derivative", "omega", "velocity"), "omega_body(t)"),
    "omega_space": "spline(t)(spline.omega_body(t))",
    **dict.fromkeys(("evaluate", "interpolate"), "spline(t)"),
    "knots": "times",
    "rotations": "rotors",
}
