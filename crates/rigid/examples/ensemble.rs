//! Body-steps per second of ensembles, beside what the machine can do at most and beside bodies one by one:
//! `cargo run --release --example ensemble`; with an argument only what has it in its name, such as
//! `adaptive`.

use polhode_ga::formula::Names;
use polhode_ga::simd::lanes::{Work, fastest};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::ensemble::{Ensemble, Outputs, Rows, Start};
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::torque::{Axes, Gains, Orbit, Torque};
use polhode_rigid::methods::Method;
use polhode_rigid::run::Options;
use polhode_rigid::state::center::Center;
use std::time::Instant;

/// Independent chains of products with sums.
struct Peak;

impl Work for Peak {
    type Output = f64;

    #[inline(always)]
    fn run<const F: bool>(self) -> f64 {
        let (a, b) = (std::hint::black_box(0.999), std::hint::black_box(0.1));
        let mut chains = [0.0_f64; 96];
        for _ in 0..1_000_000 {
            for x in &mut chains {
                *x = if F { x.mul_add(a, b) } else { *x * a + b };
            }
        }
        chains.iter().sum()
    }
}

fn best(runs: u32, mut run: impl FnMut()) -> f64 {
    let time = |_| {
        let begin = Instant::now();
        run();
        begin.elapsed().as_secs_f64()
    };
    (0..runs).map(time).fold(f64::INFINITY, f64::min)
}

fn formula(text: &str) -> Torque {
    Torque::Formula(Formula::new(text, Purpose::Torque(Axes::Body), Names::new([]), |_| None).unwrap())
}

/// Orbits of mean motion [`OWN`] and below stand for an orbit of its own for each body; other laws for all bodies.
const OWN: f64 = 0.05;

fn own(law: &Torque, bodies: usize) -> Vec<Torque> {
    let Torque::GravityGradient(orbit) = law else { return vec![law.clone()] };
    if orbit.rate() > OWN {
        return vec![law.clone()];
    }
    let of = |i: usize| {
        let part = i as f64 / bodies as f64;
        let (rate, anomaly) = (orbit.rate() * (1.0 + part), 6.0 * part);
        let own = Orbit::new(rate, orbit.eccentricity() * (1.0 + part), anomaly);
        Torque::GravityGradient(own.expect("an ellipse"))
    };
    (0..bodies).map(of).collect()
}

fn ensemble(bodies: usize, laws: &[Torque]) -> Ensemble {
    let start = |i: usize| Start {
        time: 0.0,
        rotor: Rotor::IDENTITY,
        omega: Bivector([0.01 * i as f64 / bodies as f64, 1.0, 0.01]),
        center: Center::default(),
    };
    Ensemble {
        inertias: Rows::new(vec![Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap()]),
        starts: (0..bodies).map(start).collect(),
        laws: laws.iter().map(|law| Rows::new(own(law, bodies))).collect(),
        masses: Rows::new(vec![1.0]),
        forces: vec![],
    }
}

/// Sums and products in a step of a free body by rk4: in each of four slopes 10 products and 8 products with sums, 7
/// times 7 products with sums between them, and 19 for |R|.
const OPERATIONS: f64 = 4.0 * (10.0 + 2.0 * 8.0) + 49.0 * 2.0 + 19.0;

/// The steps of all bodies, and the seconds they took, the best of some runs; none where the method is not for these laws.
fn run(
    runs: u32,
    ensemble: &Ensemble,
    times: &[f64],
    options: &Options,
    threads: usize,
) -> Option<(u64, f64)> {
    let [mut a, mut b, mut c, mut d] =
        [4, 3, 3, 1].map(|n| vec![0.0; n * ensemble.starts.len() * times.len()]);
    let (mut steps, mut fit) = (0, true);
    let time = best(runs, || {
        let outputs =
            Outputs { rotors: &mut a, omegas: &mut b, momenta: &mut c, energies: &mut d, centers: None };
        let threads = Threads::new(threads);
        let summary = ensemble.run(times, options, threads, outputs, &mut |_| true).unwrap();
        fit = summary.failures.is_empty();
        steps = summary.steps.iter().sum();
    });
    fit.then_some((steps, time))
}

/// The same one by one.
fn one_by_one(ensemble: &Ensemble, times: &[f64], options: &Options) -> (u64, f64) {
    let mut steps = 0;
    let time = best(3, || {
        let each = (0..ensemble.starts.len()).map(|body| ensemble.problem(body));
        let motions = each.map(|problem| problem.simulate(times, options.clone(), &mut |_| true).unwrap());
        steps = motions.map(|motion| motion.certificate.steps).sum();
    });
    (steps, time)
}

