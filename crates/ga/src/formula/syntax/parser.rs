//! Recursive-descent parser from items to a tree.
//!
//! It limits nested brackets and the height of trees, so that neither the parser nor walks over its trees overflow the
//! stack.

mod ambiguity;
mod exponent;
mod operand;
mod unexpected;

use super::grades;
use super::indices::sum_repeated;
use super::names::Names;
use super::number::{FRACTIONS, Number};
use super::reading::read;
use super::token::{Item, Token};
use super::tree::{Kind, Named, Node, Span, Tight, Tree, is_numeric};
use crate::formula::{Error, MAX_DEPTH, Space};

/// Levels of a tree. A bracket makes at most four (sum, product, quotient, tight product).
const MAX_HEIGHT: usize = 4 * MAX_DEPTH;

/// Parses a formula with these names.
///
/// # Errors
/// With the place in the text, and what to do.
pub fn parse(text: &str, space: Space, names: &Names) -> Result<Tree, Error> {
    let items = read(text, space, names)?;
    if items.is_empty() {
        return Err(Error::new(Span::default(), "the formula is empty"));
    }
    let mut parser = Parser { text, space, names, items, at: 0, depth: 0 };
    let mut sides = vec![parser.sum()?];
    while parser.eat(&Item::Equals) {
        sides.push(parser.sum()?);
    }
    match parser.peek() {
        None => Ok(Tree { sides: sum_repeated(sides, names)? }),
        Some(_) => Err(parser.unexpected()),
    }
}

type Parsed = Result<Node, Error>;

