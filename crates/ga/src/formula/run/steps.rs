//! Steps of programs in 3-d space, ready to run on single values and blocks of rows.

use crate::MathError;
use crate::formula::compile::program::{Id, InputKind, Op, Program, Step};
use crate::g3::functions::Function;
use crate::g3::rotor::Rotor;
use crate::g3::values::{Multivector, norm};
use crate::graded::Graded;
use crate::product::{Engine, Grades, Plan, Product};
use crate::rows::compose::Compose;
use crate::rows::product::{Geometric, Turn, TurnBack};
use crate::rows::rotor_functions::{self, Cos, Exp, Log, Power, Sin, Tan};
use crate::simd::map::{self, Map};
use crate::simd::{Kernel, Lane, Path, by_eights};
use crate::table::G3;
use std::borrow::Borrow;
use std::f64::consts::PI;

/// The value of an input.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    /// A value of the input's grades.
    Value(Graded),
    /// A matrix by rows.
    Matrix([f64; 9]),
    /// A determinant.
    Determinant(f64),
}

impl Given {
    /// An input of this kind, by its numbers.
    pub(crate) fn new(kind: InputKind, number: impl Fn(usize) -> f64) -> Given {
        match kind {
            InputKind::Value(ty) => Given::Value(Graded::from_fn(ty.grades, number)),
            InputKind::Matrix { .. } => Given::Matrix(std::array::from_fn(number)),
            InputKind::Determinant => Given::Determinant(number(0)),
        }
    }

    /// Its numbers.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Given::Value(value) => value.components(),
            Given::Matrix(matrix) => matrix,
            Given::Determinant(determinant) => std::slice::from_ref(determinant),
        }
    }
}

