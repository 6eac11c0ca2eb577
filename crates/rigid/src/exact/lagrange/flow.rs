//! States of a heavy top at any time: phases, series and frames, of one motion or of `C` in lanes.

use super::series::{Series, State};
use crate::exact::lanes::{Coefficients, Phases, mapped, unit_rotor};
use crate::numerics::lanes::{in_lane, sin_cos_turns};
use polhode_ga::rows::curve::Curve;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow<S, const C: usize = 1> {
    /// Of time.
    pub scale: [f64; C],
    /// v.
    pub orbit: Phases<C>,
    /// Phases of α, β and the rate across the axis.
    pub phases: [Phases<C>; 3],
    pub series: S,
    /// Complex factors of the three.
    pub factors: [[[f64; C]; 2]; 3],
    /// Rotor components for the real and imaginary parts of α and of β.
    pub rotor: [[[f64; C]; 4]; 4],
    /// Components of the angular velocity in body axes for w and for 1.
    pub omega: [[[f64; C]; 3]; 3],
}

impl<S: Series<C>, const C: usize> Flow<S, C> {
    /// The three functions before their factors and the denominator of the series.
    #[inline(always)]
    pub fn turned<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> State<W> {
        let (mut t, mut v, mut v_rest) = ([0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            t[l] = times[l] * in_lane(&self.scale, l);
            (v[l], v_rest[l]) = self.orbit.of(l).turns::<FMA>(t[l]);
        }
        let mut state = self.series.state::<W, FMA>(&v, &v_rest);
        for k in 0..3 {
            for l in 0..W {
                let (angle, rest) = self.phases[k].of(l).turns::<FMA>(t[l]);
                let (sin, cos) = sin_cos_turns::<FMA>(angle + state.ahead[k][l], rest);
                let (re, im) = (state.z[k][0][l], state.z[k][1][l]);
                state.z[k][0][l] = re * cos - im * sin;
                state.z[k][1][l] = re * sin + im * cos;
            }
        }
        state
    }
}

impl<S: Series<C>, const C: usize> Coefficients<C> for Flow<S, C> {
    type One = Flow<S::One>;

    fn empty() -> Flow<S, C> {
        let none = [0.0; C];
        Flow {
            scale: none,
            orbit: Phases::STILL,
            phases: [Phases::STILL; 3],
            series: S::empty(),
            factors: [[none; 2]; 3],
            rotor: [[none; 4]; 4],
            omega: [[none; 3]; 3],
        }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let phases = self.phases.iter_mut().flat_map(|phase| &mut phase.0).chain(&mut self.orbit.0);
        let frames = self.rotor.as_flattened_mut().iter_mut().chain(self.omega.as_flattened_mut());
        let factors = self.factors.as_flattened_mut();
        phases.chain([&mut self.scale]).chain(factors).chain(frames).chain(self.series.each())
    }
}

impl<S: Series<C>, const C: usize> Curve<4, 3> for Flow<S, C> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let state = self.turned::<W, FMA>(times);
        let (mut z, mut f) = ([[0.0; W]; 6], [[1.0; W]; 3]);
        for k in 0..3 {
            for l in 0..W {
                let (re, im) = (state.z[k][0][l], state.z[k][1][l]);
                let (a, b) = (in_lane(&self.factors[k][0], l), in_lane(&self.factors[k][1], l));
                z[2 * k][l] = re * a - im * b;
                z[2 * k + 1][l] = re * b + im * a;
            }
        }
        let [a, b, c, d, x, y] = z;
        for l in 0..W {
            let factor = 1.0 / state.denominator[l];
            f[0][l] = x[l] * factor;
            f[1][l] = y[l] * factor;
        }
        (unit_rotor(&self.rotor, &[a, b, c, d]), mapped(&self.omega, &f))
    }
}
