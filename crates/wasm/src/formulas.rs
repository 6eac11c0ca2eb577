//! Lines of formulas, for the page of algebra: `polhode._formula.shell.session` in the browser.
//!
//! `a = 2 e1 + e2` gives a name a value, in which numbers may have units; `V(x) = ½ x·x` defines a function; `lhs = rhs`
//! of anything else, or `lhs == rhs`, asks whether an equation holds; all other lines are formulas. `#` begins a comment.

mod session;
mod value;

use crate::json::Json;
use session::{Outcome, Session, Wrong};
use value::valued;

/// What each line came to, with the names that earlier ones gave values: JSON of `Line[]` of the page's core.
pub fn evaluated(text: &str) -> String {
    let mut session = Session::default();
    let lines = text.split('\n').enumerate();
    Json::List(lines.map(|(i, line)| answered(&mut session, i + 1, line)).collect()).to_string()
}

fn answered(session: &mut Session, number: usize, line: &str) -> Json {
    let written = line.split('#').next().unwrap_or_default();
    let (outcome, problem) = match session.run(number, written) {
        Ok(outcome) => (outcome, Json::Null),
        Err((name, wrong)) => (Outcome { name, ..Outcome::default() }, problem(line, &wrong)),
    };
    let equation = outcome.agreement.map(|found| {
        Json::Object(vec![
            ("holds", found.holds().into()),
            ("residual", found.residual.into()),
            ("size", found.size.into()),
        ])
    });
    Json::Object(vec![
        ("text", line.into()),
        ("name", Json::or_null(outcome.name)),
        ("shown", Json::or_null(outcome.shown)),
        ("latex", Json::or_null(outcome.latex)),
        ("value", outcome.value.map_or(Json::Null, |(value, ty)| valued(&value, ty))),
        ("equation", equation.unwrap_or(Json::Null)),
        ("problem", problem),
    ])
}

fn problem(line: &str, wrong: &Wrong) -> Json {
    Json::Object(vec![
        ("message", wrong.message.as_str().into()),
        ("start", units_before(line, wrong.span.start).into()),
        ("end", units_before(line, wrong.span.end.max(wrong.span.start)).into()),
    ])
}

/// How many UTF-16 units stand before a place in bytes.
fn units_before(line: &str, at: usize) -> f64 {
    let before = line.char_indices().take_while(|(i, _)| *i < at);
    before.map(|(_, c)| c.len_utf16()).sum::<usize>() as f64
}

#[cfg(test)]
mod tests;
