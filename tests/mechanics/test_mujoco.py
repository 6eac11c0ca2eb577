"""Free bodies of MuJoCo, which integrates them by RK4, and ours agree, tumbling and falling."""

import numpy as np
import pytest

import polhode as ph

mujoco = pytest.importorskip("mujoco")

# A box whose axes and centre of mass are not those of the body, so that all of the file counts.
TURN = ph.Rotor.from_euler("ZYX", [30, 40, 50], degrees=True)
BODY = ph.Body.box([1, 2, 3], mass=5).moved(TURN, [0.1, -0.2, 0.3])
# Near the intermediate axis: it flips within the time.
SPINS = {"flip": TURN(ph.bivector([0.01, 1.5, 0.02])), "tumble": ph.bivector([0.5, 1.0, -0.3])}
ATTITUDE = ph.Rotor.from_euler("ZYX", [10, -20, 70], degrees=True)
VELOCITY, GRAVITY = np.array([0.3, -0.2, 2.0]), np.array([0.0, 0.0, -9.81])
DURATION, STEP = 8.0, 0.01


def by_mujoco(path, omega, step):
    """Attitude, angular velocity, angular momentum about the centre of mass, and its place, at the end."""
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.gravity, model.opt.timestep = GRAVITY, step
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data = mujoco.MjData(model)
    data.qpos[3:] = ATTITUDE.to_quaternion(order="wxyz")
    # MuJoCo's velocity is that of the origin of the body axes, its angular velocity in these axes.
    arm = ATTITUDE(BODY.center_of_mass)
    data.qvel[:3] = VELOCITY - np.cross(ATTITUDE(omega).components, arm.components)
    data.qvel[3:] = omega.components
    for _ in range(round(DURATION / step)):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    rotor = ph.Rotor.from_quaternion(data.qpos[3:], order="wxyz")
    return rotor, data.qvel[3:].copy(), data.subtree_angmom[1].copy(), data.xipos[1].copy()


@pytest.mark.parametrize("spin", SPINS)
def test_free_bodies_agree(spin, tmp_path):
    """With half the step, MuJoCo's distance from our exact motion falls 16-fold, by its order of 4."""
    ph.io.write_mjcf(BODY, tmp_path / "a.xml")
    omega = SPINS[spin]
    place = ATTITUDE(BODY.center_of_mass).components
    start = ph.State(ATTITUDE, omega, position=place, velocity=VELOCITY)
    ours = ph.simulate(BODY, start, [0, DURATION], force=ph.force.constant(BODY.mass * GRAVITY)).final
    expected = (
        ours.omega_body.components,
        ours.rotor(BODY.inertia(ours.omega_body)).components,
        ours.position.components,
    )
    coarse, fine = (
        np.array(
            [rotor.distance(ours.rotor), *(np.abs(a - b).max() for a, b in zip(rest, expected, strict=True))]
        )
        for rotor, *rest in (by_mujoco(tmp_path / "a.xml", omega, h) for h in (STEP, STEP / 2))
    )
    # The order is 4 only if both converge to the same motion. Numbers up to 2 (Ω), 10 (L) and 300 (the place)
    # are rounded at 1600 steps, at random: 40 times.
    rounding = 40 * 2.0**-53 * np.array([1, 2, 10, 300])
    assert (fine <= coarse / 15 + rounding).all(), (coarse, fine)
    # What is left is as small as the step has it: (Ω h)⁴, times the angle of 12 rad.
    assert fine[0] < 12 * (1.5 * STEP / 2) ** 4
