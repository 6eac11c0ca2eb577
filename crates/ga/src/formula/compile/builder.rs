//! Builder of programs: shares equal steps, infers grades, simplifies, and drops unused steps.

use super::program::{Id, Input, InputKind, Op, Program, Step};
use crate::formula::syntax::names::Type;
use crate::formula::syntax::number::Number;
use crate::formula::syntax::tree::Span;
use crate::formula::{Error, MAX_NODES, Space};
use crate::g3::functions::Function;
use crate::product::{Grades, Plan, Product};
use std::collections::HashMap;

/// A program under construction.
pub(crate) struct Builder<'a> {
    pub space: Space<'a>,
    pub program: Program,
    /// The place of the steps that are added.
    pub span: Span,
    known: HashMap<(Op, Type), Id>,
}

pub(crate) type Built = Result<Id, Error>;

impl<'a> Builder<'a> {
    pub fn new(space: Space<'a>) -> Builder<'a> {
        let signature = space.algebra.signature();
        let program = Program { signature, inputs: Vec::new(), steps: Vec::new(), results: Vec::new() };
        Builder { space, program, span: Span::default(), known: HashMap::new() }
    }
}

impl Builder<'_> {
    pub fn count(&self) -> usize {
        self.space.algebra.signature().generators()
    }

    pub fn all(&self) -> Grades {
        Grades((1 << (self.count() + 1)) - 1)
    }

