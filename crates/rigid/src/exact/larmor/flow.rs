//! States of a sphere in a field at any time: two uniform turns, of one motion or of `C` in lanes.

use crate::exact::lanes::{Coefficients, Phases, mapped, unit_rotor};
use crate::numerics::lanes::{in_lane, sin_cos_turns};
use polhode_ga::rows::curve::Curve;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow<const C: usize = 1> {
    /// Of the field and of the spin.
    pub turns: [Turn<C>; 2],
    /// Rotor components for the products of the cosine or sine of half the turn of the field with those of the spin.
    pub rotor: [[[f64; C]; 4]; 4],
    /// Components of the angular velocity in body axes for cosine and sine of the turn of the spin, and for 1.
    pub omega: [[[f64; C]; 3]; 3],
}

/// Half the angle of a uniform turn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<const C: usize = 1> {
    /// A power of two near the rate: that of the phase is near 1.
    pub scale: [f64; C],
    pub phase: Phases<C>,
}

impl<const C: usize> Coefficients<C> for Flow<C> {
    type One = Flow;

    fn empty() -> Flow<C> {
        let none = [0.0; C];
        let turn = Turn { scale: none, phase: Phases::STILL };
        Flow { turns: [turn; 2], rotor: [[none; 4]; 4], omega: [[none; 3]; 3] }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let turns = self.turns.iter_mut().flat_map(|turn| turn.phase.0.iter_mut().chain([&mut turn.scale]));
        turns.chain(self.rotor.as_flattened_mut()).chain(self.omega.as_flattened_mut())
    }
}

impl<const C: usize> Turn<C> {
    /// Sine and cosine in lane l.
    #[inline(always)]
    fn sin_cos<const FMA: bool>(&self, l: usize, time: f64) -> (f64, f64) {
        let (turns, rest) = self.phase.of(l).turns::<FMA>(time * in_lane(&self.scale, l));
        sin_cos_turns::<FMA>(turns, rest)
    }
}

impl<const C: usize> Curve<4, 3> for Flow<C> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let (mut z, mut f) = ([[0.0; W]; 4], [[1.0; W]; 3]);
        for l in 0..W {
            let (field_sin, field_cos) = self.turns[0].sin_cos::<FMA>(l, times[l]);
            let (sin, cos) = self.turns[1].sin_cos::<FMA>(l, times[l]);
            z[0][l] = field_cos * cos;
            z[1][l] = field_cos * sin;
            z[2][l] = field_sin * cos;
            z[3][l] = field_sin * sin;
            f[0][l] = 1.0 - 2.0 * (sin * sin);
            f[1][l] = 2.0 * (sin * cos);
        }
        (unit_rotor(&self.rotor, &z), mapped(&self.omega, &f))
    }
}
