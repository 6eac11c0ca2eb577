"""Bodies of URDF, MJCF and SDF files, inertias that no body has, and the slips that lead to them."""

import numpy as np
import pytest

import polhode as ph
from polhode._mechanics.robots.read import read_links

# Rounding of a few products and sums of numbers near 1.
CLOSE = {"rtol": 0, "atol": 1e-14}


def write(tmp_path, text, name="robot.xml"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def urdf(tmp_path, inertial, name="robot.urdf"):
    """A URDF file with one link."""
    return write(tmp_path, f'<robot name="r">\n<link name="arm">\n{inertial}\n</link>\n</robot>\n', name)


def tensor(xx, yy, zz, xy=0, xz=0, yz=0, mass=2, origin=""):
    return (
        f'<inertial>{origin}<mass value="{mass}"/>\n'
        f'<inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}" izz="{zz}"/></inertial>'
    )


def mjcf(tmp_path, bodies, header=""):
    return write(tmp_path, f"<mujoco>\n{header}\n<worldbody>\n{bodies}\n</worldbody>\n</mujoco>\n")


def rotations(*angles):
    """Matrices of turns about x, y and z."""
    (a, b, c), (s, t, u) = np.cos(angles), np.sin(angles)
    return (
        np.array([[1, 0, 0], [0, a, -s], [0, s, a]]),
        np.array([[b, 0, t], [0, 1, 0], [-t, 0, b]]),
        np.array([[c, -u, 0], [u, c, 0], [0, 0, 1]]),
    )


J = np.array([[0.3, 0.02, -0.03], [0.02, 0.4, 0.01], [-0.03, 0.01, 0.5]])
X, Y, Z = rotations(0.3, -0.4, 1.2)
ROLL_PITCH_YAW = Z @ Y @ X
# Of any length but 0.
QUATERNION = 3 * ph.Rotor.from_matrix(ROLL_PITCH_YAW).to_quaternion(order="xyzw")


# --- the formats


def test_the_inertia_of_urdf_is_turned_into_the_axes_of_the_link(tmp_path):
    origin = '<origin xyz="1 2 3" rpy="0.3 -0.4 1.2"/>'
    text = tensor(0.3, 0.4, 0.5, 0.02, -0.03, 0.01, origin=origin)
    (body,) = ph.read_urdf(urdf(tmp_path, text)).values()
    assert body.mass == 2
    np.testing.assert_allclose(body.center_of_mass.components, [1, 2, 3], **CLOSE)
    np.testing.assert_allclose(body.inertia.matrix, ROLL_PITCH_YAW @ J @ ROLL_PITCH_YAW.T, **CLOSE)


@pytest.mark.parametrize(
    "pose",
    [
        "<pose>1 2 3 0.3 -0.4 1.2</pose>",
        f"<pose degrees='true'>1 2 3 {' '.join(map(repr, np.degrees([0.3, -0.4, 1.2]).tolist()))}</pose>",
        f"<pose rotation_format='quat_xyzw'>1 2 3 {' '.join(map(repr, QUATERNION.tolist()))}</pose>",
    ],
    ids=["radians", "degrees", "quaternion"],
)
def test_sdf_agrees_with_urdf(pose, tmp_path):
    inertia = "<ixx>0.3</ixx><ixy>0.02</ixy><ixz>-0.03</ixz><iyy>0.4</iyy><iyz>0.01</iyz><izz>0.5</izz>"
    link = f"<link name='arm'><inertial>{pose}<mass>2</mass><inertia>{inertia}</inertia></inertial></link>"
    path = write(tmp_path, f"<sdf version='1.9'><model name='m'>{link}</model></sdf>")
    (body,) = ph.read_sdf(path).values()
    np.testing.assert_allclose(body.center_of_mass.components, [1, 2, 3], **CLOSE)
    np.testing.assert_allclose(body.inertia.matrix, ROLL_PITCH_YAW @ J @ ROLL_PITCH_YAW.T, **CLOSE)


def test_names_in_sdf_have_their_models(tmp_path):
    link = (
        "<link name='{}'><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1.5</izz></inertia>"
        "</inertial></link>"
    )
    inner = f"<model name='inner'>{link.format('b')}</model>"
    one = f"<model name='m'>{link.format('a')}{inner}</model>"
    two = f"<model name='n'>{link.format('a')}</model>"
    path = write(tmp_path, f"<sdf version='1.9'><world name='w'>{one}</world></sdf>")
    assert list(ph.read_sdf(path)) == ["a", "inner::b"]
    path = write(tmp_path, f"<sdf version='1.9'><world name='w'>{one}{two}</world></sdf>")
    assert list(ph.read_sdf(path)) == ["m::a", "m::inner::b", "n::a"]


ORIENTATIONS = {
    # Lower-case axes turn with the body: the first turn is the outermost.
    'euler="0.3 -0.4 1.2"': X @ Y @ Z,
    'quat="2 0 0 2"': rotations(0, 0, np.pi / 2)[2],
    'axisangle="0 0 3 1.2"': Z,
    # The second axis is made orthogonal to the first.
    'xyaxes="0 2 0 -1 5 0"': rotations(0, 0, np.pi / 2)[2],
    'zaxis="1 0 0"': rotations(0, np.pi / 2, 0)[1],
    'zaxis="0 0 -2"': np.diag([1.0, -1, -1]),
}


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_orientations_of_mjcf(orientation, tmp_path):
    inertial = f'<inertial pos="1 2 3" mass="2" diaginertia="0.3 0.4 0.5" {orientation}/>'
    path = mjcf(tmp_path, f'<body name="arm">{inertial}</body>', '<compiler angle="radian"/>')
    (body,) = ph.read_mjcf(path).values()
    R = ORIENTATIONS[orientation]
    np.testing.assert_allclose(body.inertia.matrix, R @ np.diag([0.3, 0.4, 0.5]) @ R.T, **CLOSE)


@pytest.mark.parametrize(
    ("sequence", "expected"),
    [("xyz", X @ Y @ Z), ("XYZ", Z @ Y @ X), ("zYx", Y @ rotations(0, 0, 0.3)[2] @ rotations(1.2, 0, 0)[0])],
)
def test_euler_sequences_of_mjcf(sequence, expected, tmp_path):
    angles = " ".join(map(repr, np.degrees([0.3, -0.4, 1.2]).tolist()))
    inertial = f'<inertial pos="0 0 0" mass="2" diaginertia="0.3 0.4 0.5" euler="{angles}"/>'
    path = mjcf(tmp_path, f"<body>{inertial}</body>", f'<compiler eulerseq="{sequence}"/>')
    bodies = ph.read_mjcf(path)
    assert list(bodies) == ["body 1"]
    expected = expected @ np.diag([0.3, 0.4, 0.5]) @ expected.T
    np.testing.assert_allclose(bodies["body 1"].inertia.matrix, expected, **CLOSE)


def test_a_full_inertia_of_mjcf(tmp_path):
    inertial = '<inertial pos="1 2 3" mass="2" fullinertia="0.3 0.4 0.5 0.02 -0.03 0.01"/>'
    (body,) = ph.read_mjcf(mjcf(tmp_path, f'<body name="a">{inertial}</body>')).values()
    np.testing.assert_array_equal(body.inertia.matrix, J)


# --- MJCF geoms

GEOMS = """
<default><geom density="500"/><default class="heavy"><geom density="2000" type="box"/></default>
<default class="own"><geom type="capsule" euler="30 40 50"/></default></default>
"""
BODIES = """
<geom type="plane" size="1 1 1"/>
<body name="a" pos="1 2 3"><joint/>
  <geom size="0.1" pos="1 0 0"/>
  <geom type="box" size="0.1 0.2 0.3" pos="0.1 0.2 0.3" quat="1 2 3 4"/>
  <geom type="ellipsoid" size="0.1 0.2 0.3" mass="2" axisangle="1 1 1 50"/>
  <geom type="cylinder" size="0.1 0.2" zaxis="1 2 -3" group="5"/>
  <geom type="cylinder" size="9 9" group="6"/>
  <geom type="mesh" mesh="m" mass="0"/>
  <body childclass="heavy"><geom size="0.1 0.2 0.3"/>
    <frame pos="1 2 3" euler="20 30 40" childclass="own">
      <frame pos="0 1 0" xyaxes="1 1 0 0 0 1"><geom size="0.1 0.4" pos="0.1 0 0"/>
        <body name="inner"><geom class="heavy" size="1 2 3" mass="5" euler="1 2 3"/></body></frame>
      <geom fromto="0 0 0 1 2 3" size="0.1" type="capsule"/></frame>
  </body>
  <body name="b"><geom fromto="0 0 0 1 -2 3" size="0.1" type="box" class="main"/></body>
  <body name="c"><geom class="heavy" size="0.1 0.2 0.3"/>
    <inertial pos="1 2 3" mass="2" diaginertia="0.3 0.4 0.5" euler="10 20 30"/></body>
  <body name="d"><inertial pos="1 2 3" mass="2" fullinertia="0.3 0.4 0.5 0.02 -0.03 0.01"/></body>
  <body name="e"><geom size="0.1" fromto="0 0 1 0 0 2" type="cylinder"/></body>
</body>
<body name="frame"/>
"""


@pytest.mark.parametrize(
    "settings",
    [
        "",
        'eulerseq="ZyX" inertiafromgeom="true"',
        'inertiagrouprange="0 4" angle="radian"',
        'settotalmass="5"',
    ],
)
def test_bodies_agree_with_mujoco(settings, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    # MuJoCo wants the mesh; without mass it counts neither here nor there.
    bodies = BODIES.replace('<geom type="mesh" mesh="m" mass="0"/>', "")
    if "true" in settings:  # a body that moves needs mass
        bodies = bodies.replace('<body name="d">', '<body name="d"><geom size="0.1"/>')
    path = mjcf(tmp_path, bodies, f"<compiler {settings}/>{GEOMS}")
    compare(mujoco.MjModel.from_xml_path(str(path)), ph.read_mjcf(path))


def compare(model, bodies):
    names = [model.body(k).name or f"body {k}" for k in range(model.nbody)]
    assert [names[k] for k in range(model.nbody) if model.body_mass[k] > 0] == list(bodies)
    for name, body in bodies.items():
        k = names.index(name)
        assert body.mass == pytest.approx(model.body_mass[k], rel=1e-14)
        np.testing.assert_allclose(body.center_of_mass.components, model.body_ipos[k], rtol=0, atol=1e-13)
        R = ph.Rotor.from_quaternion(model.body_iquat[k], order="wxyz").to_matrix()
        expected = R @ np.diag(model.body_inertia[k]) @ R.T
        # MuJoCo's eigenvectors are found to about 1e-12.
        np.testing.assert_allclose(body.inertia.matrix, expected, rtol=0, atol=1e-10 * np.trace(expected))


def test_urdf_agrees_with_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    origin = '<origin xyz="1 2 3" rpy="0.3 -0.4 1.2"/>'
    inertial = tensor(0.3, 0.4, 0.5, 0.02, -0.03, 0.01, origin=origin)
    base = f'<robot name="r"><link name="base"/><link name="arm">{inertial}</link>'
    joint = '<joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint></robot>'
    path = write(tmp_path, base + joint, "robot.urdf")
    compare(mujoco.MjModel.from_xml_path(str(path)), ph.read_urdf(path))


def test_geoms_are_solids(tmp_path):
    """As in the comparison with MuJoCo, by closed forms."""
    bodies = ph.read_mjcf(mjcf(tmp_path, BODIES, GEOMS))
    assert list(bodies) == ["a", "body 2", "inner", "b", "c", "d", "e"]
    cylinder = bodies["e"]
    m = 500 * np.pi * 0.1**2
    assert cylinder.mass == pytest.approx(m, rel=1e-14)
    np.testing.assert_allclose(cylinder.center_of_mass.components, [0, 0, 1.5], **CLOSE)
    across = m * (3 * 0.1**2 + 1) / 12
    np.testing.assert_allclose(
        cylinder.inertia.matrix, np.diag([across, across, m * 0.1**2 / 2]), rtol=0, atol=1e-14
    )
    box = bodies["b"]
    assert box.mass == pytest.approx(500 * 0.2 * 0.2 * np.sqrt(14), rel=1e-14)
    assert bodies["c"].mass == 2


def test_a_range_of_groups_may_have_any_size(tmp_path):
    geoms = '<body><geom size="1" group="{}"/></body>'
    for group, count in (("1e50", 1), ("-1e99", 0)):
        path = mjcf(tmp_path, geoms.format(group), '<compiler inertiagrouprange="-1e50 1e99"/>')
        assert len(ph.read_mjcf(path)) == count


def test_a_total_mass_beyond_the_range_of_floats_is_an_error_of_the_body(tmp_path):
    body = '<body><inertial pos="0 0 0" mass="1e-300" diaginertia="1 1 1"/></body>'
    with pytest.raises(ValueError, match=r"robot.xml:4:\d+: error: scaled to settotalmass=1e\+99: "):
        ph.read_mjcf(mjcf(tmp_path, body, '<compiler settotalmass="1e99"/>'))


def test_included_files_are_read(tmp_path):
    (tmp_path / "parts").mkdir()
    write(
        tmp_path / "parts", '<mujocoinclude><body name="b"><geom size="1"/></body></mujocoinclude>', "b.xml"
    )
    path = mjcf(tmp_path, '<include file="parts/b.xml"/>')
    assert ph.read_mjcf(path)["b"] == ph.Body.sphere(1, density=1000)
    with pytest.raises(ValueError, match="included twice"):
        ph.read_mjcf(mjcf(tmp_path, '<include file="robot.xml"/>'))
    for name in ("nowhere.xml", 300 * "n" + "owhere.xml"):
        with pytest.raises(ValueError, match=r"robot.xml:4:1: error: no such file: .*nowhere.xml"):
            ph.read_mjcf(mjcf(tmp_path, f'<include file="{name}"/>'))


# --- links without mass


def test_links_that_are_frames_are_left_out(tmp_path):
    frames = '<link name="base"/><link name="tool"><visual/></link>'
    massless = f'<link name="tip">{tensor(0, 0, 0, mass=0)}</link>'
    text = f'<robot name="r">{frames}{massless}<link name="arm">{tensor(1, 2, 2.5)}</link></robot>'
    path = write(tmp_path, text)
    assert list(ph.read_urdf(path)) == ["arm"]
    assert [link.note for link in read_links(path)[1]] == [
        *("no inertial element", "no inertial element", "massless", "")
    ]


# --- impossible inertias


@pytest.mark.parametrize(
    ("inertial", "parts"),
    [
        (tensor(1, 1, 3), ["1, 1, 3 kg m²", "by 1 kg m² (33.3 %)", "∫x² dm"]),
        (tensor(1, 1, 1, 1, 1, 1), ["all six entries are 1, a placeholder"]),
        (tensor(1, -2, 3), ["not positive definite", "-2", "sign of iyy"]),
        # A plate, 1/12, 1/12 and 1/6, with three digits.
        (tensor(0.0833, 0.0833, 0.167), ["digits lost by rounding"]),
        (tensor(0.2, 0.3, 0.4, 0.24, 0, 0), ["ixy = 0.24", "izz/2 = 0.2"]),
        (tensor(0.1, 0.2, 15), ["izz = 15 is too large by a factor of about 10^2"]),
        (tensor(0.1, 0.2, 200), ["10^3 (g instead of kg?)"]),
        (tensor(0.1, 0.0002, 0.2), ["iyy = 0.0002 is too small by a factor of about 10^3"]),
        (tensor(0.1, 0.1, 0.1, 20, 10, 0), ["200 times the moments", "another unit"]),
        # Eigenvalues of these products of inertia depend on the sign of ixy ixz iyz.
        (tensor(1, 1, 1, 0.3, 0.3, 0.3), ["sign of the products of inertia", "-∫xy dm"]),
    ],
)
def test_impossible_inertias_have_a_place_and_a_slip(inertial, parts, tmp_path):
    path = urdf(tmp_path, inertial)
    with pytest.raises(ValueError) as error:
        ph.read_urdf(path)
    assert str(error.value).startswith(f"{path}:4:1: error: ")
    for part in [*parts, "Probable slip: ", "4 | <inertia ", "^^^^^^^^"]:
        assert part in str(error.value)


def test_a_parallel_axis_term_subtracted_once_too_often_is_found(tmp_path):
    """The turn of the inertia's axes matters: the term is about the origin of the link."""
    body = ph.Body.box([0.1, 0.2, 0.3], mass=2)
    turn = ph.Rotor.from_euler("xyz", [0.3, -0.4, 1.2]).to_matrix()
    d = turn.T @ np.array([0.2, 0, 0.1])
    xx, yy, zz, xy, xz, yz = (body.inertia.matrix - 2 * (d @ d * np.eye(3) - np.outer(d, d)))[
        (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)
    ].tolist()
    assert min(xx, yy, zz) < 0
    origin = '<origin xyz="0.2 0 0.1" rpy="0.3 -0.4 1.2"/>'
    near = '<origin xyz="0.2 0 0.05" rpy="0.3 -0.4 1.2"/>'
    for place, found in ((origin, True), (near, False)):
        path = urdf(tmp_path, tensor(xx, yy, zz, xy, xz, yz, origin=place))
        with pytest.raises(ValueError) as error:
            ph.read_urdf(path)
        assert ("another point than the centre of mass" in str(error.value)) == found


def test_the_order_of_a_full_inertia(tmp_path):
    """The matrix xx 1, yy 1.2, zz 1.4 with small products, row by row as in URDF."""
    inertial = '<inertial pos="0 0 0" mass="1" fullinertia="1 0.01 0.02 1.2 0.03 1.4"/>'
    with pytest.raises(ValueError, match="fullinertia is in the order of URDF"):
        ph.read_mjcf(mjcf(tmp_path, f'<body name="a">{inertial}</body>'))


def test_all_mistakes_are_reported(tmp_path):
    links = "\n".join(f'<link name="{name}">{tensor(1, 1, 3)}</link>' for name in "abb")
    path = write(tmp_path, f'<robot name="r">\n{links}\n</robot>')
    with pytest.raises(ValueError) as error:
        ph.read_urdf(path)
    assert str(error.value).count("no body has this inertia") == 3
    assert "'b' is already the name of line 4" in str(error.value)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (tensor(1, 1, 1.5, mass=1), []),
        (tensor(1, 1, 1, mass=1), ["all moments are 1 kg m²; is this a placeholder?"]),
        (tensor(0, 0, 0, mass=1), ["inertia is 0"]),
        (tensor(2e-5, 3e-5, 4e-5, mass=1000), ["denser than osmium", "mass in g"]),
        (tensor(2e3, 3e3, 4e3, mass=1), ["67.1 m", "kg mm²"]),
        (tensor(1, 1, 1.5, mass=1, origin='<origin xyz="150 0 0"/>'), ["150 m", "mm instead of m"]),
        (tensor(1, 1, 1.5, mass=1, origin='<origin rpy="3 -6.28 6.28"/>'), []),
        (
            tensor(1, 1, 1.5, mass=1, origin='<origin rpy="0 -90 45"/>'),
            ["warning: rpy has -90 rad, more than a turn; if it is in degrees, convert it", "<origin rpy"],
        ),
    ],
)
def test_improbable_inertias_are_questioned(text, parts, tmp_path):
    path = urdf(tmp_path, text)
    (link,) = read_links(path)[1]
    assert link.body is not None
    assert ph.read_urdf(path) == {"arm": link.body}
    assert len(link.warnings) == bool(parts)
    for part in parts:
        assert part in link.warnings[0]


