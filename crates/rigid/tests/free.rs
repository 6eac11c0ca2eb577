//! The free top: against states computed by other formulas to 34 digits, and against conservation laws.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::exact::free::FreeMotion;
use polhode_rigid::exact::regime::Regime;
use polhode_rigid::methods::{Method, methods};
use polhode_rigid::run::{Options, Problem};
use polhode_rigid::{Inertia, SimulateError};
use proptest::prelude::*;

const EPS: f64 = f64::EPSILON;

fn start() -> Rotor {
    Rotor::from_components([4.0, -2.0, 1.0, 2.0]).unwrap()
}

fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    // NaN is the largest of all.
    numbers.into_iter().fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x.abs()) })
}

/// Phases are known to half a rounding, series and products add some: 8 in all.
#[test]
fn states_of_every_kind_at_any_time() {
    for line in include_str!("data/free_states.txt").lines() {
        let (kind, numbers) = line.split_once(' ').unwrap();
        let x: Vec<f64> = numbers.split(' ').map(|x| x.parse().unwrap()).collect();
        let motion = FreeMotion::in_principal_axes([x[0], x[1], x[2]], start(), Bivector([x[3], x[4], x[5]]));
        let (rotor, omega) = motion.at(x[6]);
        let apart = |found: &[f64], expected: &[f64]| {
            let pairs = found.iter().zip(expected.as_chunks::<2>().0);
            largest(pairs.map(|(found, [high, low])| (found - high) - low))
        };
        let rotor_error = apart(&rotor.components(), &x[7..15]);
        let omega_error = apart(&omega.0, &x[15..]) / largest(x[15..].iter().copied());
        assert!(rotor_error <= 8.0 * EPS, "{kind}: rotor off by {rotor_error:e} at {}", x[6]);
        assert!(omega_error <= 8.0 * EPS, "{kind}: spin off by {omega_error:e} at {}", x[6]);
    }
}

/// Powers of two times a number near 1.
fn size(exponents: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    (exponents, 1.0..2.0f64).prop_map(|(e, x)| x * 2f64.powi(e))
}

fn moments() -> impl Strategy<Value = [f64; 3]> {
    let nearly = || prop_oneof![Just(1.0), (1..53).prop_map(|e: i32| 1.0 + 2f64.powi(-e))];
    prop_oneof![
        [size(-2..2), size(-2..2), size(-2..2)],
        [size(-10..10), size(-10..10), size(-10..10)],
        (size(-2..2), nearly(), nearly()).prop_map(|(i, x, y)| [i, i * x, i * y]),
        (size(-2..20), size(-2..2), nearly()).prop_map(|(i, j, x)| [i, j, j * x]),
    ]
}

/// Angular velocities of either regime and at its ends; moments decide what is near the separatrix.
fn spin([i, j, k]: [f64; 3]) -> impl Strategy<Value = [f64; 3]> {
    let rate = || prop_oneof![6 => size(-2..2), 1 => size(-60..0), 1 => size(-960..0), 1 => Just(0.0)];
    let far = (0..56).prop_map(|e: i32| if e < 54 { 2f64.powi(-e) } else { 0.0 });
    let separatrix = (size(-2..2), rate(), far, any::<bool>()).prop_map(move |(w, other, far, short)| {
        let mut axes = [(i, 0), (j, 1), (k, 2)];
        axes.sort_by(|x, y| x.0.total_cmp(&y.0));
        let [(a, at_a), (b, at_b), (c, at_c)] = axes;
        let mut spin = [0.0; 3];
        let ratio = (a * (b - a) / (c * (c - b))).sqrt();
        let ratio = if ratio.is_finite() { ratio } else { 1.0 };
        (spin[at_a], spin[at_b]) = (w, other);
        spin[at_c] = w * ratio * if short { 1.0 + far } else { 1.0 - far };
        spin
    });
    let signs = [any::<bool>(), any::<bool>(), any::<bool>()];
    (prop_oneof![[rate(), rate(), rate()], separatrix.boxed()], signs)
        .prop_map(|(spin, signs)| std::array::from_fn(|k: usize| if signs[k] { -spin[k] } else { spin[k] }))
}

/// Moments in any order, and spins.
fn bodies() -> impl Strategy<Value = ([f64; 3], [f64; 3])> {
    (moments(), 0..6usize).prop_flat_map(|(i, order)| {
        let [x, y, z] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]][order];
        let i = [i[x], i[y], i[z]];
        (Just(i), spin(i))
    })
}

