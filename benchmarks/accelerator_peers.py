"""Free rigid bodies in other libraries on a GPU, for `accelerator.py`: MJX, and a kernel in Warp.

Each function returns a run of equal classical Runge–Kutta steps, which ends when the device is done, and a
function that reads the final rotors and angular velocities. The rotor (s, x, y, z) is the unit quaternion
(s, −x, −y, −z). The kernel in Warp is what a user would write: a thread per body, its state in registers.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

Run = tuple[Callable[[], Any], Callable[[], tuple[Any, Any]]]

_BODY = """
<mujoco>
  <option timestep="{h}" gravity="0 0 0" integrator="RK4">
    <flag contact="disable" constraint="disable"/>
  </option>
  <worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{moments}"/></body></worldbody>
</mujoco>
"""


def mjx(moments: Any, rotors: Any, omegas: Any, h: float, steps: int) -> Run:
    """Return a run of MJX: `mjx.step` over a batch, in one compiled loop."""
    import jax
    import mujoco
    from mujoco import mjx

    # MJX takes the type of its data from this setting.
    double = rotors.dtype == np.float64
    with jax.enable_x64(double):
        model = mujoco.MjModel.from_xml_string(_BODY.format(h=h, moments=" ".join(map(str, moments))))
        model = mjx.put_model(model)
        still = mjx.make_data(model)
    signs = np.array([1, -1, -1, -1], rotors.dtype)

    @jax.jit
    def moved(rotors: Any, omegas: Any) -> tuple[Any, Any]:
        def one(rotor: Any, omega: Any) -> Any:
            place = jax.numpy.zeros(3, rotor.dtype)
            places = jax.numpy.concatenate([place, rotor * signs])
            data = still.replace(qpos=places, qvel=jax.numpy.concatenate([place, omega]))
            return jax.lax.fori_loop(0, steps, lambda _, data: mjx.step(model, data), data)

        data = jax.vmap(one)(rotors, omegas)
        return data.qpos[:, 3:] * signs, data.qvel[:, 3:]

    def run() -> tuple[Any, Any]:
        with jax.enable_x64(double):
            return jax.block_until_ready(moved(rotors, omegas))  # type: ignore[no-any-return]

    with jax.enable_x64(double):
        rotors, omegas = jax.device_put((rotors, omegas))
    return run, run


def warp(moments: Any, rotors: Any, omegas: Any, h: float, steps: int) -> Run:
    """Return a run of a kernel in Warp, which takes all steps of a body."""
    import warp as wp

    wp.config.quiet = True
    wp.set_module_options({"enable_backward": False})
    double = rotors.dtype == np.float64
    real = wp.float64 if double else wp.float32
    vec3, quat = (wp.vec3d, wp.quatd) if double else (wp.vec3f, wp.quatf)

    @wp.func
    def attitude_rate(q: quat, w: vec3):  # type: ignore[no-untyped-def, valid-type]
        return (q * quat(w[0], w[1], w[2], real(0.0))) * real(0.5)

    @wp.func
    def spin_rate(k: vec3, w: vec3):  # type: ignore[no-untyped-def, valid-type]
        return vec3(k[0] * w[1] * w[2], k[1] * w[2] * w[0], k[2] * w[0] * w[1])

    @wp.kernel
    def walk(  # type: ignore[no-untyped-def]
        k: vec3,  # type: ignore[valid-type]
        qs: wp.array(dtype=quat),  # type: ignore[valid-type]
        ws: wp.array(dtype=vec3),  # type: ignore[valid-type]
        q_ends: wp.array(dtype=quat),  # type: ignore[valid-type]
        w_ends: wp.array(dtype=vec3),  # type: ignore[valid-type]
        h: real,  # type: ignore[valid-type]
        steps: int,
    ):
        i = wp.tid()
        q = qs[i]
        w = ws[i]
        half = h * real(0.5)
        for _step in range(steps):
            a1 = attitude_rate(q, w)
            b1 = spin_rate(k, w)
            w2 = w + b1 * half
            a2 = attitude_rate(q + a1 * half, w2)
            b2 = spin_rate(k, w2)
            w3 = w + b2 * half
            a3 = attitude_rate(q + a2 * half, w3)
            b3 = spin_rate(k, w3)
            w4 = w + b3 * h
            a4 = attitude_rate(q + a3 * h, w4)
            b4 = spin_rate(k, w4)
            sixth = h / real(6.0)
            q = wp.normalize(q + (a1 + a4 + (a2 + a3) * real(2.0)) * sixth)
            w = w + (b1 + b4 + (b2 + b3) * real(2.0)) * sixth
        q_ends[i] = q
        w_ends[i] = w

    i, j, k = moments
    couplings = vec3((j - k) / i, (k - i) / j, (i - j) / k)
    # Warp has the scalar last.
    given = [wp.array(rotors[:, [1, 2, 3, 0]] * [-1, -1, -1, 1], dtype=quat), wp.array(omegas, dtype=vec3)]
    ends = [wp.empty_like(x) for x in given]

    def run() -> None:
        wp.launch(walk, dim=len(rotors), inputs=[couplings, *given], outputs=[*ends, real(h), steps])
        wp.synchronize()

    def read() -> tuple[Any, Any]:
        q, w = (x.numpy() for x in ends)
        return q[:, [3, 0, 1, 2]] * [1, -1, -1, -1], w

    return run, read
