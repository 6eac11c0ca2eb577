//! Double-double numbers with an unbounded exponent, for fourth powers of a tilt of 1e-300.
//!
//! They have lanes, as [`DoubleDoubles`] do, so that kernels are written once for both; bodies that need them are set up one by
//! one.

use super::double_double::{DoubleDouble, DoubleDoubles};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Beyond this many bits the smaller of two terms is left out; up to it, sums are those of [`DoubleDoubles`] in the range of
/// floats.
const APART: i64 = 900;

/// `x · 2^exponent` in each lane, with `1 <= |x| < 2`, or 0 with the exponent 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wides<const W: usize, const FMA: bool> {
    x: DoubleDoubles<W, FMA>,
    exponent: [i64; W],
}

/// A single number.
pub(crate) type Wide = Wides<1, false>;

/// 2^n, if it is a normal number.
#[inline(always)]
pub(crate) fn exp2(n: i64) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

/// The exponent of a normal number; −1023 for 0, 1024 for what is not finite.
#[inline(always)]
fn exponent(x: f64) -> i64 {
    ((x.to_bits() >> 52) & 0x7ff) as i64 - 1023
}

impl<const W: usize, const FMA: bool> Wides<W, FMA> {
    /// `x · 2^exponent` of numbers that are 0 or far from the ends of the range of floats.
    #[inline(always)]
    fn normal(mut x: DoubleDoubles<W, FMA>, mut exponents: [i64; W]) -> Self {
        for l in 0..W {
            let own = exponent(x.hi[l]);
            let kept = x.hi[l] == 0.0 || own == 1024;
            let power = exp2(if kept { 0 } else { -own });
            x.hi[l] *= power;
            x.lo[l] *= power;
            exponents[l] = if kept { 0 } else { exponents[l] + own };
        }
        Wides { x, exponent: exponents }
    }

    /// That of lane l.
    #[inline(always)]
    pub fn lane(&self, l: usize) -> Wide {
        Wides { x: DoubleDoubles { hi: [self.x.hi[l]], lo: [self.x.lo[l]] }, exponent: [self.exponent[l]] }
    }

    /// Replaces that of lane l.
    pub fn put(&mut self, l: usize, one: Wide) {
        (self.x.hi[l], self.x.lo[l], self.exponent[l]) = (one.x.hi[0], one.x.lo[0], one.exponent[0]);
    }

    /// Numbers of the same signs, 0 for 0.
    #[inline(always)]
    pub fn signs(&self) -> &[f64; W] {
        &self.x.hi
    }

    /// `self` where the mask says so, else `other`.
    #[inline(always)]
    pub fn or(mut self, mask: &[bool; W], other: Self) -> Self {
        self.x = self.x.or(mask, other.x);
        for l in 0..W {
            self.exponent[l] = if mask[l] { self.exponent[l] } else { other.exponent[l] };
        }
        self
    }

    /// Each multiplied by 1 or −1.
    #[inline(always)]
    pub fn signed(self, signs: &[f64; W]) -> Self {
        Wides { x: self.x.scaled(signs), ..self }
    }

    /// Each divided by a power of two, a normal number.
    #[inline(always)]
    pub fn in_units(mut self, powers: &[f64; W]) -> Self {
        for l in 0..W {
            let shift = if self.x.hi[l] == 0.0 { 0 } else { exponent(powers[l]) };
            self.exponent[l] -= shift;
        }
        self
    }

    /// 0 for a negative number.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let (mut powers, mut exponents) = ([0.0; W], [0; W]);
        for l in 0..W {
            let odd = self.exponent[l] & 1;
            powers[l] = exp2(odd);
            exponents[l] = (self.exponent[l] - odd) >> 1;
        }
        Wides::normal(self.x.scaled(&powers).sqrt(), exponents)
    }

    /// An operation on numbers without exponents, whose exponents are added or subtracted.
    #[inline(always)]
    pub fn of_parts(
        self,
        o: Self,
        operation: impl Fn(DoubleDoubles<W, FMA>, DoubleDoubles<W, FMA>) -> DoubleDoubles<W, FMA>,
        sign: i64,
    ) -> Self {
        Wides::normal(operation(self.x, o.x), together(self.exponent, &o.exponent, sign))
    }

    /// In the range of floating point: 0 below it, infinite above.
    #[inline(always)]
    pub fn narrowed(self) -> DoubleDoubles<W, FMA> {
        let mut x = self.x;
        for l in 0..W {
            // In two steps, of which at most the second leaves the normal numbers.
            let whole = self.exponent[l].clamp(-1500, 1500);
            let half = whole >> 1;
            let (first, second) = (exp2(half), exp2(whole - half));
            x.hi[l] = x.hi[l] * first * second;
            x.lo[l] = x.lo[l] * first * second;
            x.lo[l] = if x.hi[l].abs() < f64::INFINITY { x.lo[l] } else { 0.0 };
        }
        x
    }
}

