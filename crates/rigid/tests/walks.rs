//! Runs: progress, interruption, and functions as forces and events.

use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::error::TorqueError;
use polhode_rigid::laws::event::{Direction, Event, Quantity};
use polhode_rigid::laws::force::Force;
use polhode_rigid::methods::Method;
use polhode_rigid::run::{Options, Problem};
use polhode_rigid::state::center::Center;
use polhode_rigid::state::point::Function;

fn problem() -> Problem {
    let inertia = Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap();
    Problem::new(&inertia, Rotor::IDENTITY, Bivector([0.25, -0.5, 1.0]), &[])
}

#[test]
fn progress_rises_over_both_signs_of_time() {
    let mut seen = Vec::new();
    let options = Options { step: Some(1.0 / 64.0), ..Options::default() };
    let motion = problem().simulate(&[-100.0, -50.0, 30.0, 200.0], options, &mut |at| {
        seen.push(at.fraction);
        assert_eq!(at.pass, 1);
        true
    });
    assert_eq!(motion.unwrap().certificate.steps, 300 * 64);
    // Once every 256 steps: 19,200 of them.
    assert_eq!(seen.len(), 75);
    assert!(seen.is_sorted_by(|a, b| a < b) && seen[0] > 0.0 && seen[74] == 1.0, "{seen:?}");
}

#[test]
fn a_run_can_be_stopped() {
    let mut calls = 0;
    let options = Options { step: Some(1.0 / 64.0), ..Options::default() };
    let motion = problem().simulate(&[1e6], options, &mut |_| {
        calls += 1;
        calls < 3
    });
    assert!(motion.is_err());
    assert_eq!(calls, 3);
}

/// `x'' = −x` from 1: zeros at the odd quarters, by a function of the force and one of the event.
#[test]
fn functions_of_forces_and_events() {
    let spring = Force::Function(Function::new(|seen| Ok(seen.position * -2.0)));
    let center = Center { position: Vector([1.0, 0.0, 0.0]), velocity: Vector::default() };
    let quantity = Quantity::Function(Function::new(|seen| Ok(seen.position.0[0])));
    let events = vec![Event { quantity, direction: Some(Direction::Falling), terminal: false }];
    let options = Options { events, ..Options::default() };
    let motion = problem().with_center(center, 2.0, &[spring]).simulate(&[-9.0, 9.0], options, &mut |_| true);
    let motion = motion.unwrap();
    let times = motion.event_states().times;
    let quarter = std::f64::consts::FRAC_PI_2;
    let expected = [-1.0, -5.0, 1.0, 5.0].map(|k| k * quarter);
    assert_eq!(times.len(), 4);
    let error = motion.certificate.error_estimate.unwrap();
    assert!(times.iter().zip(expected).all(|(t, e)| (t - e).abs() <= 10.0 * error), "{times:?}");
    assert!(motion.events.iter().all(|occurrence| occurrence.direction == Direction::Falling));
}

/// Zeros exactly at a sample: the end of a step, the end of the motion, the middle and the quarter of a step.
#[test]
fn a_touch_is_not_a_crossing() {
    type Curve = fn(f64) -> f64;
    let curves: [(Curve, Option<f64>); 5] = [
        (|t| t * t, None),
        (|t| -t.abs(), None),
        (|t| t, Some(0.0)),
        (|t| -t.powi(3), Some(0.0)),
        (|t| t * t * (1.0 - t), Some(1.0)),
    ];
    let runs =
        [(2.0, &[1.0, 2.0, 4.0][..], 0.5), (2.0, &[2.0], 0.5), (2.125, &[4.0], 0.25), (2.25, &[4.0], 0.5)];
    for (case, (curve, crossed)) in curves.into_iter().enumerate() {
        for (zero, times, step) in runs {
            let end = times[times.len() - 1];
            let expected: Vec<f64> = crossed.map(|t| zero + t).into_iter().filter(|t| *t <= end).collect();
            for terminal in [false, true] {
                let quantity = Quantity::Function(Function::new(move |seen| Ok(curve(seen.time - zero))));
                let events = vec![Event { quantity, direction: None, terminal }];
                let options = Options { events, step: Some(step), ..Options::default() };
                let motion = problem().simulate(times, options, &mut |_| true).unwrap();
                assert_eq!(motion.event_states().times, expected, "{case} {zero} {terminal}");
                let ended = expected.first().filter(|_| terminal);
                let kept = times.iter().filter(|time| ended.is_none_or(|end| *time <= end));
                assert!(motion.states().times.iter().eq(kept), "{case} {zero} {terminal}");
            }
        }
    }
}

/// A function need not have a value beyond the end of the motion.
#[test]
fn a_zero_at_the_end_is_a_crossing_where_nothing_is_known_beyond() {
    let quantity = Quantity::Function(Function::new(|seen| match seen.time {
        t if t <= 2.0 => Ok(t - 2.0),
        _ => Err(TorqueError::new("too late")),
    }));
    let events = vec![Event { quantity, direction: None, terminal: false }];
    let motion = problem().simulate(&[2.0], Options { events, ..Options::default() }, &mut |_| true);
    assert_eq!(motion.unwrap().event_states().times, [2.0]);
}

#[test]
fn errors_have_a_time() {
    let late = |seen: &polhode_rigid::state::point::Seen| {
        if seen.time > 0.5 { Err(TorqueError::new("too late")) } else { Ok(Vector::default()) }
    };
    let late = [Force::Function(Function::new(late))];
    let motion = problem().with_center(Center::default(), 1.0, &late).simulate(
        &[1.0],
        Options::default(),
        &mut |_| true,
    );
    let message = motion.unwrap_err().to_string();
    assert!(message.starts_with("at t = ") && message.ends_with("too late"), "{message}");
    let drag = [Force::QuadraticDrag(1.0)];
    for name in ["strang", "midpoint", "dmv"] {
        let options = Options { method: Method::from_name(name), ..Options::default() };
        let motion =
            problem().with_center(Center::default(), 1.0, &drag).simulate(&[1.0], options, &mut |_| true);
        assert!(motion.unwrap_err().to_string().contains("forces"), "{name}");
    }
}
