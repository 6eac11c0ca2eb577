//! Formulas in Python: parsing, programs for values of given kinds, and calls.

pub(crate) mod batches;
pub(crate) mod caller;
pub(crate) mod calls;
pub(crate) mod line;
mod magnitude;
pub(crate) mod program;

use crate::algebra::signature::{Algebra, g3, largest};
use crate::algebra::value::Object;
use crate::support::arrays::bad;
use crate::support::python_objects::CALL_FORMULA;
use calls::Calls;
use polhode_ga::formula::{
    Kind, Language, Meaning, Names, Node, RowRunner, Runner, Space, Style, Tree, Type, canonical, compile,
    define, heading, is_function_name, parse, types,
};
use polhode_ga::product::Grades;
use polhode_ga::table::Signature;
use program::{Place, Program, characters, error};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString, PyTuple};
use std::collections::HashMap;
use std::sync::Mutex;

/// A name, its grades as bits, and 0 for a value, 1 for a rotor, or 2 for a linear map of grade 1 or 2.
pub(crate) type NameKind = (String, u16, u8);

/// Maximum number of cached programs of a formula, one for each combination of kinds.
const KEPT: usize = 64;

/// A formula.
#[derive(Default)]
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Formula {
    text: String,
    algebra: Option<Py<Algebra>>,
    definitions: Vec<(String, String)>,
    /// The names of values that are given by position.
    arguments: Vec<Py<PyString>>,
    programs: Mutex<HashMap<Key, Py<Program>>>,
    calls: Calls,
}

/// The signature of the algebra, the number of its first generator, and the names with their kinds.
type Key = (Signature, usize, Vec<NameKind>);

#[pymethods]
impl Formula {
    /// Parses a text, for the given algebra or any; raises a FormulaError if it is not a formula.
    #[new]
    fn new(
        py: Python<'_>,
        text: String,
        algebra: Option<Py<Algebra>>,
        definitions: Vec<(String, String)>,
        arguments: Vec<String>,
    ) -> PyResult<Formula> {
        // Only to check the names.
        let kinds: Vec<NameKind> = arguments.iter().map(|name| (name.clone(), 1, 0)).collect();
        let (_, spelled) = names(&kinds)?;
        if let Some(place) = spelled.iter().position(String::is_empty) {
            return Err(not_a_name(&arguments[place]));
        }
        let arguments = arguments.iter().map(|name| PyString::intern(py, name).unbind()).collect();
        let (programs, calls) = <_>::default();
        let formula = Formula { text, algebra, definitions, arguments, programs, calls };
        formula.read_open(py)?;
        Ok(formula)
    }

    /// The text.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// The algebra, if one was given.
    #[getter]
    fn algebra(&self, py: Python<'_>) -> Option<Py<Algebra>> {
        self.algebra.as_ref().map(|algebra| algebra.clone_ref(py))
    }

    /// The definitions.
    #[getter]
    fn definitions(&self) -> Vec<(String, String)> {
        self.definitions.clone()
    }

    /// The names of values that are given by position.
    #[getter]
    fn arguments(&self, py: Python<'_>) -> Vec<Py<PyString>> {
        self.arguments.iter().map(|name| name.clone_ref(py)).collect()
    }

    /// The formula in canonical spelling, `unicode`, `ascii` or `latex`, for values of these kinds; without any, with
    /// open names.
    fn spelled(
        &self,
        py: Python<'_>,
        style: &str,
        algebra: Py<Algebra>,
        given: Vec<NameKind>,
    ) -> PyResult<String> {
        let tree =
            if given.is_empty() { self.read_open(py)? } else { self.read(py, &algebra, names(&given)?.0)?.0 };
        Ok(match style {
            "latex" => tree.latex(),
            "ascii" => tree.text(Style::Ascii),
            _ => tree.text(Style::Unicode),
        })
    }

