//! Neumaier's compensated summation.

/// A total and the sum of its rounding errors, which are exact in floating point. The error of the result is one
/// rounding of the exact sum, plus `n² ε²` of the terms' sizes.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sum {
    total: f64,
    lost: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, x: f64) {
        let total = self.total + x;
        let (large, small) = if self.total.abs() >= x.abs() { (self.total, x) } else { (x, self.total) };
        self.lost += (large - total) + small;
        self.total = total;
    }

    pub(crate) fn value(self) -> f64 {
        // The rounding errors of an infinite total are NaN.
        if self.total.is_finite() { self.total + self.lost } else { self.total }
    }
}

/// Sums of `w x xᵀ`, the second moment of weighted points.
#[derive(Clone, Copy, Default)]
pub(crate) struct SymmetricSum([Sum; 6]);

/// The entries of the upper triangle, in the order in which they are stored.
const UPPER: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)];

impl SymmetricSum {
    /// Adds the entry `(i, j)` given by a function of the indices.
    pub(crate) fn add(&mut self, entry: impl Fn(usize, usize) -> f64) {
        for (sum, (i, j)) in self.0.iter_mut().zip(UPPER) {
            sum.add(entry(i, j));
        }
    }

    pub(crate) fn matrix(self) -> [[f64; 3]; 3] {
        let mut m = [[0.0; 3]; 3];
        for (sum, (i, j)) in self.0.into_iter().zip(UPPER) {
            m[i][j] = sum.value();
            m[j][i] = m[i][j];
        }
        m
    }
}

#[cfg(test)]
mod tests;
