//! Double-double numbers with an unbounded exponent, for fourth powers of a tilt of 1e-300.

use super::double_double::DoubleDouble;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Beyond this many bits the smaller of two terms is below the last digit of the larger one.
const DIGITS: i64 = 128;

/// `x · 2^exponent`, with `1 <= |x| < 2`, or 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wide {
    x: DoubleDouble,
    exponent: i64,
}

/// 2^n, if it is a normal number.
#[inline]
pub(crate) fn exp2(n: i64) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

/// Times a power of two, without rounding unless the result is subnormal.
#[inline]
fn scaled(x: DoubleDouble, power: f64) -> DoubleDouble {
    DoubleDouble { hi: x.hi * power, lo: x.lo * power }
}

impl Wide {
    pub const ZERO: Wide = Wide { x: DoubleDouble::ZERO, exponent: 0 };
    pub const ONE: Wide = Wide { x: DoubleDouble::ONE, exponent: 0 };

    /// `x · 2^exponent` of a normal number x, or 0.
    #[inline]
    pub fn normal(x: DoubleDouble, exponent: i64) -> Wide {
        if x.hi == 0.0 {
            return Wide::ZERO;
        }
        let own = ((x.hi.to_bits() >> 52) & 0x7ff) as i64 - 1023;
        if own == 1024 {
            return Wide { x, exponent: 0 };
        }
        // 2^−1023, by which the largest floats are scaled, is not a normal number.
        let (x, left) = if own == 1023 { (scaled(x, 0.5), own - 1) } else { (x, own) };
        Wide { x: scaled(x, exp2(-left)), exponent: exponent + own }
    }

    /// x and the exponent.
    #[inline]
    pub fn parts(self) -> (DoubleDouble, i64) {
        (self.x, self.exponent)
    }

    #[inline]
    pub fn is_zero(self) -> bool {
        self.x.hi == 0.0
    }

    #[inline]
    pub fn is_negative(self) -> bool {
        self.x.hi < 0.0
    }

    #[inline]
    pub fn is_positive(self) -> bool {
        self.x.hi > 0.0
    }

    pub fn is_finite(self) -> bool {
        self.x.hi.is_finite()
    }

    #[inline]
    pub fn abs(self) -> Wide {
        if self.is_negative() { -self } else { self }
    }

    /// 0 for a negative number.
    #[inline]
    pub fn sqrt(self) -> Wide {
        if !self.is_positive() {
            return Wide::ZERO;
        }
        let odd = self.exponent.rem_euclid(2);
        let root = scaled(self.x, exp2(odd)).sqrt();
        Wide::normal(root, (self.exponent - odd) / 2)
    }

    /// In the range of floating point: 0 below it, infinite above.
    #[inline]
    pub fn narrow(self) -> DoubleDouble {
        if self.exponent.abs() < 900 {
            // Also of the low part, a normal number.
            return scaled(self.x, exp2(self.exponent));
        }
        // In two steps, of which at most the second leaves the normal numbers.
        let exponent = self.exponent.clamp(-1500, 1500);
        let half = exponent / 2;
        let x = scaled(scaled(self.x, exp2(half)), exp2(exponent - half));
        if x.hi.is_finite() { x } else { x.hi.into() }
    }

    /// Rounded to the range of floating point.
    #[inline]
    pub fn value(self) -> f64 {
        self.narrow().value()
    }
}

impl From<DoubleDouble> for Wide {
    #[inline]
    fn from(x: DoubleDouble) -> Wide {
        // Subnormal numbers become normal.
        if x.hi.abs() < exp2(-900) { Wide::normal(scaled(x, exp2(900)), -900) } else { Wide::normal(x, 0) }
    }
}

impl From<f64> for Wide {
    #[inline]
    fn from(x: f64) -> Wide {
        DoubleDouble::from(x).into()
    }
}

impl PartialEq for Wide {
    #[inline]
    fn eq(&self, o: &Wide) -> bool {
        self.partial_cmp(o) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Wide {
    #[inline]
    fn partial_cmp(&self, o: &Wide) -> Option<Ordering> {
        (*self - *o).x.hi.partial_cmp(&0.0)
    }
}

impl Add for Wide {
    type Output = Wide;
    #[inline]
    fn add(self, o: Wide) -> Wide {
        let (large, small) =
            if self.is_zero() || !o.is_zero() && o.exponent > self.exponent { (o, self) } else { (self, o) };
        let apart = large.exponent - small.exponent;
        if small.is_zero() || apart > DIGITS {
            return large;
        }
        Wide::normal(large.x + scaled(small.x, exp2(-apart)), large.exponent)
    }
}

impl Neg for Wide {
    type Output = Wide;
    #[inline]
    fn neg(self) -> Wide {
        Wide { x: -self.x, ..self }
    }
}

impl Sub for Wide {
    type Output = Wide;
    #[inline]
    fn sub(self, o: Wide) -> Wide {
        self + -o
    }
}

impl Mul for Wide {
    type Output = Wide;
    #[inline]
    fn mul(self, o: Wide) -> Wide {
        Wide::normal(self.x * o.x, self.exponent + o.exponent)
    }
}

impl Div for Wide {
    type Output = Wide;
    #[inline]
    fn div(self, o: Wide) -> Wide {
        Wide::normal(self.x / o.x, self.exponent - o.exponent)
    }
}

#[cfg(test)]
mod tests;
