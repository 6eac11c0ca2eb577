//! Syntax trees of formulas; each node has its place in the text.

use super::number::Number;
use crate::g3::functions::Function;
use crate::product::Grades;

/// A piece of the text, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
}

impl Span {
    /// The span of both and the text between them.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// A formula: one side, or the sides of an equation `lhs = rhs`, which may go on, `a = b = c`.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// At least one.
    pub sides: Vec<Node>,
}

impl Tree {
    /// Every node, each before its children.
    pub fn nodes(&self) -> Vec<&Node> {
        let mut nodes = Vec::new();
        for side in &self.sides {
            side.visit(&mut |node| nodes.push(node));
        }
        nodes
    }
}

/// A part of a formula. Brackets are not nodes; they shape the tree.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its kind.
    pub kind: Kind,
    /// Its place, without brackets around it.
    pub span: Span,
    /// The number of its levels.
    height: usize,
}

/// Nodes are equal if they are the same formula, in any place.
impl PartialEq for Node {
    fn eq(&self, other: &Node) -> bool {
        self.kind == other.kind
    }
}

macro_rules! children {
    ($node:ident, $iter:ident $(, $mut:ident)?) => {
        match &$($mut)? $node.kind {
            Kind::Number(_) | Kind::Pi | Kind::Blade(_) | Kind::Pseudoscalar | Kind::Name(_) => Vec::new(),
            Kind::Sum(terms) => terms.$iter().map(|(_, term)| term).collect(),
            Kind::Product(nodes) | Kind::Call(_, nodes) | Kind::Tight(_, nodes) => nodes.$iter().collect(),
            Kind::Quotient(pair) => vec![&$($mut)? pair.0, &$($mut)? pair.1],
            Kind::Reverse(x)
            | Kind::Power(x, _)
            | Kind::Part(x, _)
            | Kind::Function(_, x)
            | Kind::Derivative(x)
            | Kind::Total(_, x) => vec![x],
        }
    };
}

impl Node {
    /// A node.
    pub fn new(kind: Kind, span: Span) -> Node {
        let mut node = Node { kind, span, height: 1 };
        node.height += node.children().iter().map(|child| child.height).max().unwrap_or(0);
        node
    }

    /// The number of levels of the tree, when it was made.
    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// The node without brackets that are kept as a product of one factor.
    pub(crate) fn without_brackets(self) -> Node {
        match self.kind {
            Kind::Product(mut factors) if factors.len() == 1 => factors.remove(0),
            kind => Node { kind, ..self },
        }
    }

    /// Calls a function with the node and all its descendants.
    pub(crate) fn visit<'n>(&'n self, f: &mut impl FnMut(&'n Node)) {
        f(self);
        for child in self.children() {
            child.visit(f);
        }
    }

    /// Its children, from left to right.
    pub fn children(&self) -> Vec<&Node> {
        children!(self, iter)
    }

    /// Its children, mutable.
    pub(crate) fn children_mut(&mut self) -> Vec<&mut Node> {
        children!(self, iter_mut, mut)
    }
}

/// The kinds of nodes.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// `2`, `0.5`, `½`; never negative.
    Number(Number),
    /// `π`
    Pi,
    /// `e1`, `e12`: the generators in the order written, from 1.
    Blade(Vec<u8>),
    /// `I`, the product of all generators.
    Pseudoscalar,
    /// A value, by its canonical name.
    Name(String),
    /// `a + b − c`, or `−a` alone: for each term, whether it is subtracted.
    Sum(Vec<(bool, Node)>),
    /// The geometric product of two or more factors; of one that needs its brackets, as `(ab)` of open names.
    Product(Vec<Node>),
    /// `A/B`, that is `A B⁻¹`.
    Quotient(Box<(Node, Node)>),
    /// A product that binds tighter; `∧` of two or more operands, the others of two.
    Tight(Tight, Vec<Node>),
    /// `~A`
    Reverse(Box<Node>),
    /// `Aⁿ`
    Power(Box<Node>, i32),
    /// `⟨A⟩_k`
    Part(Box<Node>, Grades),
    /// `exp(A)`
    Function(Named, Box<Node>),
    /// A linear map or a defined function, by its canonical name.
    Call(String, Vec<Node>),
    /// `(…)'`, the derivative by the product rule from primed names.
    Derivative(Box<Node>),
    /// `Σ_k A`: the sum over the index from 1 to the number of generators.
    Total(String, Box<Node>),
}

