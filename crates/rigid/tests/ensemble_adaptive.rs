//! Ensembles with adaptive steps, independent for each body.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::ensemble::{Ensemble, Failure, Outputs, Rows, Start, Summary};
use polhode_rigid::laws::force::Force;
use polhode_rigid::laws::torque::{Axes, Gains, Kind, Orbit, Table, Torque};
use polhode_rigid::methods::Method;
use polhode_rigid::run::{Options, Progress};
use polhode_rigid::state::center::Center;
use polhode_rigid::{Inertia, SimulateError};
use std::sync::Arc;

/// Everything that a run gives.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    rotors: Vec<f64>,
    omegas: Vec<f64>,
    momenta: Vec<f64>,
    energies: Vec<f64>,
    centers: Vec<f64>,
    summary: Summary,
}

fn run_with(
    ensemble: &Ensemble,
    times: &[f64],
    options: &Options,
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> bool,
) -> Result<Run, SimulateError> {
    let count = ensemble.starts.len() * times.len();
    let [mut rotors, mut omegas, mut momenta, mut energies, mut places, mut velocities] =
        [4, 3, 3, 1, 3, 3].map(|n| vec![-7.0; n * count]);
    let outputs = Outputs {
        rotors: &mut rotors,
        omegas: &mut omegas,
        momenta: &mut momenta,
        energies: &mut energies,
        centers: Some([&mut places, &mut velocities]),
    };
    let summary = ensemble.run(times, options, Threads::new(threads), outputs, progress)?;
    let centers = [places, velocities].concat();
    Ok(Run { rotors, omegas, momenta, energies, centers, summary })
}

fn run(ensemble: &Ensemble, times: &[f64], options: &Options) -> Run {
    run_with(ensemble, times, options, 2, &mut |_| true).unwrap()
}

fn dop853(rtol: f64) -> Options {
    Options { method: Method::from_name("dop853"), rtol: Some(rtol), ..Options::default() }
}

/// A pseudorandom number between 0 and 1.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// Bodies of many shapes and starts under the same laws, whose principal axes are not those of the body.
fn bodies(count: usize, laws: Vec<Torque>) -> Ensemble {
    let mut seed = 7;
    let mut next = || 2.0 * random(&mut seed) - 1.0;
    let (mut inertias, mut starts) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let moments = [2.0 + 0.5 * next(), 3.0 + 0.5 * next(), 3.5 + 0.5 * next()];
        let off = [0.1 * next(), 0.1 * next(), 0.1 * next()];
        let matrix =
            [[moments[0], off[0], off[1]], [off[0], moments[1], off[2]], [off[1], off[2], moments[2]]];
        inertias.push(Inertia::from_matrix(matrix).unwrap());
        starts.push(Start {
            time: 0.0,
            rotor: Rotor::from_components([1.0, next(), next(), next()]).unwrap(),
            omega: Bivector([next(), next(), next()]),
            center: Center {
                position: Vector([next(), next(), next()]),
                velocity: Vector([next(), next(), next()]),
            },
        });
    }
    let laws = laws.into_iter().map(|law| Rows::new(vec![law])).collect();
    let forces = vec![Rows::new(vec![Force::Constant(Vector([0.0, 0.0, -2.0]))])];
    Ensemble { inertias: Rows::new(inertias), starts, laws, masses: Rows::new(vec![2.0]), forces }
}

fn laws() -> Vec<Torque> {
    vec![
        Torque::Heavy(Vector([0.4, -0.2, 0.8])),
        Torque::Damping(0.05),
        Torque::GravityGradient(Orbit::new(0.3, 0.2, 0.5).unwrap()),
        Torque::Wheel(Bivector([0.1, 0.2, -0.3])),
        Torque::ViscousDamping(Gains::new([0.02, 0.01, 0.03])),
    ]
}

/// The largest difference of two rows.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, |m, x| if x <= m { m } else { x })
}

const TIMES: [f64; 6] = [-7.0, -2.5, 0.0, 1.0, 1.0, 12.0];

