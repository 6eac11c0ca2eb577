//! Remedies for the commonest slips in TOML, added to the messages of the parser.

use std::ops::Range;

/// The message of the parser for the text at the span, and what to write.
pub(super) fn explained(message: &str, text: &str, span: Range<usize>) -> String {
    let before = text.get(..span.start).unwrap_or("").trim_end();
    let token = text.get(span).unwrap_or("").trim();
    if message == "duplicate key" {
        return format!("{message} `{token}`, which this table has already");
    }
    let is_path =
        message.starts_with("missing escaped value") || message.starts_with("too few unicode value");
    let is_word = message.starts_with("invalid boolean") || message.starts_with("invalid float");
    let remedy = if is_path {
        Some("write a path with `/`, or in single quotes".to_owned())
    } else if message.starts_with("string values must be quoted") {
        remedy_of_value(token, before.ends_with(['[', ',']))
    } else {
        (is_word && !token.contains(|c: char| c.is_ascii_digit())).then(|| quoted(token))
    };
    remedy.map_or_else(|| message.to_owned(), |remedy| format!("{message}; {remedy}"))
}

fn quoted(token: &str) -> String {
    format!("write `\"{token}\"`")
}

/// What to write for text that is not a TOML value; in an array it is not put in brackets.
fn remedy_of_value(token: &str, in_array: bool) -> Option<String> {
    let parts: Vec<&str> = token.split_whitespace().collect();
    let is_number = |part: &&str| part.parse::<f64>().is_ok();
    if token.is_empty() {
        Some("write a value after `=`".to_owned())
    } else if parts.len() > 1 && parts.iter().all(is_number) {
        let list = parts.join(", ");
        Some(format!("separate numbers by commas, `{}`", if in_array { list } else { format!("[{list}]") }))
    } else if parts.len() == 2 && is_number(&parts[0]) {
        Some(format!("{}, because a value with a unit needs quotes", quoted(token)))
    } else {
        token.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c)).then(|| quoted(token))
    }
}