    /// The source of a function of this name in a language, for values of these kinds.
    fn code(
        &self,
        py: Python<'_>,
        language: &str,
        function: &str,
        algebra: Py<Algebra>,
        given: Vec<NameKind>,
    ) -> PyResult<String> {
        let language = Language::from_name(language).ok_or_else(|| bad("unknown language"))?;
        if !is_function_name(function) {
            let message = "must be an ASCII identifier that no language reserves";
            return Err(bad(format!("the name of the function {message}, got {function:?}")));
        }
        let (tree, _) = self.read(py, &algebra, names(&given)?.0)?;
        let program = self.program(py, algebra.clone_ref(py), given)?;
        let Program { program, order, .. } = program.get();
        let mut sorted: Vec<usize> = (0..order.len()).collect();
        sorted.sort_by_key(|&input| order[input]);
        let text = tree.text(Style::Ascii);
        let code = language.code(program, &algebra.get().table, &sorted, (function, &text));
        code.map_err(|e| error(py, &self.text, &e))
    }

    /// The program for values of these kinds, in this algebra.
    fn program(&self, py: Python<'_>, algebra: Py<Algebra>, given: Vec<NameKind>) -> PyResult<Py<Program>> {
        let table = &algebra.get().table;
        let key = (table.signature(), table.numbers().start, given);
        if let Some(program) = self.programs.lock().map_err(bad)?.get(&key) {
            return Ok(program.clone_ref(py));
        }
        let program = Py::new(py, self.compiled(py, &algebra, &key.2)?)?;
        let mut programs = self.programs.lock().map_err(bad)?;
        if programs.len() >= KEPT {
            programs.clear();
        }
        programs.insert(key, program.clone_ref(py));
        Ok(program)
    }

    /// The tree as nested dictionaries, for values of these kinds; without any, with open names.
    fn tree<'py>(&self, py: Python<'py>, algebra: Py<Algebra>, given: Vec<NameKind>) -> Object<'py> {
        let names = if given.is_empty() { Names::open() } else { names(&given)?.0 };
        let space = space(&algebra);
        let (tree, names) = self.read(py, &algebra, names)?;
        let types = types(&tree, space, &names).map_err(|e| error(py, &self.text, &e))?;
        let mut grades = types.into_iter();
        let sides: Vec<_> =
            tree.sides.iter().map(|side| self.node(py, side, &mut grades)).collect::<PyResult<_>>()?;
        if let [side] = &sides[..] {
            return Ok(side.clone().into_any());
        }
        let place = (0, self.text.chars().count());
        Ok(entry(("equation", py.None().into_bound(py)), &self.text, place, None, sides)?.into_any())
    }
}

impl Formula {
    /// The program for values of an algebra over floats; `None` for an equation, for another algebra than that of the
    /// formula, for functions outside 3-d space, and for an error, which the general way reports.
    pub(crate) fn for_floats(
        &self,
        py: Python<'_>,
        algebra: &Py<Algebra>,
        kinds: Vec<NameKind>,
    ) -> Option<Py<Program>> {
        if self.algebra.as_ref().is_some_and(|own| !own.is(algebra)) {
            return None;
        }
        let program = self.program(py, algebra.clone_ref(py), kinds).ok()?;
        let Program { program: steps, runner, rows, .. } = program.get();
        let runs = !steps.is_equation() && (runner.is_some() || rows.is_some());
        runs.then_some(program)
    }

    fn algebra_or_g3<'a>(&'a self, py: Python<'a>) -> PyResult<&'a Py<Algebra>> {
        match &self.algebra {
            Some(algebra) => Ok(algebra),
            None => g3(py),
        }
    }

    /// The tree with open names. Without an algebra there may be more basis vectors than in 3-d space.
    fn read_open(&self, py: Python<'_>) -> PyResult<Tree> {
        let read = self.read(py, self.algebra_or_g3(py)?, Names::open());
        let read = match (read, &self.algebra) {
            (Err(first), None) => {
                let mut others = largest(py)?.iter();
                let other = others.find_map(|algebra| self.read(py, algebra, Names::open()).ok());
                other.ok_or(first)
            }
            (read, _) => read,
        };
        Ok(read?.0)
    }

