//! Names with values, and functions, which lines of formulas use and add to.

use polhode_ga::Graded;
use polhode_ga::formula::{
    Agreement, Definition, Error, Given, Kind, Meaning, Names, Node, Program, Runner, Space, Span, Style,
    Tree, Type, canonical, compile, define, heading, parse,
};
use polhode_rigid::units::{self, Source};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a line came to; nothing, if it is empty.
#[derive(Default)]
pub struct Outcome {
    /// What got the value, or is a function now.
    pub name: Option<String>,
    /// The formula in canonical spelling; of a function, its body.
    pub shown: Option<String>,
    /// The same in LaTeX.
    pub latex: Option<String>,
    /// The value, and what was known of it before it was there.
    pub value: Option<(Graded, Type)>,
    /// Of an equation.
    pub agreement: Option<Agreement>,
}

/// What is wrong with a line, and where in it, in bytes.
pub struct Wrong {
    pub message: String,
    pub span: Range<usize>,
}

/// What lines gave names to.
#[derive(Default)]
pub struct Session {
    /// All of them. What a line that is wrong would have named is here, too, so that others are read the same way.
    names: Names,
    values: BTreeMap<String, Graded>,
    /// The number of the line that should give this name a value and is wrong.
    failed: BTreeMap<String, usize>,
}

impl Session {
    /// What a line without its comment comes to; else what is wrong, with the name that it would have given a value.
    pub fn run(&mut self, number: usize, line: &str) -> Result<Outcome, (Option<String>, Wrong)> {
        if line.trim().is_empty() {
            return Ok(Outcome::default());
        }
        let Some((head, name, parameters, body)) = assignment(line) else {
            return self.evaluate(line).map_err(|wrong| (None, wrong));
        };
        let outcome = match parameters.is_empty() {
            true => self.assign(head.trim(), &name, body),
            false => self.define(head, &name, &parameters, body),
        };
        let begins = line.len() - body.len();
        match outcome {
            Ok(outcome) => {
                self.failed.remove(&name);
                Ok(Outcome { name: Some(name), ..outcome })
            }
            Err(wrong) => {
                self.values.remove(&name);
                self.names.bind(name.clone(), placeholder(parameters));
                self.failed.insert(name.clone(), number);
                let span = begins + wrong.span.start..begins + wrong.span.end;
                Err((Some(name), Wrong { span, ..wrong }))
            }
        }
    }

    fn evaluate(&self, line: &str) -> Result<Outcome, Wrong> {
        let whole = whole(line);
        self.outcome(line, &whole).map_err(|error| about_units(error.into(), line, false))
    }

    fn assign(&mut self, head: &str, name: &str, body: &str) -> Result<Outcome, Wrong> {
        let whole = whole(body);
        let source = self.source(body, &[])?;
        let outcome = self
            .outcome(&source.text, &(0..source.text.len()))
            .map_err(|error| about_units(placed(&source, error), body, true))?;
        let Some((value, ty)) = outcome.value else {
            let message = format!("an equation is no value for `{head}`; compare with `==`");
            return Err(Wrong { message, span: whole });
        };
        self.names.bind(name.to_owned(), Meaning::Value(ty));
        self.values.insert(name.to_owned(), value);
        Ok(outcome)
    }

    fn define(
        &mut self,
        head: &str,
        name: &str,
        parameters: &[String],
        body: &str,
    ) -> Result<Outcome, Wrong> {
        let source = self.source(body, parameters)?;
        let defined = define(head, &source.text, Space::g3(), &mut self.names);
        defined.map_err(|error| {
            let wrong = placed(&source, error);
            let itself = body.get(wrong.span.clone()).and_then(canonical).is_some_and(|word| word == name);
            match itself {
                true => Wrong {
                    message: format!("`{name}` would call itself; formulas have no recursion"),
                    ..wrong
                },
                false => about_units(wrong, body, true),
            }
        })?;
        let Some(Meaning::Function(Definition { body: defined, .. })) = self.names.get(name) else {
            return Ok(Outcome::default());
        };
        self.check(defined, parameters).map_err(|error| placed(&source, error))?;
        let (shown, latex) = (defined.text(Style::Unicode), defined.latex());
        self.values.remove(name);
        Ok(Outcome { shown: Some(shown), latex: Some(latex), ..Outcome::default() })
    }

