//! Cost of a body in short runs of many bodies, with one inertia for all and with one each:
//! `cargo run --release --example short [BODIES [STEPS [ROUNDS [WHICH]]]]`.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::ensemble::{Ensemble, Outputs, Rows, Start};
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::methods::Method;
use polhode_rigid::run::Options;
use polhode_rigid::state::center::Center;
use std::time::Instant;

fn start(i: usize) -> Start {
    let x = (i * 7919 % 1009) as f64 / 500.0 - 1.001;
    Start {
        time: 0.0,
        rotor: Rotor::from_components([1.0, x, 0.5, -x]).expect("not zero"),
        omega: Bivector([x, 1.0, 0.01]),
        center: Center::default(),
    }
}

fn inertia(i: usize) -> Inertia {
    let x = (i * 4241 % 1013) as f64 / 1013.0;
    Inertia::from_principal_moments([1.0 + x, 2.0 + 0.5 * x, 2.5 + x]).expect("moments of a body")
}

/// The inertia of each body.
type Own = fn(usize) -> Inertia;

/// Symmetric about e3.
fn top(i: usize) -> Inertia {
    let x = (i * 4241 % 1013) as f64 / 1013.0;
    Inertia::from_principal_moments([1.0 + x, 1.0 + x, 0.5 + x]).expect("moments of a body")
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut number = |or: usize| arguments.next().map_or(or, |text| text.parse().expect("a whole number"));
    let (bodies, steps, rounds) = (number(100_000), number(2), number(10));
    let only = arguments.next().unwrap_or_default();
    let heavy = |c: [f64; 3]| vec![Torque::Heavy(Vector(c))];
    let kinds: [(_, _, Own); 4] = [
        ("free", vec![], inertia),
        ("damped", vec![Torque::Damping(0.1)], inertia),
        ("heavy", heavy([0.1, 0.2, 0.3]), inertia),
        ("heavy top", heavy([0.0, 0.0, 0.3]), top),
    ];
    for (own, what) in [(false, "shared"), (true, "own")] {
        for (law, laws, inertia) in &kinds {
            for method in ["rk4", "kahan_li8", "auto"] {
                let name = format!("{law}, {what} moments, {method}");
                if !name.contains(&only) {
                    continue;
                }
                let ensemble = Ensemble {
                    inertias: Rows::new((0..if own { bodies } else { 1 }).map(inertia).collect()),
                    starts: (0..bodies).map(start).collect(),
                    laws: laws.iter().map(|law: &Torque| Rows::new(vec![law.clone()])).collect(),
                    masses: Rows::new(vec![1.0]),
                    forces: vec![],
                };
                let step = (method != "auto").then_some(0.01);
                let options = Options { method: Method::from_name(method), step, ..Options::default() };
                let times = [0.01 * steps as f64];
                let [mut a, mut b, mut c, mut d] = [4, 3, 3, 1].map(|n| vec![0.0; n * bodies]);
                for threads in [1, 2] {
                    let mut best = f64::INFINITY;
                    for _ in 0..rounds {
                        let begin = Instant::now();
                        let outputs = Outputs {
                            rotors: &mut a,
                            omegas: &mut b,
                            momenta: &mut c,
                            energies: &mut d,
                            centers: None,
                        };
                        let threads = Threads::new(threads);
                        let summary = ensemble.run(&times, &options, threads, outputs, &mut |_| true);
                        assert!(summary.is_ok_and(|summary| summary.failures.is_empty()));
                        best = best.min(begin.elapsed().as_secs_f64());
                    }
                    println!("{name}, {threads} threads: {:.0} ns a body", 1e9 * best / bodies as f64);
                }
            }
        }
    }
}
