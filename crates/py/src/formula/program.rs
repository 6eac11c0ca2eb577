//! Programs of formulas in Python: inputs, evaluation on arrays, and steps for interpreters.

use super::magnitude::PyMagnitude;
use crate::support::arrays::{Rows, RowsToFill, bad, numbers, numbers_to_fill, place, threads};
use crate::support::interrupts::in_pieces;
use crate::support::python_objects::FORMULA_ERROR;
use crate::support::text::byte;
use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use polhode_ga::Graded;
use polhode_ga::formula::{self, Given, InputKind, Op, RowError, RowRunner, Runner, Span, Type, term_size};
use polhode_ga::rows::product::Element;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::G3;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

/// A range of text in characters.
pub(crate) type Place = (usize, usize);

/// A formula compiled for values of known types.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Program {
    pub(crate) program: formula::Program,
    /// For each input, its index among the values given.
    pub(crate) order: Vec<usize>,
    pub(crate) text: String,
    /// In 3-d space.
    pub(crate) runner: Option<Runner>,
    /// In other algebras, if it has no functions.
    pub(crate) rows: Option<RowRunner>,
}

/// Work that is done at once, without a check for signals, as weights of rows.
const FEW: usize = 1 << 14;

/// Work before the first check for signals, as weights of rows: a millisecond.
const PIECE: usize = 1 << 22;

/// An operation: name, operands, constant or input, grades of the value as bits, whether it is a rotor, and its place in
/// the text.
type Step<'py> = (&'static str, Bound<'py, PyTuple>, Bound<'py, PyAny>, u16, bool, Place);

#[pymethods]
impl Program {
    /// For each input its index among the values given, `value`, `matrix` or `determinant`, and the grade.
    #[getter]
    fn inputs(&self) -> Vec<(usize, &'static str, u16)> {
        let kind = |kind| match kind {
            InputKind::Value(ty) => ("value", ty.grades.0),
            InputKind::Matrix { grade } => ("matrix", grade.into()),
            InputKind::Determinant => ("determinant", 3),
        };
        let named = self.order.iter().zip(&self.program.inputs).map(|(i, input)| (i, kind(input.kind)));
        named.map(|(&i, (kind, grade))| (i, kind, grade)).collect()
    }

    /// The names of the inputs.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.program.inputs.iter().map(|input| input.name.as_str()).collect()
    }

    /// The numbers of the steps that are the value, or the sides of an equation.
    #[getter]
    fn results(&self) -> Vec<Vec<usize>> {
        self.program.results.clone()
    }

    /// The grades of the value as bits, its number of components, and whether it is a rotor; None for what `run` does not
    /// evaluate: an equation, and functions in other algebras than 3-d space.
    #[getter]
    fn value_type(&self) -> Option<(u16, usize, bool)> {
        let ty = self.ty()?;
        let size = match (&self.runner, &self.rows) {
            (Some(_), _) => ty.grades.indices(&G3).len(),
            (None, rows) => rows.as_ref()?.size_of_result(),
        };
        Some((ty.grades.0, size, ty.unit))
    }

    /// The steps.
    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<Vec<Step<'py>>> {
        let step = |step: &formula::Step| {
            let operands: Vec<usize> = step.op.operands().collect();
            let operands = PyTuple::new(py, operands)?;
            let (name, detail) = described(py, &step.op)?;
            let place = characters(&self.text, step.span);
            Ok((name, operands, detail, step.ty.grades.0, step.ty.unit, place))
        };
        self.program.steps.iter().map(step).collect()
    }

    /// The size of the terms that make up a step, from the norm of its value (of the matrix, for a linear map), and the
    /// norms and sizes of its operands; `eps` is the spacing of the floats, `namespace` that of their library.
    fn term_size<'py>(
        &self,
        step: usize,
        length: Bound<'py, PyAny>,
        operands: Vec<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
        eps: f64,
        namespace: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let step = self.program.steps.get(step).ok_or_else(|| bad("there is no such step"))?;
        let magnitude = |value| PyMagnitude { value, namespace };
        let operands: Vec<_> = operands.into_iter().map(|(a, s)| (magnitude(a), magnitude(s))).collect();
        Ok(term_size(&step.op, &magnitude(length), &operands, eps)?.value)
    }

    /// Fills `out`, of the batch shape and the components of the value, from inputs that are arrays of one row
    /// or of all. All hold float64, or in 3-d space float32. False if some row may have no value, in another algebra.
    fn run<'py>(
        &self,
        py: Python<'py>,
        inputs: Vec<Bound<'py, PyAny>>,
        out: &Bound<'py, PyAny>,
    ) -> PyResult<bool> {
        if self.rows.is_some() {
            let mut out: RowsToFill<'_, f64> = out.extract()?;
            let inputs: Vec<Rows<'_, f64>> =
                inputs.iter().map(|input| input.extract()).collect::<Result<_, _>>()?;
            let data: Vec<&[f64]> = inputs.iter().map(numbers).collect::<PyResult<_>>()?;
            return self.fill_rows_elsewhere(py, &data, numbers_to_fill(&mut out)?);
        }
        if out.cast::<PyArrayDyn<f32>>().is_ok() {
            self.fill::<f32>(py, &inputs, out)?;
        } else {
            self.fill::<f64>(py, &inputs, out)?;
        }
        Ok(true)
    }
}

