use super::*;
use crate::body::inertia::Inertia;
use crate::exact::lanes::tests::{in_lanes_and_alone, rate};
use polhode_ga::{Rotor, Vector};
use proptest::prelude::*;
use std::array::from_fn;
use std::f64::consts::PI;

fn top(tilt: f64, omega: [f64; 3], c: f64) -> HeavyTop {
    let inertia = Inertia::from_principal_moments([1.0, 1.0, 0.5]).expect("a body's");
    let rotor = Rotor::exp(Bivector([-0.5 * tilt, 0.0, 0.0]));
    HeavyTop::new(&inertia, rotor, Bivector(omega), Vector([0.0, 0.0, c])).expect("a symmetric top")
}

/// The same about e1.
fn top_about_e1(tilt: f64, [x, y, z]: [f64; 3], c: f64) -> HeavyTop {
    let inertia = Inertia::from_principal_moments([0.5, 1.0, 1.0]).expect("a body's");
    let rotor = Rotor::exp(Bivector([0.0, 0.25 * PI - 0.5 * tilt, 0.0]));
    HeavyTop::new(&inertia, rotor, Bivector([z, y, x]), Vector([c, 0.0, 0.0])).expect("a symmetric top")
}

fn same_in_lanes(tops: &[HeavyTop; TOGETHER]) -> LagrangeTops<TOGETHER> {
    let [lanes, singles] = in_lanes_and_alone::<LagrangeTops<TOGETHER>>(tops);
    let times = from_fn(|l| 0.7 * l as f64 - 2.0);
    let states = |tops: &LagrangeTops<TOGETHER>| {
        let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
        tops.at(&times, &mut rotors, &mut omegas);
        (rotors, omegas)
    };
    let (first, second) = (states(&lanes), states(&singles));
    for l in 0..TOGETHER {
        assert_eq!(lanes.has(l), singles.has(l), "{:?}", tops[l]);
        if lanes.has(l) {
            assert_eq!(lanes.is_circular[l], singles.is_circular[l], "{:?}", tops[l]);
            assert_eq!(lanes.horizons[l], singles.horizons[l], "{:?}", tops[l]);
            assert_eq!((first.0[l], first.1[l]), (second.0[l], second.1[l]), "{:?}", tops[l]);
        }
    }
    lanes
}

/// Nutating tops, one near the separatrix, one that turns steadily and one that is not moderate.
#[test]
fn of_every_kind() {
    let lanes = same_in_lanes(&from_fn(|l| {
        let part = l as f64;
        match l {
            3 => top(1e-4, [0.0, 0.0, 0.1], 2.0),
            5 => top(0.0, [0.0, 0.0, 2.0], 0.0),
            8 => top(1e-120, [1e-121, 0.0, 6.0], 2.0),
            _ => top(0.3 + 0.1 * part, [0.1 * part, -0.2, 4.0 - 0.5 * part], 2.0),
        }
    }));
    assert_eq!((0..TOGETHER).filter(|&l| lanes.has(l)).count(), TOGETHER - 1);
    assert!(lanes.is_circular.contains(&true) && lanes.is_circular.contains(&false));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Tilts, rates and torques of any size.
    #[test]
    fn of_any_size(
        rates in prop::collection::vec([rate(), rate(), rate()], TOGETHER),
        tilts in prop::collection::vec([rate(), rate()], TOGETHER),
    ) {
        same_in_lanes(&from_fn(|l| {
            let [tilt, c] = tilts[l];
            // Near either pole.
            let tilt = if l % 4 < 2 { tilt } else { PI - tilt };
            let top = if l % 2 == 0 { top } else { top_about_e1 };
            top(tilt, rates[l], c.abs().max(1e-15))
        }));
    }
}
