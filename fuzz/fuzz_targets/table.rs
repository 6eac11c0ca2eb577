//! Products by the blade table, term by term: the definition to which faster products are compared.

use polhode_ga::product::Product;
use polhode_ga::table::Algebra;

/// A product of full multivectors, and for each component the sum of the magnitudes of its terms.
pub fn product(algebra: &Algebra, product: Product, a: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut sums, mut sizes) = (vec![0.0; a.len()], vec![0.0; a.len()]);
    for (i, &x) in a.iter().enumerate() {
        for (j, &y) in b.iter().enumerate() {
            let (sign, k) = product.of_basis(algebra, i, j);
            if sign != 0 {
                sums[k] += f64::from(sign) * x * y;
                sizes[k] += (x * y).abs();
            }
        }
    }
    (sums, sizes)
}

/// Asserts that components are these sums within the rounding of `terms` additions, each of a product with its own
/// rounding; not where a partial sum in another order may overflow, or an infinity may meet a component that is absent.
pub fn assert_close(found: &[f64], (sums, sizes): &(Vec<f64>, Vec<f64>), terms: usize, what: &str) {
    assert_eq!(found.len(), sums.len(), "{what}");
    for (k, ((x, sum), size)) in found.iter().zip(sums).zip(sizes).enumerate() {
        let bound = (terms + 1) as f64 * (f64::EPSILON * size + f64::MIN_POSITIVE * f64::EPSILON);
        assert!(
            (x - sum).abs() <= bound || *size > 0.25 * f64::MAX || size.is_nan(),
            "{what}: component {k} is {x:e}, by the table {sum:e} within {bound:e}"
        );
    }
}
