//! Lexer: cuts text into numbers, words and signs.

use super::letters::{
    TILDE, below_tilde, composed, folded, is_letter, is_mark, is_space, part_sign, primes, subscript,
    superscript,
};
use super::number::{Number, fraction};
use super::tree::{Span, Tight};
use crate::formula::{Error, MAX_NODES};
use std::iter::Peekable;
use std::str::CharIndices;

/// A letter with its marks, subscripts and primes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Atom {
    /// Its canonical name, without a tilde.
    pub name: String,
    /// Whether a tilde stands above.
    pub reversed: bool,
    /// Its place.
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Sign {
    Plus,
    Minus,
    Star,
    Slash,
    /// `^`: a wedge or a power.
    Caret,
    /// Another tight product.
    Tight(Tight),
    Tilde,
    Dagger,
    Equals,
    Comma,
    Underscore,
    Prime,
    /// `(`, `[` or `{`.
    Open(char),
    /// The bracket that closes this one.
    Close(char),
    OpenAngle,
    CloseAngle,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Lexeme {
    Number(Number),
    /// Letters without a space between them.
    Word(Vec<Atom>),
    /// A raised number.
    Superscript(i32),
    /// A lowered number that does not belong to a letter.
    Subscript(Number),
    Sign(Sign),
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token {
    pub lexeme: Lexeme,
    pub span: Span,
    /// Whether a space stands before it.
    pub space: bool,
}

/// Cuts a text into tokens; each letter counts.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token>, Error> {
    let mut lexer = Lexer { text, chars: text.char_indices().peekable() };
    let mut tokens: Vec<Token> = Vec::new();
    let mut count = 0;
    while let Some(token) = lexer.token()? {
        count += if let Lexeme::Word(atoms) = &token.lexeme { atoms.len() } else { 1 };
        if count > MAX_NODES {
            return Err(too_long(token.span));
        }
        tokens.push(token);
    }
    Ok(tokens)
}

fn too_long(span: Span) -> Error {
    Error::new(
        span,
        format!("the formula has more than {MAX_NODES} names, numbers and signs; define its parts first"),
    )
}

struct Lexer<'t> {
    text: &'t str,
    chars: Peekable<CharIndices<'t>>,
}