fn times() -> impl Strategy<Value = f64> {
    (size(-10..39), any::<bool>()).prop_map(|(t, minus)| if minus { -t } else { t })
}

fn momentum(moments: [f64; 3], omega: Bivector) -> Bivector {
    Bivector(std::array::from_fn(|k| moments[k] * omega.0[k]))
}

/// No rate of turning is larger than `G/i` of the smallest moment.
fn fastest(moments: [f64; 3], omega: [f64; 3]) -> f64 {
    momentum(moments, Bivector(omega)).norm() / moments.into_iter().fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// L in space and the energy, each component of the spin off by a few roundings of its amplitude.
    #[test]
    fn momentum_energy_and_norm_stay((i, w) in bodies(), t in times()) {
        let motion = FreeMotion::in_principal_axes(i, start(), Bivector(w));
        prop_assume!(t.abs() <= motion.horizon());
        let (rotor, omega) = motion.at(t);
        let norm = rotor.components().iter().map(|x| x * x).sum::<f64>();
        prop_assert!((norm - 1.0).abs() <= 4.0 * EPS, "|R|² − 1 = {:e}", norm - 1.0);
        let first = start().apply_bivector(momentum(i, Bivector(w)));
        let change = (rotor.apply_bivector(momentum(i, omega)) - first).norm();
        prop_assert!(change <= 32.0 * EPS * first.norm(), "L off by {:e} of {:e}", change, first.norm());
        let energy = |w: Bivector| (0..3).map(|k| i[k] * w.0[k] * w.0[k]).sum::<f64>();
        let change = energy(omega) - energy(Bivector(w));
        prop_assert!(change.abs() <= 32.0 * EPS * energy(omega), "E off by {change:e}");
    }

    /// The motion passes through its start, and restarted from a later state it continues. Rounded states are off by some
    /// roundings, e-fold after the fastest radian. (A small component of the spin is rounded in u0, which shifts the
    /// others by some roundings.)
    #[test]
    fn the_flow_is_a_group((i, w) in bodies(), t in times(), part in -1.0..1.0f64) {
        let motion = FreeMotion::in_principal_axes(i, start(), Bivector(w));
        prop_assume!(t.abs() <= 0.5 * motion.horizon());
        let now = motion.at(0.0);
        prop_assert!(largest((0..4).map(|k| now.0.components()[k] - start().components()[k])) <= 8.0 * EPS);
        prop_assert!(largest((0..3).map(|k| now.1.0[k] - w[k])) <= 32.0 * EPS * largest(w));
        let later = t + part / fastest(i, w).max(1e-3);
        let (rotor, omega) = motion.at(t);
        let on = FreeMotion::in_principal_axes(i, rotor, omega).at(later - t);
        let all = motion.at(later);
        let size = largest(all.1.0);
        let change = largest((0..4).map(|k| on.0.components()[k] - all.0.components()[k]));
        prop_assert!(change <= 100.0 * EPS, "rotor off by {change:e}");
        let change = largest((0..3).map(|k| on.1.0[k] - all.1.0[k]));
        prop_assert!(change <= 100.0 * EPS * size.max(largest(omega.0)), "spin off by {change:e}");
    }

    /// `R' = −½ R Ω`, which no jump of the rotor's sign could satisfy, over several periods.
    #[test]
    fn the_rotor_turns_with_the_spin((i, w) in bodies(), first in -10.0..10.0f64) {
        let motion = FreeMotion::in_principal_axes(i, start(), Bivector(w));
        let period = motion.describe().period.unwrap_or(1.0).min(1e6);
        let h = 1e-4 / fastest(i, w).max(1e-3);
        for k in 0..40 {
            let t = first + f64::from(k) * 0.062_5 * period;
            let (before, after) = (motion.at(t - h).0.components(), motion.at(t + h).0.components());
            let (rotor, omega) = motion.at(t);
            let elapsed = (t + h) - (t - h);
            let turned = (rotor * Rotor::exp(omega * (-0.5 * elapsed))).components();
            let middle = rotor.components();
            for c in 0..4 {
                // To third order in the step: (R+ − R−) = (turned − R) + second derivative, which is below 1.
                let error = (after[c] - before[c]) - (turned[c] - middle[c]);
                prop_assert!(error.abs() <= 1e-7 + EPS * t.abs() * fastest(i, w), "{error:e} at {t}");
            }
        }
    }

    /// For one time or many, on lanes of any width, shared by threads: the same bits.
    #[test]
    fn many_times_give_the_same_bits((i, w) in bodies(), t in times(), count in 0..70usize) {
        let motion = FreeMotion::in_principal_axes(i, start(), Bivector(w));
        let times: Vec<f64> = (0..count).map(|k| t + k as f64).collect();
        let (mut rotors, mut omegas) = (vec![0.0; 4 * count], vec![0.0; 3 * count]);
        motion.at_many(Threads::new(2), &times, &mut rotors, &mut omegas);
        for (k, &t) in times.iter().enumerate() {
            let (rotor, omega) = motion.at(t);
            prop_assert_eq!(rotor.components(), &rotors[4 * k..4 * k + 4]);
            prop_assert_eq!(omega.0, &omegas[3 * k..3 * k + 3]);
        }
    }
}

