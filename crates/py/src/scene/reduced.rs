//! Motions of an ensemble reduced to a few numbers of each body, as arrays.

use crate::mechanics::ensemble::Results;
use crate::support::arrays::{Array, Rows, all_threads, bad, line, numbers, table};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use polhode_ga::Vector;
use polhode_ga::simd::threads::Threads;
use polhode_rigid::ensemble::bins::{self, WIDTH};
use polhode_rigid::ensemble::reduce::{COUNTED, ENDS, REGIMES, ROW, Watch, bins_of_periods, code};
use polhode_rigid::ensemble::{Ensemble, Outputs};
use polhode_rigid::scene::KEPT;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, PoisonError};

/// The rotors of the nominal body (n, 4), a direction fixed in the body (3,), and the directions (m, 3) from which its tilt
/// is measured.
pub(crate) type Watched<'py> = (Rows<'py>, [f64; 3], Rows<'py>);

/// The columns of filled bins: column, bin and count.
type Filled<'py> = (Bound<'py, PyArray1<u32>>, Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<u32>>);

/// What may be kept of the motions of an ensemble.
#[pyfunction]
pub(crate) fn kept_words() -> [&'static str; 6] {
    KEPT
}

/// Counts of numbers in bins: of bodies at n times, and of their periods.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct BinCounts {
    series: Mutex<bins::BinCounts>,
    periods: Mutex<bins::BinCounts>,
}

#[pymethods]
impl BinCounts {
    #[new]
    fn new(times: usize) -> BinCounts {
        let series = bins::BinCounts::new(COUNTED * times + ENDS);
        BinCounts { series: Mutex::new(series), periods: Mutex::new(bins::BinCounts::new(2)) }
    }

    /// Relative width of a bin.
    #[classattr]
    fn width() -> f64 {
        WIDTH
    }

    /// The filled bins of the series and ends, in order.
    fn filled<'py>(&self, py: Python<'py>) -> Filled<'py> {
        let (mut columns, mut bins, mut counts) = (vec![], vec![], vec![]);
        for (column, bin, count) in held(&self.series).filled() {
            columns.push(column);
            bins.push(bin);
            counts.push(count);
        }
        (PyArray1::from_vec(py, columns), PyArray1::from_vec(py, bins), PyArray1::from_vec(py, counts))
    }

    /// Adds filled bins.
    fn add_filled(
        &self,
        columns: PyReadonlyArray1<'_, u32>,
        bins: PyReadonlyArray1<'_, i32>,
        counts: PyReadonlyArray1<'_, u32>,
    ) -> PyResult<()> {
        if held(&self.series).add_filled(columns.as_slice()?, bins.as_slice()?, counts.as_slice()?) {
            Ok(())
        } else {
            Err(bad("counts of another number of times"))
        }
    }

    /// Adds the counts of others.
    fn merge(slf: &Bound<'_, Self>, other: &Bound<'_, Self>) -> PyResult<()> {
        let (own, other) = (slf.get(), other.get());
        let pairs = [(&own.series, &other.series), (&own.periods, &other.periods)];
        for (counts, more) in pairs {
            let more = held(more).clone();
            if !held(counts).merge(&more) {
                return Err(bad("counts of another number of times"));
            }
        }
        Ok(())
    }

    /// The quantiles of the columns (columns, levels) of the series, at all times each, and of the ends; then of the periods
    /// (2, levels).
    fn quantiles<'py>(&self, py: Python<'py>, levels: Vec<f64>) -> PyResult<[Array<'py>; 2]> {
        let mut found =
            [&self.series, &self.periods].map(|counts| held(counts).quantiles(&levels)).into_iter();
        let mut next = || {
            let rows = found.next().unwrap_or_default();
            let shape = vec![rows.len(), levels.len()];
            PyArray1::from_vec(py, rows.concat()).reshape(shape)
        };
        Ok([next()?, next()?])
    }
}

fn held<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The motions that `run` computes, reduced: see `Scene::reduce_many`.
#[allow(clippy::too_many_arguments)]
pub(crate) fn reduced<'py>(
    py: Python<'py>,
    bodies: &Ensemble,
    times: &[f64],
    run: impl FnOnce(Option<usize>) -> PyResult<Results<'py>>,
    watched: Option<Watched<'py>>,
    free: bool,
    counts: Option<&Bound<'py, BinCounts>>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let (arrays, summary) = run(threads)?;
    let counts = counts.map(Bound::get);
    let threads = threads.map_or_else(all_threads, |count| Ok(Threads::new(count)))?;
    let mut rows: Vec<_> = arrays.iter().map(|array| array.readwrite()).collect();
    let mut slices = rows.iter_mut().map(|row| row.as_slice_mut()).collect::<Result<Vec<_>, _>>()?;
    let (count, n) = (bodies.starts.len(), times.len());
    let result = PyDict::new(py);
    result.set_item("summary", summary)?;
    // The last state of each body: of each quantity the last of n rows.
    for (name, (k, size)) in
        [("rotor", (0, 4)), ("omega_body", (1, 3)), ("position", (4, 3)), ("velocity", (5, 3))]
    {
        let Some(slice) = slices.get(k) else { continue };
        let last = slice.chunks_exact(n * size).flat_map(|body| &body[(n - 1) * size..]).copied();
        let last = PyArray1::from_vec(py, last.collect()).reshape(vec![count, size])?;
        result.set_item(name, last)?;
    }
    let centers = bodies.starts.iter().map(|start| start.center.components());
    result.set_item("centers", table(py, centers)?)?;
    if let Some((nominal, axis, upright)) = watched {
        let (nominal, upright) =
            (numbers(&nominal)?.as_chunks::<4>().0, numbers(&upright)?.as_chunks::<3>().0);
        if nominal.len() != n || !(upright.len() < 2 || upright.len() == n) {
            return Err(bad("the nominal body has another number of times"));
        }
        let watch = Watch { times, nominal, axis: Vector(axis), upright };
        let mut found = vec![[0.0; ROW]; count];
        let mut binned = vec![0; if counts.is_some() { count * (COUNTED * n + ENDS) } else { 0 }];
        let mut slices = slices.iter_mut().map(|slice| &mut **slice);
        let mut next = || slices.next().unwrap_or_default();
        let (rotors, omegas, momenta, energies) = (next(), next(), next(), next());
        let states = Outputs { rotors, omegas, momenta, energies, centers: None };
        py.detach(|| {
            watch.reduce(&states, threads, &mut found, &mut binned);
            if let Some(counts) = counts {
                held(&counts.series).add(&binned, threads);
            }
        });
        result.set_item("rows", table(py, found.into_iter())?)?;
    }
    if free {
        let found = py.detach(|| bodies.describe_free(threads));
        if let Some(counts) = counts {
            let bins: Vec<i32> = bins_of_periods(&found).flatten().collect();
            held(&counts.periods).add(&bins, Threads::ONE);
        }
        let codes = found.iter().map(|body| code(body.regime)).collect();
        result.set_item("regime", PyArray1::<i8>::from_vec(py, codes))?;
        result.set_item("period", line(py, found.iter().map(|body| body.period).collect()))?;
        let precession = found.iter().map(|body| body.precession_period).collect();
        result.set_item("precession_period", line(py, precession))?;
    }
    Ok(result)
}

/// The names of the regimes of free bodies, by their codes.
#[pyfunction]
pub(crate) fn regimes() -> Vec<String> {
    REGIMES.map(|regime| regime.to_string()).to_vec()
}
