//! LaTeX's commands for letters and accents, which also spell names in ASCII.

use super::letters::decomposed;

/// The command of a character in one of the tables.
pub(crate) fn command(table: &str, c: char) -> Option<&str> {
    table.split(' ').find_map(|entry| entry.strip_prefix(c))
}

/// Combining marks, each with its command.
pub(crate) const ACCENTS: &str = "\u{300}grave \u{301}acute \u{302}hat \u{303}tilde \u{304}bar \u{306}breve \u{307}dot \u{308}ddot \
                       \u{30c}check \u{20d7}vec";

/// The letters that Latin ones do not serve for, and the signs of directions, each with its command.
pub(crate) const LETTERS: &str = "αalpha βbeta γgamma δdelta εvarepsilon ζzeta ηeta θtheta ιiota κkappa λlambda μmu νnu ξxi πpi ρrho \
                       ςvarsigma σsigma τtau υupsilon φvarphi χchi ψpsi ωomega ΓGamma ΔDelta ΘTheta ΛLambda ΞXi ΠPi \
                       ΣSigma ΥUpsilon ΦPhi ΨPsi ΩOmega ∥parallel ⊥perp";

/// A name in ASCII letters, digits and single `_`: `Omega_B` for `Ω_B`, `R_prime` for `R'`.
pub(crate) fn plain_name(name: &str) -> String {
    let apart = |c| decomposed(c).map_or([Some(c), None], |(letter, mark)| [Some(letter), Some(mark)]);
    let mut plain = String::new();
    for c in name.chars().flat_map(apart).flatten() {
        match (c, command(LETTERS, c), command(ACCENTS, c)) {
            ('\'', ..) => plain += "_prime",
            ('∥' | '⊥', Some(word), _) | (_, _, Some(word)) => plain += &format!("_{word}"),
            (_, Some(word), _) => plain += word.trim_start_matches("var"),
            _ if c.is_ascii_alphanumeric() => plain.push(c),
            _ if c.is_ascii() => plain.push('_'),
            _ => plain += &format!("u{:x}", u32::from(c)),
        }
    }
    plain.split('_').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("_")
}
