//! Every law in an ensemble: the results of a body are those of a single run.

use polhode_ga::formula::{Given, Input, Meaning, Names, Type};
use polhode_ga::product::Grades;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Graded, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::ensemble::{Ensemble, Outputs, Rows, Start, Summary};
use polhode_rigid::error::TorqueError;
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::torque::{Axes, Gains, Kind, Orbit, Table, Torque};
use polhode_rigid::methods::Method;
use polhode_rigid::run::Options;
use polhode_rigid::state::center::Center;
use polhode_rigid::state::point::{Function, Seen};
use std::sync::Arc;

/// More than two blocks, the last not full.
const BODIES: usize = 37;

const STEP: f64 = 1.0 / 64.0;

/// Backwards too, and with steps of two lengths.
const TIMES: [f64; 4] = [-0.5, 0.25, 0.3, 1.0];

const STEPS: f64 = 16.0 + 4.0 + 45.0;

/// Numbers between −1 and 1 without a pattern, the same in every run.
fn number(body: usize, which: usize) -> f64 {
    let golden = 0.618_033_988_749_894_9;
    2.0 * ((body as f64 * 7.0 + which as f64 * 3.0 + 1.0) * golden).fract() - 1.0
}

fn three(body: usize, which: usize) -> [f64; 3] {
    [0, 1, 2].map(|k| number(body, which + k))
}

fn rotor(body: usize, which: usize) -> Rotor {
    let [x, y, z] = three(body, which);
    Rotor::from_components([1.5, x, y, z]).unwrap()
}

fn vector(x: [f64; 3]) -> Given {
    Given::Value(Graded::new(&x, Grades(0b0010)).unwrap())
}

fn scalar(x: f64) -> Given {
    Given::Value(Graded::default().map(|_| x))
}

/// With a vector c and a number k.
fn formula(text: &str, axes: Axes, c: [f64; 3], k: f64) -> Torque {
    let mut names = Names::new([]);
    names.bind("c".to_owned(), Meaning::Value(Type::of(Grades(0b0010))));
    names.bind("k".to_owned(), Meaning::Value(Type::SCALAR));
    let value = |input: &Input| Some(if input.name == "c" { vector(c) } else { scalar(k) });
    Torque::Formula(Formula::new(text, Purpose::Torque(axes), names, value).unwrap())
}

fn table(axes: Axes, kind: Kind) -> Torque {
    let times = vec![-1.0, 0.1, 0.7, 2.0];
    let torques = (0..4).map(|row| Bivector(three(row, 2))).collect();
    Torque::Tabulated(Arc::new(Table::new(times, torques, axes, kind).unwrap()))
}

/// Every kind of law, with the parameters of a body. Tables are the same for all.
fn laws(body: usize) -> Vec<(&'static str, Torque)> {
    let gains = |which: usize| Gains::new(three(body, which).map(|x| 1.0 + 0.5 * x));
    let in_body = Torque::GravityGradient(Orbit::circular(1.0 + 0.5 * number(body, 3)));
    let ellipse = Orbit::new(1.0 + 0.5 * number(body, 3), 0.4 + 0.3 * number(body, 4), number(body, 5));
    let function = move |&Seen { time, rotor, omega, .. }: &Seen| -> Result<Bivector, TorqueError> {
        Ok(rotor.reverse().apply_bivector(Bivector([time, 0.0, number(body, 1)])) - omega * 0.1)
    };
    let c = three(body, 6);
    vec![
        ("heavy", Torque::Heavy(Vector(three(body, 1)))),
        ("circle", in_body),
        ("ellipse", Torque::GravityGradient(ellipse.unwrap())),
        ("constant_body", Torque::ConstantBody(Bivector(three(body, 2)))),
        ("constant_space", Torque::ConstantSpace(Bivector(three(body, 3)))),
        ("damping", Torque::Damping(0.5 + 0.2 * number(body, 4))),
        ("quadratic_damping", Torque::QuadraticDamping(0.5 + 0.2 * number(body, 5))),
        ("viscous_damping", Torque::ViscousDamping(gains(6))),
        ("magnetic", Torque::Magnetic { dipole: Vector(three(body, 7)), field: Vector(three(body, 8)) }),
        ("spring", Torque::TorsionSpring { stiffness: 1.0 + 0.5 * number(body, 9), rest: rotor(body, 4) }),
        ("wheel", Torque::Wheel(Bivector(three(body, 10)))),
        ("control", Torque::Control { stiffness: gains(1), damping: gains(2), target: rotor(body, 9) }),
        ("larmor", Torque::Larmor(Vector(three(body, 11)))),
        ("line", table(Axes::Body, Kind::Linear)),
        ("spline", table(Axes::Space, Kind::Cubic)),
        (
            "formula",
            formula(
                "⟨k t ((~R c R)·e1) I(Ω) + exp(0.1 L_B) I c − 0.1 Ω/norm(L)⟩_2",
                Axes::Body,
                c,
                number(body, 2),
            ),
        ),
        ("formula_space", formula("c∧(R e1 ~R) − 0.1 k Ω", Axes::Space, c, number(body, 2))),
        ("function", Torque::Function(Function::new(function))),
    ]
}

