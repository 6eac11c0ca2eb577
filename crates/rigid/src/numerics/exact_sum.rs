//! Exact sums: a number as a sum of non-overlapping floats of increasing size, for differences of nearly equal terms.
//!
//! J. R. Shewchuk, *Adaptive precision floating-point arithmetic*, Discrete Comput. Geom. 18 (1997).

use super::double_double::DoubleDouble;

/// Enough parts for two products of five factors.
const MOST: usize = 32;

/// A sum of floats, exact where no product under- or overflows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exact {
    parts: [f64; MOST],
    count: usize,
}

impl Exact {
    pub const ZERO: Exact = Exact { parts: [0.0; MOST], count: 0 };

    /// The sum with one more number.
    pub fn plus(self, x: f64) -> Exact {
        let mut sum = Exact::ZERO;
        let mut carry = x;
        for &part in &self.parts[..self.count] {
            let DoubleDouble { hi, lo } = DoubleDouble::two_sum(carry, part);
            sum.push(lo);
            carry = hi;
        }
        sum.push(carry);
        sum
    }

    pub fn add(self, other: Exact) -> Exact {
        other.parts[..other.count].iter().fold(self, |sum, &part| sum.plus(part))
    }

    pub fn times(self, factor: f64) -> Exact {
        self.parts[..self.count].iter().fold(Exact::ZERO, |sum, &part| {
            let DoubleDouble { hi, lo } = DoubleDouble::two_product(part, factor);
            sum.plus(lo).plus(hi)
        })
    }

    /// The rounded sum, largest part first.
    pub fn value(self) -> DoubleDouble {
        self.parts[..self.count].iter().rev().fold(DoubleDouble::ZERO, |sum, &part| sum + part.into())
    }

    fn push(&mut self, part: f64) {
        if part != 0.0 {
            self.parts[self.count] = part;
            self.count += 1;
        }
    }
}

#[cfg(test)]
mod tests;