impl Lexer<'_> {
    fn peek(&mut self) -> Option<char> {
        self.chars.peek().map(|&(_, c)| folded(c))
    }

    /// The character after the next one.
    fn second(&self) -> Option<char> {
        let mut ahead = self.chars.clone();
        ahead.next();
        ahead.next().map(|(_, c)| folded(c))
    }

    /// The place of the next character.
    fn at(&mut self) -> usize {
        self.chars.peek().map_or(self.text.len(), |&(at, _)| at)
    }

    fn since(&mut self, start: usize) -> Span {
        Span { start, end: self.at() }
    }

    fn eat(&mut self, wanted: impl Fn(char) -> bool) -> bool {
        let found = self.peek().is_some_and(wanted);
        if found {
            self.chars.next();
        }
        found
    }

    /// The next characters as long as they are wanted.
    fn run(&mut self, wanted: impl Fn(char) -> Option<char>) -> String {
        let mut run = String::new();
        while let Some(c) = self.peek().and_then(&wanted) {
            self.chars.next();
            run.push(c);
        }
        run
    }

    fn token(&mut self) -> Result<Option<Token>, Error> {
        let before = self.at();
        while self.eat(is_space) {}
        let start = self.at();
        let Some(c) = self.peek() else { return Ok(None) };
        let lexeme = if c.is_ascii_digit() || c == '.' && self.second().is_some_and(|d| d.is_ascii_digit()) {
            self.number()?
        } else if let Some(number) = fraction(c) {
            self.chars.next();
            Lexeme::Number(number)
        } else if is_letter(c) {
            Lexeme::Word(self.word()?)
        } else if superscript(c).is_some() {
            self.superscript()?
        } else if subscript(c).is_some_and(|d| d.is_ascii_digit()) {
            let digits = self.run(|c| subscript(c).filter(char::is_ascii_digit));
            Lexeme::Subscript(self.read(&digits, start)?)
        } else {
            self.sign(c)?
        };
        Ok(Some(Token { lexeme, span: self.since(start), space: before < start }))
    }

    fn read(&mut self, digits: &str, start: usize) -> Result<Number, Error> {
        let span = self.since(start);
        Number::decimal(digits)
            .ok_or_else(|| Error::new(span, "the number is beyond the range of floating point (1.8e308)"))
    }

    /// Digits with a point; an exponent with a sign, or after a capital E: `2e1` is 2 times `e1`.
    fn number(&mut self) -> Result<Lexeme, Error> {
        let start = self.at();
        let digit = |c: char| Some(c).filter(char::is_ascii_digit);
        let mut digits = self.run(digit);
        if self.eat(|c| c == '.') {
            digits.push('.');
            digits += &self.run(digit);
        }
        let mut ahead = self.chars.clone().map(|(_, c)| folded(c));
        let (e, next, after) = (ahead.next(), ahead.next(), ahead.next());
        let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let signed = matches!(next, Some('+' | '-' | '−')) && is_digit(after);
        if matches!(e, Some('e' | 'E')) && signed || e == Some('E') && is_digit(next) {
            self.chars.next();
            digits.push('e');
            if signed {
                self.chars.next();
                digits.push(if next == Some('+') { '+' } else { '-' });
            }
            digits += &self.run(digit);
        }
        Ok(Lexeme::Number(self.read(&digits, start)?))
    }

    fn superscript(&mut self) -> Result<Lexeme, Error> {
        let start = self.at();
        let digits = self.run(superscript);
        let power = digits.parse().map_err(|_| {
            let span = self.since(start);
            Error::new(span, "a power must be a whole number of at most nine digits, such as ² or ⁻¹")
        })?;
        Ok(Lexeme::Superscript(power))
    }

    fn word(&mut self) -> Result<Vec<Atom>, Error> {
        let mut atoms = Vec::new();
        while self.peek().is_some_and(is_letter) {
            if atoms.len() > MAX_NODES {
                let at = self.at();
                return Err(too_long(self.since(at)));
            }
            atoms.push(self.atom()?);
        }
        Ok(atoms)
    }

    fn atom(&mut self) -> Result<Atom, Error> {
        let start = self.at();
        let mut name = String::new();
        let mut reversed = false;
        if let Some(c) = self.peek() {
            self.chars.next();
            reversed = below_tilde(c).is_some();
            name.push(below_tilde(c).unwrap_or(c));
        }
        let mut below = String::new();
        let mut prime_count = 0;
        while let Some(c) = self.peek() {
            if c == TILDE {
                self.chars.next();
                reversed = !reversed;
            } else if is_mark(c) {
                self.chars.next();
                match name.chars().next().and_then(|letter| composed(letter, c)) {
                    Some(both) if name.chars().nth(1).is_none() => name = both.into(),
                    _ => name.push(c),
                }
            } else if primes(c) > 0 {
                self.chars.next();
                prime_count += primes(c);
            } else if !self.below(c, &mut below)? {
                break;
            }
        }
        name += &below;
        name.extend(std::iter::repeat_n('\'', prime_count));
        Ok(Atom { name, reversed, span: self.since(start) })
    }

    /// Reads a subscript, if one follows, in canonical form: `1` for `_1` and `₁`, otherwise `_B`.
    fn below(&mut self, c: char, below: &mut String) -> Result<bool, Error> {
        let start = self.at();
        let piece = if let Some(sign) = part_sign(c) {
            self.chars.next();
            below.push(sign);
            return Ok(true);
        } else if c.is_ascii_digit() {
            self.run(|c| Some(c).filter(char::is_ascii_digit))
        } else if subscript(c).is_some() {
            self.run(subscript)
        } else if c == '_' {
            self.chars.next();
            if let Some(sign) = self.peek().and_then(part_sign) {
                self.chars.next();
                below.push(sign);
                return Ok(true);
            }
            let in_braces = self.eat(|c| c == '{');
            let piece = self.run(|c| Some(c).filter(|&c| c.is_ascii_digit() || is_letter(c)));
            if piece.is_empty() || in_braces && !self.eat(|c| c == '}') {
                let span = self.since(start);
                return Err(Error::new(
                    span,
                    "a subscript must be letters and digits, such as `Ω_B` or `e_12`",
                ));
            }
            piece
        } else {
            return Ok(false);
        };
        if !(below.is_empty() && piece.bytes().all(|b| b.is_ascii_digit())) {
            below.push('_');
        }
        below.push_str(&piece);
        Ok(true)
    }

    fn sign(&mut self, c: char) -> Result<Lexeme, Error> {
        let start = self.at();
        let sign = match c {
            '+' => Sign::Plus,
            '-' | '−' | '–' => Sign::Minus,
            '*' | '∗' => Sign::Star,
            '/' => Sign::Slash,
            '^' => Sign::Caret,
            '∧' | '⋀' => Sign::Tight(Tight::Wedge),
            '·' | '⋅' | '∙' | '•' | '|' => Sign::Tight(Tight::Dot),
            '×' => Sign::Tight(Tight::Commutator),
            '⨯' => Sign::Tight(Tight::Cross),
            '⌋' => Sign::Tight(Tight::LeftContraction),
            '⌊' => Sign::Tight(Tight::RightContraction),
            '~' | '∼' | '˜' => Sign::Tilde,
            '†' => Sign::Dagger,
            '=' => Sign::Equals,
            ',' => Sign::Comma,
            '_' => Sign::Underscore,
            '(' | '[' | '{' => Sign::Open(c),
            ')' => Sign::Close('('),
            ']' => Sign::Close('['),
            '}' => Sign::Close('{'),
            '<' | '⟨' | '〈' => Sign::OpenAngle,
            '>' | '⟩' | '〉' => Sign::CloseAngle,
            _ if primes(c) > 0 => Sign::Prime,
            _ => {
                self.chars.next();
                return Err(Error::new(self.since(start), no_meaning(c)));
            }
        };
        self.chars.next();
        if sign == Sign::Equals {
            self.eat(|c| c == '=');
        }
        if sign == Sign::Star && self.peek() == Some('*') {
            self.chars.next();
            return Err(Error::new(self.since(start), "write a power as `A^2` or `A²`"));
        }
        Ok(Lexeme::Sign(sign))
    }
}

