//! Reader of words: one name, a function, or adjacent letters, depending on the names that are bound.

use super::indices::{INDICES, indexed, is_built_in};
use super::names::{Meaning, Names};
use super::token::{Atom, Lexeme, Sign, Token, joined};
use super::tree::{Named, Span, Tight};
use crate::diagnostic::{nearest, quote};
use crate::formula::{Error, Number, Space};

/// A word, a number or a sign with its meaning in the formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    Number(Number),
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
    Superscript(i32),
    Subscript(Number),
    Sign(Sign),
}

#[derive(Clone, Debug)]
pub(crate) struct Read {
    pub item: Item,
    /// Whether a tilde stands above the letter.
    pub reversed: bool,
    pub span: Span,
    pub space: bool,
}

/// Reads all words of a formula.
pub(crate) fn read(tokens: &[Token], space: Space, names: &Names) -> Result<Vec<Read>, Error> {
    let reader = Reader { space, names, labels: names.iter().any(|name| name.contains('(')) };
    let mut items = Vec::with_capacity(tokens.len());
    let mut rest = tokens;
    while let Some((token, after)) = rest.split_first() {
        rest = after;
        let lone = |item| Read { item, reversed: false, span: token.span, space: token.space };
        match &token.lexeme {
            Lexeme::Number(n) => items.push(lone(Item::Number(*n))),
            Lexeme::Superscript(n) => items.push(lone(Item::Superscript(*n))),
            Lexeme::Subscript(n) => items.push(lone(Item::Subscript(*n))),
            Lexeme::Sign(sign) => items.push(lone(Item::Sign(sign.clone()))),
            Lexeme::Word(atoms) => {
                if let Some((name, end)) = reader.labelled(atoms, rest) {
                    items.push(Read { span: token.span.to(end), ..lone(Item::Name(name)) });
                    rest = &rest[3..];
                } else {
                    reader.word(atoms, token, rest.first(), &mut items)?;
                }
            }
        }
    }
    Ok(items)
}

struct Reader<'a> {
    space: Space<'a>,
    names: &'a Names,
    labels: bool,
}

