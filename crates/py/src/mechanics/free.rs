//! Free motion of one body or a batch, with solutions kept in Rust.

use super::bodies::Inertia;
use super::closed_forms::{States, angular_velocity, check_times, filled};
use crate::algebra::value::{Multivector, number, one, one_rotor};
use crate::support::arrays::{Array, Rows, bad, line, numbers, place, table, threads};
use crate::support::facts::{columns, dict};
use numpy::{PyReadonlyArray1, PyUntypedArrayMethods};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor};
use polhode_rigid::body::inertia;
use polhode_rigid::exact::free::{self, FlowDerivatives, TILE, Tile, Times, at_each};
use polhode_rigid::exact::regime::FreeDescription;
use polhode_rigid::state::checks::check_horizons;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// States between checks for Ctrl-C.
const PIECE: usize = 1 << 19;

/// Cost of setting up a motion, or of its derivatives at one time, in states.
const WORK: usize = 256;

/// Free motions, a batch of some shape.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct FreeMotion {
    motions: Motions,
    /// One for all, or one for each.
    inertias: Vec<inertia::Inertia>,
    /// Rotor and angular velocity at the start, as given.
    starts: Vec<Start>,
    shape: Vec<usize>,
    /// The horizon of all motions, in s.
    horizon: f64,
}

type Start = ([f64; 4], [f64; 3]);

enum Motions {
    One(Box<free::FreeMotion>),
    /// Data for states; other results set a motion up again.
    Many(Vec<Tile>),
}

fn motion(inertia: &inertia::Inertia, &(rotor, omega): &Start) -> Result<free::FreeMotion, String> {
    let rotor = Rotor::from_components(rotor).map_err(|error| error.to_string())?;
    free::FreeMotion::new(inertia, rotor, Bivector(omega)).map_err(|error| error.to_string())
}