/// A step with its operands and the grades of its value.
pub(crate) struct Ready {
    pub work: Work,
    pub grades: Grades,
    operands: [Id; 2],
    count: usize,
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
    /// `~R X R`.
    TurnBack,
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
            let (mut operands, mut count) = ([0; 2], 0);
            for id in step.op.operands() {
                operands[count] = id;
                count += 1;
            }
            let mut work = Work::new(program, step);
            if let Work::Turn = work
                && let Op::Reverse(rotor) = program.steps[operands[0]].op
            {
                (work, operands[0]) = (Work::TurnBack, rotor);
            }
            Ready { work, grades: step.ty.grades, operands, count }
        };
        program.steps.iter().map(ready).collect()
    }

    /// Its operands, at most two.
    pub fn operands(&self) -> &[Id] {
        &self.operands[..self.count]
    }

    /// Computes the value from those of earlier steps.
    #[inline]
    pub fn set<G: Borrow<Given>>(
        &self,
        out: &mut Graded,
        values: &[Graded],
        input: impl Fn(usize) -> G,
    ) -> Result<(), MathError> {
        let operand = |k: usize| &values[self.operands[k]];
        let value = match &self.work {
            Work::Input(i) => match input(*i).borrow() {
                Given::Value(value) if value.grades() == self.grades => {
                    out.assign(value);
                    return Ok(());
                }
                other => panic!("input {i} is a value of the grades {:?}, got {other:?}", self.grades),
            },
            Work::Constant(value) => *value,
            Work::Sum(sum) => {
                sum.set(out, operand(0), operand(1), self.grades);
                return Ok(());
            }
            Work::Selection(selection) => selection.of(operand(0), self.grades),
            Work::Product(plan) => {
                out.set_product(plan, operand(0), operand(1));
                return Ok(());
            }
            Work::Compose => {
                let product = rotor(operand(0)).compose(rotor(operand(1))).components();
                Graded::from_fn(self.grades, |k| product[k])
            }
            Work::Turn => {
                out.set_turned(rotor(operand(0)), operand(1));
                return Ok(());
            }
            Work::TurnBack => {
                out.set_turned(rotor(operand(0)).reverse(), operand(1));
                return Ok(());
            }
            Work::Divide => {
                let divisor = number(operand(1));
                if divisor == 0.0 {
                    return Err(MathError::DivisionByZero);
                }
                operand(0).map(|x| x / divisor)
            }
            Work::Exp => known(rotor_functions::exp_one(three(operand(0))), self.grades)?,
            Work::Log => known(rotor_functions::log_one(rotor(operand(0)).components()), self.grades)?,
            Work::Power(t) => {
                known(rotor_functions::power_one(rotor(operand(0)).components(), *t), self.grades)?
            }
            Work::Function(f) => applied(*f, operand(0), self.grades)?,
            Work::Norm => Graded::from_fn(self.grades, |_| norm(operand(0).components())),
            Work::Sin => known(Sin.value([number(operand(0))], []), self.grades)?,
            Work::Cos => known(Cos.value([number(operand(0))], []), self.grades)?,
            Work::Tan => known(Tan.value([number(operand(0))], []), self.grades)?,
            Work::Map(i) => match input(*i).borrow() {
                Given::Matrix(m) => {
                    let [x, y, z] = three(operand(0));
                    Graded::from_fn(self.grades, |k| m[3 * k] * x + m[3 * k + 1] * y + m[3 * k + 2] * z)
                }
                Given::Determinant(d) => operand(0).map(|x| 0.0 + x * d),
                Given::Value(_) => panic!("input {i} is a linear map, got a value"),
            },
        };
        out.assign(&value);
        Ok(())
    }

    /// Evaluates the step for a block of rows, `count` of which matter, within work of this path. False if some row may have
    /// no value.
    #[inline(always)]
    pub fn block<const W: usize>(
        &self,
        path: Path,
        of: Grades,
        count: usize,
        (a, b, out): (&[Lane<W>], &[Lane<W>], &mut [Lane<W>]),
    ) -> bool {
        match &self.work {
            Work::Input(_) | Work::Constant(_) => {}
            Work::Sum(sum) => sum.block(a, b, out),
            Work::Selection(selection) => selection.block(a, b, out),
            Work::Product(plan) if matches!(plan.engine, Engine::Geometric) => {
                Geometric(plan).block(a, b, out)
            }
            Work::Product(plan) => plan.block(a, b, out),
            Work::Compose => Compose.block(a, b, out),
            Work::Turn => Turn(self.grades).block(a, b, out),
            Work::TurnBack => TurnBack(Turn(self.grades)).block(a, b, out),
            Work::Divide => {
                Divide.block(a, b, out);
                return b[0].0.iter().all(|x| *x != 0.0);
            }
            Work::Exp => return map::block(Exp, path, a, &[], out),
            Work::Log => return map::block(Log, path, a, &[], out),
            Work::Power(t) => return map::block(Power, path, a, &[Lane::filled(*t)], out),
            Work::Function(f) => return function(*f, [of, self.grades], a, out, count),
            Work::Norm => norms(a, &mut out[0]),
            Work::Sin => return map::block(Sin, path, a, &[], out),
            Work::Cos => return map::block(Cos, path, a, &[], out),
            Work::Tan => return map::block(Tan, path, a, &[], out),
            Work::Map(_) if b.len() == 9 => times(b, a, out),
            Work::Map(_) => scaled(&b[0], a, out),
        }
        true
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

/// The rotor of four components.
fn rotor(value: &Graded) -> Rotor {
    let c = value.components();
    Rotor::from_unit_components([c[0], c[1], c[2], c[3]])
}

/// The first component: that of a scalar.
fn number(value: &Graded) -> f64 {
    value.components()[0]
}

fn three(value: &Graded) -> [f64; 3] {
    let c = value.components();
    [c[0], c[1], c[2]]
}

/// A value of which some number was NaN for want of one.
fn known<const N: usize>(numbers: [f64; N], grades: Grades) -> Result<Graded, MathError> {
    if numbers[0].is_nan() { Err(MathError::NotFinite) } else { Ok(Graded::from_fn(grades, |k| numbers[k])) }
}

impl Sum {
    /// As [`Graded::zip`], in place.
    fn set(&self, out: &mut Graded, a: &Graded, b: &Graded, grades: Grades) {
        let (a, b) = (a.components(), b.components());
        let held = |place: Option<usize>, c: &[f64]| place.map_or(0.0, |k| c[k]);
        out.fill(grades, |k| {
            let [i, j] = self.places[k];
            held(i, a) + self.sign * held(j, b)
        });
    }
}

impl Selection {
    fn of(&self, a: &Graded, grades: Grades) -> Graded {
        let held = a.components();
        let component =
            |place: &Option<(f64, usize)>| place.map_or(0.0, |(sign, k)| sign * held[k] + self.start);
        Graded::from_fn(grades, |k| component(&self.places[k]))
    }
}

impl<const W: usize> Kernel<W> for Sum {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        let (zeros, sign) = (Lane::filled(0.0), self.sign);
        for (out, [i, j]) in out.iter_mut().zip(&self.places) {
            let held = [i.map_or(&zeros, |i| &a[i]), j.map_or(&zeros, |j| &b[j])];
            by_eights(held, out, |[x, y]| x + sign * y);
        }
    }
}

