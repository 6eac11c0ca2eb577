//! Double-double numbers: an unevaluated sum `hi + lo`, 106 bits.
//!
//! T. J. Dekker, *A floating-point technique for extending the available precision*, Numer. Math. 18 (1971). The
//! relative error of an operation is a few 2⁻¹⁰⁴. Used for angles that grow with time: `frac(ν t)` loses as many digits
//! as `ν t` has before the point.

use polhode_ga::simd::double;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, `|lo| <= ulp(hi)/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleDouble {
    pub hi: f64,
    pub lo: f64,
}

impl DoubleDouble {
    pub const ZERO: DoubleDouble = DoubleDouble { hi: 0.0, lo: 0.0 };
    pub const ONE: DoubleDouble = DoubleDouble { hi: 1.0, lo: 0.0 };
    /// 1/2π.
    pub const OVER_TWO_PI: DoubleDouble =
        DoubleDouble { hi: 0.159_154_943_091_895_35, lo: -9.839_338_337_591_243e-18 };

    /// `a + b` without error.
    #[inline]
    pub fn two_sum(a: f64, b: f64) -> DoubleDouble {
        double::two_sum(a, b).into()
    }

    /// `a + b` without error for `|a| >= |b|`.
    #[inline]
    fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
        double::quick_two_sum(a, b).into()
    }

    /// `a b` without error.
    #[inline]
    pub fn two_product(a: f64, b: f64) -> DoubleDouble {
        double::two_product::<false>(a, b).into()
    }

    #[inline]
    pub fn sqrt(self) -> DoubleDouble {
        if self.hi <= 0.0 {
            return DoubleDouble::ZERO;
        }
        // One Newton step from the double root.
        let root = self.hi.sqrt();
        let rest = self - DoubleDouble::two_product(root, root);
        DoubleDouble::quick_two_sum(root, rest.hi / (2.0 * root))
    }

    #[inline]
    pub fn value(self) -> f64 {
        self.hi + self.lo
    }

    #[inline]
    pub fn abs(self) -> DoubleDouble {
        if self.hi < 0.0 { -self } else { self }
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(hi: f64) -> DoubleDouble {
        DoubleDouble { hi, lo: 0.0 }
    }
}

impl From<(f64, f64)> for DoubleDouble {
    #[inline]
    fn from((hi, lo): (f64, f64)) -> DoubleDouble {
        DoubleDouble { hi, lo }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn add(self, o: DoubleDouble) -> DoubleDouble {
        double::add((self.hi, self.lo), (o.hi, o.lo)).into()
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn neg(self) -> DoubleDouble {
        DoubleDouble { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn sub(self, o: DoubleDouble) -> DoubleDouble {
        self + -o
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn mul(self, o: DoubleDouble) -> DoubleDouble {
        double::multiply::<false>((self.hi, self.lo), (o.hi, o.lo)).into()
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;
    /// The remainder `hi − q o.hi` of a rounded quotient is exact; a second rounded quotient corrects q.
    #[inline]
    fn div(self, o: DoubleDouble) -> DoubleDouble {
        let q = self.hi / o.hi;
        let product = DoubleDouble::two_product(q, o.hi);
        let rest = ((self.hi - product.hi) - product.lo) + (self.lo - q * o.lo);
        DoubleDouble::quick_two_sum(q, rest / o.hi)
    }
}

#[cfg(test)]
mod tests;
