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
}
