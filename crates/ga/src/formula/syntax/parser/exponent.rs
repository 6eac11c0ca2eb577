//! Exponents: whole powers, and those of e.

use super::{Parsed, Parser};
use crate::formula::Error;
use crate::formula::syntax::number::Number;
use crate::formula::syntax::token::Item;
use crate::formula::syntax::tree::{Kind, Named, Span};
use crate::g3::functions::Function;

impl Parser<'_> {
    /// The exponent, if one follows: `²`, `^2`, `^-1`, `^(-1)`.
    pub(super) fn power(&mut self) -> Result<Option<i32>, Error> {
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
        let message = match whole {
            Some(_) => "a power must be less than 2³¹ in size",
            None => "a power must be a whole number; write other powers of a rotor as `exp(½ log(R))`",
        };
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

    /// `e^(…)`, after the e.
    pub(super) fn exponential(&mut self, start: Span) -> Parsed {
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
        let operand = self.primary()?.without_brackets();
        if matches!(self.peek(), Some(Item::Superscript(_) | Item::Caret)) {
            let message = "a power in an exponent needs brackets: `e^(A²)`";
            return Err(Error::new(self.since(start).to(self.span()), message));
        }
        Ok(operand)
    }
}
