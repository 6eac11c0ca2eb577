//! Parser of operands: names, numbers, brackets, calls.

use super::indices::count_indices;
use super::parser::{Parsed, Parser};
use super::reading::Item;
use super::token::Sign;
use super::tree::{Kind, Named, Node, Span, Tight};
use crate::formula::{Error, Number};
use crate::g3::functions::Function;
use crate::product::Grades;

impl Parser<'_> {
    pub(crate) fn primary(&mut self) -> Parsed {
        let start = self.span();
        let Some(item) = self.peek().cloned() else { return Err(self.unexpected()) };
        self.at += 1;
        match item {
            Item::Number(number) => self.build(Kind::Number(number), start, 0),
            Item::Pi => self.build(Kind::Pi, start, 0),
            Item::Blade(generators) => self.build(Kind::Blade(generators), start, 0),
            Item::Pseudoscalar => self.build(Kind::Pseudoscalar, start, 0),
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
                // `wedge(a, b, c)` is `a∧b∧c`.
                let count = if tight == Tight::Wedge { usize::MAX } else { 2 };
                let (arguments, height) = self.arguments(start, tight.name(), count)?;
                if arguments.len() < 2 {
                    return Err(Error::new(self.since(start), "`wedge` takes 2 arguments or more, got 1"));
                }
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

    fn bracketed(&mut self, start: Span, bracket: char) -> Parsed {
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
            None | Some(Item::Sign(Sign::Equals)) => {
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
    fn part(&mut self, start: Span) -> Parsed {
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
                return Err(Error::new(self.span(), "expected a grade: `⟨A⟩_2`, `⟨A⟩_{0,2}`"));
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

    fn call(&mut self, start: Span, name: String, count: usize) -> Parsed {
        let (arguments, height) =
            if count == 0 { (Vec::new(), 0) } else { self.arguments(start, &name, count)? };
        self.build(Kind::Call(name, arguments), self.since(start), height)
    }

    /// The arguments in brackets; `count` of them, or any number for `usize::MAX`.
    pub(crate) fn arguments(
        &mut self,
        start: Span,
        name: &str,
        count: usize,
    ) -> Result<(Vec<Node>, usize), Error> {
        let open = self.span();
        if !self.eat(&Sign::Open('(')) {
            return Err(Error::new(
                start,
                format!("`{name}` is a function; write its argument in brackets, `{name}(…)`"),
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
    fn exponential(&mut self, start: Span) -> Parsed {
        let exponent = if let Some(Item::Superscript(n)) = self.peek() {
            let number = Kind::Number(Number::whole(n.saturating_abs()));
            let (negative, span) = (*n < 0, self.span());
            self.at += 1;
            let number = self.build(number, span, 0)?;
            if negative { self.build(Kind::Sum(vec![(true, number.node)]), span, 1)? } else { number }
        } else if self.eat(&Sign::Caret) {
            self.deeper(start)?;
            let exponent = self.exponent()?;
            self.depth -= 1;
            self.check_exponent(start)?;
            exponent
        } else if self.names.is_open() {
            return self.build(Kind::Name("e".to_owned()), start, 0);
        } else {
            let message = "`e` has no value; write an exponential as `e^(…)` or `exp(…)`, and basis vectors as e1, e2, …";
            return Err(Error::new(start, message));
        };
        let function = Kind::Function(Named::Function(Function::Exp), Box::new(exponent.node));
        self.build(function, self.since(start), exponent.height)
    }

    /// `e^-Bθ` may mean `e^(-B) θ` or `e^(-Bθ)`; only brackets or a space decide.
    fn check_exponent(&self, start: Span) -> Result<(), Error> {
        let last = &self.items[self.at - 1].item;
        let ends = matches!(last, Item::Sign(Sign::Close(_) | Sign::CloseAngle));
        if ends || !self.begins_operand() || self.ahead(0).is_some_and(|next| next.space) {
            return Ok(());
        }
        let span = start.to(self.span());
        Err(Error::new(span, "the end of the exponent is ambiguous; put it in brackets, `e^(…)`"))
    }

    /// The exponent of e: signs and one operand without powers.
    fn exponent(&mut self) -> Parsed {
        let start = self.span();
        if self.eat(&Sign::Minus) {
            let operand = self.exponent_operand()?;
            return self.build(Kind::Sum(vec![(true, operand.node)]), self.since(start), operand.height);
        }
        self.exponent_operand()
    }

    fn exponent_operand(&mut self) -> Parsed {
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
    fn total(&mut self, start: Span, index: Option<String>) -> Parsed {
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
                            "the sum has no index; write `Σ_k ω_k e_k`; indices are i, j, k, l, m and n";
                        return Err(Error::new(start, message));
                    }
                }
            }
        };
        self.build(Kind::Total(index, Box::new(inner.node)), self.since(start), inner.height)
    }
}