impl<const W: usize> Kernel<W> for Selection {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], _: &[Lane<W>], out: &mut [Lane<W>]) {
        let start = self.start;
        for (out, place) in out.iter_mut().zip(&self.places) {
            match *place {
                Some((sign, k)) => by_eights([&a[k]], out, |[x]| sign * x + start),
                None => *out = Lane::filled(0.0),
            }
        }
    }
}

/// Each component over the one of a scalar.
pub(crate) struct Divide;

impl<const W: usize> Kernel<W> for Divide {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        for (out, a) in out.iter_mut().zip(a) {
            by_eights([a, &b[0]], out, |[x, s]| x / s);
        }
    }
}

/// A matrix, nine lanes by rows, times three.
#[inline(always)]
fn times<const W: usize>(matrix: &[Lane<W>], a: &[Lane<W>], out: &mut [Lane<W>]) {
    let (a, matrix, out) = (&a[..3], &matrix[..9], &mut out[..3]);
    for k in 0..3 {
        let row = &matrix[3 * k..3 * k + 3];
        let factors = [&row[0], &a[0], &row[1], &a[1], &row[2], &a[2]];
        by_eights(factors, &mut out[k], |[m, x, n, y, p, z]| m * x + n * y + p * z);
    }
}

/// A number times each component.
#[inline(always)]
fn scaled<const W: usize>(number: &Lane<W>, a: &[Lane<W>], out: &mut [Lane<W>]) {
    for (out, a) in out.iter_mut().zip(a) {
        by_eights([a, number], out, |[x, s]| 0.0 + x * s);
    }
}

/// The root of the sum of squares; the sum is kept to find rows where it overflows or underflows.
#[inline(always)]
fn norms<const W: usize>(a: &[Lane<W>], out: &mut Lane<W>) {
    let mut sums = [0.0; W];
    for a in a {
        for l in 0..W {
            sums[l] += a.0[l] * a.0[l];
        }
    }
    let mut plain = true;
    for l in 0..W {
        plain &= (1e-290..1e290).contains(&sums[l]);
        out.0[l] = sums[l].sqrt();
    }
    if !plain {
        for l in 0..W {
            out.0[l] = norm(&row(a, l)[..a.len()]);
        }
    }
}

/// Row `l` of at most eight lanes.
fn row<const W: usize>(lanes: &[Lane<W>], l: usize) -> [f64; 8] {
    std::array::from_fn(|k| lanes.get(k).map_or(0.0, |lane| lane.0[l]))
}

/// Evaluates a function for the first rows, one by one; whether each has a value.
fn function<const W: usize>(
    f: Function,
    grades: [Grades; 2],
    a: &[Lane<W>],
    out: &mut [Lane<W>],
    count: usize,
) -> bool {
    (0..count).all(|l| {
        let argument = Graded::from_fn(grades[0], |k| a[k].0[l]);
        let Ok(value) = applied(f, &argument, grades[1]) else { return false };
        out.iter_mut().zip(value.components()).for_each(|(lane, x)| lane.0[l] = *x);
        true
    })
}
