//! Threads that wait for work between calls, because starting one takes as long as a hundred thousand products.
//!
//! A call offers its work to idle workers, does it itself, withdraws the offers that nobody took, and waits for the
//! workers that took one. So it ends even if every worker is busy, and work may itself call for workers. A worker that
//! finds nothing to do looks out for [`WATCHED`], which bridges the time between two calls in a row, then sleeps, and
//! ends after [`IDLE`]. A forked process has none of the threads of its parent, and gets workers of its own.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::process;
use std::ptr;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// Checks for new work before a worker sleeps, for the end of work before a call does: some 20 µs, what waking takes.
/// Fewer under Miri, which interprets them.
const WATCHED: usize = if cfg!(miri) { 10 } else { 1000 };

/// A worker ends after this time without work, so that a process soon has one thread again.
const IDLE: Duration = Duration::from_millis(50);

/// The workers of a process.
struct Workers {
    process: u32,
    state: Mutex<State>,
    /// The number of offers, for idle workers to watch without the lock.
    offered: AtomicUsize,
    more: Condvar,
}

#[derive(Default)]
struct State {
    offers: VecDeque<Arc<Job>>,
    /// Workers without work, and those of them that sleep.
    idle: usize,
    asleep: usize,
}

/// The work of a call.
struct Job {
    /// Borrowed from the call: valid while the job is open or somebody works.
    work: *const (dyn Fn() + Sync),
    progress: Mutex<Progress>,
    /// The number of workers that work; changed with the lock, watched without.
    working: AtomicUsize,
    ended: Condvar,
}

// SAFETY: only the pointer keeps a job from being `Send` and `Sync`. What it points to is `Sync`, so any thread may call
// it, and `Job::work` does so only while the call that lent it waits.
unsafe impl Send for Job {}
// SAFETY: as above.
unsafe impl Sync for Job {}

struct Progress {
    open: bool,
    panic: Option<Box<dyn Any + Send>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Workers {
    /// Those of this process. Memory of a parent's is never freed, since its locks may be held.
    fn of_process() -> &'static Workers {
        static CURRENT: AtomicPtr<Workers> = AtomicPtr::new(ptr::null_mut());
        let process = process::id();
        loop {
            let current = CURRENT.load(Ordering::Acquire);
            // SAFETY: it is null, or a box that is never freed, for only the loser of the exchange below frees its own.
            if let Some(workers) = unsafe { current.as_ref() }
                && workers.process == process
            {
                return workers;
            }
            let new = Box::into_raw(Box::new(Workers {
                process,
                state: Mutex::default(),
                offered: AtomicUsize::new(0),
                more: Condvar::new(),
            }));
            if CURRENT.compare_exchange(current, new, Ordering::AcqRel, Ordering::Acquire).is_err() {
                // SAFETY: it is the box from above, which the failed exchange gave to nobody.
                drop(unsafe { Box::from_raw(new) });
            }
        }
    }

    /// Offers a job to `count` workers; starts those that are missing, if the system lets it.
    fn offer(&'static self, job: &Arc<Job>, count: usize) {
        let mut state = lock(&self.state);
        state.offers.extend((0..count).map(|_| Arc::clone(job)));
        self.offered.store(state.offers.len(), Ordering::Release);
        let (asleep, missing) = (state.asleep, state.offers.len().saturating_sub(state.idle));
        drop(state);
        (0..asleep.min(count)).for_each(|_| self.more.notify_one());
        for _ in 0..missing {
            let name = thread::Builder::new().name("polhode".into());
            if name.spawn(|| self.work()).is_err() {
                break;
            }
        }
    }

    /// Withdraws the offers of a job.
    fn withdraw(&self, job: &Arc<Job>) {
        let mut state = lock(&self.state);
        state.offers.retain(|offer| !Arc::ptr_eq(offer, job));
        self.offered.store(state.offers.len(), Ordering::Release);
    }

    /// Takes offers until there are none for some time.
    fn work(&self) {
        while let Some(job) = self.next() {
            job.work();
        }
    }

    fn next(&self) -> Option<Arc<Job>> {
        let mut state = lock(&self.state);
        if let Some(job) = self.take(&mut state) {
            return Some(job);
        }
        state.idle += 1;
        drop(state);
        for _ in 0..WATCHED {
            if self.offered.load(Ordering::Acquire) > 0 {
                break;
            }
            std::hint::spin_loop();
        }
        let mut state = lock(&self.state);
        let mut found = self.take(&mut state);
        let mut slept = false;
        while found.is_none() && !slept {
            state.asleep += 1;
            let (woken, timeout) =
                self.more.wait_timeout(state, IDLE).unwrap_or_else(PoisonError::into_inner);
            state = woken;
            state.asleep -= 1;
            slept = timeout.timed_out();
            found = self.take(&mut state);
        }
        state.idle -= 1;
        found
    }

    fn take(&self, state: &mut State) -> Option<Arc<Job>> {
        let job = state.offers.pop_front();
        self.offered.store(state.offers.len(), Ordering::Release);
        job
    }
}

impl Job {
    /// Does the work, if the call has not ended.
    fn work(&self) {
        let progress = lock(&self.progress);
        if !progress.open {
            return;
        }
        self.working.fetch_add(1, Ordering::Relaxed);
        drop(progress);
        // SAFETY: the job was open while `working` was raised, under one lock; so `end`, and with it the call that lent the
        // work, waits until it is lowered below.
        let done = catch_unwind(AssertUnwindSafe(|| unsafe { (*self.work)() }));
        let mut progress = lock(&self.progress);
        progress.panic = progress.panic.take().or(done.err());
        if self.working.fetch_sub(1, Ordering::Release) == 1 {
            self.ended.notify_all();
        }
    }

    /// Lets nobody begin, and waits for those who did; the panic of one of them.
    fn end(&self) -> Option<Box<dyn Any + Send>> {
        lock(&self.progress).open = false;
        for _ in 0..WATCHED {
            if self.working.load(Ordering::Acquire) == 0 {
                break;
            }
            std::hint::spin_loop();
        }
        let mut progress = lock(&self.progress);
        while self.working.load(Ordering::Acquire) > 0 {
            progress = self.ended.wait(progress).unwrap_or_else(PoisonError::into_inner);
        }
        progress.panic.take()
    }
}

/// Calls `work` in this thread, and at the same time in up to `count` workers that are or become free before it returns
/// here. All have returned when this does; a panic of any is passed on.
pub(super) fn together(count: usize, work: &(dyn Fn() + Sync)) {
    let borrowed: *const (dyn Fn() + Sync) = work;
    // SAFETY: only the lifetime changes. Nobody calls the work after `end`, which runs before this returns or unwinds:
    // nothing between here and there panics but the work, which is caught.
    let lasting =
        unsafe { std::mem::transmute::<*const (dyn Fn() + Sync), *const (dyn Fn() + Sync)>(borrowed) };
    let progress = Mutex::new(Progress { open: true, panic: None });
    let job = Arc::new(Job { work: lasting, progress, working: AtomicUsize::new(0), ended: Condvar::new() });
    let workers = Workers::of_process();
    workers.offer(&job, count);
    let done = catch_unwind(AssertUnwindSafe(work));
    workers.withdraw(&job);
    let of_others = job.end();
    if let Some(panic) = done.err().or(of_others) {
        resume_unwind(panic);
    }
}

#[cfg(test)]
mod tests;
