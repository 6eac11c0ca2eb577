//! Double-double numbers in lanes, in the range of floats or beyond it: kernels are written once for both.
//!
//! In the range of floats, [`DoubleDoubles`] take a third of the instructions of [`Wides`] and have the same bits: powers of
//! two commute with all operations here, as long as no number or low part leaves the range.

use super::double_double::{DoubleDouble, DoubleDoubles};
use super::wide::{Wide, Wides};
use polhode_ga::simd::lanes::Lanes;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Real numbers, in lanes.
pub(crate) trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same number in each lane.
    fn all(x: f64) -> Self;

    /// Twice each, without a rounding.
    fn twice(self) -> Self;
}

impl<const W: usize, const FUSED: bool> Real for Lanes<W, FUSED> {
    #[inline(always)]
    fn all(x: f64) -> Self {
        Lanes([x; W])
    }

    #[inline(always)]
    fn twice(self) -> Self {
        self + self
    }
}

impl<const W: usize, const FMA: bool> Real for DoubleDoubles<W, FMA> {
    #[inline(always)]
    fn all(x: f64) -> Self {
        [x; W].into()
    }

    #[inline(always)]
    fn twice(self) -> Self {
        self.scaled(&[2.0; W])
    }
}

impl<const W: usize, const FMA: bool> Real for Wides<W, FMA> {
    #[inline(always)]
    fn all(x: f64) -> Self {
        [x; W].into()
    }

    #[inline(always)]
    fn twice(self) -> Self {
        self.in_units(&[0.5; W])
    }
}

/// Double-double numbers in lanes.
pub(crate) trait Precise<const W: usize, const FMA: bool>:
    Real + Div<Output = Self> + Neg<Output = Self> + From<[f64; W]> + From<DoubleDoubles<W, FMA>>
{
    /// That of lane l.
    fn lane(&self, l: usize) -> Wide;

    /// Replaces that of lane l.
    fn put(&mut self, l: usize, one: Wide);

    /// Numbers of the same signs, 0 for 0.
    fn signs(&self) -> &[f64; W];

    /// `self` where the mask says so, else `other`.
    fn or(self, mask: &[bool; W], other: Self) -> Self;

    /// Each multiplied by 1 or −1.
    fn signed(self, signs: &[f64; W]) -> Self;

    /// Each divided by a power of two, a normal number with a normal reciprocal.
    fn in_units(self, powers: &[f64; W]) -> Self;

    /// 0 for a negative number.
    fn sqrt(self) -> Self;

    /// Products and quotients of the high parts, to a few roundings of floats: for what needs no more digits.
    fn times_roughly(self, o: Self) -> Self;
    fn over_roughly(self, o: Self) -> Self;

    /// In the range of floats: 0 below it, infinite above.
    fn narrowed(self) -> DoubleDoubles<W, FMA>;

    /// Whether each is 0.
    #[inline(always)]
    fn zeros(&self) -> [bool; W] {
        let mut zeros = [false; W];
        for l in 0..W {
            zeros[l] = self.signs()[l] == 0.0;
        }
        zeros
    }

    /// Whether each is positive.
    #[inline(always)]
    fn positive(&self) -> [bool; W] {
        let mut positive = [false; W];
        for l in 0..W {
            positive[l] = self.signs()[l] > 0.0;
        }
        positive
    }

    /// Whether each is negative.
    #[inline(always)]
    fn negative(&self) -> [bool; W] {
        (-*self).positive()
    }

    /// −1 for negative numbers, else 1.
    #[inline(always)]
    fn unit_signs(&self) -> [f64; W] {
        let mut signs = [1.0; W];
        for l in 0..W {
            signs[l] = if self.signs()[l] < 0.0 { -1.0 } else { 1.0 };
        }
        signs
    }

    /// Whether each is more than the other.
    #[inline(always)]
    fn exceeds(self, o: Self) -> [bool; W] {
        (self - o).positive()
    }

    /// Whether each is at most the other.
    #[inline(always)]
    fn at_most(self, o: Self) -> [bool; W] {
        let (difference, mut result) = (self - o, [false; W]);
        for l in 0..W {
            result[l] = difference.signs()[l] <= 0.0;
        }
        result
    }

    /// Magnitudes.
    #[inline(always)]
    fn abs(self) -> Self {
        self.signed(&self.unit_signs())
    }

    /// Half of each, without a rounding.
    #[inline(always)]
    fn half(self) -> Self {
        self.in_units(&[2.0; W])
    }

    /// Rounded to the range of floats.
    #[inline(always)]
    fn values(self) -> [f64; W] {
        let (x, mut values) = (self.narrowed(), [0.0; W]);
        for l in 0..W {
            values[l] = x.hi[l] + x.lo[l];
        }
        values
    }
}

