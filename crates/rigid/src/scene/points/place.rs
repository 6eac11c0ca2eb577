//! Places of points: where a scene has values that may differ between bodies, and where a table has them.

use super::path::{Path, Step};
use crate::laws::registry::{TABLE, TORQUES};
use crate::scene::reader::{Value, nearest_path};
use crate::scene::{NAMES, laws};
use polhode_ga::diagnostic::alternatives;
use toml::de::{DeTable, DeValue};

/// Whether the tables of this file have rows but no lines.
fn is_parquet(file: &str) -> bool {
    file.to_ascii_lowercase().ends_with(".parquet")
}

/// A row of a table, by its line as comma-separated text, from 1.
pub fn row(file: &str, line: u32) -> String {
    if is_parquet(file) {
        return format!("{file}, row {} (from 0)", line.saturating_sub(2));
    }
    format!("{file}, line {line}")
}

/// The header of a table, before an error in it.
pub fn header(file: &str, line: u32) -> String {
    if is_parquet(file) { format!("{file}: ") } else { format!("{file}, line {line}: ") }
}

/// What to do with a column of a table that is not a value of the scene, by its name.
pub fn remedy(name: &str) -> &'static str {
    let numbered = name.strip_prefix("__index_level_").is_some_and(|rest| rest.ends_with("__"));
    if numbered || matches!(name, "" | "index" | "level_0" | "Unnamed: 0") {
        return "; remove the column, or write the file by pandas with `index=False`";
    }
    if TABLES.contains(&name) { "" } else { "; rename or remove the column" }
}

/// The tables whose values may be replaced.
const TABLES: [&str; 6] = ["body", "initial", "gravity", "torque", "force", "define"];

/// Whether the scene has a place for a value that may differ between bodies.
pub fn replaceable(root: &DeTable, path: &Path) -> Result<(), String> {
    let (table, field) = (path.field(0), path.field(1));
    let mesh = root
        .get("body")
        .and_then(|body| body.get_ref().as_table())
        .is_some_and(|body| body.contains_key("mesh"));
    match table {
        _ if is_shared(table) => {
            let tables = alternatives(&TABLES);
            return Err(format!("`{table}` is the same for all bodies; values of {tables} may vary"));
        }
        _ if !TABLES.contains(&table) => {
            return Err(format!("`{path}` is not the path of a scene value{}", suggestion(root, path)));
        }
        _ if path.0.len() < 2 => {
            return Err(format!("expected a value in [{table}], such as `{table}.name`"));
        }
        "initial" if field == "time" => {
            return Err("the initial time is the same for all bodies, as the output times are".to_owned());
        }
        "body" if mesh => {
            return Err("a mesh is the same for all bodies; give the moments of the body".to_owned());
        }
        "gravity" if field == "pivot" && mesh => {
            return Err(
                "the pivot of a mesh is the same for all bodies; give the moments of the body".to_owned()
            );
        }
        "torque" if !TORQUES.iter().any(|law| law.name == field && field != TABLE) => {
            let law = Path(path.0[..2].to_vec());
            if law.find(root).is_none() {
                return Err(missing(root, &law, path));
            }
            return Err(format!(
                "`{field}` is the same for all bodies; values of [define] may vary in formulas"
            ));
        }
        _ => {}
    }
    let parents = if matches!(table, "torque" | "force") { 2 } else { path.0.len() - 1 };
    for depth in 1..=parents.max(path.0.len() - 1) {
        let parent = Path(path.0[..depth].to_vec());
        if parent.find(root).is_none() {
            return Err(missing(root, &parent, path));
        }
    }
    match path.0.last() {
        // A name that the scene does not define is in none of its formulas.
        _ if table == "define" && path.find(root).is_none() => Err(missing(root, path, path)),
        Some(Step::Item(_)) if path.find(root).is_none() => Err(missing(root, path, path)),
        _ => Ok(()),
    }
}

/// Whether this is a name of the scene whose values are the same for all bodies.
fn is_shared(name: &str) -> bool {
    !TABLES.contains(&name)
        && (NAMES.contains(&name) || laws::FORMULAS.iter().any(|(formula, _)| *formula == name))
}

/// The error for a path whose first steps, `absent`, the scene does not have.
fn missing(root: &DeTable, absent: &Path, path: &Path) -> String {
    if let Some((Step::Item(_), above)) = absent.0.split_last() {
        let array = Path(above.to_vec());
        return match array.find(root).and_then(|value| value.get_ref().as_array()) {
            Some(items) => {
                format!("the scene has no `{absent}`; `{array}` has {} items, from [0]", items.len())
            }
            None => format!("the scene has no `{absent}`; `{array}` is not an array"),
        };
    }
    format!("the scene has no `{absent}`{}", suggestion(root, path))
}

/// `` ; did you mean `initial.spin.rate`? `` if the scene has a value at a similar path.
fn suggestion(root: &DeTable, path: &Path) -> String {
    let mut paths = Vec::new();
    for table in TABLES {
        if let Some(value) = root.get(table) {
            values(value, &Path(vec![Step::Field(table.to_owned())]), &mut paths);
        }
    }
    paths.retain(|path| replaceable(root, path).is_ok());
    let names: Vec<String> = paths.iter().map(Path::to_string).collect();
    nearest_path(&path.to_string(), &names)
        .map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

/// The paths of the values in a table of the scene, and of the components of arrays.
fn values(value: &Value, path: &Path, found: &mut Vec<Path>) {
    let below = |step: Step| Path([&path.0[..], &[step]].concat());
    match value.get_ref() {
        DeValue::Table(fields) => fields
            .iter()
            .for_each(|(key, value)| values(value, &below(Step::Field(key.get_ref().to_string())), found)),
        DeValue::Array(items) => {
            found.push(path.clone());
            (0..items.len()).for_each(|index| found.push(below(Step::Item(index))));
        }
        _ => found.push(path.clone()),
    }
}