    pub fn ty(&self, id: Id) -> Type {
        self.program.steps[id].ty
    }

    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::new(self.span, message)
    }

    /// Adds a step, or finds an equal one.
    pub fn step(&mut self, op: Op, ty: Type) -> Built {
        if let Some(&id) = self.known.get(&(op, ty)) {
            return Ok(id);
        }
        let id = self.program.steps.len();
        if id >= MAX_NODES {
            let message =
                format!("the formula has more than {MAX_NODES} steps, with definitions and sums expanded");
            return Err(self.error(message));
        }
        self.program.steps.push(Step { op, ty, span: self.span });
        self.known.insert((op, ty), id);
        Ok(id)
    }

    /// The step that reverses this one, if any.
    pub fn known_reverse(&self, id: Id) -> Option<Id> {
        match self.program.steps[id].op {
            Op::Reverse(x) => Some(x),
            _ => self.known.get(&(Op::Reverse(id), self.ty(id))).copied(),
        }
    }

    pub fn constant(&mut self, number: Number, index: usize) -> Built {
        let grade = self.space.algebra.blades()[index].grade();
        self.step(Op::Constant(number, index), Type::of(Grades(1 << grade)))
    }

    pub fn is_constant(&self, id: Id) -> Option<(Number, usize)> {
        match self.program.steps[id].op {
            Op::Constant(number, index) => Some((number, index)),
            _ => None,
        }
    }

    /// An input; the same for the same name and kind.
    pub fn input(&mut self, name: &str, kind: InputKind) -> usize {
        let input = Input { name: name.to_owned(), kind };
        let known = self.program.inputs.iter().position(|other| *other == input);
        known.unwrap_or_else(|| {
            self.program.inputs.push(input);
            self.program.inputs.len() - 1
        })
    }

    /// Drops unused steps and inputs, which inferred sandwiches and folded constants replaced.
    pub fn drop_unused(&mut self) {
        let steps = std::mem::take(&mut self.program.steps);
        let mut used = vec![false; steps.len()];
        for &id in self.program.results.iter().flatten() {
            used[id] = true;
        }
        // Operands come before their steps.
        for id in (0..steps.len()).rev() {
            if used[id] {
                steps[id].op.operands().for_each(|operand| used[operand] = true);
            }
        }
        let mut places = vec![usize::MAX; steps.len()];
        let mut inputs = vec![usize::MAX; self.program.inputs.len()];
        let all = std::mem::take(&mut self.program.inputs);
        for (id, mut step) in steps.into_iter().enumerate().filter(|&(id, _)| used[id]) {
            step.op.renumber(
                |id| places[id],
                |input| {
                    if inputs[input] == usize::MAX {
                        inputs[input] = self.program.inputs.len();
                        self.program.inputs.push(all[input].clone());
                    }
                    inputs[input]
                },
            );
            places[id] = self.program.steps.len();
            self.program.steps.push(step);
        }
        for id in self.program.results.iter_mut().flatten() {
            *id = places[*id];
        }
    }

    // --- rules: grades of values, and simplifications

    pub fn negate(&mut self, id: Id) -> Built {
        match self.program.steps[id].op {
            Op::Constant(number, index) => self.constant(number.negated(), index),
            Op::Negate(x) => Ok(x),
            Op::Product(Product::Geometric, s, x)
                if self.is_constant(s).is_some_and(|(_, index)| index == 0) =>
            {
                let s = self.negate(s)?;
                let ty = self.ty(id);
                self.step(Op::Product(Product::Geometric, s, x), ty)
            }
            _ => self.step(Op::Negate(id), self.ty(id)),
        }
    }

    /// The next term of a sum, after those before it.
    pub fn add(&mut self, minus: bool, before: Option<Id>, b: Id) -> Built {
        let Some(a) = before else { return if minus { self.negate(b) } else { Ok(b) } };
        let ty = Type::of(Grades(self.ty(a).grades.0 | self.ty(b).grades.0));
        self.step(if minus { Op::Subtract(a, b) } else { Op::Add(a, b) }, ty)
    }

    pub fn reverse(&mut self, id: Id) -> Built {
        if let Op::Reverse(x) = self.program.steps[id].op {
            return Ok(x);
        }
        let ty = self.ty(id);
        if ty.grades.within(self.kept_by_reversal(true)) {
            return Ok(id);
        }
        match self.is_constant(id) {
            Some((number, index)) => self.constant(number.negated(), index),
            None => self.step(Op::Reverse(id), ty),
        }
    }

    /// The grades that reversal keeps, or those whose sign it changes.
    fn kept_by_reversal(&self, kept: bool) -> Grades {
        let grades = (0..=self.count()).filter(|k| (k % 4 < 2) == kept);
        Grades(grades.map(|k| 1 << k).sum::<u16>())
    }

    /// A named product without the grades that are known to vanish.
    pub fn product(&mut self, product: Product, a: Id, b: Id, only: Grades) -> Built {
        if let (Some((m, i)), Some((n, j))) = (self.is_constant(a), self.is_constant(b)) {
            let (sign, index) = product.of_basis(self.space.algebra, i, j);
            let number = m.times(n).times(Number::whole(i32::from(sign)));
            return self.constant(number, if sign == 0 { 0 } else { index });
        }
        let (s, t) = (self.ty(a), self.ty(b));
        if product == Product::Geometric && s.unit && t.unit {
            return self.step(Op::Compose(a, b), Type::ROTOR);
        }
        let mut grades = Plan::new(self.space.algebra, product, s.grades, t.grades).grades;
        if a == b && product == Product::Geometric && self.symmetry(s.grades).is_some() {
            // (XX)~ = ~X~X = XX for ~X = ±X.
            grades.0 &= self.kept_by_reversal(true).0;
        }
        grades.0 &= only.0;
        if grades.0 == 0 {
            return self.constant(Number::whole(0), 0);
        }
        self.step(Op::Product(product, a, b), Type::of(grades))
    }

    /// The geometric product of the factors before and the next one.
    fn times(&mut self, before: Option<Id>, b: Id) -> Built {
        match before {
            None => Ok(b),
            Some(a) => self.product(Product::Geometric, a, b, self.all()),
        }
    }

    /// Whether reversal keeps all these grades or negates all; none if it does neither.
    fn symmetry(&self, grades: Grades) -> Option<bool> {
        [true, false].into_iter().find(|&kept| grades.within(self.kept_by_reversal(kept)))
    }

    /// The geometric product of several factors. Scalars are multiplied first, since they commute; a factor
    /// and its reverse form a sandwich with the factors between them, which keeps the grades that reversal does.
    pub fn chain(&mut self, factors: &[Id]) -> Built {
        let (mut scalar, mut number) = (None, Number::whole(1));
        let mut stack: Vec<Id> = Vec::new();
        let mut places: HashMap<Id, Vec<usize>> = HashMap::new();
        for &factor in factors {
            if let Some((n, 0)) = self.is_constant(factor) {
                number = number.times(n);
            } else if self.ty(factor).grades == Grades::SCALAR {
                scalar = Some(self.times(scalar, factor)?);
            } else {
                let open = self.known_reverse(factor).and_then(|r| places.get_mut(&r)).and_then(Vec::pop);
                if let Some(at) =
                    open.filter(|&at| at + 1 < stack.len() && self.ty(stack[at]).grades != Grades::SCALAR)
                {
                    let middle = stack.split_off(at + 1);
                    let middle = self.row(&middle)?;
                    let outer = stack[at];
                    stack.pop();
                    places.values_mut().for_each(|places| places.retain(|&place| place < at));
                    stack.push(self.sandwich(outer, middle, factor)?);
                } else {
                    places.entry(factor).or_default().push(stack.len());
                    stack.push(factor);
                }
            }
        }
        if let Some(s) = scalar
            && number != Number::whole(1)
        {
            let n = self.constant(number, 0)?;
            scalar = Some(self.times(Some(n), s)?);
            number = Number::whole(1);
        }
        if stack.is_empty() {
            return scalar.map_or_else(|| self.constant(number, 0), Ok);
        }
        let rest = self.row(&stack)?;
        if number == Number::whole(-1) {
            return self.negate(rest);
        }
        if number != Number::whole(1) {
            scalar = Some(self.constant(number, 0)?);
        }
        self.times(scalar, rest)
    }

    /// Factors multiplied from left to right.
    fn row(&mut self, factors: &[Id]) -> Built {
        factors[1..].iter().try_fold(factors[0], |product, &factor| self.times(Some(product), factor))
    }

    /// `A X ~A`.
    fn sandwich(&mut self, a: Id, x: Id, reversed: Id) -> Built {
        if self.ty(a).unit {
            let ty = self.ty(x);
            return self.step(Op::Turn(a, x), ty);
        }
        let left = self.times(Some(a), x)?;
        // (A X ~A)~ = A ~X ~A
        let only = match self.symmetry(self.ty(x).grades) {
            Some(kept) => self.kept_by_reversal(kept),
            None => self.all(),
        };
        self.product(Product::Geometric, left, reversed, only)
    }

    pub fn inverse(&mut self, id: Id) -> Built {
        if self.ty(id).unit {
            return self.reverse(id);
        }
        if let Some((number, 0)) = self.is_constant(id) {
            let inverse = Number::whole(1).over(number);
            let inverse = inverse.ok_or_else(|| self.error("division by zero"))?;
            return self.constant(inverse, 0);
        }
        self.function(Function::Inverse, id)
    }

    pub fn function(&mut self, f: Function, id: Id) -> Built {
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
        self.step(Op::Function(f, id), ty)
    }

    pub fn divide(&mut self, a: Id, b: Id) -> Built {
        if self.ty(b).grades != Grades::SCALAR {
            let inverse = self.inverse(b)?;
            return self.chain(&[a, inverse]);
        }
        if let Some((divisor, _)) = self.is_constant(b) {
            if divisor.value == 0.0 {
                return Err(self.error("division by zero"));
            }
            if let Some((number, index)) = self.is_constant(a)
                && let Some(quotient) = number.over(divisor)
            {
                return self.constant(quotient, index);
            }
        }
        self.step(Op::Divide(a, b), Type::of(self.ty(a).grades))
    }

    /// A power by squaring.
    pub fn power(&mut self, id: Id, n: i32) -> Built {
        if n == 0 {
            return self.constant(Number::whole(1), 0);
        }
        if self.ty(id).unit && n != 1 && n != -1 {
            return self.step(Op::RotorPower(id, n), Type::ROTOR);
        }
        let mut base = if n < 0 { self.inverse(id)? } else { id };
        let mut exponent = n.unsigned_abs();
        let mut result = None;
        loop {
            if exponent & 1 == 1 {
                result = Some(self.times(result, base)?);
            }
            exponent >>= 1;
            match result {
                Some(result) if exponent == 0 => return Ok(result),
                _ => base = self.times(Some(base), base)?,
            }
        }
    }

    pub fn part(&mut self, id: Id, grades: Grades) -> Built {
        let ty = self.ty(id);
        if ty.grades == grades {
            return Ok(id);
        }
        // Only the requested grades of a product are computed.
        if let Op::Product(product, a, b) = self.program.steps[id].op
            && grades.within(ty.grades)
        {
            return self.step(Op::Product(product, a, b), Type::of(grades));
        }
        self.step(Op::Part(id), Type::of(grades))
    }

    pub fn dual(&mut self, id: Id, back: bool) -> Built {
        if self.space.algebra.signature().r > 0 {
            return Err(self.error("no dual: a generator squares to zero, so I has no inverse"));
        }
        let (n, ty) = (self.count(), self.ty(id));
        let grades = (0..=n).filter(|&k| ty.grades.contains(n - k)).map(|k| 1 << k).sum::<u16>();
        self.step(if back { Op::Undual(id) } else { Op::Dual(id) }, Type::of(Grades(grades)))
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
