//! Formulas line by line as JSON, for the page of algebra. `#` begins a comment.

mod value;

use polhode_ga::formula::Error;
use polhode_ga::formula::session::{Outcome, Session};
use polhode_rigid::units::UNITS;
use serde_json::{Value, json};
use value::valued;

/// Evaluates the lines of one session: JSON of `Line[]` of the page's core.
pub fn evaluated(text: &str) -> String {
    let mut session = Session::new(UNITS);
    let lines = text.split('\n').enumerate();
    lines.map(|(i, line)| evaluated_line(&mut session, i + 1, line)).collect::<Value>().to_string()
}

fn evaluated_line(session: &mut Session, number: usize, line: &str) -> Value {
    let written = line.split('#').next().unwrap_or_default();
    let (outcome, problem) = match session.run(number, written) {
        Ok(outcome) => (outcome, Value::Null),
        Err((name, error)) => (Outcome { name, ..Outcome::default() }, problem(line, &error)),
    };
    let equation = outcome
        .agreement
        .map(|found| json!({ "holds": found.holds(), "residual": found.residual, "size": found.size }));
    json!({
        "text": line,
        "name": outcome.name,
        "shown": outcome.text,
        "latex": outcome.latex,
        "value": outcome.value.map(|(value, ty)| valued(&value, ty)),
        "equation": equation,
        "problem": problem,
    })
}

fn problem(line: &str, error: &Error) -> Value {
    json!({
        "message": error.message,
        "start": units_before(line, error.span.start),
        "end": units_before(line, error.span.end.max(error.span.start)),
    })
}

/// The number of UTF-16 units before a place in bytes.
fn units_before(line: &str, at: usize) -> usize {
    let before = line.char_indices().take_while(|(i, _)| *i < at);
    before.map(|(_, c)| c.len_utf16()).sum()
}

#[cfg(test)]
mod tests;
