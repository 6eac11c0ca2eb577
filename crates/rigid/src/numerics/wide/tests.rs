use super::*;
use proptest::prelude::*;

fn number() -> impl Strategy<Value = Wide> {
    (1.0..2.0f64, -1.0..1.0f64, -5000..5000i64, prop::bool::ANY).prop_map(|(hi, lo, exponent, minus)| {
        let x = DoubleDouble::two_sum(hi, lo * 0.5 * f64::EPSILON);
        let x = Wide::of(x, exponent);
        if minus { -x } else { x }
    })
}

fn abs(x: Wide) -> Wide {
    if x.is_negative() { -x } else { x }
}

/// `|x| <= n 2⁻¹⁰⁴ |size|`.
fn small(x: Wide, n: f64, size: Wide) -> bool {
    abs(x) <= abs(size) * Wide::from(n * 2f64.powi(-104))
}

proptest! {
    /// Identities that hold exactly for real numbers, to a few units of 2⁻¹⁰⁴, far beyond the range of floats.
    #[test]
    fn field_identities(a in number(), b in number(), c in number()) {
        prop_assert!(small(a * (b + c) - a * b - a * c, 16.0, abs(a) * (abs(b) + abs(c))));
        prop_assert!(small(a / b * b - a, 16.0, a));
        prop_assert!(small((a * a).sqrt() - abs(a), 16.0, a));
        prop_assert_eq!(a < b, b > a);
        let zero = Wide::from(0.0);
        prop_assert!(a - a == zero && a + zero == a && a * zero == zero);
    }

    /// All floats go there and back.
    #[test]
    fn floats(x in prop::num::f64::ANY) {
        prop_assume!(x.is_finite());
        prop_assert_eq!(Wide::from(x).value(), x);
    }
}

#[test]
fn beyond_floats() {
    for extreme in [f64::MAX, -2f64.powi(1023), f64::MIN_POSITIVE, -5e-324] {
        assert_eq!(Wide::from(extreme).value(), extreme);
    }
    let tiny = Wide::from(5e-324);
    assert_eq!((tiny * tiny).value(), 0.0);
    assert_eq!((tiny * tiny).sqrt().value(), 5e-324);
    assert_eq!((Wide::ONE / tiny).value(), f64::INFINITY);
    assert_eq!((Wide::ONE / tiny * tiny).value(), 1.0);
}
