//! Points of motions in SIMD lanes.

use crate::methods::classical::Bodies;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::Phase;
use polhode_ga::simd::lanes::{Lanes, dot, mapped_back, matrix};
use polhode_ga::{Bivector, Rotor};

/// States of bodies in lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<const W: usize, const F: bool> {
    /// From principal axes to space.
    pub rotor: [Lanes<W, F>; 4],
    /// L in space, kg m²/s.
    pub momentum: [Lanes<W, F>; 3],
    /// Position and velocity of the centre of mass: m and m/s.
    pub center: [Lanes<W, F>; 6],
    /// Accumulated rounding of L.
    pub lost: [Lanes<W, F>; 3],
    /// In s.
    pub time: Lanes<W, F>,
}

impl<const W: usize, const F: bool> Points<W, F> {
    /// All zero.
    pub const NONE: Self = Points {
        rotor: [Lanes::ZERO; 4],
        momentum: [Lanes::ZERO; 3],
        center: [Lanes::ZERO; 6],
        lost: [Lanes::ZERO; 3],
        time: Lanes::ZERO,
    };

    /// Puts a body's point into a lane.
    #[inline(always)]
    pub fn set(&mut self, l: usize, at: &Carried) {
        let (rotor, Center { position, velocity }) = (at.phase.rotor.components(), at.center);
        for k in 0..4 {
            self.rotor[k].0[l] = rotor[k];
        }
        for k in 0..3 {
            self.momentum[k].0[l] = at.momentum_space.0[k];
            self.lost[k].0[l] = at.lost.0[k];
            self.center[k].0[l] = position.0[k];
            self.center[3 + k].0[l] = velocity.0[k];
        }
        self.time.0[l] = at.phase.time;
    }

    /// The point of a body in a lane.
    #[inline(always)]
    pub fn get(&self, l: usize) -> Carried {
        let [r, m, c] = [&self.rotor[..], &self.momentum, &self.center].map(|lanes| {
            let mut all = [0.0; 6];
            for (x, lanes) in all.iter_mut().zip(lanes) {
                *x = lanes.0[l];
            }
            all
        });
        let rotor = Rotor::from_unit_components([r[0], r[1], r[2], r[3]]);
        let momentum_space = Bivector([m[0], m[1], m[2]]);
        let momentum = rotor.reverse().apply_bivector(momentum_space);
        let center = Center::from(c);
        let lost = Bivector([0, 1, 2].map(|k| self.lost[k].0[l]));
        let phase = Phase { rotor, momentum, time: self.time.0[l] };
        Carried { phase, momentum_space, driven: Bivector::default(), center, lost }
    }

    /// Whether all is finite in a lane.
    #[inline(always)]
    pub fn is_finite(&self, l: usize) -> bool {
        let mut sum = 0.0;
        for lanes in self.rotor.iter().chain(&self.momentum).chain(&self.center) {
            sum += 0.0 * lanes.0[l];
        }
        sum == 0.0
    }

    /// Replaces the points selected by the mask with those of `other`.
    #[inline(always)]
    pub fn take(&mut self, mask: &[bool; W], other: &Self) {
        for k in 0..4 {
            self.rotor[k] = other.rotor[k].or(mask, self.rotor[k]);
        }
        for k in 0..3 {
            self.momentum[k] = other.momentum[k].or(mask, self.momentum[k]);
            self.lost[k] = other.lost[k].or(mask, self.lost[k]);
        }
        for k in 0..6 {
            self.center[k] = other.center[k].or(mask, self.center[k]);
        }
        self.time = other.time.or(mask, self.time);
    }

    /// The sizes of the angular velocities, rad/s.
    #[inline(always)]
    pub fn rates(&self, bodies: &Bodies<W, F>) -> Lanes<W, F> {
        let momentum = mapped_back(&matrix(&self.rotor), &self.momentum);
        let omega = bodies.omega(&momentum);
        dot(&omega, &omega).sqrt()
    }
}
