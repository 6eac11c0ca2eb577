use super::*;

#[test]
fn the_exponential_has_twice_the_precision() {
    // e − 1 to 32 digits.
    let cases = [
        (1.0, DoubleDouble { hi: 1.718_281_828_459_045, lo: 1.445_646_891_729_250_2e-16 }),
        (0.0, DoubleDouble::ZERO),
    ];
    for (x, expected) in cases {
        let found = DoubleDouble::from(x).exp()[1];
        assert!((found - expected).value().abs() <= 1e-30, "{x}: {found:?}");
    }
    for x in [-600.0, -3.0, -0.1, 1e-9, 0.2, 0.4, 5.0, 300.0] {
        // e^x e^{−x} = 1.
        let both = [x, -x].map(|x: f64| DoubleDouble::from(x).exp()[0]);
        assert!((both[0] * both[1] - DoubleDouble::ONE).value().abs() <= 2e-29, "{x}");
        assert!(
            (DoubleDouble::from(x).exp()[1].value() / x.exp_m1() - 1.0).abs() <= 4.0 * f64::EPSILON,
            "{x}"
        );
    }
}
