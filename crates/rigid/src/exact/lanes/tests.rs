use super::*;
use proptest::prelude::*;

/// Motions set up in lanes, and one by one, as on machines without wide instructions.
pub(in crate::exact) fn in_lanes_and_alone<M: SetUp + Default>(bodies: &[M::Body; TOGETHER]) -> [M; 2] {
    let [mut lanes, mut singles] = [M::default(), M::default()];
    lanes.set_up(bodies, TOGETHER);
    for (l, body) in bodies.iter().enumerate() {
        singles.set_up_alone(l, body);
    }
    [lanes, singles]
}

/// Rates and tilts from the least of a moderate body, or below it, up, of either sign.
pub(in crate::exact) fn rate() -> impl Strategy<Value = f64> {
    (-20.2..0.3f64, prop::bool::ANY)
        .prop_map(|(power, minus)| 10f64.powf(power) * if minus { -1.0 } else { 1.0 })
}
