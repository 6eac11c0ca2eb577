//! Base class of laws and events: a value that keeps its name and arguments. Formulas and Python functions as arguments.

use crate::algebra::value::{self, Operand};
use crate::formula::calls::{Argument, of_map};
use crate::formula::program::error;
use crate::formula::{NameKind, names};
use crate::support::arrays::{Rows, bad, one};
use crate::support::python_objects::{AS_BIVECTORS, AS_VECTORS, Slot};
use polhode_ga::formula::{Error, Given, Input, InputKind, Names};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor, Vector};
use polhode_rigid::error::TorqueError;
use pyo3::exceptions::{PyException, PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};
use std::collections::HashMap;
use std::fmt::Display;
use std::sync::{Arc, Mutex, PoisonError};

/// The exception that a Python function raised, until it is reported.
pub(crate) type Raised = Arc<Mutex<Option<PyErr>>>;

/// A law or an event, compared and pickled by its name and arguments.
#[pyclass(frozen, subclass, module = "polhode._native")]
pub(crate) struct LawValue {
    name: String,
    arguments: Py<PyTuple>,
    raised: Raised,
}

impl LawValue {
    pub fn new(name: String, arguments: Bound<'_, PyTuple>, raised: Raised) -> LawValue {
        LawValue { name, arguments: arguments.unbind(), raised }
    }
}

#[pymethods]
impl LawValue {
    /// Its name in its module.
    #[getter]
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Its arguments.
    #[getter]
    fn arguments(&self, py: Python<'_>) -> Py<PyTuple> {
        self.arguments.clone_ref(py)
    }

    fn __eq__(slf: &Bound<'_, Self>, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        if !slf.get_type().is(other.get_type()) {
            return Ok(false);
        }
        let (own, other) = (slf.get(), other.cast::<LawValue>()?.get());
        Ok(own.name == other.name && own.arguments.bind(slf.py()).eq(&other.arguments)?)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        (&self.name, &self.arguments).into_pyobject(py)?.hash()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let own = slf.get();
        let mut all = vec![own.name.clone().into_pyobject(slf.py())?.into_any()];
        all.extend(own.arguments.bind(slf.py()).iter());
        Ok((slf.get_type(), PyTuple::new(slf.py(), all)?))
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let own = slf.get();
        Ok(format!("{}({:?}, {})", slf.get_type().name()?, own.name, own.arguments.bind(slf.py()).repr()?))
    }
}

fn take_raised(value: &Bound<'_, LawValue>) -> Option<PyErr> {
    value.get().raised.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// The exception raised by the function of one of these values, or else a ValueError with this message.
pub(crate) fn failed<'a, 'py: 'a>(
    values: impl IntoIterator<Item = &'a Bound<'py, LawValue>>,
    message: impl Display,
) -> PyErr {
    values.into_iter().find_map(take_raised).unwrap_or_else(|| bad(message))
}

/// Raises stored exceptions that are not an `Exception`, such as KeyboardInterrupt. Others, which are reported already,
/// are dropped.
pub(crate) fn interrupted<'a, 'py: 'a>(
    values: impl IntoIterator<Item = &'a Bound<'py, LawValue>>,
) -> PyResult<()> {
    for value in values {
        let raised = take_raised(value);
        if let Some(error) = raised.filter(|error| !error.is_instance_of::<PyException>(value.py())) {
            return Err(error);
        }
    }
    Ok(())
}

/// The only argument.
pub(crate) fn sole<'py, T: FromPyObjectOwned<'py>>(arguments: &Bound<'py, PyTuple>) -> PyResult<T> {
    arguments.get_item(0)?.extract().map_err(Into::into)
}

/// Names with their values.
pub(crate) type Values<'py> = Vec<(String, Bound<'py, PyAny>)>;

/// The value of an input of a formula.
pub(crate) type Known<'a> = dyn FnMut(&Input) -> Option<Given> + 'a;

