"""Writes free_states.txt: states of free motions to 34 digits, from integrals and not from theta series.

Jacobi's functions and an incomplete integral of the third kind, of mpmath with many digits (near a separatrix
differences are as small as 1e-200 of their terms): the way that the module `free` does not go. A line holds
the kind, moments, angular velocity and time, which are exact floats; then the rotor and the angular velocity
at that time, each number as a float and what is left of it. All start at the rotor (4, −2, 1, 2)/5.
The thinnest needles and the least rates are those of the Taylor series of lagrange_states.py, with c = 0.

    python free_states.py > free_states.txt
"""

import itertools
import math
import random

from mpmath import atan2, ellipf, ellipfun, ellipk, ellippi, mp, mpf, nint, pi, sqrt

START = [mpf(4) / 5, mpf(-2) / 5, mpf(1) / 5, mpf(2) / 5]
mp.dps = 60


def product(p, q):
    """Multiply rotors, components (1, e2e3, e3e1, e1e2), which are those of quaternions but for signs."""
    (a, b, c, d), (e, f, g, h) = p, q
    return [
        a * e - b * f - c * g - d * h,
        a * f + b * e - c * h + d * g,
        a * g + b * h + c * e - d * f,
        a * h - b * g + c * f + d * e,
    ]


def reverse(r):
    """~R."""
    return [r[0], -r[1], -r[2], -r[3]]


def unit(v):
    """Divide by the norm."""
    size = sqrt(sum(x * x for x in v))
    return [x / size for x in v]


def state(moments, omega, times):
    """Yield rotor and angular velocity at each time, by the formulas of Whittaker § 69."""
    i, w = [mpf(x) for x in moments], [mpf(x) for x in omega]
    small, b, large = sorted(range(3), key=lambda k: i[k])
    energy2 = sum(i[k] * w[k] ** 2 for k in range(3))
    g2 = sum((i[k] * w[k]) ** 2 for k in range(3))
    g = sqrt(g2)
    a, c = (small, large) if g2 >= energy2 * i[b] else (large, small)
    s = 1 if c == large else -1
    parity = 1 if (b - a) % 3 == 1 else -1
    sigma = 1 if w[c] >= 0 else -1
    p, q = abs(energy2 * i[c] - g2), abs(g2 - energy2 * i[a])
    ac, bc, ab = abs(i[c] - i[a]), abs(i[c] - i[b]), abs(i[b] - i[a])
    rate = sqrt(bc * q / (i[a] * i[b] * i[c]))
    m = ab * p / (bc * q)
    size = {
        a: sqrt(p / (i[a] * ac)),
        b: sigma * s * parity * sqrt(p / (i[b] * bc)),
        c: sigma * sqrt(q / (i[c] * ac)),
    }
    n = -i[c] * ab / (i[a] * bc)
    quarter, whole_pi = ellipk(m), ellippi(n, m)
    kappa = g * ac / (i[a] * i[c] * rate)
    start = ellipf(atan2(w[b] / size[b], w[a] / size[a]), m)

    def at(u):
        turns = nint(u / (4 * quarter))
        v = u - 4 * quarter * turns
        sn, cn, dn = (ellipfun(name, v, m=m) for name in ("sn", "cn", "dn"))
        third = 4 * turns * whole_pi + ellippi(n, atan2(sn, cn), m)
        azimuth = 2 * pi * turns + atan2(i[b] * abs(size[b]) * sn, i[a] * size[a] * cn)
        omega = [0, 0, 0]
        omega[a], omega[b], omega[c] = size[a] * cn, size[b] * sn, size[c] * dn
        direction = unit([i[k] * omega[k] for k in range(3)])
        # The rotor that turns this direction into d = σ e_c, 1 + d m up to a factor.
        d = [0, 0, 0]
        d[c] = sigma
        e, f = d, direction
        wedge = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]
        return omega, s * (kappa * third - azimuth), unit([1 + sigma * direction[c], *wedge])

    _, angle0, aligned0 = at(start)
    for t in times:
        omega, angle, aligned = at(start + rate * mpf(t))
        half = (g * mpf(t) / i[c] + angle - angle0) / 2
        turn = [mp.cos(half), 0, 0, 0]
        turn[1 + c] = -sigma * mp.sin(half)
        yield product(START, product(reverse(aligned0), product(turn, aligned))), omega


def kinds(rng):
    """Yield names, moments and angular velocities, near and far from each limit."""
    u = rng.random

    def beside_separatrix(i, far):
        a, b, c = i
        return [1 + u(), u(), 0], (a * (b - a) / (c * (c - b))) ** 0.5 * (1 + far)

    for _ in range(6):
        yield "generic", sorted(1 + 9 * u() for _ in range(3)), [rng.gauss(0, 1) for _ in range(3)]
    for far in (0.1, 0.03, 0.01, 1e-3, 1e-5, 1e-8, 1e-10, 1e-12, 1e-14):
        for sign in (1, -1):
            i = sorted(1 + 9 * u() for _ in range(3))
            w, ratio = beside_separatrix(i, sign * far)
            yield "beside the separatrix", i, [w[0], w[1], w[0] * ratio]
    for tiny in (1e-2, 1e-6, 1e-16, 1e-60, 1e-100, 1e-250):
        yield "about the middle axis", sorted(1 + 9 * u() for _ in range(3)), [u() * tiny, 1, u() * tiny]
    for e in (1e2, 1e4, 1e6):
        yield "needle", [1, e, e * (1 + u())], [u() * e**0.5, u(), u()]
        yield "needle about a short axis", [1, e, e * (1 + u())], [u(), u(), u()]
        yield "disc", [1, 1 + u(), e], [u(), u(), u()]
        w, ratio = beside_separatrix([1, e, 1.5 * e], 1e-5)
        yield "needle beside the separatrix", [1, e, 1.5 * e], [w[0], w[1] / e, w[0] * ratio]
        yield "oblate", [1, 1 + 1 / e, 2], [u(), u(), u()]
        yield "prolate", [1, 2, 2 + 1 / e**2], [u(), u(), u()]
        yield "nearly a sphere", [1, 1 + u() / e**2, 1 + 2 / e**2], [u(), u(), u()]
        yield "wobble", [1, 2, 3], [u() / e**2, u() / e**2, 1]
        yield "wobble about the long axis", [1, 2, 3], [1, u() / e, u() / e]
        yield "nearly crossing", [1, 2, 3], [u(), u() / e, u()]


def split(x):
    """Write a number as a float and the float nearest to the rest."""
    high = float(x)
    return f"{high!r} {float(x - mpf(high))!r}"


def main():
    """Write all states, four times for each motion."""
    rng = random.Random(3)
    orders = itertools.cycle(itertools.permutations(range(3)))
    for kind, moments, omega in kinds(rng):
        order = next(orders)
        moments = [float(moments[k]) for k in order]
        omega = [float(omega[k]) * rng.choice((1, -1)) for k in order]
        times = [-0.7, 1e3 * rng.random(), -1e7 * rng.random(), 1e12 * rng.random()]
        # Twice the digits by which k falls short of 1.
        mp.dps = 60 - 4 * int(math.log10(min(abs(x) for x in omega)))
        for t, (rotor, then) in zip(times, state(moments, omega, times), strict=True):
            inputs = " ".join(repr(x) for x in [*moments, *omega, t])
            print(kind.replace(" ", "_"), inputs, *map(split, rotor), *map(split, then))


if __name__ == "__main__":
    main()
