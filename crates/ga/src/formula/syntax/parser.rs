//! Recursive-descent parser from items to a tree.
//!
//! It limits nested brackets and the height of trees, so that neither the parser nor walks over its trees overflow the
//! stack.

use super::indices::{indices_in, sum_repeated};
use super::names::Names;
use super::number::{FRACTIONS, Number};
use super::reading::read;
use super::token::{Item, Token, tokens};
use super::tree::{Kind, Named, Node, Span, Tight, Tree, is_numeric};
use crate::formula::{Error, MAX_DEPTH, Space};
use crate::g3::functions::Function;
use crate::product::Grades;

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

    fn unexpected(&self) -> Error {
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
        if let Some(&Item::Superscript(n)) = self.peek() {
            self.at += 1;
            return Ok(Some(n));
        }
        let before = self.at;
        let Some((number, minus, span)) = self.written_power() else {
            self.at = before;
            return Ok(None);
        };
        let whole = number.ratio.filter(|&(_, d)| d == 1).map(|(n, _)| if minus { -n } else { n });
        let message =
            "a power must be a whole number of 32 bits; write other powers of a rotor as `exp(½ log(R))`";
        let n = whole.and_then(|n| i32::try_from(n).ok()).ok_or_else(|| Error::new(span, message))?;
        Ok(Some(n))
    }

    /// The number of a power after `^`, whether it is negative, and its place; `None` if anything else follows.
    fn written_power(&mut self) -> Option<(Number, bool, Span)> {
        if !self.eat(&Item::Caret) {
            return None;
        }
        let close =
            if let Some(&Item::Open(bracket)) = self.peek() { Some(Item::Close(bracket)) } else { None };
        self.at += usize::from(close.is_some());
        let (minus, span) = (self.eat(&Item::Minus), self.span());
        let Some(&Item::Number(number)) = self.peek() else { return None };
        self.at += 1;
        close.is_none_or(|close| self.eat(&close)).then_some((number, minus, span))
    }

    // --- operands: names, numbers, brackets, calls

    fn primary(&mut self) -> Parsed {
        let start = self.span();
        let Some(item) = self.peek().cloned() else { return Err(self.unexpected()) };
        self.at += 1;
        match item {
            Item::Number(number) => self.build(Kind::Number(number), start),
            Item::Pi => self.build(Kind::Pi, start),
            Item::Blade(generators) => self.build(Kind::Blade(generators), start),
            Item::Pseudoscalar => self.build(Kind::Pseudoscalar, start),
            Item::Name(name) => self.build(Kind::Name(name), start),
            Item::Callable(name, count) => {
                let arguments = match count {
                    0 => Vec::new(),
                    _ => self.arguments(start, &name, count)?,
                };
                self.build(Kind::Call(name, arguments), self.since(start))
            }
            Item::Function(function) => {
                let mut arguments = self.arguments(start, function.name(), 1)?;
                let argument = Box::new(arguments.pop().ok_or_else(|| self.unexpected())?);
                let kind = match function {
                    Named::Reverse => Kind::Reverse(argument),
                    _ => Kind::Function(function, argument),
                };
                self.build(kind, self.since(start))
            }
            Item::Product(tight) => {
                // `wedge(a, b, c)` is `a∧b∧c`.
                let count = if tight == Tight::Wedge { usize::MAX } else { 2 };
                let arguments = self.arguments(start, tight.name(), count)?;
                if arguments.len() < 2 {
                    return Err(Error::new(self.since(start), "`wedge` takes 2 arguments or more, got 1"));
                }
                self.build(Kind::Tight(tight, arguments), self.since(start))
            }
            Item::Euler => self.exponential(start),
            Item::Total(index) => self.total(start, index),
            Item::Open(bracket) => self.enclosed(start, &Item::Close(bracket)),
            Item::OpenAngle => self.part(start),
            _ => {
                self.at -= 1;
                Err(self.unexpected())
            }
        }
    }

    /// A sum up to the bracket that closes it.
    fn enclosed(&mut self, open: Span, close: &Item) -> Parsed {
        self.nested(open, |parser| {
            let inner = parser.sum()?;
            parser.close(open, close)?;
            Ok(inner)
        })
    }

    fn close(&mut self, open: Span, sign: &Item) -> Result<(), Error> {
        if self.eat(sign) {
            return Ok(());
        }
        let bracket = self.slice(open).chars().next().unwrap_or('(');
        match self.peek() {
            None | Some(Item::Equals) => Err(Error::new(open, format!("`{bracket}` is never closed"))),
            Some(Item::Close(_) | Item::CloseAngle) => {
                let text = self.slice(self.span());
                Err(Error::new(self.span(), format!("`{text}` does not close `{bracket}`")))
            }
            Some(_) => Err(self.unexpected()),
        }
    }

    /// `⟨A⟩_k`, after the opening bracket.
    fn part(&mut self, start: Span) -> Parsed {
        let inner = self.enclosed(start, &Item::CloseAngle)?;
        let mut grades = Grades::SCALAR;
        if let Some(Item::Subscript(number)) = self.peek() {
            grades = self.grade(*number)?;
            self.at += 1;
        } else if self.eat(&Item::Underscore) {
            grades = self.grades()?;
        }
        self.build(Kind::Part(Box::new(inner), grades), self.since(start))
    }

    /// `2` or `{0, 2}`.
    fn grades(&mut self) -> Result<Grades, Error> {
        let braces = self.eat(&Item::Open('{'));
        let mut grades = Grades(0);
        loop {
            let Some(Item::Number(number)) = self.peek() else {
                return Err(Error::new(self.span(), "expected a grade: `⟨A⟩_2`, `⟨A⟩_{0,2}`"));
            };
            grades.0 |= self.grade(*number)?.0;
            self.at += 1;
            if !braces || self.eat(&Item::Close('{')) {
                return Ok(grades);
            }
            if !self.eat(&Item::Comma) {
                return Err(Error::new(self.span(), "grades are separated by commas: `⟨A⟩_{0,2}`"));
            }
        }
    }

    /// The grade of this number.
    fn grade(&self, number: Number) -> Result<Grades, Error> {
        let n = self.space.algebra.signature().generators();
        let k = number.ratio.filter(|&(_, d)| d == 1).and_then(|(k, _)| usize::try_from(k).ok());
        k.filter(|&k| k <= n).map(|k| Grades(1 << k)).ok_or_else(|| {
            let space = if self.space.is_g3() {
                "3-d space".to_owned()
            } else {
                format!("an algebra of {n} generators")
            };
            Error::new(self.span(), format!("{space} has grades 0 to {n}"))
        })
    }

    /// The arguments in brackets; `count` of them, or any number for `usize::MAX`.
    fn arguments(&mut self, start: Span, name: &str, count: usize) -> Result<Vec<Node>, Error> {
        let open = self.span();
        if !self.eat(&Item::Open('(')) {
            let message = format!("`{name}` is a function; write its argument in brackets, `{name}(…)`");
            return Err(Error::new(start, message));
        }
        let arguments = self.nested(open, |parser| {
            let mut arguments = vec![parser.sum()?];
            while parser.eat(&Item::Comma) {
                arguments.push(parser.sum()?);
            }
            parser.close(open, &Item::Close('('))?;
            Ok(arguments)
        })?;
        if count != usize::MAX && arguments.len() != count {
            let (found, s) = (arguments.len(), if count == 1 { "" } else { "s" });
            let message = format!("`{name}` takes {count} argument{s}, got {found}");
            return Err(Error::new(self.since(start), message));
        }
        Ok(arguments)
    }

    /// `e^(…)`, after the e.
    fn exponential(&mut self, start: Span) -> Parsed {
        let exponent = if let Some(&Item::Superscript(n)) = self.peek() {
            let span = self.span();
            self.at += 1;
            let number = self.build(Kind::Number(Number::whole(n.saturating_abs())), span)?;
            if n < 0 { self.build(Kind::Sum(vec![(true, number)]), span)? } else { number }
        } else if self.eat(&Item::Caret) {
            let exponent = self.nested(start, Self::exponent)?;
            self.check_exponent(start)?;
            exponent
        } else if self.names.is_open() {
            return self.build(Kind::Name("e".to_owned()), start);
        } else {
            let message = "`e` has no value; write an exponential as `e^(…)` or `exp(…)`, and basis vectors as e1, e2, …";
            return Err(Error::new(start, message));
        };
        self.build(Kind::Function(Named::Function(Function::Exp), Box::new(exponent)), self.since(start))
    }

    /// `e^-Bθ` may mean `e^(-B) θ` or `e^(-Bθ)`; only brackets or a space decide.
    fn check_exponent(&self, start: Span) -> Result<(), Error> {
        let last = &self.items[self.at - 1].item;
        let ends = matches!(last, Item::Close(_) | Item::CloseAngle);
        if ends || !self.begins_operand() || self.ahead(0).is_some_and(|next| next.space) {
            return Ok(());
        }
        let span = start.to(self.span());
        Err(Error::new(span, "the end of the exponent is ambiguous; put it in brackets, `e^(…)`"))
    }

    /// The exponent of e: signs and one operand without powers.
    fn exponent(&mut self) -> Parsed {
        let start = self.span();
        if self.eat(&Item::Minus) {
            let operand = self.exponent_operand()?;
            return self.build(Kind::Sum(vec![(true, operand)]), self.since(start));
        }
        self.exponent_operand()
    }

    fn exponent_operand(&mut self) -> Parsed {
        let start = self.span();
        if self.is(&Item::Tilde) {
            return self.prefix();
        }
        let operand = self.primary()?;
        if matches!(self.peek(), Some(Item::Superscript(_) | Item::Caret)) {
            let message = "a power in an exponent needs brackets: `e^(A²)`";
            return Err(Error::new(self.since(start).to(self.span()), message));
        }
        Ok(operand)
    }

    /// `Σ_k A`, after the sign.
    fn total(&mut self, start: Span, index: Option<String>) -> Parsed {
        let inner = self.nested(start, Self::product)?;
        let index = match index {
            Some(index) => index,
            None => match &indices_in(&inner, self.names)[..] {
                [(index, _)] => index.to_string(),
                _ => {
                    let message =
                        "the sum has no index; write `Σ_k ω_k e_k`; indices are i, j, k, l, m and n";
                    return Err(Error::new(start, message));
                }
            },
        };
        self.build(Kind::Total(index, Box::new(inner)), self.since(start))
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
