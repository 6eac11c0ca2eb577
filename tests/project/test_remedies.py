"""Errors name a remedy that helps; a missing file is a FileNotFoundError of any kind of file."""

import math
import pydoc
import rlcompleter

import numpy as np
import pytest

import polhode as ph
import studios
from command_line import polhode

BODY = ph.Inertia.from_principal_moments(1, 2, 3)
GRID = ph.simulate(BODY, ph.State(ph.Rotor.random((2, 3), rng=1), [0.1, 2, 0.1]), [0.0, 0.5, 1.0])


@pytest.mark.parametrize("name", ["plot", "film"])
def test_a_body_picked_from_a_batch_is_drawn(name, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    studios.paint(monkeypatch)
    call = getattr(GRID, name)
    with pytest.raises(ValueError, match=rf"{name} .*\(2, 3\).*trajectory\[0, 0\]"):
        call(*([] if name == "plot" else [tmp_path / "a.gif"]))
    if name == "plot":
        assert GRID[0, 0].plot().axes
    else:
        GRID[0, 0].film(tmp_path / "a.gif", seconds=0.4, fps=10, size=(80, 60))
        assert (tmp_path / "a.gif").stat().st_size


def test_a_body_picked_from_a_batch_is_shown():
    from polhode._viewer.document import document

    with pytest.raises(ValueError, match=r"the viewer .*trajectory\[0, 0\]"):
        document(GRID)
    assert document(GRID[0, 0])["recorded"]


@pytest.mark.parametrize("name", ["at", "drifts"])
def test_methods_of_picked_bodies_name_the_remedy(name):
    with pytest.raises(ValueError, match="simulate that body alone"):
        getattr(GRID, name)(*([0.3] if name == "at" else []))


READERS = {
    "absent.toml": ph.Scene.read,
    "absent.nc": ph.Trajectory.read,
    "absent.stl": lambda path: ph.Body.from_mesh(path, mass=1.0),
}


@pytest.mark.parametrize("name", READERS)
def test_a_missing_file_is_a_file_not_found_error(name, tmp_path):
    if name.endswith(".nc"):
        pytest.importorskip("h5py")
    with pytest.raises(FileNotFoundError, match=rf"{name}: .*no such file"):
        READERS[name](tmp_path / name)


def test_a_missing_scene_is_a_scene_error_too(tmp_path):
    with pytest.raises(ph.SceneError, match="no such file"):
        ph.Scene.read(tmp_path / "absent.toml")
    with pytest.raises(ph.SceneError, match="is a directory") as error:
        ph.Scene.read(tmp_path)
    assert not isinstance(error.value, FileNotFoundError)
    for command in (("run",), ("check",), ("figure", "-o", "a.png", "motion")):
        done = polhode(*command, "absent.toml", cwd=tmp_path)
        assert done.returncode == 3
        assert done.stderr == "absent.toml: error: no such file\n"


TURNED, RATE = ph.Rotor.identity(), [0, 0, 1]
START = ph.State(TURNED, RATE)


@pytest.mark.parametrize(
    ("call", "wrong", "ours"),
    [
        (lambda: ph.State(attitude=TURNED, omega_body=RATE), "State .*'attitude'", "rotor="),
        (lambda: ph.State(TURNED, omega=RATE), "State .*'omega'", "omega_body= or omega_space="),
        (lambda: ph.State(TURNED, RATE, positon=0), "State .*'positon'", "position="),
        (lambda: ph.Body(2.0, moments=BODY), "Body .*'moments'", "inertia="),
        (lambda: ph.Body.box(size=[1, 2, 3], mass=1), r"Body\.box .*'size'", "lengths="),
        (lambda: ph.Body.cylinder(1, h=1, mass=1), r"Body\.cylinder .*'h'", "height="),
        (lambda: ph.Body.from_mesh("a.stl", units="mm", mass=1), r"Body\.from_mesh .*'units'", "scale="),
        (lambda: ph.simulate(BODY, START, [1.0], dt=0.1), "simulate .*'dt'", "step="),
        (lambda: ph.simulate(BODY, START, t_end=1.0), "simulate .*'t_end'", "times="),
        (lambda: ph.simulate_blocks(BODY, START, [1.0], tol=1e-9), "simulate_blocks .*'tol'", "rtol="),
        (lambda: ph.Stepper(BODY, START, dt=0.1), "Stepper .*'dt'", "step="),
        (lambda: ph.Rotor.random(3, seed=1), r"Rotor\.random .*'seed'", "rng="),
        (lambda: ph.fit(quaternion=GRID.rotor), "fit .*'quaternion'", "attitude="),
    ],
)
def test_unknown_arguments_are_errors_that_name_ours(call, wrong, ours):
    with pytest.raises(TypeError, match=f"^{wrong}; write {ours}$"):
        call()


@pytest.mark.parametrize("shown", [GRID, ph.FreeMotion(BODY, TURNED, RATE)])
def test_unknown_arguments_without_a_like_name_list_all(shown):
    with pytest.raises(
        TypeError, match=r"^view has no argument 'port'; its arguments are \(duration=None\)$"
    ):
        shown.view(port=3)
    assert type(shown).view.__name__ == "view"


@pytest.mark.parametrize(
    ("call", "python", "arguments"),
    [
        (lambda: ph.State(), r"State\(\) missing .*'rotor'", r"\(rotor, omega_body=None, .*"),
        (lambda: ph.FreeMotion(BODY, START), "FreeMotion.* missing .*", r"\(inertia, rotor, omega_body\)"),
        (lambda: ph.simulate(BODY, START), "simulate.* missing .*'times'", r"\(body, state, times, .*"),
        (
            lambda: ph.Inertia.from_principal_moments(1, 2, 3, 4),
            "Inertia.from_principal_moments.* takes from 1 to 3 .*",
            r"\(i1, i2=None, i3=None\)",
        ),
        (
            lambda: ph.Rotor.from_quaternion([1, 0, 0, 0]),
            "Rotor.from_quaternion.* missing .*'order'",
            r"\(q, \*, order, errors='raise'\), with order='wxyz' or 'xyzw'",
        ),
        (
            lambda: TURNED.to_quaternion("wxyz"),
            ".* takes 0 .* 1 was.*",
            r".*with order='wxyz' or 'xyzw'",
        ),
        (
            lambda: ph.Body.box(1, 2, 3, mass=1),
            ".* takes 1 .*",
            r"\(lengths, \*, mass=None, density=None\); pass numbers as one list, \[1, 2, 3\]",
        ),
    ],
)
def test_calls_with_too_few_or_too_many_arguments_list_all(call, python, arguments):
    with pytest.raises(TypeError, match=f"^{python}; its arguments are {arguments}$"):
        call()


@pytest.mark.parametrize(
    ("use", "ours"),
    [
        (lambda: ph.Body.cuboid([1, 2, 3], mass=1), r"a Body .*; write Body\.box\(lengths, mass=m\)"),
        (lambda: ph.Body.sphere(1, mass=1).com, "a Body .*; write center_of_mass"),
        (lambda: BODY.Ixx, "an Inertia .*; write matrix"),
        (lambda: START.omega, "a State .*; write omega_body or omega_space"),
        (lambda: ph.Scene.load("a.toml"), r"a Scene .*; write Scene\.read\(path\)"),
        (lambda: ph.Trajectory.load("a.nc"), r"a Trajectory .*; write Trajectory\.read\(path\)"),
        (lambda: ph.FreeMotion(BODY, TURNED, RATE).plot(), r"a FreeMotion .*; write view\(\), or .*"),
        (lambda: GRID.kinetic_energy, "a Trajectory .*; write energy"),
        (lambda: GRID.orientation, "a Trajectory .*; write rotor"),
        (lambda: GRID.load, r"a Trajectory .*; write Trajectory\.read\(path\)"),
        (lambda: ph.Body.sphere(1, mass=1).centre_of_mass, "a Body .*; write center_of_mass"),
        (lambda: ph.Stepper(BODY, START).omega_body, "a Stepper .*; write state.omega_body"),
        (lambda: TURNED.as_rotation_matrix, r"a Rotor .*; write to_matrix\(\)"),
        (lambda: ph.Rotor.from_euler_angles, r'a Rotor .*; write from_euler\("ZYZ", angles\)'),
        (lambda: ph.KeplerOrbit, r".*; see polhode\.torque\.KeplerOrbit"),
        (lambda: GRID.period, r"a Trajectory .*; write ph\.FreeMotion\(.*\)\.describe\(\)"),
        (lambda: ph.FreeMotion(BODY, TURNED, RATE).period, r'a FreeMotion .*; write describe.*"period"\]'),
        (lambda: ph.plot, r".*; see polhode\.Trajectory\.plot and view"),
        (lambda: ph.load, r".*; see polhode\.io\.read, Trajectory\.read and Scene\.read"),
    ],
)
def test_other_names_are_errors_that_name_ours(use, ours):
    with pytest.raises(AttributeError, match=f"^{ours}$"):
        use()


def test_other_names_are_not_listed():
    assert {"rotor", "omega_body", "omega_space"} <= {*dir(START)}
    assert not {"omega", "quaternion"} & {*dir(START)}
    assert "cuboid" not in dir(ph.Body.sphere(1, mass=1))
    assert {"box", "inertia"} <= {*dir(ph.Body)}
    assert not {"cuboid", "from_stl"} & {*dir(ph.Body)}
    assert "orientation" not in pydoc.render_doc(ph.FreeMotion)


def test_completion_in_the_repl_lists_no_other_names():
    completer = rlcompleter.Completer({"start": START})
    completer.complete("start.o", 0)
    assert [match.rstrip("(") for match in completer.matches] == ["start.omega_body", "start.omega_space"]


def test_help_lists_other_names_after_the_methods_with_what_to_write():
    text = pydoc.plain(pydoc.render_doc(ph.Rotor))
    methods, _, others = text.partition("Data descriptors defined here:")
    assert "to_quaternion(" in methods
    assert "as_quat" not in methods
    assert "A name in other libraries; here write to_quaternion(" in others


def test_other_names_cannot_be_set():
    with pytest.raises(AttributeError, match="write center_of_mass"):
        ph.Body.sphere(1, mass=1).com = [0, 0, 1]


def test_a_spline_with_the_rotors_first_names_the_order():
    for rotors in (ph.Rotor.identity(2), [TURNED, TURNED]):
        with pytest.raises(TypeError, match=r"RotorSpline\(times, rotors\)"):
            ph.RotorSpline(rotors, [0.0, 1.0])


@pytest.mark.parametrize(
    ("call", "remedy"),
    [
        (lambda: ph.stack(TURNED, TURNED), r"as in stack\(\[a, b\]\)"),
        (lambda: ph.concatenate(TURNED, TURNED), r"as in concatenate\(\[a, b\]\)"),
        (lambda: ph.simulate(BODY, [START, START], [1.0]), r"write State\(rotor, omega_body\), with arrays"),
        (lambda: ph.Body.sphere(1, mass=1).moved([1, 0, 0]), "a displacement is position="),
        (lambda: ph.Body(1.0, [1, 2, 3]), "see Inertia.from_principal_moments, from_matrix"),
        (
            lambda: ph.io.write_urdf([BODY], "a.urdf"),
            "expected a Body, or a dict of bodies by name, got list",
        ),
        (
            lambda: ph.io.write_sclk("a.tsc", clock=-9, epoch=20260101),
            "a string such as '2026-01-01T00:00:00' or a datetime, got int",
        ),
        (lambda: ph.LinearMap.from_function(None), "f must be a function of a multivector, got NoneType"),
        (lambda: ph.Scene.read(7), "expected str, bytes or os.PathLike object, not int"),
    ],
)
def test_arguments_of_another_type_name_the_form(call, remedy):
    with pytest.raises(TypeError, match=remedy):
        call()


def test_euler_angles_numbered_as_in_aerospace_are_lettered():
    with pytest.raises(ValueError, match="got '321'; write 'ZYX' for turns about body axes"):
        ph.Rotor.from_euler("321", [0.1, 0.2, 0.3])
    with pytest.raises(ValueError, match="got 'rpy'; write 'xyz' for roll, pitch, yaw"):
        ph.Rotor.from_euler("rpy", [0.1, 0.2, 0.3])


def test_a_scene_without_its_suffix_is_named(tmp_path):
    (tmp_path / "top.toml").write_text("")
    with pytest.raises(FileNotFoundError, match=r"no such file; use .*top\.toml$"):
        ph.Scene.read(tmp_path / "top")


def test_a_missing_scene_of_the_name_of_an_example_is_copied(tmp_path):
    for name in ("t-handle", "t-handle.toml"):
        with pytest.raises(FileNotFoundError, match="`polhode examples t-handle` copies the example"):
            ph.Scene.read(tmp_path / name)
    with pytest.raises(FileNotFoundError, match=r"no such file$"):
        ph.Scene.read(tmp_path / "t-handles.toml")


def test_the_mean_of_motors_is_that_of_transforms():
    M = ph.RigidTransform(ph.Rotor.random(3, rng=1), [1, 2, 3]).to_motor()
    with pytest.raises(ValueError, match=r"write RigidTransform\.from_motor\(M\)\.mean\(\)\.to_motor\(\)"):
        ph.mean(M)
    assert ph.RigidTransform.from_motor(M).mean().to_motor().shape == ()


def test_the_exponential_of_rotors_is_that_of_bivectors():
    B = ph.bivector([0.1, 0.2, 0.3])
    assert ph.Rotor.exp(B) == B.exp()
    assert ph.Rotor.identity().exp().is_close(math.e)


def test_values_traced_by_jax_name_its_module():
    jax = pytest.importorskip("jax")
    with pytest.raises(TypeError, match=r"the angular velocity must be known numbers, but JAX .*use ph\.jax"):
        jax.jit(lambda w: ph.State(ph.Rotor.identity(), w).rotor.components)(jax.numpy.ones(3))


def test_a_table_read_as_netcdf_names_its_reader(tmp_path):
    pytest.importorskip("h5py")
    GRID[0, 0].save(tmp_path / "a.csv")
    with pytest.raises(OSError, match=r"use polhode\.io\.read$"):
        ph.Trajectory.read(tmp_path / "a.csv")
    assert len(ph.io.read(tmp_path / "a.csv").time) == 3


def test_errors_of_arguments_that_fit_stay():
    with pytest.raises(ValueError, match="unknown method 'RK45'"):
        ph.simulate(BODY, START, [1.0], method="RK45")
    with pytest.raises(TypeError, match="rotor must be a Rotor, got list"):
        ph.State(rotor=[1, 0, 0, 0], omega_body=RATE)


@pytest.mark.parametrize(
    ("kind", "remedy"),
    [
        (ph.Scene, r"ph\.Scene\.read\(path\)"),
        (ph.Trajectory, r"ph\.simulate, or ph\.Trajectory\.read\(path\) for a file"),
        (ph.Fit, r"ph\.fit"),
        (ph.ReducedEnsemble, r"Scene\.reduce"),
    ],
)
@pytest.mark.parametrize("given", [(), ("file.toml",)])
def test_results_have_no_public_constructor(kind, remedy, given):
    with pytest.raises(TypeError, match=f"^{kind.__name__} has no public constructor; use {remedy}$"):
        kind(*given)


@pytest.mark.parametrize("given", [(), (3,), (3, 0, 1)])
def test_algebras_are_made_by_functions(given):
    with pytest.raises(TypeError, match=r"PGA has no public constructor; write pga\(n\)"):
        ph.PGA(*given)
    with pytest.raises(TypeError, match=r"CGA has no public constructor; write cga\(n\)"):
        ph.CGA(*given)


def test_a_rotor_turns_back_by_its_reverse():
    R = ph.Rotor.from_axis_angle(ph.e3, 0.5)
    with pytest.raises(TypeError, match=r"Rotor.apply has no argument 'inverse'; write \(~R\)\(x\)"):
        R.apply(ph.e1, inverse=True)
    with pytest.raises(TypeError, match=r"positional argument .* write \(~R\)\(x\)"):
        R.apply(ph.e1, True)
    with pytest.raises(TypeError, match=r"1 positional argument but 2 were given; .* \(x, \*,"):
        R.apply(ph.e1, ph.e2)
    with pytest.raises(TypeError, match=r"4 positional arguments but 5 were given; .* \(inertia,"):
        ph.LagrangeTop(BODY, R, [0, 0, 1], [0, 0, 1], 9.81)


def test_attitudes_of_a_table_are_interpolated_by_a_spline():
    motion = ph.simulate(BODY, START, [0.0, 0.5, 1.0])
    m = ph.io.AttitudeHistory.of(motion).trajectory(BODY)
    with pytest.raises(
        ValueError, match=r"made of an AttitudeHistory .* ph\.RotorSpline\(m\.time, m\.rotor\)"
    ):
        m.at(0.3)
    assert ph.RotorSpline(m.time, m.rotor)(0.5).is_close(motion.at(0.5).rotor)


def test_moments_and_matrices_in_place_of_other_values():
    with pytest.raises(TypeError, match=r"for a matrix ph\.Inertia\.from_matrix\(J\)"):
        ph.simulate([[1, 0, 0], [0, 2, 0], [0, 0, 3]], START, [1.0])
    for given, remedy in ((BODY, "principal_moments"), (ph.Body(1, BODY), "inertia.principal_moments")):
        with pytest.raises(TypeError, match=f"got {type(given).__name__}; give its .{remedy}$"):
            ph.omega_from_periods(given, 5.0, 7.0, mode="long")


def test_the_shape_of_wheel_torques_is_named_once():
    wheels = ph.torque.reaction_wheels([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0.1] * 3)
    with pytest.raises(ValueError, match=r"wheel_torque must be of shape \(3,\), got \(2,\)"):
        ph.Stepper(BODY, START, wheels).step(0.1, wheel_torque=[1, 2])


@pytest.mark.parametrize(
    ("value", "found"),
    [
        ("0.1 /s", "the text '0.1 /s'"),
        (["1", 2], r"the text '1' at index \(0,\)"),
        ([1, "b"], r"the text 'b' at index \(1,\)"),
        (None, "None"),
        ([[1, 2], [3, None]], r"None at index \(1, 1\)"),
        ({}, "a dict"),
        (np.array([1j]), "dtype complex128"),
    ],
)
def test_what_is_not_a_number_is_named_with_its_index(value, found):
    with pytest.raises(TypeError, match=rf"g must be real numbers \(int or float\), got {found}$"):
        ph.torque.damping(value)
    with pytest.raises(
        TypeError, match="the force's F must be an array of real numbers; the rows have unequal"
    ):
        ph.force.constant([[1, 2], [3]])


def test_text_that_cannot_be_encoded_is_an_error_of_the_formula():
    for call in (ph.evaluate, ph.formula, ph.torque.formula, ph.event.formula):
        with pytest.raises(ph.FormulaError, match=r"'\\udcff' is half of a character") as caught:
            call("a\udcff")
        assert caught.value.span == (1, 2)
        assert str(caught.value).encode()


def test_a_key_of_jax_and_text_for_a_number_are_named(tmp_path):
    jax = pytest.importorskip("jax")
    for key in (jax.random.key(0), jax.random.PRNGKey(0)):
        with pytest.raises(TypeError, match=r"got a key of JAX; pass its normal .*from_components"):
            ph.Rotor.random(3, rng=key)
    (tmp_path / "a.obj").write_text("")
    with pytest.raises(TypeError, match="the scale must be a number in SI units, got the text 'km'"):
        ph.Body.from_mesh(tmp_path / "a.obj", density=1, scale="km")
    with pytest.raises(
        ValueError, match="rng must be a NumPy generator, a whole number >= 0 or None, got -1"
    ):
        ph.Rotor.random(3, rng=-1)
    with pytest.raises(TypeError, match=r"got a Body; write body\.inertia"):
        ph.jax.free(ph.Body.sphere(1, mass=1), ph.Rotor.identity(), [0, 0, 1], 1.0)
