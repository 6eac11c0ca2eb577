use super::super::bins::bin;
use super::super::{Ensemble, Outputs, Rows, Start};
use super::{BEYOND, COUNTED, ENDS, ROW, SERIES, Watch};
use crate::body::inertia::Inertia;
use crate::exact::regime::Regime;
use crate::state::center::Center;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use std::f64::consts::PI;

const TIMES: usize = 41;

/// Bodies that turn about e1 by `rate t`, with Ω = rate e2e3, L = e3 and the energy t; the second one fails after half of
/// the times.
struct Turning {
    times: Vec<f64>,
    rotors: Vec<f64>,
    omegas: Vec<f64>,
    momenta: Vec<f64>,
    energies: Vec<f64>,
}

fn turning(rates: &[f64]) -> Turning {
    let times: Vec<f64> = (0..TIMES).map(|k| 0.1 * k as f64).collect();
    let mut states =
        Turning { times: times.clone(), rotors: vec![], omegas: vec![], momenta: vec![], energies: vec![] };
    for (body, rate) in rates.iter().enumerate() {
        for (k, time) in times.iter().enumerate() {
            let known = if body == 1 && k > TIMES / 2 { f64::NAN } else { 1.0 };
            let half = 0.5 * rate * time;
            states.rotors.extend([half.cos(), -half.sin(), 0.0, 0.0].map(|x| x * known));
            states.omegas.extend([*rate, 0.0, 0.0].map(|x| x * known));
            states.momenta.extend([0.0, 0.0, 1.0].map(|x| x * known));
            states.energies.push(time * known);
        }
    }
    states
}

/// The rows and bins of these bodies; the nominal body stays at rest, and the axis is e3.
fn reduced(rates: &[f64], threads: usize) -> (Vec<[f64; ROW]>, Vec<i32>) {
    let mut states = turning(rates);
    let times = states.times.clone();
    let outputs = Outputs {
        rotors: &mut states.rotors,
        omegas: &mut states.omegas,
        momenta: &mut states.momenta,
        energies: &mut states.energies,
        centers: None,
    };
    let nominal = vec![[1.0, 0.0, 0.0, 0.0]; TIMES];
    let watch = Watch { times: &times, nominal: &nominal, axis: Vector([0.0, 0.0, 1.0]), upright: &[] };
    let mut rows = vec![[0.0; ROW]; rates.len()];
    let mut bins = vec![0; rates.len() * (COUNTED * TIMES + ENDS)];
    watch.reduce(&outputs, Threads::new(threads), &mut rows, &mut bins);
    (rows, bins)
}

#[test]
fn a_uniform_turn_has_known_extrema_and_events() {
    // From 0 to 4 s by 1.3 rad/s: 5.2 rad. The tilt passes 90° after π/2 and 3π/2 rad; the angle from the start is more
    // than 10° and 90° after π/18 and π/2 rad, and at most π.
    let (rows, _) = reduced(&[1.3], 1);
    let [from_least, from_most, tilt_least, tilt_most, rate_least, rate_most, least, most, flips, times @ ..] =
        rows[0];
    assert!(from_least.abs() < 1e-15 && tilt_least.abs() < 1e-15);
    // The last turn before π or the first after it is at most half an interval away.
    assert!((PI - from_most).abs() <= 0.065 + 1e-12 && (PI - tilt_most).abs() <= 0.065 + 1e-12);
    assert_eq!([rate_least, rate_most, least], [1.3, 1.3, 0.0]);
    assert!((most - 4.0).abs() < 1e-12);
    assert_eq!(flips, 2.0);
    // The angle grows linearly, so interpolation is exact; a cosine at its zero has an error of third order, at most
    // (0.13)³/(6 · 9√3/...) < 0.13³/10 in the angle.
    let expected = [0.5 * PI, 1.5 * PI, BEYOND[0], BEYOND[1]].map(|angle| angle / 1.3);
    for (time, expected) in times.iter().zip(expected) {
        assert!((time - expected).abs() < 0.13_f64.powi(3) / 10.0, "{time} {expected}");
    }
    assert!((times[2] - expected[2]).abs() < 1e-14);
}

#[test]
fn failed_bodies_are_reduced_up_to_their_failure() {
    // The second body turns by 0.2 rad up to its failure after 2 s; the third one not at all.
    let (rows, bins) = reduced(&[1.3, 0.1, 0.0], 1);
    assert!((rows[1][1] - 0.2).abs() < 1e-14 && (rows[1][2 * SERIES - 1] - 2.0).abs() < 1e-14);
    assert!((rows[1][2 * SERIES + 3] - 10.0 * BEYOND[0]).abs() < 1e-12);
    assert_eq!(rows[2][2 * SERIES], 0.0);
    assert!(rows[1..].iter().all(|row| row[2 * SERIES + 4].is_nan() && row[2 * SERIES + 1].is_nan()));
    let size = COUNTED * TIMES + ENDS;
    assert_eq!(bins[size + TIMES - 1], bin(f64::NAN));
    assert_eq!(bins[size - ENDS..size], [0.0, 4.0, 1.0, 1.0].map(bin));
    assert_eq!(bins[2 * TIMES], bin(1.3));
}

#[test]
fn threads_do_not_change_bits() {
    let rates: Vec<f64> = (0..3000).map(|k| 0.001 * f64::from(k)).collect();
    let [(one, bins), (many, same)] = [1, 7].map(|threads| reduced(&rates, threads));
    let bits =
        |rows: Vec<[f64; ROW]>| rows.into_flattened().into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(one), bits(many));
    assert_eq!(bins, same);
}

#[test]
fn free_bodies_have_regimes_and_periods() {
    let start = |omega| Start {
        time: 0.0,
        rotor: Rotor::IDENTITY,
        omega: Bivector(omega),
        center: Center { position: Vector::default(), velocity: Vector::default() },
    };
    let ensemble = Ensemble {
        inertias: Rows::new(vec![Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap()]),
        starts: vec![start([0.0; 3]), start([1.0, 0.1, 0.1]), start([0.1, 0.1, 1.0]), start([f64::NAN; 3])],
        laws: vec![],
        masses: Rows::new(vec![1.0]),
        forces: vec![],
    };
    let found = ensemble.describe_free(Threads::new(2));
    let regimes = found.iter().map(|body| body.regime).collect::<Vec<_>>();
    let expected = [Some(Regime::Rest), Some(Regime::LongAxis), Some(Regime::ShortAxis), None];
    assert_eq!(regimes, expected);
    assert!(found[0].period.is_nan() && found[3].precession_period.is_nan());
    // A small wobble of a long-axis mode: its period is 2π √(2·3/((3−1)(2−1)))/Ω₁ to first order in (0.1)².
    let small = 2.0 * PI * 3.0_f64.sqrt();
    assert!((found[1].period / small - 1.0).abs() < 0.1);
}
