//! Compiled formulas as functions in other languages.
//!
//! A program becomes straight-line arithmetic on numbers, the same for all languages (`walk`), which is then written down in
//! one of them (`languages`).

mod functions;
mod languages;
mod scalars;
#[cfg(test)]
mod tests;
mod walk;

pub use languages::{Language, is_function_name};

use super::Error;
use super::compile::program::{Input, InputKind, Program};
use super::syntax::commands::plain_name;
use super::syntax::names::Type;
use super::syntax::tree::{Span, listed};
use crate::product::Grades;
use crate::table::Algebra;
use languages::{Argument, Function};
use walk::Walk;

impl Language {
    /// The source of a function of this name that computes a formula, `text`. `order` has the inputs of the program in the
    /// order of the arguments. Values are arrays of components, scalars are numbers.
    ///
    /// # Errors
    /// For an equation, and at the first step that has no formula in numbers, such as the logarithm of a full multivector.
    pub fn code(
        self,
        program: &Program,
        algebra: &Algebra,
        order: &[usize],
        (name, text): (&str, &str),
    ) -> Result<String, Error> {
        if program.is_equation() {
            let message =
                "an equation has no value to compute; write the code of one side, or of the difference";
            return Err(Error::new(Span { start: 0, end: text.len() }, message));
        }
        let walk = Walk::new(program, algebra)?;
        let result = walk.result();
        let mut count = 0;
        let numbers = walk.scalars.used(&result).into_iter().map(|used| {
            count += usize::from(used);
            used.then_some(count)
        });
        let ty = program.steps[program.results[0][0]].ty;
        let mut about = vec![text.split_whitespace().collect::<Vec<_>>().join(" "), String::new()];
        let mut arguments: Vec<Argument> = Vec::new();
        let mut places = vec![0; program.inputs.len()];
        for &input in order {
            let Input { name, kind } = &program.inputs[input];
            let shared = program.inputs.iter().filter(|other| other.name == *name).count() > 1;
            let argument = Argument {
                name: self::argument(name, *kind, shared, &arguments),
                size: size(*kind, algebra),
            };
            about.push(format!("{}: {}", argument.name, described(*kind, algebra)));
            places[input] = arguments.len();
            arguments.push(argument);
        }
        about.push(format!("returns {}", described(InputKind::Value(ty), algebra)));
        let s = algebra.signature();
        about.push(format!("in Cl({},{},{}); NaN or infinite where the formula has no value", s.p, s.q, s.r));
        let numbers = numbers.collect();
        let is_number = ty.grades == Grades::SCALAR;
        let function = Function {
            name,
            about,
            arguments,
            places,
            lines: &walk.scalars.lines,
            numbers,
            result,
            is_number,
        };
        Ok(self.write(&function))
    }
}

/// The number of components of an argument; none for a plain number.
fn size(kind: InputKind, algebra: &Algebra) -> Option<usize> {
    match kind {
        InputKind::Value(ty) if ty.grades == Grades::SCALAR => None,
        InputKind::Value(ty) => Some(ty.grades.indices(algebra).len()),
        InputKind::Matrix { .. } => Some(9),
        InputKind::Determinant => None,
    }
}

/// The name of an argument in ASCII, unlike the others. Inputs of one map have different kinds.
fn argument(name: &str, kind: InputKind, shared: bool, others: &[Argument]) -> String {
    let mut name = plain_name(name);
    match kind {
        InputKind::Matrix { grade: 2 } if shared => name += "_bivectors",
        InputKind::Determinant => name += "_determinant",
        _ => {}
    }
    while !is_function_name(&name) || others.iter().any(|other| other.name == name) {
        name += if name.ends_with('_') { "1" } else { "_" };
    }
    name
}

/// `vector, components e1, e2, e3`
fn described(kind: InputKind, algebra: &Algebra) -> String {
    match kind {
        InputKind::Value(Type { grades: Grades::SCALAR, .. }) => "number".to_owned(),
        InputKind::Value(ty) => {
            let list = listed(ty.grades);
            let kind = match (ty.unit, &list[..]) {
                (true, _) => "rotor".to_owned(),
                (_, [grade]) => format!("grade {grade}"),
                _ => format!("grades {}", list.join(", ")),
            };
            format!("{kind}, components {}", basis(ty.grades, algebra))
        }
        InputKind::Matrix { grade } => {
            format!("linear map, its 3x3 matrix by rows on {}", basis(Grades(1 << grade), algebra))
        }
        InputKind::Determinant => "determinant of the linear map".to_owned(),
    }
}

/// The names of the basis elements of some grades.
fn basis(grades: Grades, algebra: &Algebra) -> String {
    let name = |index: usize| {
        let blade = algebra.blades()[index];
        let digits = (0..8).filter(|i| blade.bits >> i & 1 == 1).map(|i| (i + 1).to_string());
        let digits: String = if blade.sign < 0 { digits.rev().collect() } else { digits.collect() };
        if digits.is_empty() { "1".to_owned() } else { format!("e{digits}") }
    };
    grades.indices(algebra).into_iter().map(name).collect::<Vec<_>>().join(", ")
}
