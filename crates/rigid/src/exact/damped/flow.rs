//! States of a damped body at any time: those of the free body at the time τ, of one motion or of `C` in lanes.

use crate::exact::free::flow::Flow as FreeFlow;
use crate::exact::free::series::Series;
use crate::exact::lanes::Coefficients;
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::lanes::{exp_of_pairs, in_lane};
use polhode_ga::rows::curve::Curve;
use polhode_ga::simd::double::{quick_two_sum, two_product};

/// Where `gt` is smaller, τ is t to rounding.
const STILL: f64 = 1e-200;

/// A torque with a smaller g has no effect up to any horizon.
const NONE: f64 = 1e-300;

/// Exponents from which the exponential vanishes beside the rates.
const VANISHED: f64 = 720.0;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow<S, const C: usize = 1> {
    /// Of the free body.
    pub free: FreeFlow<S, C>,
    /// The g of the torque, and 1/g; 0 for both where no time is long enough for an effect.
    pub damping: [f64; C],
    pub per_damping: [f64; C],
}

impl<S, const C: usize> Flow<S, C> {
    /// From the motions of the free bodies.
    pub fn new(free: FreeFlow<S, C>, g: [f64; C]) -> Flow<S, C> {
        let damping = g.map(|g| if g.abs() < NONE { 0.0 } else { g });
        let per_damping = damping.map(|g| if g == 0.0 { 0.0 } else { 1.0 / g });
        Flow { free, damping, per_damping }
    }
}

impl<S: Series<C>, const C: usize> Coefficients<C> for Flow<S, C> {
    type One = Flow<S::One>;

    fn empty() -> Flow<S, C> {
        Flow { free: FreeFlow::empty(), damping: [0.0; C], per_damping: [0.0; C] }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        self.free.each().chain([&mut self.damping, &mut self.per_damping])
    }
}

impl<S: Series<C>, const C: usize> Curve<4, 3> for Flow<S, C> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let (mut g, mut per_g) = ([0.0; W], [0.0; W]);
        for l in 0..W {
            (g[l], per_g[l]) = (in_lane(&self.damping, l), in_lane(&self.per_damping, l));
        }
        let (tau, factor) = times_and_factors::<W, FMA>(&g, &per_g, times);
        let (rotor, mut omega) = self.free.states::<W, FMA>(&tau);
        for k in 0..3 {
            for l in 0..W {
                omega[k][l] *= factor[l];
            }
        }
        (rotor, omega)
    }
}

/// The times τ of the free body in double-double precision, and `e^{−gt}`.
#[inline(always)]
fn times_and_factors<const W: usize, const FMA: bool>(
    g: &[f64; W],
    per_g: &[f64; W],
    times: &[f64; W],
) -> (DoubleDoubles<W, FMA>, [f64; W]) {
    let zeros = DoubleDoubles::all(DoubleDouble::ZERO);
    let (mut exponents, mut tau, mut factor) = (zeros, zeros, [0.0; W]);
    for l in 0..W {
        let (hi, lo) = two_product::<FMA>(-g[l], times[l]);
        let vanished = hi < -VANISHED;
        exponents.hi[l] = if vanished { -VANISHED } else { hi };
        exponents.lo[l] = if vanished { 0.0 } else { lo };
    }
    let [factors, less] = exp_of_pairs::<W, FMA>(&exponents);
    for l in 0..W {
        // (1 − e^{−gt})/g: the quotient to a few roundings, and that of the remainder.
        let still = less.hi[l].abs() < STILL;
        let quotient = -less.hi[l] * per_g[l];
        let (product, error) = two_product::<FMA>(quotient, g[l]);
        let rest = (((-less.hi[l] - product) - error) - less.lo[l]) * per_g[l];
        let (hi, lo) = quick_two_sum(quotient, rest);
        (tau.hi[l], tau.lo[l]) = (if still { times[l] } else { hi }, if still { 0.0 } else { lo });
        factor[l] = factors.hi[l] + factors.lo[l];
    }
    (tau, factor)
}
