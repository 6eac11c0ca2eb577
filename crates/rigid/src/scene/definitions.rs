//! Names defined by a scene, and formulas that use them.

use crate::laws::formula::{Formula, Purpose, given_names};
use crate::laws::torque::Axes;
use crate::units::UNITS;
use polhode_ga::Graded;
use polhode_ga::formula::session::Source;
use polhode_ga::formula::{
    Error, Given, Input, Meaning, Names, Runner, Space, Span, Type, canonical, compile, define, heading,
    parse,
};
use std::collections::BTreeMap;
use std::ops::Range;

/// The names and values that formulas of a scene may use.
#[derive(Default)]
pub struct Formulas {
    pub names: Names,
    values: BTreeMap<String, Graded>,
}

/// The error at its place in the original text.
fn placed(source: &Source, error: Error) -> Error {
    let Range { start, end } = source.place(error.span.start..error.span.end);
    Error { span: Span { start, end }, ..error }
}

impl Formulas {
    pub fn bind(&mut self, name: String, value: Graded) {
        self.names.bind(name.clone(), Meaning::Value(Type::of(value.grades())));
        self.values.insert(name, value);
    }

    pub fn define(&mut self, head: &str, body: &str) -> Result<(), Error> {
        let source = self.source(body, &heading(head)?.1)?;
        define(head, &source.text, Space::g3(), &mut self.names).map_err(|error| placed(&source, error))
    }

    pub fn value(&self, text: &str) -> Result<Graded, Error> {
        let source = self.source(text, &[])?;
        self.evaluated(&source.text).map_err(|error| placed(&source, error))
    }

    pub fn torque(&self, text: &str, axes: Axes) -> Result<Formula, Error> {
        let given: Vec<String> = given_names().map(str::to_owned).collect();
        let source = self.source(text, &given)?;
        let value = |input: &Input| self.values.get(&input.name).map(|value| Given::Value(*value));
        Formula::new(&source.text, Purpose::Torque(axes), self.names.clone(), value)
            .map_err(|error| placed(&source, error))
    }

    fn evaluated(&self, text: &str) -> Result<Graded, Error> {
        let space = Space::g3();
        let failed = |message: &str, span: Span| Error { message: message.to_owned(), span };
        let whole = Span { start: 0, end: text.len() };
        let tree = parse(text, space, &self.names)?;
        if tree.sides.len() > 1 {
            return Err(failed("an equation has no value, write one side", whole));
        }
        let program = compile(&tree, space, &self.names)?;
        let inputs = program.inputs.iter().filter_map(|input| self.values.get(&input.name));
        let inputs: Vec<Given> = inputs.map(|value| Given::Value(*value)).collect();
        let runner =
            Runner::new(&program).ok_or_else(|| failed("not a formula of 3-d space", Span::default()))?;
        let values = runner
            .value(&inputs)
            .map_err(|(step, error)| failed(&error.to_string(), program.steps[step].span))?;
        let value = values[program.results[0][0]];
        if !value.components().iter().all(|x| x.is_finite()) {
            return Err(failed("the value is not finite", whole));
        }
        Ok(value)
    }

    /// The formula with its quantities as numbers in SI units; `parameters` are those of a function.
    fn source(&self, text: &str, parameters: &[String]) -> Result<Source, Error> {
        let known = |name: String| self.names.get(&name).is_some() || parameters.contains(&name);
        let is_name = |word: &str| canonical(word).is_some_and(known);
        Source::read(text, is_name, UNITS)
    }
}
