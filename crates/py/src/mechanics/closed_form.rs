//! Motions in closed form of one body or a batch, with solutions kept in Rust.

use super::bodies::Inertias;
use crate::algebra::value::{number, one as one_value, one_rotor};
use crate::support::arrays::{Array, Rows, bad, numbers, place, table, threads};
use crate::support::pool;
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use polhode_ga::product::Grades;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Graded, Rotor};
use polhode_rigid::body::inertia;
use polhode_rigid::exact::many::{TILE, Tile, Times, at_each};
use polhode_rigid::exact::motion::ExactMotion;
use polhode_rigid::state::checks::check_horizons;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::array::from_fn;
use std::ops::Range;

/// States between checks for Ctrl-C.
const PIECE: usize = 1 << 19;

/// Cost of setting up a motion, or of its derivatives at one time, in states.
const WORK: usize = 256;

/// Rotors (n, 4) and angular velocities (n, 3) at times (n,).
pub(crate) type States<'py> = PyResult<(Array<'py>, Array<'py>)>;

/// Rotor and angular velocity at the start.
pub(crate) type Start = ([f64; 4], [f64; 3]);

/// Motions in closed form under one law, a batch of some shape.
#[pyclass(frozen, subclass, module = "polhode._native")]
pub(crate) struct ClosedForm {
    motions: Motions,
    /// One for all, or one for each.
    inertias: Vec<inertia::Inertia>,
    /// As given.
    starts: Vec<Start>,
    /// Numbers of the law for each, and how many.
    parameters: (Vec<f64>, usize),
    shape: Vec<usize>,
    /// The horizons of all motions, backwards and forwards, in s.
    horizons: [f64; 2],
}

enum Motions {
    One(Box<dyn ExactMotion>),
    /// Data for states; other results set a motion up again.
    Many(Vec<Tile>),
}

/// Bodies and starts of a batch, as Python has them: one inertia, or one for each; rotors (…, 4), angular velocities
/// (…, 3) and the numbers of the law (…, N).
pub(crate) struct Given<'py> {
    pub inertias: Inertias,
    pub rotors: Rows<'py>,
    pub omegas: Rows<'py>,
    pub parameters: Option<Rows<'py>>,
}

/// A body of a batch at its start, with the numbers of its law.
pub(crate) struct Started<'a, const N: usize> {
    pub inertia: &'a inertia::Inertia,
    pub rotor: Rotor,
    pub omega: Bivector,
    pub law: [f64; N],
}

/// `count` states from a function that fills a range of rows; signals are checked after `piece` rows.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    count: usize,
    piece: usize,
    fill: impl Fn(Range<usize>, &mut [f64], &mut [f64]) + Sync,
) -> States<'py> {
    let (rotors, omegas) = (pool::array(py, &[count, 4])?, pool::array(py, &[count, 3])?);
    let (mut rotor_rows, mut omega_rows) = (rotors.readwrite(), omegas.readwrite());
    let rows = rotor_rows.as_slice_mut()?.chunks_mut(4 * piece);
    let pieces = rows.zip(omega_rows.as_slice_mut()?.chunks_mut(3 * piece));
    for (part, (rotors, omegas)) in pieces.enumerate() {
        let rows = part * piece..part * piece + rotors.len() / 4;
        py.detach(|| fill(rows, rotors, omegas));
        py.check_signals()?;
    }
    drop((rotor_rows, omega_rows));
    Ok((rotors, omegas))
}

/// Numbers that are compared at a time.
const COMPARED: usize = 16;

/// The least and the largest of some finite numbers and 0.
fn ends(numbers: &[f64]) -> [f64; 2] {
    let (parts, rest) = numbers.as_chunks::<COMPARED>();
    let (mut least, mut largest) = ([0.0_f64; COMPARED], [0.0_f64; COMPARED]);
    for part in parts {
        for k in 0..COMPARED {
            // Comparisons, which the compiler vectorises; `f64::min` also considers NaN.
            least[k] = if part[k] < least[k] { part[k] } else { least[k] };
            largest[k] = if part[k] > largest[k] { part[k] } else { largest[k] };
        }
    }
    let least = least.iter().chain(rest).fold(0.0, |a: f64, x| a.min(*x));
    [least, largest.iter().chain(rest).fold(0.0, |a: f64, x| a.max(*x))]
}

