//! Reported quantities are conserved, and others are not reported.
//!
//! A classical Runge–Kutta step of length 1e-3 follows `R' = −½ R Ω` and `m' = Ω × I(Ω) + T` to h⁵, some roundings. A
//! conserved quantity changes by roundings of its terms, any other by a thousandth of them.

use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::laws::conserved::Conserved;
use polhode_rigid::laws::torque::{Orbit, Torque, total, turn_from, wheel};
use polhode_rigid::methods::Method;
use polhode_rigid::run::{Options, Problem};
use polhode_rigid::state::phase::{Gyrostat, Phase};
use polhode_rigid::state::point::Point;

const STEP: f64 = 1e-3;

/// Rotor components and momentum, with their rates.
fn rate(body: &Gyrostat, torques: &[Torque], y: [f64; 7], time: f64) -> [f64; 7] {
    let state = phase(y, time);
    let omega = body.omega(state.momentum);
    let [s, x, z, w] = (state.rotor * Rotor::from_unit_components([0.0, omega.0[0], omega.0[1], omega.0[2]]))
        .components()
        .map(|c| -0.5 * c);
    let Bivector(m) =
        omega.commutator(body.carried(omega)) + total(torques, &Point::at_rest(body, &state)).unwrap();
    [s, x, z, w, m[0], m[1], m[2]]
}

fn phase(y: [f64; 7], time: f64) -> Phase {
    let rotor = Rotor::from_unit_components([y[0], y[1], y[2], y[3]]);
    Phase { rotor, momentum: Bivector([y[4], y[5], y[6]]), time }
}

fn step(body: &Gyrostat, torques: &[Torque], start: &Phase) -> Phase {
    let [s, x, y, z] = start.rotor.components();
    let Bivector([a, b, c]) = start.momentum;
    let (y0, t, h) = ([s, x, y, z, a, b, c], start.time, STEP);
    let along = |k: [f64; 7], h: f64| std::array::from_fn(|i| y0[i] + h * k[i]);
    let k1 = rate(body, torques, y0, t);
    let k2 = rate(body, torques, along(k1, 0.5 * h), t + 0.5 * h);
    let k3 = rate(body, torques, along(k2, 0.5 * h), t + 0.5 * h);
    let k4 = rate(body, torques, along(k3, h), t + h);
    phase(std::array::from_fn(|i| y0[i] + h * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0), t + h)
}

/// A motion's start: moments, laws, and the state.
struct Case {
    body: Gyrostat,
    torques: Vec<Torque>,
    start: Phase,
}

fn case(moments: [f64; 3], torques: Vec<Torque>) -> Case {
    let body = Gyrostat { moments, wheel: wheel(&torques) };
    let rotor = Rotor::from_components([4.0, 1.0, -2.0, 1.0]).unwrap();
    let start = Phase { rotor, momentum: body.momentum(Bivector([0.5, -0.25, 1.5])), time: 0.7 };
    Case { body, torques, start }
}

impl Case {
    fn names(&self) -> Vec<&'static str> {
        Conserved::under(&self.body, &self.torques, &self.start).map(Conserved::name).collect()
    }

    /// The change of a quantity over a step, relative to its scale.
    fn change(&self, quantity: Conserved) -> f64 {
        let end = step(&self.body, &self.torques, &self.start);
        let value = |state| quantity.value(&self.body, &self.torques, state);
        (value(&end) - value(&self.start)).abs() / quantity.scale(&self.body, &self.torques, &self.start)
    }

    /// The reported quantities have these names and are conserved.
    fn holds(&self, names: &[&str]) {
        assert_eq!(self.names(), names);
        for quantity in Conserved::under(&self.body, &self.torques, &self.start) {
            let change = self.change(quantity);
            assert!(change <= 64.0 * f64::EPSILON, "{}: {change:e}", quantity.name());
        }
    }

    /// A quantity of another case is not reported, and changes.
    fn breaks(&self, other: &Case, broken: &str) {
        assert!(!self.names().contains(&broken), "{broken} is said to be conserved");
        let mut quantity = Conserved::under(&other.body, &other.torques, &other.start);
        let quantity = quantity.find(|q| q.name() == broken).unwrap();
        assert!(self.change(quantity) > 1e-7, "{broken} would hold: {:e}", self.change(quantity));
    }
}

