//! Drawn bodies of a scene's ensemble, as Python objects.

use super::named;
use crate::mechanics::bodies::Inertia;
use crate::support::arrays::{Array, bad, line, table};
use numpy::{PyArray1, PyArrayMethods};
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::scene::{self, Drawn};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A varied quantity: name, distribution, widths, and their unit.
pub(crate) type Varied = (String, &'static str, Vec<f64>, &'static str);

/// Rotors (n, 4), angular velocities in the body (n, 3), places and velocities (n, 3) each, inertias (one or n) and
/// laws.
pub(crate) type Bodies<'py> =
    (Array<'py>, Array<'py>, Array<'py>, Array<'py>, Vec<Inertia>, Vec<Bound<'py, PyAny>>);

pub(crate) fn varied(varied: scene::Varied) -> Varied {
    match varied.spread {
        None => (varied.name, "alike", Vec::new(), ""),
        Some(spread) => (varied.name, spread.form.name(), spread.widths.to_vec(), varied.unit),
    }
}

pub(crate) fn bodies(py: Python<'_>, drawn: Drawn) -> PyResult<Bodies<'_>> {
    let half = |k| drawn.centers.iter().map(move |c: &[f64; 6]| [c[k], c[k + 1], c[k + 2]]);
    Ok((
        table(py, drawn.rotors.iter().copied())?,
        table(py, drawn.omegas.iter().copied())?,
        table(py, half(0))?,
        table(py, half(3))?,
        drawn.inertias.into_iter().map(Inertia).collect(),
        drawn.laws.iter().map(|torques| law(py, torques)).collect::<PyResult<_>>()?,
    ))
}

/// A law that all bodies share, or the name and the arguments, arrays (n,) or (n, m), of a law that varies.
fn law<'py>(py: Python<'py>, torques: &[Torque]) -> PyResult<Bound<'py, PyAny>> {
    if let [torque] = torques {
        return Ok(named(py, torque.clone())?.into_bound(py).into_any());
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
