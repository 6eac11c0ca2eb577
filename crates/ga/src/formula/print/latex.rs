//! Parts of formulas in LaTeX, for amsmath, KaTeX, MathJax and Matplotlib's mathtext.
//!
//! Fractions and exponents need no inner brackets, so there are fewer than in text. As a factor, a tight product is set
//! close, `a{\wedge}b`, to show that it binds first.

use super::{Hold, Printer, blade};
use crate::formula::syntax::commands::{ACCENTS, LETTERS, command};
use crate::formula::syntax::grades;
use crate::formula::syntax::indices::INDICES;
use crate::formula::syntax::letters::decomposed;
use crate::formula::syntax::number::{FRACTIONS, Number};
use crate::formula::syntax::tree::{Kind, Named, Node, Tight, listed};
use crate::g3::functions::Function;

/// The precedence of a node that differs from that in text.
pub(super) fn hold(node: &Node) -> Hold {
    match &node.kind {
        Kind::Number(x) if x.to_string().contains('e') => Hold::Tight,
        Kind::Number(x) if number(x).starts_with('\\') => Hold::Prefix,
        Kind::Quotient(_) => Hold::Prefix,
        Kind::Function(Named::Function(Function::Exp | Function::Inverse), _) => Hold::Postfix,
        Kind::Reverse(x) if leaves(x).is_none_or(|n| n > SHORT) => Hold::Postfix,
        _ => Hold::Primary,
    }
}

pub(super) fn is_tall(text: &str) -> bool {
    ["\\frac", "\\sum", "\\left"].iter().any(|command| text.contains(command))
}

fn inner(node: &Node) -> String {
    Printer::Latex.bare(node, false)
}

fn part(node: &Node, least: Hold) -> String {
    Printer::Latex.part(node, least)
}

/// A node spelled otherwise than in text, without brackets round it. Whether more factors follow matters to a sum over an
/// index, which takes all of them.
pub(super) fn bare(node: &Node, followed: bool) -> String {
    match &node.kind {
        Kind::Number(x) => number(x),
        Kind::Pi => "\\pi".to_owned(),
        Kind::Product(factors) => product(factors, followed),
        Kind::Quotient(pair) => format!("\\frac{{{}}}{{{}}}", inner(&pair.0), inner(&pair.1)),
        Kind::Tight(product, operands) => tight(operands, sign(*product).1),
        Kind::Reverse(x) => reverse(x),
        Kind::Function(Named::Reverse, x) => part(x, Hold::Primary) + "^{\\sim}",
        Kind::Power(x, n) => format!("{}^{{{n}}}", part(x, Hold::Primary)),
        Kind::Part(x, grades) => {
            let (text, list) = (inner(x), listed(*grades));
            let (left, right) = if is_tall(&text) { ("\\left", "\\right") } else { ("", "") };
            let below = if list == ["0"] { String::new() } else { format!("_{{{}}}", list.join(",")) };
            format!("{left}\\langle {text} {right}\\rangle{below}")
        }
        Kind::Function(function, x) => call_named(*function, x),
        Kind::Total(index, x) => format!("\\sum_{{{}}} {}", subscript(index), part(x, Hold::Product)),
        _ => letters(node, "").unwrap_or_default(),
    }
}

/// Letters stand side by side; what is wider has a thin space round it, also lest `R (x)` be a function of x.
fn product(factors: &[Node], followed: bool) -> String {
    let mut text = String::new();
    for (i, factor) in factors.iter().enumerate() {
        let followed = followed || i + 1 < factors.len();
        let mut next = match &factor.kind {
            Kind::Total(..) if !followed => inner(factor),
            Kind::Tight(..) if i + 1 < factors.len() && grades::is_loose(factor) => {
                Printer::Latex.bracketed(&inner(factor))
            }
            // A tight product has no space around its sign.
            Kind::Tight(product, operands) => tight(operands, sign(*product).0),
            _ => part(factor, Hold::Tight),
        };
        if i > 0 {
            if next.starts_with(|c: char| c.is_ascii_digit()) {
                next = Printer::Latex.bracketed(&next);
            }
            text += if is_narrow(&factors[i - 1]) && is_narrow(factor) { " " } else { "\\," };
        }
        text += &next;
    }
    text
}

fn tight(operands: &[Node], sign: &str) -> String {
    operands.iter().map(|x| part(x, Hold::Prefix)).collect::<Vec<_>>().join(sign)
}

/// The sign set close and with space.
fn sign(product: Tight) -> (&'static str, &'static str) {
    match product {
        Tight::Wedge => ("{\\wedge}", " \\wedge "),
        Tight::Dot => ("{\\cdot}", " \\cdot "),
        Tight::Commutator => ("{\\times}", " \\times "),
        Tight::Cross => ("{\\boldsymbol{\\times}}", " \\boldsymbol{\\times} "),
        Tight::LeftContraction => ("{\\rfloor}", " \\,\\rfloor\\, "),
        Tight::RightContraction => ("{\\lfloor}", " \\,\\lfloor\\, "),
    }
}

/// Whether it is about as wide as a letter.
fn is_narrow(node: &Node) -> bool {
    match &node.kind {
        Kind::Number(_) | Kind::Pi | Kind::Blade(_) | Kind::Pseudoscalar => true,
        Kind::Name(name) => core(name).chars().count() == 1 && !name.contains('('),
        Kind::Reverse(x) | Kind::Power(x, _) => is_narrow(x),
        Kind::Quotient(_) => true,
        _ => false,
    }
}

