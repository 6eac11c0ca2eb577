//! Torque laws by name and arguments, and the torque at a state.

use super::bodies::{Inertia, rotor};
use super::columns::{Arguments, Laws};
use super::law_value::{
    Callback, LawValue, Raised, Values, bivector, bivector_of, failed, rotor_of, vector, vector_of,
};
use crate::support::arrays::{Array, Rows, bad, line, numbers, one, table};
use crate::support::facts::dict;
use polhode_ga::{Bivector, Vector};
use polhode_rigid::body::weight_moment;
use polhode_rigid::describe::law_facts;
use polhode_rigid::laws::formula::Purpose;
use polhode_rigid::laws::registry::{Entry, Kernel, torque};
use polhode_rigid::laws::torque::{
    Axes, KeplerOrbit, Kind, Orbit, Table, Torque, Wheel, Wheels, dipole_field, on_orbit, total, wheel,
};
use polhode_rigid::state::center::Center;
use polhode_rigid::state::phase::{Gyrostat, Phase};
use polhode_rigid::state::point::{Function, Point, Seen};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::convert::Infallible;
use std::sync::Arc;

/// A torque law.
#[pyclass(frozen, extends = LawValue, module = "polhode._native")]
pub(crate) struct Law(pub(crate) Laws<Torque>);

impl Law {
    /// Wraps a law with its name and arguments.
    pub(crate) fn named(
        py: Python<'_>,
        torque: Torque,
        name: &str,
        arguments: Bound<'_, PyTuple>,
    ) -> PyResult<Py<Law>> {
        let value = LawValue::new(name.to_owned(), arguments, Raised::default());
        let law = Law(Laws { rows: vec![torque], shape: Vec::new() });
        Py::new(py, PyClassInitializer::from(value).add_subclass(law))
    }
}

#[pymethods]
impl Law {
    /// A law by its name in `polhode.torque` and arguments checked and converted by that module.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<PyClassInitializer<Law>> {
        let raised = Raised::default();
        let law = Law(laws(&name, &arguments, &raised)?);
        Ok(PyClassInitializer::from(LawValue::new(name, arguments, raised)).add_subclass(law))
    }

    /// The moments of the weight, rows (n, 3) in body axes, of a weight; None for other laws.
    fn weight_moments<'py>(&self, py: Python<'py>) -> PyResult<Option<Array<'py>>> {
        let moments: Option<Vec<[f64; 3]>> = self
            .0
            .rows
            .iter()
            .map(|torque| if let Torque::Heavy(c) = torque { Some(c.0) } else { None })
            .collect();
        moments.map(|rows| table(py, rows.into_iter())).transpose()
    }

    /// The momenta (n, k) of wheels about their axes at times (n,), and their speeds relative to the body at angular
    /// velocities (n, 3); None for other laws.
    fn wheels<'py>(
        &self,
        py: Python<'py>,
        times: Rows<'py>,
        omegas: Rows<'py>,
    ) -> PyResult<Option<[Array<'py>; 2]>> {
        let [Torque::Wheels(wheels)] = &self.0.rows[..] else { return Ok(None) };
        let (times, omegas) = (numbers(&times)?, numbers(&omegas)?.as_chunks::<3>().0);
        let momenta = times.iter().flat_map(|&time| wheels.momenta(time)).collect();
        let each = times.iter().zip(omegas);
        let speeds = each.flat_map(|(&time, omega)| wheels.speeds(time, Bivector(*omega))).collect();
        Ok(Some([line(py, momenta), line(py, speeds)]))
    }

    /// Its name in scenes and its formula or numbers as text, for a single body.
    fn facts<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let torque = slf.get().0.single()?;
        let name = match torque {
            Torque::Formula(law) if law.axes() == Axes::Space => "torque_space",
            Torque::Formula(_) => "torque_body",
            _ => slf.as_super().get().name(),
        };
        dict(slf.py(), law_facts(name, torque, None))
    }

    /// Shape of the batch of bodies; () for one.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.0.shape)
    }
}