pub(crate) fn check_times(times: &[f64]) -> PyResult<()> {
    // Products with 0 are NaN for what is not finite.
    let (parts, rest) = times.as_chunks::<COMPARED>();
    let mut sums = [0.0_f64; COMPARED];
    for part in parts {
        for k in 0..COMPARED {
            sums[k] += part[k] * 0.0;
        }
    }
    if sums.iter().all(|sum| *sum == 0.0) && rest.iter().all(|t| t.is_finite()) {
        return Ok(());
    }
    match times.iter().position(|t| !t.is_finite()) {
        Some(index) => Err(bad(format!("time {} at index {index} is not finite", times[index]))),
        None => Ok(()),
    }
}

/// Results of work in chunks, between which Python may interrupt; each chunk costs as much as setting up this number
/// of motions.
pub(crate) fn pieces<T: Send>(
    py: Python<'_>,
    count: usize,
    motions: usize,
    work: impl Fn(usize) -> T + Sync,
) -> PyResult<Vec<T>> {
    let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
    let threads = threads(WORK.saturating_mul(motions).saturating_mul(count))?;
    let size = (PIECE / WORK * 16 / motions).max(1);
    for (part, piece) in results.chunks_mut(size).enumerate() {
        let first = part * size;
        py.detach(|| {
            threads.for_each_piece(32usize.div_ceil(motions), 1, piece, |rows, piece| {
                for (row, slot) in rows.zip(piece) {
                    *slot = Some(work(first + row));
                }
            });
        });
        py.check_signals()?;
    }
    Ok(results.into_iter().flatten().collect())
}

impl ClosedForm {
    /// The motions, and a single one, from a function of one body and one of the bodies of a tile. An error has the place
    /// of the body in the batch.
    pub fn new<M: ExactMotion + Copy + 'static, const N: usize>(
        py: Python<'_>,
        given: Given<'_>,
        one: impl Fn(&Started<'_, N>) -> Result<M, String>,
        tile: impl Fn(&mut dyn Iterator<Item = Result<Started<'_, N>, String>>) -> Result<Tile, (usize, String)>
        + Sync,
    ) -> PyResult<(ClosedForm, Option<M>)> {
        let shape = given.rotors.shape().split_last().map_or(&[][..], |(_, batch)| batch).to_vec();
        let rotors = numbers(&given.rotors)?.as_chunks::<4>().0;
        let omegas = numbers(&given.omegas)?.as_chunks::<3>().0;
        let starts: Vec<Start> = rotors.iter().zip(omegas).map(|(rotor, omega)| (*rotor, *omega)).collect();
        let Inertias(inertias) = given.inertias;
        if inertias.len() != 1 && inertias.len() != starts.len() {
            return Err(bad(format!("{} inertias for {} motions", inertias.len(), starts.len())));
        }
        let parameters = match &given.parameters {
            Some(rows) => numbers(rows)?.to_vec(),
            None => Vec::new(),
        };
        if parameters.len() != N * starts.len() {
            return Err(bad(format!("{} numbers of the law for {} motions", parameters.len(), starts.len())));
        }
        let started = |row: usize| {
            let (rotor, omega) = starts[row];
            Ok(Started {
                inertia: &inertias[row.min(inertias.len() - 1)],
                rotor: Rotor::from_components(rotor).map_err(|error| error.to_string())?,
                omega: Bivector(omega),
                law: from_fn(|k| parameters[N * row + k]),
            })
        };
        let at = |row: usize, error: String| bad(format!("{}{error}", place(row, &shape)));
        let (motions, one) = if shape.is_empty() {
            let one = started(0).and_then(|body| one(&body)).map_err(bad)?;
            (Motions::One(Box::new(one)), Some(one))
        } else {
            let tiles = pieces(py, starts.len().div_ceil(TILE), TILE, |index| {
                let first = index * TILE;
                tile(&mut (first..starts.len()).map(started)).map_err(|(place, e)| (first + place, e))
            })?;
            let tiles = tiles.into_iter().map(|tile| tile.map_err(|(row, error)| at(row, error)));
            (Motions::Many(tiles.collect::<PyResult<_>>()?), None)
        };
        Ok((ClosedForm::of(motions, inertias, starts, (parameters, N), shape), one))
    }

    /// A single motion without numbers of a law.
    pub fn single(motion: impl ExactMotion + 'static, inertia: inertia::Inertia, start: Start) -> ClosedForm {
        let motions = Motions::One(Box::new(motion));
        ClosedForm::of(motions, vec![inertia], vec![start], (Vec::new(), 0), Vec::new())
    }

    fn of(
        motions: Motions,
        inertias: Vec<inertia::Inertia>,
        starts: Vec<Start>,
        parameters: (Vec<f64>, usize),
        shape: Vec<usize>,
    ) -> ClosedForm {
        let least = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.min(d)];
        let horizons = motions.horizons().fold([f64::INFINITY; 2], least);
        ClosedForm { motions, inertias, starts, parameters, shape, horizons }
    }

