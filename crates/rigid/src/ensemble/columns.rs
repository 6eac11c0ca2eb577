//! Columns of the summary: threads write to the rows of their bodies as these are done.
//!
//! Numbers are stored as atomic words, which cost no more than plain ones: each row is written by one thread.

use super::Failure;
use super::member::Outcome;
use super::output::{Drift, Summary};
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

/// A number of each body.
struct Column(Vec<AtomicU64>);

impl Column {
    fn new(bodies: usize, filling: u64) -> Column {
        Column((0..bodies).map(|_| AtomicU64::new(filling)).collect())
    }

    /// Of numbers that are not known yet: NaN.
    fn unknown(bodies: usize) -> Column {
        Column::new(bodies, f64::NAN.to_bits())
    }

    fn write(&self, body: usize, word: u64) {
        self.0[body].store(word, Ordering::Relaxed);
    }

    /// The words; collecting them reuses the memory.
    fn words(self) -> Vec<u64> {
        self.0.into_iter().map(AtomicU64::into_inner).collect()
    }

    /// The numbers; collecting them reuses the memory.
    fn numbers(self) -> Vec<f64> {
        self.0.into_iter().map(|word| f64::from_bits(word.into_inner())).collect()
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
    methods: Column,
    steps: Column,
    evaluations: Column,
    longest: Column,
    estimates: Column,
    norm_drifts: Column,
    /// Values and changes, by [`Conserved::number`], made when a body has the quantity; NaN for bodies that do not.
    drifts: [OnceLock<[Column; 2]>; NAMES.len()],
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
            evaluations: Column::new(bodies, 0),
            longest: Column::new(bodies, 0),
            estimates: Column::unknown(bodies),
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
        self.methods.write(body, method as u64);
        self.steps.write(body, steps);
        self.evaluations.write(body, evaluations);
        self.longest.write(body, longest.to_bits());
        self.estimates.write(body, estimate.to_bits());
        self.norm_drifts.write(body, norm_drift.to_bits());
    }

    /// Records a conserved quantity at the start, and its largest relative change.
    pub fn drift(&self, body: usize, quantity: Conserved, numbers: [f64; 2]) {
        let columns =
            self.drifts[quantity.number()].get_or_init(|| from_fn(|_| Column::unknown(self.bodies)));
        columns.iter().zip(numbers).for_each(|(column, x)| column.write(body, x.to_bits()));
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
        let mut methods = self.methods.words();
        let method_names = by_first_use(rare.methods, &mut methods);
        let mut drifts = Vec::new();
        for (name, columns) in NAMES.into_iter().zip(self.drifts) {
            let Some(columns) = columns.into_inner() else { continue };
            let [values, changes] = columns.map(Column::numbers);
            // In the order of the first bodies that have them.
            let first = values.iter().position(|value| !value.is_nan()).unwrap_or(values.len());
            drifts.push((first, Drift { name, values, changes }));
        }
        drifts.sort_by_key(|(first, _)| *first);
        Summary {
            method_names,
            methods,
            steps: self.steps.words(),
            evaluations: self.evaluations.words(),
            longest: self.longest.numbers(),
            estimates: self.estimates.numbers(),
            norm_drifts: self.norm_drifts.numbers(),
            drifts: drifts.into_iter().map(|(_, drift)| drift).collect(),
            failures: rare.failures,
            warnings: rare.warnings.into_iter().map(|(_, _, text)| text).collect(),
        }
    }
}
