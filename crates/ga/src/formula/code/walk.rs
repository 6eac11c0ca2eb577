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

/// In place of smaller lengths as a divisor: `sin(x)/x` and the like are 1 there to all digits, also in single precision.
const TINY: f64 = 1e-30;

/// A number for each basis element.
type Value = Vec<Scalar>;

pub(super) struct Walk<'a> {
    algebra: &'a Algebra,
    program: &'a Program,
    pub scalars: Scalars,
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

    fn grade(&self, index: usize) -> usize {
        self.algebra.blades()[index].grade()
    }

    fn zeros(&self) -> Value {
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
    fn by_grade(&self, value: &Value, sign: impl Fn(usize) -> i8) -> Value {
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

    fn scalar(&self, x: Scalar) -> Value {
        let mut value = self.zeros();
        value[0] = x;
        value
    }

    fn sum(&mut self, a: &Value, b: &Value) -> Value {
        a.iter().zip(b).map(|(&x, &y)| self.scalars.plus(x, y)).collect()
    }

    fn scaled(&mut self, s: Scalar, a: &Value) -> Value {
        a.iter().map(|&x| self.scalars.times(s, x)).collect()
    }

    /// A named product in some grades.
    fn product(&mut self, product: Product, a: &Value, b: &Value, grades: Grades) -> Value {
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

    fn geometric(&mut self, a: &Value, b: &Value) -> Value {
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
    fn squares(&mut self, a: &Value, sign: impl Fn(usize) -> i8) -> Scalar {
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

    // --- functions

    /// A function of one number.
    fn of_scalar(&mut self, call: Call, x: Scalar) -> Value {
        let x = self.scalars.call(call, &[x]);
        self.scalar(x)
    }

    /// Whether all pairs of components other than the scalar anticommute, so that the square of their sum is a number.
    fn anticommutes(&self, a: &Value) -> bool {
        let held: Vec<usize> = nonzero(a).map(|(i, _)| i).filter(|&i| i > 0).collect();
        let apart = |&i: &usize, &j: &usize| {
            let (there, back) = (self.algebra.basis_product(i, j).0, self.algebra.basis_product(j, i).0);
            i == j || there == -back
        };
        held.iter().all(|i| held.iter().all(|j| apart(i, j)))
    }

    /// The square of component k.
    fn square(&self, index: usize) -> i8 {
        self.algebra.basis_product(index, index).0
    }

    /// `exp(s + V) = e^s (cos θ + V sin θ/θ)` for `V² = −θ²`, with cosh and sinh for positive squares, where the square is a
    /// number.
    fn exp(&mut self, a: &Value) -> Option<Value> {
        if !self.anticommutes(a) {
            return None;
        }
        let mut v = a.clone();
        v[0] = Scalar::ZERO;
        let [plus, minus] = [1, -1].map(|sign| nonzero(&v).any(|(i, _)| self.square(i) == sign));
        let held: Vec<_> = nonzero(&v).collect();
        let mut exp = match (plus, minus, &held[..]) {
            (false, false, _) => {
                v[0] = Scalar::number(1.0);
                v
            }
            (_, _, &[(i, x)]) => {
                let (c, s) = if minus { (Call::Cos, Call::Sin) } else { (Call::Cosh, Call::Sinh) };
                let mut exp = self.zeros();
                (exp[0], exp[i]) = (self.scalars.call(c, &[x]), self.scalars.call(s, &[x]));
                exp
            }
            _ => {
                let algebra = self.algebra;
                let square = self.squares(&v, |i| algebra.basis_product(i, i).0);
                let zero = Scalar::ZERO;
                // With both signs one of the two squares is 0, and its factors are 1.
                let parts = [(plus, 1, Call::Cosh, Call::Sinh), (minus, -1, Call::Cos, Call::Sin)];
                let (mut even, mut odd) = (Scalar::number(1.0), Scalar::number(1.0));
                for (_, sign, c, s) in parts.into_iter().filter(|part| part.0) {
                    let part = square.signed(sign);
                    let part = if plus && minus { self.scalars.call(Call::Max, &[part, zero]) } else { part };
                    let length = self.scalars.call(Call::Sqrt, &[part]);
                    let divisor = self.scalars.call(Call::Max, &[length, Scalar::number(TINY)]);
                    let (c, s) = (self.scalars.call(c, &[length]), self.scalars.call(s, &[divisor]));
                    let s = self.scalars.quotient(s, divisor);
                    (even, odd) = (self.scalars.times(even, c), self.scalars.times(odd, s));
                }
                let mut exp = self.scaled(odd, &v);
                exp[0] = even;
                exp
            }
        };
        if !a[0].is_zero() {
            let factor = self.scalars.call(Call::Exp, &[a[0]]);
            exp = self.scaled(factor, &exp);
        }
        Some(exp)
    }

    /// Of `s + V` with a negative square of V: the lengths |V|, at least tiny, and `√(s² + |V|²)`.
    fn even(&mut self, a: &Value) -> Option<[Scalar; 2]> {
        let fits = self.anticommutes(a) && nonzero(a).all(|(i, _)| i == 0 || self.square(i) < 0);
        fits.then(|| {
            let of_v = self.squares(a, |i| i8::from(i > 0));
            let whole = self.squares(a, |_| 1);
            let length = self.scalars.call(Call::Sqrt, &[of_v]);
            [
                self.scalars.call(Call::Max, &[length, Scalar::number(TINY)]),
                self.scalars.call(Call::Sqrt, &[whole]),
            ]
        })
    }

    /// The angle of `s + V`, in [0, π].
    fn angle(&mut self, a: &Value, length: Scalar) -> Scalar {
        self.scalars.call(Call::Atan2, &[length, a[0]])
    }

    /// `s + V` of norm 1 to the power t: `cos tα + V sin tα/|V|`.
    fn turns(&mut self, a: &Value, [length, _]: [Scalar; 2], t: Scalar) -> Value {
        let angle = self.angle(a, length);
        let angle = self.scalars.times(t, angle);
        let sine = self.scalars.call(Call::Sin, &[angle]);
        let factor = self.scalars.quotient(sine, length);
        let mut power = self.scaled(factor, a);
        power[0] = self.scalars.call(Call::Cos, &[angle]);
        power
    }

    fn is_scalar(a: &Value) -> bool {
        nonzero(a).all(|(i, _)| i == 0)
    }

    /// `log(s + V) = log √(s² + |V|²) + V α/|V|`.
    fn log(&mut self, a: &Value, unit: bool) -> Option<Value> {
        if Walk::is_scalar(a) {
            return Some(self.of_scalar(Call::Log, a[0]));
        }
        let [length, whole] = self.even(a)?;
        let angle = self.angle(a, length);
        let factor = self.scalars.quotient(angle, length);
        let mut log = self.scaled(factor, a);
        log[0] = if unit { Scalar::ZERO } else { self.scalars.call(Call::Log, &[whole]) };
        Some(log)
    }

    fn sqrt(&mut self, a: &Value, unit: bool) -> Option<Value> {
        if Walk::is_scalar(a) {
            return Some(self.of_scalar(Call::Sqrt, a[0]));
        }
        let lengths = self.even(a)?;
        // The angle does not depend on the size, but the factor of V does.
        let half = self.turns(a, lengths, Scalar::number(0.5));
        if unit {
            return Some(half);
        }
        let size = self.scalars.call(Call::Sqrt, &[lengths[1]]);
        Some(self.scaled(size, &half))
    }

    /// A conjugate over `A` times the conjugate where that is a number whatever the components. Otherwise, with up to five
    /// generators, by products of conjugates (Hitzer and Sangwine 2017).
    fn inverse(&mut self, a: &Value, grades: Grades) -> Option<Value> {
        let signs: [fn(usize) -> i8; 4] = [reversed, conjugate, involute, |_| 1];
        for sign in signs {
            let coefficient = |i: usize| sign(self.grade(i));
            let vanishes = |i: usize, j: usize| {
                let (there, back) = (self.algebra.basis_product(i, j).0, self.algebra.basis_product(j, i).0);
                coefficient(j) * there + coefficient(i) * back == 0
            };
            let held: Vec<usize> = nonzero(a).map(|(i, _)| i).collect();
            if held.iter().all(|&i| held.iter().all(|&j| i == j || vanishes(i, j))) {
                let algebra = self.algebra;
                let square =
                    self.squares(a, |i| sign(algebra.blades()[i].grade()) * algebra.basis_product(i, i).0);
                let conjugate = self.by_grade(a, sign);
                return Some(self.divided(&conjugate, square));
            }
        }
        let mut numerator = self.by_grade(a, conjugate);
        let flipped: &[usize] = match self.algebra.signature().generators() {
            0..=4 => &[3, 4],
            5 => {
                let (hat, tilde) = (self.by_grade(a, involute), self.by_grade(a, reversed));
                numerator = self.geometric(&numerator, &hat);
                numerator = self.geometric(&numerator, &tilde);
                &[1, 4]
            }
            _ => return None,
        };
        let product = self.geometric(a, &numerator);
        let product = self.by_grade(&product, |k| if flipped.contains(&k) { -1 } else { 1 });
        let numerator = self.product(Product::Geometric, &numerator, &product, grades);
        let number = self.product(Product::Scalar, a, &numerator, Grades::SCALAR)[0];
        Some(self.divided(&numerator, number))
    }

    fn divided(&mut self, a: &Value, number: Scalar) -> Value {
        a.iter().map(|&x| self.scalars.quotient(x, number)).collect()
    }
}

fn nonzero(value: &Value) -> impl Iterator<Item = (usize, Scalar)> {
    value.iter().copied().enumerate().filter(|(_, x)| !x.is_zero())
}

/// The sign of the reverse of grade k.
fn reversed(k: usize) -> i8 {
    if k % 4 < 2 { 1 } else { -1 }
}

/// The sign of the grade involution.
fn involute(k: usize) -> i8 {
    if k.is_multiple_of(2) { 1 } else { -1 }
}

/// The sign of the Clifford conjugate.
fn conjugate(k: usize) -> i8 {
    reversed(k) * involute(k)
}
