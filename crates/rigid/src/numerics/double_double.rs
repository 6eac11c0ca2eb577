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

    /// `a b` without error.
    #[inline]
    pub fn two_product(a: f64, b: f64) -> DoubleDouble {
        double::two_product::<false>(a, b).into()
    }

    #[inline]
    pub fn sqrt(self) -> DoubleDouble {
        root::<false>((self.hi, self.lo)).into()
    }

    #[inline]
    pub fn value(self) -> f64 {
        self.hi + self.lo
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
        double::quick_two_sum(q, rest / o.hi).into()
    }
}

/// The quotient by a number whose reciprocal is a normal one, with a single division: the remainder `a − q b` of the high
/// parts is also exact for a quotient q to a few roundings.
#[inline(always)]
fn quotient<const FMA: bool>(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let reciprocal = 1.0 / b.0;
    let q = a.0 * reciprocal;
    let product = double::two_product::<FMA>(q, b.0);
    let rest = ((a.0 - product.0) - product.1) + (a.1 - q * b.1);
    double::quick_two_sum(q, rest * reciprocal)
}

/// The square root by one Newton step from that of the high part; 0 for a negative number.
#[inline(always)]
fn root<const FMA: bool>(x: (f64, f64)) -> (f64, f64) {
    let root = x.0.sqrt();
    let square = double::two_product::<FMA>(root, root);
    let rest = ((x.0 - square.0) - square.1) + x.1;
    let (hi, lo) = double::quick_two_sum(root, rest / (2.0 * root));
    if x.0 <= 0.0 { (0.0, 0.0) } else { (hi, lo) }
}

/// `W` double-double numbers, one in each lane. With `FMA` the rounding error of a product takes one instruction, for the
/// same bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleDoubles<const W: usize, const FMA: bool> {
    pub hi: [f64; W],
    pub lo: [f64; W],
}

impl<const W: usize, const FMA: bool> DoubleDoubles<W, FMA> {
    /// The same number in each lane.
    #[inline(always)]
    pub fn all(x: DoubleDouble) -> Self {
        DoubleDoubles { hi: [x.hi; W], lo: [x.lo; W] }
    }

    /// That of lane l.
    #[inline(always)]
    pub fn lane(&self, l: usize) -> DoubleDouble {
        DoubleDouble { hi: self.hi[l], lo: self.lo[l] }
    }

    /// Sums of numbers of the same sign: nothing cancels, so that the low parts need no exact sum.
    #[inline(always)]
    pub fn plus(mut self, o: Self) -> Self {
        for l in 0..W {
            let (hi, e) = double::two_sum(self.hi[l], o.hi[l]);
            (self.hi[l], self.lo[l]) = double::quick_two_sum(hi, e + (self.lo[l] + o.lo[l]));
        }
        self
    }

    #[inline(always)]
    pub fn sqrt(mut self) -> Self {
        for l in 0..W {
            (self.hi[l], self.lo[l]) = root::<FMA>((self.hi[l], self.lo[l]));
        }
        self
    }

    /// Each multiplied by a power of two, of either sign.
    #[inline(always)]
    pub fn scaled(mut self, powers: &[f64; W]) -> Self {
        for l in 0..W {
            self.hi[l] *= powers[l];
            self.lo[l] *= powers[l];
        }
        self
    }

    /// Magnitudes.
    #[inline(always)]
    pub fn abs(mut self) -> Self {
        for l in 0..W {
            let sign = if self.hi[l] < 0.0 { -1.0 } else { 1.0 };
            self.hi[l] *= sign;
            self.lo[l] *= sign;
        }
        self
    }

    /// `self` where the mask says so, else `other`.
    #[inline(always)]
    pub fn or(mut self, mask: &[bool; W], other: Self) -> Self {
        for l in 0..W {
            self.hi[l] = if mask[l] { self.hi[l] } else { other.hi[l] };
            self.lo[l] = if mask[l] { self.lo[l] } else { other.lo[l] };
        }
        self
    }
}

impl<const W: usize, const FMA: bool> From<[f64; W]> for DoubleDoubles<W, FMA> {
    #[inline(always)]
    fn from(hi: [f64; W]) -> Self {
        DoubleDoubles { hi, lo: [0.0; W] }
    }
}

/// An operator in each lane, by a function of pairs.
macro_rules! lane_operators {
    ($($operator:ident $name:ident $function:expr;)*) => { $(
        impl<const W: usize, const FMA: bool> $operator for DoubleDoubles<W, FMA> {
            type Output = Self;
            #[inline(always)]
            fn $name(mut self, o: Self) -> Self {
                for l in 0..W {
                    (self.hi[l], self.lo[l]) = $function((self.hi[l], self.lo[l]), (o.hi[l], o.lo[l]));
                }
                self
            }
        }
    )* };
}

lane_operators! {
    Add add double::add;
    Mul mul double::multiply::<FMA>;
    Div div quotient::<FMA>;
}

impl<const W: usize, const FMA: bool> Neg for DoubleDoubles<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.scaled(&[-1.0; W])
    }
}

impl<const W: usize, const FMA: bool> Sub for DoubleDoubles<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

#[cfg(test)]
mod tests;
