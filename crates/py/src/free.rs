//! The free top: one motion, or a batch of them, whose solutions stay in Rust.

use crate::arrays::{Array, Rows, bad, line, numbers, place, table, threads};
use crate::bodies::Inertia;
use crate::motion::{angular_velocity, check_times};
use crate::pool;
use crate::value::{Multivector, number, one, one_rotor};
use numpy::{PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor};
use polhode_rigid::free::{self, FlowDerivatives, at_each};
use polhode_rigid::inertia;
use polhode_rigid::regime::FreeDescription;
use polhode_rigid::simulate::check_horizons;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// States between looks for Ctrl-C.
const PIECE: usize = 1 << 19;

/// To set a motion up, or to find its derivatives once, takes as long as so many numbers of other kernels.
const WORK: usize = 256;

/// Free motions, a batch of some shape.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct FreeMotion {
    motions: Vec<free::FreeMotion>,
    /// Rotor and angular velocity at the start, as they were given.
    starts: Vec<([f64; 4], [f64; 3])>,
    shape: Vec<usize>,
}

fn motion(
    inertia: &inertia::Inertia,
    &(rotor, omega): &([f64; 4], [f64; 3]),
) -> Result<free::FreeMotion, String> {
    let rotor = Rotor::from_components(rotor).map_err(|error| error.to_string())?;
    free::FreeMotion::new(inertia, rotor, Bivector(omega)).map_err(|error| error.to_string())
}

/// The components of a single value, if it has just these grades.
fn components<const N: usize>(value: &Bound<'_, PyAny>, grades: Grades) -> Option<[f64; N]> {
    let value = value.cast::<Multivector>().ok()?.get().single()?;
    (value.grades() == grades).then(|| value.components().try_into().ok())?
}

/// Rows, in pieces between which Python may interrupt.
pub(crate) fn pieces<T: Clone + Default + Send>(
    py: Python<'_>,
    count: usize,
    work: impl Fn(usize) -> T + Sync,
) -> PyResult<Vec<T>> {
    let mut rows = vec![T::default(); count];
    let threads = threads(WORK.saturating_mul(count))?;
    for (part, piece) in rows.chunks_mut(PIECE / WORK * 16).enumerate() {
        let first = part * (PIECE / WORK * 16);
        py.detach(|| {
            threads.for_each_piece(32, 1, piece, |rows, piece| {
                for (row, slot) in rows.zip(piece) {
                    *slot = work(first + row);
                }
            });
        });
        py.check_signals()?;
    }
    Ok(rows)
}