/// Each body as in a single run: points to the tolerance, and a similar certificate.
fn assert_as_alone(ensemble: &Ensemble, times: &[f64], options: &Options, rtol: f64) {
    let batch = run(ensemble, times, options);
    assert!(batch.summary.failures.is_empty(), "{:?}", batch.summary.failures);
    let n = times.len();
    for body in 0..ensemble.starts.len() {
        let motion = ensemble.problem(body).simulate(times, options.clone(), &mut |_| true).unwrap();
        let (states, certificate) = (motion.states(), &motion.certificate);
        let fastest = states.omegas.iter().map(|w| w.norm()).fold(0.0, f64::max);
        let largest = states.momenta_space.iter().map(|l| l.norm()).fold(0.0, f64::max);
        for i in 0..n {
            let row = body * n + i;
            let rotor = apart(&states.rotors[i].components(), &batch.rotors[4 * row..][..4]);
            let omega = apart(&states.omegas[i].0, &batch.omegas[3 * row..][..3]) / fastest;
            let momentum = apart(&states.momenta_space[i].0, &batch.momenta[3 * row..][..3]) / largest;
            let center = apart(&states.centers[i].position.0, &batch.centers[3 * row..][..3])
                + apart(
                    &states.centers[i].velocity.0,
                    &batch.centers[batch.centers.len() / 2 + 3 * row..][..3],
                );
            assert!(rotor <= 2.0 * rtol && omega <= 2.0 * rtol, "{body} {i}: {rotor:e} {omega:e}");
            assert!(momentum <= 4.0 * rtol, "{body} {i}: {momentum:e}");
            assert_eq!(center, 0.0);
            let energy = (states.energies[i] - batch.energies[row]).abs();
            assert!(energy <= 20.0 * rtol * (1.0 + fastest * fastest), "{body} {i}: {energy:e}");
        }
        let Summary { steps, evaluations, longest, estimates, norm_drifts, drifts, .. } = &batch.summary;
        assert_eq!(batch.summary.method(body), certificate.method);
        // Roundings may make a step stand that does not in the other.
        let ratio = steps[body] as f64 / certificate.steps.max(1) as f64;
        let no_steps = [certificate.steps, steps[body], evaluations[body]] == [0; 3];
        assert!(no_steps || (0.9..1.1).contains(&ratio), "{ratio}");
        assert!((longest[body] - certificate.step).abs() <= 0.1 * certificate.step);
        assert_eq!(estimates[body].is_nan(), certificate.error_estimate.is_none());
        assert!(estimates[body].is_nan() || estimates[body] <= rtol);
        assert!(norm_drifts[body] <= 8.0 * f64::EPSILON);
        for (quantity, start, drift) in &certificate.drifts {
            let rows = drifts.iter().find(|drift| drift.name == quantity.name()).unwrap();
            let (value, change) = (rows.values[body], rows.changes[body]);
            assert!((value - start).abs() <= 8.0 * f64::EPSILON * start.abs().max(1.0));
            assert!(change <= drift.max(10.0 * rtol), "{quantity:?}: {change:e} {drift:e}");
        }
    }
}

#[test]
fn as_single_bodies() {
    for rtol in [1e-6, 1e-10] {
        assert_as_alone(&bodies(19, laws()), &TIMES, &dop853(rtol), rtol);
        assert_as_alone(&bodies(3, vec![]), &TIMES, &dop853(rtol), rtol);
        assert_as_alone(&bodies(17, vec![laws()[0].clone()]), &[12.0], &dop853(rtol), rtol);
    }
}

