//! Sessions of formulas: lines that give names values, define functions, evaluate and compare.
//!
//! `a = 2 e1 + e2` gives a name a value, in which numbers may have units; `V(x) = ½ x·x` defines a function; `lhs = rhs`
//! with any other left side, or `lhs == rhs`, compares; all other lines are formulas, in which `_` is the last value.
//!
//! A [`Line`] decides this for any coefficients. [`Session`] evaluates lines over floats of 3-d space.

mod line;

pub use line::{
    EQUATION_AS_VALUE, Head, LAST_VALUE, Line, NO_LAST_VALUE, NOT_FINITE, Quantities, Source, Units,
};

use super::{
    Agreement, Definition, Error, Given, Kind, Meaning, Names, Node, Program, Runner, Space, Span, Style,
    Tree, Type, compile, define, parse,
};
use crate::graded::Graded;
use crate::product::Grades;
use std::collections::BTreeMap;

/// The outcome of a line; empty for an empty line.
#[derive(Default)]
pub struct Outcome {
    /// The name that was given a value or defined as a function.
    pub name: Option<String>,
    /// The formula, or the body of the function, in canonical spelling.
    pub text: Option<String>,
    /// The same in LaTeX.
    pub latex: Option<String>,
    /// The value, and its type as known before evaluation.
    pub value: Option<(Graded, Type)>,
    /// Of an equation.
    pub agreement: Option<Agreement>,
}

/// The names of a session with their values and functions.
pub struct Session {
    /// Includes the names of invalid lines, so that later lines are read the same way.
    names: Names,
    values: BTreeMap<String, Graded>,
    /// The number of the invalid line that should have given this name a value.
    failed: BTreeMap<String, usize>,
    last: Option<(Graded, Type)>,
    units: Units,
}

impl Session {
    /// A session without names.
    pub fn new(units: Units) -> Session {
        Session {
            names: Names::default(),
            values: BTreeMap::new(),
            failed: BTreeMap::new(),
            last: None,
            units,
        }
    }

    /// Evaluates a line without its comment.
    ///
    /// # Errors
    /// The name that the line should have given a value, and the error with its place in the line.
    pub fn run(&mut self, number: usize, line: &str) -> Result<Outcome, (Option<String>, Error)> {
        if line.trim().is_empty() {
            return Ok(Outcome::default());
        }
        let known = |name: &str| self.names.get(name).is_some();
        let read = Line::read(line, 0, None, known, self.units);
        let outcome = read.and_then(|line| self.answer(&line));
        let Ok((Some(Head { name, parameters, .. }), _)) = line::head(line, 0, None) else {
            return outcome.map_err(|error| (None, error));
        };
        match outcome {
            Ok(outcome) => {
                self.failed.remove(&name);
                Ok(Outcome { name: Some(name), ..outcome })
            }
            Err(error) => {
                self.values.remove(&name);
                self.names.bind(name.clone(), placeholder(parameters));
                self.failed.insert(name.clone(), number);
                Err((Some(name), error))
            }
        }
    }

    fn answer(&mut self, line: &Line) -> Result<Outcome, Error> {
        if let Some(head) = line.head.as_ref().filter(|head| head.is_function()) {
            return self.define(line, head);
        }
        let outcome = match line.uses_last {
            false => self.evaluate(line)?,
            true => {
                let (value, ty) = self.last.ok_or_else(|| line.error(NO_LAST_VALUE))?;
                let hidden = (self.names.get(LAST_VALUE).cloned(), self.values.get(LAST_VALUE).copied());
                self.bind(LAST_VALUE, value, ty);
                let outcome = self.evaluate(line);
                self.names.restore(LAST_VALUE, hidden.0);
                self.values.remove(LAST_VALUE);
                self.values.extend(hidden.1.map(|value| (LAST_VALUE.to_owned(), value)));
                outcome?
            }
        };
        let Some((value, ty)) = outcome.value else {
            return if line.head.is_none() { Ok(outcome) } else { Err(line.error(EQUATION_AS_VALUE)) };
        };
        if let Some(head) = &line.head {
            self.bind(&head.name, value, ty);
        }
        self.last = Some((value, ty));
        Ok(outcome)
    }