/// Compiles a formula by `compile`, with values for its names.
pub(crate) fn formula<T>(
    py: Python<'_>,
    text: &str,
    values: &Values<'_>,
    compile: impl FnOnce(Names, &mut Known<'_>) -> Result<T, Error>,
) -> PyResult<T> {
    let mut types: Vec<NameKind> = Vec::with_capacity(values.len());
    for (name, value) in values {
        types.push(match Argument::of(value)? {
            Some(argument) => argument.named(name.clone()),
            None => {
                let message = format!("{name} must be a single value over floats, a number or a linear map");
                return Err(PyTypeError::new_err(message));
            }
        });
    }
    let (names, spelled) = names(&types)?;
    let places: HashMap<&str, usize> = spelled.iter().map(String::as_str).zip(0..).collect();
    let mut wrong = None;
    let mut value = |input: &Input| {
        let (_, value) = values.get(*places.get(input.name.as_str())?)?;
        known(value, input.kind).map_err(|error| wrong = Some(error)).ok()
    };
    let compiled = compile(names, &mut value);
    match wrong {
        Some(error) => Err(error),
        None => compiled.map_err(|e| error(py, text, &e)),
    }
}

/// Converts a Python value to that of an input.
fn known(value: &Bound<'_, PyAny>, kind: InputKind) -> PyResult<Given> {
    match (kind, value::operand(value)) {
        (InputKind::Value(_), Operand::Value(value, _)) => Ok(Given::Value(*value)),
        (InputKind::Value(_), Operand::Number(x)) => Ok(Given::Value(value::scalar(x))),
        (kind, _) => of_map(value, kind),
    }
}

pub(crate) fn rotor_of(py: Python<'_>, rotor: Rotor) -> value::Object<'_> {
    value::one_rotor(py, rotor)
}

pub(crate) fn bivector_of(py: Python<'_>, b: Bivector) -> value::Object<'_> {
    value::one(py, Graded::new(&b.0, Grades::BIVECTOR).unwrap_or_default())
}

pub(crate) fn vector_of(py: Python<'_>, v: Vector) -> value::Object<'_> {
    value::one(py, Graded::new(&v.0, VECTOR).unwrap_or_default())
}

const VECTOR: Grades = Grades(0b10);

/// A Python function that is called along a motion; an exception stops the motion.
pub(crate) struct Callback {
    pub call: Py<PyAny>,
    pub raised: Raised,
    /// The name of its value, for errors.
    pub what: &'static str,
}

impl Callback {
    /// Calls it at a time; `read` converts what it returns.
    pub fn at<T>(
        &self,
        time: f64,
        arguments: impl for<'py> FnOnce(Python<'py>) -> PyResult<Bound<'py, PyTuple>>,
        read: impl for<'py> FnOnce(Bound<'py, PyAny>, What<'_>) -> PyResult<T>,
    ) -> Result<T, TorqueError> {
        let what = || format!("the {} that the function returned at t = {time} s", self.what);
        Python::attach(|py| read(self.call.bind(py).call1(arguments(py)?)?, &what)).map_err(|error| {
            let message = TorqueError::new(error.to_string());
            *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            message
        })
    }
}

/// Describes a returned value, for errors.
type What<'a> = &'a dyn Fn() -> String;

/// A bivector or three numbers.
pub(crate) fn bivector(returned: Bound<'_, PyAny>, what: What<'_>) -> PyResult<Bivector> {
    three(returned, what, Grades::BIVECTOR, "bivector", &AS_BIVECTORS).map(Bivector)
}

/// A vector or three numbers.
pub(crate) fn vector(returned: Bound<'_, PyAny>, what: What<'_>) -> PyResult<Vector> {
    three(returned, what, VECTOR, "vector", &AS_VECTORS).map(Vector)
}

/// A number, or a scalar.
pub(crate) fn number(returned: Bound<'_, PyAny>, what: What<'_>) -> PyResult<f64> {
    match value::operand(&returned) {
        Operand::Value(value, _) if value.grades() == Grades::SCALAR => Ok(value.components()[0]),
        Operand::Number(x) => Ok(x),
        _ => returned.extract().map_err(|_| {
            let kind =
                returned.get_type().name().map_or_else(|_| "another type".into(), |name| name.to_string());
            PyTypeError::new_err(format!("{} must be a number, got {kind}", what()))
        }),
    }
}

fn three(
    returned: Bound<'_, PyAny>,
    what: What<'_>,
    grades: Grades,
    kind: &str,
    convert: &Slot,
) -> PyResult<[f64; 3]> {
    let py = returned.py();
    if let Operand::Value(value, _) = value::operand(&returned)
        && let (true, &[x, y, z]) = (value.grades() == grades, value.components())
    {
        return Ok([x, y, z]);
    }
    if let Some(([x, y, z, ..], 3)) = value::row(&returned) {
        return Ok([x, y, z]);
    }
    if let Ok(three) = returned.extract::<Rows<'_>>().and_then(|rows| one(&rows)) {
        return Ok(three);
    }
    // Any other value of three numbers, or an error.
    let rows = convert.get(py)?.call1((returned, what()))?;
    let rows: Rows<'_> = rows.call_method0(intern!(py, "copy"))?.extract()?;
    one(&rows).map_err(|error| PyValueError::new_err(format!("{} must be a single {kind}: {error}", what())))
}
