//! Tables of points as comma-separated text: a header line of paths, and a line for each point.

use super::place::row;
use super::values::{Values, number, string};
use polhode_ga::diagnostic::quote;
use toml::de::DeValue;

/// The columns of a table.
pub struct CsvTable {
    /// Names and values of the columns.
    pub columns: Vec<(String, Values)>,
    /// The line of the header in the file, from 1.
    pub header: u32,
    /// The line of each row in the file.
    pub lines: Vec<u32>,
}

/// Reads the text of a table; an error has the name of the file and the line.
pub fn read(file: &str, text: &str) -> Result<CsvTable, String> {
    let mut table = CsvTable { columns: Vec::new(), header: 0, lines: Vec::new() };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text).trim_end();
    for (index, line) in text.lines().enumerate() {
        let number = index as u32 + 1;
        let place = || row(file, number);
        let columns = table.columns.len();
        // In a table of one column a blank line is a row whose cell is empty.
        if line.trim().is_empty() && columns != 1 {
            continue;
        }
        let cells = split(line).map_err(|why| format!("{}: {why}", place()))?;
        if columns == 0 {
            if let Some(why) = other_separator(line) {
                return Err(format!("{}: {why}", place()));
            }
            table.columns = cells.iter().map(|cell| (unquoted(cell), Values::new())).collect();
            table.header = number;
            continue;
        }
        if cells.len() != columns {
            let found = cells.len();
            return Err(format!("{}: expected {columns} cells as in the header, found {found}", place()));
        }
        for ((name, values), cell) in table.columns.iter_mut().zip(cells) {
            let value = value(cell).map_err(|why| format!("{}, column `{name}`: {why}", place()))?;
            if !values.push(&value) {
                return Err(format!("{}: column `{name}` has more than 4 GB of text", place()));
            }
        }
        table.lines.push(number);
    }
    if table.lines.is_empty() {
        let expected = "expected a header line of paths and a line for each body";
        return Err(format!("{file} has no rows; {expected}"));
    }
    Ok(table)
}

/// What is wrong with a header without commas whose cells another character separates.
fn other_separator(header: &str) -> Option<String> {
    let (_, name) = [(';', "semicolons"), ('\t', "tabs"), ('|', "bars")]
        .into_iter()
        .find(|(separator, _)| header.contains(*separator) && !header.contains(','))?;
    Some(format!(
        "the cells are separated by {name}; separate them by commas, with decimal points in numbers"
    ))
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
        return Err(format!("{} has no closing quote in its line", quote(&line[start..])));
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
    if let Some(x) = cell.parse().ok().filter(|x: &f64| x.is_finite()) {
        return Ok(number(x));
    }
    let text = unquoted(cell);
    if text.is_empty() {
        return Err("the cell is empty".to_owned());
    }
    if let Ok(x) = text.parse::<f64>() {
        let is_float = |text: &str| DeValue::parse(text).is_ok_and(|value| value.get_ref().is_float());
        // A number that is too large is reported as it is written.
        return Ok(if x.is_infinite() && is_float(&text) { text } else { number(x) });
    }
    let is_array = text.starts_with('[') && DeValue::parse(&text).is_ok();
    Ok(if is_array { text } else { string(&text) })
}
