//! Whether heavy tops keep their energies, one top in each lane.

use super::start::{LEAST, Starts, square};
use crate::exact::free::power_of_two;
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::precise::Precise;

/// `|w|² + 2ĉu` at the start, relative to the nearer pole, with tilts and rates in units of their own largest: floats hold
/// them for any.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energies<const W: usize> {
    /// Whether u > 0 at the start.
    upper: [bool; W],
    /// Powers of two next below the largest |w| with its rounding and the largest distance from the pole, |β| or |α|.
    rate: [f64; W],
    tilt: [f64; W],
    /// |w|².
    across: [f64; W],
    /// `1 − u` or `1 + u`, in double-double precision.
    distance: [[f64; W]; 2],
    /// 2ĉ times the square of the unit of tilts over the square of that of rates.
    gravity: [f64; W],
    /// The largest change of the energy from rounding.
    most: [f64; W],
}

impl<const W: usize> Energies<W> {
    /// From starts, and the largest |α|, |β| and |w|.
    #[inline(always)]
    pub fn new<N: Precise<W, FMA>, const FMA: bool>(
        starts: &Starts<N, W, FMA>,
        sizes: &[[f64; W]; 3],
    ) -> Energies<W> {
        /// The rounding of a tilt of 1e-300 is 1e-13 of it.
        const MOST: f64 = 1e-10;
        let upper = N::all(1.0).exceeds(starts.below);
        let (mut rate, mut tilt, mut most) = ([0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            let largest = sizes[2][l];
            // The rounding of the rate about the axis, in body axes.
            let spin = starts.omega3[l].abs() / starts.scale[l] * f64::EPSILON * 8.0 + LEAST;
            rate[l] = power_of_two([largest + spin; 3]);
            tilt[l] = power_of_two([if upper[l] { sizes[1][l] } else { sizes[0][l] }; 3]);
            let (largest, spin) = (largest / rate[l], spin / rate[l]);
            most[l] = MOST * (largest * largest) + (largest + spin) * spin;
        }
        let distance = starts.below.or(&upper, starts.above).in_units(&tilt).in_units(&tilt).narrowed();
        let tilts = N::from(tilt);
        let gravity = (starts.gravity * tilts * tilts).in_units(&rate).in_units(&rate).values();
        let across = square(starts.w).in_units(&rate).in_units(&rate).values();
        Energies { upper, rate, tilt, across, distance: [distance.hi, distance.lo], gravity, most }
    }

    /// Whether they are those of the start, from the rotors of the axes of the tops and the rates about these.
    #[inline(always)]
    pub fn are_kept<const FMA: bool>(
        &self,
        [a, b, c, d]: &[[f64; W]; 4],
        [x, y, _]: &[[f64; W]; 3],
        scale: &[f64; W],
    ) -> [bool; W] {
        let (mut first, mut second) = ([0.0; W], [0.0; W]);
        for l in 0..W {
            let upper = self.upper[l];
            first[l] = if upper { b[l] } else { a[l] } / self.tilt[l];
            second[l] = if upper { c[l] } else { d[l] } / self.tilt[l];
        }
        let (first, second) = (DoubleDoubles::<W, FMA>::from(first), DoubleDoubles::from(second));
        let [hi, lo] = self.distance;
        // 1 ∓ u = 2 (b² + c²) or 2 (a² + d²): the difference of two that are nearly equal.
        let twice = DoubleDoubles::all(DoubleDouble::from(2.0));
        let rise = DoubleDoubles { hi, lo } - (first * first + second * second) * twice;
        let mut kept = [false; W];
        for l in 0..W {
            let (x, y) = (x[l] / scale[l] / self.rate[l], y[l] / scale[l] / self.rate[l]);
            let rise = if self.upper[l] { rise.hi[l] } else { -rise.hi[l] };
            let change = (x * x + y * y - self.across[l]) + self.gravity[l] * rise;
            kept[l] = change.abs() <= self.most[l];
        }
        kept
    }
}

#[cfg(test)]
mod tests;
