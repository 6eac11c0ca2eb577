//! A tree to a program: names get their types, grades are inferred and checked, equal parts found once.

use super::derivative::derivative;
use super::names::{Definition, Meaning, Names, Type};
use super::number::Number;
use super::parser::{count_indices, parse};
use super::program::{Id, Input, InputKind, Op, Program, Step, union};
use super::reading::indexed;
use super::token::{Lexeme, Sign, joined, tokens};
use super::tree::{Kind, Named, Node, Span, Tight, Tree};
use super::{Error, MAX_NODES, Space};
use crate::functions::Function;
use crate::product::{Grades, Plan, Product};
use std::collections::HashMap;

/// Most nodes that are looked at: a node of a definition or of a sum counts each time that it is written out.
const MOST_VISITS: usize = 20 * MAX_NODES;

/// What a formula does with values of these types.
///
/// # Errors
/// Where grades do not fit, with the place in the text.
pub fn compile(tree: &Tree, space: Space, names: &Names) -> Result<Program, Error> {
    Ok(compiled(tree, space, names)?.0)
}

/// What each node of a formula is, in the order of [`Tree::nodes`]; of a node that is written out for several
/// indices, what it is for the first.
///
/// # Errors
/// As [`compile`].
pub fn types(tree: &Tree, space: Space, names: &Names) -> Result<Vec<Option<Type>>, Error> {
    let (_, types) = compiled(tree, space, names)?;
    Ok(tree.nodes().into_iter().map(|node| types.get(&std::ptr::from_ref(node)).copied()).collect())
}

/// Defines a function, `V(x)`, or a value, `c`, by a formula.
///
/// # Errors
/// If the head is no name with parameters, the body no formula in them, or if the function would call itself.
pub fn define(head: &str, body: &str, space: Space, names: &mut Names) -> Result<(), Error> {
    let (name, parameters) = heading(head)?;
    let mut inside = names.clone();
    for parameter in &parameters {
        inside.bind(parameter.clone(), Meaning::Value(Type::of(Grades::ALL)));
    }
    let tree = parse(body, space, &inside)?;
    let whole = Span { start: 0, end: body.len() };
    let [body] = <[Node; 1]>::try_from(tree.sides).map_err(|_| {
        Error::new(whole, format!("`{head}` is defined by an equation; write the value alone"))
    })?;
    if calls(&body, &name, &parameters, names, &mut Vec::new()) {
        return Err(Error::new(whole, format!("`{name}` would call itself; formulas have no recursion")));
    }
    names.bind(name, Meaning::Function(Definition { parameters, body }));
    Ok(())
}

/// The canonical name and parameters of `c` or `V(x, y)`.
///
/// # Errors
/// If it is anything else.
pub fn heading(head: &str) -> Result<(String, Vec<String>), Error> {
    let tokens = tokens(head)?;
    let whole = Span { start: 0, end: head.len() };
    let wrong = || Error::new(whole, "what is defined is a name, `c`, or a function of names, `V(x)`");
    let name = |lexeme: &Lexeme| match lexeme {
        Lexeme::Word(atoms) => joined(atoms),
        _ => None,
    };
    let sign = |i: usize, sign: Sign| tokens.get(i).is_some_and(|token| token.lexeme == Lexeme::Sign(sign));
    let first = tokens.first().and_then(|token| name(&token.lexeme)).ok_or_else(wrong)?;
    let mut parameters = Vec::new();
    if tokens.len() > 1 {
        if !sign(1, Sign::Open('(')) || !sign(tokens.len() - 1, Sign::Close('(')) || tokens.len() % 2 == 1 {
            return Err(wrong());
        }
        for i in (2..tokens.len() - 1).step_by(2) {
            let parameter = name(&tokens[i].lexeme).ok_or_else(wrong)?;
            let last = i + 2 == tokens.len();
            if !last && !sign(i + 1, Sign::Comma) || parameters.contains(&parameter) {
                return Err(wrong());
            }
            parameters.push(parameter);
        }
    }
    Ok((first, parameters))
}