/// The torque of all laws in body axes, at a state and a time; `translation` has position and velocity, and the mass.
#[pyfunction]
pub(crate) fn torque_at<'py>(
    py: Python<'py>,
    laws: Vec<Bound<'py, Law>>,
    inertia: &Inertia,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    translation: (Rows<'py>, f64),
    time: f64,
) -> PyResult<Array<'py>> {
    let frame = inertia.0.principal_frame();
    let torques: Vec<Torque> =
        laws.iter().map(|law| Ok(law.get().0.single()?.clone().in_axes(frame))).collect::<PyResult<_>>()?;
    let body = Gyrostat { moments: inertia.0.principal_moments(), wheel: wheel(&torques) };
    if body.moments.contains(&0.0) {
        let [a, b, c] = body.moments;
        return Err(bad(format!(
            "principal moments {a}, {b}, {c} kg m² include a zero; give the body some thickness"
        )));
    }
    let omega = frame.reverse().apply_bivector(Bivector(one(&omega)?));
    let state = Phase { rotor: rotor(&rotor_row)? * frame, momentum: body.momentum(omega), time };
    let (center, mass) = translation;
    let center = Center::from(one(&center)?);
    let torque = total(&torques, &Point { body: &body, mass, phase: &state, center: &center })
        .map_err(|error| failed(laws.iter().map(Bound::as_super), format!("at t = {time} s: {error}")))?;
    Ok(line(py, frame.apply_bivector(torque).0.to_vec()))
}

/// The direction from planet to body on an orbit, rows (n, 3) at times (n,).
#[pyfunction]
pub(crate) fn orbit_directions<'py>(
    py: Python<'py>,
    rate: f64,
    eccentricity: f64,
    anomaly: f64,
    times: Rows<'py>,
) -> PyResult<Array<'py>> {
    let orbit = Orbit::new(rate, eccentricity, anomaly).map_err(bad)?;
    table(py, numbers(&times)?.iter().map(|&time| orbit.place(time).0.0))
}

/// The laws of this name and these arguments.
fn laws(name: &str, arguments: &Bound<'_, PyTuple>, raised: &Raised) -> PyResult<Laws<Torque>> {
    let values: Values<'_> = if name == "formula" { arguments.get_item(2)?.extract()? } else { Vec::new() };
    let given = Arguments::new(arguments, &values)?;
    let rows = match (name, torque(name)) {
        ("gravity", _) => gravity(&given)?,
        ("magnetic_on_orbit", _) => vec![magnetic_on_orbit(arguments, raised)?],
        ("reaction_wheels", _) => vec![reaction_wheels(arguments)?],
        ("formula", _) => formulas(&given, values)?,
        ("function", _) => {
            let (call, center) = arguments.extract()?;
            vec![function(call, center, raised)]
        }
        (_, Some(Entry { kernel: Kernel::Table, .. })) => vec![tabulated(arguments)?],
        (_, Some(entry)) => given.registered(entry, |numbers| entry.build(numbers))?,
        _ => return Err(bad(format!("{name} is not a torque law"))),
    };
    Ok(Laws { rows, shape: given.shape })
}

/// The weight of bodies: acceleration, mass, centre of mass and pivot.
fn gravity(given: &Arguments<'_, '_>) -> PyResult<Vec<Torque>> {
    let (acceleration, mass) = (given.column(0, 1)?, given.column(1, 1)?);
    let (center, pivot) = (given.column(2, 3)?, given.column(3, 3)?);
    given.each(|k| {
        let arm = center.vector(k) - pivot.vector(k);
        Ok::<_, Infallible>(Torque::Heavy(weight_moment(mass.of(k)[0], acceleration.of(k)[0], arm)))
    })
}

fn tabulated(arguments: &Bound<'_, PyTuple>) -> PyResult<Torque> {
    let (times, rows, frame, kind): (_, Vec<[f64; 3]>, String, String) = arguments.extract()?;
    let kind = Kind::from_name(&kind).unwrap_or(Kind::Linear);
    let rows = rows.into_iter().map(Bivector).collect();
    Table::new(times, rows, axes(&frame), kind).map(|table| Torque::Tabulated(Arc::new(table))).map_err(bad)
}

