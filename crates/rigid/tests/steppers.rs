//! Properties of the stepping methods: order, symmetry, conservation, errors.

use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::laws::torque::{Orbit, Torque};
use polhode_rigid::methods::classical::Classical;
use polhode_rigid::methods::midpoint::Midpoint;
use polhode_rigid::methods::moser_veselov::MoserVeselov;
use polhode_rigid::methods::runge_kutta::RungeKutta;
use polhode_rigid::methods::splitting::{COMPOSITIONS, RKN6, Splitting};
use polhode_rigid::state::carried::Carried;
use polhode_rigid::state::center::Center;
use polhode_rigid::state::phase::{Gyrostat, Phase};

const EPS: f64 = f64::EPSILON;

type Step = Box<dyn Fn(&mut Phase, f64)>;

/// A method at work: its name, its order, and one step of it.
struct Stepper {
    name: &'static str,
    order: f64,
    step: Step,
}

fn body() -> Gyrostat {
    Gyrostat::rigid([1.0, 2.0, 2.5])
}

fn with_wheel() -> (Gyrostat, Torque) {
    let wheel = Bivector([0.5, -0.25, 1.0]);
    (Gyrostat { wheel, ..body() }, Torque::Wheel(wheel))
}

fn heavy() -> Torque {
    Torque::Heavy(Vector([0.5, 0.25, 1.0]))
}

fn start(body: &Gyrostat) -> Phase {
    let rotor = Rotor::from_components([4.0, 1.0, -2.0, 1.0]).unwrap();
    Phase { rotor, momentum: body.momentum(Bivector([0.5, 0.25, 1.5])), time: 0.0 }
}

/// Every method that supports the laws.
fn steppers(body: Gyrostat, torques: &[Torque]) -> Vec<Stepper> {
    let from = start(&body);
    let mut all = Vec::new();
    for composition in &COMPOSITIONS {
        let splitting = Splitting::new(body, torques.to_vec(), composition, &from);
        let step = Box::new(move |state: &mut Phase, h: f64| {
            splitting.step(state, &mut Bivector::default(), h).unwrap()
        });
        all.push(Stepper { name: composition.name, order: f64::from(composition.order), step });
    }
    let classical = Classical::new(body, torques.to_vec(), None);
    let step = Box::new(move |state: &mut Phase, h: f64| {
        *state = classical.step(&Carried::new(*state, Center::default()), h).unwrap().phase;
    });
    all.push(Stepper { name: "rk4", order: 4.0, step });
    let runge_kutta = RungeKutta::new(body, torques.to_vec(), None);
    let step = Box::new(move |state: &mut Phase, h: f64| {
        *state = runge_kutta.step(&Carried::new(*state, Center::default()), h, 1.0).unwrap().0.phase;
    });
    all.push(Stepper { name: "dop853", order: 8.0, step });
    let midpoint = Midpoint::new(body, torques.to_vec(), &from);
    let step = Box::new(move |state: &mut Phase, h: f64| midpoint.step(state, h).unwrap());
    all.push(Stepper { name: "midpoint", order: 2.0, step });
    if body.wheel == Bivector::default() {
        let moser_veselov = MoserVeselov::new(body, torques.to_vec(), &from);
        // Without kicks the modified moments raise it to order 4.
        let order = if torques.is_empty() { 4.0 } else { 2.0 };
        let step = Box::new(move |state: &mut Phase, h: f64| moser_veselov.step(state, h).unwrap());
        all.push(Stepper { name: "dmv", order, step });
        if torques.iter().all(|t| t.damping_rate() == 0.0) {
            let splitting = Splitting::new(body, torques.to_vec(), &RKN6, &from);
            let step = Box::new(move |state: &mut Phase, h: f64| {
                splitting.step(state, &mut Bivector::default(), h).unwrap()
            });
            all.push(Stepper { name: RKN6.name, order: 6.0, step });
        }
    }
    all
}

fn walked(stepper: &Stepper, from: Phase, h: f64, steps: usize) -> Phase {
    let mut state = from;
    for _ in 0..steps {
        (stepper.step)(&mut state, h);
    }
    state
}

fn apart(a: &Phase, b: &Phase) -> f64 {
    let (r, s) = (a.rotor.components(), b.rotor.components());
    let turn = (0..4).map(|k| (r[k] - s[k]).powi(2)).sum::<f64>().sqrt();
    turn.max((a.momentum - b.momentum).norm() / b.momentum.norm())
}

