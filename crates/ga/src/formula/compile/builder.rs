//! Builder of programs: shares equal steps and drops unused ones.

use super::program::{Id, Input, InputKind, Op, Program, Step};
use crate::formula::syntax::names::Type;
use crate::formula::syntax::number::Number;
use crate::formula::syntax::tree::Span;
use crate::formula::{Error, MAX_NODES, Space};
use crate::product::Grades;
use std::collections::HashMap;

/// A program under construction.
pub(crate) struct Builder<'a> {
    pub space: Space<'a>,
    pub program: Program,
    /// The call of the definition being expanded: the place of all its steps.
    pub call: Option<Span>,
    /// The steps by their keys.
    known: HashMap<[u64; 5], Id>,
}

pub(crate) type Built = Result<Id, Error>;

impl<'a> Builder<'a> {
    pub fn new(space: Space<'a>) -> Builder<'a> {
        let signature = space.algebra.signature();
        let program = Program { signature, inputs: Vec::new(), steps: Vec::new(), results: Vec::new() };
        Builder { space, program, call: None, known: HashMap::new() }
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

    pub fn error(&self, span: Span, message: impl Into<String>) -> Error {
        Error::new(self.call.unwrap_or(span), message)
    }

    /// Adds a step, or finds an equal one.
    pub fn step(&mut self, op: Op, ty: Type, span: Span) -> Built {
        let key = key(&op, ty);
        if let Some(&id) = self.known.get(&key) {
            return Ok(id);
        }
        if self.program.steps.len() >= MAX_NODES {
            return Err(self.error(
                span,
                format!("the formula has more than {MAX_NODES} steps, with definitions and sums expanded"),
            ));
        }
        let span = self.call.unwrap_or(span);
        self.program.steps.push(Step { op, ty, span });
        self.known.insert(key, self.program.steps.len() - 1);
        Ok(self.program.steps.len() - 1)
    }

    /// The step that reverses this one, if any.
    pub fn known_reverse(&self, id: Id) -> Option<Id> {
        match self.program.steps[id].op {
            Op::Reverse(x) => Some(x),
            _ => self.known.get(&key(&Op::Reverse(id), self.ty(id))).copied(),
        }
    }

    pub fn constant(&mut self, number: Number, index: usize, span: Span) -> Built {
        let grade = self.space.algebra.blades()[index].grade();
        self.step(Op::Constant(number, index), Type::of(Grades(1 << grade)), span)
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
}

/// The key of a step: equal exactly for equal steps.
fn key(op: &Op, ty: Type) -> [u64; 5] {
    let pair = |a: usize, b: usize| (a as u64) << 32 | b as u64;
    let [mut kind, mut first, mut second, mut third] = [0; 4];
    match *op {
        Op::Input(i) => first = i as u64,
        Op::Constant(number, index) => {
            kind = 1 | (index as u64) << 8 | u64::from(number.ratio.is_some()) << 32;
            first = number.value.to_bits();
            (second, third) = number.ratio.map_or((0, 0), |(n, d)| (n as u64, d as u64));
        }
        Op::Pi => kind = 2,
        Op::Add(a, b) => (kind, first) = (3, pair(a, b)),
        Op::Subtract(a, b) => (kind, first) = (4, pair(a, b)),
        Op::Negate(a) => (kind, first) = (5, a as u64),
        Op::Product(product, a, b) => (kind, first, second) = (6, pair(a, b), product as u64),
        Op::Compose(a, b) => (kind, first) = (7, pair(a, b)),
        Op::Turn(a, b) => (kind, first) = (8, pair(a, b)),
        Op::Divide(a, b) => (kind, first) = (9, pair(a, b)),
        Op::Reverse(a) => (kind, first) = (10, a as u64),
        Op::Part(a) => (kind, first) = (11, a as u64),
        Op::Dual(a) => (kind, first) = (12, a as u64),
        Op::Undual(a) => (kind, first) = (13, a as u64),
        Op::Function(f, a) => (kind, first, second) = (14, a as u64, f as u64),
        Op::RotorPower(a, n) => (kind, first, second) = (15, a as u64, n as u64),
        Op::Norm(a) => (kind, first) = (16, a as u64),
        Op::Sin(a) => (kind, first) = (17, a as u64),
        Op::Cos(a) => (kind, first) = (18, a as u64),
        Op::Tan(a) => (kind, first) = (19, a as u64),
        Op::Map { input, argument } => (kind, first) = (20, pair(input, argument)),
    }
    [kind, first, second, third, u64::from(ty.grades.0) << 1 | u64::from(ty.unit)]
}
