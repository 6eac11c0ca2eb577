//! The bodies of a scene's ensemble.

use super::named;
use crate::mechanics::bodies::Inertia;
use crate::support::arrays::{Array, bad, line, table};
use numpy::{PyArray1, PyArrayMethods};
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::{body, scene};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// The bodies of the ensemble of a scene.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Draws {
    scene: scene::Scene,
    ensemble: scene::Ensemble,
    body: body::Body,
    laws: Vec<scene::Law>,
}

impl Draws {
    /// Of a scene with its body and laws; `None` without an ensemble.
    pub(crate) fn of(
        py: Python<'_>,
        scene: scene::Scene,
        body: body::Body,
        laws: Vec<scene::Law>,
    ) -> PyResult<Option<Py<Draws>>> {
        let Some(ensemble) = scene.ensemble.clone() else { return Ok(None) };
        Py::new(py, Draws { scene, ensemble, body, laws }).map(Some)
    }
}

/// A random parameter: its name, distribution, widths and their unit.
type Varied = (String, &'static str, Vec<f64>, &'static str);

/// Rotors (n, 4), angular velocities in body axes (n, 3), positions and velocities (n, 3), inertias (one or n) and laws.
type Bodies<'py> = (Array<'py>, Array<'py>, Array<'py>, Array<'py>, Vec<Inertia>, Vec<Bound<'py, PyAny>>);

#[pymethods]
impl Draws {
    fn number(&self) -> usize {
        self.ensemble.number
    }

    fn seed(&self) -> u64 {
        self.ensemble.seed
    }

    /// The initial time in s.
    fn time(&self) -> f64 {
        self.scene.time
    }

    fn varied(&self) -> Vec<Varied> {
        let row = |varied: scene::Varied| match varied.spread {
            None => (varied.name, "alike", Vec::new(), ""),
            Some(spread) => (varied.name, spread.form.name(), spread.widths.to_vec(), varied.unit),
        };
        self.ensemble.varied().into_iter().map(row).collect()
    }

    /// At least one body, from index `first` on.
    fn draw<'py>(&self, py: Python<'py>, first: usize, count: usize) -> PyResult<Bodies<'py>> {
        let number = self.ensemble.number;
        let end = first.checked_add(count).filter(|end| (first + 1..=number).contains(end));
        let Some(end) = end else {
            let end = first.saturating_add(count);
            return Err(bad(format!("range {first}..{end} is out of bounds for {number} bodies")));
        };
        let drawn = py.detach(|| self.ensemble.draw(&self.scene, (&self.body, &self.laws), first..end));
        let drawn = drawn.map_err(bad)?;
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
}

/// A law that all bodies share, or the name of one that differs from body to body and its arguments, as arrays (n,)
/// or (n, m).
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
