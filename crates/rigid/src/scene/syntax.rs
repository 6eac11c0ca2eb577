//! Remedies for the commonest slips in TOML, added to the messages of the parser.

use std::ops::Range;

/// The message of the parser for the text at the span, and what to write.
pub(super) fn explained(message: &str, text: &str, span: Range<usize>) -> String {
    let token = text.get(span).unwrap_or("").trim();
    let quoted = format!("write `\"{token}\"`");
    let remedy = if message.starts_with("string values must be quoted") {
        let parts: Vec<&str> = token.split_whitespace().collect();
        let are_numbers = parts.iter().all(|part| part.parse::<f64>().is_ok());
        if are_numbers && parts.len() > 1 {
            format!("separate the numbers by commas, `{}`", parts.join(", "))
        } else if token.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
            format!("{quoted}, because a value with a unit needs quotes")
        } else {
            quoted
        }
    } else if message.starts_with("invalid boolean") {
        quoted
    } else if message.starts_with("missing escaped value") {
        "write a path with `/`, or in single quotes".to_owned()
    } else if message == "duplicate key" {
        return format!("{message} `{token}`, which this table has already");
    } else {
        return message.to_owned();
    };
    format!("{message}; {remedy}")
}