/// Whether a body calls a function, itself or through others.
fn calls(body: &Node, name: &str, parameters: &[String], names: &Names, seen: &mut Vec<String>) -> bool {
    let mut called = Vec::new();
    body.visit(&mut |node| {
        if let Kind::Call(other, _) | Kind::Name(other) = &node.kind
            && !parameters.contains(other)
        {
            called.push(other.clone());
        }
    });
    called.into_iter().any(|other| {
        let Some(Meaning::Function(definition)) = names.get(&other) else { return false };
        if other == name {
            return true;
        }
        if seen.contains(&other) {
            return false;
        }
        seen.push(other);
        calls(&definition.body, name, &definition.parameters, names, seen)
    })
}

type Types = HashMap<*const Node, Type>;

fn compiled(tree: &Tree, space: Space, names: &Names) -> Result<(Program, Types), Error> {
    let program = Program {
        signature: space.algebra.signature(),
        inputs: Vec::new(),
        steps: Vec::new(),
        results: Vec::new(),
    };
    let mut compiler = Compiler {
        space,
        names,
        program,
        known: HashMap::new(),
        types: HashMap::new(),
        frame: Frame::default(),
        visits: 0,
    };
    let free = compiler.free_indices(tree)?;
    for number in 0..compiler.count().pow(free.len() as u32) {
        compiler.frame.indices = compiler.values_of(&free, number);
        let mut sides = Vec::new();
        for side in &tree.sides {
            sides.push(compiler.node(side)?);
        }
        compiler.check_sides(tree, &sides)?;
        compiler.program.results.push(sides);
    }
    compiler.drop_unused();
    Ok((compiler.program, compiler.types))
}

/// What names mean inside a definition, or a sum.
#[derive(Clone, Default)]
struct Frame {
    /// The parameters of the definition.
    parameters: Vec<(String, Id)>,
    /// Where its call stands, in the text that is being compiled.
    call: Option<Span>,
    /// The values of indices.
    indices: Vec<(char, usize)>,
    /// The functions that are being written out.
    active: Vec<String>,
}

struct Compiler<'a> {
    space: Space<'a>,
    names: &'a Names,
    program: Program,
    /// The steps there are, by what they do.
    known: HashMap<[u64; 4], Id>,
    types: Types,
    frame: Frame,
    visits: usize,
}

type Built = Result<Id, Error>;

