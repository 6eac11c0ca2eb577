//! Lagrange's top: against states computed by other formulas to 34 digits, and against conservation laws.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::exact::lagrange::{LagrangeRegime, LagrangeTop};
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::run::{Options, Problem};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const EPS: f64 = f64::EPSILON;

fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    // NaN is the largest of all.
    numbers.into_iter().fold(0.0, |m: f64, x| if x.is_nan() { x } else { m.max(x.abs()) })
}

/// Tolerance of the rate in roundings. Near the unstable upright the tilt grows as `θ e^{λt}` in a period of about
/// `ln (8/θ)`, whose rounding adds to that of the rate.
fn roundings(kind: &str, [s, x, y, z]: [f64; 4]) -> f64 {
    let tilt = s.hypot(z).min(x.hypot(y));
    if kind.starts_with("vertical_up") && tilt > 0.0 { 8.0 - (tilt / 8.0).ln() } else { 8.0 }
}

/// Phases are known to half a rounding, series and products add some: 8 in all.
#[test]
fn states_of_every_kind_at_any_time() {
    for line in include_str!("data/lagrange_states.txt").lines() {
        let (kind, numbers) = line.split_once(' ').unwrap();
        let x: Vec<f64> = numbers.split(' ').map(|x| x.parse().unwrap()).collect();
        let inertia = Inertia::from_principal_moments([x[0], x[1], x[2]]).unwrap();
        let rotor = Rotor::from_components([x[6], x[7], x[8], x[9]]).unwrap();
        let (c, omega) = (Vector([x[3], x[4], x[5]]), Bivector([x[10], x[11], x[12]]));
        let (rotor, omega) = LagrangeTop::new(&inertia, rotor, omega, c).unwrap().at(x[13]);
        let apart = |found: &[f64], expected: &[f64]| {
            let pairs = found.iter().zip(expected.as_chunks::<2>().0);
            largest(pairs.map(|(found, [high, low])| (found - high) - low))
        };
        let rotor_error = apart(&rotor.components(), &x[14..22]);
        let omega_error = apart(&omega.0, &x[22..]) / largest(x[22..].iter().copied());
        assert!(rotor_error <= 8.0 * EPS, "{kind}: rotor off by {rotor_error:e} at {}", x[13]);
        let most = roundings(kind, [x[6], x[7], x[8], x[9]]) * EPS;
        assert!(omega_error <= most, "{kind}: spin off by {omega_error:e} at {}", x[13]);
    }
}

/// Powers of two times a number near 1, of either sign.
fn rate(exponents: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    (exponents, 1.0..2.0f64, prop::bool::ANY)
        .prop_map(|(e, x, minus)| if minus { -x } else { x } * 2f64.powi(e))
}

