//! Drawn bodies of a scene's ensemble, as Python objects.

use super::named;
use crate::mechanics::bodies::Inertia;
use crate::support::arrays::{Array, bad, line, table};
use numpy::{PyArray1, PyArrayMethods};
use polhode_rigid::ensemble::Ensemble;
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::scene;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A varied quantity: name, distribution, widths, and their unit.
pub(crate) type Varied = (String, &'static str, Vec<f64>, &'static str);

/// Rotors (n, 4), angular velocities in the body (n, 3), places and velocities (n, 3) each, inertias (one or n) and
/// laws.
pub(crate) type Bodies<'py> =
    (Array<'py>, Array<'py>, Array<'py>, Array<'py>, Vec<Inertia>, Vec<Bound<'py, PyAny>>);

/// Form and number of points, and the paths of their values with the number of each.
pub(crate) type Points = (&'static str, usize, Vec<(String, usize)>);

/// A path, and its values as an array or as texts, with their unit.
pub(crate) type PointValues<'py> = (String, Bound<'py, PyAny>, &'static str);

pub(crate) fn varied(varied: scene::Varied) -> Varied {
    match varied.spread {
        None => (varied.name, "alike", Vec::new(), ""),
        Some(spread) => {
            let form = match (spread.form, varied.correlated) {
                (scene::Form::Relative, true) => "correlated relative",
                (_, true) => "correlated normal",
                (form, false) => form.name(),
            };
            (varied.name, form, spread.widths.to_vec(), varied.unit)
        }
    }
}

/// The values of a path at some points.
pub(crate) fn given<'py>(py: Python<'py>, path: String, values: scene::Given) -> PyResult<PointValues<'py>> {
    match values {
        scene::Given::Texts(texts) => Ok((path, texts.into_pyobject(py)?.into_any(), "")),
        scene::Given::Numbers(numbers, 1, unit) => Ok((path, line(py, numbers).into_any(), unit)),
        scene::Given::Numbers(numbers, size, unit) => {
            let shape = [numbers.len() / size, size];
            Ok((path, PyArray1::from_vec(py, numbers).reshape(shape)?.into_any(), unit))
        }
    }
}

/// The bodies, with the first `laws` of their laws.
pub(crate) fn bodies<'py>(py: Python<'py>, drawn: &Ensemble, laws: usize) -> PyResult<Bodies<'py>> {
    let starts = drawn.starts.iter();
    Ok((
        table(py, starts.clone().map(|start| start.rotor.components()))?,
        table(py, starts.clone().map(|start| start.omega.0))?,
        table(py, starts.clone().map(|start| start.center.position.0))?,
        table(py, starts.map(|start| start.center.velocity.0))?,
        inertias(drawn),
        drawn.laws.iter().take(laws).map(|law| one_or_columns(py, law.all())).collect::<PyResult<_>>()?,
    ))
}

/// The inertias, one for all or one for each body.
pub(crate) fn inertias(drawn: &Ensemble) -> Vec<Inertia> {
    drawn.inertias.all().iter().map(|inertia| Inertia(*inertia)).collect()
}

/// A law that all bodies share, or the name and the arguments of a law that varies: arrays (n,) or (n, m), or for a
/// formula the law of each body.
fn one_or_columns<'py>(py: Python<'py>, torques: &[Torque]) -> PyResult<Bound<'py, PyAny>> {
    if let [torque] = torques {
        return Ok(named(py, torque.clone())?.into_bound(py).into_any());
    }
    if let Some(Torque::Formula(_)) = torques.first() {
        // Formulas whose names have other values: the law of each body.
        let laws: Vec<_> = torques.iter().map(|law| named(py, law.clone())).collect::<PyResult<_>>()?;
        return Ok(("formula", PyTuple::new(py, laws)?).into_pyobject(py)?.into_any());
    }
    let own: Vec<_> = torques.iter().filter_map(Torque::registered).collect();
    let Some(&(entry, _)) = own.first() else { return Err(bad("a law without numbers cannot vary")) };
    let mut first = 0;
    let columns = entry.arguments.iter().map(|argument| {
        let size = argument.shape.size();
        let numbers: Vec<f64> =
            own.iter().flat_map(|(_, numbers)| &numbers[first..first + size]).copied().collect();
        first += size;
        match size {
            1 => Ok(line(py, numbers)),
            _ => PyArray1::from_vec(py, numbers).reshape(vec![own.len(), size]),
        }
    });
    let columns: Vec<Array<'_>> = columns.collect::<PyResult<_>>()?;
    Ok((entry.name, PyTuple::new(py, columns)?).into_pyobject(py)?.into_any())
}