impl Program {
    fn fill<T: Element + numpy::Element>(
        &self,
        py: Python<'_>,
        inputs: &[Bound<'_, PyAny>],
        out: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let mut out: RowsToFill<'_, T> = out.extract()?;
        let batch = out.shape().split_last().map_or(Vec::new(), |(_, batch)| batch.to_vec());
        let out = numbers_to_fill(&mut out)?;
        let inputs: Vec<Rows<'_, T>> =
            inputs.iter().map(|input| input.extract()).collect::<Result<_, _>>()?;
        let data: Vec<&[T]> = inputs.iter().map(numbers).collect::<PyResult<_>>()?;
        self.fill_rows(py, &data, &batch, out)
    }

    /// Fills the rows of a batch from inputs of one row or of all.
    pub(crate) fn fill_rows<T: Element>(
        &self,
        py: Python<'_>,
        data: &[&[T]],
        batch: &[usize],
        out: &mut [T],
    ) -> PyResult<()> {
        let (Some(runner), Some(ty)) = (&self.runner, self.ty()) else {
            return Err(bad("only formulas of 3-d space that are not equations run on arrays"));
        };
        let size = ty.grades.indices(&G3).len();
        let rows: usize = batch.iter().product();
        let kinds: Vec<usize> = self.program.inputs.iter().map(|input| input.kind.size()).collect();
        let fits = |(x, size): (&&[T], &usize)| x.len() == *size || x.len() == rows * size;
        if data.len() != kinds.len() || !data.iter().zip(&kinds).all(fits) || out.len() != rows * size {
            return Err(bad("the arrays do not fit the program"));
        }
        if rows.saturating_mul(runner.weight()) < FEW {
            let done = runner.run(Threads::ONE, data, &mut [out], 0..rows);
            return done.map_err(|error| self.row_error(py, &error, batch));
        }
        let threads = threads(rows.saturating_mul(runner.weight()) / 16)?;
        in_pieces(py, rows, PIECE / runner.weight(), |piece| {
            let done = py.detach(|| runner.run(threads, data, &mut [&mut *out], piece));
            done.map_err(|error| self.row_error(py, &error, batch))
        })
    }

    /// Fills rows in another algebra than 3-d space, from inputs of one row or of all; false if some row may have no value.
    pub(crate) fn fill_rows_elsewhere(
        &self,
        py: Python<'_>,
        data: &[&[f64]],
        out: &mut [f64],
    ) -> PyResult<bool> {
        let runner = self.rows.as_ref().ok_or_else(|| bad("the program does not run on arrays"))?;
        let count = out.len() / runner.size_of_result();
        let fits = |(x, size): (&&[f64], &usize)| x.len() == *size || x.len() == count * size;
        let whole = out.len() == count * runner.size_of_result() && data.len() == runner.sizes().len();
        if !whole || !data.iter().zip(runner.sizes()).all(fits) {
            return Err(bad("the arrays do not fit the program"));
        }
        let threads = threads(count.saturating_mul(runner.weight()) / 16)?;
        let mut all = true;
        in_pieces(py, count, PIECE / runner.weight(), |piece| {
            all = all && py.detach(|| runner.run(threads, data, &mut *out, piece));
            Ok(())
        })?;
        Ok(all)
    }

    /// The type of the value; `None` of an equation.
    pub(crate) fn ty(&self) -> Option<Type> {
        let [results] = &self.program.results[..] else { return None };
        let &[result] = &results[..] else { return None };
        Some(self.program.steps[result].ty)
    }

    /// The value for single values, and whether it is a rotor; `None` for other algebras. `values` receives the values of
    /// all steps.
    pub(crate) fn value<'v>(
        &self,
        inputs: &[Given],
        values: &'v mut Vec<Graded>,
    ) -> Option<Result<(&'v Graded, bool), RowError>> {
        let &[result] = &self.program.results.first()?[..] else { return None };
        let done = self.runner.as_ref()?.value_to(inputs, values);
        let failed = |(step, error)| RowError { row: 0, step, error };
        Some(done.map(|()| (&values[result], self.program.steps[result].ty.unit)).map_err(failed))
    }

