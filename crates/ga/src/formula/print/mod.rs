//! Canonical spelling of formulas, as text and in LaTeX.
//!
//! Brackets appear only where the text would otherwise parse as another tree: around a part that binds less tightly
//! than its place requires. Spaces separate factors, so that names never run together, whatever else is bound.

mod latex;

use super::syntax::grades;
use super::syntax::letters::raised;
use super::syntax::number::{FRACTIONS, Number};
use super::syntax::tree::{Kind, Named, Node, Tight, Tree, is_numeric, listed};
use crate::product::Grades;

/// The characters of a spelling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// As on paper: `−½ Ω_S R`, `a∧b`, `R⁻¹`, `⟨A B⟩_2`.
    Unicode,
    /// ASCII apart from names, which stay as they are: `-1/2 Ω_S R`, `a^b`, `R^-1`, `<A B>_2`.
    Ascii,
}

impl Tree {
    /// The formula in canonical spelling, which parses as the same tree where the same names are bound.
    pub fn text(&self, style: Style) -> String {
        Printer::Text(style).list(&self.sides, " = ")
    }

    /// The formula in LaTeX's mathematics, without dollar signs.
    pub fn latex(&self) -> String {
        Printer::Latex.list(&self.sides, " = ")
    }
}

impl Node {
    /// This part of a formula in canonical spelling.
    pub fn text(&self, style: Style) -> String {
        Printer::Text(style).bare(self, false)
    }

    /// This part of a formula in LaTeX's mathematics, without dollar signs.
    pub fn latex(&self) -> String {
        Printer::Latex.bare(self, false)
    }
}

/// The precedence of a node, the loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Hold {
    Sum,
    Product,
    Tight,
    Prefix,
    Postfix,
    Primary,
}

#[derive(Clone, Copy, PartialEq)]
enum Printer {
    Text(Style),
    Latex,
}

impl Printer {
    fn is_ascii(self) -> bool {
        self == Printer::Text(Style::Ascii)
    }

    fn hold(self, node: &Node) -> Hold {
        match &node.kind {
            Kind::Sum(_) => Hold::Sum,
            Kind::Product(factors) if factors.len() == 1 && self != Printer::Latex => Hold::Primary,
            Kind::Product(_) | Kind::Total(..) => Hold::Product,
            Kind::Tight(tight, operands) if self.is_called(*tight, operands) => Hold::Primary,
            Kind::Tight(..) => Hold::Tight,
            Kind::Power(..) | Kind::Derivative(_) => Hold::Postfix,
            Kind::Function(Named::Reverse, _) => Hold::Postfix,
            _ if self == Printer::Latex => latex::hold(node),
            _ if self.is_fraction(node) => Hold::Product,
            Kind::Reverse(_) => Hold::Prefix,
            _ => Hold::Primary,
        }
    }

    /// In brackets if it binds less tightly.
    fn part(self, node: &Node, least: Hold) -> String {
        let text = self.bare(node, false);
        if self.hold(node) < least { self.bracketed(&text) } else { text }
    }

    /// In LaTeX brackets are as high as their content.
    fn bracketed(self, text: &str) -> String {
        let tall = self == Printer::Latex && latex::is_tall(text);
        if tall { format!("\\left({text}\\right)") } else { format!("({text})") }
    }

    /// A function's value; in LaTeX braces keep high brackets close to its name.
    fn applied(self, function: &str, arguments: &str) -> String {
        let brackets = self.bracketed(arguments);
        let tall = brackets.starts_with('\\');
        if tall { format!("{function}{{{brackets}}}") } else { function.to_owned() + &brackets }
    }

    fn list(self, nodes: &[Node], separator: &str) -> String {
        nodes.iter().map(|node| self.bare(node, false)).collect::<Vec<_>>().join(separator)
    }

    /// Without brackets round it. Whether more factors follow matters to a sum over an index, which takes
    /// all of them.
    fn bare(self, node: &Node, followed: bool) -> String {
        match (&node.kind, self) {
            (Kind::Sum(terms), _) => self.sum(terms),
            (Kind::Derivative(x), _) => self.bracketed(&self.bare(x, false)) + "'",
            (Kind::Total(index, x), Printer::Text(_)) => {
                let sign = if self.is_ascii() { "sum" } else { "Σ" };
                format!("{sign}_{index} {}", self.part(x, Hold::Product))
            }
            (Kind::Call(name, arguments), _) => {
                let name = if self == Printer::Latex { &latex::word(name, "") } else { name };
                // A defined value has no arguments and no brackets.
                match &arguments[..] {
                    [] => name.clone(),
                    _ => self.applied(name, &self.list(arguments, ", ")),
                }
            }
            // `ab~`: of an open name that may become letters.
            (Kind::Function(Named::Reverse, x), Printer::Text(_)) => self.part(x, Hold::Postfix) + "~",
            (_, Printer::Latex) => latex::bare(node, followed),
            (Kind::Number(x), _) => self.number(x),
            (Kind::Pi, _) => if self.is_ascii() { "pi" } else { "π" }.to_owned(),
            (Kind::Blade(generators), _) => blade(generators),
            (Kind::Pseudoscalar, _) => "I".to_owned(),
            (Kind::Name(name), _) => name.clone(),
            // Brackets that are kept.
            (Kind::Product(factors), _) if factors.len() == 1 => self.bracketed(&self.list(factors, "")),
            (Kind::Product(factors), _) => self.product(factors, followed),
            (Kind::Quotient(pair), _) => {
                // A `/` divides the whole product before it.
                let whole = matches!(pair.0.kind, Kind::Product(_)) || self.is_fraction(&pair.0);
                let dividend = if whole { self.bare(&pair.0, true) } else { self.part(&pair.0, Hold::Tight) };
                format!("{dividend}/{}", self.part(&pair.1, Hold::Prefix))
            }
            (Kind::Tight(tight, operands), _) => self.tight(*tight, operands),
            (Kind::Reverse(x), _) => format!("~{}", self.part(x, Hold::Prefix)),
            (Kind::Power(x, n), _) => self.power(x, *n),
            (Kind::Part(x, grades), _) => {
                let (open, close) = if self.is_ascii() { ('<', '>') } else { ('⟨', '⟩') };
                format!("{open}{}{close}{}", self.bare(x, false), grades_of(*grades))
            }
            (Kind::Function(function, x), _) => self.applied(function.name(), &self.bare(x, false)),
        }
    }