/// Without a method and a step, bodies with a closed form are exact, for few times and many; others use dop853.
#[test]
fn closed_forms_are_the_default() {
    let many: Vec<f64> = (-30..70).map(|i| 0.37 * f64::from(i)).collect();
    for times in [&TIMES[..], &many] {
        assert_as_alone(&bodies(5, vec![]), times, &Options::default(), 1e-14);
    }
    assert_as_alone(&bodies(2, vec![Torque::Damping(0.125)]), &TIMES, &Options::default(), 1e-14);
    let heavy = bodies(2, vec![laws()[0].clone()]);
    assert_eq!(run(&heavy, &[1.0], &Options::default()).summary.method_names, ["dop853"]);
    let exact = Options { exact: true, ..Options::default() };
    let refused = run(&heavy, &[1.0], &exact).summary.failures;
    assert!(refused.len() == 2 && refused[1].error.to_string().starts_with("exact "), "{refused:?}");
    let far = run(&bodies(2, vec![]), &[1e30], &Options::default());
    assert!(far.summary.failures.iter().all(|f| matches!(f.error, SimulateError::BeyondHorizon { .. })));
    assert!(far.summary.failures.len() == 2 && far.rotors.iter().all(|x| x.is_nan()));
}

/// Heavy tops about any axis, each with its weight. Among them are one that turns about its upright axis, and ones whose moments
/// differ by rounding; some start at times whose differences from others are rounded.
fn tops(count: usize) -> Ensemble {
    let mut all = bodies(count, vec![]);
    let (mut inertias, mut weights) = (Vec::new(), Vec::new());
    for i in 0..count {
        let (mut moments, mut c) = ([2.0; 3], [0.0; 3]);
        (moments[i % 3], c[i % 3]) = (1.0 + 0.1 * (i % 7) as f64, 0.5 - (i % 5) as f64);
        if i % 11 == 10 {
            moments[(i + 1) % 3] *= 1.0 + f64::EPSILON;
        }
        inertias.push(Inertia::from_principal_moments(moments).unwrap());
        weights.push(Torque::Heavy(Vector(c)));
        all.starts[i].time = 0.1 * (i % 4) as f64;
    }
    (all.inertias, all.laws) = (Rows::new(inertias), vec![Rows::new(weights)]);
    all.starts[2].rotor = Rotor::IDENTITY;
    all.starts[2].omega = Bivector([0.0, 0.0, 4.0]);
    all
}

/// Under torques, bodies in closed form have the states of single runs, however many are side by side.
#[test]
fn closed_forms_under_torques_are_as_alone() {
    for count in [3, 16, 53] {
        let damped = (0..count).map(|i| Torque::Damping(0.05 * (i % 4) as f64)).collect();
        for all in [tops(count), Ensemble { laws: vec![Rows::new(damped)], ..bodies(count, vec![]) }] {
            assert_as_alone(&all, &TIMES, &Options::default(), 1e-12);
            for threads in [1, 2] {
                let found = run_with(&all, &TIMES, &Options::default(), threads, &mut |_| true).unwrap();
                assert_eq!(found.summary.method_names, ["exact"]);
                for body in 0..count {
                    let problem = all.problem(body);
                    let alone = problem.simulate(&TIMES, Options::default(), &mut |_| true).unwrap();
                    for (i, rotor) in alone.states().rotors.iter().enumerate() {
                        let row = body * TIMES.len() + i;
                        assert_eq!(
                            found.rotors[4 * row..][..4],
                            rotor.components(),
                            "body {body} of {count}"
                        );
                    }
                }
            }
        }
    }
}

/// A body beyond its horizon fails at once, though its time since the start is rounded; the others have their motions, and
/// all are counted.
#[test]
fn closed_forms_beyond_their_horizons_fail_at_once() {
    for count in [3, 20] {
        let damped = vec![Rows::new(vec![Torque::Damping(1e-3)])];
        let damped = Ensemble { laws: damped, ..bodies(count, vec![]) };
        for mut all in [tops(count), damped, bodies(count, vec![])] {
            all.starts[1].time = 0.1;
            all.starts[1].omega = Bivector([1.0, 1e30, 1.0]);
            let mut last = 0.0;
            let mut progress = |at: Progress| {
                last = at.fraction;
                true
            };
            let found = run_with(&all, &[1.0], &Options::default(), 1, &mut progress).unwrap();
            let failures = &found.summary.failures;
            assert!(matches!(failures[..], [Failure { body: 1, .. }]), "{failures:?}");
            assert!(matches!(failures[0].error, SimulateError::BeyondHorizon { .. }), "{failures:?}");
            assert!((0..count).all(|body| found.rotors[4 * body].is_nan() == (body == 1)));
            assert_eq!(last, 1.0);
        }
    }
}

