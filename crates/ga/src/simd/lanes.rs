//! SIMD arithmetic of many bodies, one number in each lane.
//!
//! Plain loops over lanes, which the compiler vectorises inside [`fastest`]. With `FUSED` a product and a sum are one
//! instruction, rounded once, so results differ by roundings from those of a single lane, which is not fused. Lanes are
//! independent of each other. Closures do not inherit the target features of their function, so arithmetic is in loops.

use super::Path;
use super::double;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// `W` numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const W: usize, const FUSED: bool>(pub [f64; W]);

/// A number for each lane, such as a time, that all mostly share. Cloning copies no more than there is.
#[derive(Clone, Debug)]
pub enum PerLane<const W: usize> {
    /// The same in each.
    Common(f64),
    /// Its own in each.
    Each([f64; W]),
}

impl<const W: usize> PerLane<W> {
    /// That of one lane.
    #[inline(always)]
    pub fn of(&self, lane: usize) -> f64 {
        match self {
            PerLane::Common(x) => *x,
            PerLane::Each(all) => all[lane],
        }
    }

    /// Those of all lanes.
    #[inline(always)]
    pub fn all(&self) -> [f64; W] {
        match self {
            PerLane::Common(x) => [*x; W],
            PerLane::Each(all) => *all,
        }
    }

    /// Whether the numbers are the same, also NaN and zeros; a common one differs from any of their own.
    #[inline(always)]
    pub fn has_bits_of(&self, other: &PerLane<W>) -> bool {
        match (self, other) {
            (PerLane::Common(a), PerLane::Common(b)) => a.to_bits() == b.to_bits(),
            (PerLane::Each(a), PerLane::Each(b)) => {
                let mut different = 0;
                for l in 0..W {
                    different |= a[l].to_bits() ^ b[l].to_bits();
                }
                different == 0
            }
            _ => false,
        }
    }
}

/// One number, as of a single body.
pub type One = Lanes<1, false>;

/// Work compiled for each instruction set and run with the best one of the machine.
pub trait Work {
    /// Its result.
    type Output;

    /// Runs it. `#[inline(always)]`, like all arithmetic that it calls; `FUSED` for [`Lanes`].
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// Runs the work with the widest instructions of this machine.
pub fn fastest<T: Work>(work: T) -> T::Output {
    Path::best().run(work)
}

/// The same, but None on a machine without wide instructions. For large work that can be done one by one: without wide
/// instructions its code in lanes is the longest of all, and hardly faster.
pub fn with_wide_instructions<T: Work>(work: T) -> Option<T::Output> {
    Path::best().run_if_wide(work)
}

/// Work that says that it was done.
pub(super) struct Done<T>(pub T);

impl<T: Work> Done<T> {
    /// For machines without wide instructions.
    pub fn left_undone(self) -> Option<T::Output> {
        None
    }
}

impl<T: Work> Work for Done<T> {
    type Output = Option<T::Output>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Option<T::Output> {
        Some(self.0.run::<FUSED>())
    }
}

impl<const W: usize, const FUSED: bool> Lanes<W, FUSED> {
    /// 0 in each.
    pub const ZERO: Self = Lanes([0.0; W]);

    /// The same number in each.
    #[inline(always)]
    pub fn all(x: f64) -> Self {
        Lanes([x; W])
    }
}

/// Functions of a lane, for each of them.
macro_rules! lane_functions {
    ($($(#[$doc:meta])* $name:ident($x:ident $(, $other:ident)*) $value:expr;)*) => {
        impl<const W: usize, const FUSED: bool> Lanes<W, FUSED> { $(
            $(#[$doc])*
            #[inline(always)]
            pub fn $name(self $(, $other: Self)*) -> Self {
                let mut result = self;
                for l in 0..W {
                    let ($x, $($other),*) = (self.0[l], $($other.0[l]),*);
                    result.0[l] = $value;
                }
                result
            }
        )* }
    };
}

lane_functions! {
    /// `self · b + c`.
    times_plus(x, b, c) if FUSED { x.mul_add(b, c) } else { x * b + c };
    /// `c − self · b`.
    times_from(x, b, c) if FUSED { (-x).mul_add(b, c) } else { c - x * b };
    /// Square roots.
    sqrt(x) x.sqrt();
    /// Magnitudes.
    abs(x) x.abs();
    /// The angle in [0, π/2] whose tangent is `self/|s|`, for `self >= 0` and not both 0, to a few relative roundings.
    angle(x, s) double::angle(x, s);
    /// The larger of two; a NaN of `self` is lost.
    max(x, other) if x > other { x } else { other };
}

impl<const W: usize, const FUSED: bool> Lanes<W, FUSED> {
    /// `self` where the mask says so, else `other`.
    #[inline(always)]
    pub fn or(self, mask: &[bool; W], other: Self) -> Self {
        let mut result = other;
        for l in 0..W {
            result.0[l] = if mask[l] { self.0[l] } else { other.0[l] };
        }
        result
    }
}

impl One {
    /// Each number as a single lane.
    #[inline(always)]
    pub fn each<const N: usize>(numbers: [f64; N]) -> [One; N] {
        numbers.map(|x| Lanes([x]))
    }

    /// The inverse of [`One::each`].
    #[inline(always)]
    pub fn alone<const N: usize>(lanes: [One; N]) -> [f64; N] {
        lanes.map(|Lanes([x])| x)
    }
}

macro_rules! lane_by_lane {
    ($($trait:ident $method:ident $sign:tt),*) => { $(
        impl<const W: usize, const FUSED: bool> $trait for Lanes<W, FUSED> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut result = self;
                for l in 0..W {
                    result.0[l] = self.0[l] $sign other.0[l];
                }
                result
            }
        }
    )* };
}

lane_by_lane!(Add add +, Sub sub -, Mul mul *, Div div /);

impl<const W: usize, const FUSED: bool> AddAssign for Lanes<W, FUSED> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const W: usize, const FUSED: bool> Neg for Lanes<W, FUSED> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let mut result = self;
        for x in &mut result.0 {
            *x = -*x;
        }
        result
    }
}

