"""Derivatives of the free flow against 30-digit differences, finite differences, and identities."""

import itertools
import json

import mpmath
import numpy as np
import pytest

import polhode as ph
from motions import EPS, R0, REFERENCE, moments

CASES = {
    "short axis": ((1, 2, 3), (0.25, -0.5, 1.0)),
    "long axis, odd order": ((2, 3, 1.5), (-0.25, 0.125, -1.5)),
    # A component that begins at 0, where elliptic functions are at the end of a quarter period.
    "no part along the longest": ((1, 2, 3), (0.0, -0.5, 1.0)),
    "no part along the shortest": ((1, 2, 3), (1.0, 0.5, 0.0)),
    "near the separatrix": ((1, 2, 2.25), (0.375, 0.5, 0.5000000000009095)),
    "separatrix": ((1, 2, 2.25), (0.375, 0.5, 0.5)),
    "separatrix, other branch": ((1, 2, 2.25), (-0.375, 0.5, 0.5)),
    "near the middle axis": ((1, 2, 2.5), (2**-20, 1.0, 2**-20)),
    "needle": ((1, 1000, 1000.5), (2.0, 0.5, 0.25)),
    "plate": ((1, 1, 2), (0.5, -0.25, 1.0)),
    "rod-like": ((2, 2, 1), (0.5, -0.25, 1.0)),
    "nearly a plate": ((1, 1 + 2**-33, 2), (0.5, -0.25, 1.0)),
    "nearly a sphere": ((1, 1 + 2**-33, 1 + 2**-32), (0.5, -0.25, 1.0)),
    "sphere": ((2, 2, 2), (0.5, -0.25, 1.0)),
    "tiny wobble": ((1, 2, 3), (2**-30, 2**-31, 1.0)),
    "long axis, steady": ((1, 2, 3), (-2.0, 0.0, 0.0)),
    "middle axis, steady": ((1, 2, 3), (0.0, 1.0, 0.0)),
    "symmetric, across": ((2, 2, 0.5), (3.0, 4.0, 0.0)),
    "rest": ((1, 2, 3), (0.0, 0.0, 0.0)),
}
every_case = pytest.mark.parametrize(("i", "w"), CASES.values(), ids=CASES.keys())
# The hardest of each kind; 30-digit differences of the others are slow.
HARDEST = (
    "short axis",
    "near the separatrix",
    "needle",
    "nearly a sphere",
    "tiny wobble",
    "symmetric, across",
    "rest",
)


def motion_of(i, w, rotor=R0):
    return ph.FreeMotion(moments(*i), rotor, ph.bivector(w))


def jacobian(motion, t):
    """Derivatives of (rotor, omega) by (omega, moments), (..., 7, 6)."""
    d = motion.derivatives(t)
    by_omega = np.concatenate([d.d_rotor_d_omega, d.d_omega_d_omega], axis=-2)
    by_moments = np.concatenate([d.d_rotor_d_moments, d.d_omega_d_moments], axis=-2)
    return np.concatenate([by_omega, by_moments], axis=-1)


def units(i, w):
    """Multiply a Jacobian's entries to make them pure numbers, (7, 6)."""
    spin = np.linalg.norm(w) or 1.0
    return np.concatenate([np.ones(4), np.full(3, 1 / spin)])[:, np.newaxis] * np.array([spin] * 3 + list(i))


def flow(i, w, r, t):
    """Rotor and angular velocity at t by Taylor series of order 30, steps of less than half a radian."""
    rate = mpmath.sqrt(mpmath.fsum(x * x for x in w))
    steps = int(mpmath.ceil(2.5 * abs(t) * rate)) + 1
    ratio = [(i[1] - i[2]) / i[0], (i[2] - i[0]) / i[1], (i[0] - i[1]) / i[2]]
    for _ in range(steps):
        W, R = [[x] for x in w], [[x] for x in r]

        def product(a, b):
            return mpmath.fdot(a, b[::-1])

        for k in range(1, 31):
            rates = [ratio[n] * product(W[(n + 1) % 3], W[(n + 2) % 3]) / k for n in range(3)]
            # R' = −½ R Ω.
            s, x, y, z = R
            a, b, c = W
            turn = [
                product(x, a) + product(y, b) + product(z, c),
                product(y, c) - product(z, b) - product(s, a),
                product(z, a) - product(x, c) - product(s, b),
                product(x, b) - product(y, a) - product(s, c),
            ]
            for column, value in zip(W + R, rates + [v / (2 * k) for v in turn], strict=True):
                column.append(value)
        w, r = ([mpmath.polyval(column[::-1], mpmath.mpf(t) / steps) for column in C] for C in (W, R))
    return r + w


