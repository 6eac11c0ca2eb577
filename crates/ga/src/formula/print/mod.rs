//! Canonical spelling of formulas as text.
//!
//! Brackets appear only where the text would otherwise parse as another tree: around a part that binds less tightly
//! than its place requires. Spaces separate factors, so that names never run together, whatever else is bound.

pub(crate) mod glyphs;
pub(crate) mod latex;

use super::syntax::letters::raised;
use super::syntax::number::{FRACTIONS, Number};
use super::syntax::tree::is_numeric;
use super::syntax::tree::{Kind, Named, Node, Tight, Tree};
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
        let mut printer = Printer { style, out: String::new() };
        printer.list(&self.sides, " = ");
        printer.out
    }
}

impl Node {
    /// This part of a formula in canonical spelling.
    pub fn text(&self, style: Style) -> String {
        let mut printer = Printer { style, out: String::new() };
        printer.bare(self, false);
        printer.out
    }
}

/// The precedence of a node, the loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Hold {
    Sum,
    Product,
    Tight,
    Prefix,
    Postfix,
    Primary,
}

struct Printer {
    style: Style,
    out: String,
}

impl Printer {
    fn ascii(&self) -> bool {
        self.style == Style::Ascii
    }

    /// The spelling in this style.
    fn push(&mut self, unicode: &str, ascii: &str) {
        self.out.push_str(if self.ascii() { ascii } else { unicode });
    }

    fn hold(&self, node: &Node) -> Hold {
        match &node.kind {
            Kind::Number(x) if self.number(x).contains('/') => Hold::Product,
            Kind::Sum(_) => Hold::Sum,
            Kind::Product(_) | Kind::Quotient(_) | Kind::Total(..) => Hold::Product,
            Kind::Tight(tight, operands) if self.is_called(*tight, operands) => Hold::Primary,
            Kind::Tight(..) => Hold::Tight,
            Kind::Reverse(_) | Kind::Function(Named::Reverse, _) => Hold::Prefix,
            Kind::Power(..) | Kind::Derivative(_) => Hold::Postfix,
            _ => Hold::Primary,
        }
    }

    /// In brackets if it binds less tightly.
    fn part(&mut self, node: &Node, least: Hold) {
        if self.hold(node) < least {
            self.bracketed(node);
        } else {
            self.bare(node, false);
        }
    }

    fn bracketed(&mut self, node: &Node) {
        self.out.push('(');
        self.bare(node, false);
        self.out.push(')');
    }

    fn list(&mut self, nodes: &[Node], separator: &str) {
        for (i, node) in nodes.iter().enumerate() {
            self.out.push_str(if i > 0 { separator } else { "" });
            self.bare(node, false);
        }
    }

    /// Without brackets round it. Whether more factors follow matters to a sum over an index, which takes
    /// all of them.
    fn bare(&mut self, node: &Node, followed: bool) {
        match &node.kind {
            Kind::Number(x) => {
                let text = self.number(x);
                self.out.push_str(&text);
            }
            Kind::Pi => self.push("π", "pi"),
            Kind::Blade(generators) => self.out.push_str(&blade(generators)),
            Kind::Pseudoscalar => self.out.push('I'),
            Kind::Name(name) => self.out.push_str(name),
            Kind::Sum(terms) => self.sum(terms),
            Kind::Product(factors) => self.product(factors, followed),
            Kind::Quotient(pair) => {
                self.dividend(&pair.0);
                self.out.push('/');
                self.part(&pair.1, Hold::Prefix);
            }
            Kind::Tight(tight, operands) => self.tight(*tight, operands),
            Kind::Reverse(x) | Kind::Function(Named::Reverse, x) => {
                self.out.push('~');
                self.part(x, Hold::Prefix);
            }
            Kind::Power(x, n) => self.power(x, *n),
            Kind::Part(x, grades) => {
                self.push("⟨", "<");
                self.bare(x, false);
                self.push("⟩", ">");
                self.out.push_str(&grades_of(*grades));
            }
            Kind::Function(function, x) => {
                self.out.push_str(function.name());
                self.bracketed(x);
            }
            Kind::Call(name, arguments) => self.call(name, arguments),
            Kind::Derivative(x) => {
                self.bracketed(x);
                self.out.push('\'');
            }
            Kind::Total(index, x) => {
                self.push("Σ_", "sum_");
                self.out.push_str(index);
                self.out.push(' ');
                self.part(x, Hold::Product);
            }
        }
    }

