//! Registry of laws for the page: `LawEntry` in `viewer/src/core/core.ts`.

use polhode_rigid::laws::registry::{Argument, TORQUES};
use serde_json::{Value, json};

/// Every torque law that has arguments, as JSON.
pub fn laws() -> Value {
    let entries = TORQUES.iter().map(|entry| {
        json!({
            "name": entry.name,
            "label": entry.label,
            "formula": entry.formula,
            "arguments": entry.arguments.iter().map(argument).collect::<Value>(),
        })
    });
    entries.collect()
}

fn argument(argument: &Argument) -> Value {
    json!({
        "name": argument.name,
        "field": argument.field,
        "unit": argument.quantity.map_or("", |quantity| quantity.si_unit()),
        "shape": argument.shape.name(),
        "period": argument.period,
        "optional": argument.default.is_some(),
    })
}
