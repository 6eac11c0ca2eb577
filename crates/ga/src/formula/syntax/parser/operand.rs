//! Operands: names, numbers, brackets, calls.

use super::{Parsed, Parser};
use crate::formula::Error;
use crate::formula::syntax::indices::indices_in;
use crate::formula::syntax::number::Number;
use crate::formula::syntax::token::{Item, Token, tokens};
use crate::formula::syntax::tree::{Kind, Named, Node, Span, Tight, core};
use crate::product::Grades;

impl Parser<'_> {
    pub(super) fn primary(&mut self) -> Parsed {
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
                let apart = self.ahead(0).is_some_and(|open| open.space);
                let arguments = match count {
                    0 => Vec::new(),
                    _ => self.arguments(start, &name, count)?,
                };
                if apart && name == "I" {
                    self.check_pseudoscalar(start, &arguments)?;
                }
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
            Item::Open(bracket) => {
                let inner = self.enclosed(start, &Item::Close(bracket))?;
                if self.runs_together(&inner) { self.in_brackets(inner) } else { Ok(inner) }
            }
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

    /// Whether it is a name of several letters, or a call, reverse or power of one: they may become factors once names have
    /// values.
    pub(super) fn runs_together(&self, node: &Node) -> bool {
        let (Kind::Name(name) | Kind::Call(name, _)) = &core(node).kind else { return false };
        let letters = |token: &Token| if let Item::Word(atoms) = &token.item { atoms.len() } else { 0 };
        self.names.is_open() && tokens(name).is_ok_and(|tokens| tokens.iter().map(letters).sum::<usize>() > 1)
    }

    /// Keeps the brackets around a node, as a product of this factor alone.
    pub(super) fn in_brackets(&self, node: Node) -> Parsed {
        let span = node.span;
        self.build(Kind::Product(vec![node]), span)
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