#[pymethods]
impl FreeMotion {
    /// The motion of a single body from a single Rotor and a single bivector, or three floats; None if they are
    /// anything else.
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
        let motions = vec![motion(&inertia.0, &start).map_err(bad)?];
        Ok(Some(FreeMotion { motions, starts: vec![start], shape: Vec::new() }))
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
        let found = pieces(py, starts.len(), |row| {
            Some(motion(&inertias[row.min(inertias.len() - 1)], &starts[row]))
        })?;
        let motions = found.into_iter().flatten().enumerate();
        let motions = motions.map(|(row, motion)| motion.map_err(|error| at(row, bad(error))));
        Ok(FreeMotion { motions: motions.collect::<PyResult<_>>()?, starts, shape })
    }

    /// Rotor and angular velocity of a single motion at a single time; None for anything else.
    fn once<'py>(&self, t: &Bound<'py, PyAny>) -> PyResult<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
        let py = t.py();
        let (Some(t), [motion], []) = (number(t), &self.motions[..], &self.shape[..]) else {
            return Ok(None);
        };
        self.check(&[t])?;
        let (rotor, omega) = motion.at(t);
        let Some(omega) = Graded::new(&omega.0, Grades::BIVECTOR) else { return Ok(None) };
        Ok(Some((one_rotor(py, rotor)?, one(py, omega)?)))
    }

    /// Rotors and angular velocities of all motions at all times, rows motion by motion. Threads share large
    /// batches; Python may interrupt between pieces of some milliseconds.
    fn at<'py>(&self, py: Python<'py>, times: Rows<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        let times = numbers(&times)?;
        self.check(times)?;
        let count = self.motions.len() * times.len();
        let (rotors, omegas) = (pool::array(py, &[count, 4])?, pool::array(py, &[count, 3])?);
        let (mut rotor_rows, mut omega_rows) = (rotors.readwrite(), omegas.readwrite());
        let rows = rotor_rows.as_slice_mut()?.chunks_mut(4 * PIECE);
        let pieces = rows.zip(omega_rows.as_slice_mut()?.chunks_mut(3 * PIECE));
        let threads = threads(7 * count)?;
        for (part, (rotors, omegas)) in pieces.enumerate() {
            let rows = part * PIECE..part * PIECE + rotors.len() / 4;
            py.detach(|| at_each(threads, &self.motions, times, rows, rotors, omegas));
            py.check_signals()?;
        }
        drop((rotor_rows, omega_rows));
        Ok((rotors, omegas))
    }

    /// What the invariants tell, as a dict; of a batch as lists and arrays, NaN where there is nothing to tell.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let told: Vec<FreeDescription> = self.motions.iter().map(free::FreeMotion::describe).collect();
        let result = PyDict::new(py);
        if let ([one], []) = (&told[..], &self.shape[..]) {
            result.set_item("regime", one.regime.to_string())?;
            result.set_item("axis", one.axis + 1)?;
            for (name, number) in NUMBERS {
                result.set_item(name, number(one))?;
            }
            return Ok(result);
        }
        result.set_item("regime", told.iter().map(|one| one.regime.to_string()).collect::<Vec<_>>())?;
        result.set_item("axis", told.iter().map(|one| one.axis + 1).collect::<Vec<_>>())?;
        for (name, number) in NUMBERS {
            let numbers = told.iter().map(|one| number(one).unwrap_or(f64::NAN)).collect();
            result.set_item(name, line(py, numbers))?;
        }
        Ok(result)
    }

    /// Angular velocities in body axes along the polhode, so many for each motion.
    fn polhode<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Array<'py>> {
        let curves = py.detach(|| self.motions.iter().flat_map(|m| m.polhode(count)).collect::<Vec<_>>());
        table(py, curves.into_iter().map(|omega| omega.0))
    }

    /// The same in space axes, over so many periods.
    fn herpolhode<'py>(&self, py: Python<'py>, count: usize, periods: f64) -> PyResult<Array<'py>> {
        let curves = py.detach(|| {
            let curve = |m: &free::FreeMotion| m.herpolhode(count, periods);
            self.motions.iter().map(curve).collect::<Vec<_>>()
        });
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
        let mut found: Vec<FlowDerivatives> = Vec::with_capacity(self.motions.len() * times.len());
        // What a motion's derivatives have in common is large, and kept for some motions at a time.
        for bodies in self.motions.chunks(1024) {
            let common = pieces(py, bodies.len(), |row| Some(bodies[row].differentiated()))?;
            found.extend(pieces(py, bodies.len() * times.len(), |row| {
                let common = common[row / times.len()].as_ref();
                common.map_or_else(FlowDerivatives::default, |common| common.at(times[row % times.len()]))
            })?);
        }
        if let Some(row) = found.iter().position(|one| !one.is_finite()) {
            let (body, index) = (place(row / times.len(), &self.shape), row % times.len());
            return Err(bad(format!(
                "{body}the derivatives at times[{index}] = {:e} s are beyond floating point: the rotation is not \
                 stable, and a small change of its start has grown too much; take times nearer to 0",
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

    /// Rotors (rows, 4) and angular velocities (rows, 3) at the start, as they were given.
    fn starts<'py>(&self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        let rotors = table(py, self.starts.iter().map(|start| start.0))?;
        Ok((rotors, table(py, self.starts.iter().map(|start| start.1))?))
    }

    /// Shape of the batch.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.shape)
    }
}

/// What a description tells in numbers.
type Number = (&'static str, fn(&FreeDescription) -> Option<f64>);
const NUMBERS: [Number; 12] = [
    ("modulus", |d| Some(d.modulus)),
    ("energy", |d| Some(d.energy)),
    ("angular_momentum", |d| Some(d.angular_momentum)),
    ("period", |d| d.period),
    ("precession_rate", |d| d.precession_rate),
    ("precession_period", FreeDescription::precession_period),
    ("phase_per_period", FreeDescription::phase_per_period),
    ("solid_angle", |d| d.solid_angle),
    ("flip_time", FreeDescription::flip_time),
    ("wobble_min", |d| d.wobble.map(|[least, _]| least)),
    ("wobble_max", |d| d.wobble.map(|[_, most]| most)),
    ("wobble_period", |d| d.wobble_period),
];

/// A matrix row by row.
pub(crate) fn flat<const N: usize, const ALL: usize>(rows: &[[f64; 3]; N]) -> [f64; ALL] {
    std::array::from_fn(|k| rows[k / 3][k % 3])
}

impl FreeMotion {
    /// Times must be finite, and within the horizon of every motion.
    fn check(&self, times: &[f64]) -> PyResult<()> {
        check_times(times)?;
        let furthest = times.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
        let Some(row) = self.motions.iter().position(|motion| furthest > motion.horizon()) else {
            return Ok(());
        };
        let place = place(row, &self.shape);
        check_horizons(times, [self.motions[row].horizon(); 2])
            .map_err(|error| bad(format!("{place}{error}")))
    }
}
