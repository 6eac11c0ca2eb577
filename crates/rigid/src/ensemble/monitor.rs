//! Conserved quantities of bodies in lanes, measured as for a single body.

use super::observe::LanePoints;
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::run::certificate::{larger, nonzero};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Vector};
use std::array::from_fn;

/// A point of the body of a lane, with what is computed in lanes.
pub(super) struct LanePoint<'m> {
    pub body: &'m Gyrostat,
    pub torques: &'m [Torque],
    pub phase: Phase,
    /// Kinetic energy in J.
    kinetic: f64,
    /// Kinetic and potential energy in J.
    pub energy: f64,
    /// Magnitude of the momentum, kg m²/s.
    size: f64,
    /// In space, kg m²/s.
    pub momentum: Bivector,
}

impl<'m> LanePoint<'m> {
    pub fn new<const W: usize>(
        points: &LanePoints<W>,
        l: usize,
        (body, torques): (&'m Gyrostat, &'m [Torque]),
        time: f64,
    ) -> Self {
        let (phase, kinetic) = (points.phases.phase(l, time), points.kinetic.0[l]);
        let potential = torques.iter().filter_map(|law| law.potential(body, &phase)).sum::<f64>();
        LanePoint {
            body,
            torques,
            phase,
            kinetic,
            energy: kinetic + potential,
            size: points.size.0[l],
            momentum: Bivector(from_fn(|k| points.momentum[k].0[l])),
        }
    }

    /// [`Conserved::value`].
    fn value(&self, quantity: Conserved) -> f64 {
        match quantity {
            Conserved::Energy => self.energy,
            Conserved::AngularMomentum => self.size,
            Conserved::AxialAngularMomentum(axis) => Vector(self.momentum.0).dot(axis),
            _ => quantity.value(self.body, self.torques, &self.phase),
        }
    }

    /// [`Conserved::scale`], 1 for 0.
    fn scale(&self, quantity: Conserved) -> f64 {
        match quantity {
            Conserved::Energy => {
                nonzero(self.kinetic + self.torques.iter().map(|law| law.size(self.body)).sum::<f64>())
            }
            Conserved::AngularMomentum => nonzero(self.size),
            _ => nonzero(quantity.scale(self.body, self.torques, &self.phase)),
        }
    }
}

/// The conserved quantities of the bodies in the lanes.
#[derive(Default)]
pub(super) struct LaneMonitor<const W: usize>(Vec<Tracked<W>>);

/// A quantity of some lanes: its value at the start, the size of its terms, and its largest change so far.
struct Tracked<const W: usize> {
    number: usize,
    each: [Option<Conserved>; W],
    start: [f64; W],
    scale: [f64; W],
    drift: [f64; W],
}

impl<const W: usize> LaneMonitor<W> {
    /// Adds the quantities of the body of a lane, which starts at a point.
    pub fn follow(&mut self, l: usize, start: &LanePoint) {
        for quantity in Conserved::under(start.body, start.torques, &start.phase) {
            let number = quantity.number();
            let place = self.0.iter().position(|tracked| tracked.number == number).unwrap_or_else(|| {
                let zeros = [0.0; W];
                self.0.push(Tracked { number, each: [None; W], start: zeros, scale: zeros, drift: zeros });
                self.0.len() - 1
            });
            let tracked = &mut self.0[place];
            tracked.each[l] = Some(quantity);
            (tracked.start[l], tracked.scale[l]) = (start.value(quantity), start.scale(quantity));
        }
    }

    /// Measures the changes at a point of the body of a lane.
    pub fn record(&mut self, l: usize, point: &LanePoint) {
        for tracked in &mut self.0 {
            let Some(quantity) = tracked.each[l] else { continue };
            let change = (point.value(quantity) - tracked.start[l]).abs();
            tracked.drift[l] = larger(tracked.drift[l], change / tracked.scale[l]);
        }
    }

    /// Each quantity of a lane with its value at the start and its largest relative change.
    pub fn finish(&self, l: usize) -> impl Iterator<Item = (Conserved, [f64; 2])> {
        let of = move |tracked: &Tracked<W>| Some((tracked.each[l]?, [tracked.start[l], tracked.drift[l]]));
        self.0.iter().filter_map(of)
    }
}
