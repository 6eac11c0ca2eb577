//! Errors for signs of other notations, which say what to write.

use crate::formula::syntax::commands::{ACCENTS, LETTERS};

/// The length in bytes of the sign that a text begins with and that has no meaning, and the error.
pub(super) fn foreign(text: &str) -> (usize, String) {
    let c = text.chars().next().unwrap_or('\\');
    if is_invisible(c) {
        let message =
            format!("the invisible character U+{:04X} has no meaning in a formula; remove it", c as u32);
        return (c.len_utf8(), message);
    }
    let sign = match c {
        '\\' => &text[..1 + command_length(&text[1..])],
        ':' if text.starts_with(":=") => ":=",
        _ => &text[..c.len_utf8()],
    };
    let remedy = match sign.strip_prefix('\\') {
        Some(command) => latex(command),
        None => remedy(sign, c),
    };
    let remedy = remedy.map_or(String::new(), |remedy| format!("; {remedy}"));
    (sign.len(), format!("`{sign}` has no meaning in a formula{remedy}"))
}

/// Control characters, and those that join, divide and reorder text.
fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{200c}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The length of a command after the backslash: letters, or one other character.
fn command_length(text: &str) -> usize {
    let letters = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
    if letters == 0 { text.chars().next().map_or(0, char::len_utf8) } else { letters }
}

fn remedy(sign: &str, c: char) -> Option<String> {
    let remedy = match c {
        '$' => PLAIN_TEXT,
        '.' => "write a product as `a b`, `a·b` or `a∧b`",
        '"' | '`' => "write names without quotes",
        '∨' | '&' => "join and meet are methods in Python",
        '⋏' => "write a wedge as `∧` or `^`",
        '⊗' | '∘' => "write a geometric product as `A B`",
        '‖' | '∥' => "write a magnitude as `norm(a)`",
        '√' => "write a square root as `sqrt(A)`",
        ':' if sign == ":=" => "write `=`",
        '÷' | ':' => "divide with `/`",
        '—' | '―' | '‒' | '‑' | '‐' | '﹣' => "write a minus as `-` or `−`",
        '↦' | '→' | '⇒' | ';' => "write one formula or equation at a time",
        '°' => "angles are in radians: write 90 degrees as `90 π/180`",
        '∫' => "there are sums (Σ) but no integrals",
        '∂' | '∇' => "derivatives are primes, `R'`; the gradient of a formula is `grad` in Python",
        '∞' => "numbers are finite",
        '≈' | '≃' | '≅' | '≡' | '≝' | '≔' => {
            "write an equation with `=`; floats agree within 1e-9 of the size of the terms"
        }
        '≠' | '≤' | '≥' => "an equation with `=` is true or false; there are no other comparisons",
        '±' | '∓' => "write two formulas, one with `+`, one with `-`",
        '…' | '⋯' => "write all terms, or a sum over an index, `Σ_k`",
        '\u{ff01}'..='\u{ff5e}' => {
            let plain = char::from_u32(c as u32 - 0xfee0).unwrap_or(c);
            return Some(format!("it is the full-width U+{:04X}: write `{plain}`", c as u32));
        }
        _ => return None,
    };
    Some(remedy.to_owned())
}

const PLAIN_TEXT: &str = "write plain text, `θ/2 e1∧e2`, not LaTeX";

/// What to write for a command of LaTeX.
fn latex(name: &str) -> Option<String> {
    let letter = LETTERS.split(' ').find(|entry| {
        let spelled = entry.trim_start_matches(|c: char| !c.is_ascii());
        spelled == name || spelled.trim_start_matches("var") == name.trim_start_matches("var")
    });
    if let Some(letter) = letter.and_then(|entry| entry.chars().next()) {
        return Some(format!("write `{letter}`"));
    }
    let remedy = match name {
        "wedge" | "land" => "write `∧` or `^`",
        "cdot" | "bullet" => "write `·` or `|`",
        "times" => "write a commutator as `×`, a cross product as `cross(a, b)`",
        "tilde" | "widetilde" | "dagger" | "dag" | "sim" => "write a reverse as `~R`, `R̃` or `R†`",
        "frac" | "tfrac" | "dfrac" => "write a fraction as `½`, `θ/2` or `(a + b)/c`",
        "dot" => "write a derivative as `R'`",
        "ddot" => "write a second derivative as `R''`",
        "sqrt" => "write a square root as `sqrt(A)`",
        "ln" => "write a logarithm as `log(A)`",
        "exp" | "log" | "sin" | "cos" | "tan" => return Some(format!("write `{name}(…)`")),
        "sum" => "write a sum as `Σ_k` or `sum_k`",
        "rfloor" | "lrcorner" => "write `⌋` or `left_contraction(A, B)`",
        "lfloor" | "llcorner" => "write `⌊` or `right_contraction(A, B)`",
        "langle" | "rangle" => "write a part as `⟨A⟩_2` or `<A>_2`",
        "Vert" | "lVert" | "rVert" | "|" | "lvert" | "rvert" | "vert" => "write a magnitude as `norm(a)`",
        "left" | "right" | "big" | "Big" | "bigl" | "bigr" | "Bigl" | "Bigr" | "{" | "}" => {
            "write the bracket alone, `(`, `[` or `{`"
        }
        "," | ";" | "!" | ":" | " " | "quad" | "qquad" => "write a space",
        "mathbf" | "boldsymbol" | "bm" | "mathrm" | "mathsf" | "mathcal" | "mathit" | "text"
        | "operatorname" | "overline" | "underline" | "vec" => "write the name alone, `a`",
        "circ" => return remedy("°", '°'),
        "int" => return remedy("∫", '∫'),
        "partial" | "nabla" => return remedy("∂", '∂'),
        "infty" => return remedy("∞", '∞'),
        "approx" | "equiv" | "simeq" | "cong" => return remedy("≈", '≈'),
        "ne" | "neq" | "le" | "leq" | "ge" | "geq" => return remedy("≠", '≠'),
        "pm" | "mp" => return remedy("±", '±'),
        _ => return Some(accent(name).unwrap_or_else(|| PLAIN_TEXT.to_owned())),
    };
    Some(remedy.to_owned())
}

/// `\hat` is a mark above a letter.
fn accent(name: &str) -> Option<String> {
    let mark = ACCENTS.split(' ').find(|entry| entry.trim_start_matches(|c: char| !c.is_ascii()) == name)?;
    Some(format!("write the letter with its mark, `n{}`", mark.chars().next()?))
}