@pytest.mark.parametrize(
    ("i", "w"),
    [
        pytest.param(*case, id=name, marks=() if name in HARDEST else pytest.mark.slow)
        for name, case in CASES.items()
    ],
)
def test_derivatives_to_every_digit(i, w):
    """Central differences of 2e-9 relative to the numbers changed, in 30 digits: the error is some 1e-18."""
    t = -4.0 / (np.linalg.norm(w) or 1.0)
    columns = []
    with mpmath.workdps(30):
        rotor = [mpmath.mpf(x) for x in R0.components]
        start = [mpmath.mpf(x) for x in (*w, *i)]
        for k in range(6):
            h = mpmath.mpf(10) ** -9 * (max(map(abs, start[:3])) or 1 if k < 3 else start[k])
            ends = []
            for sign in (1, -1):
                x = [value + sign * h * (j == k) for j, value in enumerate(start)]
                ends.append(flow(x[3:], x[:3], rotor, t))
            columns.append([float((a - b) / (2 * h)) for a, b in zip(*ends, strict=True)])
    expected = np.transpose(columns) * units(i, w)
    found = jacobian(motion_of(i, w), t) * units(i, w)
    # Each entry is a sum of a few products, of which those with the moments weigh the needle's by 1000.
    assert np.abs(found - expected).max() <= 64 * EPS * max(np.abs(expected).max(), 1.0)


def richardson(f, h):
    """Return a derivative by central differences with h … h/16, and what bounds its error."""
    row = [(f(h / 2**k) - f(-h / 2**k)) / (2 * h / 2**k) for k in range(5)]
    for p in range(1, 5):
        last, row = row, [(4**p * b - a) / (4**p - 1) for a, b in itertools.pairwise(row)]
    # The last two of the order before, and the rounding of states of size 1.
    return row[0], np.abs(last[1] - last[0]).max() + 8 * EPS / (h / 16)


def reference_cases():
    cases = json.loads(REFERENCE.read_text())["free_top"]
    return [pytest.param(case, id=case["name"]) for case in cases]


# The nearer time is within the addition theorems.
@pytest.mark.parametrize("turn", [4.0, 0.5])
@pytest.mark.parametrize("case", reference_cases())
def test_derivatives_agree_with_differences(case, turn):
    """Of the free motion: by time, attitude, angular velocity and moments."""
    i, w, c = (np.array([float(x) for x in case[key]]) for key in ("inertia", "omega0", "R0"))
    spin, rotor = np.linalg.norm(w) or 1.0, ph.Rotor.from_components(c)
    t, unit = turn / spin, units(i, w)
    d, found = motion_of(i, w, rotor).derivatives(t), jacobian(motion_of(i, w, rotor), t) * unit

    def state(omega=w, body=i, start=rotor, time=t):
        at = motion_of(body, omega, start).at(time)
        return np.concatenate([at.rotor.components, at.omega_body.components / spin])

    def check(f, expected):
        trials = [richardson(f, h) for h in (2**-4, 2**-6, 2**-9, 2**-12, 2**-16, 2**-20, 2**-26)]
        value, bound = min(trials, key=lambda trial: trial[1])
        size = 1 + np.abs(found).max()
        assert bound <= 1e-5 * size
        assert np.abs(value - expected).max() <= 4 * bound + 64 * EPS * size

    for k, axis in enumerate(np.eye(3)):
        check(lambda x, e=axis: state(omega=w + x * spin * e), found[:, k])
        turn = ph.bivector(axis)
        check(
            lambda x, e=turn: state(start=(-0.5 * x * e).exp() * rotor),
            np.concatenate([d.d_rotor_d_attitude[:, k], np.zeros(3)]),
        )
        # A flat body stays one if both its other moments grow, i.e. along i − i_k e_k and i_k e_k.
        if np.all(2 * i.max() < (1 - 1e-3) * i.sum()):
            small = 1 - 2 * i.max() / i.sum()
            check(lambda x, e=axis, s=small: state(body=i * (1 + x * s * e)), found[:, k + 3] * small)
    rates = np.concatenate([d.d_rotor_dt, d.d_omega_dt / spin]) / spin
    check(lambda x: state(time=t + x / spin), rates)


