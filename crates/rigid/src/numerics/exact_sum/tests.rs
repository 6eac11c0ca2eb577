use super::*;
use proptest::prelude::*;

proptest! {
    /// Whole numbers of 30 bits, so that 128 bits hold the exact result, which nearly cancels.
    #[test]
    fn sums_of_products_match_integers(a in 1i64..1 << 30, b in 1i64..1 << 30, c in 1i64..1 << 30, e in -9i64..9) {
        let product = |x: [i64; 4]| {
            let f = x.map(|x| x as f64);
            Exact::ZERO.plus(f[0]).plus(-f[3]).times(f[1]).times(f[2]).times(f[1])
        };
        let whole = |x: [i64; 4]| {
            let x = x.map(i128::from);
            (x[0] - x[3]) * x[1] * x[2] * x[1]
        };
        let (x, y) = ([a, b, c, 1], [a, b, c + e, 1]);
        let found = product(x).add(product(y).times(-1.0)).value();
        let expected = whole(x) - whole(y);
        prop_assert_eq!(found.hi as i128 + found.lo as i128, expected);
    }
}