/// Each branch of the separatrix starts and ends at the right pole.
#[test]
fn the_separatrix_ends_in_the_middle_axis() {
    for signs in 0..8 {
        let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
        let omega = [0.375 * sign(0), 0.5 * sign(1), 0.5 * sign(2)];
        let motion = FreeMotion::in_principal_axes([1.0, 2.0, 2.25], start(), Bivector(omega));
        assert_eq!(motion.describe().regime, Regime::Separatrix);
        // ω2' = ω3 ω1 (i3 − i1)/i2 keeps its sign.
        let (past, future) = (motion.at(-300.0).1.0, motion.at(300.0).1.0);
        let end = (0.601_562_5f64).sqrt() * sign(0) * sign(2);
        assert!((future[1] - end).abs() <= 4.0 * EPS && (past[1] + end).abs() <= 4.0 * EPS);
        for t in [-120.0, 120.0, 1e12] {
            let [x, _, z] = motion.at(t).1.0;
            assert!(x.abs() < 1e-5 && z.abs() < 1e-5 && x * sign(0) >= 0.0 && z * sign(2) >= 0.0);
        }
    }
}

/// On the separatrix, whose series has no period: L in space stays, and `R' = −½ R Ω`, which also shows the turn about L. The
/// middle moment is not a power of two.
#[test]
fn rotors_turn_with_the_spin_on_the_separatrix() {
    let (i, h) = ([3.75, 5.0, 7.5], 1e-4);
    for signs in 0..8 {
        let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
        let omega = Bivector([2.0 * sign(0), 0.5 * sign(1), sign(2)]);
        let motion = FreeMotion::in_principal_axes(i, start(), omega);
        assert_eq!(motion.describe().regime, Regime::Separatrix);
        let first = start().apply_bivector(momentum(i, omega));
        for t in [-20.0, -1.5, 0.75, 3.0, 1e3] {
            let (rotor, omega) = motion.at(t);
            let change = rotor.apply_bivector(momentum(i, omega)) - first;
            assert!(change.norm() <= 16.0 * EPS * first.norm(), "{signs} {t} {:e}", change.norm());
            // Between t − h and t + h it turns by 2hΩ, up to h³ times second derivatives of Ω.
            let turn = motion.at(t - h).0.reverse() * motion.at(t + h).0;
            let [_, x, y, z] = turn.components();
            let apart = Bivector([x, y, z]) / -h - omega;
            assert!(apart.norm() <= 1e-6, "{signs} {t} {:e}", apart.norm());
        }
    }
}

/// At 1e16 s after its start the time since then is a multiple of 2 s and a rest, in which the body turns by radians: the
/// states are those of the motion that goes on from the first.
#[test]
fn a_motion_long_after_its_start_keeps_its_phase() {
    let (i, omega) = ([1.25, 1.75, 2.5], Bivector([2.0, -11.0, 16.0]));
    let inertia = Inertia::from_principal_moments(i).unwrap();
    let problem = Problem::new(&inertia, start(), omega, &[]).starting_at(-1e16);
    let times = [0.0, 0.125, 0.625, 0.9375, 1.5];
    let states = problem.simulate(&times, Options::default(), &mut |_| true).unwrap().states();
    let from_zero = FreeMotion::in_principal_axes(i, states.rotors[0], states.omegas[0]);
    for (k, &t) in times.iter().enumerate() {
        let (rotor, omega) = from_zero.at(t);
        let change = largest((0..4).map(|c| rotor.components()[c] - states.rotors[k].components()[c]));
        assert!(change <= 1e-12, "rotor off by {change:e} at {t}");
        assert!((omega - states.omegas[k]).norm() <= 1e-12 * omega.norm(), "{t}");
    }
}