LONG = np.array([0.0, 3.0, -50.0, 1e4, 1e6, 1e12])


@every_case
def test_scaling_laws(i, w):
    """The motion scales with rates and times, does not depend on mass, and shifts with the start."""
    motion = motion_of(i, w)
    times = LONG if "separatrix" not in motion.describe()["regime"] and w[1] != 1.0 else LONG[:3]
    d, full, state = motion.derivatives(times), jacobian(motion, times), motion.at(times)
    omega, size = state.omega_body.components, np.abs(full * units(i, w)).max(axis=(-2, -1))
    bound = 256 * EPS * np.maximum(size, 1.0)[:, np.newaxis]
    spin = np.linalg.norm(w) or 1.0
    t = times[:, np.newaxis]
    # R(t; sω) = R(st; ω), Ω(t; sω) = s Ω(st; ω).
    assert (np.abs(d.d_rotor_d_omega @ w - t * d.d_rotor_dt) <= bound).all()
    assert (np.abs(d.d_omega_d_omega @ w - omega - t * d.d_omega_dt) <= bound * spin).all()
    # Moments in other units.
    assert (np.abs(full[..., 3:] @ np.array(i, float)) <= bound * [*[1] * 4, *[spin] * 3]).all()
    # The state at t after a start at τ is that at t + τ: with R(τ) = exp(−½ Ω_S τ) R(0).
    first = d.d_omega_dt[0]
    later = d.d_rotor_d_omega @ first + d.d_rotor_d_attitude @ R0(ph.bivector(w)).components
    assert (np.abs(later - d.d_rotor_dt) <= bound * spin).all()
    assert (np.abs(d.d_omega_d_omega @ first - d.d_omega_dt) <= bound * spin**2).all()


@every_case
def test_conservation_laws(i, w):
    """Energy, |L|, volume: ``m·δω = m0·δω0``, ``m·Iδω = m0·Iδω0``, det = 1 as Euler's field has no source."""
    motion = motion_of(i, w)
    times = LONG if "separatrix" not in motion.describe()["regime"] and w[1] != 1.0 else LONG[:3]
    inertia = np.array(i, float)
    change, omega = motion.derivatives(times).d_omega_d_omega, motion.at(times).omega_body.components
    size = np.maximum(np.abs(change).max(axis=(-2, -1)), 1.0)[:, np.newaxis]
    for power in (1, 2):
        gradient = inertia**power * omega
        found = np.einsum("ti,tij->tj", gradient, change)
        bound = 256 * EPS * size * np.linalg.norm(gradient[0])
        assert (np.abs(found - inertia**power * np.array(w)) <= bound).all()
    # The determinant is a difference of products of two large columns.
    bound = 64 * EPS * size[:, 0] ** 2 * inertia.max() / inertia.min()
    assert (np.abs(np.linalg.det(change) - 1) <= bound).all()


@every_case
def test_derivatives_obey_the_chain_rule(i, w):
    """From 0 to t, then to t + τ: the chain rule, within a fraction of a period and across many."""
    motion, part = motion_of(i, w), 1.75
    for t in (0.25, 2.0, -40.0, 1e6):
        if t == 1e6 and ("separatrix" in motion.describe()["regime"] or w[1] == 1.0):
            continue
        state = motion.at(t)
        then = ph.FreeMotion(moments(*i), state.rotor, state.omega_body)
        first, second, whole = motion.derivatives(t), then.derivatives(part), motion.derivatives(t + part)
        change = second.d_omega_d_omega @ first.d_omega_d_omega
        # δR = −½ ε R: the turn ε of the first part is the attitude that the second one starts from.
        turns = [-2 * _even(column) * ~state.rotor for column in first.d_rotor_d_omega.T]
        turns = np.stack([turn.grade(2).components for turn in turns], axis=-1)
        rotor = second.d_rotor_d_attitude @ turns + second.d_rotor_d_omega @ first.d_omega_d_omega
        size = max(np.abs(jacobian(motion, t + part)).max(), np.abs(jacobian(motion, t)).max(), 1.0)
        # The state between is rounded, and Jacobians of it change with it as much as with the start.
        bound = 256 * EPS * size * max(1.0, size if t != 1e6 else 1.0) * max(i) / min(i)
        assert np.abs(change - whole.d_omega_d_omega).max() <= bound
        assert np.abs(rotor - whole.d_rotor_d_omega).max() <= bound


