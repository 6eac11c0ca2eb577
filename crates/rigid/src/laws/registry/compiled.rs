//! Laws computed by the formulas of their entries, which are compiled once.

use super::{Entry, Kernel, Shape, TORQUES};
use crate::error::TorqueError;
use crate::laws::formula::{Formula, Purpose};
use crate::laws::torque::{Axes, FormulaLaw, Torque};
use polhode_ga::formula::{Error, Given, Input, Meaning, Names, Type};
use polhode_ga::product::Grades;
use polhode_ga::{Graded, Vector};
use std::sync::LazyLock;

/// The formulas of an entry, with all arguments 0.
struct Compiled {
    torque: Formula,
    potential: Option<Formula>,
    size: Formula,
}

static COMPILED: LazyLock<Vec<Option<Result<Compiled, TorqueError>>>> =
    LazyLock::new(|| TORQUES.iter().map(compiled).collect());

fn compiled(entry: &Entry<Torque>) -> Option<Result<Compiled, TorqueError>> {
    let Kernel::Formula { size, potential, .. } = entry.kernel else { return None };
    let zeros = vec![0.0; entry.arguments.iter().map(|argument| argument.shape.size()).sum()];
    let mut names = Names::default();
    for argument in entry.arguments {
        names.bind(argument.name.to_owned(), Meaning::Value(Type::of(grades(argument.shape))));
    }
    let compile = || {
        let value = |input: &Input| given(entry, &zeros, input);
        let formula = |text, purpose| Formula::new(text, purpose, names.clone(), value);
        let scalar = |text| formula(text, Purpose::Event);
        Ok(Compiled {
            torque: formula(entry.formula, Purpose::Torque(Axes::Body))?,
            potential: if potential.is_empty() { None } else { Some(scalar(potential)?) },
            size: scalar(size)?,
        })
    };
    let failed = |error: Error| TorqueError::new(format!("a formula of {}: {}", entry.name, error.message));
    Some(compile().map_err(failed))
}

fn grades(shape: Shape) -> Grades {
    match shape {
        Shape::Vector => Grades(0b0010),
        Shape::Bivector => Grades::BIVECTOR,
        Shape::Rotor => Grades::EVEN,
        _ => Grades::SCALAR,
    }
}

/// The value of an input of a formula.
fn given(entry: &Entry<Torque>, numbers: &[f64], input: &Input) -> Option<Given> {
    let (argument, own) = entry.split(numbers).find(|(argument, _)| argument.name == input.name)?;
    Graded::new(own, grades(argument.shape)).map(Given::Value)
}

/// Constructs the law from the numbers of all arguments.
pub(super) fn law(entry: &'static Entry<Torque>, numbers: &[f64]) -> Result<FormulaLaw, TorqueError> {
    let compiled = TORQUES.iter().zip(&*COMPILED).find(|(other, _)| other.name == entry.name);
    let (Kernel::Formula { axis, .. }, Some((_, Some(compiled)))) = (&entry.kernel, compiled) else {
        return Err(TorqueError::new(format!("{} is not computed by a formula", entry.name)));
    };
    let Compiled { torque, potential, size } = compiled.as_ref().map_err(Clone::clone)?;
    let value = |input: &Input| given(entry, numbers, input);
    let axis = entry.split(numbers).find(|(argument, _)| argument.name == *axis);
    Ok(FormulaLaw {
        name: entry.name,
        numbers: numbers.to_vec(),
        torque: torque.with_values(value),
        potential: potential.as_ref().map(|potential| potential.with_values(value)),
        size: size.with_values(value).constant()?,
        axis: axis.and_then(|(_, own)| own.try_into().ok().map(Vector)),
    })
}
