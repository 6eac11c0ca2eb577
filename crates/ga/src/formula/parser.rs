//! Items to a tree, by recursive descent. Brackets are counted on the way in and heights on the way out, so that
//! neither the parser nor whoever walks its trees needs much of the stack.

use super::names::Names;
use super::reading::{INDICES, Item, Read, indexed, read};
use super::token::{Sign, tokens};
use super::tree::{Kind, Named, Node, Span, Tight, Tree};
use super::{Error, MAX_DEPTH, Space};
use crate::functions::Function;
use crate::product::Grades;

/// Levels of a tree. A bracket makes at most four (sum, product, quotient, tight product).
const MAX_HEIGHT: usize = 4 * MAX_DEPTH;

/// Reads a formula with these names.
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
        None => Ok(Tree { sides: sum_repeated(sides, names) }),
        Some(_) => Err(parser.unexpected()),
    }
}

/// A node and its height.
struct Built {
    node: Node,
    height: usize,
}

type Result_ = Result<Built, Error>;

struct Parser<'a> {
    text: &'a str,
    space: Space<'a>,
    names: &'a Names,
    items: Vec<Read>,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    // --- the items

    fn peek(&self) -> Option<&Item> {
        self.items.get(self.at).map(|read| &read.item)
    }

    fn ahead(&self, count: usize) -> Option<&Read> {
        self.items.get(self.at + count)
    }

    fn is(&self, sign: &Sign) -> bool {
        matches!(self.peek(), Some(Item::Sign(found)) if found == sign)
    }

    fn eat(&mut self, sign: &Sign) -> bool {
        let found = self.is(sign);
        self.at += usize::from(found);
        found
    }

    /// Where the next item is; after the last one, the end.
    fn span(&self) -> Span {
        let end = Span { start: self.text.len(), end: self.text.len() };
        self.ahead(0).map_or(end, |read| read.span)
    }

    /// From there to the last item that was read.
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
                "the formula ends where a name, a number or an opening bracket should follow",
            );
        };
        let text = self.slice(read.span);
        let message = match &read.item {
            Item::Sign(Sign::Close(_) | Sign::CloseAngle) => format!("`{text}` closes no bracket"),
            Item::Sign(Sign::Comma) => "a comma only stands between the arguments of a function".to_owned(),
            Item::Sign(Sign::Underscore) => "a subscript follows a letter or `⟨…⟩` directly".to_owned(),
            Item::Subscript(_) => "a subscript follows a letter or `⟩` directly".to_owned(),
            Item::Sign(Sign::Prime) => "a prime follows a letter or a bracket directly".to_owned(),
            Item::Superscript(_) => {
                "a power follows what is raised to it; powers of powers need brackets".to_owned()
            }
            _ => format!("a name, a number or an opening bracket should stand here, not `{text}`"),
        };
        Error::new(read.span, message)
    }

    fn build(&self, kind: Kind, span: Span, height: usize) -> Result_ {
        if height >= MAX_HEIGHT {
            return Err(too_deep(span));
        }
        Ok(Built { node: Node::new(kind, span), height: height + 1 })
    }

    // --- the grammar, loosest first

    fn sum(&mut self) -> Result_ {
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

    fn product(&mut self) -> Result_ {
        let start = self.span();
        let mut factors = vec![self.tight()?];
        loop {
            if self.eat(&Sign::Star) {
                factors.push(self.tight()?);
            } else if self.eat(&Sign::Slash) {
                let divisor_start = self.span();
                let divisor = self.tight()?;
                self.check_divisor(start, divisor_start)?;
                let numerator = self.joined(factors, start)?;
                let span = self.since(start);
                let height = numerator.height.max(divisor.height);
                let pair = Box::new((numerator.node, divisor.node));
                factors = vec![self.build(Kind::Quotient(pair), span, height)?];
            } else if self.begins_operand() {
                self.check_juxtaposition(&factors)?;
                factors.push(self.tight()?);
            } else {
                return self.joined(factors, start);
            }
        }
    }

    fn joined(&self, mut factors: Vec<Built>, start: Span) -> Result_ {
        if factors.len() == 1
            && let Some(factor) = factors.pop()
        {
            return Ok(factor);
        }
        let height = factors.iter().map(|factor| factor.height).max().unwrap_or(0);
        let factors: Vec<Node> = factors.into_iter().map(|factor| factor.node).collect();
        self.build(Kind::Product(factors), self.since(start), height)
    }

    /// `x/2a` may mean `(x/2) a` or `x/(2a)`; only a space tells.
    fn check_divisor(&self, start: Span, divisor: Span) -> Result<(), Error> {
        if !self.begins_operand() || self.ahead(0).is_some_and(|read| read.space) {
            return Ok(());
        }
        let span = self.since(start).to(self.span());
        let (x, y) = (self.slice(self.since(divisor)), self.slice(self.span()));
        let y = if y == "(" || y == "[" || y == "{" || y == "⟨" || y == "<" { "(…)" } else { y };
        let message =
            format!("what is divided by? Write `…/{x} {y}` with a space for `(…/{x}) {y}`, or `…/({x} {y})`");
        Err(Error::new(span, message))
    }

    /// What stands side by side without a sign between, and is probably no product.
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
                    "a number right after a bracket: a power is written `(…)^2`, a factor stands before",
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

    /// `R(x)` with a value R looks like a function of x.
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

    fn begins_operand(&self) -> bool {
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

    fn tight(&mut self) -> Result_ {
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
                let message =
                    "a power is a whole number: `A^2`, `A^-1`. Other powers of a rotor are `exp(½ log(R))`";
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

    fn prefix(&mut self) -> Result_ {
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

    fn deeper(&mut self, span: Span) -> Result<(), Error> {
        self.depth += 1;
        if self.depth > MAX_DEPTH { Err(too_deep(span)) } else { Ok(()) }
    }

    fn postfix(&mut self) -> Result_ {
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
            } else if self.eat(&Sign::Prime) {
                Kind::Derivative(node)
            } else {
                return Ok(Built { node: *node, ..operand });
            };
            operand = self.build(kind, self.since(start), operand.height)?;
        }
    }

    /// `A~`: a tilde that stands right behind something, and not before something else.
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
        let whole = number.ratio.filter(|&(_, d)| d == 1).and_then(|(n, _)| i32::try_from(n).ok());
        let Some(n) = whole else {
            let message = "a power is a whole number of 32 bits; other powers of a rotor are `exp(½ log(R))`";
            return Err(Error::new(span, message));
        };
        self.at += count;
        Ok(Some(if minus { -n } else { n }))
    }

    fn primary(&mut self) -> Result_ {
        let start = self.span();
        let Some(item) = self.peek().cloned() else { return Err(self.unexpected()) };
        self.at += 1;
        match item {
            Item::Number(number) => self.build(Kind::Number(number), start, 0),
            Item::Pi => self.build(Kind::Pi, start, 0),
            Item::Blade(generators) => self.build(Kind::Blade(generators), start, 0),
            Item::Name(name) => self.build(Kind::Name(name), start, 0),
            Item::Callable(name, count) => self.call(start, name, count),
            Item::Function(function) => {
                let (mut arguments, height) = self.arguments(start, function.name(), 1)?;
                let argument = arguments.pop().ok_or_else(|| self.unexpected())?;
                let kind = match function {
                    Named::Reverse => Kind::Reverse(Box::new(argument)),
                    _ => Kind::Function(function, Box::new(argument)),
                };
                self.build(kind, self.since(start), height)
            }
            Item::Product(tight) => {
                let (arguments, height) = self.arguments(start, tight.name(), 2)?;
                self.build(Kind::Tight(tight, arguments), self.since(start), height)
            }
            Item::Euler => self.exponential(start),
            Item::Total(index) => self.total(start, index),
            Item::Sign(Sign::Open(bracket)) => self.bracketed(start, bracket),
            Item::Sign(Sign::OpenAngle) => self.part(start),
            _ => {
                self.at -= 1;
                Err(self.unexpected())
            }
        }
    }

    fn bracketed(&mut self, start: Span, bracket: char) -> Result_ {
        self.deeper(start)?;
        let inner = self.sum()?;
        self.close(start, &Sign::Close(bracket))?;
        self.depth -= 1;
        Ok(inner)
    }

    fn close(&mut self, open: Span, sign: &Sign) -> Result<(), Error> {
        if self.eat(sign) {
            return Ok(());
        }
        let bracket = self.slice(open).chars().next().unwrap_or('(');
        match self.peek() {
            None | Some(Item::Sign(Sign::Equals | Sign::Comma)) => {
                Err(Error::new(open, format!("`{bracket}` is never closed")))
            }
            Some(Item::Sign(Sign::Close(_) | Sign::CloseAngle)) => {
                let text = self.slice(self.span());
                Err(Error::new(self.span(), format!("`{text}` does not close `{bracket}`")))
            }
            Some(_) => Err(self.unexpected()),
        }
    }

    /// `⟨A⟩_k`, after the opening bracket.
    fn part(&mut self, start: Span) -> Result_ {
        self.deeper(start)?;
        let inner = self.sum()?;
        self.close(start, &Sign::CloseAngle)?;
        self.depth -= 1;
        let mut grades = Grades::SCALAR;
        if let Some(Item::Subscript(number)) = self.peek() {
            grades = self.grade(*number)?;
            self.at += 1;
        } else if self.eat(&Sign::Underscore) {
            grades = self.grades()?;
        }
        self.build(Kind::Part(Box::new(inner.node), grades), self.since(start), inner.height)
    }

    /// `2` or `{0, 2}`.
    fn grades(&mut self) -> Result<Grades, Error> {
        let braces = self.eat(&Sign::Open('{'));
        let mut grades = Grades(0);
        loop {
            let Some(Item::Number(number)) = self.peek() else {
                return Err(Error::new(self.span(), "a grade should stand here: `⟨A⟩_2`, `⟨A⟩_{0,2}`"));
            };
            grades.0 |= self.grade(*number)?.0;
            self.at += 1;
            if !braces || self.eat(&Sign::Close('{')) {
                return Ok(grades);
            }
            if !self.eat(&Sign::Comma) {
                return Err(Error::new(self.span(), "grades are separated by commas: `⟨A⟩_{0,2}`"));
            }
        }
    }

    /// The grade that the next item is.
    fn grade(&self, number: super::Number) -> Result<Grades, Error> {
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

    fn call(&mut self, start: Span, name: String, count: usize) -> Result_ {
        let (arguments, height) =
            if count == 0 { (Vec::new(), 0) } else { self.arguments(start, &name, count)? };
        self.build(Kind::Call(name, arguments), self.since(start), height)
    }

    /// The arguments in brackets, so many of them; any number if it is not known.
    fn arguments(&mut self, start: Span, name: &str, count: usize) -> Result<(Vec<Node>, usize), Error> {
        let open = self.span();
        if !self.eat(&Sign::Open('(')) {
            return Err(Error::new(
                start,
                format!("`{name}` is a function: write its argument in brackets, `{name}(…)`"),
            ));
        }
        self.deeper(open)?;
        let mut arguments = Vec::new();
        let mut height = 0;
        loop {
            let argument = self.sum()?;
            height = height.max(argument.height);
            arguments.push(argument.node);
            if !self.eat(&Sign::Comma) {
                break;
            }
        }
        if !self.is(&Sign::Close('(')) && self.is(&Sign::Equals) {
            return Err(Error::new(open, "`(` is never closed"));
        }
        self.close(open, &Sign::Close('('))?;
        self.depth -= 1;
        if count != usize::MAX && arguments.len() != count {
            let (found, s) = (arguments.len(), if count == 1 { "" } else { "s" });
            let message = format!("`{name}` takes {count} argument{s}, got {found}");
            return Err(Error::new(self.since(start), message));
        }
        Ok((arguments, height))
    }

    /// `e^(…)`, after the e.
    fn exponential(&mut self, start: Span) -> Result_ {
        let exponent = if let Some(Item::Superscript(n)) = self.peek() {
            let number = Kind::Number(super::Number::whole(n.saturating_abs()));
            let (negative, span) = (*n < 0, self.span());
            self.at += 1;
            let number = self.build(number, span, 0)?;
            if negative { self.build(Kind::Sum(vec![(true, number.node)]), span, 1)? } else { number }
        } else if self.eat(&Sign::Caret) {
            self.deeper(start)?;
            let exponent = self.exponent()?;
            self.depth -= 1;
            exponent
        } else {
            let message = "`e` has no value; an exponential is written `e^(…)` or `exp(…)`, the basis vectors e1, e2, …";
            return Err(Error::new(start, message));
        };
        let function = Kind::Function(Named::Function(Function::Exp), Box::new(exponent.node));
        self.build(function, self.since(start), exponent.height)
    }

    /// What stands above e: signs and one operand, without powers of its own.
    fn exponent(&mut self) -> Result_ {
        let start = self.span();
        if self.eat(&Sign::Minus) {
            let operand = self.exponent_operand()?;
            return self.build(Kind::Sum(vec![(true, operand.node)]), self.since(start), operand.height);
        }
        self.exponent_operand()
    }

    fn exponent_operand(&mut self) -> Result_ {
        let start = self.span();
        if self.is(&Sign::Tilde) {
            return self.prefix();
        }
        let operand = self.primary()?;
        if matches!(self.peek(), Some(Item::Superscript(_) | Item::Sign(Sign::Caret))) {
            return Err(Error::new(
                self.since(start).to(self.span()),
                "a power in an exponent needs brackets: `e^(A²)`",
            ));
        }
        Ok(operand)
    }

    /// `Σ_k A`, after the sign.
    fn total(&mut self, start: Span, index: Option<String>) -> Result_ {
        self.deeper(start)?;
        let inner = self.product()?;
        self.depth -= 1;
        let index = match index {
            Some(index) => index,
            None => {
                let mut found = Vec::new();
                count_indices(&inner.node, self.names, &mut found);
                match &found[..] {
                    [(index, _)] => index.to_string(),
                    _ => {
                        let message =
                            "a sum over which index? Write `Σ_k ω_k e_k`; indices are i, j, k, l, m and n";
                        return Err(Error::new(start, message));
                    }
                }
            }
        };
        self.build(Kind::Total(index, Box::new(inner.node)), self.since(start), inner.height)
    }
}

fn too_deep(span: Span) -> Error {
    Error::new(span, format!("more than {MAX_DEPTH} levels within each other; define the inner parts first"))
}

/// Whether it is made of numbers alone.
fn is_numeric(node: &Node) -> bool {
    match &node.kind {
        Kind::Number(_) | Kind::Pi => true,
        Kind::Sum(_) | Kind::Product(_) | Kind::Quotient(_) | Kind::Power(..) => {
            node.children().into_iter().all(is_numeric)
        }
        _ => false,
    }
}

/// Sums over indices that are repeated, as on paper: an index that stands twice or more in every term that has
/// it is summed over in each, `ε_ijk e_k`; one that stands once in some term is free, `L_k = i_k ω_k`.
fn sum_repeated(mut sides: Vec<Node>, names: &Names) -> Vec<Node> {
    if names.is_open() {
        return sides;
    }
    let mut counts: Vec<Vec<(char, usize)>> = Vec::new();
    for_each_term(&mut sides, &mut |term| {
        let mut found = Vec::new();
        count_indices(term, names, &mut found);
        counts.push(found);
    });
    let free = |index: char| counts.iter().flatten().any(|&(c, count)| c == index && count == 1);
    let mut next = counts.iter();
    for_each_term(&mut sides, &mut |term| {
        for &(index, _) in next.next().into_iter().flatten().filter(|&&(index, _)| !free(index)) {
            let inner = std::mem::replace(&mut term.kind, Kind::Pi);
            let inner = Box::new(Node::new(inner, term.span));
            term.kind = Kind::Total(index.to_string(), inner);
        }
    });
    sides
}

/// The terms of the sums that the sides are.
fn for_each_term(sides: &mut [Node], f: &mut impl FnMut(&mut Node)) {
    for side in sides {
        match &mut side.kind {
            Kind::Sum(terms) => terms.iter_mut().for_each(|(_, term)| f(term)),
            _ => f(side),
        }
    }
}

/// The indices in the names of a tree that are not bound, and how often each stands there. Those of a sum are
/// its own.
pub(crate) fn count_indices(node: &Node, names: &Names, found: &mut Vec<(char, usize)>) {
    if let Kind::Name(name) = &node.kind
        && names.get(name).is_none()
        && let Some((_, indices)) = indexed(name)
    {
        for index in indices.chars().filter(|&c| INDICES.contains(c)) {
            add(found, index, 1);
        }
    }
    let mut inner = Vec::new();
    for child in node.children() {
        count_indices(child, names, &mut inner);
    }
    if let Kind::Total(index, _) = &node.kind {
        inner.retain(|(c, _)| !index.contains(*c));
    }
    for (index, count) in inner {
        add(found, index, count);
    }
}

fn add(found: &mut Vec<(char, usize)>, index: char, count: usize) {
    match found.iter_mut().find(|(c, _)| *c == index) {
        Some((_, total)) => *total += count,
        None => found.push((index, count)),
    }
}
