//! Errors for texts that can be read in two ways, which show both.

use super::Parser;
use crate::formula::Error;
use crate::formula::syntax::grades;
use crate::formula::syntax::names::Meaning;
use crate::formula::syntax::token::Item;
use crate::formula::syntax::tree::{Kind, Node, Span, Tight};

impl Parser<'_> {
    /// `x/2a` may mean `(x/2) a` or `x/(2a)`, and only a space decides; so may `1/2·x`.
    pub(super) fn check_divisor(&mut self, start: Span, divisor: Span) -> Result<(), Error> {
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
    pub(super) fn check_juxtaposition(&self, factors: &[Node]) -> Result<(), Error> {
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

    /// Fails for `I (B)` where I is a map or a function: on paper it is the pseudoscalar times B.
    pub(super) fn check_pseudoscalar(&self, start: Span, arguments: &[Node]) -> Result<(), Error> {
        let [argument] = arguments else { return Ok(()) };
        let of_bivectors = matches!(self.names.get("I"), Some(Meaning::Map { grade: 2 }));
        if of_bivectors && grades::grades(argument, self.names).is_some_and(|g| !g.contains(2)) {
            return Ok(());
        }
        let x = self.slice(argument.span);
        let x = if x.chars().count() > 20 { "…" } else { x };
        let message = format!(
            "ambiguous with a space; write `I({x})` for the value of `I`, `I*({x})` with the pseudoscalar"
        );
        Err(Error::new(self.since(start), message))
    }

    /// Whether the last operand is a number and another is not, as in `x∧2`: in `x∧2 v` it seems to belong to v.
    pub(super) fn ends_in_number(&self, operands: &[Node]) -> bool {
        grades::ends_in_number(operands, self.names)
    }

    /// The two readings of `a·b∧c` or `a·2 c`, where the second sign is a space.
    pub(super) fn ambiguous(&self, first: Tight, second: &str, operands: &[Span], last: Span) -> Error {
        let cut = |text: &str| {
            if text.chars().count() > 20 { "(…)".to_owned() } else { text.to_owned() }
        };
        let shown: Vec<String> = operands.iter().map(|&span| cut(self.slice(span))).collect();
        let (f, s, c) = (first.symbol(), second, cut(self.slice(last)));
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
}