impl Wide {
    pub const ONE: Wide = Wides { x: DoubleDoubles { hi: [1.0], lo: [0.0] }, exponent: [0] };

    /// `x · 2^exponent`.
    pub fn of(x: DoubleDouble, exponent: i64) -> Wide {
        let mut number = Wide::from(x);
        if !number.is_zero() {
            number.exponent[0] += exponent;
        }
        number
    }

    /// x and the exponent.
    pub fn parts(self) -> (DoubleDouble, i64) {
        (self.x.lane(0), self.exponent[0])
    }

    #[inline]
    pub fn is_zero(self) -> bool {
        self.x.hi[0] == 0.0
    }

    #[inline]
    pub fn is_negative(self) -> bool {
        self.x.hi[0] < 0.0
    }

    #[inline]
    pub fn is_positive(self) -> bool {
        self.x.hi[0] > 0.0
    }

    /// In the range of floating point: 0 below it, infinite above.
    #[inline]
    pub fn narrow(self) -> DoubleDouble {
        self.narrowed().lane(0)
    }

    /// Rounded to the range of floating point.
    #[inline]
    pub fn value(self) -> f64 {
        self.narrow().value()
    }
}

impl<const W: usize, const FMA: bool> From<DoubleDoubles<W, FMA>> for Wides<W, FMA> {
    #[inline(always)]
    fn from(mut x: DoubleDoubles<W, FMA>) -> Self {
        // Subnormal numbers become normal, and the inverses of the largest powers of two would not be.
        let mut exponents = [0; W];
        for l in 0..W {
            let size = x.hi[l].abs();
            let shift = if size < exp2(-900) {
                900
            } else if size >= exp2(900) {
                -900
            } else {
                0
            };
            x.hi[l] *= exp2(shift);
            x.lo[l] *= exp2(shift);
            exponents[l] = -shift;
        }
        Wides::normal(x, exponents)
    }
}

impl<const W: usize, const FMA: bool> From<[f64; W]> for Wides<W, FMA> {
    #[inline(always)]
    fn from(hi: [f64; W]) -> Self {
        DoubleDoubles { hi, lo: [0.0; W] }.into()
    }
}

impl From<DoubleDouble> for Wide {
    #[inline]
    fn from(x: DoubleDouble) -> Wide {
        DoubleDoubles::all(x).into()
    }
}

impl From<f64> for Wide {
    #[inline]
    fn from(x: f64) -> Wide {
        [x].into()
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
        (*self - *o).x.hi[0].partial_cmp(&0.0)
    }
}

impl<const W: usize, const FMA: bool> Add for Wides<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let (mut large, mut small, mut exponents) = (self.x, o.x, [0; W]);
        for l in 0..W {
            let (a, b) = (self.exponent[l], o.exponent[l]);
            // The exponent of 0 says nothing.
            let swap = large.hi[l] == 0.0 || small.hi[l] != 0.0 && b > a;
            let apart = if swap { b - a } else { a - b };
            exponents[l] = if swap { b } else { a };
            let (hi, lo) = (large.hi[l], large.lo[l]);
            large.hi[l] = if swap { small.hi[l] } else { hi };
            large.lo[l] = if swap { small.lo[l] } else { lo };
            // A 0 may be apart by a negative number.
            let power = if (0..=APART).contains(&apart) { exp2(-apart) } else { 0.0 };
            small.hi[l] = power * if swap { hi } else { small.hi[l] };
            small.lo[l] = power * if swap { lo } else { small.lo[l] };
        }
        Wides::normal(large + small, exponents)
    }
}

impl<const W: usize, const FMA: bool> Neg for Wides<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Wides { x: -self.x, ..self }
    }
}

impl<const W: usize, const FMA: bool> Sub for Wides<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

/// Sums of two lists of exponents.
#[inline(always)]
fn together<const W: usize>(mut a: [i64; W], b: &[i64; W], sign: i64) -> [i64; W] {
    for l in 0..W {
        a[l] += sign * b[l];
    }
    a
}

impl<const W: usize, const FMA: bool> Mul for Wides<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.of_parts(o, Mul::mul, 1)
    }
}

impl<const W: usize, const FMA: bool> Div for Wides<W, FMA> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.of_parts(o, Div::div, -1)
    }
}

#[cfg(test)]
mod tests;