fn inertia(body: usize) -> Inertia {
    let moments = three(body, 3).map(|x| 2.0 + 0.5 * x);
    Inertia::from_principal_moments(moments).unwrap().rotated(rotor(body, 8))
}

fn start(body: usize) -> Start {
    Start { time: 0.0, rotor: rotor(body, 5), omega: Bivector(three(body, 13)), center: Center::default() }
}

/// The bodies of these numbers, with their own laws of some kinds or those of body 0.
fn ensemble(bodies: &[usize], kinds: &[usize], own: bool) -> Ensemble {
    let of = |kind: usize| -> Rows<Torque> {
        // One table for all: its rows are the same, but no other body's copy is the same table.
        let is_table = laws(0)[kind].0 == "line" || laws(0)[kind].0 == "spline";
        let whose = if own && !is_table { bodies.to_vec() } else { vec![0] };
        Rows::new(whose.into_iter().map(|body| laws(body)[kind].1.clone()).collect())
    };
    Ensemble {
        inertias: Rows::new(bodies.iter().map(|&body| inertia(body)).collect()),
        starts: bodies.iter().map(|&body| start(body)).collect(),
        laws: kinds.iter().map(|&kind| of(kind)).collect(),
        masses: Rows::new(vec![1.0]),
        forces: vec![],
    }
}

fn options() -> Options {
    Options { method: Method::from_name("rk4"), step: Some(STEP), ..Options::default() }
}

/// For each body its rotors, angular velocities, momenta and energies.
struct Run {
    rows: Vec<[Vec<f64>; 4]>,
    summary: Summary,
}

impl Run {
    fn bits(&self, body: usize) -> Vec<u64> {
        self.rows[body].iter().flatten().map(|x| x.to_bits()).collect()
    }
}

fn run(ensemble: &Ensemble, threads: usize) -> Run {
    let (bodies, times) = (ensemble.starts.len(), TIMES.len());
    let [mut a, mut b, mut c, mut d] = [4, 3, 3, 1].map(|n| vec![0.0; n * bodies * times]);
    let outputs =
        Outputs { rotors: &mut a, omegas: &mut b, momenta: &mut c, energies: &mut d, centers: None };
    let summary = ensemble.run(&TIMES, &options(), Threads::new(threads), outputs, &mut |_| true).unwrap();
    let of = |all: &[f64], n: usize, body: usize| all[n * times * body..n * times * (body + 1)].to_vec();
    let rows = (0..bodies).map(|i| [of(&a, 4, i), of(&b, 3, i), of(&c, 3, i), of(&d, 1, i)]).collect();
    Run { rows, summary }
}

/// Fused products with sums leave 8 ulps of the rotor in a step, and of the angular velocity 8 ulps of the rates here, which
/// are below 8 rad/s; laws that stiffen amplify none of it in a second.
fn assert_as_alone(ensemble: &Ensemble, run: &Run, label: &str) {
    assert!(run.summary.failures.is_empty(), "{label}: {:?}", run.summary.failures);
    for (body, [rotors, omegas, ..]) in run.rows.iter().enumerate() {
        let motion = ensemble.problem(body).simulate(&TIMES, options(), &mut |_| true).unwrap();
        let states = motion.states();
        for i in 0..TIMES.len() {
            let near = |x: &[f64], y: &[f64], size: f64| {
                let error = x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
                let allowed = 8.0 * f64::EPSILON * STEPS * size;
                assert!(error <= allowed, "{label}, body {body} at {}: {error:e} > {allowed:e}", TIMES[i]);
            };
            near(&rotors[4 * i..][..4], &states.rotors[i].components(), 1.0);
            near(&omegas[3 * i..][..3], &states.omegas[i].0, states.omegas[i].norm().max(1.0));
        }
    }
}

