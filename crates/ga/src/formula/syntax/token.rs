//! Lexer: cuts text into numbers, words and signs.

mod foreign;

use super::letters::{
    TILDE, below_tilde, composed, folded, is_letter, is_mark, is_space, part_sign, primes, subscript,
    superscript,
};
use super::number::{Number, fraction};
use super::tree::{Named, Span, Tight};
use crate::diagnostic::quote;
use crate::formula::{Error, MAX_NODES};
use foreign::foreign;
use std::str::Chars;

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

/// A number, a word or a sign; then a part of a formula, once the reader has replaced the words by their meanings.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    Number(Number),
    /// Letters without a space between them; the reader leaves none.
    Word(Vec<Atom>),
    /// A raised number.
    Superscript(i32),
    /// A lowered number that does not belong to a letter.
    Subscript(Number),
    Pi,
    /// Generators from 1, in the order written.
    Blade(Vec<u8>),
    /// `I`
    Pseudoscalar,
    /// A value, or a name with indices whose values are not known yet.
    Name(String),
    /// A linear map or a defined function, with its number of parameters.
    Callable(String, usize),
    Function(Named),
    /// A tight product by its name.
    Product(Tight),
    /// The base of an exponential.
    Euler,
    /// `Σ`, and its index where one is written.
    Total(Option<String>),
    Plus,
    Minus,
    Star,
    Slash,
    /// `^`: a wedge or a power.
    Caret,
    /// Another tight product by its sign.
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

#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub item: Item,
    /// Whether a tilde stands above the letter.
    pub reversed: bool,
    pub span: Span,
    /// Whether a space stands before it.
    pub space: bool,
}

/// Cuts a text into tokens; each letter counts.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token>, Error> {
    let mut lexer = Lexer { text, chars: text.chars() };
    let mut tokens: Vec<Token> = Vec::new();
    let mut count = 0;
    while let Some(token) = lexer.token()? {
        count += if let Item::Word(atoms) = &token.item { atoms.len() } else { 1 };
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

fn digit(c: char) -> Option<char> {
    Some(c).filter(char::is_ascii_digit)
}

struct Lexer<'t> {
    text: &'t str,
    chars: Chars<'t>,
}

