//! Rules of operations: grades of their values, and simplifications at compile time.

use super::builder::{Builder, Built};
use super::program::{Id, Op, union};
use crate::formula::syntax::names::Type;
use crate::formula::syntax::number::Number;
use crate::formula::syntax::tree::Span;
use crate::g3::functions::Function;
use crate::product::{Grades, Plan, Product};
use std::collections::HashMap;

impl Builder<'_> {
    pub fn negate(&mut self, id: Id, span: Span) -> Built {
        match self.program.steps[id].op {
            Op::Constant(number, index) => self.constant(number.negated(), index, span),
            Op::Negate(x) => Ok(x),
            Op::Product(Product::Geometric, s, x)
                if self.is_constant(s).is_some_and(|(_, index)| index == 0) =>
            {
                let s = self.negate(s, span)?;
                let ty = self.ty(id);
                self.step(Op::Product(Product::Geometric, s, x), ty, span)
            }
            _ => self.step(Op::Negate(id), self.ty(id), span),
        }
    }

    pub fn add(&mut self, minus: bool, a: Id, b: Id, span: Span) -> Built {
        let ty = Type::of(union(self.ty(a).grades, self.ty(b).grades));
        self.step(if minus { Op::Subtract(a, b) } else { Op::Add(a, b) }, ty, span)
    }

    pub fn reverse(&mut self, id: Id, span: Span) -> Built {
        if let Op::Reverse(x) = self.program.steps[id].op {
            return Ok(x);
        }
        let ty = self.ty(id);
        if ty.grades.within(self.kept_by_reversal(true)) {
            return Ok(id);
        }
        match self.is_constant(id) {
            Some((number, index)) => self.constant(number.negated(), index, span),
            None => self.step(Op::Reverse(id), ty, span),
        }
    }

    /// The grades that reversal keeps, or those whose sign it changes.
    fn kept_by_reversal(&self, kept: bool) -> Grades {
        let grades = (0..=self.count()).filter(|k| (k % 4 < 2) == kept);
        Grades(grades.map(|k| 1 << k).sum::<u16>())
    }

    /// A named product without the grades that are known to vanish.
    pub fn product(&mut self, product: Product, a: Id, b: Id, only: Grades, span: Span) -> Built {
        if let (Some((m, i)), Some((n, j))) = (self.is_constant(a), self.is_constant(b)) {
            let (sign, index) = product.of_basis(self.space.algebra, i, j);
            let number = m.times(n).times(Number::whole(i32::from(sign)));
            return self.constant(number, if sign == 0 { 0 } else { index }, span);
        }
        let (s, t) = (self.ty(a), self.ty(b));
        if product == Product::Geometric && s.unit && t.unit {
            return self.step(Op::Compose(a, b), Type::ROTOR, span);
        }
        let mut grades = Plan::new(self.space.algebra, product, s.grades, t.grades).grades;
        if a == b && product == Product::Geometric && self.symmetry(s.grades).is_some() {
            // (XX)~ = ~X~X = XX for ~X = ±X.
            grades.0 &= self.kept_by_reversal(true).0;
        }
        grades.0 &= only.0;
        if grades.0 == 0 {
            return self.constant(Number::whole(0), 0, span);
        }
        self.step(Op::Product(product, a, b), Type::of(grades), span)
    }

    pub fn times(&mut self, a: Id, b: Id, span: Span) -> Built {
        self.product(Product::Geometric, a, b, self.all(), span)
    }

    /// Whether reversal keeps all these grades or negates all; none if it does neither.
    fn symmetry(&self, grades: Grades) -> Option<bool> {
        [true, false].into_iter().find(|&kept| grades.within(self.kept_by_reversal(kept)))
    }

    /// The geometric product of several factors. Scalars are multiplied first, since they commute; a factor
    /// and its reverse form a sandwich with the factors between them, which keeps the grades that reversal does.
    pub fn chain(&mut self, factors: &[Id], span: Span) -> Built {
        let (mut scalar, mut number) = (None, Number::whole(1));
        let mut stack: Vec<Id> = Vec::new();
        let mut places: HashMap<Id, Vec<usize>> = HashMap::new();
        for &factor in factors {
            if let Some((n, 0)) = self.is_constant(factor) {
                number = number.times(n);
            } else if self.ty(factor).grades == Grades::SCALAR {
                scalar = Some(match scalar {
                    None => factor,
                    Some(before) => self.times(before, factor, span)?,
                });
            } else {
                let open = self.known_reverse(factor).and_then(|r| places.get_mut(&r)).and_then(Vec::pop);
                if let Some(at) =
                    open.filter(|&at| at + 1 < stack.len() && self.ty(stack[at]).grades != Grades::SCALAR)
                {
                    let middle = stack.split_off(at + 1);
                    let middle = self.row(&middle, span)?;
                    let outer = stack[at];
                    stack.pop();
                    places.values_mut().for_each(|places| places.retain(|&place| place < at));
                    stack.push(self.sandwich(outer, middle, factor, span)?);
                } else {
                    places.entry(factor).or_default().push(stack.len());
                    stack.push(factor);
                }
            }
        }
        if let Some(s) = scalar
            && number != Number::whole(1)
        {
            let n = self.constant(number, 0, span)?;
            scalar = Some(self.times(n, s, span)?);
            number = Number::whole(1);
        }
        if stack.is_empty() {
            return match scalar {
                Some(s) => Ok(s),
                None => self.constant(number, 0, span),
            };
        }
        let rest = self.row(&stack, span)?;
        match scalar {
            Some(s) => self.times(s, rest, span),
            None if number == Number::whole(1) => Ok(rest),
            None if number == Number::whole(-1) => self.negate(rest, span),
            None => {
                let n = self.constant(number, 0, span)?;
                self.times(n, rest, span)
            }
        }
    }

    /// Factors multiplied from left to right.
    fn row(&mut self, factors: &[Id], span: Span) -> Built {
        let mut product = factors[0];
        for &factor in &factors[1..] {
            product = self.times(product, factor, span)?;
        }
        Ok(product)
    }

    /// `A X ~A`.
    fn sandwich(&mut self, a: Id, x: Id, reversed: Id, span: Span) -> Built {
        if self.ty(a).unit {
            let ty = self.ty(x);
            return self.step(Op::Turn(a, x), ty, span);
        }
        let left = self.times(a, x, span)?;
        // (A X ~A)~ = A ~X ~A
        let only = match self.symmetry(self.ty(x).grades) {
            Some(kept) => self.kept_by_reversal(kept),
            None => self.all(),
        };
        self.product(Product::Geometric, left, reversed, only, span)
    }

    pub fn inverse(&mut self, id: Id, span: Span) -> Built {
        if self.ty(id).unit {
            return self.reverse(id, span);
        }
        if let Some((number, 0)) = self.is_constant(id) {
            let inverse = Number::whole(1).over(number);
            let inverse = inverse.ok_or_else(|| self.error(span, "division by zero"))?;
            return self.constant(inverse, 0, span);
        }
        self.function(Function::Inverse, id, span)
    }

    pub fn function(&mut self, f: Function, id: Id, span: Span) -> Built {
        let ty = self.ty(id);
        let rotor = self.space.is_g3()
            && match f {
                Function::Exp => ty.grades == Grades::BIVECTOR,
                Function::Sqrt => ty.unit,
                Function::Log | Function::Inverse => false,
            };
        let ty = if rotor {
            Type::ROTOR
        } else if f == Function::Log && ty.unit {
            Type::of(Grades::BIVECTOR)
        } else {
            Type::of(self.space.grades(f, ty.grades))
        };
        self.step(Op::Function(f, id), ty, span)
    }

    pub fn divide(&mut self, a: Id, b: Id, span: Span) -> Built {
        if self.ty(b).grades != Grades::SCALAR {
            let inverse = self.inverse(b, span)?;
            return self.chain(&[a, inverse], span);
        }
        if let Some((divisor, _)) = self.is_constant(b) {
            if divisor.value == 0.0 {
                return Err(self.error(span, "division by zero"));
            }
            if let Some((number, index)) = self.is_constant(a)
                && let Some(quotient) = number.over(divisor)
            {
                return self.constant(quotient, index, span);
            }
        }
        self.step(Op::Divide(a, b), Type::of(self.ty(a).grades), span)
    }

    /// A power by squaring.
    pub fn power(&mut self, id: Id, n: i32, span: Span) -> Built {
        if n == 0 {
            return self.constant(Number::whole(1), 0, span);
        }
        if self.ty(id).unit && n != 1 && n != -1 {
            return self.step(Op::RotorPower(id, n), Type::ROTOR, span);
        }
        let mut base = if n < 0 { self.inverse(id, span)? } else { id };
        let mut exponent = n.unsigned_abs();
        let mut result = None;
        loop {
            if exponent & 1 == 1 {
                result = Some(match result {
                    None => base,
                    Some(before) => self.times(before, base, span)?,
                });
            }
            exponent >>= 1;
            match result {
                Some(result) if exponent == 0 => return Ok(result),
                _ => base = self.times(base, base, span)?,
            }
        }
    }

    pub fn part(&mut self, id: Id, grades: Grades, span: Span) -> Built {
        let ty = self.ty(id);
        if ty.grades == grades {
            return Ok(id);
        }
        // Only the requested grades of a product are computed.
        if let Op::Product(product, a, b) = self.program.steps[id].op
            && grades.within(ty.grades)
        {
            return self.step(Op::Product(product, a, b), Type::of(grades), span);
        }
        self.step(Op::Part(id), Type::of(grades), span)
    }

    pub fn dual(&mut self, id: Id, back: bool, span: Span) -> Built {
        if self.space.algebra.signature().r > 0 {
            return Err(self.error(span, "no dual: a generator squares to zero, so I has no inverse"));
        }
        let (n, ty) = (self.count(), self.ty(id));
        let grades = (0..=n).filter(|&k| ty.grades.contains(n - k)).map(|k| 1 << k).sum::<u16>();
        self.step(if back { Op::Undual(id) } else { Op::Dual(id) }, Type::of(Grades(grades)), span)
    }

    /// Marks steps that are 0 for all values: 0 itself, its products and sums.
    pub fn zeros(&self) -> Vec<bool> {
        let mut zeros = Vec::new();
        for step in &self.program.steps {
            zeros.push(match step.op {
                Op::Constant(number, _) => number.value == 0.0,
                Op::Product(_, a, b) => zeros[a] || zeros[b],
                Op::Add(a, b) | Op::Subtract(a, b) => zeros[a] && zeros[b],
                Op::Negate(a) | Op::Reverse(a) | Op::Part(a) | Op::Dual(a) | Op::Undual(a) => zeros[a],
                _ => false,
            });
        }
        zeros
    }
}
