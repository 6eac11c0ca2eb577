use super::*;
use polhode_ga::{Bivector, Rotor, Vector};

/// A spring at a right angle from rest, `½k(π/2)²`, reaches half a turn, `½kπ²`, if the rotation and the weight can give the
/// difference. Then its torque may jump, and steps must adapt.
#[test]
fn springs_that_may_reach_half_a_turn_need_adaptive_steps() {
    let body = Gyrostat::rigid([1.0, 2.0, 2.5]);
    let spring = Torque::TorsionSpring { stiffness: 2.0, rest: Rotor::IDENTITY };
    let rotor = Rotor::exp(Bivector([0.0, 0.0, -0.25 * std::f64::consts::PI]));
    let missing = 0.75 * std::f64::consts::PI.powi(2);
    for (laws, range) in [
        (vec![spring.clone()], 0.0),
        (vec![spring.clone(), Torque::Heavy(Vector([0.0, 0.3, 0.4]))], 1.0),
        (vec![spring, Torque::Heavy(Vector([0.0, 1.2, 1.6]))], 4.0),
    ] {
        for (energy, jumps) in [(missing - range - 0.01, false), (missing - range + 0.01, true)] {
            let momentum = body.momentum(Bivector([0.0, energy.sqrt(), 0.0]));
            let start = Phase { rotor, momentum, time: 0.0 };
            assert!((body.kinetic(momentum) - energy).abs() < 1e-12);
            let adapts = Method::best(&body, &laws, false, &start).adapts();
            assert_eq!(adapts, jumps, "{energy} {range}");
        }
    }
}

/// With two equal moments a free turn is exact and cheap, whichever two they are; the method is then of Nyström's kind.
#[test]
fn symmetric_bodies_have_their_own_splitting() {
    let start = Phase { rotor: Rotor::IDENTITY, momentum: Bivector([0.1, 0.2, 0.3]), time: 0.0 };
    let best = |moments| {
        let laws = [Torque::Heavy(Vector([0.1, 0.2, 0.3]))];
        match Method::best(&Gyrostat::rigid(moments), &laws, false, &start) {
            Method::Splitting(sequence) => sequence.is_nystrom(),
            other => panic!("{other:?} for {moments:?}"),
        }
    };
    assert!(best([2.0, 2.0, 1.0]) && best([1.0, 2.0, 2.0]) && best([2.0, 1.0, 2.0]) && best([2.0; 3]));
    assert!(!best([1.0, 2.0, 2.5]));
}
