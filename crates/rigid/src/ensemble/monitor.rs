//! Conserved quantities of bodies in lanes, measured as for a single body.

use super::observe::LanePoints;
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::run::certificate::{larger, nonzero};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::Vector;
use std::array::from_fn;
use std::borrow::Cow;

/// The bodies of the lanes with their torques. The lanes after them hold copies of the first one.
pub(super) type Acted<'m> = (&'m [Gyrostat], &'m [Cow<'m, [Torque]>]);

/// The bodies of the lanes at a time.
pub(super) struct LaneStates<'m, const W: usize> {
    acted: Acted<'m>,
    points: &'m LanePoints<W>,
    /// Kinetic and potential energies in J.
    pub energy: [f64; W],
    /// In s.
    time: f64,
}

impl<'m, const W: usize> LaneStates<'m, W> {
    pub fn new(points: &'m LanePoints<W>, acted: Acted<'m>, time: f64) -> Self {
        let energy = points.kinetic.0;
        let mut states = LaneStates { acted, points, energy, time };
        for (l, (body, torques)) in acted.0.iter().zip(acted.1).enumerate() {
            if !torques.is_empty() {
                let phase = states.phase(l);
                let potential = torques.iter().filter_map(|law| law.potential(body, &phase)).sum::<f64>();
                states.energy[l] += potential;
            }
        }
        states
    }

    fn phase(&self, l: usize) -> Phase {
        self.points.phases.phase(l, self.time)
    }

    /// [`Conserved::value`] of each lane that has the quantity.
    fn values(&self, tracked: &Tracked<W>) -> [f64; W] {
        match tracked.kind {
            Conserved::Energy => self.energy,
            Conserved::AngularMomentum => self.points.size.0,
            _ => from_fn(|l| tracked.each[l].map_or(0.0, |quantity| self.value(quantity, l))),
        }
    }

    fn value(&self, quantity: Conserved, l: usize) -> f64 {
        match quantity {
            Conserved::AxialAngularMomentum(axis) => Vector(self.points.momentum_of(l).0).dot(axis),
            _ => quantity.value(&self.acted.0[l], &self.acted.1[l], &self.phase(l)),
        }
    }

    /// [`Conserved::scale`], 1 for 0.
    fn scale(&self, quantity: Conserved, l: usize) -> f64 {
        let (body, torques) = (&self.acted.0[l], &self.acted.1[l][..]);
        nonzero(match quantity {
            Conserved::Energy => {
                self.points.kinetic.0[l] + torques.iter().map(|law| law.size(body)).sum::<f64>()
            }
            Conserved::AngularMomentum => self.points.size.0[l],
            _ => quantity.scale(body, torques, &self.phase(l)),
        })
    }
}

/// The conserved quantities of the bodies in the lanes.
pub(super) struct LaneMonitor<const W: usize>(Vec<Tracked<W>>);

/// A quantity of some lanes: its value at the start, the size of its terms, and its largest change so far.
struct Tracked<const W: usize> {
    /// That of the first of these lanes.
    kind: Conserved,
    each: [Option<Conserved>; W],
    start: [f64; W],
    scale: [f64; W],
    drift: [f64; W],
}

impl<const W: usize> LaneMonitor<W> {
    /// The quantities that the bodies conserve from these states on.
    pub fn new(starts: &LaneStates<W>) -> Self {
        let mut monitor = LaneMonitor(Vec::new());
        let (bodies, torques) = starts.acted;
        let under = |l: usize| Conserved::under(&bodies[l], &torques[l], &starts.phase(l));
        if torques.iter().all(|torques| torques.is_empty()) {
            // Bodies without torques conserve the same.
            under(0).for_each(|quantity| monitor.tracked(quantity).each = [Some(quantity); W]);
        } else {
            for l in 0..bodies.len() {
                under(l).for_each(|quantity| monitor.tracked(quantity).each[l] = Some(quantity));
            }
        }
        for tracked in &mut monitor.0 {
            tracked.start = starts.values(tracked);
            for l in 0..bodies.len() {
                tracked.scale[l] = tracked.each[l].map_or(1.0, |quantity| starts.scale(quantity, l));
            }
        }
        monitor
    }

    /// The entry of this kind of quantity, which is added if it is missing.
    fn tracked(&mut self, kind: Conserved) -> &mut Tracked<W> {
        let known = self.0.iter().position(|tracked| tracked.kind.number() == kind.number());
        let place = known.unwrap_or_else(|| {
            let (each, zeros) = ([None; W], [0.0; W]);
            self.0.push(Tracked { kind, each, start: zeros, scale: [1.0; W], drift: zeros });
            self.0.len() - 1
        });
        &mut self.0[place]
    }

    /// Measures the changes of the bodies that are not lost.
    pub fn record(&mut self, states: &LaneStates<W>, lost: &[bool; W]) {
        for tracked in &mut self.0 {
            let values = states.values(tracked);
            for l in 0..W {
                let change = (values[l] - tracked.start[l]).abs() / tracked.scale[l];
                if !lost[l] {
                    tracked.drift[l] = larger(tracked.drift[l], change);
                }
            }
        }
    }

    /// Each quantity of a lane with its value at the start and its largest relative change.
    pub fn finish(&self, l: usize) -> impl Iterator<Item = (Conserved, [f64; 2])> + Clone {
        let of = move |tracked: &Tracked<W>| Some((tracked.each[l]?, [tracked.start[l], tracked.drift[l]]));
        self.0.iter().filter_map(of)
    }
}
