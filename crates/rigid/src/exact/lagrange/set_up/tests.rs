use super::*;
use crate::body::inertia::Inertia;
use polhode_ga::{Rotor, Vector};
use std::array::from_fn;

/// Tops, one near the separatrix, one that turns steadily and one that is hardly tilted.
fn tops() -> [HeavyTop; TOGETHER] {
    let inertia = Inertia::from_principal_moments([1.0, 1.0, 0.5]).expect("a body's");
    from_fn(|l| {
        let part = l as f64;
        let (tilt, omega) = match l {
            3 => (1e-4, [0.0, 0.0, 0.1]),
            5 => (0.0, [0.0, 0.0, 2.0]),
            8 => (1e-120, [1e-121, 0.0, 6.0]),
            _ => (0.3 + 0.1 * part, [0.1 * part, -0.2, 4.0 - 0.5 * part]),
        };
        let rotor = Rotor::exp(Bivector([-0.5 * tilt, 0.0, 0.0]));
        HeavyTop::new(&inertia, rotor, Bivector(omega), Vector([0.0, 0.0, 2.0])).expect("a symmetric top")
    })
}

/// Machines without wide instructions set up the motions of lanes one by one.
#[test]
fn one_by_one_as_in_lanes() {
    let [mut lanes, mut singles] = [LagrangeTops::default(), LagrangeTops::default()];
    lanes.set_up(&tops());
    singles.set_up_one_by_one(&tops());
    let has = |tops: &LagrangeTops<TOGETHER>| from_fn::<_, TOGETHER, _>(|l| tops.has(l));
    assert_eq!(has(&lanes), has(&singles));
    let times = from_fn(|l| 0.7 * l as f64 - 2.0);
    let states = |tops: &LagrangeTops<TOGETHER>| {
        let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
        tops.at(&times, &mut rotors, &mut omegas);
        (rotors, omegas)
    };
    let (first, second) = (states(&lanes), states(&singles));
    for l in (0..TOGETHER).filter(|&l| lanes.has(l)) {
        assert_eq!(lanes.is_circular[l], singles.is_circular[l], "{l}");
        assert_eq!(lanes.horizons[l], singles.horizons[l], "{l}");
        assert_eq!((first.0[l], first.1[l]), (second.0[l], second.1[l]), "{l}");
    }
    assert_eq!((0..TOGETHER).filter(|&l| lanes.has(l)).count(), TOGETHER - 1);
    assert!(lanes.is_circular.contains(&false));
}
