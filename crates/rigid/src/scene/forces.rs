//! The table `[force]`: forces on the centre of mass, which add up.

use super::reader::{Reader, Value};
use super::torques::{arguments, placed};
use crate::laws::force::Push;
use crate::laws::registry::FORCES;

pub fn read(reader: &mut Reader, value: &Value) -> Option<Vec<Push>> {
    let table = &reader.table(value, "[force]")?;
    reader.only(table, &FORCES.each_ref().map(|entry| entry.name));
    let mut pushes = Vec::new();
    for entry in &FORCES {
        if let Some(value) = table.get(entry.name) {
            let numbers = arguments(reader, value, entry);
            let push = numbers.and_then(|numbers| placed(reader, value, entry.build(&numbers)));
            pushes.push((value.span().start, push));
        }
    }
    pushes.sort_by_key(|(start, _)| *start);
    pushes.into_iter().map(|(_, push)| push).collect()
}