/// Results do not depend on the other bodies, their number and order, or the threads.
#[test]
fn bodies_are_independent() {
    let all = bodies(53, laws());
    let one = run_with(&all, &TIMES, &dop853(1e-8), 1, &mut |_| true).unwrap();
    for threads in [2, 5] {
        assert_eq!(run_with(&all, &TIMES, &dop853(1e-8), threads, &mut |_| true).unwrap(), one);
    }
    let mut seed = 3;
    let mut order: Vec<usize> = (0..53).collect();
    order.sort_by_cached_key(|_| (1e9 * random(&mut seed)) as u64);
    order.truncate(21);
    let some = Ensemble {
        inertias: Rows::new(order.iter().map(|&body| *all.inertias.of(body)).collect()),
        starts: order.iter().map(|&body| all.starts[body]).collect(),
        ..all
    };
    let some = run(&some, &TIMES, &dop853(1e-8));
    let rows = 4 * TIMES.len();
    for (i, &body) in order.iter().enumerate() {
        assert_eq!(some.rotors[i * rows..][..rows], one.rotors[body * rows..][..rows]);
        assert_eq!(some.summary.steps[i], one.summary.steps[body]);
        assert_eq!(some.summary.estimates[i], one.summary.estimates[body]);
    }
}

/// A body that turns a thousand times as fast takes more steps, the others do not.
#[test]
fn a_hard_body_among_easy_ones() {
    let easy = bodies(20, vec![laws()[0].clone()]);
    let mut mixed = easy.clone();
    mixed.starts[4].omega = Bivector([300.0, 500.0, -400.0]);
    let (times, options) = ([2.0], dop853(1e-7));
    let (a, b) = (run(&easy, &times, &options), run(&mixed, &times, &options));
    assert!(b.summary.steps[4] > 200 * a.summary.steps[4]);
    for body in (0..20).filter(|&body| body != 4) {
        assert_eq!(a.rotors[4 * body..][..4], b.rotors[4 * body..][..4]);
        assert_eq!(a.summary.steps[body], b.summary.steps[body]);
    }
    let alone = mixed.problem(4).simulate(&times, options, &mut |_| true).unwrap().states();
    assert!(apart(&alone.rotors[0].components(), &b.rotors[16..20]) <= 2e-7);
}

/// A failure is reported with time and cause as for a single body, its rows are NaN, and the others continue.
#[test]
fn failures_are_reported_and_the_others_continue() {
    let table = |end: f64| {
        let rows = vec![Bivector([0.1, 0.0, 0.2]), Bivector([0.3, -0.1, 0.0]), Bivector([0.0, 0.2, 0.1])];
        let table = Table::new(vec![-1.0, 0.6, end], rows, Axes::Body, Kind::Linear).unwrap();
        Torque::Tabulated(Arc::new(table))
    };
    let mut all = bodies(20, vec![]);
    let ends = |body: usize| if body == 6 { 2.0 } else { 9.0 };
    all.laws = vec![Rows::new((0..20).map(|body| table(ends(body))).collect())];
    all.starts[9].omega = Bivector([f64::NAN, 0.0, 0.0]);
    // Grows without bound.
    let growing = |body: usize| Torque::QuadraticDamping(if body == 13 { -50.0 } else { 0.01 });
    all.laws.push(Rows::new((0..20).map(growing).collect()));
    let (times, options) = ([0.5, 4.0], dop853(1e-8));
    let found = run(&all, &times, &options);
    let failed: Vec<usize> = found.summary.failures.iter().map(|failure| failure.body).collect();
    assert_eq!(failed, [6, 9, 13]);
    for failure in &found.summary.failures {
        let body = failure.body;
        let alone = all.problem(body).simulate(&times, options.clone(), &mut |_| true).unwrap_err();
        assert_eq!(std::mem::discriminant(&alone), std::mem::discriminant(&failure.error), "{failure:?}");
        if body == 6 {
            assert!(failure.error.to_string().contains("spans -1 s to 2 s"), "{}", failure.error);
            assert!((2.0..4.0).contains(&failure.time));
        }
        let rows = [
            &found.rotors[8 * body..][..8],
            &found.omegas[6 * body..][..6],
            &found.energies[2 * body..][..2],
        ];
        assert!(rows.iter().all(|row| row.iter().all(|x| x.is_nan())));
    }
    for body in (0..20).filter(|body| !failed.contains(body)) {
        let alone = all.problem(body).simulate(&times, options.clone(), &mut |_| true).unwrap();
        for (i, rotor) in alone.states().rotors.iter().enumerate() {
            assert!(apart(&rotor.components(), &found.rotors[8 * body + 4 * i..][..4]) <= 2e-8, "{body}");
        }
    }
}

