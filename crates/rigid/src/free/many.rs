//! Many motions at many times.

use super::{AnyFlow, FreeMotion};
use polhode_ga::curve::sample;
use polhode_ga::threads::{Threads, for_each};
use std::ops::Range;

/// From so many states on a thread more pays.
const SHARED: usize = 2048;

/// Fewer times than this are faster one by one than in lanes, which come 64 at a time.
const IN_LANES: usize = 8;

/// States `rows` of all those of the motions at the times, motion by motion: rows of four rotor components and
/// of three components of the angular velocity. The same bits as [`FreeMotion::at`], for any threads.
///
/// # Panics
/// If the numbers of rows are not that of the states, or there are no such states.
pub fn at_each(
    threads: Threads,
    motions: &[FreeMotion],
    times: &[f64],
    rows: Range<usize>,
    mut rotors: &mut [f64],
    mut omegas: &mut [f64],
) {
    assert!(rotors.len() == 4 * rows.len() && omegas.len() == 3 * rows.len(), "results of the wrong length");
    let pieces = threads.ranges(rows.len(), SHARED).map(|piece| {
        let length = piece.len();
        let a = rotors.split_off_mut(..4 * length).expect("pieces fill the result");
        let b = omegas.split_off_mut(..3 * length).expect("pieces fill the result");
        (rows.start + piece.start, a, b)
    });
    for_each(pieces, |(first, rotors, omegas)| in_order(motions, times, first, rotors, omegas));
}

/// The states from row `first` on.
fn in_order(
    motions: &[FreeMotion],
    times: &[f64],
    mut first: usize,
    mut rotors: &mut [f64],
    mut omegas: &mut [f64],
) {
    while !rotors.is_empty() {
        let motion = &motions[first / times.len()];
        let rest = &times[first % times.len()..];
        let count = rest.len().min(rotors.len() / 4);
        let (a, more_rotors) = rotors.split_at_mut(4 * count);
        let (b, more_omegas) = omegas.split_at_mut(3 * count);
        motion.fill(&rest[..count], a, b);
        (rotors, omegas) = (more_rotors, more_omegas);
        first += count;
    }
}

impl FreeMotion {
    /// The states at the times, by the calling thread.
    pub(crate) fn fill(&self, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        if times.len() >= IN_LANES {
            return match &self.flow {
                AnyFlow::Circular(flow) => sample(flow, Threads::ONE, times, rotors, omegas),
                AnyFlow::Hyperbolic(flow) => sample(flow, Threads::ONE, times, rotors, omegas),
            };
        }
        let states = rotors.as_chunks_mut::<4>().0.iter_mut().zip(omegas.as_chunks_mut::<3>().0);
        for (&t, (rotor, omega)) in times.iter().zip(states) {
            let state = self.at(t);
            (*rotor, *omega) = (state.0.components(), state.1.0);
        }
    }
}