    /// The tree, and the names with the definitions.
    fn read(&self, py: Python<'_>, algebra: &Py<Algebra>, mut names: Names) -> PyResult<(Tree, Names)> {
        let space = space(algebra);
        for (head, body) in &self.definitions {
            let (name, _) = heading(head).map_err(|e| error(py, head, &e))?;
            if matches!(names.get(&name), Some(Meaning::Value(_) | Meaning::Map { .. })) {
                return Err(PyTypeError::new_err(format!(
                    "`{name}` is defined by the formula; omit its value"
                )));
            }
            define(head, body, space, &mut names).map_err(|e| error(py, body, &e))?;
        }
        let tree = parse(&self.text, space, &names).map_err(|e| error(py, &self.text, &e))?;
        Ok((tree, names))
    }

    fn compiled(&self, py: Python<'_>, algebra: &Py<Algebra>, given: &[NameKind]) -> PyResult<Program> {
        let (names, spelled) = names(given)?;
        let (tree, names) = self.read(py, algebra, names)?;
        let program = compile(&tree, space(algebra), &names).map_err(|e| error(py, &self.text, &e))?;
        let place = |name: &String| spelled.iter().position(|other| other == name);
        let order: Option<Vec<usize>> = program.inputs.iter().map(|input| place(&input.name)).collect();
        let order = order.ok_or_else(|| bad("the program needs a value that was not given"))?;
        let runner = Runner::new(&program);
        let table = &algebra.get().table;
        let rows = if runner.is_none() { RowRunner::new(&program, table) } else { None };
        Ok(Program { program, order, text: self.text.clone(), runner, rows })
    }

    /// A node, whose types come next.
    fn node<'py>(
        &self,
        py: Python<'py>,
        node: &Node,
        types: &mut impl Iterator<Item = Option<Type>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let grades = types.next().flatten().map(|ty| grades(py, ty.grades)).transpose()?;
        let text = self.text.get(node.span.start..node.span.end).unwrap_or_default();
        let children: PyResult<_> =
            node.children().into_iter().map(|child| self.node(py, child, types)).collect();
        entry(described(py, node)?, text, characters(&self.text, node.span), grades, children?)
    }
}

/// A part of a tree as a dictionary; only some kinds have a value.
fn entry<'py>(
    (kind, value): (&str, Bound<'py, PyAny>),
    text: &str,
    span: Place,
    grades: Option<Bound<'py, PyTuple>>,
    children: Vec<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let shown = PyDict::new(value.py());
    shown.set_item("kind", kind)?;
    if !value.is_none() {
        shown.set_item("value", value)?;
    }
    shown.set_item("text", text)?;
    shown.set_item("span", span)?;
    shown.set_item("grades", grades)?;
    shown.set_item("children", children)?;
    Ok(shown)
}

/// The meanings of names, and their canonical spellings.
pub(crate) fn names(given: &[NameKind]) -> PyResult<(Names, Vec<String>)> {
    let mut names = Names::new([]);
    let mut spelled: Vec<String> = Vec::new();
    for (name, grades, kind) in given {
        let grades = Grades(*grades);
        let meaning = match kind {
            0 => Meaning::Value(Type::of(grades)),
            1 => Meaning::Value(Type::ROTOR),
            _ => Meaning::Map { grade: grades.0 as u8 },
        };
        let Some(spelling) = canonical(name) else {
            // Such as __name__, which cannot occur in a formula.
            if name.chars().all(|c| c.is_alphanumeric() || c == '_') {
                spelled.push(String::new());
                continue;
            }
            return Err(not_a_name(name));
        };
        if let Some(i) = spelled.iter().position(|other| *other == spelling) {
            let other = &given[i].0;
            return Err(PyTypeError::new_err(format!("{other:?} and {name:?} are the same name; give one")));
        }
        spelled.push(spelling.clone());
        names.bind(spelling, meaning);
    }
    Ok((names, spelled))
}

fn not_a_name(name: &str) -> PyErr {
    PyTypeError::new_err(format!(
        "{name:?} is not a name in formulas; names are letters with subscripts and primes, or words"
    ))
}