const E1: Vector = Vector([1.0, 0.0, 0.0]);
const E3: Vector = Vector([0.0, 0.0, 1.0]);

fn heavy(c: [f64; 3]) -> Torque {
    Torque::Heavy(Vector(c))
}

fn magnetic(field: Vector) -> Torque {
    Torque::Magnetic { dipole: Vector([0.3, -0.7, 0.2]), field }
}

fn spring() -> Torque {
    Torque::TorsionSpring { stiffness: 1.5, rest: Rotor::from_components([1.0, 0.2, 0.3, -0.1]).unwrap() }
}

fn along_e3() -> Torque {
    Torque::Wheel(Bivector([0.0, 0.0, 0.8]))
}

fn askew() -> Torque {
    Torque::Wheel(Bivector([0.4, -0.3, 0.8]))
}

const ASYMMETRIC: [f64; 3] = [1.0, 2.0, 2.5];
const SYMMETRIC: [f64; 3] = [1.3, 1.3, 0.5];

#[test]
fn free_bodies_and_gyrostats() {
    case(ASYMMETRIC, vec![]).holds(&["energy", "angular_momentum"]);
    case(ASYMMETRIC, vec![askew(), along_e3()]).holds(&["energy", "angular_momentum"]);
    let straight = case(SYMMETRIC, vec![along_e3()]);
    straight.holds(&["energy", "angular_momentum", "spin_angular_momentum"]);
    case(SYMMETRIC, vec![askew()]).breaks(&straight, "spin_angular_momentum");
    case([1.1; 3], vec![askew()]).holds(&["energy", "angular_momentum", "spin_angular_momentum"]);
}

#[test]
fn heavy_bodies() {
    let both = ["energy", "vertical_angular_momentum"];
    case(ASYMMETRIC, vec![heavy([0.5, 0.25, 1.0])]).holds(&both);
    case(ASYMMETRIC, vec![heavy([0.5, 0.25, 1.0]), askew()]).holds(&both);
    let lagrange = case(SYMMETRIC, vec![heavy([0.0, 0.0, 2.0]), along_e3()]);
    lagrange.holds(&["energy", "vertical_angular_momentum", "spin_angular_momentum"]);
    case(SYMMETRIC, vec![heavy([0.1, 0.0, 2.0])]).breaks(&lagrange, "spin_angular_momentum");
    case([1.3, 1.2, 0.5], vec![heavy([0.0, 0.0, 2.0])]).breaks(&lagrange, "spin_angular_momentum");
    case([1.1; 3], vec![heavy([0.5, 0.25, 1.0])]).holds(&[
        "energy",
        "vertical_angular_momentum",
        "spin_angular_momentum",
    ]);
    // On a sphere the axis is that of the weight, and the quantity the component of L along it.
    let sphere = case([1.1; 3], vec![heavy([3.0, 0.0, 4.0])]);
    let spin = Conserved::under(&sphere.body, &sphere.torques, &sphere.start).last().unwrap();
    let expected = sphere.start.momentum.dual().dot(Vector([0.6, 0.0, 0.8]));
    assert!((spin.value(&sphere.body, &sphere.torques, &sphere.start) - expected).abs() <= 1e-15);
    // A torque that is constant in the body, across the axis of symmetry or not.
    let across = case(SYMMETRIC, vec![Torque::ConstantBody(Bivector([0.3, -0.2, 0.0]))]);
    across.holds(&["spin_angular_momentum"]);
    let along = case(SYMMETRIC, vec![Torque::ConstantBody(Bivector([0.3, -0.2, 0.1]))]);
    along.breaks(&across, "spin_angular_momentum");
    let mixed = case(ASYMMETRIC, vec![heavy([0.5, 0.25, 1.0]), Torque::Damping(0.1)]);
    assert!(mixed.names().is_empty());
    mixed.breaks(&case(ASYMMETRIC, vec![heavy([0.5, 0.25, 1.0])]), "energy");
}

