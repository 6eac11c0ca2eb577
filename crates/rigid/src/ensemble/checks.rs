//! Checks of bodies in closed form, in lanes, with the bits of those of a single body.

use super::columns::Record;
use super::member::{Member, of};
use super::monitor::{LaneMonitor, LaneStates};
use super::observe::{LaneBodies, LanePhases, LanePoints};
use super::scheduler::Scheduler;
use crate::error::SimulateError;
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::run::certificate::larger;
use crate::run::closed_form::{ElapsedTime, check_kept};
use crate::state::checks::check_horizons;
use crate::state::phase::Gyrostat;
use polhode_ga::rows::curve::TOGETHER;
use std::array::from_fn;
use std::borrow::Cow;

/// A conserved quantity, its value at the start and its largest relative change.
pub(super) type Drift = (Conserved, [f64; 2]);

/// States of the lanes: rotors to space, and angular velocities.
pub(super) struct Rows {
    pub rotors: [[f64; 4]; TOGETHER],
    pub omegas: [[f64; 3]; TOGETHER],
}

impl Default for Rows {
    fn default() -> Rows {
        Rows { rotors: [[1.0, 0.0, 0.0, 0.0]; TOGETHER], omegas: [[0.0; 3]; TOGETHER] }
    }
}

/// The torques of the lanes.
type Torques<'t> = [Cow<'t, [Torque]>; TOGETHER];

/// Of free bodies.
pub(super) const NO_TORQUES: Torques<'static> = [const { Cow::Borrowed(&[]) }; TOGETHER];

/// Measures states of bodies in lanes.
pub(super) struct Checks<'t> {
    pub bodies: LaneBodies<TOGETHER>,
    pub monitor: LaneMonitor<TOGETHER>,
    pub norm_drifts: [f64; TOGETHER],
    gyrostats: [Gyrostat; TOGETHER],
    torques: Torques<'t>,
    starts: [f64; TOGETHER],
    known: [bool; TOGETHER],
}

impl<'t> Checks<'t> {
    /// Lanes beyond the members are of the first one. `known` are those of [`Scheduler::known`].
    pub fn new(members: &[Member], torques: Torques<'t>, known: [bool; TOGETHER]) -> Checks<'t> {
        let gyrostats = from_fn(|l| of(members, l).gyrostat);
        let bodies = LaneBodies::new(members);
        let starts = bodies.points(LanePhases::starts(members));
        Checks {
            monitor: LaneMonitor::new(&LaneStates::new(&starts, (&gyrostats, &torques), 0.0)),
            starts: from_fn(|l| of(members, l).start.time),
            norm_drifts: [0.0; TOGETHER],
            bodies,
            gyrostats,
            torques,
            known,
        }
    }

    /// Measures the first lanes at these times, with free bodies at the rounded times since the start, in body axes, and
    /// moves these to the exact times.
    pub fn free(&mut self, times: &[f64; TOGETHER], count: usize, rows: &mut Rows) {
        let phases = self.bodies.phases(&rows.rotors, &rows.omegas);
        let moved = self.moved(times, count);
        let points = self.measure(times, &moved, count, phases, |_, _| {});
        for l in (0..count).filter(|&l| moved[l]) {
            let (rotor, omega) = points.in_body(l);
            (rows.rotors[l], rows.omegas[l]) = (rotor.components(), omega.0);
        }
    }

    /// Measures the first lanes at a time, with the states at the rounded times since the start, in principal axes. Returns
    /// the points at the exact time, and their energies in J.
    pub fn under_torques(
        &mut self,
        time: f64,
        count: usize,
        rows: &Rows,
    ) -> (LanePoints<TOGETHER>, [f64; TOGETHER]) {
        let times = [time; TOGETHER];
        let phases = self.bodies.phases_in_principal_axes(&rows.rotors, &rows.omegas);
        let mut energies = [0.0; TOGETHER];
        let moved = self.moved(&times, count);
        let points = self.measure(&times, &moved, count, phases, |l, energy| energies[l] = energy);
        (points, energies)
    }

    /// The first lanes whose times since the start are rounded. Steps over the remainder are few only within the horizon.
    fn moved(&self, times: &[f64; TOGETHER], count: usize) -> [bool; TOGETHER] {
        let is_rounded = |l: usize| ElapsedTime::remainder(self.starts[l], times[l]) != 0.0;
        from_fn(|l| l < count && self.known[l] && is_rounded(l))
    }

    /// Moves some lanes to their exact times and measures the first ones.
    #[inline]
    fn measure(
        &mut self,
        times: &[f64; TOGETHER],
        moved: &[bool; TOGETHER],
        count: usize,
        mut phases: LanePhases<TOGETHER>,
        mut energy: impl FnMut(usize, f64),
    ) -> LanePoints<TOGETHER> {
        for l in (0..count).filter(|&l| moved[l]) {
            let since = ElapsedTime::new(self.starts[l], self.gyrostats[l], &self.torques[l][..]);
            phases.set(l, &since.at(phases.phase(l, times[l])));
        }
        let points = self.bodies.points(phases);
        for l in 0..count {
            self.norm_drifts[l] = self.norm_drifts[l].max(points.off_unit.0[l]);
        }
        // None of the laws depends on time.
        let states = LaneStates::new(&points, (&self.gyrostats, &self.torques), times[0]);
        self.monitor.record(&states, &from_fn(|l| l >= count));
        (0..count).for_each(|l| energy(l, states.energy[l]));
        points
    }

    /// The largest change of the norm and the drifts of a body that has all lanes.
    pub fn of_all_lanes(&self) -> (f64, impl Iterator<Item = Drift> + Clone) {
        let mut drifts: Vec<_> = self.monitor.finish(0).collect();
        for l in 1..TOGETHER {
            for ((_, [_, drift]), (_, [_, own])) in drifts.iter_mut().zip(self.monitor.finish(l)) {
                *drift = larger(*drift, own);
            }
        }
        (self.norm_drifts.iter().fold(0.0, |most, x| x.max(most)), drifts.into_iter())
    }
}

impl Scheduler<'_> {
    /// Whether the motion of each lane is known at all times, from its horizons.
    pub(super) fn known(
        &self,
        members: &[Member],
        horizons: impl Fn(usize) -> Option<[f64; 2]>,
    ) -> [bool; TOGETHER] {
        let within =
            |l: usize, horizons| check_horizons(of(members, l).start.time, self.times, horizons).is_ok();
        from_fn(|l| horizons(l).is_some_and(|horizons| within(l, horizons)))
    }

    /// Records a body by what its checks found. An error if its motion is not known, or not kept.
    pub(super) fn kept(
        &self,
        Member { body, start, .. }: &Member,
        method: usize,
        horizons: [f64; 2],
        (norm_drift, drifts): (f64, impl Iterator<Item = Drift> + Clone),
    ) -> Result<(), SimulateError> {
        check_horizons(start.time, self.times, horizons)?;
        check_kept(drifts.clone().map(|(quantity, [_, change])| (quantity, change)))?;
        let estimate = f64::NAN;
        let record = Record { method, longest: 0.0, steps: 0, evaluations: 0, estimate, norm_drift };
        self.columns.record(*body, record);
        drifts.for_each(|(quantity, numbers)| self.columns.drift(*body, quantity, numbers));
        Ok(())
    }
}
