use super::*;

/// Whether a number is within some units of its last place, or of the least number.
fn is_near(x: f64, expected: f64, units: f64) -> bool {
    x == expected || (x - expected).abs() <= (units * f64::EPSILON * expected.abs()).max(5e-324)
}

#[test]
fn sines_and_cosines_of_a_quarter_are_those_of_the_library() {
    for k in 0..=10_000 {
        let angle = FRAC_PI_2 * (f64::from(k) / 1e4);
        for (sin, cos) in [sin_cos_of_quarter::<false>(angle), sin_cos_of_quarter::<true>(angle)] {
            assert!(is_near(sin, angle.sin(), 2.0) && is_near(cos, angle.cos(), 2.0), "of {angle}");
        }
    }
    for tiny in [0.0, 5e-324, 1e-300, 1e-20] {
        assert_eq!(sin_cos_of_quarter::<false>(tiny), (tiny, 1.0));
    }
}

#[test]
fn decays_are_exponentials() {
    for k in 0..=7050 {
        let x = 0.1 * f64::from(k);
        assert!(is_near(decay(x), (-x).exp(), 2.0), "{:e} of {x}", decay(x));
    }
    assert_eq!([0.0, 706.0, 1e10, f64::INFINITY].map(decay), [1.0, 0.0, 0.0, 0.0]);
    assert!(decay(f64::NAN).is_nan());
}

#[test]
fn hypotenuses_are_those_of_the_library() {
    let legs: [f64; 11] = [0.0, 5e-324, 3e-310, 2e-308, 1e-170, 1e-3, 1.0, 3.7, 1e155, 9e307, 1.7e308];
    for x in legs {
        for y in legs {
            let expected = x.hypot(y);
            for side in [hypotenuse(x, y), hypotenuse(-x, y), hypotenuse(x, -y)] {
                assert!(is_near(side, expected, 2.0), "{side:e} of {x:e} and {y:e}, expected {expected:e}");
            }
        }
    }
    assert_eq!(hypotenuse(f64::NEG_INFINITY, 1.0), f64::INFINITY);
    assert!(hypotenuse(f64::NAN, 1.0).is_nan() && hypotenuse(1.0, f64::NAN).is_nan());
}
