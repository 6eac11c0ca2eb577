//! Columns of the summary: threads write to the rows of their bodies as these are done.
//!
//! Numbers are stored as atomic words, which cost no more than plain ones: each row is written by one thread.

use super::Failure;
use super::member::Outcome;
use super::output::Summary;
use crate::error::SimulateError;
use crate::laws::conserved::{Conserved, NAMES};
use std::array::from_fn;
use std::mem;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Locks, also after a panic of another thread.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// N numbers of each body.
struct Column<const N: usize>(Vec<[AtomicU64; N]>);

impl<const N: usize> Column<N> {
    fn new(bodies: usize, filling: u64) -> Column<N> {
        Column((0..bodies).map(|_| from_fn(|_| AtomicU64::new(filling))).collect())
    }

    fn write(&self, body: usize, words: [u64; N]) {
        for (place, word) in self.0[body].iter().zip(words) {
            place.store(word, Ordering::Relaxed);
        }
    }

    fn finish(self) -> Vec<[u64; N]> {
        let row = |row: [AtomicU64; N]| from_fn(|k| row[k].load(Ordering::Relaxed));
        self.0.into_iter().map(row).collect()
    }

    fn numbers(self) -> Vec<[f64; N]> {
        let row = |row: [AtomicU64; N]| from_fn(|k| f64::from_bits(row[k].load(Ordering::Relaxed)));
        self.0.into_iter().map(row).collect()
    }
}

/// Names in the order in which the numbers refer to them, which are changed accordingly: threads add names in any order.
fn by_first_use(names: Vec<&'static str>, numbers: &mut [u64]) -> Vec<&'static str> {
    if names.len() == 1 {
        return names;
    }
    let mut ordered: Vec<&'static str> = Vec::with_capacity(names.len());
    for number in numbers {
        let name = names.get(*number as usize).copied().unwrap_or_default();
        let place = ordered.iter().position(|known| *known == name).unwrap_or_else(|| {
            ordered.push(name);
            ordered.len() - 1
        });
        *number = place as u64;
    }
    ordered
}

/// What is recorded of few bodies.
#[derive(Default)]
struct Rare {
    /// The names of the methods, by number.
    methods: Vec<&'static str>,
    failures: Vec<Failure>,
    /// Each once, with the first body and its place among the warnings of that.
    warnings: Vec<(usize, usize, String)>,
}

/// The columns of all bodies.
pub(super) struct Columns {
    bodies: usize,
    /// By number.
    methods: Column<1>,
    steps: Column<2>,
    longest: Column<1>,
    estimates: Column<1>,
    norm_drifts: Column<1>,
    /// By [`Conserved::number`], made when a body has the quantity; NaN for bodies that do not.
    drifts: [OnceLock<Column<2>>; NAMES.len()],
    rare: Mutex<Rare>,
}

/// How a body was computed.
#[derive(Clone, Copy)]
pub(super) struct Record {
    /// See [`Columns::method`].
    pub method: usize,
    /// Longest step in s.
    pub longest: f64,
    pub steps: u64,
    pub evaluations: u64,
    /// NaN if unknown.
    pub estimate: f64,
    pub norm_drift: f64,
}

impl Columns {
    pub fn new(bodies: usize) -> Columns {
        Columns {
            bodies,
            methods: Column::new(bodies, 0),
            steps: Column::new(bodies, 0),
            longest: Column::new(bodies, 0),
            estimates: Column::new(bodies, f64::NAN.to_bits()),
            norm_drifts: Column::new(bodies, 0),
            drifts: from_fn(|_| OnceLock::new()),
            rare: Mutex::default(),
        }
    }

    /// The number of a method.
    pub fn method(&self, name: &'static str) -> usize {
        let methods = &mut lock(&self.rare).methods;
        methods.iter().position(|known| *known == name).unwrap_or_else(|| {
            methods.push(name);
            methods.len() - 1
        })
    }

    pub fn record(&self, body: usize, record: Record) {
        let Record { method, longest, steps, evaluations, estimate, norm_drift } = record;
        self.methods.write(body, [method as u64]);
        self.steps.write(body, [steps, evaluations]);
        self.longest.write(body, [longest.to_bits()]);
        self.estimates.write(body, [estimate.to_bits()]);
        self.norm_drifts.write(body, [norm_drift.to_bits()]);
    }

    /// Records a conserved quantity at the start, and its largest relative change.
    pub fn drift(&self, body: usize, quantity: Conserved, numbers: [f64; 2]) {
        let column =
            self.drifts[quantity.number()].get_or_init(|| Column::new(self.bodies, f64::NAN.to_bits()));
        column.write(body, numbers.map(f64::to_bits));
    }

    pub fn fail(&self, body: usize, (time, error): (f64, SimulateError)) {
        lock(&self.rare).failures.push(Failure { body, time, error });
    }

    /// Records warnings of a body.
    pub fn warn(&self, body: usize, warnings: impl IntoIterator<Item = String>) {
        for (place, text) in warnings.into_iter().enumerate() {
            let known = &mut lock(&self.rare).warnings;
            match known.iter_mut().find(|(_, _, known)| *known == text) {
                Some(warning) => (warning.0, warning.1) = (warning.0, warning.1).min((body, place)),
                None => known.push((body, place, text)),
            }
        }
    }

    /// Records all of a body.
    pub fn take(&self, Outcome { body, certificate, failure }: Outcome) {
        let record = Record {
            method: self.method(certificate.method),
            longest: certificate.step,
            steps: certificate.steps,
            evaluations: certificate.evaluations,
            estimate: certificate.error_estimate.unwrap_or(f64::NAN),
            norm_drift: certificate.norm_drift,
        };
        self.record(body, record);
        for (quantity, start, change) in certificate.drifts {
            self.drift(body, quantity, [start, change]);
        }
        self.warn(body, certificate.warnings);
        if let Some(failure) = failure {
            self.fail(body, failure);
        }
    }

    /// The summary, once all bodies are done.
    pub fn finish(self) -> Summary {
        let mut rare = mem::take(&mut *lock(&self.rare));
        rare.failures.sort_by_key(|failure| failure.body);
        rare.warnings.sort_by_key(|(body, place, _)| (*body, *place));
        let mut methods = self.methods.finish().into_flattened();
        let method_names = by_first_use(rare.methods, &mut methods);
        let mut drifts = Vec::new();
        for (name, column) in NAMES.into_iter().zip(self.drifts) {
            let Some(column) = column.into_inner() else { continue };
            let rows = column.numbers();
            // In the order of the first bodies that have them.
            let first = rows.iter().position(|[start, _]| !start.is_nan()).unwrap_or(rows.len());
            drifts.push((first, (name, rows)));
        }
        drifts.sort_by_key(|(first, _): &(usize, _)| *first);
        Summary {
            method_names,
            methods,
            steps: self.steps.finish(),
            longest: self.longest.numbers().into_flattened(),
            estimates: self.estimates.numbers().into_flattened(),
            norm_drifts: self.norm_drifts.numbers().into_flattened(),
            drifts: drifts.into_iter().map(|(_, column)| column).collect(),
            failures: rare.failures,
            warnings: rare.warnings.into_iter().map(|(_, _, text)| text).collect(),
        }
    }
}