#[test]
fn each_law_matches_single_runs() {
    let all: Vec<usize> = (0..BODIES).collect();
    for (kind, (name, _)) in laws(0).iter().enumerate() {
        for own in [false, true] {
            let ensemble = ensemble(&all, &[kind], own);
            assert_as_alone(&ensemble, &run(&ensemble, 2), &format!("{name}, own: {own}"));
        }
    }
}

#[test]
fn laws_add_up() {
    let all: Vec<usize> = (0..BODIES).collect();
    let kinds: Vec<usize> = (0..laws(0).len()).collect();
    for own in [false, true] {
        let once = ensemble(&all, &kinds, own);
        assert_as_alone(&once, &run(&once, 1), &format!("all, own: {own}"));
        // Two of a kind.
        let twice: Vec<usize> = [0, 3, 4, 6, 7, 12].into_iter().flat_map(|kind| [kind, kind]).collect();
        let twice = ensemble(&all, &twice, own);
        assert_as_alone(&twice, &run(&twice, 1), &format!("two of a kind, own: {own}"));
    }
}

#[test]
fn bodies_are_independent() {
    let kinds: Vec<usize> = (0..laws(0).len()).collect();
    let all: Vec<usize> = (0..BODIES).collect();
    let by_one = run(&ensemble(&all, &kinds, true), 1);
    for threads in [2, 3, 7] {
        let shared = run(&ensemble(&all, &kinds, true), threads);
        assert!((0..BODIES).all(|body| shared.bits(body) == by_one.bits(body)), "{threads} threads");
    }
    for body in [0, 15, 16, 36] {
        assert!(run(&ensemble(&[body], &kinds, true), 1).bits(0) == by_one.bits(body), "alone: {body}");
    }
    let mixed: Vec<usize> = (0..BODIES).map(|i| (i * 10 + 5) % BODIES).collect();
    let other = run(&ensemble(&mixed, &kinds, true), 2);
    for (place, &body) in mixed.iter().enumerate() {
        assert!(other.bits(place) == by_one.bits(body), "body {body} at {place}");
    }
}

/// One law alone may have steps of its own, and few bodies narrower lanes.
#[test]
fn each_law_has_the_same_bits_for_any_number_of_bodies() {
    let all: Vec<usize> = (0..BODIES).collect();
    for (kind, (name, _)) in laws(0).iter().enumerate() {
        let together = run(&ensemble(&all, &[kind], true), 1);
        for few in [&all[..1], &all[20..33], &all[36..]] {
            let apart = run(&ensemble(few, &[kind], true), 1);
            for (place, &body) in few.iter().enumerate() {
                assert!(apart.bits(place) == together.bits(body), "{name}, body {body} of {}", few.len());
            }
        }
    }
}

/// Laws whose parameters differ from body to body, as formulas and as laws. Between the stages of a step a rotor is not of
/// norm 1 by `(hω/2)²` at most, and the weight of a formula is another function of it there: a difference in the error of
/// the method, `h⁴`.
#[test]
fn formulas_match_the_built_in_laws() {
    let rounding = 16.0 * f64::EPSILON * STEPS;
    type Make = fn([f64; 3], f64) -> Torque;
    let pairs: [(&str, Axes, f64, Make); 4] = [
        ("(~R e3 R) ∧ c", Axes::Body, 0.01 * STEP.powi(4), |c, _| Torque::Heavy(Vector(c))),
        ("−k norm(Ω) Ω", Axes::Body, rounding, |_, k| Torque::QuadraticDamping(k)),
        ("I c", Axes::Body, rounding, |c, _| Torque::ConstantBody(Bivector(c))),
        ("I c", Axes::Space, rounding, |c, _| Torque::ConstantSpace(Bivector(c))),
    ];
    let all: Vec<usize> = (0..BODIES).collect();
    for (text, axes, allowed, law) in pairs {
        let mut ensemble = ensemble(&all, &[], true);
        let values = |body: usize| (three(body, 1), 1.0 + 0.5 * number(body, 2));
        ensemble.laws = vec![Rows::new(all.iter().map(|&i| law(values(i).0, values(i).1)).collect())];
        let expected = run(&ensemble, 1);
        let formulas = |&i: &usize| formula(text, axes, values(i).0, values(i).1);
        ensemble.laws = vec![Rows::new(all.iter().map(formulas).collect())];
        let found = run(&ensemble, 1);
        for body in 0..BODIES {
            for (x, y) in found.rows[body].iter().take(2).flatten().zip(expected.rows[body].iter().flatten())
            {
                assert!((x - y).abs() <= allowed, "{text}, body {body}: {x} {y}");
            }
        }
    }
}