/// i3, rotor, angular velocity and c of a top with the moments 1 and 1; rates up to 8.
fn tops() -> impl Strategy<Value = (f64, [f64; 4], [f64; 3], f64)> {
    let small = || prop_oneof![Just(0.0), rate(-40..2), rate(-3..2)];
    let component = || prop_oneof![Just(0.0), rate(-40..1), rate(-3..1)];
    let rotor = [component(), component(), component(), component()];
    let omega = (small(), small(), rate(-8..2)).prop_map(|(x, y, z)| [x, y, z]);
    (0.1..2.0f64, rotor, omega, rate(-40..3)).prop_filter("no rotor", |(_, r, ..)| largest(*r) > 1e-3)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    /// The start is met; energy, L3 and Lz stay up to t = 1e12, as far as roundings of R and Ω let them; one time or
    /// many, the same bits.
    #[test]
    fn integrals_stay((i3, r, w, c) in tops(), t in -1e12..1e12f64, near in -30.0..30.0f64) {
        let inertia = Inertia::from_principal_moments([1.0, 1.0, i3]).unwrap();
        let (rotor, omega, c) = (Rotor::from_components(r).unwrap(), Bivector(w), Vector([0.0, 0.0, c]));
        let top = LagrangeTop::new(&inertia, rotor, omega, c);
        prop_assume!(top.is_ok());
        let top = top.unwrap();
        let speed = (omega.norm() + c.norm().sqrt()) * (1.0 + i3);
        let (first, spin) = top.at(0.0);
        prop_assert!(largest((0..4).map(|k| first.components()[k] - rotor.components()[k])) <= 8.0 * EPS);
        prop_assert!(largest((0..3).map(|k| spin.0[k] - w[k])) <= 16.0 * EPS * speed);
        let integrals = |(r, w): (Rotor, Bivector)| {
            let momentum = inertia.apply(w);
            let gamma = r.reverse().apply(Vector([0.0, 0.0, 1.0]));
            [0.5 * w.0.iter().zip(momentum.0).map(|(w, l)| w * l).sum::<f64>() + gamma.dot(c), momentum.0[2],
             r.apply_bivector(momentum).0[2]]
        };
        let (start, scales) = (integrals((rotor, omega)), [speed * speed, speed, speed]);
        for t in [t, near] {
            let now = integrals(top.at(t));
            for k in 0..3 {
                prop_assert!((now[k] - start[k]).abs() <= 64.0 * EPS * scales[k], "{} at {}", k, t);
            }
        }
        let (mut rotors, mut omegas) = ([0.0; 8], [0.0; 6]);
        top.at_many(Threads::new(1), &[t, near], &mut rotors, &mut omegas);
        prop_assert_eq!(&rotors[4..], &top.at(near).0.components()[..]);
        prop_assert_eq!(&omegas[..3], &top.at(t).1.0[..]);
    }

    /// `R' = −½ R Ω`, by central differences of order 4.
    #[test]
    fn the_rate_of_the_rotor_is_the_spin((i3, r, w, c) in tops(), t in -30.0..30.0f64) {
        let inertia = Inertia::from_principal_moments([1.0, 1.0, i3]).unwrap();
        let (rotor, omega, c) = (Rotor::from_components(r).unwrap(), Bivector(w), Vector([0.0, 0.0, c]));
        let top = LagrangeTop::new(&inertia, rotor, omega, c);
        prop_assume!(top.is_ok());
        let top = top.unwrap();
        let speed = (omega.norm() + 2.0 * c.norm().sqrt()) * (1.0 + i3);
        let h = 2f64.powi(-9) / speed;
        let at = |k: f64| top.at(t + k * h).0.components();
        let (a, b, c, d) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
        let (now, spin) = top.at(t);
        let rate = now.reverse();
        // −2 ~R R' is Ω: the slope in the rotor's own axes.
        let slope: [f64; 4] = std::array::from_fn(|k| (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * h));
        let found = rate * Rotor::from_unit_components(slope.map(|x| -2.0 * x));
        let [_, x, y, z] = found.components();
        let bound = speed * 2f64.powi(-36) * 4.0 + 64.0 * EPS * (1.0 + speed * (1.0 + t.abs())) / h;
        prop_assert!(largest([x - spin.0[0], y - spin.0[1], z - spin.0[2]]) <= bound);
    }
}

/// From every tilt that a float can have to the vertical, and with every push, the solution exists, and so does its
/// rate: its part across the axis obeys `i1 |w|² + 2cu = const` beside its own size.
#[test]
fn no_start_beside_the_vertical_is_refused() {
    let inertia = Inertia::from_principal_moments([1.0, 1.0, 0.5]).unwrap();
    let c = Vector([0.0, 0.0, 1.0]);
    let tilts =
        [0.0, 5e-324, 1e-310, 1e-300, 1e-200, 1e-154, 1e-80, 1e-60, 1e-40, 1e-30, 1e-21, 1e-16, 1e-12, 1e-8];
    let spins = [0.0, 3.0, 4.0, 4.0 * (1.0 + EPS), 8.0];
    for (tilt, push, spin, up) in starts(&tilts, &spins) {
        let r = if up { [1.0, tilt, 0.5 * tilt, 0.0] } else { [tilt, 1.0, 0.0, -0.5 * tilt] };
        let rotor = Rotor::from_components(r).unwrap();
        let omega = Bivector([push, -0.5 * push, spin]);
        let top = LagrangeTop::new(&inertia, rotor, omega, c);
        let top = top.unwrap_or_else(|error| panic!("{tilt:e} {push:e} {spin} {up}: {error}"));
        let (first, rate) = top.at(0.0);
        assert!(largest((0..4).map(|k| first.components()[k] - rotor.components()[k])) <= 8.0 * EPS);
        // The series have no numbers below e^−700.
        let across = largest([tilt, push]).max(1e-304);
        let most = 1e3 * EPS * across.max(spin * EPS) + 1e-303;
        assert!(largest((0..2).map(|k| rate.0[k] - omega.0[k])) <= most, "{tilt:e} {push:e} {spin} {up}");
        for t in [0.3, 2.0, 20.0] {
            let (_, rate) = top.at(t);
            // A tilt grows at most like e^t, the rate with it.
            assert!(
                rate.0[0].hypot(rate.0[1]) <= 8.0 * across.max(1e-303) * f64::exp(t),
                "{tilt:e} {push:e} {spin} {up} {t}"
            );
        }
    }
}

