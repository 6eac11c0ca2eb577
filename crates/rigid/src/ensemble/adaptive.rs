//! Adaptive integration of bodies in SIMD lanes, each with its own steps.
//!
//! In every round each body attempts a step of its own length and accepts or rejects it, by the rules for a single body:
//! its sweeps, and stops at output times and where its laws are not smooth. A body that is done gives its lane to the
//! next one, so that a slow one does not hold up the others. The last few continue in fewer lanes, with the same bits.

use super::body_run::BodyRun;
use super::laws::{Laws, NoForcing};
use super::member::{Member, SIDE_BY_SIDE};
use super::scheduler::Scheduler;
use crate::error::SimulateError;
use crate::laws::forcing::Forcing;
use crate::laws::torque::{Torque, damping_rate};
use crate::methods::classical::Bodies;
use crate::methods::runge_kutta::{Points, STAGES, step};
use crate::run::Progress;
use crate::state::carried::Carried;
use crate::state::phase::Gyrostat;
use polhode_ga::simd::lanes::{Lanes, Work};
use std::{array, mem};

/// Lanes for the last bodies: one register of the widest machines.
const LAST: usize = 8;

/// Rounds between calls of `progress`.
const BETWEEN_CHECKS: u32 = 64;

/// Integration of all bodies not yet assigned to a thread.
pub(super) struct AdaptedSteps<'a, 'b> {
    pub scheduler: &'b Scheduler<'a>,
    pub progress: &'b mut dyn FnMut(Progress) -> bool,
}

/// A body without a lane, between two batches.
struct WaitingRun<'a> {
    run: BodyRun<'a>,
    torques: Vec<Torque>,
    at: Carried,
    /// The largest angular velocity so far, rad/s.
    fastest: f64,
}

/// Bodies in lanes, with their current points.
struct LaneBatch<'a, const W: usize, const F: bool> {
    runs: [Option<BodyRun<'a>>; W],
    bodies: Bodies<W, F>,
    at: Points<W, F>,
    /// The largest angular velocities so far, and their lower bounds as scales, in rad/s.
    fastest: Lanes<W, F>,
    least: Lanes<W, F>,
}

impl Work for AdaptedSteps<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<const F: bool>(self) {
        let AdaptedSteps { scheduler, progress } = self;
        let last = follow::<SIDE_BY_SIDE, F>(scheduler, Vec::new(), LAST, progress);
        follow::<LAST, F>(scheduler, last, 0, progress);
    }
}

/// Integrates bodies, the waiting ones first, until at most `enough` are left, which are returned.
#[inline(always)]
fn follow<'a, const W: usize, const F: bool>(
    scheduler: &Scheduler<'a>,
    mut waiting: Vec<WaitingRun<'a>>,
    enough: usize,
    progress: &mut dyn FnMut(Progress) -> bool,
) -> Vec<WaitingRun<'a>> {
    let nobody = Gyrostat::rigid([1.0; 3]);
    let mut batch = LaneBatch::<W, F> {
        runs: [const { None }; W],
        bodies: Bodies::new([(nobody, 0.0); W]),
        at: Points::NONE,
        fastest: Lanes::ZERO,
        least: Lanes::ZERO,
    };
    let mut torques: [Vec<Torque>; W] = [const { Vec::new() }; W];
    let mut gyrostats = [nobody; W];
    loop {
        for l in 0..W {
            while batch.runs[l].is_none()
                && let Some(next) = waiting
                    .pop()
                    .or_else(|| Some(WaitingRun::new(scheduler.next_member(progress)?, scheduler)))
            {
                gyrostats[l] = next.run.member.gyrostat;
                torques[l] = batch.load(l, next, scheduler);
            }
        }
        if batch.occupied() <= enough {
            return batch.unload(torques);
        }
        let go_on = if scheduler.ensemble.laws.is_empty() {
            batch.rounds(scheduler, &torques, &mut NoForcing, progress)
        } else {
            // An empty lane uses laws of the same kinds.
            let taken = batch.runs.iter().position(Option::is_some).unwrap_or(0);
            let of = |l: usize| if torques[l].is_empty() { taken } else { l };
            let laws = &mut Laws::new(gyrostats, array::from_fn(|l| &torques[of(l)][..]));
            batch.rounds(scheduler, &torques, laws, progress)
        };
        if !go_on {
            return Vec::new();
        }
    }
}

impl<'a> WaitingRun<'a> {
    fn new(mut member: Member<'a>, scheduler: &Scheduler<'a>) -> WaitingRun<'a> {
        let torques = mem::take(&mut member.torques).into_owned();
        let mut run = BodyRun::new(member, &torques, scheduler);
        let at = run.begin_sweep();
        WaitingRun { fastest: run.rate(&at), run, torques, at }
    }
}

impl<'a, const W: usize, const F: bool> LaneBatch<'a, W, F> {
    /// Puts a body into an empty lane, unless it is done at once. Returns its laws.
    fn load(&mut self, l: usize, body: WaitingRun<'a>, scheduler: &Scheduler<'a>) -> Vec<Torque> {
        let WaitingRun { run, torques, at, fastest } = body;
        let gyrostat = run.member.gyrostat;
        self.bodies.set(l, &gyrostat, damping_rate(&torques));
        (self.least.0[l], self.fastest.0[l]) = (gyrostat.least_rate(), fastest);
        self.at.set(l, &at);
        self.runs[l] = Some(run);
        self.proceed(l, &torques, scheduler);
        torques
    }

