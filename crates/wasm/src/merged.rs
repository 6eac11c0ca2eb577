//! Replacement of tables in the text of a scene.

use toml_edit::{Decor, DocumentMut, Item, Table};

/// The scene with its tables replaced by those of `change`; an empty table removes one. Of a dotted table,
/// `run.samples = 11`, only these fields are replaced. Comments and order of the rest stay.
pub fn merged(scene: &str, change: &str) -> Result<String, String> {
    let read = |text: &str, what: &str| {
        text.parse::<DocumentMut>().map_err(|error| format!("{what} cannot be read: {error}"))
    };
    let mut scene = read(scene, "the scene")?;
    for (name, table) in read(change, "the change")?.iter() {
        let empty = table.as_table_like().is_some_and(|table| table.is_empty());
        if empty {
            scene.remove(name);
            continue;
        }
        if let Some(fields) = table.as_table().filter(|table| table.is_dotted()) {
            replace_fields(scene.entry(name).or_insert(toml_edit::table()), fields);
            continue;
        }
        let mut table = table.clone();
        // At the position of the old table, else at the end.
        let old = scene.get(name).and_then(|old| old.as_table());
        let (place, decor) = (old.and_then(|old| old.position()), old.map(|old| old.decor().clone()));
        if let Some(table) = table.as_table_mut() {
            table.set_position(place);
            *table.decor_mut() = decor.unwrap_or_else(|| Decor::new("\n", ""));
        }
        scene.insert(name, table);
    }
    Ok(scene.to_string())
}

/// Replaces fields of a table in place; an empty table removes a field.
fn replace_fields(table: &mut Item, fields: &Table) {
    let Some(table) = table.as_table_like_mut() else { return };
    for (name, field) in fields {
        if field.as_table_like().is_some_and(|field| field.is_empty()) {
            table.remove(name);
            continue;
        }
        let mut field = field.clone();
        let old = table.get(name).and_then(|old| old.as_value()).map(|old| old.decor().clone());
        if let (Some(value), Some(decor)) = (field.as_value_mut(), old) {
            *value.decor_mut() = decor;
        }
        table.insert(name, field);
    }
}

#[cfg(test)]
mod tests;
