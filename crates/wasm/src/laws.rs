//! The registry of laws for the page: `LawEntry` in `viewer/src/core/core.ts`.

use crate::json::Json;
use polhode_rigid::laws::registry::{Argument, TORQUES};

/// Every torque law that has arguments, as JSON.
pub fn laws() -> Json {
    let entry = |entry: &'static polhode_rigid::laws::registry::Entry<_>| {
        Json::Object(vec![
            ("name", entry.name.into()),
            ("label", entry.label.into()),
            ("formula", entry.formula.into()),
            ("arguments", Json::List(entry.arguments.iter().map(argument).collect())),
        ])
    };
    Json::List(TORQUES.iter().map(entry).collect())
}

fn argument(argument: &Argument) -> Json {
    Json::Object(vec![
        ("name", argument.name.into()),
        ("field", argument.field.into()),
        ("unit", argument.quantity.map_or("", |quantity| quantity.si_unit()).into()),
        ("shape", argument.shape.name().into()),
        ("period", argument.period.into()),
        ("optional", argument.default.is_some().into()),
    ])
}