impl Compiler<'_> {
    fn count(&self) -> usize {
        self.space.algebra.signature().generators()
    }

    fn all(&self) -> Grades {
        Grades((1 << (self.count() + 1)) - 1)
    }

    fn ty(&self, id: Id) -> Type {
        self.program.steps[id].ty
    }

    fn error(&self, span: Span, message: impl Into<String>) -> Error {
        Error::new(self.frame.call.unwrap_or(span), message)
    }

    // --- steps

    /// A step, or the equal one that is there already.
    fn step(&mut self, op: Op, ty: Type, span: Span) -> Built {
        let key = key(&op, ty);
        if let Some(&id) = self.known.get(&key) {
            return Ok(id);
        }
        if self.program.steps.len() >= MAX_NODES {
            return Err(self.error(
                span,
                format!("the formula has more than {MAX_NODES} steps, definitions and sums written out"),
            ));
        }
        let span = self.frame.call.unwrap_or(span);
        self.program.steps.push(Step { op, ty, span });
        self.known.insert(key, self.program.steps.len() - 1);
        Ok(self.program.steps.len() - 1)
    }

    /// The step that reverses this one, if it is there.
    fn known_reverse(&self, id: Id) -> Option<Id> {
        match self.program.steps[id].op {
            Op::Reverse(x) => Some(x),
            _ => self.known.get(&key(&Op::Reverse(id), self.ty(id))).copied(),
        }
    }

    fn constant(&mut self, number: Number, index: usize, span: Span) -> Built {
        let grade = self.space.algebra.blades()[index].grade();
        self.step(Op::Constant(number, index), Type::of(Grades(1 << grade)), span)
    }

    fn is_constant(&self, id: Id) -> Option<(Number, usize)> {
        match self.program.steps[id].op {
            Op::Constant(number, index) => Some((number, index)),
            _ => None,
        }
    }

    /// An input; the same for the same name and kind.
    fn input(&mut self, name: &str, kind: InputKind) -> usize {
        let input = Input { name: name.to_owned(), kind };
        let known = self.program.inputs.iter().position(|other| *other == input);
        known.unwrap_or_else(|| {
            self.program.inputs.push(input);
            self.program.inputs.len() - 1
        })
    }

    /// Steps and inputs that nothing uses are left out: what an inferred sandwich or a folded constant replaced.
    fn drop_unused(&mut self) {
        let steps = std::mem::take(&mut self.program.steps);
        let mut used = vec![false; steps.len()];
        for &id in self.program.results.iter().flatten() {
            used[id] = true;
        }
        for id in (0..steps.len()).rev().filter(|&id| used[id]).collect::<Vec<_>>() {
            // Operands come before; marking them here would miss those marked later in this same pass.
            mark(&steps, id, &mut used);
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

/// Marks all that a step needs.
fn mark(steps: &[Step], id: Id, used: &mut [bool]) {
    let mut waiting = vec![id];
    while let Some(id) = waiting.pop() {
        for operand in steps[id].op.operands() {
            if !used[operand] {
                used[operand] = true;
                waiting.push(operand);
            }
        }
    }
}

/// What a step does, as numbers: equal for equal steps only.
fn key(op: &Op, ty: Type) -> [u64; 4] {
    let pair = |a: usize, b: usize| (a as u64) << 32 | b as u64;
    let [mut kind, mut first, mut second] = [0; 3];
    match *op {
        Op::Input(i) => first = i as u64,
        Op::Constant(number, index) => {
            kind = 1 | (index as u64) << 8 | u64::from(number.ratio.is_some()) << 32;
            first = number.value.to_bits();
            second = number.ratio.map_or(0, |(n, d)| (n as u64).rotate_left(32) ^ d as u64);
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
    [kind, first, second, u64::from(ty.grades.0) << 1 | u64::from(ty.unit)]
}

// --- operations on steps: their types, and what is known before any value is

impl Compiler<'_> {
    fn negate(&mut self, id: Id, span: Span) -> Built {
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
            _ => self.step(Op::Negate(id), Type::of(self.ty(id).grades), span),
        }
    }

    fn add(&mut self, minus: bool, a: Id, b: Id, span: Span) -> Built {
        let ty = Type::of(union(self.ty(a).grades, self.ty(b).grades));
        self.step(if minus { Op::Subtract(a, b) } else { Op::Add(a, b) }, ty, span)
    }

    fn reverse(&mut self, id: Id, span: Span) -> Built {
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

    /// A named product, of whose grades some may be known to vanish.
    fn product(&mut self, product: Product, a: Id, b: Id, only: Grades, span: Span) -> Built {
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

    fn times(&mut self, a: Id, b: Id, span: Span) -> Built {
        self.product(Product::Geometric, a, b, self.all(), span)
    }

    /// The sign that reversal gives all these grades, if it gives them the same.
    fn symmetry(&self, grades: Grades) -> Option<bool> {
        [true, false].into_iter().find(|&kept| grades.within(self.kept_by_reversal(kept)))
    }

    /// The geometric product of several factors. Scalars are multiplied first, since they commute; what stands
    /// between a factor and its reverse is turned by it, which keeps the grades that reversal does.
    fn chain(&mut self, factors: &[Id], span: Span) -> Built {
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

    fn inverse(&mut self, id: Id, span: Span) -> Built {
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

    fn function(&mut self, f: Function, id: Id, span: Span) -> Built {
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

    fn divide(&mut self, a: Id, b: Id, span: Span) -> Built {
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
    fn power(&mut self, id: Id, n: i32, span: Span) -> Built {
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

    fn part(&mut self, id: Id, grades: Grades, span: Span) -> Built {
        let ty = self.ty(id);
        if ty.grades == grades {
            return Ok(id);
        }
        // Of a product only what is asked for is computed.
        if let Op::Product(product, a, b) = self.program.steps[id].op
            && grades.within(ty.grades)
        {
            return self.step(Op::Product(product, a, b), Type::of(grades), span);
        }
        self.step(Op::Part(id), Type::of(grades), span)
    }

    fn dual(&mut self, id: Id, back: bool, span: Span) -> Built {
        if self.space.algebra.signature().r > 0 {
            return Err(self.error(span, "no dual: a generator squares to zero, so that I has no inverse"));
        }
        let (n, ty) = (self.count(), self.ty(id));
        let grades = (0..=n).filter(|&k| ty.grades.contains(n - k)).map(|k| 1 << k).sum::<u16>();
        self.step(if back { Op::Undual(id) } else { Op::Dual(id) }, Type::of(Grades(grades)), span)
    }

    /// Whether an argument is of these grades; of one that is not known yet, whether it may be.
    fn fits(&self, id: Id, grades: Grades) -> bool {
        let held = self.ty(id).grades;
        held.within(grades) || self.names.is_open() && held.0 & grades.0 != 0
    }

    fn require(&self, id: Id, grades: Grades, what: &str, node: &Node) -> Result<(), Error> {
        if self.fits(id, grades) {
            return Ok(());
        }
        let held = shown(self.ty(id).grades);
        let kind = match grades {
            Grades::SCALAR => "a number (grade 0)",
            Grades(0b10) => "a vector (grade 1)",
            _ => "a bivector (grade 2)",
        };
        let k = grades.0.trailing_zeros();
        let remedy = if self.ty(id).grades.0 & grades.0 != 0 {
            format!("; take its part `⟨…⟩_{k}`")
        } else {
            String::new()
        };
        Err(self.error(node.span, format!("{what} needs {kind}; this has {held}{remedy}")))
    }
}

/// `grade 1`, `grades 0, 2`.
fn shown(grades: Grades) -> String {
    let list: Vec<String> = (0..16).filter(|&k| grades.contains(k)).map(|k| k.to_string()).collect();
    format!("grade{} {}", if list.len() == 1 { "" } else { "s" }, list.join(", "))
}

// --- nodes

impl Compiler<'_> {
    fn node(&mut self, node: &Node) -> Built {
        self.visits += 1;
        if self.visits > MOST_VISITS {
            return Err(self.error(
                node.span,
                "definitions and sums make this formula too long when they are written out",
            ));
        }
        let id = self.kind(node)?;
        if self.frame.call.is_none() {
            let ty = self.ty(id);
            self.types.entry(std::ptr::from_ref(node)).or_insert(ty);
        }
        Ok(id)
    }

    fn kind(&mut self, node: &Node) -> Built {
        let span = node.span;
        match &node.kind {
            Kind::Number(number) => self.constant(*number, 0, span),
            Kind::Pi => self.step(Op::Pi, Type::SCALAR, span),
            Kind::Blade(generators) => self.blade(generators, span),
            Kind::Name(name) => self.name(name, span),
            Kind::Sum(terms) => self.sum(terms, span),
            Kind::Product(factors) => {
                let factors = self.nodes(factors)?;
                self.chain(&factors, span)
            }
            Kind::Quotient(pair) => {
                let (a, b) = (self.node(&pair.0)?, self.node(&pair.1)?);
                self.divide(a, b, span)
            }
            Kind::Tight(tight, operands) => self.tight(*tight, operands, span),
            Kind::Reverse(x) => {
                let x = self.node(x)?;
                self.reverse(x, span)
            }
            Kind::Power(x, n) => {
                let x = self.node(x)?;
                self.power(x, *n, span)
            }
            Kind::Part(x, grades) => {
                let x = self.node(x)?;
                self.part(x, *grades, span)
            }
            Kind::Function(function, x) => self.named(*function, x, span),
            Kind::Call(name, arguments) => self.call(name, arguments, span),
            Kind::Derivative(x) => match derivative(x)? {
                Some(x) => self.node(&x),
                None => self.constant(Number::whole(0), 0, span),
            },
            Kind::Total(index, x) => self.total(index, x, span),
        }
    }

    fn nodes(&mut self, nodes: &[Node]) -> Result<Vec<Id>, Error> {
        nodes.iter().map(|node| self.node(node)).collect()
    }

    fn blade(&mut self, generators: &[u8], span: Span) -> Built {
        let algebra = self.space.algebra;
        let generator = |g: u8| algebra.blades().iter().position(|b| b.bits == 1 << (g - 1)).unwrap_or(0);
        let (mut sign, mut index) = (1, 0);
        for &g in generators {
            let (s, k) = algebra.basis_product(index, generator(g));
            (sign, index) = (sign * s, k);
        }
        self.constant(Number::whole(i32::from(sign)), index, span)
    }

    fn name(&mut self, name: &str, span: Span) -> Built {
        if let Some((_, id)) = self.frame.parameters.iter().find(|(parameter, _)| parameter == name) {
            return Ok(*id);
        }
        let ty = match self.names.get(name) {
            Some(Meaning::Value(ty)) => *ty,
            Some(Meaning::Function(definition)) if definition.parameters.is_empty() => {
                return self.call(name, &[], span);
            }
            Some(_) => return Err(self.error(span, format!("`{name}` is a function; write `{name}(…)`"))),
            None => match self.substituted(name, span)? {
                Some(id) => return Ok(id),
                None if self.names.is_open() => Type::of(self.all()),
                None if name.ends_with('\'') => {
                    return Err(
                        self.error(span, format!("`{name}` has no value, and a derivative here needs it"))
                    );
                }
                None => return Err(self.error(span, format!("`{name}` has no value"))),
            },
        };
        let input = self.input(name, InputKind::Value(ty));
        self.step(Op::Input(input), ty, span)
    }

    /// What a name stands for whose indices have values.
    fn substituted(&mut self, name: &str, span: Span) -> Result<Option<Id>, Error> {
        let Some((base, indices)) = indexed(name) else { return Ok(None) };
        let value = |c: char| self.frame.indices.iter().rev().find(|(index, _)| *index == c).map(|(_, k)| *k);
        let Some(values) = indices.chars().map(value).collect::<Option<Vec<usize>>>() else {
            return Ok(None);
        };
        let number = match (base, &values[..]) {
            ("δ", [i, j]) => Number::whole(i32::from(i == j)),
            ("ε", &[i, j, k]) => Number::whole(permutation([i, j, k])),
            ("e", &[k]) if self.names.get(&format!("e{k}")).is_none() => {
                return self.blade(&[k as u8], span).map(Some);
            }
            _ => {
                let digits: String = values.iter().map(usize::to_string).collect();
                let primes = &name[base.len() + 1 + indices.len()..];
                return self.name(&format!("{base}{digits}{primes}"), span).map(Some);
            }
        };
        self.constant(number, 0, span).map(Some)
    }

    fn sum(&mut self, terms: &[(bool, Node)], span: Span) -> Built {
        let mut sum = None;
        for (minus, term) in terms {
            let id = self.node(term)?;
            sum = Some(match sum {
                None if *minus => self.negate(id, term.span)?,
                None => id,
                Some(before) => self.add(*minus, before, id, span.to(term.span))?,
            });
        }
        sum.ok_or_else(|| self.error(span, "a sum without terms"))
    }

    fn tight(&mut self, tight: Tight, operands: &[Node], span: Span) -> Built {
        let ids = self.nodes(operands)?;
        let product = match tight {
            Tight::Wedge | Tight::Cross => Product::Wedge,
            Tight::Dot => Product::Dot,
            Tight::Commutator => Product::Commutator,
            Tight::LeftContraction => Product::LeftContraction,
            Tight::RightContraction => Product::RightContraction,
        };
        if tight == Tight::Cross {
            if !self.space.is_g3() {
                return Err(self.error(
                    span,
                    "the cross product is one of 3-d space; elsewhere write `a∧b` or its dual",
                ));
            }
            for (node, &id) in operands.iter().zip(&ids) {
                self.require(id, Grades(0b10), "the cross product", node)?;
            }
        }
        let mut result = ids[0];
        for &id in &ids[1..] {
            result = self.product(product, result, id, self.all(), span)?;
        }
        if tight == Tight::Cross { self.dual(result, false, span) } else { Ok(result) }
    }

    fn named(&mut self, function: Named, node: &Node, span: Span) -> Built {
        let x = self.node(node)?;
        match function {
            Named::Function(Function::Inverse) => self.inverse(x, span),
            Named::Function(f) => self.function(f, x, span),
            Named::Norm => self.step(Op::Norm(x), Type::SCALAR, span),
            Named::Dual => self.dual(x, false, span),
            Named::Undual => self.dual(x, true, span),
            Named::Reverse => self.reverse(x, span),
            Named::Sin | Named::Cos | Named::Tan => {
                self.require(x, Grades::SCALAR, &format!("`{}`", function.name()), node)?;
                let op = match function {
                    Named::Sin => Op::Sin(x),
                    Named::Cos => Op::Cos(x),
                    _ => Op::Tan(x),
                };
                self.step(op, Type::SCALAR, span)
            }
        }
    }

    fn call(&mut self, name: &str, arguments: &[Node], span: Span) -> Built {
        let ids = self.nodes(arguments)?;
        match self.names.get(name) {
            Some(Meaning::Map { grade }) => self.map(name, *grade, ids[0], &arguments[0], span),
            Some(Meaning::Function(definition)) => self.write_out(name, definition, &ids, span),
            // Not known yet.
            _ => {
                let input = self.input(name, InputKind::Matrix { grade: 1 });
                let ty = Type::of(self.all());
                self.step(Op::Map { input, argument: ids[0] }, ty, span)
            }
        }
    }

    /// A linear map of each part.
    fn map(&mut self, name: &str, grade: u8, x: Id, node: &Node, span: Span) -> Built {
        if !self.space.is_g3() {
            return Err(self.error(span, "linear maps are of 3-d space"));
        }
        if grade == 2 {
            self.require(x, Grades::BIVECTOR, &format!("`{name}`, a map of bivectors,"), node)?;
        }
        let held = self.ty(x).grades;
        let mut sum = None;
        for k in (0..=3).filter(|&k| held.contains(k) && (grade == 1 || k == 2)) {
            let part = self.part(x, Grades(1 << k), span)?;
            let kind = match k {
                0 => None,
                3 => Some(InputKind::Determinant),
                _ => Some(InputKind::Matrix { grade: k as u8 }),
            };
            let image = match kind {
                None => part,
                Some(kind) => {
                    let input = self.input(name, kind);
                    self.step(Op::Map { input, argument: part }, Type::of(Grades(1 << k)), span)?
                }
            };
            sum = Some(match sum {
                None => image,
                Some(before) => self.add(false, before, image, span)?,
            });
        }
        sum.ok_or_else(|| self.error(span, format!("`{name}` has nothing to map")))
    }

    /// The value of a definition for these arguments.
    fn write_out(&mut self, name: &str, definition: &Definition, arguments: &[Id], span: Span) -> Built {
        if definition.parameters.len() != arguments.len() {
            let (count, found) = (definition.parameters.len(), arguments.len());
            return Err(self.error(span, format!("`{name}` takes {count} arguments, got {found}")));
        }
        if self.frame.active.iter().any(|active| active == name) {
            return Err(self.error(span, format!("`{name}` calls itself; formulas have no recursion")));
        }
        let call = self.frame.call.unwrap_or(span);
        let mut active = self.frame.active.clone();
        active.push(name.to_owned());
        let parameters = definition.parameters.iter().cloned().zip(arguments.iter().copied()).collect();
        let inside = Frame { parameters, call: Some(call), indices: Vec::new(), active };
        let outside = std::mem::replace(&mut self.frame, inside);
        let value = self.node(&definition.body);
        self.frame = outside;
        value.map_err(|error| Error::new(call, format!("in `{name}`: {}", error.message)))
    }

    // --- indices

    /// `Σ_k`: the sum over all values of the index.
    fn total(&mut self, index: &str, node: &Node, span: Span) -> Built {
        let index = index.chars().next().unwrap_or('k');
        let mut sum = None;
        for k in 1..=self.count() {
            self.frame.indices.push((index, k));
            let term = self.node(node);
            self.frame.indices.pop();
            let term = term?;
            sum = Some(match sum {
                None => term,
                Some(before) => self.add(false, before, term, span)?,
            });
        }
        sum.ok_or_else(|| self.error(span, "a sum over no index"))
    }

    /// The indices for whose every value an equation is to hold.
    fn free_indices(&self, tree: &Tree) -> Result<Vec<char>, Error> {
        let mut free = Vec::new();
        if self.names.is_open() {
            return Ok(Vec::new());
        }
        for side in &tree.sides {
            count_indices(side, self.names, &mut free);
        }
        let free: Vec<char> = free.into_iter().map(|(index, _)| index).collect();
        let whole = tree.sides[0].span;
        match free[..] {
            [] => Ok(free),
            _ if free.len() > 3 => Err(Error::new(whole, "an equation has at most three free indices")),
            [index, ..] if tree.sides.len() == 1 => Err(Error::new(
                whole,
                format!(
                    "the index {index} is free: a sum is written `Σ_{index}`; only an equation holds for every value"
                ),
            )),
            _ => Ok(free),
        }
    }

    /// The values of these indices in the `number`-th case.
    fn values_of(&self, free: &[char], mut number: usize) -> Vec<(char, usize)> {
        let n = self.count().max(1);
        let digit = |&index: &char| {
            let k = number % n + 1;
            number /= n;
            (index, k)
        };
        free.iter().map(digit).collect()
    }

    /// The sides of an equation must have a grade in common, unless one of them is 0.
    fn check_sides(&self, tree: &Tree, sides: &[Id]) -> Result<(), Error> {
        let is_zero = |id: Id| self.is_constant(id).is_some_and(|(number, _)| number.value == 0.0);
        for (i, pair) in sides.windows(2).enumerate() {
            let (a, b) = (self.ty(pair[0]).grades, self.ty(pair[1]).grades);
            if a.0 & b.0 == 0 && !is_zero(pair[0]) && !is_zero(pair[1]) {
                let span = tree.sides[i].span.to(tree.sides[i + 1].span);
                let message = format!(
                    "the sides of the equation have no grade in common, {} and {}: they agree only if both are 0",
                    shown(a),
                    shown(b)
                );
                return Err(Error::new(span, message));
            }
        }
        Ok(())
    }
}

/// The sign of a permutation of 1, 2, 3; 0 of anything else.
fn permutation([i, j, k]: [usize; 3]) -> i32 {
    match (i, j, k) {
        (1, 2, 3) | (2, 3, 1) | (3, 1, 2) => 1,
        (3, 2, 1) | (2, 1, 3) | (1, 3, 2) => -1,
        _ => 0,
    }
}
