//! Gravity gradients of bodies on their orbits, in lanes.

use crate::laws::forcing::Place;
use crate::laws::torque::lanes::{Three, gradient, seen};
use crate::laws::torque::orbit::kepler::Elements;
use crate::laws::torque::{Orbit, Torque};
use polhode_ga::simd::lanes::{Lanes, PerLane, Work, fastest};
use polhode_ga::simd::lookahead::Lookahead;

/// The orbits of all bodies, with their latest positions.
pub(super) struct Orbits<const W: usize> {
    elements: Elements<W>,
    /// 3n², in rad²/s².
    strength: [f64; W],
    /// The times of the latest positions in s.
    now: Option<PerLane<W>>,
    /// Directions u, whose third component is 0, and `3n² (a/r)³`.
    places: [[f64; W]; 3],
    /// Whether all bodies have the same orbit.
    shared: bool,
    /// Times to come, and the places on a shared orbit then: lanes hold times instead of bodies.
    lookahead: Lookahead,
    then: Vec<[f64; 3]>,
}

impl<const W: usize> Orbits<W> {
    /// None if a law is not a gravity gradient.
    pub fn new(each: [&Torque; W]) -> Option<Orbits<W>> {
        let mut orbits = [Orbit::circular(0.0); W];
        for (l, law) in each.into_iter().enumerate() {
            let Torque::GravityGradient(orbit) = law else { return None };
            orbits[l] = *orbit;
        }
        Some(Orbits {
            elements: Elements::new(orbits.each_ref().map(Orbit::elements)),
            strength: orbits.map(|orbit| 3.0 * orbit.rate() * orbit.rate()),
            now: None,
            places: [[0.0; W]; 3],
            shared: orbits.iter().all(|orbit| *orbit == orbits[0]),
            lookahead: Lookahead::default(),
            then: Vec::new(),
        })
    }

    #[inline(always)]
    pub fn torque<const F: bool>(&mut self, moments: &Three<W, F>, at: &Place<W, F>) -> Three<W, F> {
        let are_there = match &self.now {
            Some(now) => now.has_bits_of(&at.time),
            None => false,
        };
        if !are_there {
            fastest(Moved { orbits: self, times: &at.time });
        }
        let [x, y, strength] = self.places;
        gradient(moments, &seen(&at.rotor, &[Lanes(x), Lanes(y), Lanes::ZERO]), Lanes(strength))
    }

    /// Computes the places at times to come, in order, if all bodies share them.
    pub fn foresee(&mut self, times: impl Iterator<Item = f64>) {
        if !self.shared {
            return;
        }
        self.then.clear();
        for times in self.lookahead.announce(times).chunks(W) {
            let mut lanes = [times[0]; W];
            lanes[..times.len()].copy_from_slice(times);
            let [x, y, nearness] = fastest(Places { elements: &self.elements, times: &lanes });
            self.then.extend((0..times.len()).map(|l| [x[l], y[l], self.strength[0] * nearness[l]]));
        }
    }
}

/// Moves all bodies to these times, compiled outside the stages of the steps and, with the copies, for their registers.
struct Moved<'a, const W: usize> {
    orbits: &'a mut Orbits<W>,
    times: &'a PerLane<W>,
}

impl<const W: usize> Work for Moved<'_, W> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Moved { orbits, times } = self;
        orbits.now = Some(times.clone());
        if let PerLane::Common(time) = times
            && orbits.shared
            && let Some(place) = orbits.lookahead.find(*time)
        {
            for k in 0..3 {
                orbits.places[k] = [orbits.then[place][k]; W];
            }
            return;
        }
        let [x, y, mut strength] = orbits.elements.places::<FUSED>(&times.all());
        for l in 0..W {
            strength[l] *= orbits.strength[l];
        }
        orbits.places = [x, y, strength];
    }
}

/// Places on orbits at times of each lane.
struct Places<'a, const W: usize> {
    elements: &'a Elements<W>,
    times: &'a [f64; W],
}

impl<const W: usize> Work for Places<'_, W> {
    type Output = [[f64; W]; 3];

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> [[f64; W]; 3] {
        self.elements.places::<FUSED>(self.times)
    }
}

#[cfg(test)]
mod tests;