/// Tilts, pushes, spins, and whether upright.
fn starts<'a>(tilts: &'a [f64], spins: &'a [f64]) -> impl Iterator<Item = (f64, f64, f64, bool)> + 'a {
    let pushed = tilts.iter().flat_map(|&tilt| [0.0, 0.1 * tilt, 1e-100, 1e-5].map(|push| (tilt, push)));
    let spun = pushed.flat_map(|(tilt, push)| spins.iter().map(move |&spin| (tilt, push, spin)));
    spun.flat_map(|(tilt, push, spin)| [true, false].map(|up| (tilt, push, spin, up)))
}

/// Neglected asymmetry by rounding is reported as an angle; near the upright it grows with the fall.
#[test]
fn neglected_asymmetry() {
    let top = |moments: [f64; 3], c: [f64; 3], r: [f64; 4]| {
        let inertia = Inertia::from_principal_moments(moments).unwrap();
        let rotor = Rotor::from_components(r).unwrap();
        LagrangeTop::new(&inertia, rotor, Bivector([0.0, 0.0, 3.0]), Vector(c)).unwrap()
    };
    let (even, tilted, off) = ([1.0, 1.0, 0.5], [2.0, 1.0, 0.0, 0.0], 4.0 * EPS);
    assert_eq!(top(even, [0.0, 0.0, 1.0], tilted).neglected(1e6), 0.0);
    let uneven = top([1.0, 1.0 + off, 0.5], [0.0, 0.0, 1.0], tilted).neglected(1e6);
    assert!(uneven >= off * 3.0 * 1e6 && uneven <= off * 1e8, "{uneven:e}");
    let aside = top(even, [off, 0.0, 1.0], tilted).neglected(1e6);
    assert!(aside >= off * 1e6 && aside <= off * 1e8, "{aside:e}");
    // Upright and unstable: λ² = c/i1 − (i3 ω3/2i1)².
    let falling = top(even, [off, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]);
    let growth = (1.0 - 0.75f64 * 0.75).sqrt();
    let angle = falling.neglected(40.0);
    assert!(angle >= off * (growth * 40.0).exp() && angle <= off * 1e4 * (growth * 40.0).exp(), "{angle:e}");
    // Asleep above ω3 = 2 √(c i1)/i3, where it does not grow.
    let inertia = Inertia::from_principal_moments(even).unwrap();
    let turning = Bivector([0.0, 0.0, 5.0]);
    let asleep = LagrangeTop::new(&inertia, Rotor::IDENTITY, turning, Vector([off, 0.0, 1.0])).unwrap();
    let angle = asleep.neglected(1e6);
    assert!(angle >= off * 1e6 && angle <= off * 1e8, "{angle:e}");
}

/// What is neglected is the error estimate of the motion, and too much for a smaller tolerance.
#[test]
fn a_neglected_asymmetry_is_an_error_estimate() {
    let (off, omega) = (4.0 * EPS, Bivector([0.5, 0.0, 3.0]));
    let solve = |moments: [f64; 3], rtol: Option<f64>, t: f64| {
        let inertia = Inertia::from_principal_moments(moments).unwrap();
        let weight = Torque::Heavy(Vector([0.0, 0.0, 1.0]));
        let problem = Problem::new(&inertia, Rotor::IDENTITY, omega, &[weight]);
        let options = Options { rtol, ..Options::default() };
        problem.simulate(&[t], options, &mut |_| true).unwrap().certificate
    };
    let long = solve([1.0, 1.0 + off, 0.5], None, 1e6);
    assert_eq!(long.method, "exact");
    let estimate = long.error_estimate.unwrap();
    assert!(estimate >= off * 3.0 * 1e6 && estimate <= off * 1e8, "{estimate:e}");
    assert_eq!(solve([1.0, 1.0 + off, 0.5], Some(1e-12), 1.0).method, "exact");
    assert_eq!(solve([1.0, 1.0, 0.5], None, 1e6).error_estimate, None);
}

#[test]
fn horizon_and_regime() {
    let inertia = Inertia::from_principal_moments([1.0, 1.0, 0.5]).unwrap();
    let up = Vector([0.0, 0.0, 1.0]);
    let top = LagrangeTop::new(&inertia, Rotor::IDENTITY, Bivector([0.0, 0.0, 3.0]), up).unwrap();
    assert_eq!(top.describe().regime, LagrangeRegime::Upright);
    assert!(!top.describe().sleeps && top.horizon() > 1e16);
    let top = LagrangeTop::new(&inertia, Rotor::IDENTITY, Bivector([0.5, 0.0, 3.0]), up).unwrap();
    assert!(top.horizon() > 1e16 && top.horizon() < 1e18);
    // Without weight the tilt is that of e3 of the body, too.
    let tilted = Rotor::from_components([3f64.sqrt(), 1.0, 0.0, 0.0]).unwrap();
    let top = LagrangeTop::new(&inertia, tilted, Bivector([0.0, 0.0, 3.0]), Vector::default()).unwrap();
    assert!((top.describe().tilt_min - std::f64::consts::FRAC_PI_3).abs() <= 4.0 * EPS);
}

