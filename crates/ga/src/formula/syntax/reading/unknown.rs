//! Errors for words without a meaning, which say what they may stand for.

use super::Reader;
use crate::diagnostic::{nearest, quote};
use crate::formula::Error;
use crate::formula::syntax::commands::plain_name;
use crate::formula::syntax::letters::look_alike;
use crate::formula::syntax::names::Meaning;
use crate::formula::syntax::token::{Atom, Item, Token, canonical};
use crate::formula::syntax::tree::{Named, Tight};

/// Maximum number of places where a word is cut into two names.
const LONGEST_SPLIT: usize = 40;

impl Reader<'_> {
    /// The error for a name without a value, which was also read letter by letter.
    pub(super) fn unknown(&self, token: &Token, atoms: &[Atom], called: bool, before: &[Token]) -> Error {
        let word: String = atoms.iter().map(|atom| &atom.name[..]).collect();
        let message = format!("{} has no value", quote(&word));
        let missing: Vec<&str> =
            atoms.iter().filter(|a| self.atom(a, false).is_none()).map(|a| &a.name[..]).collect();
        let remedy = in_latin(&missing, &word)
            .or_else(|| if called { of_function(&word) } else { None })
            .or_else(|| missing.contains(&"Λ").then(|| "; write a wedge as `∧` or `^`".to_owned()))
            .or_else(|| self.respelled(&word).map(|name| format!("; did you mean `{name}`?")))
            .or_else(|| self.split(&word, called).map(|apart| format!("; write `{apart}`")));
        if let Some(remedy) = remedy {
            return Error::new(token.span, message + &remedy);
        }
        let mut message = message + &letter_by_letter(atoms, &missing) + &self.suggestion(&word);
        let after_factor = before.last().is_some_and(|last| {
            matches!(last.item, Item::Name(_) | Item::Blade(_) | Item::Pseudoscalar | Item::Close(_))
        });
        if word == "x" && token.space && after_factor {
            message += ". Write the cross product as `a ⨯ b` or `cross(a, b)`";
        }
        Error::new(token.span, message)
    }

    /// The name that is the word in other letters: `θ` for `theta`, `R'` for `Ṙ`, `spin` for `Spin`.
    fn respelled(&self, word: &str) -> Option<&str> {
        let (plain, lower) = (plain_parts(word), word.to_lowercase());
        let mut names = self.names.iter();
        let same = self.names.iter().find(|name| plain_parts(name) == plain);
        same.or_else(|| names.find(|name| name.to_lowercase() == lower))
    }

    /// A name that the word may stand for, or the names that have values.
    fn suggestion(&self, word: &str) -> String {
        let functions = Named::ALL.iter().map(|f| f.name()).chain(Tight::ALL.iter().map(|t| t.name()));
        let known: Vec<&str> = self.names.iter().collect();
        if let Some(near) = nearest(word, known.iter().copied().chain(functions)) {
            return format!("; did you mean `{near}`?");
        }
        if known.is_empty() {
            return "; no names have values here".to_owned();
        }
        let more = if known.len() > 8 { ", …" } else { "" };
        format!("; names with values: {}{more}", known[..known.len().min(8)].join(", "))
    }

    /// Two names with a meaning that make up a word: `spin a` for `spina`.
    fn split(&self, word: &str, called: bool) -> Option<String> {
        let cuts = word.char_indices().skip(1).take(LONGEST_SPLIT);
        let mut pairs = cuts.map(|(at, _)| word.split_at(at));
        let (a, b) = pairs.find(|(a, b)| self.is_known(a, false) && self.is_known(b, called))?;
        Some(format!("{a} {b}{}", if called { "(…)" } else { "" }))
    }

    /// Whether a word has a meaning, before an opening bracket or not.
    fn is_known(&self, word: &str, called: bool) -> bool {
        let Some(name) = canonical(word).filter(|name| !name.contains('(')) else { return false };
        match self.names.get(&name) {
            Some(Meaning::Value(_)) => true,
            Some(Meaning::Map { .. }) => called,
            Some(Meaning::Function(definition)) => called || definition.parameters.is_empty(),
            None => {
                let function =
                    Named::from_name(&name).is_some() || Tight::ALL.iter().any(|t| t.name() == name);
                let constant = self.built_in_atom(&name);
                name == "pi"
                    || function && called
                    || matches!(constant, Some(Item::Pi | Item::Pseudoscalar | Item::Blade(_)))
            }
        }
    }
}

/// Which letters have no meaning of their own.
fn letter_by_letter(atoms: &[Atom], missing: &[&str]) -> String {
    if atoms.len() < 2 {
        return String::new();
    }
    let mut shown: Vec<&str> = missing.iter().take(5).copied().collect();
    shown.dedup();
    let (verb, list) = (if shown.len() == 1 { "has" } else { "have" }, shown.join(", "));
    format!(" as one name; read as adjacent letters, {list} {verb} none")
}

/// What to write for functions of other programs.
fn of_function(word: &str) -> Option<String> {
    let remedy = match word {
        "grade" => "the part of grade 2 as `⟨A⟩_2` or `<A>_2`",
        "abs" | "mag" | "magnitude" | "length" => "a magnitude as `norm(a)`",
        "det" => "the determinant of a linear map F as `F(I)/I`",
        "inv" => "an inverse as `A⁻¹`, `A^-1` or `inverse(A)`",
        "ln" => "a logarithm as `log(A)`",
        "rev" => "a reverse as `~A` or `reverse(A)`",
        _ => return None,
    };
    Some(format!("; write {remedy}"))
}

/// What to write for a word with a letter of another script that looks like a Latin one.
fn in_latin(missing: &[&str], word: &str) -> Option<String> {
    let letter = missing.iter().find_map(|name| name.chars().find(|&c| look_alike(c).is_some()))?;
    let script = if ('\u{370}'..='\u{3ff}').contains(&letter) { "Greek" } else { "Cyrillic" };
    let latin = |c| look_alike(c).unwrap_or(c);
    let (like, written) = (latin(letter), quote(&word.chars().map(latin).collect::<String>()));
    let code = letter as u32;
    Some(format!(
        "; `{letter}` is the {script} letter U+{code:04X}, not the Latin `{like}`: write {written} in Latin letters"
    ))
}

/// The parts of a name in ASCII, in any order, with primes for dots: `θ` is `theta`, `Ṙ` is `R'`.
fn plain_parts(name: &str) -> Vec<String> {
    let plain = plain_name(name);
    let mut parts = Vec::new();
    for part in plain.split('_') {
        let (stem, primes) = match (part.strip_suffix("ddot"), part.strip_suffix("dot")) {
            (Some(stem), _) => (stem, 2),
            (_, Some(stem)) => (stem, 1),
            _ => (part, 0),
        };
        parts.extend([stem].into_iter().filter(|stem| !stem.is_empty()).map(str::to_owned));
        parts.extend(std::iter::repeat_n("prime".to_owned(), primes));
    }
    parts.sort_unstable();
    parts
}
