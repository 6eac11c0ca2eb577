//! Tables of a scene replaced by others, all else kept as it was written.

use toml_edit::{Decor, DocumentMut};

/// The scene with its tables replaced by those of `change`; an empty table takes its one away. Comments and the order
/// of the rest stay.
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
        let mut table = table.clone();
        // In the place of the one that it replaces, else at the end.
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
    fn tables_are_added_and_taken_away() {
        let heavy = merged(SCENE, "[gravity]\nacceleration = 9.81\n").unwrap();
        assert_eq!(heavy.trim_end(), format!("{SCENE}\n[gravity]\nacceleration = 9.81").trim_end());
        assert_eq!(merged(&heavy, "[gravity]\n").unwrap().trim_end(), SCENE.trim_end());
        assert_eq!(merged(SCENE, "[gravity]\n").unwrap(), SCENE);
    }

    #[test]
    fn what_is_no_toml_is_told() {
        assert!(merged("[body", "").unwrap_err().contains("the scene cannot be read"));
        assert!(merged(SCENE, "[body").unwrap_err().contains("the change cannot be read"));
    }
}
