//! An ensemble gives each body the results of a single run.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::ensemble::{Ensemble, Failure, Outputs, Rows, Start, Summary};
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::methods::Method;
use polhode_rigid::run::Options;
use polhode_rigid::state::center::Center;
use polhode_rigid::state::point::Function;
use polhode_rigid::{Inertia, SimulateError};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Bodies of every order of moments, symmetric ones and a sphere among them, in axes of their own.
fn bodies(count: usize) -> Vec<Inertia> {
    let moments = [
        [1.0, 2.0, 2.5],
        [2.5, 1.0, 2.0],
        [2.0, 2.5, 1.0],
        [1.0, 2.5, 2.0],
        [2.0, 1.0, 1.0],
        [1.0, 2.0, 2.0],
        [1.5, 1.5, 1.5],
    ];
    let tilted = |i: usize| {
        let m = moments[i % moments.len()];
        let r = Rotor::from_components([1.0, 0.1 * (i % 5) as f64, 0.0, 0.2 * (i % 3) as f64])
            .unwrap()
            .to_matrix();
        let entry = |j: usize, k: usize| (0..3).map(|a| r[j][a] * m[a] * r[k][a]).sum::<f64>();
        Inertia::from_matrix(std::array::from_fn(|j| std::array::from_fn(|k| entry(j.min(k), j.max(k)))))
            .unwrap()
    };
    (0..count).map(tilted).collect()
}

fn starts(count: usize) -> Vec<Start> {
    let start = |i: usize| Start {
        time: 0.0,
        rotor: Rotor::from_components([1.0, (i as f64).sin(), 0.3, (2.0 * i as f64).cos()]).unwrap(),
        omega: Bivector([0.3 + 0.01 * i as f64, 1.0, (i as f64).cos()]),
        center: Center { position: Vector([1.0, 0.0, 0.0]), velocity: Vector([0.0, i as f64, 0.0]) },
    };
    (0..count).map(start).collect()
}

fn ensemble(count: usize, laws: Vec<Rows<Torque>>) -> Ensemble {
    Ensemble {
        inertias: Rows::new(bodies(count)),
        starts: starts(count),
        laws,
        masses: Rows::new(vec![2.0]),
        forces: vec![],
    }
}

/// All points of all bodies as rows of eleven numbers: rotor, angular velocity, momentum and energy.
fn points(bodies: &Ensemble, times: &[f64], options: &Options, threads: usize) -> (Vec<[f64; 11]>, Summary) {
    let rows = bodies.starts.len() * times.len();
    let [mut a, mut b, mut c, mut d] = [4, 3, 3, 1].map(|n| vec![0.5; n * rows]);
    let outputs =
        Outputs { rotors: &mut a, omegas: &mut b, momenta: &mut c, energies: &mut d, centers: None };
    let summary = bodies.run(times, options, Threads::new(threads), outputs, &mut |_| true).unwrap();
    let row = |i: usize| {
        std::array::from_fn(|k| match k {
            0..4 => a[4 * i + k],
            4..7 => b[3 * i + k - 4],
            7..10 => c[3 * i + k - 7],
            _ => d[i],
        })
    };
    ((0..rows).map(row).collect(), summary)
}

fn stepped(method: &str, step: f64) -> Options {
    Options { method: Method::from_name(method), step: Some(step), ..Options::default() }
}

fn weights(count: usize) -> Rows<Torque> {
    Rows::new((0..count).map(|i| Torque::Heavy(Vector([0.1, 0.02 * i as f64, 0.3]))).collect())
}

fn dampings(count: usize) -> Rows<Torque> {
    Rows::new((0..count).map(|i| Torque::Damping(0.01 * (i % 4) as f64)).collect())
}

const TIMES: [f64; 5] = [-1.0, 0.0, 0.25, 2.0, 5.0];

#[test]
fn bodies_match_single_runs() {
    let count = 45;
    let wheel = Rows::new(vec![Torque::Wheel(Bivector([0.1, 0.2, -0.3]))]);
    let lists = [
        vec![],
        vec![weights(count)],
        vec![dampings(count)],
        vec![wheel.clone()],
        vec![weights(count), dampings(count), wheel],
    ];
    for laws in lists {
        let all = ensemble(count, laws);
        for method in ["rk4", "strang", "yoshida4", "kahan_li8", "rkn6", "midpoint"] {
            let options = stepped(method, 0.05);
            let (found, summary) = points(&all, &TIMES, &options, 2);
            for body in 0..count {
                let alone = all.problem(body).simulate(&TIMES, options.clone(), &mut |_| true);
                let motion = match alone {
                    Ok(motion) => motion,
                    Err(error) => {
                        assert!(
                            summary.failures.iter().any(|f| f.body == body && f.error == error),
                            "{error}"
                        );
                        continue;
                    }
                };
                let states = motion.states();
                assert_eq!(summary.method(body), motion.certificate.method);
                assert_eq!(summary.steps[body], motion.certificate.steps);
                for (k, row) in found[body * TIMES.len()..][..TIMES.len()].iter().enumerate() {
                    let single = states.rotors[k].components().into_iter().chain(states.omegas[k].0);
                    let single = single.chain(states.momenta_space[k].0).chain([states.energies[k]]);
                    for (x, y) in row.iter().zip(single) {
                        // 120 steps of up to 51 roundings at random, magnified some times.
                        let bound = 20.0 * f64::EPSILON * (120.0 * 51.0_f64).sqrt() * y.abs().max(1.0);
                        assert!((x - y).abs() <= bound, "{method}, body {body}, t = {}: {x} {y}", TIMES[k]);
                    }
                }
            }
        }
    }
}

