"""Calls of the public functions of mechanics with arrays of numbers, for tests over kinds of input."""

import inspect
import tempfile
from pathlib import Path

import numpy as np

import polhode as ph
from algebra_calls import Call, numbers, positive, rotor, turns
from polhode import event, force, io, torque

MOMENTS = np.array([1.0, 1.5, 2.0])
OMEGA = np.array([0.4, 2.0, 0.3])
TIMES = np.array([0.0, 0.25, 0.5, 1.0])
ONE, TURN, PLACE = np.array(1.25), turns(), numbers(3)
_SYMMETRIC = np.array([2.0, 2.0, 1.0])
_SAMPLES = np.linspace(0, 5, 41)
_SIZES = np.array([1.0, 1.25, 1.5])


def inertia(moments=MOMENTS):
    return ph.Inertia.from_principal_moments(*np.moveaxis(np.asanyarray(moments), -1, 0))


def body(mass=1.5):
    return ph.Body(mass, inertia())


def state(omega=OMEGA, **others):
    return ph.State(rotor(TURN), omega, **others)


def run(law=None, strength=None, times=TIMES, omega=OMEGA, place=0.0, **options):
    """A motion; laws far beyond their units end with an error that names the number of steps."""
    begin = state(omega, position=place)
    return ph.simulate(body(), begin, times, law, strength, rtol=1e-6, max_steps=1e5, **options)


def _free(omega=OMEGA, moments=MOMENTS):
    return ph.FreeMotion(inertia(moments), rotor(TURN), omega)


def _value(owner, name):
    if isinstance(owner, np.ndarray):  # of inertias
        return [_value(one, name) for one in owner.ravel()]
    found = getattr(owner, name)
    return found() if inspect.isroutine(found) else found


def _solved(name, make):
    """The states of a motion in closed form."""
    return {
        f"{name}.at": Call(lambda t: make().at(t), (TIMES,)),
        f"{name}.at_each": Call(lambda t: make().at_each(t), (TIMES,)),
    }


def _solid(name, *sizes):
    return Call(lambda *given: getattr(ph.Body, name)(*given, mass=2.0), tuple(map(np.array, sizes)))


def _law(make, *arrays):
    """A torque: its value on one state."""
    return Call(lambda *given: make(*given).at(inertia(), state(), 0.5), tuple(map(np.array, arrays)))


def _force(make, *arrays):
    return Call(lambda *given: run(strength=make(*given)), tuple(map(np.array, arrays)))


def _event(make, *arrays):
    return Call(lambda *given: run(events=make(*given)), tuple(map(np.array, arrays)))


def _of(make, kind, names, *arrays):
    """Attributes and methods without arguments of a value made from arrays."""
    return {
        f"{kind}.{name}": Call(lambda *given, name=name: _value(make(*given), name), arrays)
        for name in names.split()
    }


def _written(write, *arrays):
    """The lines of the file that a function writes, but the one with the time of writing."""

    def call(*given):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "out.aem"
            write(path, *given)
            lines = path.read_bytes().splitlines()
            return b"\n".join(line for line in lines if not line.startswith(b"CREATION_DATE"))

    return Call(call, arrays)


def _stepped(dt, kick):
    stepper = ph.Stepper(body(), state())
    stepper.step(dt, torque=kick)
    return stepper


def _fit(times, rates):
    return ph.fit(rates=(times, rates), sigma_rates=1e-3)


def _history(times, turned, omega):
    return io.AttitudeHistory(times, rotor(turned), ph.bivector(omega))


def _wheels(axes, inertias, torques):
    return torque.reaction_wheels(axes, inertias, torques)


_RATES = _free().at(_SAMPLES).omega_body.components
_MOMENTS_ADDED = numbers(5, 3)
_TURNS, _OMEGAS = turns(4), numbers(4, 3)