    /// A defined value has no arguments and no brackets.
    fn call(&mut self, name: &str, arguments: &[Node]) {
        self.out.push_str(name);
        if !arguments.is_empty() {
            self.out.push('(');
            self.list(arguments, ", ");
            self.out.push(')');
        }
    }

    fn sum(&mut self, terms: &[(bool, Node)]) {
        for (i, (negative, term)) in terms.iter().enumerate() {
            match (i, negative) {
                (0, false) => {}
                (0, true) => self.push("−", "-"),
                (_, false) => self.out.push_str(" + "),
                (_, true) => self.push(" − ", " - "),
            }
            self.part(term, Hold::Product);
        }
    }

    fn product(&mut self, factors: &[Node], followed: bool) {
        for (i, factor) in factors.iter().enumerate() {
            let before = self.out.len();
            self.out.push_str(if i > 0 { " " } else { "" });
            let followed = followed || i + 1 < factors.len();
            match factor.kind {
                Kind::Total(..) if !followed => self.bare(factor, false),
                _ if i == 0 && self.is_fraction(factor) => self.bare(factor, true),
                _ => self.part(factor, Hold::Tight),
            }
            if i > 0 && needs_star(&self.out[..before], &self.out[before + 1..]) {
                self.out.insert_str(before, " *");
            }
        }
    }

    /// A `/` divides the whole product before it.
    fn dividend(&mut self, node: &Node) {
        match node.kind {
            Kind::Product(_) | Kind::Quotient(_) => self.bare(node, true),
            _ if self.is_fraction(node) => self.bare(node, true),
            _ => self.part(node, Hold::Tight),
        }
    }

    /// Whether it is written with a `/`.
    fn is_fraction(&self, node: &Node) -> bool {
        match &node.kind {
            Kind::Quotient(_) => true,
            Kind::Number(x) => self.number(x).contains('/'),
            _ => false,
        }
    }

    fn tight(&mut self, tight: Tight, operands: &[Node]) {
        if self.is_called(tight, operands) {
            return self.call(tight.name(), operands);
        }
        for (i, operand) in operands.iter().enumerate() {
            if i > 0 {
                let symbol = tight.symbol().encode_utf8(&mut [0; 4]).to_owned();
                self.push(&symbol, if tight == Tight::Wedge { "^" } else { "|" });
            }
            // `e^x` is the exponential if e has no value.
            match &operand.kind {
                Kind::Name(name) if name == "e" && self.ascii() => self.bracketed(operand),
                _ => self.part(operand, Hold::Prefix),
            }
        }
    }

    /// Whether the product is written as a function: if it has no sign in this style, or if a number after `^` would be an
    /// exponent.
    fn is_called(&self, tight: Tight, operands: &[Node]) -> bool {
        self.ascii()
            && match tight {
                Tight::Wedge => operands[1..].iter().any(is_exponent),
                Tight::Dot => false,
                _ => true,
            }
    }

    fn power(&mut self, base: &Node, n: i32) {
        match &base.kind {
            Kind::Number(x) if !self.number(x).bytes().all(|c| c.is_ascii_digit()) => self.bracketed(base),
            Kind::Name(name) if name == "e" => self.bracketed(base),
            _ => self.part(base, Hold::Primary),
        }
        if self.ascii() {
            self.out.push('^');
            self.out.push_str(&n.to_string());
        } else {
            self.out.extend(n.to_string().chars().filter_map(raised));
        }
    }

