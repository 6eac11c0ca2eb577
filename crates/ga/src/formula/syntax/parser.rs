//! Recursive-descent parser from items to a tree.
//!
//! It limits nested brackets and the height of trees, so that neither the parser nor walks over its trees overflow the
//! stack.

use super::indices::sum_repeated;
use super::names::Names;
use super::number::FRACTIONS;
use super::number::Number;
use super::reading::read;
use super::token::{Item, Token, tokens};
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
    let mut sides = vec![parser.sum()?];
    while parser.eat(&Item::Equals) {
        sides.push(parser.sum()?);
    }
    match parser.peek() {
        None => Ok(Tree { sides: sum_repeated(sides, names)? }),
        Some(_) => Err(parser.unexpected()),
    }
}

pub(crate) type Parsed = Result<Node, Error>;

pub(crate) struct Parser<'a> {
    pub text: &'a str,
    pub space: Space<'a>,
    pub names: &'a Names,
    pub items: Vec<Token>,
    pub at: usize,
    pub depth: usize,
}

impl Parser<'_> {
    // --- the items

    pub fn peek(&self) -> Option<&Item> {
        self.ahead(0).map(|token| &token.item)
    }

    pub fn ahead(&self, count: usize) -> Option<&Token> {
        self.items.get(self.at + count)
    }

    pub fn is(&self, item: &Item) -> bool {
        self.peek() == Some(item)
    }

    pub fn eat(&mut self, item: &Item) -> bool {
        let found = self.is(item);
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
            Item::Close(_) | Item::CloseAngle if self.depth == 0 => {
                format!("`{text}` closes no bracket")
            }
            Item::Tight(Tight::Dot) if text == "|" => {
                "`|` is a dot product, `a|b`, and needs its left factor; a magnitude is `norm(a)`".to_owned()
            }
            Item::Comma => "commas are allowed only between arguments of a function".to_owned(),
            Item::Underscore => "a subscript must directly follow a letter or `⟨…⟩`".to_owned(),
            Item::Subscript(_) => "a subscript must directly follow a letter or `⟩`".to_owned(),
            Item::Prime => "a prime must directly follow a letter or a bracket".to_owned(),
            Item::Superscript(_) => "a power must follow its base; powers of powers need brackets".to_owned(),
            _ => format!("expected a name, a number or an opening bracket, got `{text}`"),
        };
        Error::new(read.span, message)
    }

    pub fn build(&self, kind: Kind, span: Span) -> Parsed {
        let node = Node::new(kind, span);
        if node.height() > MAX_HEIGHT { Err(too_deep(span)) } else { Ok(node) }
    }

    /// Parses an inner part, one level deeper.
    pub fn nested<T>(
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

    pub fn sum(&mut self) -> Parsed {
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

    pub fn product(&mut self) -> Parsed {
        let start = self.span();
        let mut factors = vec![self.tight()?];
        loop {
            if self.eat(&Item::Star) {
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
                factors.push(self.tight()?);
            } else {
                return self.joined(factors, start);
            }
        }
    }

    fn joined(&self, factors: Vec<Node>, start: Span) -> Parsed {
        match <[Node; 1]>::try_from(factors) {
            Ok([factor]) => Ok(factor),
            Err(factors) => self.build(Kind::Product(factors), self.since(start)),
        }
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
    fn check_juxtaposition(&self, factors: &[Node]) -> Result<(), Error> {
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
            (Item::Close(_) | Item::CloseAngle, Item::Number(_)) if !next.space => Err(Error::new(
                next.span,
                "a number right after a bracket; write a power as `(…)^2`, or the factor before the bracket",
            )),
            (Item::Name(name), Item::Open('(')) if !next.space && last.kind == Kind::Name(name.clone()) => {
                self.check_application(name)
            }
            _ => Ok(()),
        }
    }

    /// Fails for `R(x)` with a value R, which looks like a function of x.
    fn check_application(&self, name: &str) -> Result<(), Error> {
        let (argument, close) = (self.ahead(1), self.ahead(2));
        let alone = argument.is_some_and(|a| matches!(a.item, Item::Name(_) | Item::Number(_)))
            && close.is_some_and(|c| c.item == Item::Close('('));
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
            return Err(self.ambiguous(tight, other, &spans, self.since(begin)));
        }
        self.build(Kind::Tight(tight, operands), self.since(start))
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
                Kind::Reverse(Box::new(operand))
            } else if self.is(&Item::Prime) {
                if matches!(self.items[self.at - 1].item, Item::Number(_)) {
                    let message = "a prime means a derivative, not minutes of arc or feet";
                    return Err(Error::new(self.span(), message));
                }
                self.at += 1;
                Kind::Derivative(Box::new(operand))
            } else {
                return Ok(operand);
            };
            operand = self.build(kind, self.since(start))?;
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

    /// The exponent, if one follows: `²`, `^2`, `^-1`, `^(-1)`.
    fn power(&mut self) -> Result<Option<i32>, Error> {
        if let Some(Item::Superscript(n)) = self.peek() {
            let n = *n;
            self.at += 1;
            return Ok(Some(n));
        }
        if !self.is(&Item::Caret) {
            return Ok(None);
        }
        let mut count = 1;
        let bracket = match self.ahead(count).map(|read| &read.item) {
            Some(Item::Open(kind)) => Some(*kind),
            _ => None,
        };
        count += usize::from(bracket.is_some());
        let minus = self.ahead(count).is_some_and(|read| read.item == Item::Minus);
        count += usize::from(minus);
        let Some(&Token { item: Item::Number(number), span, .. }) = self.ahead(count) else {
            return Ok(None);
        };
        count += 1;
        if let Some(kind) = bracket {
            if self.ahead(count).is_none_or(|read| read.item != Item::Close(kind)) {
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
