//! Compiler from trees to programs: resolves names, infers and checks grades.

pub(crate) mod builder;
pub(crate) mod define;
pub(crate) mod derivative;
pub(crate) mod program;

use super::syntax::indices::{indexed, indices_in, permutation};
use super::syntax::names::{Definition, Meaning, Names, Type};
use super::syntax::number::Number;
use super::syntax::tree::{Kind, Named, Node, Span, Tight, Tree, listed};
use super::{Error, MAX_NODES, Space};
use crate::g3::functions::Function;
use crate::product::{Grades, Product};
use builder::{Builder, Built};
use derivative::{Derivation, TOO_LONG};
use program::{Id, InputKind, Op, Program};
use std::collections::HashMap;

/// Maximum number of visited nodes: a node of a definition or a sum counts each time it is expanded.
const MOST_VISITS: usize = 20 * MAX_NODES;

/// Maximum depth of nodes. Formulas have fewer levels, but definitions may call definitions.
const MOST_LEVELS: usize = 1000;

/// Compiles a formula for values of these types.
///
/// # Errors
/// If grades do not fit, with the place in the text.
pub fn compile(tree: &Tree, space: Space, names: &Names) -> Result<Program, Error> {
    Ok(compiled(tree, space, names)?.0)
}

/// The type of each node, in the order of [`Tree::nodes`]; for a node expanded for several indices, that for the
/// first.
///
/// # Errors
/// As [`compile`].
pub fn types(tree: &Tree, space: Space, names: &Names) -> Result<Vec<Option<Type>>, Error> {
    let (_, types) = compiled(tree, space, names)?;
    Ok(tree.nodes().into_iter().map(|node| types.get(&std::ptr::from_ref(node)).copied()).collect())
}

type Types = HashMap<*const Node, Type>;

fn compiled(tree: &Tree, space: Space, names: &Names) -> Result<(Program, Types), Error> {
    let mut compiler = Compiler {
        steps: Builder::new(space),
        names,
        types: HashMap::new(),
        frame: Frame::default(),
        visits: MOST_VISITS,
        depth: 0,
    };
    let free = compiler.free_indices(tree)?;
    for number in 0..compiler.steps.count().pow(free.len() as u32) {
        compiler.frame.indices = compiler.values_of(&free, number);
        let mut sides = Vec::new();
        for side in &tree.sides {
            sides.push(compiler.node(side)?);
        }
        compiler.check_sides(tree, &sides)?;
        compiler.steps.program.results.push(sides);
    }
    compiler.steps.drop_unused();
    Ok((compiler.steps.program, compiler.types))
}

/// The meaning of names inside a definition or a sum.
#[derive(Clone, Default)]
struct Frame {
    /// The parameters of the definition.
    parameters: Vec<(String, Id)>,
    /// The values of indices.
    indices: Vec<(char, usize)>,
    /// Whether a definition is being expanded.
    expanding: bool,
}

struct Compiler<'a> {
    steps: Builder<'a>,
    names: &'a Names,
    types: Types,
    frame: Frame,
    /// The remaining number of nodes that may be visited.
    visits: usize,
    /// The current depth.
    depth: usize,
}