/// The error for a character outside the language.
fn no_meaning(c: char) -> String {
    let remedy = match c {
        '\\' | '$' => "; write plain text, `θ/2 e1∧e2`, not LaTeX",
        '.' => "; write a product as `a b`, `a·b` or `a∧b`",
        '"' | '`' => "; write names without quotes",
        '∨' => "; join and meet are methods in Python",
        '÷' | ':' => "; divide with `/`",
        '↦' | '→' | '⇒' | ';' => "; write one formula or equation at a time",
        '∫' => "; there are sums (Σ) but no integrals",
        _ => "",
    };
    let shown = if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    format!("`{shown}` has no meaning in a formula{remedy}")
}

/// The canonical spelling of a name, such as `Ω_B`, `a1` for `a_1` and `a₁`, or `R(0)`; `None` for anything else.
pub fn canonical(name: &str) -> Option<String> {
    let tokens = tokens(name).ok()?;
    let word = |token: &Token| match &token.lexeme {
        Lexeme::Word(atoms) => joined(atoms),
        _ => None,
    };
    match &tokens[..] {
        [name] => word(name),
        [name, open, argument, close] => {
            let brackets = open.lexeme == Lexeme::Sign(Sign::Open('('))
                && close.lexeme == Lexeme::Sign(Sign::Close('('));
            let argument = match &argument.lexeme {
                Lexeme::Number(n) => n.to_string(),
                _ => word(argument)?,
            };
            brackets.then_some(format!("{}({argument})", word(name)?))
        }
        _ => None,
    }
}

/// The canonical name of letters that form one name; `None` if one of them is reversed.
pub(crate) fn joined(atoms: &[Atom]) -> Option<String> {
    (!atoms.iter().any(|atom| atom.reversed)).then(|| atoms.iter().map(|atom| atom.name.as_str()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_canonical() {
        let cases = [
            ("a₁", "a1"),
            ("a_1", "a1"),
            ("e_{12}", "e12"),
            ("Ω_B", "Ω_B"),
            ("fₖ'", "f_k'"),
            ("f′_k", "f_k'"),
            ("a∥", "a∥"),
            ("a_⊥", "a⊥"),
            ("omega_body", "omega_body"),
            ("x_0", "x0"),
            ("𝑅", "R"),
            ("R(0)", "R(0)"),
            ("R( t )", "R(t)"),
            ("n̂", "n\u{302}"),
            ("x\u{307}", "ẋ"),
        ];
        for (name, expected) in cases {
            assert_eq!(canonical(name).as_deref(), Some(expected), "{name}");
        }
        for name in ["", "1", "a b", "R̃", "a+b", "a^2", "f(a, b)", "a_"] {
            assert_eq!(canonical(name), None, "{name}");
        }
    }

    #[test]
    fn numbers_end_where_basis_vectors_begin() {
        let kinds = |text: &str| -> Vec<String> {
            let show = |t: Token| match t.lexeme {
                Lexeme::Number(n) => n.to_string(),
                Lexeme::Word(atoms) => joined(&atoms).unwrap(),
                other => format!("{other:?}"),
            };
            tokens(text).unwrap().into_iter().map(show).collect()
        };
        assert_eq!(kinds("2e1"), ["2", "e1"]);
        assert_eq!(kinds("2e-1"), ["0.2"]);
        assert_eq!(kinds("2E1 x"), ["20", "x"]);
        assert_eq!(kinds(".5e12"), ["0.5", "e12"]);
        assert_eq!(kinds("½ΩR"), ["0.5", "ΩR"]);
    }
}
