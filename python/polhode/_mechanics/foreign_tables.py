"""Names of other libraries for bodies, states and motions, with ours."""

BODY = {
    **dict.fromkeys(("cube", "cuboid", "brick"), "Body.box(lengths, mass=m)"),
    **dict.fromkeys(("disk", "circle"), "Body.disc(radius, mass=m)"),
    "from_inertia": "Body(mass=m, inertia=J)",
    **dict.fromkeys(("from_stl", "from_obj", "from_file", "load", "read"), "Body.from_mesh(path, mass=m)"),
    **dict.fromkeys(("com", "center", "centre", "centre_of_mass", "centroid"), "center_of_mass"),
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
    **dict.fromkeys(("q", "quat", "quaternion"), 'rotor.to_quaternion(order="wxyz")'),
    "R": "rotor",
    **dict.fromkeys(("omega", "angular_velocity", "rates"), "omega_body or omega_space"),
    "t": "time",
}

TRAJECTORY = {
    **STATE,
    "times": "time",
    "y": "rotor and omega_body",
    "rotors": "rotor",
    **dict.fromkeys(("angular_momentum", "momentum", "L"), "momentum_body or momentum_space"),
    "kinetic_energy": "energy",
    "states": "at(t)",
    "state": "at(t)",
    **dict.fromkeys(("interpolate", "sol"), "at(t)"),
    "summary": "certificate",
    **dict.fromkeys(
        ("describe", "frequency", "period", "periods"), "ph.FreeMotion(body, rotor, omega_body).describe()"
    ),
    "show": "view() and plot()",
    "animate": "view() and film(path)",
    "to_pandas": "to_dataframe()",
    "to_csv": "save(path)",
    "to_parquet": "save(path)",
    "to_netcdf": "save(path)",
    "euler": "rotor.to_euler(seq)",
    **dict.fromkeys(("load", "open", "from_file"), "Trajectory.read(path)"),
}

STEPPER = {
    **dict.fromkeys(("rotor", "attitude", "orientation"), "state.rotor"),
    **dict.fromkeys(("omega", "omega_body", "angular_velocity"), "state.omega_body"),
    "advance": "step(dt)",
    "wheel_speeds": "wheel_speed",
    "qpos": 'state.rotor.to_quaternion(order="wxyz"), and state.position',
    "qvel": "state.omega_body, and state.velocity",
    "t": "time",
}

CLOSED_FORM = {
    "plot": "view(), or ph.simulate(…).plot()",
    **dict.fromkeys(("period", "frequency"), 'describe()["period"]'),
    "regime": 'describe()["regime"]',
    **dict.fromkeys(("rotor", "attitude", "orientation", "rotation"), "at(t).rotor"),
    **dict.fromkeys(("omega", "omega_body", "angular_velocity"), "at(t).omega_body"),
    **dict.fromkeys(("state", "sol", "interpolate"), "at(t)"),
}

CROSSINGS = dict.fromkeys(("t", "times"), "time")

HISTORY = {
    **STATE,
    **dict.fromkeys(("omega", "omega_space", "angular_velocity", "rates"), "omega_body"),
    "times": "time",
    **dict.fromkeys(("at", "interpolate", "resample"), "RotorSpline(history.time, history.rotor)(t)"),
    **dict.fromkeys(("save", "write", "to_csv"), "ph.io.write(history, path)"),
    **dict.fromkeys(("plot", "view", "film", "to_dataframe"), "trajectory(body), which has it"),
}
