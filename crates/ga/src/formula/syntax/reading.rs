//! Reader of words: one name, a function, or adjacent letters, depending on the names that are bound.

mod unknown;

use super::indices::{INDICES, first_of, is_built_in};
use super::names::{Meaning, Names};
use super::token::{Atom, Item, Token, joined, labelled, tokens};
use super::tree::{Named, Span, Tight};
use crate::formula::{Error, Space};

/// Replaces all words of a formula by their meanings.
pub(crate) fn read(text: &str, space: Space, names: &Names) -> Result<Vec<Token>, Error> {
    let tokens = &tokens(text)?[..];
    let reader = Reader { text, space, names, labels: names.iter().any(|name| name.contains('(')) };
    let mut items = Vec::with_capacity(tokens.len());
    let mut rest = tokens;
    while let Some((token, after)) = rest.split_first() {
        rest = after;
        if let Item::Word(atoms) = &token.item {
            if let Some((name, end)) = reader.labelled(atoms, rest) {
                items.push(Token { item: Item::Name(name), span: token.span.to(end), ..*token });
                rest = &rest[3..];
            } else {
                reader.word(atoms, token, rest.first(), &mut items)?;
            }
        } else {
            items.push(token.clone());
        }
    }
    Ok(items)
}

struct Reader<'a> {
    text: &'a str,
    space: Space<'a>,
    names: &'a Names,
    labels: bool,
}

