//! Programs of formulas in Python: what they are given, and their steps for those who walk them.

use crate::value::Object;
use polhode_ga::formula::{self, InputKind, Op, Span};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyTuple, PyType};

/// A piece of text in characters, as Python counts.
pub(crate) type Place = (usize, usize);

/// What a formula does with values of known types.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Program {
    pub(crate) program: formula::Program,
    /// For each input, its place among the values given.
    pub(crate) order: Vec<usize>,
    pub(crate) text: String,
}

/// An operation: its name, the steps it needs, what else it needs, the grades of the value as bits, whether
/// that is a rotor, and where it stands in the text.
type Step<'py> = (&'static str, Bound<'py, PyTuple>, Bound<'py, PyAny>, u16, bool, Place);

#[pymethods]
impl Program {
    /// For each input its place among the values given, `value`, `matrix` or `determinant`, and the grade.
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

    /// The steps.
    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<Vec<Step<'py>>> {
        let step = |step: &formula::Step| {
            let operands = PyTuple::new(py, step.op.operands())?;
            let (name, detail) = described(py, &step.op)?;
            let place = characters(&self.text, step.span);
            Ok((name, operands, detail, step.ty.grades.0, step.ty.unit, place))
        };
        self.program.steps.iter().map(step).collect()
    }
}

/// The name of an operation, and what it needs beside other steps.
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

/// A piece of text in characters instead of bytes.
pub(crate) fn characters(text: &str, span: Span) -> Place {
    let count = |end: usize| text.get(..end).unwrap_or(text).chars().count();
    (count(span.start), count(span.end))
}

/// The exception that tells what is wrong with a formula, and where.
pub(crate) fn error(py: Python<'_>, text: &str, error: &formula::Error) -> PyErr {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    match CLASS.import(py, "polhode._formula_error", "FormulaError") {
        Ok(class) => {
            let arguments = (error.message.clone(), text.to_owned(), characters(text, error.span));
            PyErr::from_type(class.clone(), arguments)
        }
        Err(_) => PyValueError::new_err(error.shown(text)),
    }
}

/// The place in a text, in characters, with a caret, on lines of its own.
#[pyfunction]
pub(crate) fn marked(text: &str, place: Place) -> String {
    let byte = |count: usize| text.char_indices().nth(count).map_or(text.len(), |(i, _)| i);
    let span = Span { start: byte(place.0), end: byte(place.1) };
    formula::Error { message: String::new(), span }.shown(text)
}