/// The components of a single value, if it has just these grades.
pub(crate) fn components<const N: usize>(value: &Bound<'_, PyAny>, grades: Grades) -> Option<[f64; N]> {
    let value = value.cast::<Multivector>().ok()?.get().single()?;
    (value.grades() == grades).then(|| value.components().try_into().ok())?
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

#[pymethods]
impl FreeMotion {
    /// The motion of a single body from a single Rotor and a single bivector, or three floats; None for other
    /// types.
    #[staticmethod]
    fn single(
        inertia: &Inertia,
        rotor: &Bound<'_, PyAny>,
        omega: &Bound<'_, PyAny>,
    ) -> PyResult<Option<FreeMotion>> {
        let is_rotor = rotor.cast::<Multivector>().is_ok_and(|value| value.get().unit);
        let Some(rotor) = components(rotor, Grades::EVEN).filter(|_| is_rotor) else { return Ok(None) };
        let omega = match omega.extract::<PyReadonlyArray1<'_, f64>>() {
            Ok(array) => array.as_array().to_vec().try_into().ok(),
            Err(_) => components(omega, Grades::BIVECTOR),
        };
        let Some(omega) = omega else { return Ok(None) };
        let start = (rotor, angular_velocity(omega)?.0);
        let motions = Motions::One(Box::new(motion(&inertia.0, &start).map_err(bad)?));
        Ok(Some(FreeMotion::new(motions, vec![inertia.0], vec![start], Vec::new())))
    }

    /// Motions of a batch from one inertia, or one for each; rotors (…, 4) and angular velocities (…, 3).
    #[staticmethod]
    fn batch(
        py: Python<'_>,
        inertias: Vec<PyRef<'_, Inertia>>,
        rotors: Rows<'_>,
        omegas: Rows<'_>,
    ) -> PyResult<FreeMotion> {
        let shape = rotors.shape().split_last().map_or(&[][..], |(_, batch)| batch).to_vec();
        let rows = numbers(&rotors)?.as_chunks::<4>().0.iter().zip(numbers(&omegas)?.as_chunks::<3>().0);
        let starts: Vec<_> = rows.map(|(rotor, omega)| (*rotor, *omega)).collect();
        let inertias: Vec<inertia::Inertia> = inertias.iter().map(|inertia| inertia.0).collect();
        if inertias.len() != 1 && inertias.len() != starts.len() {
            return Err(bad(format!("{} inertias for {} motions", inertias.len(), starts.len())));
        }
        let at = |row: usize, error: PyErr| bad(format!("{}{}", place(row, &shape), error.value(py)));
        for (row, (_, omega)) in starts.iter().enumerate() {
            angular_velocity(*omega).map_err(|error| at(row, error))?;
        }
        let new = |row: usize| motion(&inertias[row.min(inertias.len() - 1)], &starts[row]);
        let motions = if shape.is_empty() {
            Motions::One(Box::new(new(0).map_err(bad)?))
        } else {
            let tiles = pieces(py, starts.len().div_ceil(TILE), TILE, |tile| {
                Tile::new((tile * TILE..starts.len()).map(new)).map_err(|(place, e)| (tile * TILE + place, e))
            })?;
            let tiles = tiles.into_iter().map(|tile| tile.map_err(|(row, error)| at(row, bad(error))));
            Motions::Many(tiles.collect::<PyResult<_>>()?)
        };
        Ok(FreeMotion::new(motions, inertias, starts, shape))
    }

    /// Rotor and angular velocity of a single motion at a single time; None for anything else.
    fn once<'py>(&self, t: &Bound<'py, PyAny>) -> PyResult<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
        let py = t.py();
        let (Some(t), Motions::One(motion)) = (number(t), &self.motions) else { return Ok(None) };
        self.check(&[t])?;
        let (rotor, omega) = motion.at(t);
        let Some(omega) = Graded::new(&omega.0, Grades::BIVECTOR) else { return Ok(None) };
        Ok(Some((one_rotor(py, rotor)?, one(py, omega)?)))
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

    /// The horizon of each motion, in s.
    fn horizons<'py>(&self, py: Python<'py>) -> Array<'py> {
        line(py, self.motions.horizons().collect())
    }

    /// The horizon of all motions, in s.
    #[getter]
    fn horizon(&self) -> f64 {
        self.horizon
    }

    /// The description as a dict; for a batch with lists and arrays, NaN for None.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = pieces(py, self.starts.len(), 1, |row| self.motion(row).map(|motion| motion.describe()))?;
        let rows: Vec<FreeDescription> = rows.into_iter().collect::<Result<_, _>>().map_err(bad)?;
        if let ([one], []) = (&rows[..], &self.shape[..]) {
            return dict(py, one.facts());
        }
        let sphere = inertia::Inertia::from_principal_moments([1.0; 3]).map_err(bad)?;
        let at_rest = free::FreeMotion::new(&sphere, Rotor::IDENTITY, Bivector::default()).map_err(bad)?;
        columns(py, at_rest.describe().facts(), rows.iter().map(FreeDescription::facts))
    }

    /// Angular velocities in body axes along the polhode, n for each motion.
    fn polhode<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Array<'py>> {
        let curves = pieces(py, self.starts.len(), 1, |row| self.motion(row).map(|m| m.polhode(count)))?;
        let curves: Vec<_> = curves.into_iter().collect::<Result<_, _>>().map_err(bad)?;
        let all: Vec<Bivector> = curves.into_iter().flatten().collect();
        table(py, all.into_iter().map(|omega| omega.0))
    }

    /// The same in space axes, over a number of periods.
    fn herpolhode<'py>(&self, py: Python<'py>, count: usize, periods: f64) -> PyResult<Array<'py>> {
        let curves = pieces(py, self.starts.len(), 1, |row| {
            self.motion(row)?.herpolhode(count, periods).map_err(|error| error.to_string())
        })?;
        let mut all = Vec::with_capacity(count * curves.len());
        for (row, curve) in curves.into_iter().enumerate() {
            all.extend(curve.map_err(|error| bad(format!("{}{error}", place(row, &self.shape))))?);
        }
        table(py, all.into_iter().map(|omega| omega.0))
    }

    /// Derivatives of all motions at all times, rows motion by motion: of the rotor by attitude, angular velocity
    /// and moments (rows, 12) and by time (rows, 4), of the angular velocity by itself and the moments (rows, 9)
    /// and by time (rows, 3).
    #[allow(clippy::type_complexity)]
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        times: Rows<'py>,
    ) -> PyResult<(Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>)> {
        let times = numbers(&times)?;
        self.check(times)?;
        let mut found: Vec<FlowDerivatives> = Vec::with_capacity(self.starts.len() * times.len());
        // Data shared by the derivatives of a motion is large, so motions are processed in groups.
        for first in (0..self.starts.len()).step_by(TILE) {
            let count = TILE.min(self.starts.len() - first);
            let common = pieces(py, count, 1, |row| self.motion(first + row).map(|m| m.differentiated()))?;
            let common: Vec<_> = common.into_iter().collect::<Result<_, _>>().map_err(bad)?;
            found.extend(pieces(py, count * times.len(), 1, |row| {
                common[row / times.len()].at(times[row % times.len()])
            })?);
        }
        if let Some(row) = found.iter().position(|one| !one.is_finite()) {
            let (body, index) = (place(row / times.len(), &self.shape), row % times.len());
            return Err(bad(format!(
                "{body}the derivatives at times[{index}] = {:e} s overflow, because the rotation is \
                 unstable; use times closer to 0",
                times[index]
            )));
        }
        Ok((
            table(py, found.iter().map(|one| flat::<4, 12>(&one.rotor_by_attitude)))?,
            table(py, found.iter().map(|one| flat::<4, 12>(&one.rotor_by_omega)))?,
            table(py, found.iter().map(|one| flat::<4, 12>(&one.rotor_by_moments)))?,
            table(py, found.iter().map(|one| one.rotor_by_time))?,
            table(py, found.iter().map(|one| flat::<3, 9>(&one.omega_by_omega)))?,
            table(py, found.iter().map(|one| flat::<3, 9>(&one.omega_by_moments)))?,
            table(py, found.iter().map(|one| one.omega_by_time))?,
        ))
    }

    /// Rotors (rows, 4) and angular velocities (rows, 3) at the start, as given.
    fn starts<'py>(&self, py: Python<'py>) -> States<'py> {
        let rotors = table(py, self.starts.iter().map(|start| start.0))?;
        Ok((rotors, table(py, self.starts.iter().map(|start| start.1))?))
    }

    /// Shape of the batch.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.shape)
    }
}