/// Through the lower pole `L_z = −L3`, so that the rate of precession `(L_z − L3 u)/i1(1 − u²) = −L3/i1(1 − u)` never changes
/// its sign; the same at the upper one with `L3/i1(1 + u)`.
#[test]
fn tops_through_a_pole_precess_one_way() {
    let inertia = Inertia::from_principal_moments([1.0, 1.0, 0.5]).unwrap();
    let up = Vector([0.0, 0.0, 1.0]);
    let hanging = Rotor::from_components([0.0, 1.0, 0.0, 0.0]).unwrap();
    for spin in [3.0, -3.0] {
        for (rotor, side) in [(hanging, -1.0), (Rotor::IDENTITY, 1.0)] {
            let top = LagrangeTop::new(&inertia, rotor, Bivector([1.0, 0.0, spin]), up).unwrap();
            let found = top.describe();
            assert_eq!(found.regime, LagrangeRegime::Waves);
            let rate = |tilt: f64| side * 0.5 * spin / (1.0 + side * tilt.cos());
            let (one, other) = (rate(found.tilt_min), rate(found.tilt_max));
            let mean = found.precession_rate.unwrap();
            assert!(mean > one.min(other) && mean < one.max(other), "{one} {mean} {other}");
            // Beside the pole, where the rate is large and not zero.
            for tilt in [1e-4, -1e-4, 1e-8, -1e-8] {
                let beside = rotor * Rotor::from_components([1.0, tilt, 2.0 * tilt, 0.0]).unwrap();
                let top = LagrangeTop::new(&inertia, beside, Bivector([1.0, 0.0, spin]), up).unwrap();
                let regime = top.describe().regime;
                assert!(
                    matches!(regime, LagrangeRegime::Waves | LagrangeRegime::Loops),
                    "{regime:?} {tilt:e}"
                );
            }
        }
    }
}

/// With `L_z = L3` and the energy of the upright top it rises for ever: from `1 + u = L3²/2c i1`, here the horizontal, where
/// it precesses with `L3/i1`. Energy and `L_z` stay, and `R' = −½ R Ω`.
#[test]
fn a_spinning_top_rises_for_ever_on_the_separatrix() {
    let (moments, c, h) = ([1.0, 1.0, 0.5], 2.0, 1e-4);
    let inertia = Inertia::from_principal_moments(moments).unwrap();
    for (x, precession, spin) in [(1.0, 2.0, 4.0), (-1.0, -2.0, 4.0), (1.0, -2.0, -4.0), (-1.0, 2.0, -4.0)] {
        let rotor = Rotor::from_components([1.0, x, 0.0, 0.0]).unwrap();
        let omega = Bivector([0.0, -precession, spin]);
        let top = LagrangeTop::new(&inertia, rotor, omega, Vector([0.0, 0.0, c])).unwrap();
        assert_eq!(top.describe().regime, LagrangeRegime::Separatrix);
        for t in [-30.0, -2.0, 0.0, 0.5, 3.0, 12.0] {
            let (rotor, omega) = top.at(t);
            let u = rotor.apply(Vector([0.0, 0.0, 1.0])).0[2];
            let momentum = Bivector([0, 1, 2].map(|k| moments[k] * omega.0[k]));
            let energy = 0.5 * (0..3).map(|k| moments[k] * omega.0[k] * omega.0[k]).sum::<f64>() + c * u;
            assert!((energy - 6.0).abs() <= 64.0 * EPS, "{t} {energy}");
            let vertical = rotor.apply_bivector(momentum).0[2];
            assert!((vertical - 0.5 * spin).abs() <= 64.0 * EPS, "{t} {vertical}");
            assert!(u >= -8.0 * EPS && (t.abs() < 10.0 || u > 1.0 - 1e-6), "{t} {u}");
            // Between t − h and t + h it turns by 2hΩ, up to h³ times second derivatives of Ω.
            let [_, x, y, z] = (top.at(t - h).0.reverse() * top.at(t + h).0).components();
            let apart = Bivector([x, y, z]) / -h - omega;
            assert!(apart.norm() <= 1e-6, "{t} {:e}", apart.norm());
        }
    }
}