/// The modified moments of the Moser–Veselov step leave an error of order 4 in the phase, for moments of any size.
#[test]
fn moser_veselov_follows_the_free_top_to_fourth_order() {
    let (i, omega) = ([1.25, 1.75, 2.5], Bivector([0.5, -0.75, 1.0]));
    let inertia = Inertia::from_principal_moments(i).unwrap();
    let exact = FreeMotion::in_principal_axes(i, start(), omega).at(4.0);
    let error = |step: f64| {
        let options = Options { method: Some(Method::MoserVeselov), step: Some(step), ..Options::default() };
        let motion =
            Problem::new(&inertia, start(), omega, &[]).simulate(&[4.0], options, &mut |_| true).unwrap();
        let states = motion.states();
        largest((0..4).map(|c| exact.0.components()[c] - states.rotors[0].components()[c]))
    };
    let (coarse, fine) = (error(0.1), error(0.05));
    assert!(coarse < 1e-4 && (coarse / fine).log2() > 3.8, "{coarse:e} {fine:e}");
}

/// A motion is known up to a number of turns from its start, wherever that is on the axis of time.
#[test]
fn horizons_begin_at_the_start() {
    let inertia = Inertia::from_principal_moments([1.25, 1.75, 2.5]).unwrap();
    let omega = Bivector([2.0, -11.0, 16.0]);
    let most = FreeMotion::in_principal_axes([1.25, 1.75, 2.5], start(), omega).horizon();
    let solve = |from: f64, to: f64| {
        let problem = Problem::new(&inertia, start(), omega, &[]).starting_at(from);
        problem.simulate(&[to], Options::default(), &mut |_| true).map(|_| ())
    };
    for sign in [1.0, -1.0] {
        assert_eq!(solve(0.6 * most * sign, 1.2 * most * sign), Ok(()));
        let beyond = solve(-0.6 * most * sign, 0.6 * most * sign);
        assert!(matches!(beyond, Err(SimulateError::BeyondHorizon { index: 0, .. })), "{beyond:?}");
    }
}

#[test]
fn times_and_options_must_be_valid() {
    let inertia = Inertia::from_principal_moments([1.25, 1.75, 2.5]).unwrap();
    let solve = |from: f64, times: &[f64], options: Options| {
        let problem = Problem::new(&inertia, start(), Bivector([0.5, 1.0, 0.25]), &[]).starting_at(from);
        problem.simulate(times, options, &mut |_| true).map(|_| ())
    };
    for (times, bad) in [(&[1.0, 0.5][..], 1), (&[0.0, 1.0, f64::NAN], 2), (&[f64::INFINITY], 0)] {
        let refused = solve(0.0, times, Options::default());
        assert!(matches!(refused, Err(SimulateError::BadTime { index, .. }) if index == bad), "{refused:?}");
    }
    assert_eq!(solve(0.0, &[-1.0, 0.0, 0.0, 2.0], Options::default()), Ok(()));
    let refused = solve(f64::NAN, &[1.0], Options::default());
    assert!(matches!(refused, Err(SimulateError::BadValue { what: "the time of the start", .. })));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for (what, options) in [
            ("step", Options { step: Some(value), ..Options::default() }),
            ("rtol", Options { rtol: Some(value), ..Options::default() }),
            ("max_step", Options { max_step: Some(value), ..Options::default() }),
            ("max_steps", Options { max_steps: Some(value), ..Options::default() }),
        ] {
            let refused = solve(0.0, &[1.0], options);
            assert!(matches!(refused, Err(SimulateError::BadValue { what: named, .. }) if named == what));
        }
    }
}

/// In a step the classical method evaluates the torque four times, the Störmer–Verlet method before and after the drift.
#[test]
fn certificates_count_evaluations() {
    let inertia = Inertia::from_principal_moments([1.25, 1.75, 2.5]).unwrap();
    let problem = Problem::new(&inertia, start(), Bivector([0.5, 1.0, 0.25]), &[]);
    let strang = methods().find(|method| method.name() == "strang").unwrap();
    for (method, each) in [(Method::Classical, 4), (strang, 2)] {
        let options = Options { method: Some(method), step: Some(0.125), ..Options::default() };
        let certificate = problem.simulate(&[1.0], options, &mut |_| true).unwrap().certificate;
        assert_eq!((certificate.steps, certificate.evaluations), (8, 8 * each), "{method:?}");
    }
}