CALLS = {
    "Inertia": Call(lambda m, b: inertia(m)(ph.bivector(b)), (MOMENTS, numbers(4, 3))),
    "Inertia.from_principal_moments": Call(lambda m: inertia(m), (MOMENTS,)),
    "Inertia.from_matrix": Call(ph.Inertia.from_matrix, (np.diag(MOMENTS) + 0.1,)),
    "Inertia.from_function": Call(lambda m: ph.Inertia.from_function(lambda b: b * ph.scalar(m)), (ONE,)),
    "Inertia.from_points": Call(ph.Inertia.from_points, (positive(5), numbers(5, 3))),
    **_of(inertia, "Inertia", "inverse matrix principal_moments principal_frame eigenplanes", MOMENTS),
    "Body": Call(lambda m, x: ph.Body(m, inertia(), x), (ONE, PLACE)),
    "Body.box": _solid("box", _SIZES),
    "Body.ellipsoid": _solid("ellipsoid", _SIZES),
    "Body.sphere": _solid("sphere", 1.25),
    "Body.hollow_sphere": _solid("hollow_sphere", 1.25, 0.5),
    "Body.cylinder": _solid("cylinder", 1.25, 0.5),
    "Body.cone": _solid("cone", 1.25, 0.5),
    "Body.rod": _solid("rod", 1.25),
    "Body.disc": _solid("disc", 1.25),
    "Body.torus": _solid("torus", 1.25, 0.5),
    "Body.capsule": _solid("capsule", 1.25, 0.5),
    "Body.from_points": Call(ph.Body.from_points, (positive(5), numbers(5, 3))),
    **_of(lambda m: ph.Body(m, inertia(), PLACE), "Body", "mass center_of_mass inertia", ONE),
    "Body.inertia_about": Call(lambda x: body().inertia_about(x), (PLACE,)),
    "Body.moved": Call(lambda r, x: body().moved(rotor(r), x), (TURN, PLACE)),
    "State": Call(
        lambda r, w, x, v, t: ph.State(rotor(r), w, x, v, time=t), (TURN, OMEGA, PLACE, numbers(3), ONE)
    ),
    **_of(state, "State", "shape omega_space transform", OMEGA),
    "FreeMotion": Call(lambda r, w, t: ph.FreeMotion(inertia(), rotor(r), w).at(t), (TURN, OMEGA, TIMES)),
    "FreeMotion.describe": Call(lambda w: _free(w).describe(), (OMEGA,)),
    "FreeMotion.polhode": Call(lambda w: _free(w).polhode(9), (OMEGA,)),
    "FreeMotion.herpolhode": Call(lambda w: _free(w).herpolhode(9), (OMEGA,)),
    "FreeMotion.derivatives": Call(lambda t: _free().derivatives(t), (TIMES,)),
    "FlowDerivatives": Call(lambda w: _free(w).derivatives(0.5), (OMEGA,)),
    "SymmetricTop": Call(
        lambda w, t: ph.SymmetricTop(inertia(_SYMMETRIC), rotor(TURN), w).at(t), (OMEGA, TIMES)
    ),
    **_of(
        lambda w: ph.SymmetricTop(inertia(_SYMMETRIC), rotor(TURN), w),
        "SymmetricTop",
        "omega_l omega_r",
        OMEGA,
    ),
    "SymmetricTop.at": Call(
        lambda t: ph.SymmetricTop(inertia(_SYMMETRIC), rotor(TURN), OMEGA).at(t), (TIMES,)
    ),
    "DampedTop": Call(
        lambda w, g, t: ph.DampedTop(inertia(), rotor(TURN), w, g).at(t), (OMEGA, np.array(0.1), TIMES)
    ),
    "LarmorSphere": Call(
        lambda w, b, t: ph.LarmorSphere(inertia(np.ones(3)), rotor(TURN), w, b).at_each(t),
        (numbers(4, 3), PLACE, TIMES),
    ),
    "LagrangeTop": Call(
        lambda w, c, t: ph.LagrangeTop(inertia(_SYMMETRIC), rotor(TURN), w, c).at(t),
        (OMEGA, np.array([0.0, 0.0, 0.5]), TIMES),
    ),
    "LagrangeTop.describe": Call(
        lambda w: ph.LagrangeTop(inertia(_SYMMETRIC), rotor(TURN), w, [0, 0, 0.5]).describe(), (OMEGA,)
    ),
    **_solved("FreeMotion", _free),
    **_solved("DampedTop", lambda: ph.DampedTop(inertia(), rotor(TURN), OMEGA, 0.1)),
    **_solved("LarmorSphere", lambda: ph.LarmorSphere(inertia(np.ones(3)), rotor(TURN), OMEGA, PLACE)),
    **_solved("LagrangeTop", lambda: ph.LagrangeTop(inertia(_SYMMETRIC), rotor(TURN), OMEGA, [0, 0, 0.5])),
    "describe_free": Call(lambda w: ph.describe_free(inertia(), w), (OMEGA,)),
    "omega_from_periods": Call(
        lambda m: ph.omega_from_periods(m, 5.41, 7.35, mode="long"), (np.array([3.09, 3.22, 1.0]),)
    ),
    "Moments": Call(lambda x: ph.Moments().add(x).add(x).variance, (_MOMENTS_ADDED,)),
    "Moments.add": Call(lambda x: ph.Moments(-1).add(x).mean, (_MOMENTS_ADDED,)),
    **_of(
        lambda x: ph.Moments().add(x),
        "Moments",
        "count missing mean variance std minimum maximum",
        _MOMENTS_ADDED,
    ),
    "simulate": Call(lambda w, t: ph.simulate(inertia(), state(w), t), (numbers(4, 3), TIMES)),
    "simulate_blocks": Call(
        lambda w, t: [found for _, found in ph.simulate_blocks(inertia(), state(w), t, block=3)],
        (numbers(4, 3), TIMES),
    ),
    "Trajectory": Call(lambda w: run(torque.damping(0.1), omega=w, step=0.125), (OMEGA,)),
    **_of(
        lambda w: run(omega=w),
        "Trajectory",
        "shape ok omega_space momentum_body final drifts time energy",
        OMEGA,
    ),
    "Trajectory.at": Call(lambda t: run(omega=OMEGA).at(t), (TIMES * 0.9,)),
    "Stepper": Call(lambda w: ph.Stepper(body(), state(w)).step(0.25), (OMEGA,)),
    "Stepper.step": Call(lambda dt, n: _stepped(dt, n).state, (np.array(0.25), PLACE)),
    **_of(_stepped, "Stepper", "time state shape", np.array(0.25), PLACE),
    "Stepper.reset": Call(lambda w: _stepped(0.25, PLACE).reset(state(w)), (OMEGA,)),
    "fit": Call(lambda t, w: _fit(t, w).values, (_SAMPLES, _RATES)),
    "torque.Torque": _law(lambda g: torque.damping(g) + torque.gyrostat([0, 0, 1]), 0.1),
    "torque.Torque.at": Call(lambda w: torque.damping(0.1).at(inertia(), state(w)), (OMEGA,)),
    "torque.KeplerOrbit": Call(
        lambda a, t: torque.KeplerOrbit(a, 0.1).position(t), (np.array(7e6), TIMES * 1000)
    ),
    "torque.KeplerOrbit.rate": Call(lambda a: torque.KeplerOrbit(a).rate, (np.array(7e6),)),
    "torque.KeplerOrbit.period": Call(lambda a: torque.KeplerOrbit(a).period, (np.array(7e6),)),
    "torque.KeplerOrbit.position": Call(lambda t: torque.KeplerOrbit(7e6, 0.2).position(t), (TIMES * 1000,)),
    "torque.KeplerOrbit.velocity": Call(lambda t: torque.KeplerOrbit(7e6, 0.2).velocity(t), (TIMES * 1000,)),
    "torque.constant_body": _law(torque.constant_body, PLACE),
    "torque.constant_space": _law(torque.constant_space, PLACE),
    "torque.damping": _law(torque.damping, 0.1),
    "torque.dipole_field": _law(
        lambda m: torque.magnetic(PLACE, torque.dipole_field(m), _ORBIT), [0, 0, -8e15]
    ),
    "torque.formula": _law(lambda c: torque.formula("c ∧ e3", c=ph.vector(c)), PLACE),
    "torque.function": _law(lambda c: torque.function(lambda t, R, w: c * w), 0.5),
    "torque.gravity": _law(lambda g, x: torque.gravity(body(), g, x), 9.81, PLACE),
    "torque.gravity_gradient": _law(torque.gravity_gradient, 1.1, 0.1, 0.2),
    "torque.gyrostat": _law(torque.gyrostat, PLACE),
    "torque.heavy": _law(torque.heavy, PLACE),
    "torque.larmor": _law(torque.larmor, PLACE),
    "torque.magnetic": _law(torque.magnetic, PLACE, [0.0, 1e-5, 2e-5]),
    "torque.pd_control": _law(torque.pd_control, 1.5, 0.5),
    "torque.quadratic_damping": _law(torque.quadratic_damping, 0.2),
    "torque.radiation_pressure": _law(torque.radiation_pressure, 2.0, PLACE, [1.0, 0, 0]),
    "torque.reaction_wheels": _law(_wheels, np.eye(3), [0.1, 0.1, 0.2], [0.1, 0.2, 0.3]),
    "torque.tabulated": _law(torque.tabulated, [0.0, 0.5, 1.0], numbers(3, 3)),
    "torque.torsion_spring": _law(torque.torsion_spring, 0.5),
    "torque.viscous_damping": _law(torque.viscous_damping, 0.25),
    "force.Force": _force(lambda k: force.drag(k) + force.constant([0, 0, -1]), 0.1),
    "force.Force.at": Call(lambda v: force.drag(0.1).at(body(), state(velocity=v)), (PLACE,)),
    "force.central": Call(lambda k: run(strength=force.central(k), place=PLACE), (ONE,)),
    "force.constant": _force(force.constant, PLACE),
    "force.drag": _force(force.drag, 0.5),
    "force.formula": _force(lambda k: force.formula("-k v", k=k), 0.5),
    "force.function": _force(lambda k: force.function(lambda t, x, v, R: k * v), 0.5),
    "force.quadratic_drag": _force(force.quadratic_drag, 0.5),
    "force.spring": _force(force.spring, 0.5, PLACE),
    "force.thrust": _force(force.thrust, PLACE, PLACE[::-1].copy()),
    "event.Event": _event(lambda n: event.plane(ph.e1, n), PLACE),
    "event.angle": _event(lambda n, a: event.angle(ph.e1, ph.vector(n), a), PLACE, 0.5),
    "event.formula": _event(lambda k: event.formula("t - k", k=k), 0.5),
    "event.function": _event(lambda k: event.function(lambda t, R, w, x, v: t - float(k)), 0.5),
    "event.plane": _event(lambda a, n: event.plane(ph.vector(a), ph.vector(n)), PLACE, PLACE[::-1].copy()),
    "event.position": _event(lambda n, d: event.position(n, d), PLACE, 0.1),
    "event.spin": _event(lambda n, d: event.spin(ph.bivector(n), d), PLACE, 0.5),
    "io.AttitudeHistory": Call(_history, (TIMES, _TURNS, _OMEGAS)),
    "io.AttitudeHistory.trajectory": Call(
        lambda t, r, w: _history(t, r, w).trajectory(body()), (TIMES, _TURNS, _OMEGAS)
    ),
    "io.solid_surface": Call(lambda r: io.solid_surface("sphere", r), (ONE,)),
    "io.FrameVector.fixed": Call(lambda v: io.FrameVector.fixed("X", v, "J2000"), (PLACE,)),
    "io.write": _written(
        lambda path, t, r, w: io.write(_history(t, r, w), path, **_AEM),
        TIMES,
        _TURNS,
        _OMEGAS,
    ),
}
_AEM = {
    "epoch": "2000-01-01T00:00:00",
    "time_system": "UTC",
    "reference_frame": "EME2000",
    "body_frame": "SC",
}
_ORBIT = torque.KeplerOrbit(7e6)
# No arrays of numbers among the arguments, or none but those of a value that another call makes.
WITHOUT_NUMBERS = """
    Body.from_mesh Certificate Certificate.conserved Certificate.drift Certificate.error_estimate
    Certificate.evaluations Certificate.method Certificate.norm_drift Certificate.step Certificate.steps
    Certificate.warnings Certificate.worst Crossings Crossings.rising Crossings.states Crossings.time
    DampedTop.shape DampedTop.view Failure Fit Fit.covariance Fit.interval Fit.plot Fit.residuals Fit.state
    Fit.stderr Fit.summary Fit.times Fit.to_dict Fit.values FlowDerivatives.d_omega_d_moments
    FlowDerivatives.d_omega_d_omega FlowDerivatives.d_omega_dt FlowDerivatives.d_rotor_d_attitude
    FlowDerivatives.d_rotor_d_moments FlowDerivatives.d_rotor_d_omega FlowDerivatives.d_rotor_dt
    FreeMotion.shape FreeMotion.view Inertia.algebra Inertia.grade Inertia.identity LagrangeTop.shape
    LagrangeTop.view LarmorSphere.shape LarmorSphere.view ReducedEnsemble ReducedEnsemble.to_xarray Scene
    Scene.alone Scene.block Scene.block_of_motions Scene.elapsed Scene.held Scene.kind Scene.name Scene.read
    Scene.reduce Scene.result_bytes Scene.run Scene.run_blocks Scene.shift Scene.surface Scene.times
    Scene.view SceneError Stepper.wheel_speed Trajectory.events Trajectory.failures Trajectory.film
    Trajectory.plot Trajectory.read Trajectory.save Trajectory.to_dataframe Trajectory.to_xarray
    Trajectory.view Trajectory.wheel_momentum Trajectory.wheel_speed event.Event.name force.Force.shape
    io.AttitudeHistory.energy io.AttitudeHistory.inertia io.AttitudeHistory.momentum_space
    io.AttitudeHistory.of io.AttitudeHistory.omega_body io.AttitudeHistory.position
    io.AttitudeHistory.velocity io.AttitudeHistory.wheel_speed io.CkFrame io.FileError io.FrameVector
    io.FrameVector.position io.FrameVector.velocity io.TwoVectorFrame io.read io.read_aem io.read_ck
    io.read_csv io.read_mesh io.read_netcdf io.read_parquet io.read_zarr io.write_aem io.write_ck io.write_fk
    io.write_gltf io.write_mjcf io.write_sclk io.write_stl io.write_urdf read_mjcf read_sdf read_urdf
    torque.KeplerOrbit.eccentricity torque.KeplerOrbit.mean_anomaly torque.KeplerOrbit.mu torque.Torque.holds
    torque.Torque.shape view
"""
