"""Summaries of runs: facts that depend on samples, and their text."""

from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from polhode._report.summary import as_text, summary

EXAMPLES = Path(__file__).parents[2] / "examples"


def summary_with(name, tmp_path, **changes):
    """The summary of an example with some fields changed."""
    text = (EXAMPLES / name).read_text().replace("t-handle.stl", str(EXAMPLES / "t-handle.stl"))
    for field, value in changes.items():
        lines = [
            f"{field} = {value}" if line.startswith(f"{field} =") else line for line in text.splitlines()
        ]
        text = "\n".join(lines)
    path = tmp_path / "scene.toml"
    path.write_text(text)
    scene = ph.Scene.read(path)
    return summary(scene, scene.run())


def test_precession_is_unknown_for_sparse_samples(tmp_path):
    # Off the axis of symmetry the top has no closed form, whose precession is known without samples.
    beside = {"heavy": "[0.05, 0, 3]", "duration": 5}
    followed = summary_with("kovalevskaya.toml", tmp_path, **beside)
    assert followed["motion"]["kind"] == "heavy"
    assert followed["motion"]["precession_rate"] is not None
    sparse = summary_with("kovalevskaya.toml", tmp_path, **beside, samples=2)
    assert sparse["motion"]["precession_rate"] is None
    assert "too far apart" in as_text(sparse)


def test_flips_are_not_counted_in_sparse_samples(tmp_path):
    assert summary_with("t-handle.toml", tmp_path)["motion"]["reversals"]["count"] == 9
    sparse = summary_with("t-handle.toml", tmp_path, samples=12)
    assert sparse["motion"]["reversals"] is None
    assert "sampled" not in as_text(sparse)


def test_titles_are_printed_without_control_characters(tmp_path):
    result = summary_with("toutatis.toml", tmp_path, title='"a\\u001b[31mb"')
    assert "\x1b" not in as_text(result)


def test_bodies_and_torques_add_up_with_sum():
    a, b = ph.Body.sphere(1.0, mass=1.0), ph.Body.sphere(0.5, mass=2.0).moved(position=[1, 0, 0])
    assert sum([a, b]) == a + b
    assert a + b != b
    laws = [ph.torque.damping(0.1), ph.torque.constant_body([1, 0, 0])]
    assert sum(laws) == laws[0] + laws[1]


def test_forces_on_held_bodies_are_refused():
    body, state = ph.Body.sphere(1.0, mass=1.0), ph.State(ph.Rotor.identity(), [0, 0, 1])
    with pytest.raises(ValueError, match="fixed point"):
        ph.simulate(body, state, [1.0], ph.torque.heavy([0, 0, 1]), force=[0, 0, -9.8])
    with pytest.raises(ValueError, match="3 components"):
        ph.simulate(body, state, [1.0], force=np.eye(2))