/// The products that bind tighter than the geometric product.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tight {
    /// `A∧B`
    Wedge,
    /// `A·B`
    Dot,
    /// `A×B = ½(AB − BA)`
    Commutator,
    /// `a⨯b = dual(a∧b)`, of vectors of 3-d space
    Cross,
    /// `A⌋B`
    LeftContraction,
    /// `A⌊B`
    RightContraction,
}

impl Tight {
    /// Every one.
    pub const ALL: [Tight; 6] = {
        use Tight::{Commutator, Cross, Dot, LeftContraction, RightContraction, Wedge};
        [Wedge, Dot, Commutator, Cross, LeftContraction, RightContraction]
    };

    /// The sign on paper.
    pub fn symbol(self) -> char {
        ['∧', '·', '×', '⨯', '⌋', '⌊'][self as usize]
    }

    /// Its name as a function, which is also its ASCII spelling apart from `^` and `|`.
    pub fn name(self) -> &'static str {
        ["wedge", "dot", "commutator", "cross", "left_contraction", "right_contraction"][self as usize]
    }
}

/// The named functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Named {
    /// `exp`, `log`, `sqrt`, `inverse`.
    Function(Function),
    /// `norm(A) = √⟨A ~A⟩`
    Norm,
    /// `dual(A) = A I⁻¹`
    Dual,
    /// `undual(A) = A I`
    Undual,
    /// `reverse(A)`, which is written `~A` again.
    Reverse,
    /// `sin` of a scalar.
    Sin,
    /// `cos` of a scalar.
    Cos,
    /// `tan` of a scalar.
    Tan,
}

impl Named {
    /// Every one.
    pub const ALL: [Named; 11] = [
        Named::Function(Function::Exp),
        Named::Function(Function::Log),
        Named::Function(Function::Sqrt),
        Named::Function(Function::Inverse),
        Named::Norm,
        Named::Dual,
        Named::Undual,
        Named::Reverse,
        Named::Sin,
        Named::Cos,
        Named::Tan,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Named::Function(f) => f.name(),
            Named::Norm => "norm",
            Named::Dual => "dual",
            Named::Undual => "undual",
            Named::Reverse => "reverse",
            Named::Sin => "sin",
            Named::Cos => "cos",
            Named::Tan => "tan",
        }
    }

    /// The function of this name.
    pub fn from_name(name: &str) -> Option<Named> {
        Named::ALL.into_iter().find(|f| f.name() == name)
    }
}

/// Whether a node contains only numbers.
pub(crate) fn is_numeric(node: &Node) -> bool {
    match &node.kind {
        Kind::Number(_) | Kind::Pi => true,
        Kind::Sum(_) | Kind::Product(_) | Kind::Quotient(_) | Kind::Power(..) => {
            node.children().into_iter().all(is_numeric)
        }
        _ => false,
    }
}

/// The numbers of some grades.
pub(crate) fn listed(grades: Grades) -> Vec<String> {
    (0..16).filter(|&k| grades.contains(k)).map(|k| k.to_string()).collect()
}

/// The operand of reverses and powers: in `(ab²)·c` the name of several letters.
pub(crate) fn core(node: &Node) -> &Node {
    match &node.kind {
        Kind::Reverse(x) | Kind::Function(Named::Reverse, x) | Kind::Power(x, _) => core(x),
        _ => node,
    }
}
