//! Recursive-descent parser from items to a tree.
//!
//! It limits nested brackets and the height of trees, so that neither the parser nor walks over its trees overflow the
//! stack.

use super::indices::sum_repeated;
use super::names::Names;
use super::number::FRACTIONS;
use super::number::Number;
use super::reading::{Item, Read, read};
use super::token::{Sign, tokens};
use super::tree::{Kind, Node, Span, Tight, Tree, is_numeric};
use crate::formula::{Error, MAX_DEPTH, Space};

/// Levels of a tree. A bracket makes at most four (sum, product, quotient, tight product).
const MAX_HEIGHT: usize = 4 * MAX_DEPTH;

/// Parses a formula with these names.
///
/// # Errors
/// With the place in the text, and what to do.
pub fn parse(text: &str, space: Space, names: &Names) -> Result<Tree, Error> {
    let items = read(&tokens(text)?, space, names)?;
    if items.is_empty() {
        return Err(Error::new(Span::default(), "the formula is empty"));
    }
    let mut parser = Parser { text, space, names, items, at: 0, depth: 0 };
    let mut sides = vec![parser.sum()?.node];
    while parser.eat(&Sign::Equals) {
        sides.push(parser.sum()?.node);
    }
    match parser.peek() {
        None => Ok(Tree { sides: sum_repeated(sides, names)? }),
        Some(_) => Err(parser.unexpected()),
    }
}

/// A node and its height.
pub(crate) struct Built {
    pub node: Node,
    pub height: usize,
}

pub(crate) type Parsed = Result<Built, Error>;

pub(crate) struct Parser<'a> {
    pub text: &'a str,
    pub space: Space<'a>,
    pub names: &'a Names,
    pub items: Vec<Read>,
    pub at: usize,
    pub depth: usize,
}

