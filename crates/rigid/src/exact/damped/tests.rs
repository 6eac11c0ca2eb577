use super::*;
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::lanes::exp_of_pairs;

/// The relative error of the exponential, 2⁻⁹⁰.
const EXP_ERROR: f64 = 1.0 / (1u128 << 90) as f64;

fn exponential(x: f64) -> [DoubleDouble; 2] {
    let fused = exp_of_pairs::<1, true>(&DoubleDoubles::all(DoubleDouble::from(x)));
    let split = exp_of_pairs::<1, false>(&DoubleDoubles::all(DoubleDouble::from(x)));
    assert_eq!(fused.map(|p| (p.hi, p.lo)), split.map(|p| (p.hi, p.lo)));
    split.map(|p| p.lane(0))
}

#[test]
fn the_exponential_has_90_bits() {
    // e − 1 to 32 digits.
    let cases = [
        (1.0, DoubleDouble { hi: 1.718_281_828_459_045, lo: 1.445_646_891_729_250_2e-16 }),
        (0.0, DoubleDouble::ZERO),
    ];
    for (x, expected) in cases {
        let found = exponential(x)[1];
        assert!((found - expected).value().abs() <= 2.0 * EXP_ERROR, "{x}: {found:?}");
    }
    for x in [-600.0, -3.0, -0.1, 1e-9, 0.2, 0.4, 5.0, 300.0] {
        // e^x e^{−x} = 1.
        let both = [x, -x].map(|x: f64| exponential(x)[0]);
        assert!((both[0] * both[1] - DoubleDouble::ONE).value().abs() <= 2.0 * EXP_ERROR, "{x}");
        assert!((exponential(x)[1].value() / x.exp_m1() - 1.0).abs() <= 4.0 * f64::EPSILON, "{x}");
    }
}

/// In lanes and threads too, damped, growing and free, over more than one block.
#[test]
fn many_states_have_the_bits_of_single_ones() {
    let inertia = Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap();
    let rotor = Rotor::exp(Bivector([0.3, -0.2, 0.9]));
    for damping in [0.3, -0.01, 0.0, 1e-20, 1e-310] {
        let top = DampedTop::new(&inertia, rotor, Bivector([0.2, 1.0, -0.4]), damping).unwrap();
        let times: Vec<f64> = (0..10_000).map(|k| 0.37 * k as f64 - 40.0).collect();
        for (threads, count) in [(1, 0), (1, 1), (1, 131), (3, times.len())] {
            let (mut rotors, mut omegas) = (vec![0.0; 4 * count], vec![0.0; 3 * count]);
            top.at_many(Threads::new(threads), &times[..count], &mut rotors, &mut omegas);
            for (k, &t) in times[..count].iter().enumerate() {
                let (rotor, omega) = top.at(t);
                assert_eq!(rotors[4 * k..4 * k + 4], rotor.components(), "g = {damping}, t = {t}");
                assert_eq!(omegas[3 * k..3 * k + 3], omega.0, "g = {damping}, t = {t}");
            }
        }
    }
}
