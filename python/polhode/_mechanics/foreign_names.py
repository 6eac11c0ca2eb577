"""Names of other libraries for bodies and states, with ours."""

BODY = {
    **dict.fromkeys(("cube", "cuboid", "brick"), "Body.box(lengths, mass=m)"),
    **dict.fromkeys(("disk", "circle"), "Body.disc(radius, mass=m)"),
    **dict.fromkeys(("from_stl", "from_obj", "from_file", "load", "read"), "Body.from_mesh(path, mass=m)"),
    **dict.fromkeys(("com", "center", "centroid"), "center_of_mass"),
    **dict.fromkeys(("moments", "principal_moments"), "inertia.principal_moments"),
    **dict.fromkeys(("inertia_matrix", "inertia_tensor"), "inertia.matrix"),
    **dict.fromkeys(("translate", "rotate", "transform"), "moved(rotor, position)"),
}

INERTIA = {
    **dict.fromkeys(
        ("diagonal", "from_diagonal", "from_moments"), "Inertia.from_principal_moments(i1, i2, i3)"
    ),
    "from_tensor": "Inertia.from_matrix(J)",
    **dict.fromkeys(("tensor", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"), "matrix"),
    **dict.fromkeys(("moments", "eigenvalues"), "principal_moments"),
    **dict.fromkeys(("principal_axes", "eigenvectors"), "principal_frame, or eigenplanes()"),
    "inv": "inverse()",
}

STATE = {
    **dict.fromkeys(("attitude", "orientation", "rotation"), "rotor"),
    "quaternion": 'rotor.to_quaternion(order="wxyz")',
    **dict.fromkeys(("omega", "angular_velocity", "rates"), "omega_body or omega_space"),
    "t": "time",
}
