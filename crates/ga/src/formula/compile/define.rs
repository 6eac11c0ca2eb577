//! Definitions of functions and values by formulas.

use crate::formula::syntax::letters::is_space;
use crate::formula::syntax::names::{Definition, Meaning, Names, Type};
use crate::formula::syntax::parser::parse;
use crate::formula::syntax::token::{Item, Token, canonical, joined, tokens};
use crate::formula::syntax::tree::{Kind, Node, Span};
use crate::formula::{Error, Space};
use crate::product::Grades;
use std::collections::BTreeSet;

/// Defines a function, `V(x)`, or a value, `c`, by a formula.
///
/// # Errors
/// If the head is not a name with parameters, the body is not a formula in them, or the function calls itself.
pub fn define(head: &str, body: &str, space: Space, names: &mut Names) -> Result<(), Error> {
    let (name, parameters) = heading(head)?;
    let any = Meaning::Value(Type::of(Grades::ALL));
    let hidden: Vec<_> = parameters.iter().map(|name| names.bind(name.clone(), any.clone())).collect();
    let tree = parse(body, space, names);
    for (name, meaning) in parameters.iter().zip(hidden) {
        names.restore(name, meaning);
    }
    let tree =
        tree.map_err(|error| if is_about(&error, body, &name) { recursive(&error, &name) } else { error })?;
    let whole = Span { start: 0, end: body.len() };
    let [body] = <[Node; 1]>::try_from(tree.sides).map_err(|_| {
        Error::new(whole, format!("`{head}` cannot be defined by an equation; write one side only"))
    })?;
    if calls(&body, &name, &parameters, names) {
        return Err(Error::new(whole, format!("`{name}` would call itself; formulas have no recursion")));
    }
    names.bind(name, Meaning::Function(Definition { parameters, body }));
    Ok(())
}

/// The canonical name and parameters of `c` or `V(x, y)`.
///
/// # Errors
/// If it is anything else.
pub fn heading(head: &str) -> Result<(String, Vec<String>), Error> {
    tokens(head)?;
    let valid = |(_, parameters): &(_, Vec<String>)| {
        let repeated = (1..parameters.len()).any(|i| parameters[..i].contains(&parameters[i]));
        !repeated && !parameters.iter().any(|parameter| parameter.contains('('))
    };
    named(head).filter(valid).ok_or_else(|| {
        let whole = Span { start: 0, end: head.len() };
        Error::new(whole, "expected a name, `c`, or a function of distinct names, `V(x)`")
    })
}

/// The same, where parameters may also be labelled or repeated.
pub(crate) fn named(head: &str) -> Option<(String, Vec<String>)> {
    let Some(call) = head.trim_end_matches(is_space).strip_suffix(')') else {
        return Some((canonical(head)?, Vec::new()));
    };
    let (name, parameters) = call.split_once('(')?;
    Some((canonical(name)?, parameters.split(',').map(canonical).collect::<Option<_>>()?))
}

/// Whether an error is that this name has no value.
fn is_about(error: &Error, text: &str, name: &str) -> bool {
    let word = text.get(error.span.start..error.span.end).and_then(|word| tokens(word).ok());
    let holds = |token: &Token| match &token.item {
        Item::Word(atoms) => {
            joined(atoms).is_some_and(|word| word == name) || atoms.iter().any(|a| a.name == name)
        }
        _ => false,
    };
    error.message.contains("has no value") && word.is_some_and(|word| word.iter().any(holds))
}

fn recursive(error: &Error, name: &str) -> Error {
    Error::new(error.span, format!("`{name}` has no value in its own definition; formulas have no recursion"))
}

/// Whether a body calls a function, itself or through others.
fn calls(body: &Node, name: &str, parameters: &[String], names: &Names) -> bool {
    let mut waiting = called(body, parameters);
    let mut seen = BTreeSet::new();
    while let Some(other) = waiting.pop() {
        let Some(Meaning::Function(definition)) = names.get(&other) else { continue };
        if other == name {
            return true;
        }
        if seen.insert(other) {
            waiting.extend(called(&definition.body, &definition.parameters));
        }
    }
    false
}

/// The names in a body other than parameters.
fn called(body: &Node, parameters: &[String]) -> Vec<String> {
    let mut called = Vec::new();
    body.visit(&mut |node| {
        if let Kind::Call(other, _) | Kind::Name(other) = &node.kind
            && !parameters.contains(other)
        {
            called.push(other.clone());
        }
    });
    called
}
