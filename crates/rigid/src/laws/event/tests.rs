use super::*;

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
