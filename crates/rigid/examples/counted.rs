//! Kernels for counting instructions: `counted` lists them with the rows that one run computes; `counted NAME RUNS`
//! runs one. `benchmarks/instructions.py` compares two numbers of runs under valgrind.

use polhode_ga::formula::{Meaning, Names, Runner, Space, Type, compile, parse};
use polhode_ga::g3::functions::Function;
use polhode_ga::product::{Grades, Plan, Product};
use polhode_ga::rows::compose::compose;
use polhode_ga::rows::motors::{self, Motors};
use polhode_ga::rows::product::turn;
use polhode_ga::rows::rotor_functions;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::{Algebra, Signature};
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::ensemble::{Ensemble, Outputs, Rows, Start};
use polhode_rigid::exact::free::{FreeBody, FreeMotion};
use polhode_rigid::exact::lagrange::HeavyTop;
use polhode_rigid::exact::many::Tile;
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::torque::{Axes, Gains, Orbit, Torque};
use polhode_rigid::methods::Method;
use polhode_rigid::run::Options;
use polhode_rigid::state::center::Center;
use std::hint::black_box;

const ROWS: usize = 1024;
const BODIES: usize = 64;
const STEPS: usize = 64;

/// A name, the rows of one run, and the run.
type Kernel = (&'static str, usize, Box<dyn FnMut()>);

/// Numbers of either sign, none special.
fn numbers(count: usize) -> Vec<f64> {
    (0..count).map(|i| (i * 7919 % 1009) as f64 / 500.0 - 1.001).collect()
}

fn product(name: &'static str, p: usize, r: usize, ga: u16, gb: u16) -> Kernel {
    let algebra = Algebra::new(Signature { p, q: 0, r }).expect("few generators");
    let plan = Plan::new(&algebra, Product::Geometric, Grades(ga), Grades(gb));
    let (a, b) = (numbers(ROWS * plan.sizes.0), numbers(ROWS * plan.sizes.1));
    let mut out = numbers(ROWS * plan.sizes.2);
    (name, ROWS, Box::new(move || plan.run(Threads::ONE, black_box(&a), &b, &mut out)))
}

fn rotors() -> Vec<f64> {
    let mut rotors = vec![0.0; 4 * ROWS];
    let planes: Vec<f64> = numbers(3 * ROWS).iter().map(|x| 3.0 * x).collect();
    rotor_functions::exp(Threads::ONE, &planes, &mut rotors).expect("finite planes");
    rotors
}

fn of_rotors(name: &'static str, width: usize, mut run: impl FnMut(&[f64], &mut [f64]) + 'static) -> Kernel {
    let (rotors, mut out) = (rotors(), vec![0.0; width * ROWS]);
    (name, ROWS, Box::new(move || run(black_box(&rotors), &mut out)))
}

/// A function of motors.
fn of_motors(name: &'static str, f: Function) -> Kernel {
    let algebra = Algebra::pga(3).expect("few generators");
    let motors = Motors::new(&algebra).expect("the algebra of motors");
    let bivectors = numbers(motors::BIVECTOR * ROWS);
    let [mut rows, mut out] = [(); 2].map(|()| vec![0.0; motors::SIZE * ROWS]);
    motors.run(Function::Exp, Threads::ONE, &bivectors, &mut rows).expect("finite bivectors");
    let given = if f == Function::Exp { bivectors } else { rows };
    (name, ROWS, Box::new(move || motors.run(f, Threads::ONE, black_box(&given), &mut out).expect("motors")))
}

/// Equal steps of bodies in lanes.
fn stepped(name: &'static str, method: &'static str, laws: Vec<Torque>) -> Kernel {
    let options = Options { method: Method::from_name(method), step: Some(0.01), ..Options::default() };
    ensemble(name, BODIES * STEPS, options, laws)
}

/// A run of an ensemble, whose results have this number of rows to count.
fn ensemble(name: &'static str, rows: usize, options: Options, laws: Vec<Torque>) -> Kernel {
    let start = |i: usize| Start {
        time: 0.0,
        rotor: Rotor::IDENTITY,
        omega: Bivector([0.01 * i as f64 / BODIES as f64, 1.0, 0.01]),
        center: Center::default(),
    };
    let ensemble = Ensemble {
        inertias: Rows::new(vec![Inertia::from_principal_moments([1.0, 2.0, 3.0]).expect("a body's")]),
        starts: (0..BODIES).map(start).collect(),
        laws: laws.into_iter().map(|law| Rows::new(vec![law])).collect(),
        masses: Rows::new(vec![1.0]),
        forces: vec![],
    };
    let times = [0.01 * STEPS as f64];
    let run = move || {
        let [mut rotors, mut omegas, mut momenta, mut energies] = [4, 3, 3, 1].map(|n| vec![0.0; n * BODIES]);
        let outputs = Outputs {
            rotors: &mut rotors,
            omegas: &mut omegas,
            momenta: &mut momenta,
            energies: &mut energies,
            centers: None,
        };
        let summary = ensemble.run(&times, &options, Threads::ONE, outputs, &mut |_| true);
        assert!(summary.is_ok_and(|summary| summary.failures.is_empty()));
    };
    (name, rows, Box::new(run))
}

/// A formula of a rotor and vectors over many rows.
fn over_rows(text: &'static str) -> Kernel {
    let vector = Type::of(Grades(0b0010));
    let types = [("R", Type::ROTOR), ("v", vector), ("a", vector), ("b", vector), ("c", vector)];
    let names = Names::new(types.map(|(name, ty)| (name.into(), Meaning::Value(ty))));
    let tree = parse(text, Space::g3(), &names).expect("a formula");
    let runner =
        Runner::new(&compile(&tree, Space::g3(), &names).expect("of known names")).expect("3-d space");
    let (rotors, vectors, mut out) = (rotors(), numbers(3 * ROWS), vec![0.0; 3 * ROWS]);
    let run = move || {
        let inputs = [black_box(&rotors[..]), &vectors, &vectors, &vectors, &vectors];
        runner.run(Threads::ONE, &inputs, &mut [&mut out], 0..ROWS).expect("it has values");
    };
    (text, ROWS, Box::new(run))
}

fn formula(text: &str) -> Vec<Torque> {
    let law = Formula::new(text, Purpose::Torque(Axes::Body), Names::new([]), |_| None);
    vec![Torque::Formula(law.expect("a bivector of known names"))]
}

fn controller() -> Torque {
    let (stiffness, damping) = (Gains::new([2.0, 3.0, 4.0]), Gains::new([0.5, 0.6, 0.7]));
    Torque::Control { stiffness, damping, target: Rotor::exp(Bivector([0.3, 0.2, 0.1])) }
}

/// The exact free motion at many times.
fn exact() -> Kernel {
    let motion = FreeMotion::in_principal_axes([1.0, 2.0, 3.0], Rotor::IDENTITY, Bivector([0.01, 1.0, 0.01]));
    let times: Vec<f64> = (0..ROWS).map(|i| 0.1 * i as f64).collect();
    let (mut rotors, mut omegas) = (vec![0.0; 4 * ROWS], vec![0.0; 3 * ROWS]);
    let run = move || motion.at_many(Threads::ONE, black_box(&times), &mut rotors, &mut omegas);
    ("exact states of a free body", ROWS, Box::new(run))
}

/// The set-up of tumbling bodies in closed form.
fn free_set_up() -> Kernel {
    let moments = Inertia::from_principal_moments([1.0, 2.0, 3.0]).expect("a body's");
    let body =
        move |w: &[f64; 3]| FreeBody::new(&moments, Rotor::IDENTITY, Bivector([0.5 + w[0], w[1], w[2]]));
    let starts = numbers(3 * ROWS);
    let run = move || {
        let bodies = black_box(&starts).as_chunks().0.iter().map(body);
        black_box(Tile::free(bodies).expect("positive moments"));
    };
    ("set-up of a free body", ROWS, Box::new(run))
}

/// The set-up of heavy tops in closed form.
fn heavy_set_up() -> Kernel {
    let moments = Inertia::from_principal_moments([1.0, 1.0, 0.5]).expect("a body's");
    let tilted = Rotor::exp(Bivector([-0.25, 0.0, 0.0]));
    let top = move |w: &[f64; 3]| {
        let omega = Bivector([0.1 * w[0], 0.1 * w[1], 4.0 + w[2]]);
        HeavyTop::new(&moments, tilted, omega, Vector([0.0, 0.0, 2.0])).map_err(|error| error.to_string())
    };
    let starts = numbers(3 * ROWS);
    let run = move || {
        let tops = black_box(&starts).as_chunks().0.iter().map(top);
        black_box(Tile::lagrange(tops).expect("symmetric tops"));
    };
    ("set-up of a heavy top", ROWS, Box::new(run))
}

fn kernels() -> Vec<Kernel> {
    let (planes, vectors) = (numbers(3 * ROWS), numbers(3 * ROWS));
    let gradient = || vec![Torque::GravityGradient(Orbit::circular(0.1))];
    vec![
        product("vector * vector", 3, 0, 0b0010, 0b0010),
        product("full * full", 3, 0, 0b1111, 0b1111),
        product("full * full, Cl(3,0,1)", 3, 1, 0b11111, 0b11111),
        of_rotors("rotor * rotor", 4, |r, out| compose(Threads::ONE, r, r, out)),
        of_rotors("R v ~R", 3, move |r, out| turn(Threads::ONE, r, &vectors, Grades(0b0010), out)),
        of_rotors("exp", 4, move |_, out| rotor_functions::exp(Threads::ONE, &planes, out).expect("finite")),
        of_rotors("log", 3, |r, out| rotor_functions::log(Threads::ONE, r, out).expect("finite")),
        of_motors("exp of a motor", Function::Exp),
        of_motors("log of a motor", Function::Log),
        over_rows("R v ~R + (a∧b)·c"),
        exact(),
        free_set_up(),
        heavy_set_up(),
        ensemble("short run of a free body", BODIES, Options::default(), vec![]),
        stepped("free body, rk4", "rk4", vec![]),
        stepped("free body, kahan_li8", "kahan_li8", vec![]),
        stepped("gravity gradient, rk4", "rk4", gradient()),
        stepped("gravity gradient, kahan_li8", "kahan_li8", gradient()),
        stepped("controller, rk4", "rk4", vec![controller()]),
        stepped("formula, rk4", "rk4", formula("-(0.1 e1 + 0.2 e2 + 0.3 e3) ∧ (~R e3 R)")),
        stepped(
            "formula of time, rk4",
            "rk4",
            formula("-0.01 (1 + sin(t)) Ω + (~R e3 R) ∧ (0.1 e1 + 0.3 e3)"),
        ),
    ]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, runs] = arguments.as_slice() else {
        for (name, rows, _) in kernels() {
            println!("{rows}\t{name}");
        }
        return;
    };
    let runs: usize = runs.parse().expect("a number of runs");
    let mut kernel = kernels().into_iter().find(|kernel| kernel.0 == name).expect("a name from the list").2;
    for _ in 0..runs {
        kernel();
    }
}