impl Compiler<'_> {
    /// Fails if an argument does not have these grades, nor may have them since they are unknown.
    fn require(&mut self, id: Id, grades: Grades, what: &str, node: &Node) -> Result<(), Error> {
        let held = self.steps.ty(id).grades;
        let some = held.0 & grades.0 != 0;
        if held.within(grades) || self.names.is_open() && some {
            return Ok(());
        }
        let kind = match grades {
            Grades::SCALAR => "a number (grade 0)",
            Grades(0b10) => "a vector (grade 1)",
            _ => "a bivector (grade 2)",
        };
        let k = grades.0.trailing_zeros();
        let remedy = if some { format!("; take its part `⟨…⟩_{k}`") } else { String::new() };
        let message = format!("{what} needs {kind}; this has {}{remedy}", shown(held));
        self.placed(node.span, |compiler| Err(compiler.steps.error(message)))
    }

    /// Adds steps with this place; those of an expanded definition have the place of its call.
    fn placed<T>(&mut self, span: Span, add: impl FnOnce(&mut Self) -> Result<T, Error>) -> Result<T, Error> {
        let outer = self.steps.span;
        if !self.frame.expanding {
            self.steps.span = span;
        }
        let added = add(self)?;
        self.steps.span = outer;
        Ok(added)
    }

    fn node(&mut self, node: &Node) -> Built {
        self.placed(node.span, |compiler| {
            let visits = compiler.visits.checked_sub(1);
            compiler.visits = visits.ok_or_else(|| compiler.steps.error(TOO_LONG))?;
            if compiler.depth >= MOST_LEVELS {
                let message = format!("more than {MOST_LEVELS} nested levels, with definitions expanded");
                return Err(compiler.steps.error(message));
            }
            compiler.depth += 1;
            let id = compiler.kind(node)?;
            compiler.depth -= 1;
            if !compiler.frame.expanding {
                let ty = compiler.steps.ty(id);
                compiler.types.entry(std::ptr::from_ref(node)).or_insert(ty);
            }
            Ok(id)
        })
    }

    fn kind(&mut self, node: &Node) -> Built {
        match &node.kind {
            Kind::Number(number) => self.steps.constant(*number, 0),
            Kind::Pi => self.steps.step(Op::Pi, Type::SCALAR),
            Kind::Blade(generators) => self.blade(generators),
            Kind::Pseudoscalar => {
                let all: Vec<u8> = self.steps.space.algebra.numbers().map(|g| g as u8).collect();
                self.blade(&all)
            }
            Kind::Name(name) => self.name(name),
            Kind::Sum(terms) => self.sum(terms),
            Kind::Product(factors) => self.nodes(factors).and_then(|factors| self.steps.chain(&factors)),
            Kind::Quotient(pair) => {
                let (a, b) = (self.node(&pair.0)?, self.node(&pair.1)?);
                self.steps.divide(a, b)
            }
            Kind::Tight(tight, operands) => self.tight(*tight, operands),
            Kind::Reverse(x) => self.node(x).and_then(|x| self.steps.reverse(x)),
            Kind::Power(x, n) => self.node(x).and_then(|x| self.steps.power(x, *n)),
            Kind::Part(x, grades) => self.node(x).and_then(|x| self.steps.part(x, *grades)),
            Kind::Function(function, x) => self.named(*function, x),
            Kind::Call(name, arguments) => self.call(name, arguments),
            Kind::Derivative(x) => match (Derivation { names: self.names, left: &mut self.visits }).of(x)? {
                Some(x) => self.node(&x),
                None => self.steps.constant(Number::whole(0), 0),
            },
            Kind::Total(index, x) => self.total(index, x),
        }
    }

    fn nodes(&mut self, nodes: &[Node]) -> Result<Vec<Id>, Error> {
        nodes.iter().map(|node| self.node(node)).collect()
    }

    fn blade(&mut self, generators: &[u8]) -> Built {
        let algebra = self.steps.space.algebra;
        // The generators stand after the scalar, in order.
        let generator = |g: u8| 1 + usize::from(g) - algebra.numbers().start;
        let (mut sign, mut index) = (1, 0);
        for &g in generators {
            let (s, k) = algebra.basis_product(index, generator(g));
            (sign, index) = (sign * s, k);
        }
        self.steps.constant(Number::whole(i32::from(sign)), index)
    }

    fn name(&mut self, name: &str) -> Built {
        if let Some((_, id)) = self.frame.parameters.iter().find(|(parameter, _)| parameter == name) {
            return Ok(*id);
        }
        let unprimed = name.trim_end_matches('\'');
        if name != unprimed && self.frame.parameters.iter().any(|(parameter, _)| parameter == unprimed) {
            let message = format!("`{name}`, the derivative of a parameter, must be a parameter too");
            return Err(self.steps.error(message));
        }
        let ty = match self.names.get(name) {
            Some(Meaning::Value(ty)) => *ty,
            Some(Meaning::Function(definition)) if definition.parameters.is_empty() => {
                return self.call(name, &[]);
            }
            Some(_) => {
                return Err(self.steps.error(format!("`{name}` is a function; write `{name}(…)`")));
            }
            None => match self.substituted(name)? {
                Some(id) => return Ok(id),
                None if self.names.is_open() => Type::of(self.steps.all()),
                None if name.ends_with('\'') => {
                    let message = format!("`{name}` has no value; a derivative in this formula needs it");
                    return Err(self.steps.error(message));
                }
                None => return Err(self.steps.error(format!("`{name}` has no value"))),
            },
        };
        let input = self.steps.input(name, InputKind::Value(ty));
        self.steps.step(Op::Input(input), ty)
    }

    /// The value of a name whose indices have values.
    fn substituted(&mut self, name: &str) -> Result<Option<Id>, Error> {
        let Some((base, indices)) = indexed(name) else { return Ok(None) };
        let value = |c: char| self.frame.indices.iter().rev().find(|(index, _)| *index == c).map(|(_, k)| *k);
        let Some(values) = indices.chars().map(value).collect::<Option<Vec<usize>>>() else {
            return Ok(None);
        };
        let number = match (base, &values[..]) {
            ("δ", [i, j]) => Number::whole(i32::from(i == j)),
            ("ε", &[i, j, k]) => Number::whole(permutation([i, j, k])),
            ("e", &[k]) if self.names.get(&format!("e{k}")).is_none() => {
                return self.blade(&[k as u8]).map(Some);
            }
            _ => {
                let digits: String = values.iter().map(usize::to_string).collect();
                let primes = &name[base.len() + 1 + indices.len()..];
                return self.name(&format!("{base}{digits}{primes}")).map(Some);
            }
        };
        self.steps.constant(number, 0).map(Some)
    }

    fn sum(&mut self, terms: &[(bool, Node)]) -> Built {
        let mut sum = None;
        for (minus, term) in terms {
            let id = self.node(term)?;
            sum = Some(match sum {
                None if *minus => self.placed(term.span, |compiler| compiler.steps.negate(id))?,
                before => self.steps.add(*minus, before, id)?,
            });
        }
        sum.ok_or_else(|| self.steps.error("the sum has no terms"))
    }

    fn tight(&mut self, tight: Tight, operands: &[Node]) -> Built {
        let ids = self.nodes(operands)?;
        let product = match tight {
            Tight::Wedge | Tight::Cross => Product::Wedge,
            Tight::Dot => Product::Dot,
            Tight::Commutator => Product::Commutator,
            Tight::LeftContraction => Product::LeftContraction,
            Tight::RightContraction => Product::RightContraction,
        };
        if tight == Tight::Cross {
            if !self.steps.space.is_g3() {
                let message = "the cross product exists only in 3-d space; elsewhere write `a∧b` or its dual";
                return Err(self.steps.error(message));
            }
            for (node, &id) in operands.iter().zip(&ids) {
                self.require(id, Grades(0b10), "the cross product", node)?;
            }
        }
        let all = self.steps.all();
        let mut products = ids[1..].iter();
        let result = products.try_fold(ids[0], |result, &id| self.steps.product(product, result, id, all))?;
        if tight == Tight::Cross { self.steps.dual(result, false) } else { Ok(result) }
    }

    fn named(&mut self, function: Named, node: &Node) -> Built {
        let x = self.node(node)?;
        match function {
            Named::Function(Function::Inverse) => self.steps.inverse(x),
            Named::Function(f) => self.steps.function(f, x),
            Named::Norm => self.steps.step(Op::Norm(x), Type::SCALAR),
            Named::Dual => self.steps.dual(x, false),
            Named::Undual => self.steps.dual(x, true),
            Named::Reverse => self.steps.reverse(x),
            Named::Sin | Named::Cos | Named::Tan => {
                self.require(x, Grades::SCALAR, &format!("`{}`", function.name()), node)?;
                let op = match function {
                    Named::Sin => Op::Sin(x),
                    Named::Cos => Op::Cos(x),
                    _ => Op::Tan(x),
                };
                self.steps.step(op, Type::SCALAR)
            }
        }
    }

    fn call(&mut self, name: &str, arguments: &[Node]) -> Built {
        let ids = self.nodes(arguments)?;
        match (self.names.get(name), &ids[..]) {
            (Some(Meaning::Map { grade }), &[x]) => self.map(name, *grade, x, &arguments[0]),
            (Some(Meaning::Function(definition)), ids) => self.write_out(name, definition, ids),
            (Some(Meaning::Value(_)), _) => Err(self.steps.error(format!("`{name}` is not a function"))),
            // An open name.
            (None, &[argument]) => {
                let input = self.steps.input(name, InputKind::Matrix { grade: 1 });
                let ty = Type::of(self.steps.all());
                self.steps.step(Op::Map { input, argument }, ty)
            }
            (_, ids) => {
                let message = format!("`{name}` is a linear map, which takes 1 argument, got {}", ids.len());
                Err(self.steps.error(message))
            }
        }
    }

    /// Applies a linear map to each part.
    fn map(&mut self, name: &str, grade: u8, x: Id, node: &Node) -> Built {
        if !self.steps.space.is_g3() {
            return Err(self.steps.error("linear maps exist only in 3-d space"));
        }
        if grade == 2 {
            self.require(x, Grades::BIVECTOR, &format!("`{name}`, a map of bivectors,"), node)?;
        }
        let held = self.steps.ty(x).grades;
        let mut sum = None;
        for k in (0..=3).filter(|&k| held.contains(k) && (grade == 1 || k == 2)) {
            let part = self.steps.part(x, Grades(1 << k))?;
            let kind = match k {
                0 => None,
                3 => Some(InputKind::Determinant),
                _ => Some(InputKind::Matrix { grade: k as u8 }),
            };
            let image = match kind {
                None => part,
                Some(kind) => {
                    let input = self.steps.input(name, kind);
                    self.steps.step(Op::Map { input, argument: part }, Type::of(Grades(1 << k)))?
                }
            };
            sum = Some(self.steps.add(false, sum, image)?);
        }
        sum.ok_or_else(|| self.steps.error(format!("`{name}` has nothing to map")))
    }

    /// The value of a definition for these arguments.
    fn write_out(&mut self, name: &str, definition: &Definition, arguments: &[Id]) -> Built {
        if definition.parameters.len() != arguments.len() {
            let (count, found) = (definition.parameters.len(), arguments.len());
            return Err(self.steps.error(format!("`{name}` takes {count} arguments, got {found}")));
        }
        let call = self.steps.span;
        let parameters = definition.parameters.iter().cloned().zip(arguments.iter().copied()).collect();
        let frame = Frame { parameters, indices: Vec::new(), expanding: true };
        let outside = std::mem::replace(&mut self.frame, frame);
        let value = self.node(&definition.body);
        self.frame = outside;
        // Of nested definitions the innermost is named.
        value.map_err(|Error { message, .. }| {
            let named = message.starts_with("in `");
            Error::new(call, if named { message } else { format!("in `{name}`: {message}") })
        })
    }

    /// `Σ_k`: the sum over all values of the index.
    fn total(&mut self, index: &str, node: &Node) -> Built {
        let index = index.chars().next().unwrap_or('k');
        let mut sum = None;
        for k in self.steps.space.algebra.numbers() {
            self.frame.indices.push((index, k));
            let term = self.node(node)?;
            self.frame.indices.pop();
            sum = Some(self.steps.add(false, sum, term)?);
        }
        sum.ok_or_else(|| self.steps.error("the sum has no index"))
    }

    /// The free indices: an equation must hold for all their values.
    fn free_indices(&self, tree: &Tree) -> Result<Vec<char>, Error> {
        let mut free = Vec::new();
        if self.names.is_open() {
            return Ok(free);
        }
        for (index, _) in tree.sides.iter().flat_map(|side| indices_in(side, self.names)) {
            if !free.contains(&index) {
                free.push(index);
            }
        }
        let whole = tree.sides[0].span;
        match free[..] {
            [] => Ok(free),
            _ if free.len() > 3 => Err(Error::new(whole, "an equation may have at most three free indices")),
            [index, ..] if tree.sides.len() == 1 => Err(Error::new(
                whole,
                format!(
                    "the index {index} is free; write a sum as `Σ_{index}`, or an equation, which holds for every value"
                ),
            )),
            _ => Ok(free),
        }
    }

    /// The values of these indices in the `number`-th case.
    fn values_of(&self, free: &[char], mut number: usize) -> Vec<(char, usize)> {
        let n = self.steps.count().max(1);
        let first = self.steps.space.algebra.numbers().start;
        let digit = |&index: &char| {
            let k = number % n + first;
            number /= n;
            (index, k)
        };
        free.iter().map(digit).collect()
    }

    /// The sides of an equation must have a grade in common, unless one of them is 0.
    fn check_sides(&self, tree: &Tree, sides: &[Id]) -> Result<(), Error> {
        let zeros = self.steps.zeros();
        for (i, pair) in sides.windows(2).enumerate() {
            let (a, b) = (self.steps.ty(pair[0]).grades, self.steps.ty(pair[1]).grades);
            if a.0 & b.0 == 0 && !zeros[pair[0]] && !zeros[pair[1]] {
                let span = tree.sides[i].span.to(tree.sides[i + 1].span);
                let message = format!(
                    "the sides of the equation have no common grade, {} and {}: they agree only if both are 0",
                    shown(a),
                    shown(b)
                );
                return Err(Error::new(span, message));
            }
        }
        Ok(())
    }
}

/// `grade 1`, `grades 0, 2`.
fn shown(grades: Grades) -> String {
    let list = listed(grades);
    format!("grade{} {}", if list.len() == 1 { "" } else { "s" }, list.join(", "))
}