impl Lexer<'_> {
    /// A character after so many others.
    fn ahead(&self, count: usize) -> Option<char> {
        self.chars.clone().nth(count).map(folded)
    }

    fn peek(&self) -> Option<char> {
        self.ahead(0)
    }

    /// The place of the next character.
    fn at(&self) -> usize {
        self.text.len() - self.chars.as_str().len()
    }

    fn since(&self, start: usize) -> Span {
        Span { start, end: self.at() }
    }

    /// The next character as a function gives it, if it wants it.
    fn take<T>(&mut self, wanted: impl Fn(char) -> Option<T>) -> Option<T> {
        let found = wanted(self.peek()?)?;
        self.chars.next();
        Some(found)
    }

    fn eat(&mut self, wanted: impl Fn(char) -> bool) -> bool {
        self.take(|c| wanted(c).then_some(())).is_some()
    }

    /// The next characters as long as they are wanted.
    fn run(&mut self, wanted: impl Fn(char) -> Option<char>) -> String {
        std::iter::from_fn(|| self.take(&wanted)).collect()
    }

    fn token(&mut self) -> Result<Option<Token>, Error> {
        let before = self.at();
        while self.eat(is_space) {}
        let start = self.at();
        let Some(c) = self.peek() else { return Ok(None) };
        let item = if digit(c).is_some() || c == '.' && self.ahead(1).and_then(digit).is_some() {
            self.number(start)?
        } else if let Some(number) = self.take(fraction) {
            Item::Number(number)
        } else if is_letter(c) {
            Item::Word(self.word()?)
        } else if superscript(c).is_some() {
            let power = self.run(superscript).parse().map_err(|_| {
                let message = "a power must be a whole number of at most nine digits, such as ² or ⁻¹";
                Error::new(self.since(start), message)
            })?;
            Item::Superscript(power)
        } else if subscript(c).and_then(digit).is_some() {
            let digits = self.run(|c| subscript(c).and_then(digit));
            Item::Subscript(self.read(&digits, start)?)
        } else {
            self.sign(c)?
        };
        Ok(Some(Token { item, reversed: false, span: self.since(start), space: before < start }))
    }

    fn read(&self, digits: &str, start: usize) -> Result<Number, Error> {
        let message = "the number is beyond the range of floating point (1.8e308)";
        Number::decimal(digits).ok_or_else(|| Error::new(self.since(start), message))
    }

    /// Digits with a point; an exponent with a sign, or after a capital E: `2e1` is 2 times `e1`.
    fn number(&mut self, start: usize) -> Result<Item, Error> {
        let mut digits = self.run(digit);
        let mut grouped = false;
        while self.begins_group() {
            grouped = true;
            self.chars.next();
            digits += &self.run(digit);
        }
        if self.eat(|c| c == '.') {
            digits.push('.');
            digits += &self.run(digit);
        }
        let [e, next, after] = [0, 1, 2].map(|count| self.ahead(count));
        let signed = matches!(next, Some('+' | '-' | '−')) && after.and_then(digit).is_some();
        if matches!(e, Some('e' | 'E')) && signed || e == Some('E') && next.and_then(digit).is_some() {
            self.chars.next();
            digits.push('e');
            if signed {
                self.chars.next();
                digits.push(if next == Some('+') { '+' } else { '-' });
            }
            digits += &self.run(digit);
        }
        if grouped {
            let message = format!("write a number without signs between its digits, {}", quote(&digits));
            return Err(Error::new(self.since(start), message));
        }
        Ok(Item::Number(self.read(&digits, start)?))
    }

    /// Whether a group of three digits follows, as in `1_000` and `1'000`.
    fn begins_group(&self) -> bool {
        let sign = self.peek().is_some_and(|c| c == '_' || primes(c) == Some(1));
        sign && (1..=3).all(|k| self.ahead(k).and_then(digit).is_some())
    }

    fn word(&mut self) -> Result<Vec<Atom>, Error> {
        let mut atoms = Vec::new();
        while let Some(letter) = self.peek().filter(|&c| is_letter(c)) {
            if atoms.len() > MAX_NODES {
                return Err(too_long(self.since(self.at())));
            }
            atoms.push(self.atom(letter)?);
        }
        Ok(atoms)
    }

    fn atom(&mut self, letter: char) -> Result<Atom, Error> {
        let start = self.at();
        self.chars.next();
        let plain = below_tilde(letter);
        let (mut name, mut reversed) = (String::from(plain.unwrap_or(letter)), plain.is_some());
        let mut below = String::new();
        let mut prime_count = 0;
        loop {
            if self.eat(|c| c == TILDE) {
                reversed = !reversed;
            } else if let Some(mark) = self.take(|c| Some(c).filter(|&c| is_mark(c))) {
                match name.chars().next().and_then(|letter| composed(letter, mark)) {
                    Some(both) if name.chars().nth(1).is_none() => name = both.into(),
                    _ => name.push(mark),
                }
            } else if let Some(count) = self.take(primes) {
                prime_count += count;
            } else if !self.below(&mut below)? {
                break;
            }
        }
        name += &below;
        name.extend(std::iter::repeat_n('\'', prime_count));
        Ok(Atom { name, reversed, span: self.since(start) })
    }

    /// Reads a subscript, if one follows, in canonical form: `1` for `_1` and `₁`, otherwise `_B`.
    fn below(&mut self, below: &mut String) -> Result<bool, Error> {
        let start = self.at();
        let underscore = self.eat(|c| c == '_');
        if let Some(sign) = self.take(part_sign) {
            below.push(sign);
            return Ok(true);
        }
        let piece = if underscore {
            let in_braces = self.eat(|c| c == '{');
            let piece = self.lowered(in_braces);
            if piece.is_empty() || in_braces && !self.eat(|c| c == '}') {
                let message = "a subscript must be letters and digits, such as `Ω_B` or `e_12`";
                return Err(Error::new(self.since(start), message));
            }
            piece
        } else {
            Some(self.run(digit)).filter(|digits| !digits.is_empty()).unwrap_or_else(|| self.run(subscript))
        };
        if piece.is_empty() {
            return Ok(false);
        }
        if !below.is_empty() || !piece.starts_with(|c: char| c.is_ascii_digit()) {
            below.push('_');
        }
        below.push_str(&piece);
        Ok(true)
    }

    /// A subscript after `_`: letters with their marks, and digits. Without braces, one that begins with a digit has no
    /// letters: `e_1e_2` is two names.
    fn lowered(&mut self, in_braces: bool) -> String {
        let mut piece = self.run(digit);
        if !in_braces && !piece.is_empty() {
            return piece;
        }
        loop {
            let last = piece.chars().last().filter(|&c| !c.is_ascii_digit());
            let mark = last.and_then(|_| self.take(|c| Some(c).filter(|&c| is_mark(c) && c != TILDE)));
            let both = last.zip(mark).and_then(|(letter, mark)| composed(letter, mark));
            if both.is_some() {
                piece.pop();
            }
            let next = both
                .or(mark)
                .or_else(|| self.take(|c| Some(c).filter(|&c| digit(c).is_some() || is_letter(c))));
            let Some(c) = next else { return piece };
            piece.push(c);
        }
    }

    fn sign(&mut self, c: char) -> Result<Item, Error> {
        let start = self.at();
        self.chars.next();
        let sign = match c {
            '+' => Item::Plus,
            '-' | '−' | '–' => Item::Minus,
            '*' | '∗' => Item::Star,
            '/' => Item::Slash,
            '^' => Item::Caret,
            '∧' | '⋀' => Item::Tight(Tight::Wedge),
            '·' | '⋅' | '∙' | '•' | '|' => Item::Tight(Tight::Dot),
            '×' => Item::Tight(Tight::Commutator),
            '⨯' => Item::Tight(Tight::Cross),
            '⌋' => Item::Tight(Tight::LeftContraction),
            '⌊' => Item::Tight(Tight::RightContraction),
            '~' | '∼' | '˜' => Item::Tilde,
            '†' => Item::Dagger,
            '=' => Item::Equals,
            ',' => Item::Comma,
            '_' => Item::Underscore,
            '(' | '[' | '{' => Item::Open(c),
            ')' => Item::Close('('),
            ']' => Item::Close('['),
            '}' => Item::Close('{'),
            '<' | '⟨' | '〈' => Item::OpenAngle,
            '>' | '⟩' | '〉' => Item::CloseAngle,
            _ if primes(c).is_some() => Item::Prime,
            _ => {
                let (length, message) = foreign(&self.text[start..]);
                return Err(Error::new(Span { start, end: start + length }, message));
            }
        };
        if sign == Item::Equals {
            self.eat(|c| c == '=');
        }
        if sign == Item::Star && self.eat(|c| c == '*') {
            return Err(Error::new(self.since(start), "write a power as `A^2` or `A²`"));
        }
        Ok(sign)
    }
}

