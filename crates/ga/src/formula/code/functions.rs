//! Functions of multivectors in numbers, where the square of a value or its product with a conjugate is a number.

use super::scalars::{Call, Scalar};
use super::walk::{Value, Walk, nonzero, reversed};
use crate::product::{Grades, Product};

/// In place of smaller lengths as a divisor: `sin(x)/x` and the like are 1 there to all digits, also in single precision.
const TINY: f64 = 1e-30;

impl Walk<'_> {
    /// A function of one number.
    pub(super) fn of_scalar(&mut self, call: Call, x: Scalar) -> Value {
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
    pub(super) fn exp(&mut self, a: &Value) -> Option<Value> {
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
    pub(super) fn even(&mut self, a: &Value) -> Option<[Scalar; 2]> {
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
    pub(super) fn turns(&mut self, a: &Value, [length, _]: [Scalar; 2], t: Scalar) -> Value {
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
    pub(super) fn log(&mut self, a: &Value, unit: bool) -> Option<Value> {
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

    pub(super) fn sqrt(&mut self, a: &Value, unit: bool) -> Option<Value> {
        if Walk::is_scalar(a) {
            return Some(self.of_scalar(Call::Sqrt, a[0]));
        }
        let lengths = self.even(a)?;
        // Neither the angle nor V/|V| depends on the size.
        let half = self.turns(a, lengths, Scalar::number(0.5));
        if unit {
            return Some(half);
        }
        let size = self.scalars.call(Call::Sqrt, &[lengths[1]]);
        Some(self.scaled(size, &half))
    }

    /// A conjugate over `A` times the conjugate where that is a number whatever the components. Otherwise, with up to five
    /// generators, by products of conjugates (Hitzer and Sangwine 2017).
    pub(super) fn inverse(&mut self, a: &Value, grades: Grades) -> Option<Value> {
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

    pub(super) fn divided(&mut self, a: &Value, number: Scalar) -> Value {
        a.iter().map(|&x| self.scalars.quotient(x, number)).collect()
    }
}

/// The sign of the grade involution.
fn involute(k: usize) -> i8 {
    if k.is_multiple_of(2) { 1 } else { -1 }
}

/// The sign of the Clifford conjugate.
fn conjugate(k: usize) -> i8 {
    reversed(k) * involute(k)
}