impl Parser<'_> {
    // --- the items

    pub fn peek(&self) -> Option<&Item> {
        self.items.get(self.at).map(|read| &read.item)
    }

    pub fn ahead(&self, count: usize) -> Option<&Read> {
        self.items.get(self.at + count)
    }

    pub fn is(&self, sign: &Sign) -> bool {
        matches!(self.peek(), Some(Item::Sign(found)) if found == sign)
    }

    pub fn eat(&mut self, sign: &Sign) -> bool {
        let found = self.is(sign);
        self.at += usize::from(found);
        found
    }

    /// The place of the next item, or the end of the text.
    pub fn span(&self) -> Span {
        let end = Span { start: self.text.len(), end: self.text.len() };
        self.ahead(0).map_or(end, |read| read.span)
    }

    /// From `start` to the last item that was read.
    pub fn since(&self, start: Span) -> Span {
        start.to(self.items[self.at.max(1) - 1].span)
    }

    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.start..span.end).unwrap_or_default()
    }

    pub fn unexpected(&self) -> Error {
        let Some(read) = self.ahead(0) else {
            return Error::new(
                self.span(),
                "the formula ends where a name, a number or an opening bracket is expected",
            );
        };
        let text = self.slice(read.span);
        let message = match &read.item {
            Item::Sign(Sign::Close(_) | Sign::CloseAngle) if self.depth == 0 => {
                format!("`{text}` closes no bracket")
            }
            Item::Sign(Sign::Tight(Tight::Dot)) if text == "|" => {
                "`|` is a dot product, `a|b`, and needs its left factor; a magnitude is `norm(a)`".to_owned()
            }
            Item::Sign(Sign::Comma) => "commas are allowed only between arguments of a function".to_owned(),
            Item::Sign(Sign::Underscore) => "a subscript must directly follow a letter or `⟨…⟩`".to_owned(),
            Item::Subscript(_) => "a subscript must directly follow a letter or `⟩`".to_owned(),
            Item::Sign(Sign::Prime) => "a prime must directly follow a letter or a bracket".to_owned(),
            Item::Superscript(_) => "a power must follow its base; powers of powers need brackets".to_owned(),
            _ => format!("expected a name, a number or an opening bracket, got `{text}`"),
        };
        Error::new(read.span, message)
    }

    pub fn build(&self, kind: Kind, span: Span, height: usize) -> Parsed {
        if height >= MAX_HEIGHT {
            return Err(too_deep(span));
        }
        Ok(Built { node: Node::new(kind, span), height: height + 1 })
    }

    // --- the grammar, loosest first

    pub fn sum(&mut self) -> Parsed {
        let start = self.span();
        let mut minus = self.eat(&Sign::Minus);
        if !minus {
            self.eat(&Sign::Plus);
        }
        let mut terms = Vec::new();
        let mut height = 0;
        loop {
            let term = self.product()?;
            height = height.max(term.height);
            terms.push((minus, term));
            minus = self.is(&Sign::Minus);
            if !minus && !self.is(&Sign::Plus) {
                break;
            }
            self.at += 1;
        }
        if let [(false, _)] = terms[..] {
            return terms.pop().map(|(_, term)| term).ok_or_else(|| self.unexpected());
        }
        let terms = terms.into_iter().map(|(minus, term)| (minus, term.node)).collect();
        self.build(Kind::Sum(terms), self.since(start), height)
    }

    pub fn product(&mut self) -> Parsed {
        let start = self.span();
        let mut factors = vec![self.tight()?];
        loop {
            if self.eat(&Sign::Star) {
                factors.push(self.tight()?);
            } else if self.eat(&Sign::Slash) {
                let divisor_start = self.span();
                let divisor = self.prefix()?;
                self.check_divisor(start, divisor_start)?;
                let numerator = self.joined(factors, start)?;
                let span = self.since(start);
                let height = numerator.height.max(divisor.height);
                let kind = match written_fraction(&numerator.node, &divisor.node) {
                    Some(fraction) => Kind::Number(fraction),
                    None => Kind::Quotient(Box::new((numerator.node, divisor.node))),
                };
                factors = vec![self.build(kind, span, height)?];
            } else if self.begins_operand() {
                self.check_juxtaposition(&factors)?;
                factors.push(self.tight()?);
            } else {
                return self.joined(factors, start);
            }
        }
    }

    fn joined(&self, mut factors: Vec<Built>, start: Span) -> Parsed {
        if factors.len() == 1
            && let Some(factor) = factors.pop()
        {
            return Ok(factor);
        }
        let height = factors.iter().map(|factor| factor.height).max().unwrap_or(0);
        let factors: Vec<Node> = factors.into_iter().map(|factor| factor.node).collect();
        self.build(Kind::Product(factors), self.since(start), height)
    }

    /// `x/2a` may mean `(x/2) a` or `x/(2a)`, and only a space decides; so may `1/2·x`.
    fn check_divisor(&mut self, start: Span, divisor: Span) -> Result<(), Error> {
        if let Some(tight) = self.tight_sign() {
            let x = self.slice(self.since(divisor)).to_owned();
            self.at += 1;
            let begin = self.span();
            self.prefix()?;
            let (sign, y, span) = (tight.symbol(), self.slice(self.since(begin)), self.since(start));
            let message = format!("ambiguous divisor; write `(…/{x}){sign}{y}` or `…/({x}{sign}{y})`");
            return Err(Error::new(span, message));
        }
        if !self.begins_operand() || self.ahead(0).is_some_and(|read| read.space) {
            return Ok(());
        }
        let span = self.since(start).to(self.span());
        let (x, y) = (self.slice(self.since(divisor)), self.slice(self.span()));
        let y = if y == "(" || y == "[" || y == "{" || y == "⟨" || y == "<" { "(…)" } else { y };
        let message =
            format!("ambiguous divisor; write `…/{x} {y}` with a space for `(…/{x}) {y}`, or `…/({x} {y})`");
        Err(Error::new(span, message))
    }

    /// Fails for adjacent operands that are probably not meant as a product.
    fn check_juxtaposition(&self, factors: &[Built]) -> Result<(), Error> {
        let (Some(last), Some(next)) = (factors.last(), self.ahead(0)) else { return Ok(()) };
        let before = &self.items[self.at - 1];
        match (&before.item, &next.item) {
            (Item::Number(_), Item::Number(_)) => {
                let (x, y) = (self.slice(before.span), self.slice(next.span));
                let message = format!(
                    "two numbers side by side; write `{x}*{y}` for their product, `{x}+{y}` for their sum"
                );
                Err(Error::new(before.span.to(next.span), message))
            }
            (Item::Sign(Sign::Close(_) | Sign::CloseAngle), Item::Number(_)) if !next.space => {
                Err(Error::new(
                    next.span,
                    "a number right after a bracket; write a power as `(…)^2`, or the factor before the bracket",
                ))
            }
            (Item::Name(name), Item::Sign(Sign::Open('(')))
                if !next.space && last.node.kind == Kind::Name(name.clone()) =>
            {
                self.check_application(name)
            }
            _ => Ok(()),
        }
    }

    /// Fails for `R(x)` with a value R, which looks like a function of x.
    fn check_application(&self, name: &str) -> Result<(), Error> {
        let (argument, close) = (self.ahead(1), self.ahead(2));
        let alone = argument.is_some_and(|a| matches!(a.item, Item::Name(_) | Item::Number(_)))
            && close.is_some_and(|c| c.item == Item::Sign(Sign::Close('(')));
        if self.names.is_open() || !alone {
            return Ok(());
        }
        let x = argument.map_or("", |argument| self.slice(argument.span));
        let span = self.items[self.at - 1].span.to(close.map_or(self.span(), |close| close.span));
        Err(Error::new(
            span,
            format!(
                "`{name}({x})` looks like a function of {x}, but `{name}` is a value: write `{name} {x}` for the product, \
                 `{name} {x} ~{name}` for {x} turned by a rotor, or give `{name}({x})` itself a value"
            ),
        ))
    }

    pub fn begins_operand(&self) -> bool {
        match self.peek() {
            Some(Item::Sign(sign)) => matches!(sign, Sign::Open(_) | Sign::OpenAngle | Sign::Tilde),
            Some(Item::Superscript(_) | Item::Subscript(_)) | None => false,
            Some(_) => true,
        }
    }

    fn tight_sign(&self) -> Option<Tight> {
        match self.peek() {
            Some(Item::Sign(Sign::Caret)) => Some(Tight::Wedge),
            Some(Item::Sign(Sign::Tight(tight))) => Some(*tight),
            _ => None,
        }
    }

    fn tight(&mut self) -> Parsed {
        let start = self.span();
        let first = self.prefix()?;
        let Some(tight) = self.tight_sign() else { return Ok(first) };
        let mut spans = vec![self.since(start)];
        let mut height = first.height;
        let mut operands = vec![first.node];
        while self.tight_sign() == Some(tight) && (tight == Tight::Wedge || operands.len() < 2) {
            let caret = self.is(&Sign::Caret);
            self.at += 1;
            let begin = self.span();
            let operand = self.prefix()?;
            spans.push(self.since(begin));
            if caret && is_numeric(&operand.node) {
                let message = "a power must be a whole number: `A^2`, `A^-1`; write other powers of a rotor as `exp(½ log(R))`";
                return Err(Error::new(self.since(begin), message));
            }
            height = height.max(operand.height);
            operands.push(operand.node);
        }
        if let Some(other) = self.tight_sign() {
            self.at += 1;
            let begin = self.span();
            self.prefix()?;
            return Err(self.ambiguous(tight, other, &spans, self.since(begin)));
        }
        self.build(Kind::Tight(tight, operands), self.since(start), height)
    }

    /// The two readings of `a·b∧c`.
    fn ambiguous(&self, first: Tight, second: Tight, operands: &[Span], last: Span) -> Error {
        let cut = |text: &str| {
            if text.chars().count() > 20 { "(…)".to_owned() } else { text.to_owned() }
        };
        let sign = |tight: Tight| tight.symbol();
        let shown: Vec<String> = operands.iter().map(|&span| cut(self.slice(span))).collect();
        let (f, s, c) = (sign(first), sign(second), cut(self.slice(last)));
        let (before, b) = match &shown[..] {
            [before @ .., b] if before.len() <= 3 => (before.join(&f.to_string()), b.as_str()),
            _ => ("…".to_owned(), "…"),
        };
        let span = operands.first().map_or(last, |first| first.to(last));
        Error::new(
            span,
            format!("ambiguous without brackets: `({before}{f}{b}){s}{c}` or `{before}{f}({b}{s}{c})`"),
        )
    }

    pub fn prefix(&mut self) -> Parsed {
        let start = self.span();
        let (tilde, minus) = (self.is(&Sign::Tilde), self.is(&Sign::Minus));
        if !tilde && !minus {
            return self.postfix();
        }
        self.at += 1;
        self.deeper(start)?;
        let operand = self.prefix()?;
        self.depth -= 1;
        let span = self.since(start);
        let Built { node, height } = operand;
        let kind = if tilde { Kind::Reverse(Box::new(node)) } else { Kind::Sum(vec![(true, node)]) };
        self.build(kind, span, height)
    }

    pub fn deeper(&mut self, span: Span) -> Result<(), Error> {
        self.depth += 1;
        if self.depth > MAX_DEPTH { Err(too_deep(span)) } else { Ok(()) }
    }

    fn postfix(&mut self) -> Parsed {
        let start = self.span();
        let reversed = self.ahead(0).is_some_and(|read| read.reversed);
        let mut operand = self.primary()?;
        if reversed {
            operand = self.build(Kind::Reverse(Box::new(operand.node)), self.since(start), operand.height)?;
        }
        let mut powered = false;
        loop {
            let node = Box::new(operand.node);
            let kind = if let Some(n) = self.power()? {
                if powered {
                    return Err(Error::new(self.since(start), "a power of a power needs brackets: `(A²)³`"));
                }
                powered = true;
                Kind::Power(node, n)
            } else if self.eat(&Sign::Dagger) || self.eat_tilde_behind() {
                Kind::Reverse(node)
            } else if self.is(&Sign::Prime) {
                if matches!(self.items[self.at - 1].item, Item::Number(_)) {
                    return Err(Error::new(
                        self.span(),
                        "a prime means a derivative, not minutes of arc or feet",
                    ));
                }
                self.at += 1;
                Kind::Derivative(node)
            } else {
                return Ok(Built { node: *node, ..operand });
            };
            operand = self.build(kind, self.since(start), operand.height)?;
        }
    }

    /// Consumes the tilde of `A~`, which directly follows an operand and does not directly precede another.
    fn eat_tilde_behind(&mut self) -> bool {
        let behind = self.is(&Sign::Tilde) && self.ahead(0).is_some_and(|tilde| !tilde.space);
        self.at += 1;
        let before = self.begins_operand() && self.ahead(0).is_some_and(|next| !next.space);
        let found = behind && !before;
        self.at -= usize::from(!found);
        found
    }

    /// The exponent, if one follows: `²`, `^2`, `^-1`, `^(-1)`.
    fn power(&mut self) -> Result<Option<i32>, Error> {
        if let Some(Item::Superscript(n)) = self.peek() {
            let n = *n;
            self.at += 1;
            return Ok(Some(n));
        }
        if !self.is(&Sign::Caret) {
            return Ok(None);
        }
        let mut count = 1;
        let bracket = match self.ahead(count).map(|read| &read.item) {
            Some(Item::Sign(Sign::Open(kind))) => Some(*kind),
            _ => None,
        };
        count += usize::from(bracket.is_some());
        let minus = self.ahead(count).is_some_and(|read| read.item == Item::Sign(Sign::Minus));
        count += usize::from(minus);
        let Some(&Read { item: Item::Number(number), span, .. }) = self.ahead(count) else { return Ok(None) };
        count += 1;
        if let Some(kind) = bracket {
            if self.ahead(count).is_none_or(|read| read.item != Item::Sign(Sign::Close(kind))) {
                return Ok(None);
            }
            count += 1;
        }
        let whole = number.ratio.filter(|&(_, d)| d == 1).map(|(n, _)| if minus { -n } else { n });
        let Some(n) = whole.and_then(|n| i32::try_from(n).ok()) else {
            let message =
                "a power must be a whole number of 32 bits; write other powers of a rotor as `exp(½ log(R))`";
            return Err(Error::new(span, message));
        };
        self.at += count;
        Ok(Some(n))
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