/// The canonical spelling of a name, such as `Ω_B`, `a1` for `a_1` and `a₁`, or `R(0)`; `None` for anything else.
pub fn canonical(name: &str) -> Option<String> {
    let tokens = tokens(name).ok()?;
    let (first, rest) = tokens.split_first()?;
    let Item::Word(atoms) = &first.item else { return None };
    match rest.len() {
        0 => joined(atoms),
        3 => labelled(atoms, rest),
        _ => None,
    }
}

/// The canonical name of letters whose label follows in brackets, `R(0)`.
pub(crate) fn labelled(atoms: &[Atom], rest: &[Token]) -> Option<String> {
    let [open, argument, close, ..] = rest else { return None };
    let label = match &argument.item {
        Item::Number(n) => n.to_string(),
        Item::Word(atoms) => joined(atoms)?,
        _ => return None,
    };
    let brackets = open.item == Item::Open('(') && close.item == Item::Close('(');
    brackets.then_some(format!("{}({label})", joined(atoms)?))
}

/// The canonical name of letters that form one name; `None` if one of them is reversed.
pub(crate) fn joined(atoms: &[Atom]) -> Option<String> {
    let reversed = atoms.iter().any(|atom| atom.reversed);
    (!reversed).then(|| atoms.iter().map(|atom| atom.name.as_str()).collect())
}

#[cfg(test)]
mod tests;
