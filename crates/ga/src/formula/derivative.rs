//! `(…)'`: the derivative of a formula by the product rule, in terms of the derivatives of its names, which
//! have names of their own: `(R v ~R)' = R' v ~R + R v' ~R + R v ~R'`.

use super::Error;
use super::tree::{Kind, Named, Node, Tight};

/// Powers above this are not written out.
const MOST_FACTORS: i32 = 32;

/// The derivative; `None` where it is zero, as of numbers and basis elements.
pub(crate) fn derivative(node: &Node) -> Result<Option<Node>, Error> {
    let made = |kind| Node::new(kind, node.span);
    let same = |inner: &Node, rebuild: &dyn Fn(Box<Node>) -> Kind| -> Result<Option<Node>, Error> {
        Ok(derivative(inner)?.map(|inner| made(rebuild(Box::new(inner)))))
    };
    match &node.kind {
        Kind::Number(_) | Kind::Pi | Kind::Blade(_) => Ok(None),
        Kind::Name(name) => Ok(Some(made(Kind::Name(format!("{name}'"))))),
        Kind::Sum(terms) => {
            let mut changing = Vec::new();
            for (minus, term) in terms {
                if let Some(term) = derivative(term)? {
                    changing.push((*minus, term));
                }
            }
            Ok((!changing.is_empty()).then(|| made(Kind::Sum(changing))))
        }
        Kind::Product(factors) => one_by_one(node, factors, &Kind::Product),
        Kind::Tight(Tight::Wedge, operands) => one_by_one(node, operands, &|x| Kind::Tight(Tight::Wedge, x)),
        Kind::Tight(tight, operands) => one_by_one(node, operands, &|x| Kind::Tight(*tight, x)),
        // (A B⁻¹)' = A' B⁻¹ − A B⁻¹ B' B⁻¹
        Kind::Quotient(pair) => {
            let (a, b) = &**pair;
            let over = |a: Node| made(Kind::Quotient(Box::new((a, b.clone()))));
            let mut terms: Vec<(bool, Node)> = derivative(a)?.map(|a| (false, over(a))).into_iter().collect();
            if let Some(b) = derivative(b)? {
                terms.push((true, over(made(Kind::Product(vec![node.clone(), b])))));
            }
            Ok((!terms.is_empty()).then(|| made(Kind::Sum(terms))))
        }
        Kind::Reverse(x) => same(x, &Kind::Reverse),
        Kind::Part(x, grades) => same(x, &|x| Kind::Part(x, *grades)),
        Kind::Total(index, x) => same(x, &|x| Kind::Total(index.clone(), x)),
        Kind::Function(f @ (Named::Dual | Named::Undual | Named::Reverse), x) => {
            same(x, &|x| Kind::Function(*f, x))
        }
        Kind::Power(x, n) if (1..=MOST_FACTORS).contains(n) => {
            let factors = vec![(**x).clone(); *n as usize];
            derivative(&if *n == 1 { (**x).clone() } else { made(Kind::Product(factors)) })
        }
        // (A⁻¹)' = −A⁻¹ A' A⁻¹
        Kind::Power(x, -1) => Ok(derivative(x)?.map(|x| {
            let term = made(Kind::Product(vec![node.clone(), x, node.clone()]));
            made(Kind::Sum(vec![(true, term)]))
        })),
        Kind::Derivative(x) => match derivative(x)? {
            Some(x) => derivative(&x),
            None => Ok(None),
        },
        Kind::Power(..) | Kind::Function(..) | Kind::Call(..) => Err(Error::new(
            node.span,
            "a prime means the derivative by the product rule, which knows sums and products only; \
             give this part a name, and its derivative the primed name",
        )),
    }
}

/// The product rule.
fn one_by_one(
    node: &Node,
    factors: &[Node],
    rebuild: &dyn Fn(Vec<Node>) -> Kind,
) -> Result<Option<Node>, Error> {
    let mut terms = Vec::new();
    for (i, factor) in factors.iter().enumerate() {
        if let Some(factor) = derivative(factor)? {
            let mut factors = factors.to_vec();
            factors[i] = factor;
            terms.push((false, Node::new(rebuild(factors), node.span)));
        }
    }
    Ok((!terms.is_empty()).then(|| Node::new(Kind::Sum(terms), node.span)))
}