/// Steps end at the bends of each body's table, between which the motion is smooth, so few steps are rejected.
#[test]
fn steps_end_where_a_table_bends() {
    let table = |body: usize| {
        let bends: Vec<f64> = (-12..=24)
            .map(|i: i32| 0.5 * f64::from(i) + if i.abs() < 12 { 0.01 * body as f64 } else { 0.0 })
            .collect();
        let torque = |i: usize| {
            Bivector([
                if i.is_multiple_of(2) { 0.5 } else { -0.4 },
                0.1,
                if i.is_multiple_of(3) { 0.7 } else { 0.0 },
            ])
        };
        let torques = (0..bends.len()).map(torque).collect();
        Torque::Tabulated(Arc::new(Table::new(bends, torques, Axes::Space, Kind::Linear).unwrap()))
    };
    let mut all = bodies(18, vec![]);
    all.laws = vec![Rows::new((0..18).map(table).collect())];
    assert_as_alone(&all, &[-5.0, 0.3, 11.0], &dop853(1e-10), 1e-10);
    let summary = run(&all, &[-5.0, 0.3, 11.0], &dop853(1e-10)).summary;
    let (steps, evaluations) = (summary.steps[17], summary.evaluations[17]);
    assert!(evaluations as f64 <= 1.1 * (12 * steps) as f64, "{steps} {evaluations}");
}

#[test]
fn a_run_can_be_stopped() {
    let mut all = bodies(40, vec![laws()[0].clone()]);
    all.starts.iter_mut().for_each(|start| start.omega = start.omega * 1e4);
    let mut calls = 0;
    let mut seen = Vec::new();
    let stopped = run_with(&all, &[-100.0, 100.0], &dop853(1e-9), 2, &mut |at| {
        calls += 1;
        seen.push(at.fraction);
        calls < 5
    });
    assert_eq!(stopped.unwrap_err(), SimulateError::Interrupted);
    assert!(seen.is_sorted() && seen.iter().all(|x| (0.0..1.0).contains(x)), "{seen:?}");
}

/// Free bodies, in full groups and in others, at few and at more times.
#[test]
fn progress_of_free_bodies_ends_at_1() {
    for (number, count) in [(1, 2), (3, 40), (8, 2), (40, 2), (40, 100)] {
        let times: Vec<f64> = (0..count).map(|k| 0.25 * f64::from(k)).collect();
        let mut seen = Vec::new();
        let mut keep = |at: Progress| {
            seen.push(at.fraction);
            true
        };
        run_with(&bodies(number, vec![]), &times, &Options::default(), 1, &mut keep).unwrap();
        assert!(seen.is_sorted() && seen.last() == Some(&1.0), "{number} bodies: {seen:?}");
    }
}

/// Other methods, user functions and other forces than linear ones run body by body.
#[test]
fn unsupported_laws_run_body_by_body() {
    let mut all = bodies(2, vec![laws()[0].clone()]);
    let splitting = Options { method: Method::from_name("strang"), rtol: Some(1e-5), ..Options::default() };
    assert_as_alone(&all, &TIMES, &splitting, 1e-5);
    all.forces = vec![Rows::new(vec![Force::QuadraticDrag(0.1)])];
    assert_as_alone(&all, &TIMES, &dop853(1e-9), 1e-9);
}