/// Only these bodies fail; the others have the same bits as without failures.
fn assert_only_these_fail(healthy: &Ensemble, ill: &Ensemble, failing: &[usize]) {
    let (expected, found) = (run(healthy, 2), run(ill, 2));
    assert!(expected.summary.failures.is_empty());
    assert_eq!(found.summary.failures.iter().map(|failure| failure.body).collect::<Vec<_>>(), failing);
    for failure in &found.summary.failures {
        let alone = ill.problem(failure.body).simulate(&TIMES, options(), &mut |_| true).unwrap_err();
        assert_eq!(failure.error, alone);
    }
    for body in (0..BODIES).filter(|body| !failing.contains(body)) {
        assert_eq!(found.bits(body), expected.bits(body), "body {body}");
    }
}

#[test]
fn a_body_that_fails_fails_alone() {
    let all: Vec<usize> = (0..BODIES).collect();
    let ill = [11, 16, 36];
    let with = |law: &dyn Fn(usize) -> Torque| {
        let mut ensemble = ensemble(&all, &[0], true);
        ensemble.laws.push(Rows::new(all.iter().map(|&body| law(body)).collect()));
        ensemble
    };
    // A quotient without a value at one time; the whole block stumbles over it.
    let quotient = |at: f64| formula("⟨I c/(k − t) + exp(t I c) I c⟩_2", Axes::Body, [0.1, 0.2, 0.3], at);
    let healthy = with(&|_| quotient(2.0));
    let failing = with(&|body| quotient(if ill.contains(&body) { 0.5 * STEP } else { 2.0 }));
    assert_only_these_fail(&healthy, &failing, &ill);
    // Functions that give up.
    let function = |until: f64| {
        Torque::Function(Function::new(move |&Seen { time, omega, .. }| {
            if time > until { Err(TorqueError::new("too late")) } else { Ok(omega * -0.1) }
        }))
    };
    let failing = with(&|body| function(if ill.contains(&body) { 0.4 } else { 2.0 }));
    assert_only_these_fail(&with(&|_| function(2.0)), &failing, &ill);
    // Tables of their own that end.
    let table = |last: f64| {
        let torques = vec![Bivector::default(), Bivector([0.1, 0.2, 0.3])];
        Torque::Tabulated(Arc::new(Table::new(vec![-1.0, last], torques, Axes::Body, Kind::Linear).unwrap()))
    };
    let healthy = with(&|_| table(2.0));
    let failing = with(&|body| table(if ill.contains(&body) { 0.4 } else { 2.0 }));
    assert_only_these_fail(&healthy, &failing, &ill);
}

/// A table that ends for all.
#[test]
fn a_shared_table_that_ends_fails_all() {
    let mut ensemble = ensemble(&[0, 1, 2], &[], false);
    let torques = vec![Bivector::default(), Bivector([0.1, 0.2, 0.3])];
    let short = Table::new(vec![-1.0, 0.4], torques, Axes::Space, Kind::Linear).unwrap();
    ensemble.laws = vec![Rows::new(vec![Torque::Tabulated(Arc::new(short))])];
    let found = run(&ensemble, 1);
    assert_eq!(found.summary.failures.iter().map(|f| f.body).collect::<Vec<_>>(), [0, 1, 2]);
    assert!(found.summary.failures.iter().all(|f| f.error.to_string().contains("0.4")));
}