    /// The exception for a row without a value.
    pub(crate) fn row_error(&self, py: Python<'_>, found: &RowError, batch: &[usize]) -> PyErr {
        let message = format!("{}{}", place(found.row, batch), found.error);
        error(py, &self.text, &formula::Error { message, span: self.program.steps[found.step].span })
    }
}

/// The name of an operation, and its constant, input or power.
fn described<'py>(py: Python<'py>, op: &Op) -> PyResult<(&'static str, Bound<'py, PyAny>)> {
    let none = || py.None().into_bound(py);
    Ok(match *op {
        Op::Input(input) => ("input", input.into_pyobject(py)?.into_any()),
        Op::Constant(number, blade) => {
            ("constant", (number.value, number.ratio, blade).into_pyobject(py)?.into_any())
        }
        Op::Pi => ("pi", none()),
        Op::Add(..) => ("add", none()),
        Op::Subtract(..) => ("subtract", none()),
        Op::Negate(_) => ("negate", none()),
        Op::Product(product, ..) => ("product", product.name().into_pyobject(py)?.into_any()),
        Op::Compose(..) => ("compose", none()),
        Op::Turn(..) => ("turn", none()),
        Op::Divide(..) => ("divide", none()),
        Op::Reverse(_) => ("reverse", none()),
        Op::Part(_) => ("part", none()),
        Op::Dual(_) => ("dual", none()),
        Op::Undual(_) => ("undual", none()),
        Op::Function(function, _) => (function.name(), none()),
        Op::RotorPower(_, n) => ("power", n.into_pyobject(py)?.into_any()),
        Op::Norm(_) => ("norm", none()),
        Op::Sin(_) => ("sin", none()),
        Op::Cos(_) => ("cos", none()),
        Op::Tan(_) => ("tan", none()),
        Op::Map { input, .. } => ("map", input.into_pyobject(py)?.into_any()),
    })
}

/// Converts a span of bytes to characters.
pub(crate) fn characters(text: &str, span: Span) -> Place {
    let count = |end: usize| text.get(..end).unwrap_or(text).chars().count();
    (count(span.start), count(span.end))
}

/// Converts a range of characters to bytes.
pub(crate) fn span(text: &str, place: Place) -> Span {
    Span { start: byte(text, place.0), end: byte(text, place.1) }
}

/// The exception for an error in a formula, with its place.
pub(crate) fn error(py: Python<'_>, text: &str, error: &formula::Error) -> PyErr {
    match FORMULA_ERROR.get(py).and_then(|class| Ok(class.cast::<PyType>()?.clone())) {
        Ok(class) => {
            let arguments = (error.message.clone(), text.to_owned(), characters(text, error.span));
            PyErr::from_type(class, arguments)
        }
        Err(missing) => missing,
    }
}

/// The line of a text with carets under a place in characters.
#[pyfunction]
pub(crate) fn marked(text: &str, place: Place) -> String {
    formula::Error { message: String::new(), span: span(text, place) }.shown(text)
}

/// The relative tolerance of equations over floats of spacing `eps`.
#[pyfunction]
pub(crate) fn agreement_tolerance(eps: f64) -> f64 {
    formula::tolerance(eps)
}

/// The canonical spelling of a name, such as `Ω_B` or `a1` for `a_1`; None if it is not a name.
#[pyfunction]
pub(crate) fn canonical(name: &str) -> Option<String> {
    formula::canonical(name)
}