@pytest.mark.parametrize(("options", "is_doubted"), [("", True), (" degrees='true'", False)])
def test_angles_of_sdf_beyond_a_turn_are_questioned(options, is_doubted, tmp_path):
    inertia = "<ixx>0.3</ixx><ixy>0</ixy><ixz>0</ixz><iyy>0.4</iyy><iyz>0</iyz><izz>0.5</izz>"
    pose = f"<pose{options}>0 0 0 90 0 0</pose>"
    link = f"<link name='arm'><inertial>{pose}<mass>2</mass><inertia>{inertia}</inertia></inertial></link>"
    path = tmp_path / "arm.sdf"
    path.write_text(f"<sdf version='1.9'><model name='robot'>{link}</model></sdf>")
    (found,) = read_links(path)[1]
    assert len(found.warnings) == is_doubted
    assert all("warning: the pose has 90 rad, more than a turn" in x for x in found.warnings)


def test_a_ball_of_osmium_is_as_dense_as_a_body_can_be(tmp_path):
    for density, dense in ((22_589, False), (22_591, True)):
        body = ph.Body.sphere(0.1, density=density)
        moments = body.inertia.principal_moments.tolist()
        (link,) = read_links(urdf(tmp_path, tensor(*moments, mass=body.mass)))[1]
        assert bool(link.warnings) == dense


