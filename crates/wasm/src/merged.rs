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
mod tests {
    use super::*;

    const SCENE: &str = "# A box.\ntitle = \"box\"\n\n[body] # what\nsolid = \"box\"\n\n# How.\n[initial]\nspin = { vector = [1, 0, 0] }\n\n[run]\nduration = 1\n";

    #[test]
    fn tables_are_replaced_where_they_stand() {
        let changed = merged(SCENE, "[initial]\nspin = { vector = [0, 2, 0] }\n").unwrap();
        assert_eq!(changed, SCENE.replace("[1, 0, 0]", "[0, 2, 0]"));
    }

    #[test]
    fn tables_are_added_and_removed() {
        let heavy = merged(SCENE, "[gravity]\nacceleration = 9.81\n").unwrap();
        assert_eq!(heavy.trim_end(), format!("{SCENE}\n[gravity]\nacceleration = 9.81").trim_end());
        assert_eq!(merged(&heavy, "[gravity]\n").unwrap().trim_end(), SCENE.trim_end());
        assert_eq!(merged(SCENE, "[gravity]\n").unwrap(), SCENE);
    }

    #[test]
    fn fields_are_replaced_where_they_stand() {
        let scene = "[run]\nduration = 1 # s\ninterval = 0.1\nmethod = \"kahan\"\n";
        let changed = merged(scene, "run.duration = 2\nrun.samples = 11\nrun.interval = {}\n").unwrap();
        assert_eq!(changed, "[run]\nduration = 2 # s\nmethod = \"kahan\"\nsamples = 11\n");
        let inline = merged("run = { duration = 1, rtol = 1e-9 }\n", "run.duration = 2\n").unwrap();
        assert_eq!(inline, "run = { duration = 2, rtol = 1e-9 }\n");
        assert_eq!(merged("", "run.duration = 2\n").unwrap(), "[run]\nduration = 2\n");
    }

    #[test]
    fn invalid_toml_is_reported() {
        assert!(merged("[body", "").unwrap_err().contains("the scene cannot be read"));
        assert!(merged(SCENE, "[body").unwrap_err().contains("the change cannot be read"));
    }
}