#[test]
fn fields_along_one_axis() {
    let oblique = Vector([0.2, -0.4, 1.1]);
    let alone = case(ASYMMETRIC, vec![magnetic(oblique)]);
    alone.holds(&["energy", "axial_angular_momentum"]);
    case(ASYMMETRIC, vec![magnetic(oblique), magnetic(oblique * -2.0), askew()])
        .holds(&["energy", "axial_angular_momentum"]);
    let upright = case(ASYMMETRIC, vec![magnetic(E3 * -0.4), heavy([0.5, 0.25, 1.0])]);
    upright.holds(&["energy", "vertical_angular_momentum"]);
    case(ASYMMETRIC, vec![magnetic(oblique), heavy([0.5, 0.25, 1.0])])
        .breaks(&upright, "vertical_angular_momentum");
    case(ASYMMETRIC, vec![spring(), magnetic(oblique)]).holds(&["energy"]);
    case(ASYMMETRIC, vec![spring()]).breaks(&alone, "axial_angular_momentum");
}

#[test]
fn larmors_precession() {
    let b = Vector([0.125, 0.5, 1.0]);
    let larmor = case(ASYMMETRIC, vec![Torque::Larmor(b), askew()]);
    larmor.holds(&["angular_momentum", "axial_angular_momentum"]);
    let sphere = case([2.0; 3], vec![Torque::Larmor(b)]);
    sphere.holds(&["energy", "angular_momentum", "axial_angular_momentum"]);
    case([2.0; 3], vec![Torque::Larmor(b), askew()]).breaks(&sphere, "energy");
    case(ASYMMETRIC, vec![Torque::Larmor(b)]).breaks(&sphere, "energy");
    case(ASYMMETRIC, vec![Torque::Larmor(b), heavy([0.5, 0.25, 1.0])]).breaks(&larmor, "angular_momentum");
}

/// In any order of the axes, and with the centre of mass anywhere in their plane.
#[test]
fn kovalevskaya() {
    for turn in 0..3 {
        let turned = |x: [f64; 3]| std::array::from_fn(|k| x[(k + turn) % 3]);
        for c in [[1.0, 0.0, 0.0], [0.6, -0.8, 0.0], [0.0, 0.7, 0.0]] {
            let top = case(turned([2.0, 2.0, 1.0]), vec![heavy(turned(c))]);
            top.holds(&["energy", "vertical_angular_momentum", "kovalevskaya_integral"]);
            case(turned([2.0, 2.0, 1.1]), vec![heavy(turned(c))]).breaks(&top, "kovalevskaya_integral");
            let tilted = heavy(turned([c[0], c[1], 0.2]));
            case(turned([2.0, 2.0, 1.0]), vec![tilted]).breaks(&top, "kovalevskaya_integral");
            case(turned([2.0, 2.0, 1.0]), vec![heavy(turned(c)), askew()])
                .breaks(&top, "kovalevskaya_integral");
        }
    }
    let dipole = Torque::Magnetic { dipole: E1, field: Vector([0.3, 0.1, -0.5]) };
    for moments in [[2.0, 2.0, 1.0], [3.0, 3.0, 1.5]] {
        let laws = vec![dipole.clone()];
        case(moments, laws).holds(&["energy", "axial_angular_momentum", "kovalevskaya_integral"]);
    }
}

#[test]
fn goryachev_and_chaplygin() {
    for turn in 0..3 {
        let turned = |x: [f64; 3]| std::array::from_fn(|k| x[(k + turn) % 3]);
        for c in [[1.0, 0.0, 0.0], [0.6, -0.8, 0.0]] {
            let mut top = case(turned([4.0, 4.0, 1.0]), vec![heavy(turned(c))]);
            let spinning = case(turned([4.0, 4.0, 1.0]), vec![heavy(turned(c))]);
            // The part of L along the vertical, taken out.
            let vertical = top.start.rotor.reverse().apply(E3).undual();
            let about = top.start.momentum.dual().dot(vertical.dual());
            top.start.momentum = top.start.momentum - vertical * about;
            top.holds(&["energy", "vertical_angular_momentum", "goryachev_chaplygin_integral"]);
            spinning.breaks(&top, "goryachev_chaplygin_integral");
        }
    }
}

