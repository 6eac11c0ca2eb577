//! Names with indices, as in `ω_k I e_k` and `f_k = R e_k ~R`.

use super::names::Names;
use super::tree::{Kind, Node};
use crate::formula::Error;

/// The letters that, as subscripts, run from 1 to the number of generators.
pub(crate) const INDICES: &str = "ijklmn";

/// The base and the indices of a name with indices: `ω_k`, `ε_ijk`.
pub(crate) fn indexed(name: &str) -> Option<(&str, &str)> {
    let plain = name.trim_end_matches('\'');
    let (base, indices) = plain.split_once('_')?;
    let some = !indices.is_empty() && indices.len() <= 3 && indices.chars().all(|c| INDICES.contains(c));
    (some && !base.is_empty()).then_some((base, indices))
}

/// The name of the first value of a name with indices: `ω1` for `ω_k`.
pub(crate) fn first_of(name: &str) -> Option<String> {
    let (base, indices) = indexed(name)?;
    Some(format!("{base}{}{}", "1".repeat(indices.len()), &name[base.len() + 1 + indices.len()..]))
}

/// Whether a name with indices is built in: `e_k`, `δ_ij`, `ε_ijk`.
pub(crate) fn is_built_in(name: &str) -> bool {
    let constant =
        |(base, indices): (&str, &str)| matches!((base, indices.len()), ("e", 1) | ("δ", 2) | ("ε", 3));
    !name.ends_with('\'') && indexed(name).is_some_and(constant)
}

/// Sums over repeated indices, as on paper: an index that occurs at least twice in every term that has it is
/// summed over in each, `ε_ijk e_k`; one that occurs once in some term is free, `L_k = i_k ω_k`.
pub(crate) fn sum_repeated(mut sides: Vec<Node>, names: &Names) -> Result<Vec<Node>, Error> {
    if names.is_open() {
        return Ok(sides);
    }
    fn terms_of(side: &mut Node) -> Vec<&mut Node> {
        if matches!(side.kind, Kind::Sum(_)) { side.children_mut() } else { vec![side] }
    }
    let mut terms: Vec<&mut Node> = sides.iter_mut().flat_map(terms_of).collect();
    let counts: Vec<Vec<(char, usize)>> = terms.iter().map(|term| indices_in(term, names)).collect();
    let free = |index: char| counts.iter().flatten().any(|&(c, count)| c == index && count == 1);
    for (term, found) in terms.iter_mut().zip(&counts) {
        let mut repeated = found.iter().filter(|&&(index, _)| !free(index));
        repeated.try_for_each(|&(index, _)| sum_over(index, term, names))?;
    }
    Ok(sides)
}

/// Puts the sum around the smallest part that contains every occurrence of the index, in each term separately:
/// `(a_k b_k + 1)²` is `(Σ_k a_k b_k + 1)²`.
fn sum_over(index: char, node: &mut Node, names: &Names) -> Result<(), Error> {
    let count =
        |node: &Node| indices_in(node, names).iter().find(|(c, _)| *c == index).map_or(0, |(_, n)| *n);
    if let Kind::Sum(terms) = &mut node.kind {
        let mut with = terms.iter_mut().filter(|(_, term)| count(term) > 0);
        return with.try_for_each(|(_, term)| sum_over(index, term, names));
    }
    let counts: Vec<usize> = node.children().into_iter().map(count).collect();
    let with: Vec<usize> = (0..counts.len()).filter(|&i| counts[i] > 0).collect();
    if let [child] = with[..] {
        return sum_over(index, node.children_mut().swap_remove(child), names);
    }
    if counts.iter().any(|&n| n > 1) {
        let message = format!(
            "the index {index} occurs {} times, so the sum is ambiguous; write `Σ_{index}`, or \
             another index in one pair",
            counts.iter().sum::<usize>()
        );
        return Err(Error::new(node.span, message));
    }
    let inner = std::mem::replace(&mut node.kind, Kind::Pi);
    node.kind = Kind::Total(index.to_string(), Box::new(Node::new(inner, node.span)));
    Ok(())
}

/// The free indices in the unbound names of a tree, the first first, and how often each occurs. A sum binds its own.
pub(crate) fn indices_in(node: &Node, names: &Names) -> Vec<(char, usize)> {
    let all: Vec<(char, usize)> = match &node.kind {
        Kind::Name(name) if names.get(name).is_none() => {
            indexed(name).map_or_else(Vec::new, |(_, indices)| indices.chars().map(|c| (c, 1)).collect())
        }
        _ => node.children().into_iter().flat_map(|child| indices_in(child, names)).collect(),
    };
    let mut found: Vec<(char, usize)> = Vec::new();
    for (index, count) in all {
        match found.iter_mut().find(|(c, _)| *c == index) {
            None => found.push((index, count)),
            // Terms of a sum count separately: an index is repeated if it is in every term that has it.
            Some((_, least)) if matches!(node.kind, Kind::Sum(_)) => *least = count.min(*least),
            Some((_, total)) => *total += count,
        }
    }
    if let Kind::Total(index, _) = &node.kind {
        found.retain(|(c, _)| !index.contains(*c));
    }
    found
}

/// The sign of a permutation of 1, 2, 3; 0 for anything else.
pub(crate) fn permutation([i, j, k]: [usize; 3]) -> i32 {
    match (i, j, k) {
        (1, 2, 3) | (2, 3, 1) | (3, 1, 2) => 1,
        (3, 2, 1) | (2, 1, 3) | (1, 3, 2) => -1,
        _ => 0,
    }
}