# --- files with mistakes


@pytest.mark.parametrize(
    ("inertial", "message"),
    [
        ("<inertial/>", "3:1: error: <inertial> needs the element <mass>"),
        ('<inertial><mass value="1"/></inertial>', "3:1: error: <inertial> needs the element <inertia>"),
        (
            '<inertial><mass value="1"/>\n<inertia ixx="1"/></inertial>',
            "4:1: error: <inertia> needs the attr",
        ),
        (
            tensor("1_0", 1, 1),
            "4:1: error: attribute 'ixx' of <inertia> has '1_0', which is not a number",
        ),
        (
            tensor("nan", 1, 1),
            "4:1: error: attribute 'ixx' of <inertia> has 'nan', which is not a number",
        ),
        (
            tensor("0,02", 1, 1),
            "4:1: error: attribute 'ixx' of <inertia> has '0,02', which is not a number; write decimals",
        ),
        (
            tensor("1e200", 1, 1),
            "4:1: error: attribute 'ixx' of <inertia> must have numbers below 1e+100, got '1e200'",
        ),
        (
            tensor(1, 1, 1).replace("<mass", '<origin xyz="0,0,0"/><mass'),
            "attribute 'xyz' of <origin> must have 3 numbers, got '0,0,0'; write decimals with a point",
        ),
        (tensor("1 2", 1, 1), "4:1: error: attribute 'ixx' of <inertia> must have 1 number, got '1 2'"),
        (tensor("${m}", 1, 1), "expand the file with xacro first"),
        (tensor(1, 1, 1, mass=-1), "3:11: error: mass must be more than 0, got -1 kg"),
        (tensor(1, 1, 1, mass=0), "3:11: error: mass must be more than 0, got 0 kg"),
        ("<xacro:arm/>", "3:1: error: <xacro:arm> is not URDF"),
        (tensor(1, 1, 1, origin='<origin xyz="1 2"/>'), "must have 3 numbers, got '1 2'"),
        (2 * tensor(1, 1, 1.5), "<link> has more than one <inertial>"),
        ("<a>", "mismatched tag"),
    ],
)
def test_mistakes_in_urdf_have_a_place(inertial, message, tmp_path):
    path = urdf(tmp_path, inertial)
    with pytest.raises(ValueError) as error:
        ph.read_urdf(path)
    assert str(error.value).startswith(f"{path}:")
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("body", "header", "message"),
    [
        ('<geom type="mesh" mesh="m"/>', "", "3:18: error: inertia of a geom of a mesh is not supported"),
        ('<geom type="sdf"/>', "", "of type 'sdf' is not supported"),
        ('<geom size="1" shellinertia="true"/>', "", "shellinertia"),
        ('<geom size="1" class="x"/>', "", "no default class 'x'"),
        ('<geom type="box" size="1 1"/>', "", "a box needs 3 numbers in 'size'"),
        ('<geom type="box" size="1 1 -1"/>', "", "lengths[2]"),
        ('<geom type="capsule" size="1" fromto="0 0 0 0 0 0"/>', "", "two different points"),
        ('<replicate count="2"/>', "", "<replicate> is not supported"),
        ('<geom size="1"/>', '<compiler boundmass="5"/>', "'boundmass' of <compiler> is not supported"),
        ('<geom size="1"/>', '<compiler coordinate="global"/>', "global"),
        ('<geom size="1"/>', '<compiler angle="turn"/>', "angle must be one of degree, radian, got 'turn'"),
        ('<geom size="1"/>', '<compiler eulerseq="xy"/>', "eulerseq"),
        ('<inertial mass="1" pos="0 0 0"/>', "", "exactly one of the attributes 'diaginertia'"),
        ('<inertial mass="1" diaginertia="1 1 1"/>', "", "needs the attribute 'pos'"),
        (
            '<inertial mass="1" pos="0 0 0" fullinertia="1 1 1 0 0 0" euler="1 2 3"/>',
            "",
            "leave out the orientation",
        ),
        (
            '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1" euler="1 2 3" zaxis="1 0 0"/>',
            "",
            "has several orientations, euler and zaxis",
        ),
        ('<inertial mass="1" pos="0 0 0" diaginertia="1 1 1" quat="0 0 0 0"/>', "", "length 0"),
    ],
)
def test_mistakes_in_mjcf_have_a_place(body, header, message, tmp_path):
    path = write(
        tmp_path,
        f"<mujoco>{header}\n<worldbody>\n<body name='arm'>{body}</body>\n</worldbody></mujoco>",
    )
    with pytest.raises(ValueError) as error:
        ph.read_mjcf(path)
    assert str(error.value).startswith(f"{path}:")
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("model", "message"),
    [
        ("<include><uri>model://x</uri></include>", "1:36: error: <include> of 'model://x' is not supported"),
        ('<link name="a"><inertial auto="true"/></link>', 'auto="true"'),
        ('<link name="a"><inertial/></link>', "needs the element <mass>"),
        ("<link/>", "<link> needs the attribute 'name'"),
        (
            "<link name='a'><inertial><pose relative_to='b'>0 0 0 0 0 0</pose><mass>1</mass><inertia/>"
            "</inertial></link>",
            "'relative_to'",
        ),
        (
            "<link name='a'><inertial><mass>1</mass><inertia><ixx>1</ixx></inertia></inertial></link>",
            "<inertia> needs the element <iyy>",
        ),
    ],
)
def test_mistakes_in_sdf_have_a_place(model, message, tmp_path):
    path = write(tmp_path, f"<sdf version='1.9'><model name='m'>{model}</model></sdf>")
    with pytest.raises(ValueError) as error:
        ph.read_sdf(path)
    assert str(error.value).startswith(f"{path}:")
    assert message in str(error.value)


