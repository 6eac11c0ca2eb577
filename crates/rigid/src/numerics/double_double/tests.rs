use super::*;
use proptest::prelude::*;

fn number() -> impl Strategy<Value = DoubleDouble> {
    (-1e3..1e3f64, -1.0..1.0f64).prop_map(|(hi, lo)| DoubleDouble::two_sum(hi, lo * f64::EPSILON * hi))
}

proptest! {
    /// Identities that hold exactly for real numbers, to 16 units of 2⁻¹⁰⁴.
    #[test]
    fn field_identities(a in number(), b in number(), c in number()) {
        let unit = 16.0 * 2f64.powi(-104);
        let size = a.hi.abs() * (b.hi.abs() + c.hi.abs());
        prop_assert!((a * (b + c) - a * b - a * c).value().abs() <= unit * size);
        prop_assume!(b.hi.abs() > 1e-3);
        prop_assert!((a / b * b - a).value().abs() <= unit * a.hi.abs());
        let (root, size) = ((a * a).sqrt(), if a.hi < 0.0 { -a } else { a });
        prop_assert!((root - size).value().abs() <= unit * a.hi.abs());
    }
}

proptest! {
    /// Sums of numbers with the same signs, to a unit of 2⁻¹⁰⁴.
    #[test]
    fn sums_of_the_same_sign(a in number(), b in number()) {
        let b = if (a.hi < 0.0) == (b.hi < 0.0) { b } else { -b };
        let [x, y]: [DoubleDoubles<1, false>; 2] = [DoubleDoubles::all(a), DoubleDoubles::all(b)];
        let sum = x.plus(y).lane(0);
        prop_assert!((sum - (a + b)).value().abs() <= 2f64.powi(-104) * (a + b).value().abs());
        prop_assert_eq!(sum.hi + sum.lo, sum.hi);
    }
}

#[test]
fn over_two_pi() {
    let pi = DoubleDouble { hi: std::f64::consts::PI, lo: 1.224_646_799_147_353_2e-16 };
    let one = DoubleDouble::OVER_TWO_PI * pi * 2.0.into();
    assert!((one - DoubleDouble::ONE).value().abs() <= 4.0 * 2f64.powi(-104));
}