    /// Empties all lanes.
    fn unload(&mut self, torques: [Vec<Torque>; W]) -> Vec<WaitingRun<'a>> {
        let mut all = Vec::new();
        for (l, torques) in torques.into_iter().enumerate() {
            let (at, fastest) = (self.at.get(l), self.fastest.0[l]);
            all.extend(self.runs[l].take().map(|run| WaitingRun { run, torques, at, fastest }));
        }
        all
    }

    /// Continues with the body of a lane at a stop. Empties the lane if the body is done.
    fn proceed(&mut self, l: usize, torques: &[Torque], scheduler: &Scheduler<'a>) {
        let Some(run) = &mut self.runs[l] else { return };
        let mut at = self.at.get(l);
        match run.proceed(&mut at, &mut self.fastest.0[l], scheduler.times) {
            Ok(None) => self.at.set(l, &at),
            Ok(Some(converged)) => {
                if let Some(run) = self.runs[l].take() {
                    run.done(converged, torques, scheduler);
                }
            }
            Err(error) => self.fail(l, error, scheduler),
        }
    }

    /// Repeats rounds until another lane is empty. False if the run was stopped.
    #[inline(always)]
    fn rounds<E: Forcing<W, F>>(
        &mut self,
        scheduler: &Scheduler<'a>,
        torques: &[Vec<Torque>; W],
        forcing: &mut E,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> bool {
        let before = self.occupied();
        let mut rounds = 0;
        while self.occupied() == before {
            let (h, ends) = self.plan(scheduler);
            let fastest = self.fastest.max(self.least);
            let (mut next, error) = step::<6, W, F, E>(&self.bodies, forcing, &self.at, h, fastest);
            next.time = ends;
            let rates = next.rates(&self.bodies);
            let accepted = self.judge(scheduler, torques, &h, &next, &error);
            self.at.take(&accepted, &next);
            self.fastest = rates.max(self.fastest).or(&accepted, self.fastest);
            for l in 0..W {
                if accepted[l]
                    && let Some(noise) = self.runs[l].as_mut().and_then(|run| run.noise.as_mut())
                {
                    self.at.set(l, &noise.perturb(&self.at.get(l)));
                }
                let stops = |run: &BodyRun| run.stop == self.at.time.0[l];
                if accepted[l] && self.runs[l].as_ref().is_some_and(stops) {
                    self.proceed(l, &torques[l], scheduler);
                }
            }
            rounds += 1;
            if rounds % BETWEEN_CHECKS == 0 {
                for l in 0..W {
                    let time = self.at.time.0[l];
                    let Some(run) = &mut self.runs[l] else { continue };
                    run.count(time, scheduler);
                }
                if !scheduler.report(progress) {
                    return false;
                }
            }
        }
        // Where bodies are done after a few rounds each, too.
        scheduler.report(progress)
    }

    fn occupied(&self) -> usize {
        self.runs.iter().filter(|run| run.is_some()).count()
    }

    /// The lengths of the next steps and the times at which they end; empty lanes do not move.
    fn plan(&mut self, scheduler: &Scheduler<'a>) -> (Lanes<W, F>, Lanes<W, F>) {
        let (mut h, mut ends) = (Lanes::ZERO, self.at.time);
        for l in 0..W {
            let Some(run) = &mut self.runs[l] else { continue };
            let from = self.at.time.0[l];
            match run.controller.end(from, run.stop) {
                Ok(to) => (h.0[l], ends.0[l]) = (to - from, to),
                Err(error) => {
                    let error = run.undefined.take().unwrap_or(error);
                    self.fail(l, error, scheduler);
                }
            }
        }
        (h, ends)
    }

    /// Which steps are accepted.
    fn judge(
        &mut self,
        scheduler: &Scheduler<'a>,
        torques: &[Vec<Torque>; W],
        h: &Lanes<W, F>,
        next: &Points<W, F>,
        error: &Lanes<W, F>,
    ) -> [bool; W] {
        let mut accepted = [false; W];
        for l in 0..W {
            let Some(run) = &mut self.runs[l] else { continue };
            let (h, error) = (h.0[l], error.0[l]);
            run.sweep.evaluations += STAGES as u64;
            if error.is_nan()
                && let Err(error) = run.diagnose(&self.at.get(l), h, &torques[l])
            {
                self.fail(l, error, scheduler);
                continue;
            }
            if run.controller.judge(h, error) {
                run.sweep.add_error(error, &run.controller);
                run.undefined = None;
                match run.arrive(h, next, l, scheduler) {
                    Ok(()) => accepted[l] = true,
                    Err(error) => self.fail(l, error, scheduler),
                }
            }
        }
        accepted
    }

    #[cold]
    fn fail(&mut self, l: usize, error: SimulateError, scheduler: &Scheduler<'a>) {
        if let Some(run) = self.runs[l].take() {
            run.failed(error, scheduler);
        }
    }
}
