"""Write exp_log_table.txt: hard arguments of exp and log, and the values nearest to the true ones.

    python crates/ga/tests/exp_log_table.py

Each line is a name and numbers as hexadecimal bits: of `exp` three and four, of `log` four and three.
"""

import math
import struct
from pathlib import Path
from random import Random

from mpmath import mp, mpf, workprec

PI = math.pi


def exp(b):
    """Exponential of a bivector. The working precision outlasts any cancellation of an angle of this size."""
    with workprec(400 + max(math.frexp(max(map(abs, b)))[1], 0)):
        x = [mpf(c) for c in b]
        size = mp.sqrt(sum(c * c for c in x))
        sinc = mp.sin(size) / size if size else mpf(1)
        return [float(mp.cos(size)), *(float(c * sinc) for c in x)]


def log(r):
    """Logarithm of a rotor that need not be quite unit."""
    with workprec(2400):
        s, *b = (mpf(c) for c in r)
        size = mp.sqrt(sum(c * c for c in b))
        if not size:
            return [0.0, 0.0, PI if s < 0 else 0.0]
        factor = mp.atan2(size, s) / size
        return [float(c * factor) for c in b]


def plane(random):
    """A unit plane, one in four along an axis."""
    if random.random() < 0.25:
        return random.choice([(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)])
    c = [random.gauss(0, 1) for _ in range(3)]
    return [x / math.hypot(*c) for x in c]


def angles(random):
    """Tiny, ordinary and huge angles, and angles near quarter turns."""
    yield from (0.0, 5e-324, 1e-310, 1e-300, 1e-155, 1e-120, 2**-28, 2**-27, 1e-4, PI / 8, PI / 4)
    yield from (k * PI / 2 for k in range(1, 30))
    yield from ((2 * k + 1) * PI / 4 for k in range(12))
    for k in (1, 2, 3, 1000):
        yield from (k * PI / 2 * (1 + random.uniform(-1, 1) * 10**e) for e in range(-16, -2))
    yield from (random.randrange(2**19) * PI / 2 for _ in range(12))
    for exponent in (3, 5, 5.9, 6, 6.1, 7, 9, 12, 15, 16, 22, 50, 100, 200, 300):
        yield 10**exponent * random.uniform(1, 10)
    # Of all doubles the nearest to a multiple of pi/2.
    yield 6381956970095103 * 2.0**797


def exps(random):
    """Arguments of exp."""
    yield from ([angle * c for c in plane(random)] for angle in angles(random))
    yield from ([1e308, -1.7e308, 1.7e308], [3.0, 1e-200, 5e-324], [PI, 1e-8, 1e-12], [1e17, 1.0, -1.0])


def logs(random):
    """Arguments of log: rotors of angles up to half a turn, near the borders of its cases, and near -1."""
    rotors = [exp(b) for b in exps(random) if max(map(abs, b)) < 1e3]
    yield from rotors
    yield from ([-s, *b] for s, *b in rotors[::3])
    for angle in (PI / 8, 3 * PI / 8, 5 * PI / 8, 7 * PI / 8):
        yield [math.cos(angle), *(math.sin(angle) * c for c in plane(random))]
    for s in (1.0, -1.0):
        yield from ([s, x, 1e-3 * x, 0.0] for x in (5e-324, 1e-310, 1e-200, 1e-101, 1e-99, 1e-20, 1e-8))


def line(name, argument, value):
    """One line of the table."""
    return " ".join([name, *(struct.pack(">d", x).hex() for x in (*argument, *value))]) + "\n"


def main():
    """Write the table beside this file."""
    lines = [line("exp", b, exp(b)) for b in exps(Random(1))]
    lines += [line("log", r, log(r)) for r in logs(Random(2))]
    Path(__file__).with_name("exp_log_table.txt").write_text("".join(lines))


if __name__ == "__main__":
    main()
