//! Names in LaTeX: letters, accents, indices, primes and labels.

use crate::formula::syntax::indices::INDICES;
use crate::formula::syntax::letters::decomposed;

/// The letters of a name before its indices, primes and label.
pub(crate) fn core(name: &str) -> &str {
    let end = name.find(|c: char| c.is_ascii_digit() || "_'(∥⊥".contains(c));
    &name[..end.unwrap_or(name.len())]
}

/// A name: letters, indices below, primes, a label `(t)`.
pub(crate) fn word(name: &str, accent: &str) -> String {
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

pub(crate) fn subscript(indices: &str) -> String {
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

fn command(table: &str, c: char) -> Option<&str> {
    table.split(' ').find_map(|entry| entry.strip_prefix(c))
}

/// Combining marks, each with its command.
const ACCENTS: &str = "\u{300}grave \u{301}acute \u{302}hat \u{303}tilde \u{304}bar \u{306}breve \u{307}dot \u{308}ddot \
                       \u{30c}check \u{20d7}vec";

/// The letters that Latin ones do not serve for, and the signs of directions, each with its command.
const LETTERS: &str = "αalpha βbeta γgamma δdelta εvarepsilon ζzeta ηeta θtheta ιiota κkappa λlambda μmu νnu ξxi πpi ρrho \
                       ςvarsigma σsigma τtau υupsilon φvarphi χchi ψpsi ωomega ΓGamma ΔDelta ΘTheta ΛLambda ΞXi ΠPi \
                       ΣSigma ΥUpsilon ΦPhi ΨPsi ΩOmega ∥parallel ⊥perp";