    fn bind(&mut self, name: &str, value: Graded, ty: Type) {
        self.names.bind(name.to_owned(), Meaning::Value(ty));
        self.values.insert(name.to_owned(), value);
    }

    fn define(&mut self, line: &Line, head: &Head) -> Result<Outcome, Error> {
        define(&head.text, line.text(), Space::g3(), &mut self.names)
            .map_err(|error| line.place(line.text(), error))?;
        let Some(Meaning::Function(Definition { body, .. })) = self.names.get(&head.name) else {
            return Ok(Outcome::default());
        };
        self.check(body, &head.parameters).map_err(|error| line.place(line.text(), error))?;
        let (text, latex) = (body.text(Style::Unicode), body.latex());
        self.values.remove(&head.name);
        Ok(Outcome { text: Some(text), latex: Some(latex), ..Outcome::default() })
    }

    /// The value of a formula, or the agreement of an equation.
    fn evaluate(&self, line: &Line) -> Result<Outcome, Error> {
        let placed = |error: Error| line.place(line.text(), error);
        let tree = parse(line.text(), Space::g3(), &self.names).map_err(placed)?;
        tree.sides.iter().try_for_each(|side| self.check(side, &[])).map_err(placed)?;
        let program = compile(&tree, Space::g3(), &self.names).map_err(placed)?;
        let inputs = self.inputs(&program).map_err(|message| line.error(message))?;
        let runner =
            Runner::new(&program).ok_or_else(|| line.error("the formula is not one of 3-d space"))?;
        let values = runner.value(&inputs).map_err(|(step, error)| {
            placed(Error { message: error.to_string(), span: program.steps[step].span })
        })?;
        let result = program.results[0][0];
        let (value, ty) = (values[result], program.steps[result].ty);
        let agreement = program.is_equation().then(|| Agreement::of(&program, &inputs, &values));
        let finite = match agreement {
            Some(found) => found.residual.is_finite() && found.size.is_finite(),
            None => value.components().iter().all(|x| x.is_finite()),
        };
        if !finite {
            return Err(line.error(NOT_FINITE));
        }
        let value = agreement.is_none().then_some((value, ty));
        Ok(Outcome { value, agreement, ..spelled(&tree) })
    }

    fn inputs(&self, program: &Program) -> Result<Vec<Given>, String> {
        let inputs = program.inputs.iter().map(|input| {
            let value = self.values.get(&input.name).copied();
            value.map(Given::Value).ok_or_else(|| self.no_value(&input.name))
        });
        inputs.collect()
    }

    /// Fails at the first name in a formula of these parameters whose own line is invalid.
    fn check(&self, node: &Node, parameters: &[String]) -> Result<(), Error> {
        if let Kind::Name(name) | Kind::Call(name, _) = &node.kind
            && self.failed.contains_key(name)
            && !parameters.contains(name)
        {
            return Err(Error { message: self.no_value(name), span: node.span });
        }
        node.children().into_iter().try_for_each(|child| self.check(child, parameters))
    }

    fn no_value(&self, name: &str) -> String {
        match self.failed.get(name) {
            Some(line) => format!("`{name}` has no value, because line {line} has an error"),
            None => format!("`{name}` has no value"),
        }
    }
}

/// The meaning of a name whose line is invalid; it is never evaluated.
fn placeholder(parameters: Vec<String>) -> Meaning {
    match parameters.is_empty() {
        true => Meaning::Value(Type::of(Grades::ALL)),
        false => Meaning::Function(Definition { parameters, body: Node::new(Kind::Pi, Span::default()) }),
    }
}

fn spelled(tree: &Tree) -> Outcome {
    Outcome { text: Some(tree.text(Style::Unicode)), latex: Some(tree.latex()), ..Outcome::default() }
}
