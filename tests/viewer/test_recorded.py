"""What Python tells of a motion that it followed is what the core in the browser tells of it."""

import json
import re

import pytest

import polhode as ph
from polhode._viewer import document

BODY = '[body]\nsolid = "cone"\nradius = "3 cm"\nheight = "8 cm"\nmass = "0.2 kg"\n'
SPIN = '[initial]\nspin = { vector = [0.5, 0.1, "2 rev/s"] }\n'
RUN = '[run]\nduration = "1 s"\nsamples = 51\nmethod = "rk4"\nstep = "10 ms"\n'
SCENES = {
    "free": f'title = "Free"\n{BODY}{SPIN}{RUN}',
    "top": f'{BODY}{SPIN}[gravity]\nacceleration = 9.81\npivot = [0, 0, "-5 cm"]\n{RUN}',
    "moments": f"[body]\nmoments = [3, 1, 2.5]\n{SPIN}[torque]\nheavy = [0.1, 0, 2]\n{RUN}",
    "laws": f"{BODY}{SPIN}[torque]\nviscous_damping = 1e-7\n"
    "magnetic = { dipole = [1e-5, 0, 0], field = [0, 3, 0] }\n"
    f'torque_space = "-1e-7 Ω"\n{RUN}',
}
# Told in words of their own, or rounding alone.
OWN = {"method", "exact", "horizon", "laws", "conserved", "norm_drift", "error_estimate"}


@pytest.mark.parametrize("name", SCENES)
def test_the_same_is_told(name, core, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(SCENES[name], encoding="utf-8")
    trajectory = ph.Scene.read(path).run()
    told = json.loads(document.document(trajectory)["recorded"]["about"])
    expected, _ = core.motion(SCENES[name], [0.0], name="a.toml")
    assert set(told) == set(expected)
    for key in expected.keys() - OWN:
        assert told[key] == close(expected[key]), key
    assert list(map(law, told["laws"])) == list(map(law, expected["laws"]))
    for ours, theirs in zip(told["conserved"], expected["conserved"], strict=True):
        assert ours["name"] == theirs["name"]
        assert ours["value"] == close(theirs["value"])


def law(told):
    """The name of a law, and its formula or its numbers, which are written in several ways."""
    if told["name"].startswith("torque_"):
        return told
    return told["name"], told["text"].count("("), [float(x) for x in re.findall(r"[\d.e+-]+", told["text"])]


def close(value):
    """What is equal to a value but for the rounding of its numbers."""
    if isinstance(value, dict):
        return {name: close(x) for name, x in value.items()}
    if isinstance(value, list):
        return [close(x) for x in value]
    return pytest.approx(value, rel=1e-12, abs=1e-15) if isinstance(value, float) else value
