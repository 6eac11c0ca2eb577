use super::*;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};

#[test]
fn roots_are_found_to_the_spacing() {
    let find = |f: &dyn Fn(f64) -> f64, low: f64, high: f64| {
        let mut calls = 0;
        let root = root::<()>((low, high), (f(low), f(high)), 1e-15, |x| {
            calls += 1;
            Ok(f(x))
        });
        (root.unwrap(), calls)
    };
    let (x, calls) = find(&|x| x.cos() - x, 0.0, 1.0);
    assert!((x - 0.739_085_133_215_160_6).abs() < 2e-15 && calls < 20, "{x} {calls}");
    // A triple root, and a jump.
    let (x, _) = find(&|x| (x - 0.3).powi(3), 0.0, 1.0);
    assert!((x - 0.3).abs() < 1e-5);
    let (x, _) = find(&|x| if x < 0.7 { -1e-9 } else { 1e3 }, 0.0, 1.0);
    assert!((x - 0.7).abs() < 1e-14);
}

/// Two crossings between three samples.
#[test]
fn a_dip_below_zero_is_found() {
    let find = |f: &dyn Fn(f64) -> f64, times: [f64; 3]| {
        let mut calls = 0;
        let found = dip::<()>(times.map(|t| (t, f(t))), |t| {
            calls += 1;
            Ok(f(t))
        });
        (found.unwrap(), calls)
    };
    for (times, sign) in [([0.0, 0.2, 0.4], 1.0), ([0.4, 0.2, 0.0], -1.0)] {
        for lowest in [0.05, 0.11, 0.2, 0.3, 0.37] {
            for depth in [1e-3, 1e-6, 1e-9, 1e-12] {
                let below = |t: f64| sign * (1.0 - (t - lowest).cos() - depth);
                let (found, calls) = find(&below, times);
                let seen = times.iter().any(|&t| below(t) * sign < 0.0);
                assert!(seen || found.is_some_and(|(_, value)| value * sign < 0.0), "{lowest} {depth}");
                assert!(calls <= 12, "{calls}");
                let above = |t: f64| sign * (1.0 - (t - lowest).cos() + depth);
                let (found, calls) = find(&above, times);
                assert!(found.is_none() && calls <= 12, "{found:?} {calls}");
            }
        }
    }
    // Far from zero the function is not called.
    assert_eq!(find(&|t| 2.0 + t.cos(), [0.0, 0.2, 0.4]), (None, 0));
    assert_eq!(find(&|t| 2.0 - t.cos(), [-0.2, 0.0, 0.2]), (None, 0));
}

#[test]
fn crossings_are_counted_once() {
    assert_eq!(crossing(-1.0, 0.0), Some(Direction::Rising));
    assert_eq!(crossing(0.0, 1.0), None);
    assert_eq!(crossing(1.0, -1.0), Some(Direction::Falling));
    assert_eq!(crossing(f64::NAN, 1.0), None);
}

/// Values of a function at three times.
fn samples(times: [f64; 3], f: impl Fn(f64) -> f64) -> [(f64, f64); 3] {
    times.map(|t| (t, f(t)))
}

/// The first vertex is that of a parabola itself, forwards and backwards in time and with either sign.
#[test]
fn a_parabola_that_dips_is_found_at_its_vertex() {
    for (times, sign) in [([0.0, 0.7, 1.5], 1.0), ([1.5, 0.7, 0.0], 1.0), ([0.0, 1.1, 1.5], -1.0)] {
        for depth in [1e-2, 1e-6, 1e-10] {
            let f = |t: f64| sign * (3.0 * (t - 0.9).powi(2) - depth);
            let (at, value) = dip(samples(times, f), |t| Ok::<_, ()>(f(t))).unwrap().unwrap();
            // Divided differences of values of size 1 to 4 round the vertex to several of their ulps.
            assert!((at - 0.9).abs() <= 32.0 * f64::EPSILON, "{times:?} {at}");
            assert!(value * sign < 0.0 && value == f(at));
        }
    }
}

/// Vertices of parabolas converge to a minimum that is not of a parabola.
#[test]
fn narrow_dips_of_other_functions_are_found() {
    for (times, center) in [([0.0, 0.3, 1.0], 0.55), ([1.0, 0.4, 0.0], 0.35), ([0.0, 0.5, 1.0], 0.9)] {
        for depth in [1e-3, 1e-6, 1e-9] {
            let f = |t: f64| 1.0 - (t - center).cos() + 0.05 * (t - center).powi(3) - depth;
            let found = dip(samples(times, f), |t| Ok::<_, ()>(f(t))).unwrap();
            assert!(found.is_some_and(|(_, value)| value < 0.0), "{times:?} {depth} {found:?}");
        }
    }
}

/// Minima above zero and samples that bend the other way are given up, the latter without a value.
#[test]
fn samples_without_a_dip_are_given_up() {
    let calls = |times: [f64; 3], f: &dyn Fn(f64) -> f64| {
        let mut count = 0;
        let mut counted = |t| {
            count += 1;
            Ok::<_, ()>(f(t))
        };
        assert_eq!(dip(samples(times, f), &mut counted), Ok(None));
        count
    };
    let times = [0.0, 0.7, 1.5];
    assert_eq!(calls(times, &|t| (t - 0.9).powi(2) + 1.0), 0);
    assert_eq!(calls(times, &|t| 3.0 - (t - 0.9).powi(2)), 0);
    // The vertex lies beyond the next samples.
    assert_eq!(calls(times, &|t| (t - 4.0).powi(2) - 1.0), 0);
    assert_eq!(calls(times, &|t| t - 0.9), 0);
    assert!(calls(times, &|t| 1.0 - (t - 0.9).cos() + 1e-3) <= 4);
}

/// False position gains digits in proportion to the order 1.4 of the Illinois rule; bisection would take 52 values.
#[test]
fn roots_of_smooth_functions_take_few_values() {
    for (low, high, f) in [
        (0.0, 2.0, (|x| x * x * x - 2.0) as fn(f64) -> f64),
        (2.0, 0.0, |x| 2.0 - x * x * x),
        (0.0, 2.0, |x| x.exp() - 2.0_f64.cbrt().exp()),
        (-3.0, 2.0, |x| (-x).exp() - (-(2.0_f64.cbrt())).exp()),
    ] {
        let mut count = 0;
        let counted = |x| {
            count += 1;
            Ok::<_, ()>(f(x))
        };
        let found = root((low, high), (f(low), f(high)), 1e-14, counted).unwrap();
        assert!((found - 2.0_f64.cbrt()).abs() <= 2e-14, "{found}");
        assert!(count <= 20, "{count} values from {low} to {high}");
    }
}

/// The component of Ω along a plane is that of the axial vectors, in all three directions.
#[test]
fn the_spin_about_a_plane_is_a_component() {
    let body = Gyrostat::rigid([1.0, 2.0, 2.5]);
    let omega = Bivector([0.5, -0.25, 1.5]);
    let phase = Phase { rotor: Rotor::IDENTITY, momentum: body.momentum(omega), time: 0.0 };
    let at = Point { body: &body, mass: 1.0, phase: &phase, center: &Center::default() };
    for plane in [Bivector([1.0, 0.0, 0.0]), Bivector([0.0, 2.0, 0.0]), Bivector([3.0, -1.0, 2.0])] {
        let spin = Quantity::Spin { plane, level: 0.125 };
        assert_eq!(spin.value(&at), Ok(omega.dual().dot(plane.dual()) - 0.125));
    }
}
