use super::*;

/// `M = E − e sin E` for the E found, to the rounding of M: from circles to near-parabolas, from
/// periapsis to apoapsis.
#[test]
fn keplers_equation_holds() {
    for e in [1e-9, 0.1, 0.5, 0.9, 0.99, 0.999_999, 1.0 - 1e-12] {
        for m in [0.0, 1e-300, 1e-15, 1e-9, 1e-4, 0.01, 0.3, 1.0, 2.0, 3.0, PI] {
            let anomaly = eccentric_anomaly(m, e);
            let found = (1.0 - e) * anomaly + e * less_its_sine(anomaly);
            assert!((found - m).abs() <= 4.0 * f64::EPSILON * m, "e = {e}, M = {m}: {found}");
            assert_eq!(eccentric_anomaly(-m, e), -anomaly);
        }
    }
}

#[test]
fn the_small_difference_keeps_its_digits() {
    // x − sin x at x = 1e-3 and at 1, to 20 digits.
    for (x, exact) in [(1e-3, 1.666_666_583_333_335_3e-10), (1.0, 0.158_529_015_192_103_5)] {
        assert!((less_its_sine(x) / exact - 1.0).abs() <= 4.0 * f64::EPSILON, "{x}");
    }
}