impl Reader<'_> {
    /// A name with an argument as its label, `R(0)`, and the place of its end.
    fn labelled(&self, atoms: &[Atom], rest: &[Token]) -> Option<(String, Span)> {
        let [open, argument, close, ..] = rest else { return None };
        // With open names `R(0)`, `V(x)` and `I(B)` may mean anything, so they stay one name.
        let unknown = match atoms {
            [atom] => self.names.is_open() && !matches!(&atom.name[..], "e" | "π" | "Σ"),
            _ => false,
        };
        if !(self.labels || unknown)
            || open.space
            || open.lexeme != Lexeme::Sign(Sign::Open('('))
            || close.lexeme != Lexeme::Sign(Sign::Close('('))
        {
            return None;
        }
        let label = match &argument.lexeme {
            Lexeme::Number(n) => n.to_string(),
            Lexeme::Word(atoms) => joined(atoms)?,
            _ => return None,
        };
        let name = format!("{}({label})", joined(atoms)?);
        (unknown || self.names.get(&name).is_some()).then_some((name, close.span))
    }

    fn word(
        &self,
        atoms: &[Atom],
        token: &Token,
        next: Option<&Token>,
        items: &mut Vec<Read>,
    ) -> Result<(), Error> {
        let called = next.is_some_and(|next| next.lexeme == Lexeme::Sign(Sign::Open('(')));
        let whole = |item, reversed| Read { item, reversed, span: token.span, space: token.space };
        if let [atom] = atoms {
            let item =
                self.atom(atom, called).ok_or_else(|| self.unknown(&atom.name, token.span, None))??;
            items.push(whole(item, atom.reversed));
            return Ok(());
        }
        if let Some(name) = joined(atoms) {
            if let Some(item) = self.bound(&name, token.span, called) {
                items.push(whole(item?, false));
                return Ok(());
            }
            if let Some(item) = self.built_in_word(&name, called) {
                items.push(whole(item, false));
                return Ok(());
            }
            if let Some(name) = self.run_together(atoms) {
                items.push(whole(Item::Name(name), false));
                return Ok(());
            }
            let letters_alone = atoms.iter().all(|atom| self.built_in_atom(&atom.name).is_some());
            if self.names.is_open() && !letters_alone {
                let adjacent = called && next.is_some_and(|next| !next.space);
                let item = if adjacent { Item::Callable(name, usize::MAX) } else { Item::Name(name) };
                items.push(whole(item, false));
                return Ok(());
            }
        }
        for (i, atom) in atoms.iter().enumerate() {
            let item = self.atom(atom, called && i + 1 == atoms.len());
            let item = item.ok_or_else(|| self.unknown(&atom.name, token.span, Some(atoms)))??;
            let space = token.space && i == 0;
            items.push(Read { item, reversed: atom.reversed, span: atom.span, space });
        }
        Ok(())
    }

    /// What one letter is; `None` if nothing.
    fn atom(&self, atom: &Atom, called: bool) -> Option<Result<Item, Error>> {
        if let Some(item) = self.bound(&atom.name, atom.span, called) {
            return Some(item);
        }
        if let Some(item) = self.built_in_atom(&atom.name) {
            return Some(Ok(item));
        }
        if let Some(number) = generators(&atom.name) {
            return Some(Err(self.no_blade(&atom.name, number, atom.span)));
        }
        let is_index = self.is_indexed(&atom.name);
        (is_index || self.names.is_open()).then(|| Ok(Item::Name(atom.name.clone())))
    }

    /// The item of a bound name.
    fn bound(&self, name: &str, span: Span, called: bool) -> Option<Result<Item, Error>> {
        let item = match self.names.get(name)? {
            Meaning::Value(_) => Item::Name(name.to_owned()),
            Meaning::Map { .. } if called => Item::Callable(name.to_owned(), 1),
            // The handout writes I for the inertia and for the pseudoscalar; only one of them is called.
            Meaning::Map { .. } if name == "I" => Item::Pseudoscalar,
            Meaning::Map { .. } => {
                return Some(Err(Error::new(
                    span,
                    format!("`{name}` is a linear map; write its argument, `{name}(…)`"),
                )));
            }
            Meaning::Function(definition) => match definition.parameters.len() {
                0 => Item::Callable(name.to_owned(), 0),
                count if called => Item::Callable(name.to_owned(), count),
                _ => {
                    let parameters = definition.parameters.join(", ");
                    let message = format!("`{name}` is a function; write `{name}({parameters})`");
                    return Some(Err(Error::new(span, message)));
                }
            },
        };
        Some(Ok(item))
    }

    fn built_in_word(&self, name: &str, called: bool) -> Option<Item> {
        if name == "pi" {
            return Some(Item::Pi);
        }
        if let Some(index) = name.strip_prefix("sum_").filter(|i| i.len() == 1 && INDICES.contains(i)) {
            return Some(Item::Total(Some(index.to_owned())));
        }
        let product = Tight::ALL.into_iter().find(|tight| tight.name() == name).map(Item::Product);
        let function = product.or_else(|| Named::from_name(name).map(Item::Function));
        // Without brackets they are letters, if those are bound.
        function
            .filter(|_| called || !name.chars().all(|c| self.names.get(c.encode_utf8(&mut [0; 4])).is_some()))
    }

    fn built_in_atom(&self, name: &str) -> Option<Item> {
        match name {
            "π" => Some(Item::Pi),
            "I" => Some(Item::Pseudoscalar),
            "e" => Some(Item::Euler),
            "Σ" => Some(Item::Total(None)),
            _ => {
                if let Some(index) = name.strip_prefix("Σ_").filter(|i| i.len() == 1 && INDICES.contains(i))
                {
                    return Some(Item::Total(Some(index.to_owned())));
                }
                let generators = generators(name)?;
                let fits = |g: &u8| (1..=self.count()).contains(&usize::from(*g));
                let distinct = (1..generators.len()).all(|i| !generators[..i].contains(&generators[i]));
                (distinct && generators.iter().all(fits)).then_some(Item::Blade(generators))
            }
        }
    }

    fn count(&self) -> usize {
        self.space.algebra.signature().generators()
    }

    /// `e_k` or `ε_ijk` written as `ek` or `εijk`, if some of these letters have no meaning of their own.
    fn run_together(&self, atoms: &[Atom]) -> Option<String> {
        let (base, indices) = atoms.split_first()?;
        let name = format!("{}_{}", base.name, joined(indices)?);
        (self.is_indexed(&name) && atoms.iter().any(|atom| self.atom(atom, false).is_none())).then_some(name)
    }

    /// Whether an unbound name stands for several, one for each value of its indices.
    fn is_indexed(&self, name: &str) -> bool {
        let Some((base, indices)) = indexed(name) else { return false };
        let first = format!("{base}{}{}", "1".repeat(indices.len()), &name[base.len() + 1 + indices.len()..]);
        is_built_in(name) || self.names.get(&first).is_some()
    }

    fn no_blade(&self, name: &str, generators: Vec<u8>, span: Span) -> Error {
        let n = self.count();
        let repeated = (1..generators.len()).find(|&i| generators[..i].contains(&generators[i]));
        let why = match repeated {
            Some(i) => {
                format!("`{name}` contains e{} twice; the vectors of a blade must be distinct", generators[i])
            }
            None => format!("`{name}` is not a basis element; the basis vectors are e1 to e{n}"),
        };
        Error::new(span, format!("{why}. Write a power of ten as `1e+{}`", name.trim_start_matches('e')))
    }

    /// The error for a name without a value; `letters` are those of a word that was also read letter by letter.
    fn unknown(&self, name: &str, span: Span, letters: Option<&[Atom]>) -> Error {
        let word: String =
            letters.map_or(name.to_owned(), |atoms| atoms.iter().map(|a| a.name.as_str()).collect());
        let mut message = format!("{} has no value", quote(&word));
        if let Some(atoms) = letters {
            let missing: Vec<&str> =
                atoms.iter().filter(|a| self.atom(a, false).is_none()).map(|a| &a.name[..]).collect();
            let mut shown: Vec<&str> = missing.iter().take(5).copied().collect();
            shown.dedup();
            let (verb, list) = (if shown.len() == 1 { "has" } else { "have" }, shown.join(", "));
            message += &format!(" as one name; read as adjacent letters, {list} {verb} none");
        }
        let functions = Named::ALL.iter().map(|f| f.name()).chain(Tight::ALL.iter().map(|t| t.name()));
        let known: Vec<&str> = self.names.iter().collect();
        if let Some(near) = nearest(&word, known.iter().copied().chain(functions)) {
            message += &format!("; did you mean `{near}`?");
        } else if known.is_empty() {
            message += "; no names have values here";
        } else {
            let more = if known.len() > 8 { ", …" } else { "" };
            message += &format!("; names with values: {}{more}", known[..known.len().min(8)].join(", "));
        }
        if word == "x" {
            message += ". Write the cross product as `a ⨯ b` or `cross(a, b)`";
        }
        Error::new(span, message)
    }
}

/// The generators of `e12`; `None` for other names.
fn generators(name: &str) -> Option<Vec<u8>> {
    let digits = name.strip_prefix('e').filter(|digits| !digits.is_empty())?;
    digits.bytes().map(|b| b.is_ascii_digit().then(|| b - b'0')).collect()
}
