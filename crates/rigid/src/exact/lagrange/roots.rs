//! Roots of the cubic of heavy tops, one top in each lane.

use crate::numerics::precise::{Precise, Real};
use polhode_ga::simd::lanes::Lanes;

/// The numbers of the start on which the roots depend.
#[derive(Clone, Copy)]
pub(super) struct Cubic<T> {
    pub gravity: T,
    pub spin: T,
    pub delta: T,
    pub surplus: T,
}

impl<T: Real> Cubic<T> {
    /// Half the second derivative by 2ĉ(u − 1), and by 1 − u, at u = 1.
    #[inline(always)]
    fn bend(self) -> T {
        self.gravity.twice() - self.surplus - self.spin * self.spin
    }

    /// The cubic, its derivative and half the second: above the upright by y = 2ĉ(u − 1), else by w = 1 − u.
    #[inline(always)]
    fn at<const ABOVE: bool>(self, x: T) -> [T; 3] {
        if ABOVE { self.above(x) } else { self.below(x) }
    }

    #[inline(always)]
    fn above(self, y: T) -> [T; 3] {
        let Cubic { gravity, spin, delta, surplus } = self;
        let (p, q, r) = (y * (gravity.twice() + y), y - surplus, gravity * delta - spin * y);
        let slope = ((gravity + y) * q + spin * r).twice() + p;
        [p * q - r * r, slope, self.bend() + y * T::all(3.0)]
    }

    #[inline(always)]
    fn below(self, w: T) -> [T; 3] {
        let Cubic { gravity, spin, delta, surplus } = self;
        let (p, q, r) = (w * (T::all(2.0) - w), surplus + gravity * w, delta + spin * w);
        let bend = self.bend();
        let third = gravity * w * T::all(3.0);
        let slope = (surplus - delta * spin + bend * w).twice() - third * w;
        [p * q - r * r, slope, bend - third]
    }
}

impl<N> Cubic<N> {
    /// The largest roots by Newton's method from starts above them, where `wanted`; the other roots are all >= 0 or all
    /// <= 0. While value and derivatives have the sign of the leading coefficient, there is no root above (Budan). The
    /// method begins beside the root that floats find, if that is above the root.
    #[inline(always)]
    pub fn largest_root<const ABOVE: bool, const W: usize, const FMA: bool>(
        self,
        start: N,
        wanted: &[bool; W],
    ) -> N
    where
        N: Precise<W, FMA>,
    {
        const STRIDE: f64 = 1.0 / (1u64 << 32) as f64;
        /// Above the rounding of the root of floats, and below the root of the rounding of double-double numbers.
        const MARGIN: f64 = 1e-12;
        let (mut near, mut begun) = self.floats().root::<ABOVE>(start.values(), wanted);
        for l in 0..W {
            near[l] *= 1.0 + MARGIN;
        }
        let near = N::from(near);
        let mut values = self.at::<ABOVE>(near);
        let is_above = have_no_root_above::<ABOVE, N, W, FMA>(&values);
        let mut open = [false; W];
        for l in 0..W {
            begun[l] &= is_above[l];
            open[l] = wanted[l] & !begun[l];
        }
        let mut x = near.or(&begun, start);
        for _ in 0..100 {
            if open == [false; W] {
                break;
            }
            let next = x * N::all(STRIDE);
            let is_above = have_no_root_above::<ABOVE, N, W, FMA>(&self.at::<ABOVE>(next));
            for l in 0..W {
                open[l] &= is_above[l];
            }
            x = next.or(&open, x);
        }
        if begun != [true; W] {
            values = self.at::<ABOVE>(x);
        }
        open = *wanted;
        for _ in 0..200 {
            let [value, slope, bend] = values;
            // The value has all digits, so that steps need no more than leading ones.
            let (step, flat) = (value.over_roughly(slope), slope.zeros());
            let least = x.times_roughly(N::all(1e-31));
            let small = step.at_most(least);
            for l in 0..W {
                open[l] &= !flat[l] & !small[l] & step.signs()[l].is_finite();
            }
            x = (x - step).or(&open, x);
            // The next step, to the leading order, and the rounding of this one.
            let next = step.times_roughly(step).times_roughly(bend);
            let next = next.abs().at_most(slope.times_roughly(least).abs());
            let rounded = step.abs().times_roughly(N::all(f64::EPSILON)).at_most(least);
            for l in 0..W {
                open[l] &= !(next[l] & rounded[l]);
            }
            if open == [false; W] {
                break;
            }
            values = self.at::<ABOVE>(x);
        }
        x
    }

    #[inline(always)]
    fn floats<const W: usize, const FMA: bool>(self) -> Cubic<Lanes<W, FMA>>
    where
        N: Precise<W, FMA>,
    {
        let Cubic { gravity, spin, delta, surplus } = self;
        Cubic {
            gravity: Lanes(gravity.values()),
            spin: Lanes(spin.values()),
            delta: Lanes(delta.values()),
            surplus: Lanes(surplus.values()),
        }
    }
}

/// Whether the cubic and its derivatives have the sign of the leading coefficient.
#[inline(always)]
fn have_no_root_above<const ABOVE: bool, N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    values: &[N; 3],
) -> [bool; W] {
    let (leading, mut found) = (if ABOVE { 1.0 } else { -1.0 }, [true; W]);
    for value in values {
        for l in 0..W {
            found[l] &= value.signs()[l] * leading > 0.0;
        }
    }
    found
}

impl<const W: usize, const FMA: bool> Cubic<Lanes<W, FMA>> {
    /// The same in floats, to a few roundings of a simple root, and whether it was found: not beyond their range.
    #[inline(always)]
    fn root<const ABOVE: bool>(self, mut x: [f64; W], wanted: &[bool; W]) -> ([f64; W], [bool; W]) {
        /// Terms of this size are far from underflow.
        const LEAST: f64 = 1e-200;
        let (mut open, mut found) = (*wanted, [false; W]);
        for _ in 0..60 {
            if open == [false; W] {
                break;
            }
            let [Lanes(value), Lanes(slope), _] = self.at::<ABOVE>(Lanes(x));
            for l in 0..W {
                let step = value[l] / slope[l];
                open[l] &= step.is_finite() & ((slope[l] * x[l]).abs() >= LEAST);
                x[l] = if open[l] { x[l] - step } else { x[l] };
                found[l] |= open[l] & (step.abs() <= 1e-9 * x[l]);
                open[l] &= !found[l];
            }
        }
        (x, found)
    }
}

/// The positive x and y with given `x y` and `y − x`.
#[inline(always)]
pub(super) fn factors<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    product: N,
    difference: N,
) -> [N; 2] {
    let root = (difference * difference + product.twice().twice()).sqrt();
    let large = (root + difference.abs()).half();
    let small = (product / large).or(&large.positive(), N::all(0.0));
    let negative = difference.negative();
    [large.or(&negative, small), small.or(&negative, large)]
}
