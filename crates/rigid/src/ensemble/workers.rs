//! Worker threads of an ensemble: solve its bodies and summarise the outcomes.

use super::adaptive::AdaptedSteps;
use super::columns::lock;
use super::fixed::FixedSteps;
use super::member::{Member, Plan, SIDE_BY_SIDE, WIDE};
use super::output::Summary;
use super::scheduler::Scheduler;
use crate::error::SimulateError;
use crate::run::Progress;
use polhode_ga::simd::lanes::fastest;
use std::sync::atomic::Ordering;
use std::time::Duration;
use std::{iter, thread};

/// Interval at which an idle thread reports the progress of the others.
const BETWEEN_REPORTS: Duration = Duration::from_millis(20);

/// Maximum number of incomplete groups of bodies with the same plan.
const MOST_WAITING: usize = 64;

/// A thread that works; dropped when it ends, also by a panic, so that nobody waits for it.
struct Running<'a, 'b>(&'a Scheduler<'b>);

impl Drop for Running<'_, '_> {
    fn drop(&mut self) {
        if thread::panicking() {
            // The panic is passed on at the end; the other bodies would be solved in vain.
            self.0.stopped.store(true, Ordering::Relaxed);
        }
        *lock(&self.0.running) -= 1;
        self.0.ended.notify_all();
    }
}

impl<'a> Scheduler<'a> {
    /// Solves all bodies.
    pub fn work(self, progress: &mut dyn FnMut(Progress) -> bool) -> Result<Summary, SimulateError> {
        let count = self.threads;
        thread::scope(|scope| {
            for _ in 1..count {
                *lock(&self.running) += 1;
                // If no more threads can be created, the existing ones do all the work.
                if thread::Builder::new()
                    .spawn_scoped(scope, || self.work_loop(count, &mut |_| true))
                    .is_err()
                {
                    *lock(&self.running) -= 1;
                }
            }
            *lock(&self.running) += 1;
            self.work_loop(count, progress);
            self.wait(progress);
        });
        if self.stopped.load(Ordering::Relaxed) {
            return Err(SimulateError::Interrupted);
        }
        Ok(self.columns.finish())
    }

    /// Solves bodies until none is left.
    fn work_loop(&self, threads: usize, progress: &mut dyn FnMut(Progress) -> bool) {
        let _running = Running(self);
        match self.options.step {
            Some(step) => {
                self.equal_steps(step.min(self.options.max_step.unwrap_or(step)), threads, progress)
            }
            None if self.is_free() => self.free_bodies(threads, progress),
            None => fastest(AdaptedSteps { scheduler: self, progress }),
        }
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
    fn equal_steps(&self, step: f64, threads: usize, progress: &mut dyn FnMut(Progress) -> bool) {
        // Bodies wait for others with the same plan.
        let mut waiting: Vec<(Plan, Vec<Member<'a>>)> = Vec::new();
        let shares = iter::from_fn(|| self.next_bodies(threads, WIDE));
        for (body, own) in shares.flatten().take_while(|_| !self.is_stopped()) {
            let member = self.member(body, own);
            let Some(plan) = self.plan(&member, step) else {
                self.run_single(body, member.own, progress);
                continue;
            };
            let place = waiting.iter().position(|(alike, _)| *alike == plan).unwrap_or_else(|| {
                if waiting.len() == MOST_WAITING {
                    let (plan, members) = waiting.remove(0);
                    self.integrate(plan, members, progress);
                }
                waiting.push((plan, Vec::with_capacity(self.together(&plan))));
                waiting.len() - 1
            });
            waiting[place].1.push(member);
            if waiting[place].1.len() == self.together(&plan) {
                let (plan, members) = waiting.swap_remove(place);
                self.integrate(plan, members, progress);
            }
        }
        for (plan, members) in waiting {
            self.integrate(plan, members, progress);
        }
    }

    /// Integrates some bodies with the same plan in as few lanes as hold them: a lane has the same bits in any number.
    fn integrate(&self, plan: Plan, members: Vec<Member<'a>>, progress: &mut dyn FnMut(Progress) -> bool) {
        if members.len() > SIDE_BY_SIDE {
            fastest(FixedSteps::<WIDE> { scheduler: self, plan, members, progress });
        } else {
            fastest(FixedSteps::<SIDE_BY_SIDE> { scheduler: self, plan, members, progress });
        }
    }
}