#[test]
fn satellites() {
    let circle = || Torque::GravityGradient(Orbit::new(1.2, 0.0, 0.4).unwrap());
    let alone = case(ASYMMETRIC, vec![circle()]);
    alone.holds(&["jacobi_integral"]);
    case(ASYMMETRIC, vec![circle(), askew()]).holds(&["jacobi_integral"]);
    case(ASYMMETRIC, vec![circle(), magnetic(E3 * 0.7), askew()]).holds(&["jacobi_integral"]);
    case(SYMMETRIC, vec![circle(), along_e3()]).holds(&["spin_angular_momentum", "jacobi_integral"]);
    case(ASYMMETRIC, vec![circle(), magnetic(E1)]).breaks(&alone, "jacobi_integral");
    let ellipse = Torque::GravityGradient(Orbit::new(1.2, 0.1, 0.4).unwrap());
    case(ASYMMETRIC, vec![ellipse.clone()]).breaks(&alone, "jacobi_integral");
    case(SYMMETRIC, vec![ellipse]).holds(&["spin_angular_momentum"]);
}

/// The scale of a quantity that vanishes, or of a body at rest, is the size its terms reach.
#[test]
fn scales_do_not_vanish() {
    for (i, integral) in [(2.0, "kovalevskaya_integral"), (4.0, "goryachev_chaplygin_integral")] {
        let mut top = case([i, i, 1.0], vec![heavy([1.0, 0.0, 0.0])]);
        top.start.momentum = Bivector::default();
        top.holds(&["energy", "vertical_angular_momentum", integral]);
        for quantity in Conserved::under(&top.body, &top.torques, &top.start) {
            assert!(quantity.scale(&top.body, &top.torques, &top.start) >= 1.0, "{}", quantity.name());
        }
    }
}

/// A law without effect restricts nothing.
#[test]
fn zero_laws_change_nothing() {
    let nothing = Vector::default();
    let still = vec![heavy([0.0; 3]), Torque::Damping(0.0), magnetic(nothing), Torque::Larmor(nothing)];
    case(ASYMMETRIC, still).holds(&["energy", "angular_momentum"]);
}

#[test]
fn the_shorter_turn_is_taken() {
    let rest = Rotor::from_components([1.0, 0.2, 0.3, -0.1]).unwrap();
    for angle in [0.0, 1e-9, 0.5, 3.0, 3.5, 6.0] {
        let turn = Bivector([0.6, 0.0, -0.8]) * angle;
        let shorter = if angle > std::f64::consts::PI { angle - 2.0 * std::f64::consts::PI } else { angle };
        let found = turn_from(rest, rest * Rotor::exp(turn * -0.5));
        let expected = Bivector([0.6, 0.0, -0.8]) * shorter;
        assert!((found - expected).norm() <= 8.0 * f64::EPSILON * (1.0 + shorter.abs()), "{angle}");
    }
}

/// The implicit midpoint rule lets the energy oscillate. Its changes at the output times are `(E − E0)` by the
/// size of its terms, the kinetic energy and the largest torque; the largest at the steps is what the certificate reports.
#[test]
fn changes_of_the_energy_are_those_of_its_terms() {
    let inertia = Inertia::from_principal_moments([1.5, 2.0, 3.0]).unwrap();
    let c = Vector([0.0, 0.0, 4.0]);
    let rotor = Rotor::from_components([4.0, 1.0, -2.0, 1.0]).unwrap();
    let problem = Problem::new(&inertia, rotor, Bivector([0.5, -2.0, 1.5]), &[Torque::Heavy(c)]);
    let times: Vec<f64> = (0..=40).map(|k| f64::from(k) * 0.125).collect();
    let options = Options { method: Some(Method::Midpoint), step: Some(0.125), ..Options::default() };
    let motion = problem.simulate(&times, options, &mut |_| true).unwrap();
    let states = motion.states();
    let drifts = motion.drifts();
    let (_, changes) = drifts.iter().find(|(quantity, _)| quantity.name() == "energy").unwrap();
    let (_, first, drift) = motion.certificate.drifts.iter().find(|(q, _, _)| q.name() == "energy").unwrap();
    assert!((first - states.energies[0]).abs() <= 1e-14 * first.abs());
    let size = first - rotor.apply(c).0[2] + c.norm();
    for (change, energy) in changes.iter().zip(&states.energies) {
        assert!((change - (energy - first) / size).abs() <= 1e-13, "{change:e} {energy}");
    }
    let largest = changes.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    assert!(largest > 1e-6 && (drift - largest).abs() <= 1e-13, "{largest:e} {drift:e}");
    assert!(changes.last().unwrap().abs() < largest);
}
