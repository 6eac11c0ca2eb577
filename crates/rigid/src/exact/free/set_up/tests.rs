use super::*;
use crate::exact::lanes::tests::{in_lanes_and_alone, rate};
use proptest::prelude::*;
use std::array::from_fn;

/// Rotors and angular velocities in lanes.
fn states(motions: &FreeMotions<TOGETHER>) -> ([[f64; 4]; TOGETHER], [[f64; 3]; TOGETHER]) {
    let times = from_fn(|l| 3.0 * l as f64 - 7.0);
    let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
    motions.at(&times, &mut rotors, &mut omegas);
    (rotors, omegas)
}

fn same_in_lanes(bodies: &[FreeBody; TOGETHER]) -> FreeMotions<TOGETHER> {
    let [lanes, singles] = in_lanes_and_alone::<FreeMotions<TOGETHER>>(bodies);
    assert_eq!(lanes.is_circular, singles.is_circular);
    assert_eq!(lanes.horizons, singles.horizons);
    assert_eq!(states(&lanes), states(&singles));
    lanes
}

/// Tumbling bodies, one near the separatrix, one that turns steadily and one that is not moderate.
#[test]
fn of_every_kind() {
    let rotor = Rotor::exp(Bivector([0.2, -0.1, 0.4]));
    let lanes = same_in_lanes(&from_fn(|l| {
        let part = l as f64;
        let omega = match l {
            3 => [1e-9, 1.0, 0.0],
            5 => [0.0, 0.0, 2.0],
            8 => [1.0, 2.0, 1e-200],
            _ => [1.0 - 0.1 * part, 0.3, 0.05 * part - 0.4],
        };
        FreeBody::in_frame(rotor, [1.0, 2.0, 3.0 - 0.01 * part], rotor, Bivector(omega))
    }));
    assert!(lanes.is_circular.contains(&true) && lanes.is_circular.contains(&false));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Rates and differences of moments of any size.
    #[test]
    fn of_any_size(
        rates in prop::collection::vec([rate(), rate(), rate()], TOGETHER),
        apart in prop::collection::vec([rate(), rate()], TOGETHER),
    ) {
        same_in_lanes(&from_fn(|l| {
            let [a, b] = apart[l].map(|x| 0.4 * x.abs());
            // Frames with components of rounding.
            let frame = Rotor::exp(Bivector([apart[l][0], 0.25 * PI, apart[l][1]]));
            FreeBody::in_frame(frame, [1.0, 1.0 + a, 1.0 + a + b], frame, Bivector(rates[l]))
        }));
    }
}
