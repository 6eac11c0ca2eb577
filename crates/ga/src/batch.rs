//! Any product over rows of numbers.
//!
//! Values lie row by row, `(rows, components)`. A block of rows is turned so that each component is
//! contiguous; then every term of the plan is one loop over the block, which compilers vectorise.

use crate::product::{Grades, Plan};
use crate::rotor::Rotor;
use crate::values::Vector;

/// Rows in a block: three operands of 8 × 32 numbers stay in the first-level cache.
const LANES: usize = 32;

/// A factor: one row for all, or a row for each.
fn load(block: &mut [[f64; LANES]], data: &[f64], size: usize, first: usize, rows: usize) {
    if data.len() == size {
        for (lane, &x) in block.iter_mut().zip(data) {
            lane.fill(x);
        }
        return;
    }
    for (row, values) in data[first * size..(first + rows) * size].chunks_exact(size).enumerate() {
        for (lane, &x) in block.iter_mut().zip(values) {
            lane[row] = x;
        }
    }
}

impl Plan {
    /// Multiplies row by row into `out`. A factor of a single row meets every row of the other.
    ///
    /// # Panics
    /// If a slice is not a whole number of rows, or the numbers of rows do not fit together.
    pub fn run(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        let (na, nb, nout) = self.sizes;
        let total = out.len() / nout;
        assert_eq!(out.len(), total * nout);
        assert!(a.len() == na || a.len() == total * na, "left factor has the wrong length");
        assert!(b.len() == nb || b.len() == total * nb, "right factor has the wrong length");
        let mut a_block = vec![[0.0; LANES]; na];
        let mut b_block = vec![[0.0; LANES]; nb];
        let mut out_block = vec![[0.0; LANES]; nout];
        for first in (0..total).step_by(LANES) {
            let rows = LANES.min(total - first);
            load(&mut a_block, a, na, first, rows);
            load(&mut b_block, b, nb, first, rows);
            out_block.fill([0.0; LANES]);
            for term in &self.terms {
                let (x, y) = (&a_block[term.a], &b_block[term.b]);
                let z = &mut out_block[term.out];
                let sign = f64::from(term.sign);
                for i in 0..LANES {
                    z[i] += sign * x[i] * y[i];
                }
            }
            let rows_out = out[first * nout..(first + rows) * nout].chunks_exact_mut(nout);
            for (row, values) in rows_out.enumerate() {
                for (x, lane) in values.iter_mut().zip(&out_block) {
                    *x = lane[row];
                }
            }
        }
    }
}

/// `R X ~R` for rows of rotor components and rows of values that hold `grades`. Scalar and trivector
/// stay; vector and bivector each turn as three numbers. One row of either meets every row of the other.
///
/// # Panics
/// If the numbers of rows do not fit together.
pub fn turn(rotors: &[f64], values: &[f64], grades: Grades, out: &mut [f64]) {
    const WIDTH: [usize; 4] = [1, 3, 3, 1];
    let present = (0..4).filter(|&k| grades.contains(k));
    let size: usize = present.clone().map(|k| WIDTH[k]).sum();
    let (rotors, total) = (rotors.as_chunks::<4>().0, out.len() / size);
    assert!(rotors.len() == 1 || rotors.len() == total, "rotors have the wrong length");
    assert!(values.len() == size || values.len() == total * size, "values have the wrong length");
    let mut at = 0;
    for k in present {
        for (row, target) in out.chunks_exact_mut(size).enumerate() {
            let first = if values.len() == size { at } else { row * size + at };
            if WIDTH[k] == 1 {
                target[at] = values[first];
            } else {
                let rotor = Rotor::from_unit_components(rotors[if rotors.len() == 1 { 0 } else { row }]);
                let turned = rotor.apply(Vector([values[first], values[first + 1], values[first + 2]]));
                target[at..at + 3].copy_from_slice(&turned.0);
            }
        }
        at += WIDTH[k];
    }
}

#[cfg(test)]
mod tests {
    use super::turn;
    use crate::product::{Grades, Plan, Product};
    use crate::table::{Algebra, Signature};
    use crate::{Multivector, Rotor};

    /// Every set of grades, one row against many both ways, equals `R X ~R` by products to 8 roundings.
    #[test]
    fn turning_equals_the_sandwich() {
        let number = |i: usize| (i * 7 % 11) as f64 - 4.5;
        let rotors: Vec<Rotor> = (0..5)
            .map(|i| Rotor::from_components(std::array::from_fn(|k| number(4 * i + k))).unwrap())
            .collect();
        for grades in (1..16).map(Grades) {
            let indices = grades.indices(&crate::table::G3);
            for (n, m) in [(1, 1), (1, 5), (5, 1), (5, 5)] {
                let r: Vec<f64> = rotors[..n].iter().flat_map(|r| r.components()).collect();
                let x: Vec<f64> = (0..m * indices.len()).map(number).collect();
                let mut out = vec![f64::NAN; n.max(m) * indices.len()];
                turn(&r, &x, grades, &mut out);
                for row in 0..n.max(m) {
                    let mut full = Multivector::default();
                    for (k, &i) in indices.iter().enumerate() {
                        full.0[i] = x[(if m == 1 { 0 } else { row }) * indices.len() + k];
                    }
                    let rotor = rotors[if n == 1 { 0 } else { row }];
                    let turned = Multivector::from(rotor) * full * Multivector::from(rotor.reverse());
                    for (k, &i) in indices.iter().enumerate() {
                        let error = (out[row * indices.len() + k] - turned.0[i]).abs();
                        assert!(error <= 8.0 * f64::EPSILON * full.norm(), "{grades:?} {error}");
                    }
                }
            }
        }
    }

    /// Row counts around the block size, and one row against many, in several algebras: every row
    /// equals the sum over the table.
    #[test]
    fn every_row_equals_the_table() {
        for (p, q, r) in [(3, 0, 0), (2, 0, 0), (3, 0, 1), (4, 1, 0), (1, 3, 0)] {
            let algebra = Algebra::new(Signature { p, q, r }).unwrap();
            let all = Grades((1 << (algebra.signature().generators() + 1)) - 1);
            let size = algebra.blades().len();
            for product in Product::ALL {
                let plan = Plan::new(&algebra, product, all, all);
                let out_indices = plan.grades.indices(&algebra);
                for rows in [1, 31, 32, 33, 70] {
                    let a: Vec<f64> = (0..rows * size).map(|i| (i * 7 % 11) as f64 - 5.0).collect();
                    let b: Vec<f64> = (0..size).map(|i| (i * 5 % 13) as f64 - 6.0).collect();
                    let mut out = vec![f64::NAN; rows * out_indices.len()];
                    plan.run(&a, &b, &mut out);
                    for row in 0..rows {
                        let mut expected = vec![0.0; size];
                        for i in 0..size {
                            for j in 0..size {
                                let (sign, k) = product.of_basis(&algebra, i, j);
                                expected[k] += f64::from(sign) * a[row * size + i] * b[j];
                            }
                        }
                        for (x, &k) in out_indices.iter().enumerate() {
                            assert_eq!(out[row * out_indices.len() + x], expected[k]);
                        }
                    }
                }
            }
        }
    }
}