/// A matrix row by row.
pub(crate) fn flat<const N: usize, const ALL: usize>(rows: &[[f64; 3]; N]) -> [f64; ALL] {
    std::array::from_fn(|k| rows[k / 3][k % 3])
}

impl Motions {
    fn horizons(&self) -> impl Iterator<Item = f64> {
        let (one, many) = match self {
            Motions::One(motion) => (Some(motion.horizon()), &[][..]),
            Motions::Many(tiles) => (None, &tiles[..]),
        };
        one.into_iter().chain(many.iter().flat_map(Tile::horizons).copied())
    }
}

impl FreeMotion {
    fn new(
        motions: Motions,
        inertias: Vec<inertia::Inertia>,
        starts: Vec<Start>,
        shape: Vec<usize>,
    ) -> FreeMotion {
        let horizon = motions.horizons().fold(f64::INFINITY, f64::min);
        FreeMotion { motions, inertias, starts, shape, horizon }
    }

    /// One of the motions, which was set up successfully before.
    fn motion(&self, row: usize) -> Result<free::FreeMotion, String> {
        match &self.motions {
            Motions::One(motion) => Ok(**motion),
            Motions::Many(_) => motion(&self.inertias[row.min(self.inertias.len() - 1)], &self.starts[row]),
        }
    }

    /// Checks that times are finite and within the horizon of every motion.
    fn check(&self, times: &[f64]) -> PyResult<()> {
        check_times(times)?;
        let furthest = times.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
        if furthest <= self.horizon {
            return Ok(());
        }
        match self.motions.horizons().enumerate().find(|(_, horizon)| furthest > *horizon) {
            Some((row, horizon)) => check_horizons(0.0, times, [horizon; 2])
                .map_err(|error| bad(format!("{}{error}", place(row, &self.shape)))),
            None => Ok(()),
        }
    }

    /// Computes states. Threads share large batches; Python may interrupt every few milliseconds.
    fn states<'py>(&self, py: Python<'py>, times: Times<'_>, count: usize) -> States<'py> {
        let threads = threads(7 * count)?;
        filled(py, count, PIECE, |rows, rotors, omegas| match (&self.motions, times) {
            (Motions::Many(tiles), _) => at_each(threads, tiles, times, rows, rotors, omegas),
            (Motions::One(motion), Times::Common(times) | Times::Own(times, _)) => {
                motion.at_many(threads, &times[rows], rotors, omegas);
            }
        })
    }
}