#[test]
fn bodies_are_independent_of_threads_and_each_other() {
    let count = 70;
    let all = ensemble(count, vec![weights(count), dampings(count)]);
    for method in ["rk4", "strang", "kahan_li6"] {
        let options = stepped(method, 0.05);
        let (found, _) = points(&all, &TIMES, &options, 1);
        for threads in [2, 3, 7] {
            assert_eq!(points(&all, &TIMES, &options, threads).0, found, "{method}");
        }
        for body in [0, 33, 69] {
            let one = Ensemble {
                inertias: Rows::new(vec![*all.inertias.of(body)]),
                starts: vec![all.starts[body]],
                laws: all.laws.iter().map(|law| Rows::new(vec![law.of(body).clone()])).collect(),
                ..all.clone()
            };
            let (alone, _) = points(&one, &TIMES, &options, 1);
            assert_eq!(alone, found[body * TIMES.len()..][..TIMES.len()], "{method} {body}");
        }
    }
}

#[test]
fn failures_are_reported_and_the_others_continue() {
    let count = 40;
    let healthy = ensemble(count, vec![Rows::new(vec![Torque::ConstantBody(Bivector::default()); count])]);
    let mut broken = healthy.clone();
    let mut torques = vec![Torque::ConstantBody(Bivector::default()); count];
    torques[17] = Torque::ConstantBody(Bivector([1e200, 0.0, 0.0]));
    broken.laws = vec![Rows::new(torques)];
    for method in ["rk4", "strang"] {
        let options = stepped(method, 0.05);
        let (expected, _) = points(&healthy, &TIMES, &options, 2);
        let (found, summary) = points(&broken, &TIMES, &options, 2);
        let [Failure { body: 17, error: SimulateError::Diverged { .. }, .. }] = &summary.failures[..] else {
            panic!("{method}: {:?}", summary.failures)
        };
        for body in (0..count).filter(|&body| body != 17) {
            assert_eq!(found[body * 5..][..5], expected[body * 5..][..5]);
        }
        assert!(found[17 * 5 + 4].iter().all(|x| x.is_nan()));
    }
}

#[test]
fn a_run_can_be_stopped() {
    let all = ensemble(40, vec![]);
    let [mut a, mut b, mut c, mut d] = [4, 3, 3, 1].map(|n| vec![0.0; n * 40]);
    let outputs =
        Outputs { rotors: &mut a, omegas: &mut b, momenta: &mut c, energies: &mut d, centers: None };
    let result = all.run(&[1e6], &stepped("rk4", 0.01), Threads::new(2), outputs, &mut |_| false);
    assert_eq!(result, Err(SimulateError::Interrupted));
}

/// Points and conserved quantities are measured in lanes with the bits of a single body.
#[test]
fn certificates_have_the_bits_of_single_runs() {
    let count = 37;
    let wheel = Rows::new(vec![Torque::Wheel(Bivector([0.1, 0.2, -0.3]))]);
    let field = Torque::Magnetic { dipole: Vector([0.1, 0.2, 0.3]), field: Vector([0.3, 0.0, 0.4]) };
    let lists = [
        vec![],
        vec![weights(count)],
        vec![wheel.clone()],
        vec![Rows::new(vec![field])],
        vec![weights(count), dampings(count), wheel],
    ];
    for laws in lists {
        let mut all = ensemble(count, laws);
        all.starts[3].omega = Bivector::default();
        for method in ["rk4", "strang"] {
            let (found, summary) = points(&all, &[0.0], &stepped(method, 0.05), 2);
            let again = points(&all, &[0.0], &stepped(method, 0.05), 3).1;
            assert_eq!(format!("{again:?}"), format!("{summary:?}"));
            let mut named = 0;
            for (body, row) in found.iter().enumerate() {
                let alone = all.problem(body).simulate(&[0.0], stepped(method, 0.05), &mut |_| true).unwrap();
                let states = alone.states();
                let single = states.rotors[0].components().into_iter().chain(states.omegas[0].0);
                let single = single.chain(states.momenta_space[0].0).chain([states.energies[0]]);
                // The method by components stores ω, of which it computes the momentum again.
                if method == "strang" {
                    assert_eq!(row.to_vec(), single.collect::<Vec<f64>>());
                    assert_eq!(summary.norm_drifts[body], alone.certificate.norm_drift);
                }
                for (quantity, start, drift) in &alone.certificate.drifts {
                    let drifts = summary.drifts.iter().find(|drift| drift.name == quantity.name()).unwrap();
                    assert_eq!(drifts.values[body], *start, "{}", quantity.name());
                    assert!((drifts.changes[body] - drift).abs() <= 8.0 * f64::EPSILON);
                }
                named += alone.certificate.drifts.len();
            }
            let known = summary.drifts.iter().flat_map(|drift| &drift.values);
            assert_eq!(known.filter(|value| !value.is_nan()).count(), named);
        }
    }
}

/// A panic of one thread is passed on, and no thread waits for it.
#[test]
fn a_panic_ends_the_run() {
    let count = 40;
    let law = Torque::Function(Function::new(|seen| {
        assert!(seen.omega.norm() < 1e-3, "too fast");
        Ok(Bivector([0.0, 0.0, 1.0]))
    }));
    let all = ensemble(count, vec![Rows::new(vec![law])]);
    let [mut a, mut b, mut c, mut d] = [4, 3, 3, 1].map(|n| vec![0.0; n * count]);
    let outputs =
        Outputs { rotors: &mut a, omegas: &mut b, momenta: &mut c, energies: &mut d, centers: None };
    let run =
        AssertUnwindSafe(|| all.run(&[1.0], &Options::default(), Threads::new(3), outputs, &mut |_| true));
    assert!(catch_unwind(run).is_err());
}
