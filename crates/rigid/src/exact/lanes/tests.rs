use proptest::prelude::*;

/// Rates and tilts from the least of a moderate body, or below it, up, of either sign.
pub(in crate::exact) fn rate() -> impl Strategy<Value = f64> {
    (-20.2..0.3f64, prop::bool::ANY)
        .prop_map(|(power, minus)| 10f64.powf(power) * if minus { -1.0 } else { 1.0 })
}
