"""The core as WebAssembly against the core in Python: the same states, errors, changes of scenes and lines of algebra."""

import json

import numpy as np
import pytest

import polhode as ph
from node_core import Problem, packed
from viewer_scenes import FILES, METHODS, PRESETS, RUN, SCENES, TUMBLING

EVERY = [*FILES, *PRESETS, *SCENES]


def agree(found, expected, followed):
    """Hold states to 1e-12 of the size of each quantity."""
    for name, values in expected.items():
        # A quantity that is zero throughout is zero in both.
        tolerance = 1e-12 * followed.scale(name)
        np.testing.assert_allclose(found[name], values, rtol=0, atol=tolerance, err_msg=name)


def files_of(followed):
    return {} if followed.mesh is None else {followed.mesh.name: packed(followed.mesh)}


@pytest.mark.parametrize("name", EVERY)
def test_states_are_those_of_python(name, core, follow):
    followed = follow(name)
    for times, expected in (followed.outputs(), followed.between()):
        _, found = core.motion(followed.text, times, files=files_of(followed))
        np.testing.assert_array_equal(found["time"], times)
        agree(found, expected, followed)
