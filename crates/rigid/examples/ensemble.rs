//! Body-steps per second of ensembles, beside what the machine can do at most: `cargo run --release --example ensemble`.

use polhode_ga::formula::Names;
use polhode_ga::lanes::{Work, fastest};
use polhode_ga::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::ensemble::{Ensemble, Outputs, Rows, Start};
use polhode_rigid::force::Center;
use polhode_rigid::method::Method;
use polhode_rigid::simulate::Options;
use polhode_rigid::torque::{Axes, FormulaTorque, Gains, Orbit, Torque};
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
    Torque::Formula(FormulaTorque::new(text, Axes::Body, Names::new([]), |_| None).unwrap())
}

fn main() {
    let peak = 2.0 * 96.0 * 1e6 / best(5, || assert!(std::hint::black_box(fastest(Peak)) > 0.0));
    println!("products with sums: {:.1} GFLOP/s on one core", peak / 1e9);
    let heavy = Torque::Heavy(Vector([0.1, 0.2, 0.3]));
    let spring = Torque::TorsionSpring { stiffness: 0.1, rest: Rotor::IDENTITY };
    let magnetic = Torque::Magnetic { dipole: Vector([0.1, 0.2, 0.3]), field: Vector([0.3, 0.0, 0.4]) };
    let kepler = Torque::GravityGradient(Orbit::new(0.1, 0.2, 0.3).unwrap());
    let laws: [(&str, Vec<Torque>); 14] = [
        ("free", vec![]),
        ("heavy", vec![heavy.clone()]),
        ("heavy, damped", vec![heavy.clone(), Torque::Damping(1e-3)]),
        ("gravity gradient", vec![Torque::GravityGradient(Orbit::circular(0.1))]),
        ("gravity gradient, ellipse", vec![kepler]),
        ("constant in the body", vec![Torque::ConstantBody(Bivector([0.1, 0.2, 0.3]))]),
        ("constant in space", vec![Torque::ConstantSpace(Bivector([0.1, 0.2, 0.3]))]),
        ("quadratic damping", vec![Torque::QuadraticDamping(0.01)]),
        ("viscous damping", vec![Torque::ViscousDamping(Gains::new([0.01, 0.02, 0.03]))]),
        ("magnetic", vec![magnetic]),
        ("torsion spring", vec![spring]),
        ("Larmor", vec![Torque::Larmor(Vector([0.1, 0.2, 0.3]))]),
        (
            "formula -(0.1 e1 + 0.2 e2 + 0.3 e3) ∧ (~R e3 R)",
            vec![formula("-(0.1 e1 + 0.2 e2 + 0.3 e3) ∧ (~R e3 R)")],
        ),
        ("formula -0.01 Ω", vec![formula("-0.01 Ω")]),
    ];
    for (name, laws) in laws {
        for method in ["rk4", "strang", "kahan_li8"] {
            for threads in [1, 2] {
                // Short runs, of which the best was not disturbed.
                let (bodies, steps) = (64, 4096);
                let start = |i: usize| Start {
                    rotor: Rotor::IDENTITY,
                    omega: Bivector([0.01 * i as f64 / bodies as f64, 1.0, 0.01]),
                    center: Center::default(),
                };
                let ensemble = Ensemble {
                    inertias: Rows::new(vec![Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap()]),
                    starts: (0..bodies).map(start).collect(),
                    laws: laws.iter().map(|law| Rows::new(vec![law.clone()])).collect(),
                    masses: Rows::new(vec![1.0]),
                    forces: vec![],
                };
                let options =
                    Options { method: Method::from_name(method), step: Some(0.01), ..Options::default() };
                let [mut a, mut b, mut c, mut d] = [4, 3, 3, 1].map(|n| vec![0.0; n * bodies]);
                let time = best(if method == "rk4" { 40 } else { 3 }, || {
                    let outputs = Outputs {
                        rotors: &mut a,
                        omegas: &mut b,
                        momenta: &mut c,
                        energies: &mut d,
                        centers: None,
                    };
                    let times = [0.01 * steps as f64];
                    ensemble.run(&times, &options, Threads::new(threads), outputs, &mut |_| true).unwrap();
                });
                let rate = (bodies * steps) as f64 / time;
                println!("{name}, {method}, {threads} threads: {:.1} M body-steps/s", rate / 1e6);
            }
        }
    }
}