fn call_named(function: Named, x: &Node) -> String {
    let text = inner(x);
    match function {
        Named::Function(Function::Exp) => format!("e^{{{text}}}"),
        Named::Function(Function::Sqrt) => format!("\\sqrt{{{text}}}"),
        Named::Function(Function::Inverse) => part(x, Hold::Primary) + "^{-1}",
        Named::Norm => format!("\\left\\Vert {text} \\right\\Vert"),
        Named::Function(Function::Log) | Named::Sin | Named::Cos | Named::Tan => {
            Printer::Latex.applied(&format!("\\{}", function.name()), &text)
        }
        _ => Printer::Latex.applied(&format!("\\operatorname{{{}}}", function.name()), &text),
    }
}

/// Maximum number of letters under one tilde.
const SHORT: usize = 3;

/// The number of letters, if it consists of letters only.
fn leaves(node: &Node) -> Option<usize> {
    match &node.kind {
        Kind::Name(_) | Kind::Blade(_) | Kind::Pseudoscalar => Some(1),
        Kind::Product(parts) | Kind::Tight(_, parts) => parts.iter().map(leaves).sum(),
        _ => None,
    }
}

/// A tilde over one letter, with its indices beside it; over a few letters; after a bracket.
fn reverse(x: &Node) -> String {
    let tilde = if is_narrow(x) { "\\tilde" } else { "\\widetilde" };
    if let Some(text) = letters(x, tilde) {
        return text;
    }
    let text = inner(x);
    let short = leaves(x).is_some_and(|n| n <= SHORT);
    if short { format!("\\widetilde{{{text}}}") } else { Printer::Latex.bracketed(&text) + "^{\\sim}" }
}

/// A name or a blade, with an accent over what stands before its indices.
fn letters(node: &Node, accent: &str) -> Option<String> {
    match &node.kind {
        Kind::Name(name) => Some(word(name, accent)),
        Kind::Blade(generators) => Some(word(&blade(generators), accent)),
        Kind::Pseudoscalar => Some(word("I", accent)),
        _ => None,
    }
}

fn number(x: &Number) -> String {
    if let Some((n, d)) = x.ratio.filter(|ratio| FRACTIONS.iter().any(|(_, n, d)| (*n, *d) == *ratio)) {
        return format!("\\frac{{{n}}}{{{d}}}");
    }
    let text = x.to_string();
    match text.split_once('e') {
        Some(("1", exponent)) => format!("10^{{{}}}", exponent.trim_start_matches('+')),
        Some((digits, exponent)) => {
            format!("{digits} {{\\times}} 10^{{{}}}", exponent.trim_start_matches('+'))
        }
        None => text,
    }
}

// --- names: letters, accents, indices, primes and labels

/// The letters of a name before its indices, primes and label.
fn core(name: &str) -> &str {
    let end = name.find(|c: char| c.is_ascii_digit() || "_'(∥⊥".contains(c));
    &name[..end.unwrap_or(name.len())]
}

/// A name: letters, indices below, primes, a label `(t)`.
pub(super) fn word(name: &str, accent: &str) -> String {
    let letters = core(name);
    let rest = &name[letters.len()..];
    let (rest, label) = rest.split_at(rest.find('(').unwrap_or(rest.len()));
    let indices = rest.trim_end_matches('\'');
    let primes = &rest[indices.len()..];

    let mut text = upright(letters);
    if !accent.is_empty() {
        text = format!("{accent}{{{text}}}");
    }
    if !indices.is_empty() {
        text += &format!("_{{{}}}", subscript(indices.trim_start_matches('_')));
    }
    // A label is a number or a name without a label.
    let label = label.trim_start_matches('(').trim_end_matches(')');
    let label = match label.chars().next() {
        None => String::new(),
        Some(c) if c.is_alphabetic() => format!("({})", word(label, "")),
        Some(_) => format!("({label})"),
    };
    text + primes + &label
}

/// More than three Latin letters are a word, set upright; fewer may be factors and are set as such.
fn upright(letters: &str) -> String {
    if letters.len() > 3 && letters.bytes().all(|c| c.is_ascii_alphabetic()) {
        return format!("\\mathrm{{{letters}}}");
    }
    let mut marked: Vec<(char, Vec<&str>)> = Vec::new();
    let apart = |c| decomposed(c).map_or([Some(c), None], |(letter, mark)| [Some(letter), Some(mark)]);
    for c in letters.chars().flat_map(apart).flatten() {
        match (command(ACCENTS, c), marked.last_mut()) {
            (Some(accent), Some((_, accents))) => accents.push(accent),
            _ => marked.push((c, Vec::new())),
        }
    }
    let texts: Vec<String> = marked.into_iter().map(|(c, accents)| accented(c, &accents)).collect();
    texts.join(" ")
}

/// A letter below accents, the first of them the lowest.
fn accented(c: char, accents: &[&str]) -> String {
    let above: String = accents.iter().rev().map(|accent| format!("\\{accent}{{")).collect();
    above + &letter(c) + &"}".repeat(accents.len())
}

fn subscript(indices: &str) -> String {
    let parts: Vec<String> = indices.split('_').map(upright_or_digits).collect();
    parts.join(",")
}

/// An index: digits, letters that count, or a word, which is set upright.
fn upright_or_digits(index: &str) -> String {
    if index.bytes().all(|c| c.is_ascii_digit()) {
        return index.to_owned();
    }
    let word = index.len() > 1 && index.bytes().all(|c| c.is_ascii_alphabetic());
    match word && !index.chars().all(|c| INDICES.contains(c)) {
        true => format!("\\mathrm{{{index}}}"),
        false => upright(index),
    }
}

/// One character of a name.
fn letter(c: char) -> String {
    match command(LETTERS, c) {
        Some(command) => format!("\\{command}"),
        None if "#$%&_{}~^\\".contains(c) => format!("\\{c}"),
        None => c.to_string(),
    }
}

#[cfg(test)]
mod tests;