    /// The number of motions.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// The shape of the batch.
    pub fn batch(&self) -> &[usize] {
        &self.shape
    }

    /// The body of a motion, its start and the numbers of its law.
    pub fn given(&self, row: usize) -> (&inertia::Inertia, &Start, &[f64]) {
        let (parameters, size) = &self.parameters;
        let own = &parameters[row * size..(row + 1) * size];
        (&self.inertias[row.min(self.inertias.len() - 1)], &self.starts[row], own)
    }

    /// Checks that times are finite and within the horizons of every motion.
    pub fn check(&self, times: &[f64]) -> PyResult<()> {
        check_times(times)?;
        let [earliest, latest] = ends(times);
        let within = |horizons: [f64; 2]| -earliest <= horizons[0] && latest <= horizons[1];
        if within(self.horizons) {
            return Ok(());
        }
        match self.motions.horizons().enumerate().find(|(_, horizons)| !within(*horizons)) {
            Some((row, horizons)) => check_horizons(0.0, times, horizons)
                .map_err(|error| bad(format!("{}{error}", place(row, &self.shape)))),
            None => Ok(()),
        }
    }

    /// Computes states. Threads share large batches; Python may interrupt every few milliseconds.
    fn states<'py>(&self, py: Python<'py>, times: Times<'_>, count: usize) -> States<'py> {
        let threads: Threads = threads(7 * count)?;
        filled(py, count, PIECE, |rows, rotors, omegas| match (&self.motions, times) {
            (Motions::Many(tiles), _) => at_each(threads, tiles, times, rows, rotors, omegas),
            (Motions::One(motion), Times::Common(times) | Times::Own(times, _)) => {
                motion.at_many(threads, &times[rows], rotors, omegas);
            }
        })
    }
}

impl Motions {
    fn horizons(&self) -> impl Iterator<Item = [f64; 2]> {
        let (one, many) = match self {
            Motions::One(motion) => (Some(motion.horizons()), &[][..]),
            Motions::Many(tiles) => (None, &tiles[..]),
        };
        one.into_iter().chain(many.iter().flat_map(Tile::horizons).copied())
    }
}

#[pymethods]
impl ClosedForm {
    /// Rotor and angular velocity of a single motion at a single time; None for anything else.
    fn once<'py>(&self, t: &Bound<'py, PyAny>) -> PyResult<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
        let py = t.py();
        let (Some(t), Motions::One(motion)) = (number(t), &self.motions) else { return Ok(None) };
        self.check(&[t])?;
        let (rotor, omega) = motion.at(t);
        let Some(omega) = Graded::new(&omega.0, Grades::BIVECTOR) else { return Ok(None) };
        Ok(Some((one_rotor(py, rotor)?, one_value(py, omega)?)))
    }

    /// Rotors and angular velocities of all motions at all times, rows motion by motion.
    fn at<'py>(&self, py: Python<'py>, times: Rows<'py>) -> States<'py> {
        let times = numbers(&times)?;
        self.check(times)?;
        self.states(py, Times::Common(times), self.starts.len() * times.len())
    }

    /// The same for each motion at its own times, `each` in a row, cyclically. The caller has checked the times.
    fn at_each<'py>(&self, py: Python<'py>, times: Rows<'py>, each: usize) -> States<'py> {
        let times = numbers(&times)?;
        let turn = self.starts.len() * each;
        if !times.is_empty() && times.len().checked_rem(turn).is_none_or(|rest| rest != 0) {
            return Err(bad(format!(
                "{} times for {} motions of {each} each",
                times.len(),
                self.starts.len()
            )));
        }
        self.states(py, Times::Own(times, each), times.len())
    }

    /// The horizons of each motion (n, 2), backwards and forwards, in s.
    fn horizons<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        table(py, self.motions.horizons().collect::<Vec<_>>().into_iter())
    }

    /// The horizons of all motions, in s.
    #[getter]
    fn horizon(&self) -> (f64, f64) {
        self.horizons.into()
    }

    /// Rotors (rows, 4) and angular velocities (rows, 3) at the start, as given.
    fn starts<'py>(&self, py: Python<'py>) -> States<'py> {
        let rotors = table(py, self.starts.iter().map(|start| start.0))?;
        Ok((rotors, table(py, self.starts.iter().map(|start| start.1))?))
    }

    /// The numbers of the law (rows, k), as given.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let (numbers, size) = &self.parameters;
        PyArray1::from_slice(py, numbers).reshape(vec![self.starts.len(), *size])
    }

    /// Shape of the batch.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.shape)
    }
}
