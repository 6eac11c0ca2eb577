//! Steps of programs in 3-d space, ready to run on single values and blocks of rows.

use crate::MathError;
use crate::formula::compile::program::{Id, Op, Program, Step};
use crate::g3::functions::Function;
use crate::g3::values::Multivector;
use crate::graded::Graded;
use crate::product::{Grades, Plan, Product};
use crate::table::G3;
use std::f64::consts::PI;

/// A step with its operands and the grades of its value.
pub(crate) struct Ready {
    pub work: Work,
    pub operands: Operands,
    pub grades: Grades,
}

/// The operands of a step, at most two.
#[derive(Clone, Copy)]
pub(crate) struct Operands {
    ids: [Id; 2],
    count: usize,
}

impl Operands {
    fn new(ids: impl Iterator<Item = Id>) -> Operands {
        ids.fold(Operands { ids: [0; 2], count: 0 }, |Operands { mut ids, count }, id| {
            ids[count] = id;
            Operands { ids, count: count + 1 }
        })
    }
}

impl std::ops::Deref for Operands {
    type Target = [Id];

    fn deref(&self) -> &[Id] {
        &self.ids[..self.count]
    }
}

/// The operation.
pub(crate) enum Work {
    Input(usize),
    Constant(Graded),
    Sum(Sum),
    Selection(Selection),
    Product(Plan),
    Compose,
    Turn,
    Divide,
    /// exp of a bivector.
    Exp,
    /// log of a rotor.
    Log,
    /// `exp(t log R)`
    Power(f64),
    Function(Function),
    Norm,
    Sin,
    Cos,
    Tan,
    /// A linear map by the matrix or determinant of this input.
    Map(usize),
}

/// `A + sign B` over the grades of both: the places of each component in A and in B, if present.
pub(crate) struct Sum {
    pub places: Vec<[Option<usize>; 2]>,
    pub sign: f64,
}

/// Components of one value, or zeros, with signs.
pub(crate) struct Selection {
    /// For each component, the sign and the place in A.
    pub places: Vec<Option<(f64, usize)>>,
    /// Added to each: −0 changes nothing, 0 makes a −0 a 0, as the sums of products begin with it.
    pub start: f64,
}

impl Selection {
    /// Each component of `grades` from a basis element of the argument, given by a function.
    fn new(of: Grades, grades: Grades, start: f64, from: impl Fn(usize) -> (f64, usize)) -> Selection {
        let held = of.indices(&G3);
        let place = |&k: &usize| {
            let (sign, index) = from(k);
            Some((sign, held.binary_search(&index).ok()?))
        };
        Selection { places: grades.indices(&G3).iter().map(place).collect(), start }
    }
}

/// The value of a function in the grades that it has for an argument of this kind.
pub(crate) fn applied(f: Function, a: &Graded, grades: Grades) -> Result<Graded, MathError> {
    let Multivector(full) = f.apply(Multivector(a.full()))?;
    Ok(Graded::from_fn(Grades::ALL, |k| full[k]).with_grades(grades))
}

impl Ready {
    /// The steps of a program of 3-d space.
    pub fn steps(program: &Program) -> Vec<Ready> {
        let ready = |step: &Step| {
            let operands = Operands::new(step.op.operands());
            Ready { work: Work::new(program, step), operands, grades: step.ty.grades }
        };
        program.steps.iter().map(ready).collect()
    }
}

impl Work {
    fn new(program: &Program, step: &Step) -> Work {
        let of = |id: Id| program.steps[id].ty.grades;
        let grades = step.ty.grades;
        let sum = |a, b, sign| {
            let held = [of(a).indices(&G3), of(b).indices(&G3)];
            let place = |k| held.each_ref().map(|held| held.binary_search(k).ok());
            Work::Sum(Sum { places: grades.indices(&G3).iter().map(place).collect(), sign })
        };
        let select = |a, start, from: &dyn Fn(usize) -> (f64, usize)| {
            Work::Selection(Selection::new(of(a), grades, start, from))
        };
        let reverse = |a| select(a, -0.0, &|k| (if k >= 4 { -1.0 } else { 1.0 }, k));
        match step.op {
            Op::Input(input) => Work::Input(input),
            Op::Constant(number, index) => {
                let place = grades.indices(&G3).iter().position(|&k| k == index);
                Work::Constant(Graded::from_fn(grades, |k| if Some(k) == place { number.value } else { 0.0 }))
            }
            Op::Pi => Work::Constant(Graded::from_fn(Grades::SCALAR, |_| PI)),
            Op::Add(a, b) => sum(a, b, 1.0),
            Op::Subtract(a, b) => sum(a, b, -1.0),
            Op::Negate(a) => select(a, -0.0, &|k| (-1.0, k)),
            Op::Reverse(a) => reverse(a),
            Op::Part(a) => select(a, -0.0, &|k| (1.0, k)),
            // By I⁻¹ = −I and by I, the product of component k with which is component 7 − k in the end.
            Op::Dual(a) => select(a, 0.0, &|k| dual(-1.0, k)),
            Op::Undual(a) => select(a, 0.0, &|k| dual(1.0, k)),
            Op::Product(product, a, b) => Work::Product(Plan::g3(product, of(a), of(b)).part(&G3, grades)),
            Op::Compose(..) => Work::Compose,
            Op::Turn(..) => Work::Turn,
            Op::Divide(..) => Work::Divide,
            Op::Function(f, a) => match f {
                Function::Exp if of(a) == Grades::BIVECTOR => Work::Exp,
                Function::Log if program.steps[a].ty.unit => Work::Log,
                Function::Sqrt if program.steps[a].ty.unit => Work::Power(0.5),
                Function::Inverse if program.steps[a].ty.unit => reverse(a),
                _ => Work::Function(f),
            },
            Op::RotorPower(_, n) => Work::Power(f64::from(n)),
            Op::Norm(_) => Work::Norm,
            Op::Sin(_) => Work::Sin,
            Op::Cos(_) => Work::Cos,
            Op::Tan(_) => Work::Tan,
            Op::Map { input, .. } => Work::Map(input),
        }
    }
}

/// The sign and the basis element from which component k of `sign A I` comes.
fn dual(sign: f64, k: usize) -> (f64, usize) {
    let from = (0..8).find(|&i| G3.basis_product(i, 7).1 == k).unwrap_or(k);
    (sign * f64::from(Product::Geometric.of_basis(&G3, from, 7).0), from)
}
