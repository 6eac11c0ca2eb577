use super::*;
use proptest::prelude::*;

/// Four numbers of exponents up to the largest.
fn four(largest: i64) -> impl Strategy<Value = [Wide; 4]> {
    let one = (1.0..2.0f64, -1.0..1.0f64, -largest..largest, prop::bool::ANY);
    prop::array::uniform4(one.prop_map(|(hi, lo, exponent, minus)| {
        let x = DoubleDouble::two_sum(hi, lo * 0.5 * f64::EPSILON);
        let x = Wide::of(x, exponent);
        if minus { -x } else { x }
    }))
}

proptest! {
    /// Lanes with fused multiply-add have the bits of single numbers without.
    #[test]
    fn lanes(a in four(5000), b in four(5000)) {
        let zero = Wide::from(0.0);
        let abs = |x: Wide| if x.is_negative() { -x } else { x };
        let (mut x, mut y) = (Wides::<6, true>::all(0.0), Wides::<6, true>::all(0.0));
        let (a, b) = ([a[0], a[1], a[2], a[3], zero, a[0]], [b[0], b[1], b[2], b[3], b[0], zero]);
        for l in 0..6 {
            x.put(l, a[l]);
            y.put(l, b[l]);
        }
        for l in 0..6 {
            let same = |lanes: Wides<6, true>, one: Wide| lanes.lane(l).parts() == one.parts();
            prop_assert!(same(x + y, a[l] + b[l]) && same(x - y, a[l] - b[l]) && same(x * y, a[l] * b[l]));
            prop_assert!(b[l].is_zero() || same(x / y, a[l] / b[l]));
            prop_assert!(same(x.sqrt(), a[l].sqrt()) && same(x.abs(), abs(a[l])));
            prop_assert_eq!(x.values()[l], a[l].value());
            prop_assert_eq!(x.at_most(y)[l], a[l] <= b[l]);
            prop_assert_eq!(x.exceeds(y)[l], a[l] > b[l]);
            prop_assert_eq!((x.positive()[l], x.negative()[l]), (a[l] > zero, a[l] < zero));
            prop_assert_eq!(x.unit_signs()[l], if a[l] < zero { -1.0 } else { 1.0 });
        }
    }

    /// In the range of floats, double-double numbers have the bits of those beyond it.
    #[test]
    fn in_the_range_of_floats(a in four(200), b in four(200)) {
        let zero = Wide::from(0.0);
        let (a, b) = ([a[0], a[1], a[2], a[3], zero, a[0], zero], [b[0], b[1], b[2], b[3], b[0], zero, zero]);
        let (mut x, mut y) = (Wides::<7, true>::all(0.0), Wides::<7, true>::all(0.0));
        for l in 0..7 {
            x.put(l, a[l]);
            y.put(l, b[l]);
        }
        same_results(x, y, x.narrowed(), y.narrowed())?;
    }
}

fn bits<const W: usize>(numbers: &[f64; W]) -> [u64; W] {
    numbers.map(|x| if x.is_nan() { u64::MAX } else { x.to_bits() })
}

/// Every function of the trait.
fn same_results(
    a: Wides<7, true>,
    b: Wides<7, true>,
    x: DoubleDoubles<7, true>,
    y: DoubleDoubles<7, true>,
) -> Result<(), TestCaseError> {
    let same = |wide: Wides<7, true>, narrow: DoubleDoubles<7, true>| {
        let (wide, narrow) = (wide.narrowed(), Precise::narrowed(narrow));
        (bits(&wide.hi), bits(&wide.lo)) == (bits(&narrow.hi), bits(&narrow.lo))
    };
    prop_assert!(same(a + b, x + y) && same(a - b, x - y) && same(a * b, x * y) && same(a / b, x / y));
    prop_assert!(same(Precise::sqrt(a), Precise::sqrt(x)) && same(Precise::abs(a), Precise::abs(x)));
    prop_assert!(same(a + a * b - a, x + x * y - x) && same(a.half(), x.half()) && same(-a, -x));
    prop_assert!(same(a.twice(), x.twice()) && same(a.times_roughly(b), x.times_roughly(y)));
    prop_assert!(same(a.over_roughly(b), x.over_roughly(y)));
    // Numbers that differ in their low parts alone.
    let part = 2f64.powi(-70);
    let (c, z) = (a + b.times_roughly(Real::all(part)), x + y.times_roughly(Real::all(part)));
    prop_assert_eq!((a.exceeds(c), c.exceeds(a)), (x.exceeds(z), z.exceeds(x)));
    prop_assert_eq!((a.at_most(c), c.at_most(a)), (x.at_most(z), z.at_most(x)));
    let (mask, units) = (a.exceeds(b), [0.25, 1024.0, 2f64.powi(-300), 2f64.powi(300), 2.0, 1.0, 0.5]);
    prop_assert_eq!(mask, x.exceeds(y));
    prop_assert!(same(Precise::or(a, &mask, b), Precise::or(x, &mask, y)));
    prop_assert!(same(Precise::in_units(a, &units), Precise::in_units(x, &units)));
    prop_assert_eq!((a.at_most(b), a.positive(), a.negative()), (x.at_most(y), x.positive(), x.negative()));
    prop_assert_eq!((a.zeros(), a.unit_signs()), (x.zeros(), x.unit_signs()));
    prop_assert_eq!(bits(&a.values()), bits(&x.values()));
    for l in 0..7 {
        prop_assert_eq!(Precise::lane(&a, l).parts(), Precise::lane(&x, l).parts());
    }
    Ok(())
}
