//! Worker threads of an ensemble: solve its bodies and summarise the outcomes.

use super::Failure;
use super::adaptive::AdaptedSteps;
use super::fixed::FixedSteps;
use super::member::{Member, Outcome, Plan, SIDE_BY_SIDE};
use super::output::Summary;
use super::scheduler::{Scheduler, lock};
use crate::error::SimulateError;
use crate::laws::conserved::Conserved;
use crate::run::Progress;
use polhode_ga::simd::lanes::fastest;
use polhode_ga::simd::threads::Threads;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

/// Interval at which an idle thread reports the progress of the others.
const BETWEEN_REPORTS: Duration = Duration::from_millis(20);

/// Maximum number of incomplete groups of bodies with the same plan.
const MOST_WAITING: usize = 64;

impl Scheduler<'_> {
    /// Solves all bodies.
    pub fn work(
        &self,
        threads: Threads,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Summary, SimulateError> {
        let count = threads.count().min(self.ensemble.starts.len()).max(1);
        thread::scope(|scope| {
            for _ in 1..count {
                *lock(&self.running) += 1;
                // If no more threads can be created, the existing ones do all the work.
                if thread::Builder::new().spawn_scoped(scope, || self.work_loop(&mut |_| true)).is_err() {
                    *lock(&self.running) -= 1;
                }
            }
            *lock(&self.running) += 1;
            self.work_loop(progress);
            self.wait(progress);
        });
        if self.stopped.load(Ordering::Relaxed) {
            return Err(SimulateError::Interrupted);
        }
        Ok(summary(std::mem::take(&mut *lock(&self.outcomes))))
    }

    /// Solves bodies until none is left.
    fn work_loop(&self, progress: &mut dyn FnMut(Progress) -> bool) {
        match self.options.step {
            Some(step) => self.equal_steps(step.min(self.options.max_step.unwrap_or(step)), progress),
            None => fastest(AdaptedSteps { scheduler: self, progress }),
        }
        *lock(&self.running) -= 1;
        self.ended.notify_all();
    }

    /// Waits for the other threads and reports their progress.
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

    /// Integrates bodies by equal steps.
    fn equal_steps(&self, step: f64, progress: &mut dyn FnMut(Progress) -> bool) {
        // Bodies wait for others with the same plan.
        let mut waiting: Vec<(Plan, Vec<Member>)> = Vec::new();
        while let Some((body, own)) = self.next_body() {
            let Some(plan) = self.plan(body, step) else {
                self.run_single(body, own, progress);
                continue;
            };
            let place = waiting.iter().position(|(alike, _)| *alike == plan).unwrap_or_else(|| {
                if waiting.len() == MOST_WAITING {
                    let (plan, members) = waiting.remove(0);
                    fastest(FixedSteps { scheduler: self, plan, members, progress });
                }
                waiting.push((plan, Vec::with_capacity(SIDE_BY_SIDE)));
                waiting.len() - 1
            });
            waiting[place].1.push(self.member(body, own));
            if waiting[place].1.len() == SIDE_BY_SIDE {
                let (plan, members) = waiting.swap_remove(place);
                fastest(FixedSteps { scheduler: self, plan, members, progress });
            }
        }
        for (plan, members) in waiting {
            fastest(FixedSteps { scheduler: self, plan, members, progress });
        }
    }
}

/// Collects the outcomes by body.
fn summary(mut outcomes: Vec<Outcome>) -> Summary {
    outcomes.sort_by_key(|outcome| outcome.body);
    let count = outcomes.len();
    let mut all = Summary::default();
    for (row, Outcome { body, certificate, failure }) in outcomes.into_iter().enumerate() {
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
