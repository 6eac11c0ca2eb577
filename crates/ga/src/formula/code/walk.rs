//! Walker from programs to straight-line arithmetic, in any algebra.
//!
//! A value is a number for each basis element, zeros included; the arithmetic drops products with zeros. So the grades of
//! values need no further attention, and constants such as `e1` cost nothing.

use super::scalars::{Atom, Call, Scalar, Scalars};
use crate::formula::Error;
use crate::formula::compile::program::{InputKind, Op, Program, Step};
use crate::formula::syntax::tree::listed;
use crate::g3::functions::Function;
use crate::product::{Grades, Product};
use crate::table::Algebra;

/// Maximum number of terms of all sums.
const MAX_TERMS: usize = 200_000;

/// A number for each basis element.
pub(super) type Value = Vec<Scalar>;

pub(super) struct Walk<'a> {
    pub(super) algebra: &'a Algebra,
    program: &'a Program,
    pub(super) scalars: Scalars,
    values: Vec<Value>,
}

impl<'a> Walk<'a> {
    /// Walks through all steps.
    ///
    /// # Errors
    /// At the first step that has no formula in numbers.
    pub fn new(program: &'a Program, algebra: &'a Algebra) -> Result<Walk<'a>, Error> {
        let mut walk = Walk { algebra, program, scalars: Scalars::default(), values: Vec::new() };
        for step in &program.steps {
            let value = walk.step(step).map_err(|message| Error::new(step.span, message))?;
            if walk.scalars.terms > MAX_TERMS {
                let message = format!("the code would have more than {MAX_TERMS} terms");
                return Err(Error::new(step.span, message));
            }
            walk.values.push(walk.part(&value, step.ty.grades));
        }
        Ok(walk)
    }

    /// The components of the result.
    pub fn result(&self) -> Vec<Scalar> {
        let id = self.program.results[0][0];
        let held = self.program.steps[id].ty.grades.indices(self.algebra);
        held.into_iter().map(|k| self.values[id][k]).collect()
    }

    pub(super) fn grade(&self, index: usize) -> usize {
        self.algebra.blades()[index].grade()
    }

    pub(super) fn zeros(&self) -> Value {
        vec![Scalar::ZERO; self.algebra.blades().len()]
    }

    /// A value with these components of these grades.
    fn of(&self, grades: Grades, component: impl Fn(usize) -> Scalar) -> Value {
        let mut value = self.zeros();
        grades.indices(self.algebra).into_iter().enumerate().for_each(|(k, i)| value[i] = component(k));
        value
    }

    fn part(&self, value: &Value, grades: Grades) -> Value {
        let kept = |(i, &x): (usize, &Scalar)| if grades.contains(self.grade(i)) { x } else { Scalar::ZERO };
        value.iter().enumerate().map(kept).collect()
    }

    /// Each part times a sign that depends on its grade.
    pub(super) fn by_grade(&self, value: &Value, sign: impl Fn(usize) -> i8) -> Value {
        value.iter().enumerate().map(|(i, x)| x.signed(sign(self.grade(i)))).collect()
    }

    fn step(&mut self, step: &Step) -> Result<Value, String> {
        let grades = step.ty.grades;
        let mut operands = step.op.operands().map(|id| self.values[id].clone());
        let (a, b) = (operands.next().unwrap_or_default(), operands.next().unwrap_or_default());
        drop(operands);
        Ok(match step.op {
            Op::Input(input) => self.of(grades, |k| Scalar::new(Atom::Component(input, k))),
            Op::Constant(number, index) => {
                let mut constant = self.zeros();
                constant[index] = Scalar::number(number.value);
                constant
            }
            Op::Pi => self.scalar(Scalar::number(std::f64::consts::PI)),
            Op::Add(..) => self.sum(&a, &b),
            Op::Subtract(..) => {
                let b = self.by_grade(&b, |_| -1);
                self.sum(&a, &b)
            }
            Op::Negate(_) => self.by_grade(&a, |_| -1),
            Op::Reverse(_) => self.by_grade(&a, reversed),
            Op::Part(_) => a,
            Op::Product(product, ..) => self.product(product, &a, &b, grades),
            Op::Compose(..) => self.product(Product::Geometric, &a, &b, grades),
            Op::Turn(..) => self.turned(&a, &b),
            Op::Dual(_) => self.times_pseudoscalar(&a, true),
            Op::Undual(_) => self.times_pseudoscalar(&a, false),
            Op::Divide(..) => self.divided(&a, b[0]),
            Op::Norm(_) => self.norm(&a),
            Op::Sin(_) => self.of_scalar(Call::Sin, a[0]),
            Op::Cos(_) => self.of_scalar(Call::Cos, a[0]),
            Op::Tan(_) => self.of_scalar(Call::Tan, a[0]),
            Op::Map { input, .. } => self.mapped(input, &a),
            Op::RotorPower(_, n) => {
                let lengths = self.even(&a).ok_or("this power has no formula in numbers")?;
                self.turns(&a, lengths, Scalar::number(n.into()))
            }
            Op::Function(function, id) => {
                let ty = self.program.steps[id].ty;
                let applied = match function {
                    Function::Exp => self.exp(&a),
                    Function::Log => self.log(&a, ty.unit),
                    Function::Sqrt => self.sqrt(&a, ty.unit),
                    Function::Inverse => self.inverse(&a, grades),
                };
                applied.ok_or_else(|| self.missing(function, ty.grades))?
            }
        })
    }

    fn missing(&self, function: Function, grades: Grades) -> String {
        let list = listed(grades);
        let (s, n) = (if list.len() == 1 { "" } else { "s" }, self.algebra.signature());
        format!(
            "`{}` of grade{s} {} in Cl({},{},{}) has no formula in numbers; compute it outside the code and give its \
             value by a name",
            function.name(),
            list.join(", "),
            n.p,
            n.q,
            n.r
        )
    }

    // --- sums and products

    pub(super) fn scalar(&self, x: Scalar) -> Value {
        let mut value = self.zeros();
        value[0] = x;
        value
    }

    fn sum(&mut self, a: &Value, b: &Value) -> Value {
        a.iter().zip(b).map(|(&x, &y)| self.scalars.plus(x, y)).collect()
    }

    pub(super) fn scaled(&mut self, s: Scalar, a: &Value) -> Value {
        a.iter().map(|&x| self.scalars.times(s, x)).collect()
    }

    /// A named product in some grades.
    pub(super) fn product(&mut self, product: Product, a: &Value, b: &Value, grades: Grades) -> Value {
        let mut sums = vec![Vec::new(); a.len()];
        for (i, x) in nonzero(a) {
            for (j, y) in nonzero(b) {
                let (sign, k) = product.of_basis(self.algebra, i, j);
                if sign != 0 && grades.contains(self.grade(k)) {
                    sums[k].push((x.signed(sign), y));
                }
            }
        }
        sums.into_iter().map(|terms| self.scalars.sum(terms)).collect()
    }

    pub(super) fn geometric(&mut self, a: &Value, b: &Value) -> Value {
        self.product(Product::Geometric, a, b, Grades(u16::MAX))
    }

    /// A I⁻¹, or A I.
    fn times_pseudoscalar(&mut self, a: &Value, inverse: bool) -> Value {
        let last = a.len() - 1;
        let (square, _) = self.algebra.basis_product(last, last);
        let mut value = self.zeros();
        for (i, x) in nonzero(a) {
            let (sign, k) = self.algebra.basis_product(i, last);
            value[k] = x.signed(if inverse { sign * square } else { sign });
        }
        value
    }

    /// `Σ sign_k x_k²`, of the components with a sign other than 0.
    pub(super) fn squares(&mut self, a: &Value, sign: impl Fn(usize) -> i8) -> Scalar {
        let terms: Vec<_> =
            nonzero(a).filter(|&(i, _)| sign(i) != 0).map(|(i, x)| (x.signed(sign(i)), x)).collect();
        self.scalars.sum(terms)
    }

    fn norm(&mut self, a: &Value) -> Value {
        let algebra = self.algebra;
        // The sign of `E ~E`.
        let sign = |i: usize| algebra.basis_product(i, i).0 * reversed(algebra.blades()[i].grade());
        let mut square = self.squares(a, sign);
        if nonzero(a).any(|(i, _)| sign(i) < 0) {
            square = self.scalars.call(Call::Abs, &[square]);
        }
        self.of_scalar(Call::Sqrt, square)
    }

    /// `R X ~R` in 3-d space for `R = s + B`: scalar and trivector stay. With the cross product of components `u = a × B`, a
    /// vector, and the dual of a bivector, becomes `a + 2 (s u + u × B)`.
    fn turned(&mut self, rotor: &Value, x: &Value) -> Value {
        let (s, b) = (rotor[0], [rotor[4], rotor[5], rotor[6]]);
        let mut turned = x.clone();
        for at in [1, 4] {
            let a = [x[at], x[at + 1], x[at + 2]];
            if a.iter().all(|x| x.is_zero()) {
                continue;
            }
            let u = [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                self.scalars.sum([(b[k], a[j]), (b[j].signed(-1), a[k])])
            });
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let half = self.scalars.sum([(s, u[i]), (b[k], u[j]), (b[j].signed(-1), u[k])]);
                turned[at + i] = self.scalars.sum([(Scalar::number(1.0), a[i]), (Scalar::number(2.0), half)]);
            }
        }
        turned
    }

    /// A linear map by its matrix or determinant.
    fn mapped(&mut self, input: usize, x: &Value) -> Value {
        let entry = |k| Scalar::new(Atom::Component(input, k));
        let mut image = self.zeros();
        match self.program.inputs[input].kind {
            InputKind::Matrix { grade } => {
                let at = if grade == 1 { 1 } else { 4 };
                for i in 0..3 {
                    image[at + i] = self.scalars.sum((0..3).map(|j| (entry(3 * i + j), x[at + j])));
                }
            }
            _ => image[7] = self.scalars.times(entry(0), x[7]),
        }
        image
    }
}

pub(super) fn nonzero(value: &Value) -> impl Iterator<Item = (usize, Scalar)> {
    value.iter().copied().enumerate().filter(|(_, x)| !x.is_zero())
}

/// The sign of the reverse of grade k.
pub(super) fn reversed(k: usize) -> i8 {
    if k % 4 < 2 { 1 } else { -1 }
}