impl Reader<'_> {
    /// A name with an argument as its label, `R(0)`, and the place of its end.
    fn labelled(&self, atoms: &[Atom], rest: &[Token]) -> Option<(String, Span)> {
        // With open names `R(0)`, `V(x)` and `I(B)` may mean anything, so they stay one name.
        let unknown = match atoms {
            [atom] => self.names.is_open() && !matches!(&atom.name[..], "e" | "π" | "Σ"),
            _ => false,
        };
        if !(self.labels || unknown) || rest.first().is_some_and(|open| open.space) {
            return None;
        }
        let name = labelled(atoms, rest)?;
        let apart = matches!(&rest[1].item, Item::Word(label) if joined(label).is_some_and(|name| merges(&name, label)));
        (unknown && !apart || self.names.get(&name).is_some()).then_some((name, rest[2].span))
    }

    fn word(
        &self,
        atoms: &[Atom],
        token: &Token,
        next: Option<&Token>,
        items: &mut Vec<Token>,
    ) -> Result<(), Error> {
        let next = next.filter(|next| next.item == Item::Open('('));
        if let Some(item) = self.one_name(atoms, token.span, next) {
            items.push(Token { item: item?, ..*token });
            return Ok(());
        }
        for (i, atom) in atoms.iter().enumerate() {
            let item = self.atom(atom, next.is_some() && i + 1 == atoms.len());
            let item = item.ok_or_else(|| self.unknown(token, atoms, next.is_some(), items))??;
            let space = token.space && i == 0;
            items.push(Token { item, reversed: atom.reversed, span: atom.span, space });
        }
        Ok(())
    }

    /// What several letters are as one name, before this opening bracket if any; `None` if they are read one by one.
    fn one_name(&self, atoms: &[Atom], span: Span, open: Option<&Token>) -> Option<Result<Item, Error>> {
        let name = joined(atoms).filter(|_| atoms.len() > 1)?;
        let bound = self.bound(&name, span, open.is_some());
        bound.or_else(|| {
            let built_in = self.built_in_word(&name, open.is_some());
            let item = built_in.or_else(|| self.run_together(atoms).map(Item::Name));
            let letters_alone = || atoms.iter().all(|atom| self.built_in_atom(&atom.name).is_some());
            Some(Ok(match item {
                Some(item) => item,
                None if !self.names.is_open() || letters_alone() || merges(&name, atoms) => return None,
                None if open.is_some_and(|open| !open.space) => Item::Callable(name, usize::MAX),
                None => Item::Name(name),
            }))
        })
    }

    /// What one letter is; `None` if nothing.
    fn atom(&self, atom: &Atom, called: bool) -> Option<Result<Item, Error>> {
        if let Some(item) = self.bound(&atom.name, atom.span, called) {
            return Some(item);
        }
        if let Some(item) = self.built_in_atom(&atom.name) {
            return Some(Ok(item));
        }
        if let Some(problem) = generators(&atom.name).and_then(|generators| self.no_blade(&generators)) {
            let power = format!("{}e+{}", self.digits_before(atom), atom.name.trim_start_matches('e'));
            let message = if power.parse::<f64>().is_ok_and(f64::is_finite) {
                format!("`{}` {problem}. Write a power of ten as `{power}`", atom.name)
            } else {
                let what = "is not a basis element, and as a power of ten beyond the range of floating point";
                format!("`{}` {what} (1.8e308)", atom.name)
            };
            return Some(Err(Error::new(atom.span, message)));
        }
        let is_index = self.is_indexed(&atom.name);
        (is_index || self.names.is_open()).then(|| Ok(Item::Name(atom.name.clone())))
    }

    /// The number to which a letter is joined; 1 without any, or if its digits belong to a name.
    fn digits_before(&self, atom: &Atom) -> &str {
        let before = &self.text[..atom.span.start];
        let name = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
        let digits = &before[name.len()..];
        let is_index = name.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        if is_index || digits.parse::<f64>().is_err() { "1" } else { digits }
    }

    /// The item of a bound name.
    fn bound(&self, name: &str, span: Span, called: bool) -> Option<Result<Item, Error>> {
        let item = match self.names.get(name)? {
            Meaning::Value(_) => Item::Name(name.to_owned()),
            Meaning::Map { .. } if called => Item::Callable(name.to_owned(), 1),
            // The handout writes I for the inertia and for the pseudoscalar; only one of them is called. So it is with a
            // definition of I(B).
            Meaning::Map { .. } if name == "I" => Item::Pseudoscalar,
            Meaning::Map { .. } => {
                let message = format!("`{name}` is a linear map; write its argument, `{name}(…)`");
                return Some(Err(Error::new(span, message)));
            }
            Meaning::Function(definition) => match definition.parameters.len() {
                0 => Item::Callable(name.to_owned(), 0),
                count if called => Item::Callable(name.to_owned(), count),
                _ if name == "I" => Item::Pseudoscalar,
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
        if let Some(total) = total(name, "sum_") {
            return Some(total);
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
            _ => total(name, "Σ_").or_else(|| {
                let generators = generators(name)?;
                self.no_blade(&generators).is_none().then_some(Item::Blade(generators))
            }),
        }
    }

    /// `e_k` or `ε_ijk` written as `ek` or `εijk`, if some of these letters have no meaning of their own.
    fn run_together(&self, atoms: &[Atom]) -> Option<String> {
        let (base, indices) = atoms.split_first()?;
        let name = format!("{}_{}", base.name, joined(indices)?);
        (self.is_indexed(&name) && atoms.iter().any(|atom| self.atom(atom, false).is_none())).then_some(name)
    }

    /// Whether an unbound name stands for several, one for each value of its indices.
    fn is_indexed(&self, name: &str) -> bool {
        is_built_in(name) || first_of(name).is_some_and(|first| self.names.get(&first).is_some())
    }

    /// Why these generators are not a basis element.
    fn no_blade(&self, generators: &[u8]) -> Option<String> {
        let names = self.space.algebra.numbers();
        if let Some(i) = (1..generators.len()).find(|&i| generators[..i].contains(&generators[i])) {
            return Some(format!(
                "contains e{} twice; the vectors of a blade must be distinct",
                generators[i]
            ));
        }
        let fits = generators.iter().all(|&g| names.contains(&usize::from(g)));
        (!fits).then(|| {
            let (first, end) = (names.start, names.end);
            format!("is not a basis element; the basis vectors are e{first} to e{}", end.saturating_sub(1))
        })
    }
}

/// Whether letters written together are fewer in the canonical spelling: `ωₖe` is not `ω_ke`.
fn merges(name: &str, atoms: &[Atom]) -> bool {
    let same = |token: &Token| matches!(&token.item, Item::Word(again) if again.len() == atoms.len());
    !tokens(name).is_ok_and(|tokens| tokens.first().is_some_and(same))
}

/// `Σ_k` after this spelling of the sign.
fn total(name: &str, sign: &str) -> Option<Item> {
    let index = name.strip_prefix(sign).filter(|i| i.len() == 1 && INDICES.contains(i))?;
    Some(Item::Total(Some(index.to_owned())))
}

/// The generators of `e12`; `None` for other names.
fn generators(name: &str) -> Option<Vec<u8>> {
    let digits = name.strip_prefix('e').filter(|digits| !digits.is_empty())?;
    digits.bytes().map(|b| b.is_ascii_digit().then(|| b - b'0')).collect()
}
