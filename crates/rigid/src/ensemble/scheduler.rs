//! The work on an ensemble, shared by threads: each takes bodies that nobody has taken yet.

use super::Failure;
use super::adaptive::AdaptedSteps;
use super::crew::{Crew, Member, Plan, SIDE_BY_SIDE, Told, lock};
use super::fixed::FixedSteps;
use super::output::Summary;
use crate::error::SimulateError;
use crate::laws::conserved::Conserved;
use crate::run::Progress;
use polhode_ga::simd::lanes::fastest;
use polhode_ga::simd::threads::Threads;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

/// How often a thread that has no more work tells how far the others are.
const BETWEEN_REPORTS: Duration = Duration::from_millis(20);

/// How many groups of bodies that are stepped alike wait for more at a time.
const MOST_WAITING: usize = 64;

impl Crew<'_> {
    /// Does all the work.
    pub fn work(
        &self,
        threads: Threads,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Summary, SimulateError> {
        let count = threads.count().min(self.ensemble.starts.len()).max(1);
        thread::scope(|scope| {
            for _ in 1..count {
                *lock(&self.running) += 1;
                // Where no more threads are to be had, those that are there do all the work.
                if thread::Builder::new().spawn_scoped(scope, || self.take_turns(&mut |_| true)).is_err() {
                    *lock(&self.running) -= 1;
                }
            }
            *lock(&self.running) += 1;
            self.take_turns(progress);
            self.wait(progress);
        });
        if self.stopped.load(Ordering::Relaxed) {
            return Err(SimulateError::Interrupted);
        }
        Ok(summary(std::mem::take(&mut *lock(&self.told))))
    }

    /// Takes bodies and follows them, until there are no more.
    fn take_turns(&self, progress: &mut dyn FnMut(Progress) -> bool) {
        match self.options.step {
            Some(step) => self.equal_steps(step.min(self.options.max_step.unwrap_or(step)), progress),
            None => fastest(AdaptedSteps { crew: self, progress }),
        }
        *lock(&self.running) -= 1;
        self.ended.notify_all();
    }

    /// Waits for the other threads, and tells how far they are.
    fn wait(&self, progress: &mut dyn FnMut(Progress) -> bool) {
        let mut running = lock(&self.running);
        while *running > 0 {
            running = match self.ended.wait_timeout(running, BETWEEN_REPORTS) {
                Ok((running, _)) => running,
                Err(poisoned) => poisoned.into_inner().0,
            };
            self.report(progress);
        }
    }

    /// Follows bodies by equal steps.
    fn equal_steps(&self, step: f64, progress: &mut dyn FnMut(Progress) -> bool) {
        // Bodies wait for others that are stepped alike.
        let mut waiting: Vec<(Plan, Vec<Member>)> = Vec::new();
        while let Some((body, own)) = self.take() {
            let Some(plan) = self.plan(body, step) else {
                self.alone(body, own, progress);
                continue;
            };
            let place = waiting.iter().position(|(alike, _)| *alike == plan).unwrap_or_else(|| {
                if waiting.len() == MOST_WAITING {
                    let (plan, members) = waiting.remove(0);
                    fastest(FixedSteps { crew: self, plan, members, progress });
                }
                waiting.push((plan, Vec::with_capacity(SIDE_BY_SIDE)));
                waiting.len() - 1
            });
            waiting[place].1.push(self.member(body, own));
            if waiting[place].1.len() == SIDE_BY_SIDE {
                let (plan, members) = waiting.swap_remove(place);
                fastest(FixedSteps { crew: self, plan, members, progress });
            }
        }
        for (plan, members) in waiting {
            fastest(FixedSteps { crew: self, plan, members, progress });
        }
    }
}

/// What was told, by bodies.
fn summary(mut told: Vec<Told>) -> Summary {
    told.sort_by_key(|told| told.body);
    let count = told.len();
    let mut all = Summary::default();
    for (row, Told { body, certificate, failure }) in told.into_iter().enumerate() {
        all.methods.push(certificate.method);
        all.steps.push([certificate.steps, certificate.evaluations]);
        all.longest.push(certificate.step);
        all.estimates.push(certificate.error_estimate.unwrap_or(f64::NAN));
        all.norm_drifts.push(certificate.norm_drift);
        for warning in certificate.warnings {
            if !all.warnings.contains(&warning) {
                all.warnings.push(warning);
            }
        }
        for (quantity, start, change) in certificate.drifts {
            let name = Conserved::name(quantity);
            let place = all.drifts.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
                all.drifts.push((name, vec![[f64::NAN; 2]; count]));
                all.drifts.len() - 1
            });
            all.drifts[place].1[row] = [start, change];
        }
        all.failures.extend(failure.map(|(time, error)| Failure { body, time, error }));
    }
    all
}
