use super::*;
use std::array::from_fn;

/// Tumbling bodies, one near the separatrix, one that turns steadily and one with rates far below those of the others.
fn bodies() -> [FreeBody; TOGETHER] {
    let rotor = Rotor::exp(Bivector([0.2, -0.1, 0.4]));
    from_fn(|l| {
        let part = l as f64;
        let omega = match l {
            3 => [1e-9, 1.0, 0.0],
            5 => [0.0, 0.0, 2.0],
            8 => [1e-200, 2e-200, 1e-201],
            _ => [1.0 - 0.1 * part, 0.3, 0.05 * part - 0.4],
        };
        FreeBody::in_frame(rotor, [1.0, 2.0, 3.0 - 0.01 * part], rotor, Bivector(omega))
    })
}

/// Machines without wide instructions set up the motions of lanes one by one.
#[test]
fn one_by_one_as_in_lanes() {
    let [mut lanes, mut singles] = [FreeMotions::default(), FreeMotions::default()];
    lanes.set_up(&bodies());
    singles.set_up_one_by_one(&bodies());
    assert_eq!(lanes.is_circular, singles.is_circular);
    assert!(lanes.is_circular.contains(&true) && lanes.is_circular.contains(&false));
    assert_eq!(lanes.horizons, singles.horizons);
    let times = from_fn(|l| 3.0 * l as f64 - 7.0);
    let [first, second] = [lanes, singles].map(|motions| {
        let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
        motions.at(&times, &mut rotors, &mut omegas);
        (rotors, omegas)
    });
    assert_eq!(first, second);
}
