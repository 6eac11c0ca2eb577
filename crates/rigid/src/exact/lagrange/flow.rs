//! States of a heavy top at any time: phases, series and frames.

use super::series::{Series, State};
use crate::numerics::lanes::{Phase, sin_cos_turns};
use polhode_ga::rows::curve::Curve;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow<S> {
    /// Of time.
    pub scale: f64,
    /// v.
    pub orbit: Phase,
    /// Phases of α, β and the rate across the axis.
    pub phases: [Phase; 3],
    pub series: S,
    /// Complex factors of the three.
    pub factors: [[f64; 2]; 3],
    /// Rotor components for the real and imaginary parts of α and of β.
    pub rotor: [[f64; 4]; 4],
    /// Components of the angular velocity in body axes for w and for 1.
    pub omega: [[f64; 3]; 3],
}

#[inline(always)]
pub(super) fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl<S: Series> Flow<S> {
    /// The three functions before their factors and the denominator of the series.
    #[inline(always)]
    pub fn turned<const W: usize, const FMA: bool>(&self, times_: &[f64; W]) -> State<W> {
        let (mut v, mut v_rest) = ([0.0; W], [0.0; W]);
        for l in 0..W {
            (v[l], v_rest[l]) = self.orbit.turns::<FMA>(times_[l] * self.scale);
        }
        let mut state = self.series.state::<W, FMA>(&v, &v_rest);
        for k in 0..3 {
            for l in 0..W {
                let (angle, rest) = self.phases[k].turns::<FMA>(times_[l] * self.scale);
                let (sin, cos) = sin_cos_turns::<FMA>(angle + state.ahead[k][l], rest);
                let [re, im] = times([state.z[k][0][l], state.z[k][1][l]], [cos, sin]);
                (state.z[k][0][l], state.z[k][1][l]) = (re, im);
            }
        }
        state
    }
}

impl<S: Series> Curve<4, 3> for Flow<S> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times_: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let state = self.turned::<W, FMA>(times_);
        let (mut rotor, mut omega) = ([[0.0; W]; 4], [[0.0; W]; 3]);
        for l in 0..W {
            let of = |k: usize| times([state.z[k][0][l], state.z[k][1][l]], self.factors[k]);
            let ([a, b], [c, d]) = (of(0), of(1));
            let r = self.rotor.map(|m| (m[0] * a + m[1] * b) + (m[2] * c + m[3] * d));
            let square = (r[0] * r[0] + r[1] * r[1]) + (r[2] * r[2] + r[3] * r[3]);
            let factor = 1.0 / square.sqrt();
            for k in 0..4 {
                rotor[k][l] = r[k] * factor;
            }
            let [x, y] = of(2);
            let factor = 1.0 / state.denominator[l];
            for k in 0..3 {
                let m = self.omega[k];
                omega[k][l] = (m[0] * (x * factor) + m[1] * (y * factor)) + m[2];
            }
        }
        (rotor, omega)
    }
}