struct Parser<'a> {
    text: &'a str,
    space: Space<'a>,
    names: &'a Names,
    items: Vec<Token>,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    // --- the items

    fn peek(&self) -> Option<&Item> {
        self.ahead(0).map(|token| &token.item)
    }

    fn ahead(&self, count: usize) -> Option<&Token> {
        self.items.get(self.at + count)
    }

    fn is(&self, item: &Item) -> bool {
        self.peek() == Some(item)
    }

    fn eat(&mut self, item: &Item) -> bool {
        let found = self.is(item);
        self.at += usize::from(found);
        found
    }

    /// The place of the next item, or the end of the text.
    fn span(&self) -> Span {
        let end = Span { start: self.text.len(), end: self.text.len() };
        self.ahead(0).map_or(end, |read| read.span)
    }

    /// From `start` to the last item that was read.
    fn since(&self, start: Span) -> Span {
        start.to(self.items[self.at.max(1) - 1].span)
    }

    fn slice(&self, span: Span) -> &str {
        self.text.get(span.start..span.end).unwrap_or_default()
    }

    fn build(&self, kind: Kind, span: Span) -> Parsed {
        let node = Node::new(kind, span);
        if node.height() > MAX_HEIGHT { Err(too_deep(span)) } else { Ok(node) }
    }

    /// Parses an inner part, one level deeper.
    fn nested<T>(
        &mut self,
        span: Span,
        part: impl FnOnce(&mut Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(too_deep(span));
        }
        let part = part(self)?;
        self.depth -= 1;
        Ok(part)
    }

    // --- the grammar, loosest first

    fn sum(&mut self) -> Parsed {
        let start = self.span();
        let mut minus = self.eat(&Item::Minus);
        if !minus {
            self.eat(&Item::Plus);
        }
        let first = self.product()?;
        if !minus && !matches!(self.peek(), Some(Item::Plus | Item::Minus)) {
            return Ok(first);
        }
        let mut terms = vec![(minus, first)];
        loop {
            minus = self.eat(&Item::Minus);
            if !minus && !self.eat(&Item::Plus) {
                return self.build(Kind::Sum(terms), self.since(start));
            }
            terms.push((minus, self.product()?));
        }
    }

    fn product(&mut self) -> Parsed {
        let start = self.span();
        let mut factors = vec![self.tight()?];
        loop {
            if self.eat(&Item::Star) {
                factors = self.before_another(factors)?;
                factors.push(self.tight()?);
            } else if self.eat(&Item::Slash) {
                let divisor_start = self.span();
                let divisor = self.prefix()?;
                self.check_divisor(start, divisor_start)?;
                let numerator = self.joined(factors, start)?;
                let kind = match written_fraction(&numerator, &divisor) {
                    Some(fraction) => Kind::Number(fraction),
                    None => Kind::Quotient(Box::new((numerator, divisor))),
                };
                factors = vec![self.build(kind, self.since(start))?];
            } else if self.begins_operand() {
                self.check_juxtaposition(&factors)?;
                factors = self.before_another(factors)?;
                factors.push(self.tight()?);
            } else {
                return self.joined(factors, start);
            }
        }
    }

    /// Keeps the brackets of `(x∧m) v` with a number m, without which it is ambiguous.
    fn before_another(&self, mut factors: Vec<Node>) -> Result<Vec<Node>, Error> {
        let keeps = |factor: &mut Node| match &factor.kind {
            Kind::Tight(_, operands) => self.ends_in_number(operands) && !grades::is_loose(factor),
            _ => false,
        };
        if let Some(last) = factors.pop_if(keeps) {
            factors.push(self.in_brackets(last)?);
        }
        Ok(factors)
    }

    fn joined(&self, factors: Vec<Node>, start: Span) -> Parsed {
        match <[Node; 1]>::try_from(factors) {
            Ok([factor]) => Ok(factor),
            Err(factors) => self.build(Kind::Product(factors), self.since(start)),
        }
    }

    fn begins_operand(&self) -> bool {
        use Item::*;
        let Some(item) = self.peek() else { return false };
        let named = matches!(item, Name(_) | Callable(..) | Function(_) | Product(_) | Euler | Total(_));
        named || matches!(item, Number(_) | Pi | Blade(_) | Pseudoscalar | Open(_) | OpenAngle | Tilde)
    }

    fn tight_sign(&self) -> Option<Tight> {
        match self.peek() {
            Some(Item::Caret) => Some(Tight::Wedge),
            Some(Item::Tight(tight)) => Some(*tight),
            _ => None,
        }
    }

    fn tight(&mut self) -> Parsed {
        let start = self.span();
        let first = self.prefix()?;
        let Some(tight) = self.tight_sign() else { return Ok(first) };
        let mut spans = vec![self.since(start)];
        let mut operands = vec![first];
        while self.tight_sign() == Some(tight) && (tight == Tight::Wedge || operands.len() < 2) {
            let caret = self.is(&Item::Caret);
            self.at += 1;
            let begin = self.span();
            let operand = self.prefix()?;
            spans.push(self.since(begin));
            if caret && is_numeric(&operand) {
                let message = "a power must be a whole number: `A^2`, `A^-1`; write other powers of a rotor as `exp(½ log(R))`";
                return Err(Error::new(self.since(begin), message));
            }
            operands.push(operand);
        }
        if let Some(other) = self.tight_sign() {
            self.at += 1;
            let begin = self.span();
            self.prefix()?;
            return Err(self.ambiguous(tight, &other.symbol().to_string(), &spans, self.since(begin)));
        }
        if self.begins_operand() && self.ends_in_number(&operands) {
            let begin = self.span();
            self.prefix()?;
            return Err(self.ambiguous(tight, " ", &spans, self.since(begin)));
        }
        self.build(Kind::Tight(tight, operands), self.since(start))
    }

    fn prefix(&mut self) -> Parsed {
        let start = self.span();
        let (tilde, minus) = (self.is(&Item::Tilde), self.is(&Item::Minus));
        if !tilde && !minus {
            return self.postfix();
        }
        self.at += 1;
        let operand = self.nested(start, Self::prefix)?;
        let kind = if tilde { Kind::Reverse(Box::new(operand)) } else { Kind::Sum(vec![(true, operand)]) };
        self.build(kind, self.since(start))
    }

    fn postfix(&mut self) -> Parsed {
        let start = self.span();
        let reversed = self.ahead(0).is_some_and(|token| token.reversed);
        let mut operand = self.primary()?;
        if reversed {
            operand = self.build(Kind::Reverse(Box::new(operand)), self.since(start))?;
        }
        let mut powered = false;
        loop {
            let kind = if let Some(n) = self.power()? {
                if powered {
                    return Err(Error::new(self.since(start), "a power of a power needs brackets: `(A²)³`"));
                }
                powered = true;
                Kind::Power(Box::new(operand), n)
            } else if self.eat(&Item::Dagger) || self.eat_tilde_behind() {
                self.reversed(operand)
            } else if self.is(&Item::Prime) {
                if matches!(self.items[self.at - 1].item, Item::Number(_)) {
                    let message = "a prime means a derivative, not minutes of arc or feet";
                    return Err(Error::new(self.span(), message));
                }
                self.at += 1;
                Kind::Derivative(Box::new(operand.without_brackets()))
            } else {
                return Ok(operand);
            };
            operand = self.build(kind, self.since(start))?;
        }
    }

    /// `A~`: of an open name of several letters the sign stays behind it, for as letters `ab~` is `a ~b`.
    fn reversed(&self, operand: Node) -> Kind {
        match operand.kind {
            Kind::Function(Named::Reverse, x) => x.kind,
            _ if self.runs_together(&operand) => Kind::Function(Named::Reverse, Box::new(operand)),
            _ => Kind::Reverse(Box::new(operand)),
        }
    }

    /// Consumes the tilde of `A~`, which directly follows an operand and does not directly precede another.
    fn eat_tilde_behind(&mut self) -> bool {
        let behind = self.is(&Item::Tilde) && self.ahead(0).is_some_and(|tilde| !tilde.space);
        self.at += 1;
        let before = self.begins_operand() && self.ahead(0).is_some_and(|next| !next.space);
        let found = behind && !before;
        self.at -= usize::from(!found);
        found
    }
}

fn too_deep(span: Span) -> Error {
    Error::new(span, format!("more than {MAX_DEPTH} nested levels; define the inner parts first"))
}

/// `1/2` is the number ½; likewise the other fractions that are one character.
fn written_fraction(numerator: &Node, divisor: &Node) -> Option<Number> {
    let whole = |node: &Node| match &node.kind {
        Kind::Number(Number { ratio: Some((n, 1)), .. }) => Some(*n),
        _ => None,
    };
    let (n, d) = (whole(numerator)?, whole(divisor)?);
    let known = FRACTIONS.iter().any(|fraction| (fraction.1, fraction.2) == (n, d));
    if known { Number::ratio(n.into(), d.into()) } else { None }
}
