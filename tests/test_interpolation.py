"""Between rotors: slerp and the mean attitude."""

import numpy as np
import pytest

import polhode as ph
from polhode import e1, e2, e3

EPS = np.finfo(float).eps


def test_slerp_turns_at_a_constant_rate():
    start = ph.Rotor.random(rng=1)
    end = ph.Rotor.from_plane_angle(e1 ^ e2, 2.0) * start
    for t in (-0.5, 0.0, 0.25, 1.0, 2.0):
        expected = ph.Rotor.from_plane_angle(e1 ^ e2, 2.0 * t) * start
        # The angle is known to a few roundings, and turns by t times as much.
        assert (ph.slerp(start, end, t) - expected).norm() <= 8 * EPS * (1 + abs(t))


def test_slerp_goes_the_shorter_way_whatever_the_signs():
    rotors = ph.Rotor.random(50, rng=2)
    a, b = rotors[:25], rotors[25:]
    half = ph.slerp(a, b, 0.5)
    for sign_a in (1, -1):
        for sign_b in (1, -1):
            turned = ph.slerp(a if sign_a > 0 else -a, b if sign_b > 0 else -b, 0.5)
            assert (turned(e1) - half(e1)).norm().max() <= 32 * EPS
    # Half way is as far from both, and no farther than a quarter turn.
    for other in (a, b):
        angle = (~half * other).plane_angle()[1]
        assert np.minimum(angle, 2 * np.pi - angle).max() <= np.pi / 2 + 8 * EPS


def test_slerp_broadcasts():
    start, end = ph.Rotor.identity(), ph.Rotor.from_plane_angle(e2 ^ e3, 1.0)
    path = ph.slerp(start, end, np.linspace(0, 1, 5))
    assert path.shape == (5,)
    assert path[0] == start
    assert path[4].is_close(end, rtol=4 * EPS)
    with pytest.raises(TypeError, match="between rotors"):
        ph.slerp(start, e1, 0.5)


def test_the_mean_ignores_signs_and_finds_the_middle():
    middle = ph.Rotor.random(rng=3)
    middle = middle if middle.components[0] >= 0 else -middle
    turns = [
        ph.Rotor.from_plane_angle(plane, angle)
        for plane in (e1 ^ e2, e2 ^ e3, e3 ^ e1)
        for angle in (0.3, -0.3)
    ]
    rotors = ph.Rotor.from_components(
        [(turn * middle).components * (-1) ** k for k, turn in enumerate(turns)]
    )
    assert (ph.mean(rotors) - middle).norm() <= 16 * EPS


def test_weights_pull_the_mean():
    a, b = ph.Rotor.identity(), ph.Rotor.from_plane_angle(e1 ^ e2, 1.0)
    pair = ph.Rotor.from_components([a.components, b.components])
    assert (ph.mean(pair) - ph.slerp(a, b, 0.5)).norm() <= 16 * EPS
    assert (ph.mean(pair, [0, 2]) - b).norm() <= 16 * EPS
    assert ph.mean(pair, [1, 3])(e1).dot(b(e1)).components > ph.mean(pair)(e1).dot(b(e1)).components


def test_there_may_be_no_mean():
    half_turns = ph.Rotor.from_components(np.eye(4))
    with pytest.raises(ValueError, match="no mean"):
        ph.mean(half_turns)
    with pytest.raises(ValueError, match="weights"):
        ph.mean(half_turns, [1, -1, 1, 1])
    with pytest.raises(ValueError, match=r"shape \(n,\)"):
        ph.mean(ph.Rotor.identity())