/// The value of a formula.
fn called<'py>(
    formula: &Bound<'py, Formula>,
    arguments: &Bound<'py, PyTuple>,
    named: Option<&Bound<'py, PyDict>>,
) -> Object<'py> {
    let py = formula.py();
    let own = formula.get();
    if arguments.is_empty() {
        return match named {
            Some(named) => called_by_name(formula, named),
            None => general(formula, arguments, named),
        };
    }
    // A mapping of values by name, or an error.
    if arguments.len() > own.arguments.len() || arguments.get_item(0)?.cast::<PyMapping>().is_ok() {
        return general(formula, arguments, named);
    }
    let all = PyDict::new(py);
    for (name, value) in own.arguments.iter().zip(arguments.iter()) {
        all.set_item(name, value)?;
    }
    for (name, value) in named.iter().flat_map(|named| named.iter()) {
        if all.contains(&name)? {
            let name: String = name.extract()?;
            return Err(PyTypeError::new_err(format!("{name:?} is given both by position and by name")));
        }
        all.set_item(name, value)?;
    }
    called_by_name(formula, &all)
}

/// The value for values by their names.
fn called_by_name<'py>(formula: &Bound<'py, Formula>, named: &Bound<'py, PyDict>) -> Object<'py> {
    let py = formula.py();
    let own = formula.get();
    let pairs: Vec<_> = named.iter().collect();
    let borrowed = || pairs.iter().map(|(name, value)| (name.as_borrowed(), value.as_borrowed()));
    if let Some(value) = own.calls.value(py, borrowed)? {
        return Ok(value);
    }
    // `out` is an array for the value, unless the formula uses the name, which the Python half finds out.
    if named.contains(intern!(py, "out"))? {
        return general(formula, &PyTuple::empty(py), Some(named));
    }
    if own.calls.keep(own, named)?
        && let Some(value) = own.calls.value(py, borrowed)?
    {
        return Ok(value);
    }
    if let Some(value) = batches::value(own, named)? {
        return Ok(value);
    }
    general(formula, &PyTuple::empty(py), Some(named))
}

/// The value for values of any kind, or the error.
fn general<'py>(
    formula: &Bound<'py, Formula>,
    arguments: &Bound<'py, PyTuple>,
    named: Option<&Bound<'py, PyDict>>,
) -> Object<'py> {
    CALL_FORMULA.get(formula.py())?.call1((formula, arguments, named))
}

/// The kind of a node, and its further value.
fn described<'py>(py: Python<'py>, node: &Node) -> PyResult<(&'static str, Bound<'py, PyAny>)> {
    let none = py.None().into_bound(py);
    Ok(match &node.kind {
        Kind::Number(number) => ("number", number.value.into_pyobject(py)?.into_any()),
        Kind::Pi => ("pi", none),
        Kind::Blade(generators) => {
            let generators: Vec<usize> = generators.iter().map(|&i| i.into()).collect();
            ("blade", generators.into_pyobject(py)?)
        }
        Kind::Pseudoscalar => ("pseudoscalar", none),
        Kind::Name(name) => ("name", name.into_pyobject(py)?.into_any()),
        Kind::Sum(terms) => {
            let signs: Vec<&str> = terms.iter().map(|&(minus, _)| if minus { "-" } else { "+" }).collect();
            ("sum", signs.into_pyobject(py)?)
        }
        Kind::Product(_) => ("product", none),
        Kind::Quotient(_) => ("quotient", none),
        Kind::Tight(tight, _) => (tight.name(), none),
        Kind::Reverse(_) => ("reverse", none),
        Kind::Power(_, n) => ("power", n.into_pyobject(py)?.into_any()),
        Kind::Part(_, part) => ("part", grades(py, *part)?.into_any()),
        Kind::Function(function, _) => (function.name(), none),
        Kind::Call(name, _) => ("call", name.into_pyobject(py)?.into_any()),
        Kind::Derivative(_) => ("derivative", none),
        Kind::Total(index, _) => ("total", index.into_pyobject(py)?.into_any()),
    })
}

/// Grades as Python shows them.
fn grades(py: Python<'_>, grades: Grades) -> PyResult<Bound<'_, PyTuple>> {
    let grades: Vec<usize> = (0..16).filter(|&k| grades.contains(k)).collect();
    PyTuple::new(py, grades)
}

/// The algebra, for formulas.
fn space(algebra: &Py<Algebra>) -> Space<'_> {
    let algebra = algebra.get();
    if algebra.is_g3() { Space::g3() } else { Space::new(&algebra.table, algebra.calculus(false)) }
}