impl<const W: usize, const FMA: bool> Precise<W, FMA> for DoubleDoubles<W, FMA> {
    #[inline(always)]
    fn lane(&self, l: usize) -> Wide {
        DoubleDouble { hi: self.hi[l], lo: self.lo[l] }.into()
    }

    #[inline(always)]
    fn put(&mut self, l: usize, one: Wide) {
        let one = one.narrow();
        (self.hi[l], self.lo[l]) = (one.hi, one.lo);
    }

    #[inline(always)]
    fn signs(&self) -> &[f64; W] {
        &self.hi
    }

    #[inline(always)]
    fn or(self, mask: &[bool; W], other: Self) -> Self {
        DoubleDoubles::or(self, mask, other)
    }

    #[inline(always)]
    fn signed(self, signs: &[f64; W]) -> Self {
        self.scaled(signs)
    }

    #[inline(always)]
    fn in_units(self, powers: &[f64; W]) -> Self {
        let mut reciprocals = [1.0; W];
        for l in 0..W {
            reciprocals[l] = 1.0 / powers[l];
        }
        self.scaled(&reciprocals)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        DoubleDoubles::sqrt(self)
    }

    #[inline(always)]
    fn times_roughly(mut self, o: Self) -> Self {
        for l in 0..W {
            (self.hi[l], self.lo[l]) = (self.hi[l] * o.hi[l], 0.0);
        }
        self
    }

    #[inline(always)]
    fn over_roughly(mut self, o: Self) -> Self {
        for l in 0..W {
            (self.hi[l], self.lo[l]) = (self.hi[l] / o.hi[l], 0.0);
        }
        self
    }

    /// By their parts, which is exact for finite numbers: the high part is the rounded sum of both.
    #[inline(always)]
    fn exceeds(self, o: Self) -> [bool; W] {
        let mut result = [false; W];
        for l in 0..W {
            let (more, same) = (self.hi[l] > o.hi[l], self.hi[l] == o.hi[l]);
            result[l] = more | (same & (self.lo[l] > o.lo[l]));
        }
        result
    }

    #[inline(always)]
    fn at_most(self, o: Self) -> [bool; W] {
        let mut result = [false; W];
        for l in 0..W {
            let (less, same) = (self.hi[l] < o.hi[l], self.hi[l] == o.hi[l]);
            result[l] = less | (same & (self.lo[l] <= o.lo[l]));
        }
        result
    }

    #[inline(always)]
    fn narrowed(mut self) -> Self {
        for l in 0..W {
            self.lo[l] = if self.hi[l].abs() < f64::INFINITY { self.lo[l] } else { 0.0 };
        }
        self
    }
}

impl<const W: usize, const FMA: bool> Precise<W, FMA> for Wides<W, FMA> {
    #[inline(always)]
    fn lane(&self, l: usize) -> Wide {
        Wides::lane(self, l)
    }

    #[inline(always)]
    fn put(&mut self, l: usize, one: Wide) {
        Wides::put(self, l, one);
    }

    #[inline(always)]
    fn signs(&self) -> &[f64; W] {
        Wides::signs(self)
    }

    #[inline(always)]
    fn or(self, mask: &[bool; W], other: Self) -> Self {
        Wides::or(self, mask, other)
    }

    #[inline(always)]
    fn signed(self, signs: &[f64; W]) -> Self {
        Wides::signed(self, signs)
    }

    #[inline(always)]
    fn in_units(self, powers: &[f64; W]) -> Self {
        Wides::in_units(self, powers)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Wides::sqrt(self)
    }

    #[inline(always)]
    fn times_roughly(self, o: Self) -> Self {
        self.of_parts(o, Precise::times_roughly, 1)
    }

    #[inline(always)]
    fn over_roughly(self, o: Self) -> Self {
        self.of_parts(o, Precise::over_roughly, -1)
    }

    #[inline(always)]
    fn narrowed(self) -> DoubleDoubles<W, FMA> {
        Wides::narrowed(self)
    }
}

#[cfg(test)]
mod tests;