/// The numbers, in quotes, behind a key: one, or a row of them.
fn numbers(text: &str, key: &str) -> Vec<f64> {
    let Some(place) = text.find(&format!("\"{key}\":")) else { return vec![] };
    let rest = text[place + key.len() + 3..].trim_start();
    let one = |x: &str| x.trim().trim_matches('"').parse().unwrap();
    match rest.strip_prefix('[') {
        Some(row) => row[..row.find(']').unwrap()].split(',').map(one).collect(),
        None => vec![one(&rest[..rest.find([',', '}']).unwrap()])],
    }
}

fn three(numbers: &[f64]) -> [f64; 3] {
    numbers.try_into().unwrap_or_default()
}

/// Rotor and angular velocity of a reference case at a time.
struct Known<'t> {
    case: &'t str,
    time: f64,
    rotor: Vec<f64>,
    omega: Vec<f64>,
}

/// The references of all laws in one batch for each time; the other laws of a case are zero.
#[test]
fn references_are_met() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/motion_cases.json");
    let text = std::fs::read_to_string(path).unwrap();
    let torqued = &text[text.find("\"torqued\"").unwrap()..text.find("\"real_world\"").unwrap()];
    let mut known = Vec::new();
    for case in torqued.split("\"name\":").skip(1).filter(|case| case.contains("\"omega0\":")) {
        let head = case.find("\"results\"").unwrap();
        for result in case[head..].split("\"t\":").skip(1) {
            let time = numbers(&format!("\"t\":{result}"), "t")[0];
            let (rotor, omega) = (numbers(result, "R"), numbers(result, "omega"));
            known.push(Known { case: &case[..head], time, rotor, omega });
        }
    }
    assert_eq!(known.len(), 24);
    for time in [0.5, 1.0, 5.0, 10.0, 30.0, 40.0, 50.0, 100.0] {
        let here: Vec<&Known> = known.iter().filter(|known| known.time == time).collect();
        let start = |k: &&Known| Start {
            time: 0.0,
            rotor: Rotor::from_components(numbers(k.case, "R0").try_into().unwrap()).unwrap(),
            omega: Bivector(three(&numbers(k.case, "omega0"))),
            center: Center::default(),
        };
        let one = |k: &Known, key: &str| numbers(k.case, key).first().copied().unwrap_or(0.0);
        let kinds: [&dyn Fn(&&Known) -> Torque; 4] = [
            &|k| Torque::Heavy(Vector(three(&numbers(k.case, "c")))),
            &|k| Torque::GravityGradient(Orbit::circular(one(k, "n"))),
            &|k| Torque::Damping(one(k, "g")),
            &|k| Torque::Larmor(Vector(three(&numbers(k.case, "b")))),
        ];
        let inertia =
            |k: &&Known| Inertia::from_principal_moments(three(&numbers(k.case, "inertia"))).unwrap();
        let all = Ensemble {
            inertias: Rows::new(here.iter().map(inertia).collect()),
            starts: here.iter().map(start).collect(),
            laws: kinds.iter().map(|law| Rows::new(here.iter().map(law).collect())).collect(),
            masses: Rows::new(vec![1.0]),
            forces: vec![],
        };
        for rtol in [1e-6, 1e-9] {
            let found = run(&all, &[time], &dop853(rtol));
            assert!(found.summary.failures.is_empty(), "{:?}", found.summary.failures);
            for (i, k) in here.iter().enumerate() {
                let fastest = all.starts[i].omega.norm();
                let rotor = apart(&found.rotors[4 * i..][..4], &k.rotor);
                let omega = apart(&found.omegas[3 * i..][..3], &k.omega) / fastest;
                assert!(rotor.max(omega) <= 10.0 * rtol, "{} at {time}: {rotor:e} {omega:e}", k.case);
            }
        }
    }
}