@pytest.mark.parametrize("turned", [(1, 2), (0, 2), (0, 1)])
@pytest.mark.parametrize(
    ("i", "w"),
    [
        (
            (1.4637715882484015, 1.1773640572056574, 1.824610388517695),
            (-2.8763559918879677, -0.6010803642492871, -0.4301683540051395),
        ),
        ((1, 2, 2.25), (0.375, 0.5, 0.5000000000009095)),
        ((1, 2, 3), (0.25, -0.5, 1.0)),
    ],
)
def test_a_half_turn_turns_the_derivatives(i, w, turned):
    """A motion from behind the saddle, where cn < 0, is the same near the separatrix as from before it."""
    signs = np.array([-1.0 if k in turned else 1.0 for k in range(3)])
    for t in (0.3, 1.7, 20.0):
        one, other = (motion_of(i, x).derivatives(t).d_omega_d_omega for x in (w, signs * w))
        # Rounding of the start changes the motion by this near the separatrix.
        assert np.abs(signs[:, None] * one * signs - other).max() < 1e-9 * np.abs(one).max()


def test_body_axes_need_not_be_principal():
    """Rotating the body axes rotates rows and columns of the angular velocity only."""
    turn, omega = ph.Rotor.random(rng=5), [0.25, -0.5, 1.0]
    matrix = turn.to_matrix() @ np.diag([1.0, 2.0, 3.0]) @ turn.to_matrix().T
    body = ph.Inertia.from_matrix(0.5 * (matrix + matrix.T))
    plain, turned = motion_of((1, 2, 3), omega), ph.FreeMotion(body, R0 * ~turn, turn(ph.bivector(omega)))
    d, e, M = plain.derivatives(3.0), turned.derivatives(3.0), turn.to_matrix()
    # The matrix's moments and axes are off by a few ulps.
    close = {"rtol": 0, "atol": 1e3 * EPS}
    np.testing.assert_allclose(M.T @ e.d_omega_d_omega @ M, d.d_omega_d_omega, **close)
    np.testing.assert_allclose(M.T @ e.d_omega_d_moments, d.d_omega_d_moments, **close)
    np.testing.assert_allclose(M.T @ e.d_omega_dt, d.d_omega_dt, **close)
    # (R ~T)(t) of the turned body.
    for name, columns in (("omega", M), ("moments", np.eye(3)), ("attitude", np.eye(3))):
        found = getattr(e, f"d_rotor_d_{name}") @ columns
        back = [(_even(column) * turn)._with_grades(0b0101) for column in found.T]
        expected = getattr(d, f"d_rotor_d_{name}")
        np.testing.assert_allclose(np.stack(back, axis=-1), expected, **close)


def test_overflowing_derivatives_are_rejected():
    for i, w in (((1, 2, 3), (0, 1, 0)), ((1, 2, 2.25), (0.375, 0.5, 0.5))):
        motion = motion_of(i, w)
        assert np.isfinite(motion.derivatives(200.0).d_omega_d_omega).all()
        with pytest.raises(ValueError, match=r"derivatives at times\[1\] = 1e6 s overflow"):
            motion.derivatives([0.0, 1e6])
    with pytest.raises(ValueError, match="time NaN"):
        motion_of((1, 2, 3), (0, 1, 0)).derivatives(np.nan)


def _even(components):
    s, x, y, z = components
    return ph.multivector([s, 0, 0, 0, x, y, z, 0])