/// Wheels by their axes, moments, limits of torque and of speed, and speeds relative to an angular velocity of the body,
/// with times and rows of commands.
fn reaction_wheels(arguments: &Bound<'_, PyTuple>) -> PyResult<Torque> {
    type Given = (Vec<[f64; 3]>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>, [f64; 3], Vec<f64>, Vec<Vec<f64>>);
    let (axes, inertias, max_torques, max_speeds, speeds, omega, times, rows): Given = arguments.extract()?;
    let wheel = |k: usize| Wheel {
        axis: Vector(axes[k]) / Vector(axes[k]).norm(),
        inertia: inertias[k],
        max_torque: max_torques[k],
        max_speed: max_speeds[k],
    };
    let wheels = (0..axes.len()).map(wheel).collect();
    let wheels = Wheels::new(wheels, &speeds, Bivector(omega), &times, &rows);
    wheels.map(|wheels| Torque::Wheels(Arc::new(wheels))).map_err(bad)
}

/// A dipole of the body in a field along an orbit: the dipole, the orbit, and either the moment of a dipole at its focus
/// or a function of time and position.
fn magnetic_on_orbit(arguments: &Bound<'_, PyTuple>, raised: &Raised) -> PyResult<Torque> {
    type Given<'py> = ([f64; 3], (f64, f64, f64, f64), Bound<'py, PyAny>);
    let (dipole, orbit, field): Given<'_> = arguments.extract()?;
    let (orbit, dipole) = (orbit_of(orbit)?, Vector(dipole));
    if let Ok(moment) = field.extract::<[f64; 3]>() {
        let field = move |_: f64, place: Vector| Ok(dipole_field(Vector(moment), place));
        return Ok(Torque::Function(on_orbit(dipole, orbit, field)));
    }
    let callback = Callback { call: field.unbind(), raised: raised.clone(), what: "field" };
    Ok(Torque::Function(on_orbit(dipole, orbit, move |time, place| {
        callback.at(time, |py| (time, vector_of(py, place)?).into_pyobject(py), vector)
    })))
}

/// An orbit from its semi-major axis, eccentricity, mean anomaly and gravitational parameter.
fn orbit_of((axis, eccentricity, anomaly, mu): (f64, f64, f64, f64)) -> PyResult<KeplerOrbit> {
    KeplerOrbit::new(axis, eccentricity, anomaly, mu).map_err(bad)
}

/// The mean motion of an orbit in rad/s, and its positions, rows (n, 3), at times (n,).
#[pyfunction]
pub(crate) fn orbit_positions<'py>(
    py: Python<'py>,
    orbit: (f64, f64, f64, f64),
    times: Rows<'py>,
) -> PyResult<(f64, Array<'py>)> {
    let orbit = orbit_of(orbit)?;
    let places = table(py, numbers(&times)?.iter().map(|&time| orbit.position(time).0))?;
    Ok((orbit.rate(), places))
}

/// The field of a dipole, rows (n, 3) in T, at positions (n, 3).
#[pyfunction]
pub(crate) fn dipole_fields<'py>(
    py: Python<'py>,
    moment: Rows<'py>,
    places: Rows<'py>,
) -> PyResult<Array<'py>> {
    let moment = Vector(one(&moment)?);
    table(py, numbers(&places)?.as_chunks::<3>().0.iter().map(|place| dipole_field(moment, Vector(*place)).0))
}

fn function(call: Py<PyAny>, center: bool, raised: &Raised) -> Torque {
    let callback = Callback { call, raised: raised.clone(), what: "torque" };
    let law =
        Function::new(move |seen| callback.at(seen.time, |py| arguments_at(py, seen, center), bivector));
    Torque::Function(law.reading_center(center))
}

/// The arguments of a function at a point, with those of the centre of mass or without.
fn arguments_at<'py>(py: Python<'py>, seen: &Seen, center: bool) -> PyResult<Bound<'py, PyTuple>> {
    let (rotor, omega) = (rotor_of(py, seen.rotor)?, bivector_of(py, seen.omega)?);
    if !center {
        return (seen.time, rotor, omega).into_pyobject(py);
    }
    let (position, velocity) = (vector_of(py, seen.position)?, vector_of(py, seen.velocity)?);
    (seen.time, rotor, omega, position, velocity).into_pyobject(py)
}

fn formulas<'py>(given: &Arguments<'_, 'py>, values: Values<'py>) -> PyResult<Vec<Torque>> {
    let (text, frame): (String, String) = given.all.get_slice(0, 2).extract()?;
    let formulas = given.formulas(&text, Purpose::Torque(axes(&frame)), values)?;
    Ok(formulas.into_iter().map(Torque::Formula).collect())
}

fn axes(frame: &str) -> Axes {
    if frame == "space" { Axes::Space } else { Axes::Body }
}
