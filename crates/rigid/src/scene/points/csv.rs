//! Tables of points as comma-separated text: a header line of paths, and a line for each point.

use super::values::{Values, number, string};
use polhode_ga::diagnostic::quote;
use toml::de::DeValue;

/// The columns of a table.
pub struct CsvTable {
    /// Names and values of the columns.
    pub columns: Vec<(String, Values)>,
    /// The number of each row's line in the file, if lines without content are before it.
    pub lines: Vec<u32>,
}

/// Reads the text of a table; an error has its line.
pub fn read(text: &str) -> Result<CsvTable, String> {
    let mut table = CsvTable { columns: Vec::new(), lines: Vec::new() };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let number = index + 1;
        let cells = split(line).map_err(|why| format!("line {number}: {why}"))?;
        let columns = table.columns.len();
        if columns == 0 {
            table.columns = cells.iter().map(|cell| (unquoted(cell), Values::new())).collect();
            continue;
        }
        if cells.len() != columns {
            let found = cells.len();
            return Err(format!("line {number}: expected {columns} cells as in the header, found {found}"));
        }
        for ((name, values), cell) in table.columns.iter_mut().zip(cells) {
            let value = value(cell).map_err(|why| format!("line {number}, column `{name}`: {why}"))?;
            if !values.push(&value) {
                return Err(format!("line {number}: column `{name}` has more than 4 GB of text"));
            }
        }
        table.lines.push(number as u32);
    }
    if table.lines.is_empty() {
        return Err("has no rows; expected a header line of paths and a line for each body".to_owned());
    }
    Ok(table)
}

/// The cells of a line, without spaces around them.
fn split(line: &str) -> Result<Vec<&str>, String> {
    let mut cells = Vec::new();
    let (mut start, mut quoted) = (0, false);
    for (at, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => {
                cells.push(line[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    if quoted {
        return Err(format!("{} has no closing quote", quote(&line[start..])));
    }
    cells.push(line[start..].trim());
    Ok(cells)
}

/// The content of a cell in quotes, in which two quotes stand for one.
fn unquoted(cell: &str) -> String {
    match cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')) {
        Some(inner) => inner.replace("\"\"", "\"").trim().to_owned(),
        None => cell.to_owned(),
    }
}

/// The content of a cell as text of TOML: a number, an array in brackets, or a string.
fn value(cell: &str) -> Result<String, String> {
    if let Ok(x) = cell.parse() {
        return Ok(number(x));
    }
    let text = unquoted(cell);
    if text.is_empty() {
        return Err("the cell is empty".to_owned());
    }
    if let Ok(x) = text.parse() {
        return Ok(number(x));
    }
    let is_array = text.starts_with('[') && DeValue::parse(&text).is_ok();
    Ok(if is_array { text } else { string(&text) })
}