def test_documents_that_are_refused(tmp_path):
    bomb = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>\n<robot name="&b;"/>'
    with pytest.raises(ValueError, match=r":1:1: error: a document type .*; delete it"):
        ph.read_urdf(write(tmp_path, bomb))
    deep = "<robot>" + 1000 * "<a>" + 1000 * "</a>" + "</robot>"
    with pytest.raises(ValueError, match="nested more than 200 deep"):
        ph.read_urdf(write(tmp_path, deep))
    with pytest.raises(ValueError, match=r"must be <robot> \(URDF\), got <mujoco>; use read_mjcf"):
        ph.read_urdf(write(tmp_path, "<mujoco/>"))
    with pytest.raises(ValueError, match="the file is empty; export it again"):
        ph.read_sdf(write(tmp_path, ""))
    with pytest.raises(ValueError, match="not well-formed XML"):
        ph.read_sdf(write(tmp_path, "<sdf version=1/>"))
    with pytest.raises(ValueError, match="unknown encoding"):
        ph.read_sdf(write(tmp_path, '<?xml version="1.0" encoding="klingon"?><sdf/>'))
    with pytest.raises(FileNotFoundError, match=r"absent.urdf: no such file"):
        ph.read_urdf(tmp_path / "absent.urdf")
    with pytest.raises(ValueError, match="not a regular file"):
        ph.read_urdf(tmp_path)


def test_other_encodings_are_read(tmp_path):
    link = f'<link name="bras é">{tensor(1, 1, 1.5)}</link>'
    text = f'<?xml version="1.0" encoding="{{}}"?>\n<robot name="r">{link}</robot>'
    for encoding in ("utf-8", "latin-1", "utf-16"):
        path = tmp_path / "robot.urdf"
        path.write_bytes(text.format(encoding).encode(encoding))
        assert list(ph.read_urdf(path)) == ["bras é"]
