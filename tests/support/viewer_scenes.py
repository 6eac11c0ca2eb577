"""Scenes of every kind, and their motions in Python."""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

import polhode as ph

ROOT = Path(__file__).parents[2]
FILES = {path.stem: path for path in sorted((ROOT / "examples").glob("*.toml"))}
PRESETS = {path.stem: path for path in sorted((ROOT / "viewer/src/presets").glob("*.toml"))}

TUMBLING = "[body]\nmoments = [1, 2, 3]\n[initial]\nspin = { vector = [0.3, 1, 0.2] }\n"
RUN = '[run]\nduration = "5 s"\nsamples = 51\n'
HELD = """\
[body]
moments = ["2 kg m^2", 2, 1]
mass = "4 kg"
center_of_mass = [0, 0, "0.5 m"]
[initial]
attitude = { plane = "e2e3", angle = "60 deg" }
spin = { plane = "e1e2", rate = "15 rad/s" }
[gravity]
acceleration = "9.81 m/s^2"
"""

# Torques on a tumbling body, each for five seconds.
TORQUES = {
    "damping": 'damping = "0.1 /s"',
    "viscous damping": "viscous_damping = [0.1, 0.2, 0.3]",
    "quadratic damping": "quadratic_damping = 0.05",
    "gravity gradient": "gravity_gradient = { rate = 0.5, eccentricity = 0.1 }",
    "magnetic": "magnetic = { dipole = [0.2, 0, 0.1], field = [0, 1, 2] }",
    "torsion spring": 'torsion_spring = { stiffness = 2, rest = { plane = "e1e2", angle = "10 deg" } }',
    "control": 'pd_control = { kp = [1, 2, 3], kd = 0.4, target = { plane = "e3e1", angle = "1 rad" } }',
    "gyrostat": "gyrostat = [0.5, 1, 0]",
    "constant in the body": "constant_body = [0.1, 0, 0.2]",
    "constant in space": "constant_space = [0, 0.1, 0]",
    "tabulated": "tabulated = { times = [0, 2, 6], torques = [[0, 0, 0.1], [0.2, 0, 0], [0, 0, 0]] }",
    "heavy": "heavy = [0.4, 0, 0.3]",
    "formula in the body": 'torque_body = "-0.1 Ω_B + 0.2 (R~ e3 R) ∧ e1 cos(t)"',
    "formula in space": 'torque_space = "-0.05 L + 0.1 I e3"',
    "sum": 'viscous_damping = 0.1\nconstant_space = [0, 0.1, 0]\ntorque_body = "0.1 e1e2 sin(2*t)"',
}
METHODS = ("strang", "yoshida4", "yoshida6", "kahan_li6", "kahan_li8", "rkn6", "rk4", "midpoint", "dmv")

SCENES = {
    "asymmetric": TUMBLING + RUN,
    "about the middle axis": TUMBLING.replace("[0.3, 1, 0.2]", "[1e-8, 1, 1e-8]")
    + RUN.replace("5 s", "90 s"),
    "separatrix": TUMBLING.replace("[0.3, 1, 0.2]", "[1.7320508075688772, 0, 1]") + RUN,
    "symmetric": TUMBLING.replace("1, 2, 3", "2, 2, 3") + RUN,
    "spherical": TUMBLING.replace("1, 2, 3", "2, 2, 2") + RUN,
    "at rest": TUMBLING.replace("[0.3, 1, 0.2]", "[0, 0, 0]") + RUN,
    "full inertia": TUMBLING.replace(
        "moments = [1, 2, 3]", "inertia = [[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]]"
    )
    + RUN,
    "spin in space": TUMBLING.replace(
        " }", ', frame = "space" }\nattitude = { plane = "e1e2 + e2e3", angle = "1 rad" }'
    )
    + RUN,
    "thrown": TUMBLING.replace("[body]", '[body]\nmass = "2 kg"')
    + 'position = [0, 0, 1]\nvelocity = [1, 0, 2]\n[force]\nconstant = "-19.62 e3"\n'
    + RUN,
    "lagrange": HELD + RUN,
    "sleeping": HELD.replace("60 deg", "0 deg") + RUN,
    "heavy asymmetric": HELD.replace('["2 kg m^2", 2, 1]', "[2, 2.5, 1]") + RUN,
} | {name: TUMBLING + f"[torque]\n{law}\n" + RUN for name, law in TORQUES.items()}
SPRING = TORQUES["torsion spring"]
BY_METHOD = {
    f"by {name}": TUMBLING + f'[torque]\n{SPRING}\n{RUN}[method]\nname = "{name}"\nstep = 0.01\n'
    for name in METHODS
}


@dataclass(frozen=True)
class Followed:
    """A scene with its files and its motion in Python."""

    path: Path
    text: str
    scene: ph.Scene
    motion: ph.Trajectory

    @property
    def mesh(self):
        """The mesh file of the body; None if it has none."""
        name = tomllib.loads(self.text)["body"].get("mesh")
        return None if name is None else self.path.parent / name

    def outputs(self, count=5):
        """Return output times from the first to the last, and the states at them by name."""
        picked = np.linspace(0, len(self.motion.time) - 1, count).astype(int)
        motion = self.motion
        states = quantities(motion.rotor[picked], motion.omega_body[picked], motion.momentum_space[picked])
        states |= {"energy": motion.energy[picked]}
        states |= {
            "position": motion.position[picked].components,
            "velocity": motion.velocity[picked].components,
        }
        return motion.time[picked], states

    def between(self, count=5):
        """Return unsorted times between the output times, and the states of `Trajectory.at` by name."""
        first, last = self.motion.time[[0, -1]]
        times = np.random.default_rng(1).uniform(first, last, count)
        state = self.motion.at(times)
        states = quantities(state.rotor, state.omega_body)
        return times, states | {"position": state.position.components, "velocity": state.velocity.components}

    def scale(self, quantity):
        """Return the largest magnitude of a quantity in the motion, to which its errors are relative."""
        motion = self.motion
        name = {"omega_space": "omega_body", "momentum_body": "momentum_space"}.get(quantity, quantity)
        values = getattr(motion, name)
        values = values if isinstance(values, np.ndarray) else np.linalg.norm(values.components, axis=-1)
        return np.abs(values).max()


def quantities(rotor, omega_body, momentum_space=None):
    """Return attitude, rates and momenta by name, as rows of components."""
    found = {"rotor": rotor, "omega_body": omega_body, "omega_space": rotor(omega_body)}
    if momentum_space is not None:
        found |= {"momentum_space": momentum_space, "momentum_body": (~rotor)(momentum_space)}
    return {name: value.components for name, value in found.items()}


@cache
def followed(name, folder):
    """Return the motion of an example, a preset or one of `SCENES` by name, computed once."""
    path = FILES.get(name) or PRESETS.get(name)
    return followed_at(path) if path else followed_text((SCENES | BY_METHOD)[name], folder / f"{name}.toml")


def followed_at(path):
    """Return the motion of a scene file."""
    scene = ph.Scene.read(path).alone()
    return Followed(path, path.read_text(), scene, scene.run())


def followed_text(text, path):
    """Return the motion of a scene text, which is written to a path."""
    path.write_text(text)
    return followed_at(path)