    /// The value of a formula, or whether an equation holds.
    fn outcome(&self, text: &str, whole: &Range<usize>) -> Result<Outcome, Error> {
        let wrong = |message: String| Error { message, span: Span { start: whole.start, end: whole.end } };
        let tree = parse(text, Space::g3(), &self.names)?;
        tree.sides.iter().try_for_each(|side| self.check(side, &[]))?;
        let program = compile(&tree, Space::g3(), &self.names)?;
        let inputs = self.inputs(&program).map_err(wrong)?;
        let runner = Runner::new(&program).ok_or_else(|| wrong("no formula of 3-d space".to_owned()))?;
        let values = runner
            .value(&inputs)
            .map_err(|(step, error)| Error { message: error.to_string(), span: program.steps[step].span })?;
        let result = program.results[0][0];
        let (value, ty) = (values[result], program.steps[result].ty);
        let agreement = program.is_equation().then(|| Agreement::of(&program, &inputs, &values));
        let finite = match agreement {
            Some(found) => found.residual.is_finite() && found.size.is_finite(),
            None => value.components().iter().all(|x| x.is_finite()),
        };
        if !finite {
            return Err(wrong("the value is beyond the range of floating point, about 1.8e308".to_owned()));
        }
        let value = agreement.is_none().then_some((value, ty));
        Ok(Outcome { value, agreement, ..spelled(&tree) })
    }

    fn inputs(&self, program: &Program) -> Result<Vec<Given>, String> {
        let inputs = program.inputs.iter().map(|input| {
            let value = self.values.get(&input.name).copied();
            value.map(Given::Value).ok_or_else(|| self.why_no_value(&input.name))
        });
        inputs.collect()
    }

    /// Fails at the first name of a formula in these parameters that has no value because its line is wrong.
    fn check(&self, node: &Node, parameters: &[String]) -> Result<(), Error> {
        if let Kind::Name(name) | Kind::Call(name, _) = &node.kind
            && self.failed.contains_key(name)
            && !parameters.contains(name)
        {
            return Err(Error { message: self.why_no_value(name), span: node.span });
        }
        node.children().into_iter().try_for_each(|child| self.check(child, parameters))
    }

    fn why_no_value(&self, name: &str) -> String {
        match self.failed.get(name) {
            Some(line) => format!("`{name}` has no value, because line {line} is wrong"),
            None => format!("`{name}` has no value"),
        }
    }

    /// The formula with numbers in SI units for its quantities; it has parameters, if it is a function's.
    fn source(&self, text: &str, parameters: &[String]) -> Result<Source, Wrong> {
        let known = |name: String| self.names.get(&name).is_some() || parameters.contains(&name);
        let is_name = |word: &str| canonical(word).is_some_and(known);
        Source::read(text, is_name).map_err(|error| Wrong { message: error.message, span: error.span })
    }
}

/// The head of a line that gives a value to a name, `a = …` or `V(x) = …`, its name and parameters, and the body; `None`
/// for a formula.
fn assignment(line: &str) -> Option<(&str, String, Vec<String>, &str)> {
    let (head, body) = line.split_once('=').filter(|(_, body)| !body.starts_with('='))?;
    let (name, parameters) = heading(head).ok()?;
    Some((head, name, parameters, body))
}

/// What a name stands for whose line is wrong; nobody gets to see it.
fn placeholder(parameters: Vec<String>) -> Meaning {
    match parameters.is_empty() {
        true => Meaning::Value(Type::SCALAR),
        false => Meaning::Function(Definition { parameters, body: Node::new(Kind::Pi, Span::default()) }),
    }
}

fn spelled(tree: &Tree) -> Outcome {
    Outcome { shown: Some(tree.text(Style::Unicode)), latex: Some(tree.latex()), ..Outcome::default() }
}

/// A line without the spaces around it.
fn whole(line: &str) -> Range<usize> {
    let trimmed = line.trim_start();
    let start = line.len() - trimmed.len();
    start..start + trimmed.trim_end().len()
}

impl From<Error> for Wrong {
    fn from(error: Error) -> Wrong {
        Wrong { message: error.message, span: error.span.start..error.span.end }
    }
}

/// An error with its place in the formula as it was written.
fn placed(source: &Source, error: Error) -> Wrong {
    Wrong { message: error.message, span: source.place(error.span.start..error.span.end) }
}

/// Says more where a word that has no value may be a unit; units are read where a name gets a value.
fn about_units(wrong: Wrong, line: &str, has_units: bool) -> Wrong {
    let word = line.get(wrong.span.clone()).unwrap_or_default();
    let letters = !word.is_empty() && word.chars().all(char::is_alphabetic);
    let Some(unit) = (letters && wrong.message.contains("has no value")).then(|| units::near(word)).flatten()
    else {
        return wrong;
    };
    let before = line.get(..wrong.span.start).unwrap_or_default().trim_end();
    let after_number = before.ends_with(char::is_numeric);
    let more = match (unit == word, has_units) {
        (true, true) => format!(". The unit `{unit}` stands right after a number, as in `0.5 {unit}`"),
        (true, false) if after_number => {
            format!(". Units are read where a name gets a value, as in `x = 2 {word}`")
        }
        (false, true) if after_number => format!(". Is the unit `{unit}` meant?"),
        _ => String::new(),
    };
    Wrong { message: wrong.message + &more, ..wrong }
}
