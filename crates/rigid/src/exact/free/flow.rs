//! States of a free motion at any time: phases, series and frames.
//!
//! A flow holds coefficients of one motion, with times in the lanes, or of `C` motions, one in each lane. Both give the
//! same bits.

use super::series::{Series, State};
use crate::exact::lanes::{Coefficients, Phases, mapped, unit_rotor};
use crate::numerics::double_double::DoubleDoubles;
use crate::numerics::lanes::{Phase, in_lane, sin_cos_turns};
use polhode_ga::rows::curve::Curve;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow<S, const C: usize = 1> {
    /// Of time.
    pub scale: [f64; C],
    /// v.
    pub orbit: Phases<C>,
    /// νt/2.
    pub precession: Phases<C>,
    pub series: S,
    /// Rotor components that take the quaternion units of (e1, e2, d) to space and body axes.
    pub rotor: [[[f64; C]; 4]; 4],
    /// Components of the angular velocity in body axes for cn, sn and dn.
    pub omega: [[[f64; C]; 3]; 3],
}

impl<S: Series<C>, const C: usize> Coefficients<C> for Flow<S, C> {
    type One = Flow<S::One>;

    fn empty() -> Flow<S, C> {
        let none = [0.0; C];
        Flow {
            scale: none,
            orbit: Phases::STILL,
            precession: Phases::STILL,
            series: S::empty(),
            rotor: [[none; 4]; 4],
            omega: [[none; 3]; 3],
        }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let phases = self.orbit.0.iter_mut().chain(&mut self.precession.0);
        let frames = self.rotor.as_flattened_mut().iter_mut().chain(self.omega.as_flattened_mut());
        phases.chain([&mut self.scale]).chain(frames).chain(self.series.each())
    }
}

/// `W` times, at which phases are reduced.
pub(crate) trait Times<const W: usize> {
    /// A phase at time l, multiplied by a power of two, less whole turns, and its rounding error: [`Phase::turns`].
    fn turns<const FMA: bool>(&self, l: usize, scale: f64, phase: Phase) -> (f64, f64);
}

impl<const W: usize> Times<W> for [f64; W] {
    #[inline(always)]
    fn turns<const FMA: bool>(&self, l: usize, scale: f64, phase: Phase) -> (f64, f64) {
        phase.turns::<FMA>(self[l] * scale)
    }
}

impl<const W: usize, const FUSED: bool> Times<W> for DoubleDoubles<W, FUSED> {
    #[inline(always)]
    fn turns<const FMA: bool>(&self, l: usize, scale: f64, phase: Phase) -> (f64, f64) {
        phase.turns_at_pair::<FMA>((self.hi[l] * scale, self.lo[l] * scale))
    }
}

impl<S: Series<C>, const C: usize> Flow<S, C> {
    /// `exp(½νt) Z`, up to its norm, as quaternion components; and the state.
    #[inline(always)]
    pub fn turned<const W: usize, const FMA: bool>(
        &self,
        times: &impl Times<W>,
    ) -> ([[f64; W]; 4], State<W>) {
        let (mut v, mut v_rest, mut angle, mut angle_rest) = ([0.0; W], [0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            let scale = in_lane(&self.scale, l);
            (v[l], v_rest[l]) = times.turns::<FMA>(l, scale, self.orbit.of(l));
            (angle[l], angle_rest[l]) = times.turns::<FMA>(l, scale, self.precession.of(l));
        }
        let state = self.series.state::<W, FMA>(&v, &v_rest);
        let mut z = [[0.0; W]; 4];
        for l in 0..W {
            let (sin, cos) = sin_cos_turns::<FMA>(angle[l] + state.ahead[l], angle_rest[l]);
            let (z0, z1, z2, z3) = (state.z[0][l], state.z[1][l], state.z[2][l], state.z[3][l]);
            z[0][l] = cos * z0 - sin * z3;
            z[1][l] = cos * z1 - sin * z2;
            z[2][l] = cos * z2 + sin * z1;
            z[3][l] = cos * z3 + sin * z0;
        }
        (z, state)
    }

    /// Rotors and angular velocities at these times.
    #[inline(always)]
    pub fn states<const W: usize, const FMA: bool>(
        &self,
        times: &impl Times<W>,
    ) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let (z, state) = self.turned::<W, FMA>(times);
        let mut functions = state.functions;
        for l in 0..W {
            let factor = 1.0 / state.denominator[l];
            for k in 0..3 {
                functions[k][l] *= factor;
            }
        }
        (unit_rotor(&self.rotor, &z), mapped(&self.omega, &functions))
    }
}

impl<S: Series<C>, const C: usize> Curve<4, 3> for Flow<S, C> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        self.states::<W, FMA>(times)
    }
}