/// Steps that keep to a tolerance, in lanes and one by one; then with one body 500 times as hard as the others.
fn adaptive(name: &str, laws: &[Torque]) {
    let options = Options { method: Method::from_name("dop853"), rtol: Some(1e-9), ..Options::default() };
    let rate = |(steps, time): (u64, f64)| steps as f64 / time / 1e6;
    let all = ensemble(512, laws);
    let (lanes, alone) = (run(3, &all, &[20.0], &options, 1).unwrap(), one_by_one(&all, &[20.0], &options));
    println!("{name}, dop853 to 1e-9: {:.2} M body-steps/s, one by one {:.2}", rate(lanes), rate(alone));
    let mut mixed = all;
    mixed.starts[7].omega = Bivector([50.0, 25.0, 500.0]);
    for threads in [1, 2] {
        let (steps, time) = run(3, &mixed, &[20.0], &options, threads).unwrap();
        println!("  with a body 500 times as hard: {time:.3} s for {steps} steps, {threads} threads");
    }
    let (steps, time) = one_by_one(&mixed, &[20.0], &options);
    println!("  one by one {time:.3} s for {steps} steps");
    let times: Vec<f64> = (0..1000).map(|i| 0.02 * f64::from(i)).collect();
    if laws.is_empty() {
        let (free, exact) = (ensemble(512, laws), Options::default());
        let (lanes, alone) =
            (run(3, &free, &times, &exact, 1).unwrap().1, one_by_one(&free, &times, &exact).1);
        println!("{name}, exact: {:.1} ns a point, one by one {:.1}", lanes / 512e-6, alone / 512e-6);
    }
}

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    equal_steps(&only);
    let heavy = Torque::Heavy(Vector([0.1, 0.2, 0.3]));
    let gradient = Torque::GravityGradient(Orbit::circular(0.1));
    for (name, laws) in [
        ("free", vec![]),
        ("heavy, damped", vec![heavy, Torque::Damping(1e-3)]),
        ("gravity gradient", vec![gradient]),
    ] {
        if format!("{name}, adaptive").contains(&only) {
            adaptive(name, &laws);
        }
    }
}

fn equal_steps(only: &str) {
    let peak = 2.0 * 96.0 * 1e6 / best(5, || assert!(std::hint::black_box(fastest(Peak)) > 0.0));
    println!("products with sums: {:.1} GFLOP/s on one core", peak / 1e9);
    let heavy = Torque::Heavy(Vector([0.1, 0.2, 0.3]));
    let spring = Torque::TorsionSpring { stiffness: 0.1, rest: Rotor::IDENTITY };
    let magnetic = Torque::Magnetic { dipole: Vector([0.1, 0.2, 0.3]), field: Vector([0.3, 0.0, 0.4]) };
    let kepler = Torque::GravityGradient(Orbit::new(0.1, 0.2, 0.3).unwrap());
    let control = Torque::Control {
        stiffness: Gains::new([0.1, 0.2, 0.3]),
        damping: Gains::new([0.01, 0.02, 0.03]),
        target: Rotor::IDENTITY,
    };
    let orbit = |e| vec![Torque::GravityGradient(Orbit::new(OWN, e, 0.3).unwrap())];
    let laws: [(&str, Vec<Torque>); 18] = [
        ("free", vec![]),
        ("heavy", vec![heavy.clone()]),
        ("heavy, damped", vec![heavy.clone(), Torque::Damping(1e-3)]),
        ("gravity gradient", vec![Torque::GravityGradient(Orbit::circular(0.1))]),
        ("gravity gradient, ellipse", vec![kepler]),
        ("gravity gradient, own circles", orbit(0.0)),
        ("gravity gradient, own ellipses", orbit(0.2)),
        ("constant in the body", vec![Torque::ConstantBody(Bivector([0.1, 0.2, 0.3]))]),
        ("constant in space", vec![Torque::ConstantSpace(Bivector([0.1, 0.2, 0.3]))]),
        ("quadratic damping", vec![Torque::QuadraticDamping(0.01)]),
        ("viscous damping", vec![Torque::ViscousDamping(Gains::new([0.01, 0.02, 0.03]))]),
        ("magnetic", vec![magnetic]),
        ("torsion spring", vec![spring]),
        ("control", vec![control]),
        ("Larmor", vec![Torque::Larmor(Vector([0.1, 0.2, 0.3]))]),
        (
            "formula -(0.1 e1 + 0.2 e2 + 0.3 e3) ∧ (~R e3 R)",
            vec![formula("-(0.1 e1 + 0.2 e2 + 0.3 e3) ∧ (~R e3 R)")],
        ),
        ("formula -0.01 Ω", vec![formula("-0.01 Ω")]),
        (
            "formula of time, -0.01 (1 + sin(t)) Ω + (~R e3 R) ∧ (0.1 e1 + 0.3 e3)",
            vec![formula("-0.01 (1 + sin(t)) Ω + (~R e3 R) ∧ (0.1 e1 + 0.3 e3)")],
        ),
    ];
    for (name, laws) in laws.into_iter().filter(|(name, _)| name.contains(only)) {
        for method in ["rk4", "strang", "kahan_li8"] {
            for threads in [1, 2] {
                // On one thread short runs, of which the best was not disturbed.
                let (bodies, steps) = (64 * if threads == 1 { 1 } else { 16 }, 1024);
                let ensemble = ensemble(bodies, &laws);
                let options =
                    Options { method: Method::from_name(method), step: Some(0.01), ..Options::default() };
                let runs = if method == "rk4" && threads == 1 { 100 } else { 10 };
                let end = [0.01 * steps as f64];
                let Some((_, time)) = run(runs, &ensemble, &end, &options, threads) else { continue };
                let rate = (bodies * steps) as f64 / time;
                let share = if laws.is_empty() && method == "rk4" {
                    format!(", {:.0} % of the peak", 100.0 * rate * OPERATIONS / (peak * threads as f64))
                } else {
                    String::new()
                };
                println!("{name}, {method}, {threads} threads: {:.1} M body-steps/s{share}", rate / 1e6);
            }
        }
    }
}
