"""Writes states of heavy symmetric tops to 34 digits, by ways that the module `lagrange` does not go.

Short times by Taylor series of the equations of motion; long ones from the roots of the cubic and incomplete
integrals of the third kind, of mpmath with 90 digits. The two agree to 40 digits. A line of
lagrange_states.txt, which is a choice of such lines, holds the kind, moments, c, rotor (to be divided by its
norm), angular velocity and time, which are exact floats; then the rotor and the angular velocity at that
time, each number as a float and what is left of it. Beside the vertical the series of order 52 keep the
digits of a tilt of 1e-300, for components of the rotor and the rate are not differences of larger numbers.

    python lagrange_states.py
"""

import math
import random

from mpmath import (
    acos,
    atan2,
    ceil,
    conj,
    ellipf,
    ellipfun,
    ellippi,
    expj,
    im,
    mp,
    mpc,
    mpf,
    nint,
    polyroots,
    polyval,
    re,
    sqrt,
)

mp.dps = 90


def series(moments, c, rotor, omega, time, order=44):
    """Sum Taylor series of order 44 for q' = ½ q ω, I ω' = (I ω) x ω − c x γ."""
    n = sqrt(sum(mpf(x) ** 2 for x in rotor))
    q = [mpf(rotor[0]) / n, *(-mpf(x) / n for x in rotor[1:])]
    w = [mpf(x) for x in omega]
    fastest = max(1.0, math.hypot(*omega), math.sqrt(math.hypot(*c) / min(moments)))
    steps = int(ceil(abs(time) * fastest / 0.6))
    for _ in range(steps):
        a, b, gamma = [[x] for x in q], [[x] for x in w], [[], [], []]
        for k in range(order):

            def times(x, y, k=k):
                return sum(x[i] * y[k - i] for i in range(k + 1))

            gamma[0].append(2 * (times(a[1], a[3]) - times(a[0], a[2])))
            gamma[1].append(2 * (times(a[2], a[3]) + times(a[0], a[1])))
            gamma[2].append(times(a[0], a[0]) - times(a[1], a[1]) - times(a[2], a[2]) + times(a[3], a[3]))
            slopes = [
                -(times(a[1], b[0]) + times(a[2], b[1]) + times(a[3], b[2])),
                times(a[0], b[0]) + times(a[2], b[2]) - times(a[3], b[1]),
                times(a[0], b[1]) + times(a[3], b[0]) - times(a[1], b[2]),
                times(a[0], b[2]) + times(a[1], b[1]) - times(a[2], b[0]),
            ]
            for i in range(4):
                a[i].append(slopes[i] / 2 / (k + 1))
            for i in range(3):
                j, m = (i + 1) % 3, (i + 2) % 3
                torque = (mpf(moments[j]) - mpf(moments[m])) * times(b[j], b[m])
                torque -= mpf(c[j]) * gamma[m][k] - mpf(c[m]) * gamma[j][k]
                b[i].append(torque / mpf(moments[i]) / (k + 1))
        h = mpf(time) / steps
        q, w = [polyval(x[::-1], h) for x in a], [polyval(x[::-1], h) for x in b]
    return [q[0], -q[1], -q[2], -q[3]], w


