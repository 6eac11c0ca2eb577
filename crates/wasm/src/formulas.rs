//! Formulas line by line as JSON, for the page of algebra. `#` begins a comment.

mod value;

use crate::json::Json;
use polhode_ga::formula::Error;
use polhode_ga::formula::session::{Outcome, Session};
use polhode_rigid::units::UNITS;
use value::valued;

/// The outcome of each line of one session: JSON of `Line[]` of the page's core.
pub fn evaluated(text: &str) -> String {
    let mut session = Session::new(UNITS);
    let lines = text.split('\n').enumerate();
    Json::List(lines.map(|(i, line)| answered(&mut session, i + 1, line)).collect()).to_string()
}

fn answered(session: &mut Session, number: usize, line: &str) -> Json {
    let written = line.split('#').next().unwrap_or_default();
    let (outcome, problem) = match session.run(number, written) {
        Ok(outcome) => (outcome, Json::Null),
        Err((name, error)) => (Outcome { name, ..Outcome::default() }, problem(line, &error)),
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
        ("shown", Json::or_null(outcome.text)),
        ("latex", Json::or_null(outcome.latex)),
        ("value", outcome.value.map_or(Json::Null, |(value, ty)| valued(&value, ty))),
        ("equation", equation.unwrap_or(Json::Null)),
        ("problem", problem),
    ])
}

fn problem(line: &str, error: &Error) -> Json {
    Json::Object(vec![
        ("message", error.message.as_str().into()),
        ("start", units_before(line, error.span.start).into()),
        ("end", units_before(line, error.span.end.max(error.span.start)).into()),
    ])
}

/// The number of UTF-16 units before a place in bytes.
fn units_before(line: &str, at: usize) -> f64 {
    let before = line.char_indices().take_while(|(i, _)| *i < at);
    before.map(|(_, c)| c.len_utf16()).sum::<usize>() as f64
}

#[cfg(test)]
mod tests;
