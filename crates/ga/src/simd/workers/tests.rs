use super::*;
use std::sync::Barrier;

/// The caller and as many workers as were asked for work at the same time: each waits for all others.
#[test]
fn workers_work_at_the_same_time() {
    for count in [1, 3, 7, 2] {
        let barrier = Barrier::new(count + 1);
        together(count, &|| _ = barrier.wait());
    }
}

/// A call that is made by a worker ends, also when all workers are busy with such calls.
#[test]
fn work_may_ask_for_workers() {
    let calls = AtomicUsize::new(0);
    let outer = AtomicUsize::new(8);
    let take = |left: &AtomicUsize| {
        left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1)).is_ok()
    };
    together(4, &|| {
        while take(&outer) {
            let inner = AtomicUsize::new(10);
            together(4, &|| {
                while take(&inner) {
                    calls.fetch_add(1, Ordering::Relaxed);
                }
            });
            assert_eq!(inner.into_inner(), 0);
        }
    });
    assert_eq!(calls.into_inner(), 80);
}

/// Threads that call at the same time share the workers.
#[test]
fn many_threads_may_call() {
    // Miri interprets, a thousand times slower.
    let (callers, calls) = if cfg!(miri) { (3, 4) } else { (8, 200) };
    thread::scope(|scope| {
        for _ in 0..callers {
            scope.spawn(|| {
                for _ in 0..calls {
                    let sum = AtomicUsize::new(0);
                    let left = Mutex::new(0..20);
                    let next = || lock(&left).next();
                    together(3, &|| {
                        while let Some(x) = next() {
                            sum.fetch_add(x, Ordering::Relaxed);
                        }
                    });
                    assert_eq!(sum.into_inner(), 190);
                }
            });
        }
    });
}

/// A panic in a worker reaches the caller, after all others have ended; the workers go on.
#[test]
fn a_panic_is_passed_on() {
    let barrier = Barrier::new(2);
    let me = thread::current().id();
    let work = || {
        barrier.wait();
        assert!(thread::current().id() == me, "in a worker");
    };
    let panic = catch_unwind(AssertUnwindSafe(|| together(1, &work))).expect_err("it panics");
    assert_eq!(panic.downcast_ref(), Some(&"in a worker"));
    together(1, &|| _ = barrier.wait());
}