def integrals(i1, i3, c, rotor, omega, time):
    """Integrate φ' ± ψ' for a top about e3 with c > 0; not for one that passes the vertical exactly."""
    i1, i3, c, time = mpf(i1), mpf(i3), mpf(c), mpf(time)
    n = sqrt(sum(mpf(x) ** 2 for x in rotor))
    s, b1, b2, b3 = (mpf(x) / n for x in rotor)
    alpha, beta, w, w3 = mpc(s, -b3), mpc(-b2, b1), mpc(omega[0], omega[1]), mpf(omega[2])
    g, u0, ell, weight = -2 * conj(alpha) * beta, abs(alpha) ** 2 - abs(beta) ** 2, i3 * w3 / i1, 2 * c / i1
    b, slope, a = re(w * conj(g)) + ell * u0, im(w * conj(g)), abs(w) ** 2 + weight * u0
    cubic = [weight, -(a + ell**2), 2 * b * ell - weight, a - b * b]
    r1, r2, r3 = sorted(re(x) for x in polyroots(cubic, maxsteps=2000, extraprec=400))
    rate, m = sqrt(weight * (r3 - r1)) / 2, (r2 - r1) / (r3 - r1)
    first = acos(sqrt(max(0, (r2 - u0) / (r2 - r1)))) * (1 if slope >= 0 else -1)
    quarter = mp.ellipk(m)
    argument = ellipf(first, m) + rate * time
    whole = nint(argument / (2 * quarter))
    argument -= 2 * quarter * whole
    sn, cn, dn = (ellipfun(name, argument, m=m) for name in ("sn", "cn", "dn"))
    u, slope, last = r1 + (r2 - r1) * sn**2, 2 * rate * (r2 - r1) * sn * cn * dn, atan2(sn, cn)

    def phase(top, distance, sign):
        n = sign * (r2 - r1) / distance
        turned = 2 * whole * ellippi(n, m) + ellippi(n, last, m) - ellippi(n, first, m)
        return top / (2 * distance * rate) * turned

    spin = (w3 - ell) * time / 2
    alpha = sqrt((1 + u) / 2) * alpha / abs(alpha) * expj(phase(b + ell, 1 + r1, -1) + spin)
    beta = sqrt((1 - u) / 2) * beta / abs(beta) * expj(phase(b - ell, 1 - r1, 1) - spin)
    w = mpc(b - ell * u, slope) / (-2 * alpha * conj(beta))
    return [alpha.real, beta.imag, -beta.real, -alpha.imag], [w.real, w.imag, w3]


def line(kind, inputs, state):
    """Write exact floats, then each number as a float and the rest."""
    numbers = [x for y in (*state[0], *state[1]) for x in (float(y), float(y - mpf(float(y))))]
    print(kind, *(repr(float(x)) for x in [*inputs, *numbers]))


def main():
    """Write examples of both."""
    for c, rotor, omega in [
        ((0, 0, 1), (1, 0.5, 0.25, 0), (0, 0, 0)),
        ((0, 0, 1), (0, 1, 0, 0), (2, 0, 0)),
        ((0, 0, 1), (1, 0, 0, 0), (0.5, 0.25, 3)),
        ((0, 0, -1), (2, 1, 0.5, 0.25), (0.25, -0.5, 3)),
    ]:
        for time in (-3, 3, 10):
            state = series((1, 1, 0.5), c, rotor, omega, time)
            line("series", [1, 1, 0.5, *c, *rotor, *omega, time], state)
    for tilt in (0.0, 1e-16, 1e-30, 1e-60, 1e-300):
        for rotor in ((1, tilt, 0.5 * tilt, 0), (0.5 * tilt, 1, 0, tilt)):
            pushes = (0, 0), (0.5 * tilt, -0.25 * tilt), (0.25, -0.5)
            for spin, push in ((s, p) for s in (0, 3, 8) for p in pushes):
                state = series((1, 1, 0.5), (0, 0, 1), rotor, (*push, spin), 2, order=52)
                line("vertical", [1, 1, 0.5, 0, 0, 1, *rotor, *push, spin, 2], state)
    rng = random.Random(3)

    def size():
        return rng.uniform(1, 2) * 2.0 ** rng.randint(-12, 12) * rng.choice((1, -1))

    for _ in range(40):
        i3, c = rng.uniform(0.05, 1.95), abs(size())
        rotor = [rng.gauss(0, 1) * 2.0 ** rng.randint(-8, 1) for _ in range(4)]
        rotor = [x / math.hypot(*rotor) for x in rotor]
        omega = [size() / 64, size() / 64, size() / 16]
        for time in (-7, 1e9):
            state = integrals(1, i3, c, rotor, omega, time)
            line("random", [1, 1, i3, 0, 0, c, *rotor, *omega, time], state)


if __name__ == "__main__":
    main()
