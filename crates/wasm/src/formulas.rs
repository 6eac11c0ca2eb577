//! Lines of formulas, for the page of algebra: `polhode._formula.shell.session` in the browser.
//!
//! `a = 2 e1 + e2` gives a name a value, in which numbers may have units; `V(x) = ½ x·x` defines a function; `lhs = rhs`
//! of anything else, or `lhs == rhs`, asks whether an equation holds; all other lines are formulas. `#` begins a comment.

mod session;
mod value;

use serde_json::{Value, json};
use session::{Outcome, Session, Wrong};
use value::valued;

/// What each line came to, with the names that earlier ones gave values: JSON of `Line[]` of the page's core.
pub fn evaluated(text: &str) -> String {
    let mut session = Session::default();
    let lines = text.split('\n').enumerate();
    lines.map(|(i, line)| answered(&mut session, i + 1, line)).collect::<Value>().to_string()
}

fn answered(session: &mut Session, number: usize, line: &str) -> Value {
    let written = line.split('#').next().unwrap_or_default();
    let (outcome, problem) = match session.run(number, written) {
        Ok(outcome) => (outcome, Value::Null),
        Err((name, wrong)) => (Outcome { name, ..Outcome::default() }, problem(line, &wrong)),
    };
    let equation = outcome
        .agreement
        .map(|found| json!({ "holds": found.holds(), "residual": found.residual, "size": found.size }));
    json!({
        "text": line,
        "name": outcome.name,
        "shown": outcome.shown,
        "latex": outcome.latex,
        "value": outcome.value.map(|(value, ty)| valued(&value, ty)),
        "equation": equation,
        "problem": problem,
    })
}

fn problem(line: &str, wrong: &Wrong) -> Value {
    json!({
        "message": wrong.message,
        "start": units_before(line, wrong.span.start),
        "end": units_before(line, wrong.span.end.max(wrong.span.start)),
    })
}

/// The number of UTF-16 units before a place in bytes.
fn units_before(line: &str, at: usize) -> usize {
    let before = line.char_indices().take_while(|(i, _)| *i < at);
    before.map(|(_, c)| c.len_utf16()).sum()
}

#[cfg(test)]
mod tests;