    fn number(&self, x: &Number) -> String {
        let fraction = x.ratio.and_then(|ratio| FRACTIONS.iter().find(|(_, n, d)| (*n, *d) == ratio));
        match fraction {
            Some((_, n, d)) if self.ascii() => format!("{n}/{d}"),
            Some((character, ..)) => character.to_string(),
            None => x.to_string(),
        }
    }
}

/// `e12`
pub(super) fn blade(generators: &[u8]) -> String {
    generators.iter().fold("e".to_owned(), |text, g| text + &g.to_string())
}

/// The grades after `⟨A⟩`: none is grade 0.
fn grades_of(grades: Grades) -> String {
    let list: Vec<String> = (0..16).filter(|&k| grades.contains(k)).map(|k| k.to_string()).collect();
    match list.as_slice() {
        [only] if only == "0" => String::new(),
        [only] => format!("_{only}"),
        _ => format!("_{{{}}}", list.join(",")),
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
mod tests {
    use super::*;
    use crate::formula::tests::build::*;

    #[track_caller]
    fn check(node: Node, unicode: &str, ascii: &str) {
        assert_eq!(node.text(Style::Unicode), unicode);
        assert_eq!(node.text(Style::Ascii), ascii);
    }

    #[test]
    fn formulas_print_as_on_paper() {
        let turned = product([x("R"), x("v"), reverse(x("R"))]);
        let inner = tight(Tight::Dot, [wedge(x("a"), x("b")), x("c")]);
        check(plus(turned, inner), "R v ~R + (a∧b)·c", "R v ~R + (a^b)|c");
        check(minus(product([x("½"), x("Ω_S"), x("R")])), "−½ Ω_S R", "-1/2 Ω_S R");
        check(minus(product([x("I"), wedge(x("a"), x("b"))])), "−I a∧b", "-I a^b");
        let half_turn = minus(product([over(x("θ"), x("2")), wedge(x("e1"), x("e2"))]));
        check(product([exp(half_turn), x("e1")]), "exp(−θ/2 e1∧e2) e1", "exp(-θ/2 e1^e2) e1");
        check(tight(Tight::Wedge, [x("a"), x("b"), x("c")]), "a∧b∧c", "a^b^c");
        check(part(product([x("A"), x("B")]), 4), "⟨A B⟩_2", "<A B>_2");
        check(part(x("A"), 1), "⟨A⟩", "<A>");
        check(part(x("A"), 5), "⟨A⟩_{0,2}", "<A>_{0,2}");
        check(product([power(x("a"), -1), power(x("B"), 12)]), "a⁻¹ B¹²", "a^-1 B^12");
        check(product([x("2"), x("π"), x("e12")]), "2 π e12", "2 pi e12");
        let equation = tree([derivative(product([x("R"), x("S")])), x("T'")]);
        assert_eq!(equation.text(Style::Unicode), "(R S)' = T'");
    }

    #[test]
    fn signs_that_a_keyboard_lacks_are_functions() {
        let (a, b) = (|| x("a"), || x("b"));
        check(tight(Tight::Dot, [a(), b()]), "a·b", "a|b");
        let product = product([tight(Tight::Commutator, [a(), minus(b())]), x("c")]);
        check(product, "a×(−b) c", "commutator(a, -b) c");
        check(tight(Tight::Cross, [a(), b()]), "a⨯b", "cross(a, b)");
        let contracted = tight(Tight::LeftContraction, [a(), b()]);
        check(power(contracted, 2), "(a⌋b)²", "left_contraction(a, b)^2");
        check(tight(Tight::RightContraction, [a(), wedge(a(), b())]), "a⌊(a∧b)", "right_contraction(a, a^b)");
    }

    #[test]
    fn brackets_stand_where_they_are_needed() {
        let (a, b, c) = (|| x("a"), || x("b"), || x("c"));
        check(product([plus(a(), b()), minus(c())]), "(a + b) (−c)", "(a + b) (-c)");
        check(plus(minus(a()), plus(b(), c())), "(−a) + (b + c)", "(-a) + (b + c)");
        check(product([a(), product([b(), c()])]), "a (b c)", "a (b c)");
        check(product([over(a(), b()), c()]), "a/b c", "a/b c");
        check(product([c(), over(a(), b())]), "c (a/b)", "c (a/b)");
        check(over(product([a(), b()]), c()), "a b/c", "a b/c");
        check(over(over(a(), b()), product([b(), c()])), "a/b/(b c)", "a/b/(b c)");
        check(wedge(wedge(a(), b()), over(a(), c())), "(a∧b)∧(a/c)", "(a^b)^(a/c)");
        check(reverse(power(a(), 2)), "~a²", "~a^2");
        check(power(reverse(a()), 2), "(~a)²", "(~a)^2");
        check(power(power(a(), 2), 3), "(a²)³", "(a^2)^3");
        check(derivative(a()), "(a)'", "(a)'");
        check(wedge(a(), reverse(b())), "a∧~b", "a^~b");
        check(reverse(reverse(wedge(a(), b()))), "~~(a∧b)", "~~(a^b)");
    }

    #[test]
    fn a_sum_over_an_index_takes_the_product_after_it() {
        let one = || total("k", product([x("ω_k"), x("I"), x("e_k")]));
        check(one(), "Σ_k ω_k I e_k", "sum_k ω_k I e_k");
        check(total("k", plus(x("a_k"), x("b"))), "Σ_k (a_k + b)", "sum_k (a_k + b)");
        check(plus(one(), x("b")), "Σ_k ω_k I e_k + b", "sum_k ω_k I e_k + b");
        check(product([x("½"), one()]), "½ Σ_k ω_k I e_k", "1/2 sum_k ω_k I e_k");
        check(product([one(), x("b")]), "(Σ_k ω_k I e_k) b", "(sum_k ω_k I e_k) b");
        check(over(product([x("a"), one()]), x("b")), "a (Σ_k ω_k I e_k)/b", "a (sum_k ω_k I e_k)/b");
    }

    #[test]
    fn numbers_stay_apart_and_are_no_exponents() {
        check(product([x("2"), x("3"), x("a")]), "2 * 3 a", "2 * 3 a");
        check(product([power(x("2"), 3), x("½")]), "2³ ½", "2^3 (1/2)");
        check(product([over(x("a"), x("2")), x("3")]), "a/2 * 3", "a/2 * 3");
        check(power(x("½"), 2), "(½)²", "(1/2)^2");
        check(power(x("0.1"), 2), "(0.1)²", "(0.1)^2");
        check(over(x("½"), x("½")), "½/½", "1/2/(1/2)");
        check(wedge(x("2"), x("a")), "2∧a", "2^a");
        check(wedge(x("a"), x("2")), "a∧2", "wedge(a, 2)");
        check(wedge(x("a"), minus(x("2"))), "a∧(−2)", "wedge(a, -2)");
        check(wedge(x("a"), power(x("2"), 2)), "a∧2²", "wedge(a, 2^2)");
        check(product([x("1e-7"), x("a")]), "1e-7 a", "1e-7 a");
    }

    #[test]
    fn functions_keep_their_brackets_and_products_their_space() {
        check(call("V", [x("x"), minus(x("y"))]), "V(x, −y)", "V(x, -y)");
        check(product([x("R"), plus(x("a"), x("b"))]), "R (a + b)", "R (a + b)");
        check(product([x("I"), plus(x("a"), x("b"))]), "I * (a + b)", "I * (a + b)");
        check(product([call("c", []), plus(x("a"), x("b"))]), "c (a + b)", "c (a + b)");
        check(function(Named::Norm, x("a")), "norm(a)", "norm(a)");
        check(function(Named::Reverse, plus(x("a"), x("b"))), "~(a + b)", "~(a + b)");
    }
}