/// The dot product of two vectors, or of two axial ones.
#[inline(always)]
pub fn dot<const W: usize, const F: bool>(a: &[Lanes<W, F>; 3], b: &[Lanes<W, F>; 3]) -> Lanes<W, F> {
    a[2].times_plus(b[2], a[1].times_plus(b[1], a[0] * b[0]))
}

/// The cross product: `a∧b` by its components.
#[inline(always)]
pub fn cross<const W: usize, const F: bool>(a: &[Lanes<W, F>; 3], b: &[Lanes<W, F>; 3]) -> [Lanes<W, F>; 3] {
    [
        a[2].times_from(b[1], a[1] * b[2]),
        a[0].times_from(b[2], a[2] * b[0]),
        a[1].times_from(b[0], a[0] * b[1]),
    ]
}

/// `S R` of even elements by their components `(1, e2e3, e3e1, e1e2)`.
#[inline(always)]
pub fn composed<const W: usize, const F: bool>(
    s: &[Lanes<W, F>; 4],
    r: &[Lanes<W, F>; 4],
) -> [Lanes<W, F>; 4] {
    // The planes are the negatives of the quaternion units: `B1 B2 = −B3`.
    [
        s[3].times_from(r[3], s[2].times_from(r[2], s[1].times_from(r[1], s[0] * r[0]))),
        s[3].times_plus(r[2], s[2].times_from(r[3], s[1].times_plus(r[0], s[0] * r[1]))),
        s[1].times_plus(r[3], s[3].times_from(r[1], s[2].times_plus(r[0], s[0] * r[2]))),
        s[2].times_plus(r[1], s[1].times_from(r[2], s[3].times_plus(r[0], s[0] * r[3]))),
    ]
}

/// The matrix of a rotor, `(R e_j ~R)·e_i` in row i and column j; of any even element times its squared norm.
#[inline(always)]
pub fn matrix<const W: usize, const F: bool>(r: &[Lanes<W, F>; 4]) -> [[Lanes<W, F>; 3]; 3] {
    let [s, x, y, z] = *r;
    let two = Lanes::all(2.0);
    // With `B = (x, y, z)`: `(s² − B²) v + 2 (B·v) B − 2 s (B × v)` for the axial vector B.
    let (s2, x2, y2, z2) = (s * s, x * x, y * y, z * z);
    let (xy, yz, zx) = (x * y, y * z, z * x);
    [
        [(s2 + x2) - (y2 + z2), two * s.times_plus(z, xy), two * s.times_from(y, zx)],
        [two * s.times_from(z, xy), (s2 + y2) - (z2 + x2), two * s.times_plus(x, yz)],
        [two * s.times_plus(y, zx), two * s.times_from(x, yz), (s2 + z2) - (x2 + y2)],
    ]
}

/// A matrix times a vector.
#[inline(always)]
pub fn mapped<const W: usize, const F: bool>(
    m: &[[Lanes<W, F>; 3]; 3],
    v: &[Lanes<W, F>; 3],
) -> [Lanes<W, F>; 3] {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

/// The transpose of a matrix times a vector: the inverse of a rotation.
#[inline(always)]
pub fn mapped_back<const W: usize, const F: bool>(
    m: &[[Lanes<W, F>; 3]; 3],
    v: &[Lanes<W, F>; 3],
) -> [Lanes<W, F>; 3] {
    [
        dot(&[m[0][0], m[1][0], m[2][0]], v),
        dot(&[m[0][1], m[1][1], m[2][1]], v),
        dot(&[m[0][2], m[1][2], m[2][2]], v),
    ]
}

#[cfg(test)]
mod tests;