    fn sum(self, terms: &[(bool, Node)]) -> String {
        let minus = if self == Printer::Text(Style::Unicode) { "−" } else { "-" };
        let mut text = String::new();
        for (i, (negative, term)) in terms.iter().enumerate() {
            text += &match (i, negative) {
                (0, false) => String::new(),
                (0, true) => minus.to_owned(),
                (_, false) => " + ".to_owned(),
                (_, true) => format!(" {minus} "),
            };
            text += &self.part(term, Hold::Product);
        }
        text
    }

    fn product(self, factors: &[Node], followed: bool) -> String {
        let mut text = String::new();
        for (i, factor) in factors.iter().enumerate() {
            let last = i + 1 == factors.len();
            let next = match factor.kind {
                Kind::Total(..) if last && !followed => self.bare(factor, false),
                _ if !last && self.hold(factor) == Hold::Tight && grades::is_loose(factor) => {
                    self.bracketed(&self.bare(factor, false))
                }
                _ if i == 0 && self.is_fraction(factor) => self.bare(factor, true),
                _ => self.part(factor, Hold::Tight),
            };
            if i > 0 {
                text += if needs_star(&text, &next) { " * " } else { " " };
            }
            text += &next;
        }
        text
    }

    /// Whether it is written with a `/`.
    fn is_fraction(self, node: &Node) -> bool {
        match &node.kind {
            Kind::Quotient(_) => true,
            Kind::Number(x) => self.number(x).contains('/'),
            _ => false,
        }
    }

    fn tight(self, tight: Tight, operands: &[Node]) -> String {
        if self.is_called(tight, operands) {
            return self.applied(tight.name(), &self.list(operands, ", "));
        }
        let sign = match tight {
            Tight::Wedge if self.is_ascii() => '^',
            Tight::Dot if self.is_ascii() => '|',
            _ => tight.symbol(),
        };
        let operand = |operand: &Node| match &operand.kind {
            // `e^x` is the exponential if e has no value.
            Kind::Name(name) if name == "e" && self.is_ascii() => "(e)".to_owned(),
            _ => self.part(operand, Hold::Prefix),
        };
        operands.iter().map(operand).collect::<Vec<_>>().join(&sign.to_string())
    }

    /// Whether the product is written as a function: if it has no sign in this style, or if a number after `^` would be an
    /// exponent.
    fn is_called(self, tight: Tight, operands: &[Node]) -> bool {
        self.is_ascii()
            && match tight {
                Tight::Wedge => operands[1..].iter().any(is_exponent),
                Tight::Dot => false,
                _ => true,
            }
    }

    fn power(self, base: &Node, n: i32) -> String {
        let base = match &base.kind {
            Kind::Number(x) if !self.number(x).bytes().all(|c| c.is_ascii_digit()) => {
                self.bracketed(&self.number(x))
            }
            Kind::Name(name) if name == "e" => "(e)".to_owned(),
            Kind::Function(Named::Reverse, _) => self.bare(base, false),
            _ => self.part(base, Hold::Primary),
        };
        let exponent = n.to_string();
        if self.is_ascii() { format!("{base}^{exponent}") } else { base + &raised(&exponent) }
    }

    fn number(self, x: &Number) -> String {
        let fraction = x.ratio.and_then(|ratio| FRACTIONS.iter().find(|(_, n, d)| (*n, *d) == ratio));
        match fraction {
            Some((_, n, d)) if self.is_ascii() => format!("{n}/{d}"),
            Some((character, ..)) => character.to_string(),
            None => x.to_string(),
        }
    }
}

/// `e12`
fn blade(generators: &[u8]) -> String {
    generators.iter().fold("e".to_owned(), |text, g| text + &g.to_string())
}

/// The grades after `⟨A⟩`: none is grade 0.
fn grades_of(grades: Grades) -> String {
    match &listed(grades)[..] {
        [only] if only == "0" => String::new(),
        [only] => format!("_{only}"),
        list => format!("_{{{}}}", list.join(",")),
    }
}

/// Whether it would be an exponent after `^`: a number, or `(2)'`.
fn is_exponent(node: &Node) -> bool {
    match &node.kind {
        Kind::Derivative(x) => is_numeric(x),
        _ => is_numeric(node),
    }
}

/// Whether adjacent factors need a sign: two numbers could be one, and `I (B)` the value of a map I, as of the inertia.
fn needs_star(before: &str, after: &str) -> bool {
    let is_digit = |c: char| c.is_ascii_digit() || FRACTIONS.iter().any(|&(fraction, ..)| fraction == c);
    let is_pseudoscalar = before.strip_suffix('I').is_some_and(|rest| !rest.ends_with(char::is_alphanumeric));
    before.ends_with(is_digit) && after.starts_with(is_digit) || is_pseudoscalar && after.starts_with('(')
}

#[cfg(test)]
mod tests;