/// The slope of log(error) against log(step) between steps whose errors are above rounding.
fn assert_orders(body: Gyrostat, torques: &[Torque]) {
    let (from, time) = (start(&body), 4.0);
    let all = steppers(body, torques);
    let reference = all.iter().find(|s| s.name == "kahan_li8").unwrap();
    let exact = walked(reference, from, time / 256.0, 256);
    for stepper in &all {
        let error = |steps: usize| apart(&walked(stepper, from, time / steps as f64, steps), &exact);
        // From the step at which the higher powers of it no longer count, over as much as rounding leaves.
        let (small, finer) = if stepper.order < 6.0 { (1e-5, 4.0) } else { (1e-7, 3.0) };
        let mut coarse = 8;
        while error(coarse) > small {
            coarse *= 2;
        }
        let slope = (error(coarse) / error(coarse * finer as usize)).ln() / f64::ln(finer);
        // The terms of the powers 8 and 9 of dop853 are of one size until both are rounding.
        let margin = if stepper.name == "dop853" { 0.9 } else { 0.2 };
        let exact_by_construction = error(coarse) < 1e-13;
        assert!(
            exact_by_construction || (slope - stepper.order).abs() < margin,
            "{} {torques:?}: {slope}",
            stepper.name
        );
    }
}

#[test]
fn orders_of_free_bodies() {
    assert_orders(body(), &[]);
}

#[test]
fn orders_of_heavy_bodies() {
    assert_orders(body(), &[heavy()]);
}

#[test]
fn orders_under_damping() {
    assert_orders(body(), &[heavy(), Torque::Damping(0.25)]);
}

#[test]
fn orders_of_bodies_with_a_wheel() {
    let (body, wheel) = with_wheel();
    assert_orders(body, std::slice::from_ref(&wheel));
    assert_orders(body, &[wheel, heavy(), Torque::Damping(0.25)]);
}

/// A step forward and the same step back return, except for Runge–Kutta methods.
#[test]
fn symmetric_methods_return() {
    let (gyrostat, wheel) = with_wheel();
    let problems: [(Gyrostat, Vec<Torque>); 4] = [
        (body(), vec![]),
        (body(), vec![heavy()]),
        (body(), vec![heavy(), Torque::GravityGradient(Orbit::circular(0.5)), Torque::Damping(0.25)]),
        (gyrostat, vec![wheel, heavy()]),
    ];
    for (body, torques) in problems {
        for stepper in steppers(body, &torques) {
            let (from, h, steps) = (start(&body), 0.125, 40);
            let there = walked(&stepper, from, h, steps);
            let back = apart(&walked(&stepper, there, -h, steps), &from);
            // Two times 40 steps of up to 51 turns, each rounded, and magnified some tens of times.
            let rounding = 100.0 * EPS * (80.0 * 51.0_f64).sqrt();
            match stepper.name {
                "rk4" => assert!(back > 1e-9, "{back}"),
                "dop853" => assert!(back < 1e-9, "{back}"),
                name => assert!(back < rounding, "{name} {torques:?}: {back}"),
            }
        }
    }
}

/// The energy with its largest change over a run, and the same of L and |m|.
fn drifts(stepper: &Stepper, body: &Gyrostat, potential: impl Fn(&Phase) -> f64) -> [f64; 4] {
    let from = start(body);
    let energy = |s: &Phase| body.kinetic(s.momentum) + potential(s);
    let space = |s: &Phase| s.rotor.apply_bivector(s.momentum);
    let (mut state, mut worst) = (from, [0.0_f64; 4]);
    for _ in 0..20_000 {
        (stepper.step)(&mut state, 0.1);
        let changes = [
            energy(&state) / energy(&from) - 1.0,
            (space(&state) - space(&from)).norm() / from.momentum.norm(),
            (space(&state).0[2] - space(&from).0[2]) / from.momentum.norm(),
            state.momentum.norm() / from.momentum.norm() - 1.0,
        ];
        for (w, change) in worst.iter_mut().zip(changes) {
            *w = w.max(change.abs());
        }
    }
    worst
}

#[test]
fn conserved_quantities_of_free_bodies() {
    // 20,000 steps of up to 51 roundings at random.
    let rounding = 4.0 * EPS * (51.0 * 20_000.0_f64).sqrt();
    let (gyrostat, wheel) = with_wheel();
    for (body, torques) in [(body(), vec![]), (gyrostat, vec![wheel])] {
        for stepper in steppers(body, &torques) {
            let [energy, l, _, size] = drifts(&stepper, &body, |_| 0.0);
            assert!(stepper.name == "rk4" || l < rounding && size < rounding, "{}: {l} {size}", stepper.name);
            match stepper.name {
                "midpoint" | "dmv" | "rkn6" => assert!(energy < rounding, "{}: {energy}", stepper.name),
                "rk4" => assert!(energy > rounding, "{energy}"),
                // Bounded by the error of a step, which does not add up.
                _ => assert!(energy < 2e-3, "{}: {energy}", stepper.name),
            }
        }
    }
}

