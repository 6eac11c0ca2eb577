"""exp of bivectors and log of rotors: each component within 2 ulp of a multiprecision reference."""

import math

import mpmath
import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

import polhode as ph

PI = math.pi
NEAR = st.floats(-1.0, 1.0).flatmap(lambda x: st.integers(-17, -1).map(lambda e: x * 10.0**e))
SIZES = st.one_of(
    st.floats(-300.0, 300.0).map(lambda e: 10.0**e),
    st.floats(0.0, 30.0),
    # Near multiples of a quarter turn and of an eighth, where a component nearly vanishes.
    st.tuples(st.integers(1, 2**20), NEAR).map(lambda t: t[0] * PI / 4 * (1 + t[1])),
    st.tuples(st.integers(1, 8), NEAR).map(lambda t: t[0] * PI / 4 * (1 + t[1])),
)
PLANES = st.one_of(
    st.sampled_from([(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)]),
    st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda c: math.hypot(*c) > 1e-3),
)


def bivector(size, plane):
    return np.array([size * (x / math.hypot(*plane)) for x in plane])


def assert_within_2_ulps(got, exact):
    for x, y in zip(got, exact, strict=True):
        assert abs(mpmath.mpf(float(x)) - y) <= 2 * math.ulp(float(y)), (x, y)


@given(size=SIZES, plane=PLANES)
@example(size=6381956970095103 * 2.0**797, plane=(1.0, 0.0, 0.0))
def test_exp(size, plane):
    b = bivector(size, plane)
    # Bits for the integer part of the angle, and for the cancellation near a quarter turn.
    with mpmath.workprec(400 + max(math.frexp(size)[1], 0)):
        exact = [mpmath.mpf(x) for x in b]
        angle = mpmath.sqrt(sum(x * x for x in exact))
        sinc = mpmath.sin(angle) / angle if angle else 1
        assert_within_2_ulps(ph.bivector(b).exp().components, [mpmath.cos(angle), *(x * sinc for x in exact)])


@given(angle=st.one_of(st.floats(0.0, PI), NEAR.map(abs), NEAR.map(lambda x: PI - abs(x))), plane=PLANES)
@example(angle=1e-300, plane=(0.0, 0.0, 1.0))
def test_log(angle, plane):
    rotor = ph.Rotor.from_components([math.cos(angle), *bivector(math.sin(angle), plane)])
    with mpmath.workprec(2400):
        s, *b = (mpmath.mpf(float(x)) for x in rotor.components)
        size = mpmath.sqrt(sum(x * x for x in b))
        if not size:
            assert np.all(rotor.log().components == 0.0)
            return
        factor = mpmath.atan2(size, s) / size
        assert_within_2_ulps(rotor.log().components, [x * factor for x in b])
