//! `(…)'`: the derivative of a formula by the product rule.
//!
//! It uses the derivatives of names, which are the primed names: `(R v ~R)' = R' v ~R + R v' ~R + R v ~R'`.

use crate::formula::Error;
use crate::formula::syntax::indices::is_built_in;
use crate::formula::syntax::names::{Meaning, Names};
use crate::formula::syntax::tree::{Kind, Named, Node};

/// Powers above this are not expanded.
const MOST_FACTORS: i32 = 32;

/// The error for a formula that grows beyond bounds.
pub(crate) const TOO_LONG: &str =
    "the formula is too long when its definitions, sums and derivatives are expanded";

/// The product rule. A product becomes one term for each factor, so the nodes are counted.
pub(crate) struct Derivation<'a> {
    pub names: &'a Names,
    /// The remaining number of nodes.
    pub left: &'a mut usize,
}

type Derived = Result<Option<Node>, Error>;

impl Derivation<'_> {
    /// The derivative; `None` where it is zero, as of numbers and basis elements.
    pub fn of(&mut self, node: &Node) -> Derived {
        self.count(1, node)?;
        let new = |kind| Node::new(kind, node.span);
        match &node.kind {
            Kind::Number(_) | Kind::Pi | Kind::Blade(_) | Kind::Pseudoscalar => Ok(None),
            Kind::Name(name) if is_built_in(name) && self.names.get(name).is_none() => Ok(None),
            Kind::Name(name) => Ok(Some(new(Kind::Name(format!("{name}'"))))),
            Kind::Sum(terms) => {
                let mut changing = Vec::new();
                for (minus, term) in terms {
                    changing.extend(self.of(term)?.map(|term| (*minus, term)));
                }
                Ok(sum(changing, node))
            }
            Kind::Product(factors) => self.one_by_one(node, factors, &Kind::Product),
            Kind::Tight(tight, operands) => {
                self.one_by_one(node, operands, &|operands| Kind::Tight(*tight, operands))
            }
            Kind::Quotient(pair) => self.quotient(node, &pair.0, &pair.1),
            Kind::Reverse(x) => self.same(x, node, Kind::Reverse),
            Kind::Part(x, grades) => self.same(x, node, |x| Kind::Part(x, *grades)),
            Kind::Total(index, x) => self.same(x, node, |x| Kind::Total(index.clone(), x)),
            Kind::Function(f @ (Named::Dual | Named::Undual | Named::Reverse), x) => {
                self.same(x, node, |x| Kind::Function(*f, x))
            }
            Kind::Power(x, 1) => self.of(x),
            Kind::Power(x, n) if (2..=MOST_FACTORS).contains(n) => {
                let factors = (0..*n).map(|_| self.copy(x)).collect::<Result<_, _>>()?;
                self.of(&new(Kind::Product(factors)))
            }
            // (A⁻¹)' = −A⁻¹ A' A⁻¹
            Kind::Power(x, -1) => {
                let Some(x) = self.of(x)? else { return Ok(None) };
                let term = new(Kind::Product(vec![self.copy(node)?, x, self.copy(node)?]));
                Ok(Some(new(Kind::Sum(vec![(true, term)]))))
            }
            Kind::Derivative(x) => self.of(x)?.map_or(Ok(None), |x| self.of(&x)),
            // Linear maps, such as the inertia in body axes, are constant.
            Kind::Call(name, arguments) if matches!(self.names.get(name), Some(Meaning::Map { .. })) => {
                let rate = arguments.first().map_or(Ok(None), |x| self.of(x))?;
                Ok(rate.map(|rate| new(Kind::Call(name.clone(), vec![rate]))))
            }
            Kind::Power(..) | Kind::Function(..) | Kind::Call(..) => Err(Error::new(
                node.span,
                "a prime is the derivative by the product rule, for sums, products and linear maps only; \
                 give this part a name, and its derivative the primed name",
            )),
        }
    }

    fn count(&mut self, nodes: usize, node: &Node) -> Result<(), Error> {
        *self.left = self.left.checked_sub(nodes).ok_or_else(|| Error::new(node.span, TOO_LONG))?;
        Ok(())
    }

    fn copy(&mut self, node: &Node) -> Result<Node, Error> {
        let mut nodes = 0;
        node.visit(&mut |_| nodes += 1);
        self.count(nodes, node)?;
        Ok(node.clone())
    }

    /// The derivative of an expression that is linear in x.
    fn same(&mut self, x: &Node, node: &Node, rebuild: impl Fn(Box<Node>) -> Kind) -> Derived {
        Ok(self.of(x)?.map(|x| Node::new(rebuild(Box::new(x)), node.span)))
    }

    /// (A B⁻¹)' = A' B⁻¹ − A B⁻¹ B' B⁻¹
    fn quotient(&mut self, node: &Node, a: &Node, b: &Node) -> Derived {
        let mut terms = Vec::new();
        let over = |a: Node, b: Node| Node::new(Kind::Quotient(Box::new((a, b))), node.span);
        if let Some(a) = self.of(a)? {
            terms.push((false, over(a, self.copy(b)?)));
        }
        if let Some(rate) = self.of(b)? {
            let product = Node::new(Kind::Product(vec![self.copy(node)?, rate]), node.span);
            terms.push((true, over(product, self.copy(b)?)));
        }
        Ok(sum(terms, node))
    }

    /// (A B C)' = A' B C + A B' C + A B C'
    fn one_by_one(&mut self, node: &Node, factors: &[Node], rebuild: &dyn Fn(Vec<Node>) -> Kind) -> Derived {
        let mut terms = Vec::new();
        for (i, factor) in factors.iter().enumerate() {
            let Some(changing) = self.of(factor)? else { continue };
            let mut copies = factors[..i].iter().map(|x| self.copy(x)).collect::<Result<Vec<_>, _>>()?;
            copies.push(changing);
            for x in &factors[i + 1..] {
                copies.push(self.copy(x)?);
            }
            terms.push((false, Node::new(rebuild(copies), node.span)));
        }
        Ok(sum(terms, node))
    }
}

/// The sum of the terms of a node's derivative; zero if there are none.
fn sum(terms: Vec<(bool, Node)>, node: &Node) -> Option<Node> {
    (!terms.is_empty()).then(|| Node::new(Kind::Sum(terms), node.span))
}