#[test]
fn heavy_bodies_keep_vertical_momentum_and_do_not_gain_energy() {
    let rounding = 4.0 * EPS * (51.0 * 20_000.0_f64).sqrt();
    let c = Vector([0.5, 0.25, 1.0]);
    for stepper in steppers(body(), &[heavy()]) {
        let [energy, _, vertical, _] = drifts(&stepper, &body(), |s| s.vertical().dot(c));
        assert!(stepper.name == "rk4" || vertical < rounding, "{}: {vertical}", stepper.name);
        let bound = match stepper.name {
            "rk4" => continue,
            _ if stepper.order == 2.0 => 3e-2,
            _ => 2e-3,
        };
        assert!(energy < bound, "{}: {energy}", stepper.name);
    }
}

/// `γ` is the third row of the matrix of R.
#[test]
fn vertical_direction() {
    let from = start(&body());
    let expected = from.rotor.reverse().apply(Vector([0.0, 0.0, 1.0]));
    assert!((from.vertical() - expected).norm() < 4.0 * EPS);
}

/// Each step ends with one Newton step towards |R| = 1, so that the rounding of any number of steps is that of one.
#[test]
fn ten_million_steps_leave_the_rotor_a_rotor() {
    let body = body();
    let from = start(&body);
    let splitting = Splitting::new(body, vec![], &COMPOSITIONS[0], &from);
    let (mut state, mut worst) = (from, 0.0_f64);
    for _ in 0..10_000_000 {
        splitting.step(&mut state, &mut Bivector::default(), 0.01).unwrap();
        let square: f64 = state.rotor.components().iter().map(|x| x * x).sum();
        worst = worst.max((square - 1.0).abs());
    }
    assert!(worst <= 4.0 * EPS, "{worst}");
    let space = state.rotor.apply_bivector(state.momentum);
    let fixed = from.rotor.apply_bivector(from.momentum);
    assert!((space - fixed).norm() <= 1e-12 * fixed.norm(), "{:e}", (space - fixed).norm());
}

#[test]
fn zero_components_stay_zero_on_the_unstable_axis() {
    let body = body();
    let from = Phase { momentum: Bivector([0.0, 2.0, 0.0]), ..start(&body) };
    for stepper in steppers(body, &[]) {
        if matches!(stepper.name, "rk4" | "dop853" | "rkn6") {
            continue;
        }
        let late = walked(&stepper, from, 0.125, 8000);
        assert!(late.momentum.0[0] == 0.0 && late.momentum.0[2] == 0.0, "{} {late:?}", stepper.name);
    }
}

/// Of `m' = −g m` with `hg = 10⁴` the rule makes `m' = −m (1 − ½hg)/(1 + ½hg)` times a turn: it shrinks, slowly.
#[test]
fn the_midpoint_rule_survives_stiff_damping() {
    let (gyrostat, wheel) = with_wheel();
    for (body, torques) in [
        (body(), vec![Torque::Damping(1e5)]),
        (body(), vec![Torque::Damping(1e5), heavy()]),
        (gyrostat, vec![wheel, Torque::Damping(1e5)]),
    ] {
        let from = start(&body);
        let midpoint = Midpoint::new(body, torques.clone(), &from);
        let mut state = from;
        let mut last = body.omega(state.momentum).norm();
        for _ in 0..1000 {
            midpoint.step(&mut state, 0.1).unwrap();
            let now = body.omega(state.momentum).norm();
            assert!(now <= last * 2.6, "{now} {last} {torques:?}");
            last = last.min(now.max(1e-3));
        }
        assert!(last < 2.0, "{last}");
    }
}

#[test]
fn steps_that_are_too_long_are_errors() {
    let body = body();
    let mut state = start(&body);
    let error = MoserVeselov::new(body, vec![], &state).step(&mut state, 4.0).unwrap_err();
    assert!(
        error.to_string().contains("4e0 s") && error.to_string().contains("use steps of at most"),
        "{error}"
    );
    // A pull of 10⁴ N m on a body of 1 kg m² swings it a hundred times a second.
    let mut errors = Vec::new();
    for k in 1..=10 {
        let mut state = start(&body);
        let pull = Torque::Heavy(Vector([1e4, 0.0, 2e3]));
        let h = 0.05 * f64::from(k);
        match Midpoint::new(body, vec![pull], &state).step(&mut state, h) {
            Ok(()) => assert!(state.momentum.norm().is_finite()),
            Err(error) => errors.push(error.to_string()),
        }
    }
    assert!(!errors.is_empty() && errors.iter().all(|e| e.contains("use a shorter step")), "{errors:?}");
}

#[test]
fn methods_have_names() {
    use polhode_rigid::methods::{Method, methods};
    let names: Vec<&str> = methods().map(Method::name).collect();
    assert_eq!(
        names,
        [
            "strang",
            "yoshida4",
            "yoshida6",
            "kahan_li6",
            "kahan_li8",
            "rkn6",
            "rk4",
            "dop853",
            "midpoint",
            "dmv"
        ]
    );
    for method in methods() {
        assert_eq!(Method::from_name(method.name()), Some(method));
    }
}
