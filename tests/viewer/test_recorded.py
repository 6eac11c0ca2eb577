"""Recordings written by Python have the properties that the WebAssembly core finds."""

import json
import re

import pytest

import polhode as ph
from polhode._viewer import document

BODY = '[body]\nsolid = "cone"\nradius = "3 cm"\nheight = "8 cm"\nmass = "0.2 kg"\n'
SPIN = '[initial]\nspin = { vector = [0.5, 0.1, "2 rev/s"] }\n'
RUN = '[run]\nduration = "1 s"\nsamples = 51\nmethod = "rk4"\nstep = "10 ms"\n'
SCENES = {
    "free": f'title = "Free"\ncaption = "Nothing acts\\non it."\n{BODY}{SPIN}{RUN}',
    "top": f'{BODY}{SPIN}[gravity]\nacceleration = 9.81\npivot = [0, 0, "-5 cm"]\n{RUN}',
    "moments": f"[body]\nmoments = [3, 1, 2.5]\n{SPIN}[torque]\nheavy = [0.1, 0, 2]\n{RUN}",
    "laws": f"{BODY}{SPIN}[torque]\nviscous_damping = 1e-7\n"
    "magnetic = { dipole = [1e-5, 0, 0], field = [0, 3, 0] }\n"
    f'torque_space = "-1e-7 Ω"\n{RUN}',
}
# Worded differently, or only rounding errors.
OWN = {"method", "exact", "horizon", "laws", "conserved", "norm_drift", "error_estimate"}


@pytest.mark.parametrize("name", SCENES)
def test_properties_are_the_same(name, core, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(SCENES[name], encoding="utf-8")
    trajectory = ph.Scene.read(path).run()
    found = json.loads(document.document(trajectory)["recorded"]["about"])
    expected, _ = core.motion(SCENES[name], [0.0], name="a.toml")
    # The core finds no events in the page.
    assert set(found) - {"events"} == set(expected)
    for key in expected.keys() - OWN:
        assert found[key] == close(expected[key]), key
    assert list(map(law, found["laws"])) == list(map(law, expected["laws"]))
    for ours, theirs in zip(found["conserved"], expected["conserved"], strict=True):
        assert ours["name"] == theirs["name"]
        assert ours["value"] == close(theirs["value"])


def law(entry):
    """Return the name of a law with its formula or its numbers, which may be formatted differently."""
    if entry["name"].startswith("torque_"):
        return entry
    numbers = [float(x) for x in re.findall(r"[\d.e+-]+", entry["text"])]
    return entry["name"], entry["text"].count("("), numbers


def close(value):
    """Return a value that compares equal up to rounding errors."""
    if isinstance(value, dict):
        return {name: close(x) for name, x in value.items()}
    if isinstance(value, list):
        return [close(x) for x in value]
    return pytest.approx(value, rel=1e-12, abs=1e-15) if isinstance(value, float) else value
