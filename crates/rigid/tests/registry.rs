//! Laws of the registry: their numbers, and their formulas against their code.

use polhode_ga::formula::{Given, Input, Meaning, Names, Type};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor};
use polhode_rigid::laws::conserved::energy;
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::registry::{Argument, Entry, FORCES, Kernel, Limit, Shape, TORQUES, torque};
use polhode_rigid::laws::torque::{Axes, Torque, total, wheel};
use polhode_rigid::state::phase::{Gyrostat, Phase};
use polhode_rigid::state::point::Point;

/// Numbers that every law takes: those of rotors of norm 1, those of ellipses below 1.
fn numbers<T>(entry: &Entry<T>) -> Vec<f64> {
    let own = |argument: &Argument| match argument.shape {
        Shape::Rotor => vec![0.48, 0.6, -0.64, 0.0],
        _ => (0..argument.shape.size()).map(|k| 0.25 + 0.125 * k as f64).collect(),
    };
    entry.arguments.iter().flat_map(own).collect()
}

fn states() -> Vec<Phase> {
    let rotors = [[1.0, 0.0, 0.0, 0.0], [0.76, 0.48, -0.24, 0.36], [-0.1, 0.7, 0.5, -0.5]];
    let phase = |c| Phase {
        rotor: Rotor::from_components(c).unwrap(),
        momentum: Bivector([0.6, -0.5, 0.9]),
        time: 0.5,
    };
    rotors.into_iter().map(phase).collect()
}

const MOMENTS: [f64; 3] = [1.0, 1.25, 1.75];

#[test]
fn numbers_make_the_law_and_are_found_again() {
    for entry in TORQUES.iter().filter(|entry| !matches!(entry.kernel, Kernel::Table)) {
        let given = numbers(entry);
        entry.check(&given).unwrap();
        let law = entry.build(&given).unwrap();
        let (found, again) = law.registered().unwrap();
        assert_eq!((found.name, again), (entry.name, given));
    }
    for entry in &FORCES {
        let given = numbers(entry);
        let (found, again) = entry.build(&given).unwrap().registered().unwrap();
        assert_eq!((found.name, again), (entry.name, given));
    }
}

#[test]
fn names_are_unique_and_arguments_are_named() {
    let names: Vec<_> =
        TORQUES.iter().map(|entry| entry.name).chain(FORCES.iter().map(|entry| entry.name)).collect();
    for (k, name) in names.iter().enumerate() {
        assert!(!names[..k].contains(name), "{name}");
    }
    for entry in &TORQUES {
        // A law of several arguments has a table, whose fields have names.
        assert!(entry.arguments.len() == 1 || entry.arguments.iter().all(|a| !a.field.is_empty()));
    }
}

#[test]
fn limits_name_the_argument() {
    let refused = |name: &str, numbers: &[f64]| torque(name).unwrap().check(numbers).unwrap_err().to_string();
    assert_eq!(refused("quadratic_damping", &[-1.0]), "k is -1.0; it must not be negative");
    assert_eq!(
        refused("gravity_gradient", &[1.0, 1.5, 0.0]),
        "eccentricity is 1.5; it must be at least 0 and below 1"
    );
    assert_eq!(refused("damping", &[f64::NAN]), "g is NaN; it must be finite");
    assert_eq!(Limit::Positive.refuses(0.0), Some("must be more than 0"));
}

/// The formula of an entry with these numbers.
fn formula(entry: &Entry<Torque>, numbers: &[f64]) -> Torque {
    let grades = |shape| match shape {
        Shape::Scalar => Grades::SCALAR,
        Shape::Vector => Grades(0b0010),
        Shape::Bivector => Grades::BIVECTOR,
        _ => Grades::EVEN,
    };
    let mut names = Names::default();
    for argument in entry.arguments {
        let meaning = match argument.shape {
            Shape::Gains => Meaning::Map { grade: 2 },
            shape => Meaning::Value(Type::of(grades(shape))),
        };
        names.bind(argument.name.to_owned(), meaning);
    }
    let value = |input: &Input| {
        let (argument, own) = entry.split(numbers).find(|(argument, _)| argument.name == input.name)?;
        Some(match (argument.shape, own) {
            (Shape::Gains, &[a, b, c]) => Given::Matrix([a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c]),
            (shape, own) => Given::Value(Graded::new(own, grades(shape))?),
        })
    };
    let law = Formula::new(entry.formula, Purpose::Torque(Axes::Body), names, value);
    Torque::Formula(law.unwrap_or_else(|error| panic!("{}: {}", entry.name, error.message)))
}

/// Formulas and code go through the same few products of numbers below 2: some tens of roundings.
#[test]
fn every_formula_is_its_law() {
    // Its place on the orbit is not an argument; a table has no formula.
    for entry in TORQUES.iter().filter(|entry| !matches!(entry.name, "gravity_gradient" | "tabulated")) {
        let given = numbers(entry);
        let (law, formula) = (entry.build(&given).unwrap(), formula(entry, &given));
        let body = Gyrostat { moments: MOMENTS, wheel: wheel(std::slice::from_ref(&law)) };
        let rigid = Gyrostat::rigid(MOMENTS);
        for state in states() {
            let expected = formula.value(&Point::at_rest(&body, &state)).unwrap();
            let found = total(std::slice::from_ref(&law), &Point::at_rest(&body, &state)).unwrap();
            assert!(
                (found - expected).norm() <= 64.0 * f64::EPSILON,
                "{}: {found:?} {expected:?}",
                entry.name
            );
            assert!(
                law.size(&rigid) == 0.0 || expected.norm() <= law.size(&rigid) * (1.0 + 1e-12),
                "{}",
                entry.name
            );
        }
    }
}

/// `V' = −N·Ω` along `R' = −½ R Ω`, by central differences over ±h: off by h² |V'''|/6 and ε |V|/h.
#[test]
fn every_potential_has_the_torque_as_its_gradient() {
    let (body, h) = (Gyrostat::rigid(MOMENTS), 1e-4);
    let mut count = 0;
    for entry in TORQUES.iter().filter(|entry| !matches!(entry.kernel, Kernel::Table)) {
        let law = entry.build(&numbers(entry)).unwrap();
        for state in states() {
            if matches!(law, Torque::Wheel(_)) || law.potential(&body, &state).is_none() {
                continue;
            }
            count += 1;
            for plane in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Bivector) {
                let at = |t: f64| Phase { rotor: state.rotor * Rotor::exp(plane * (-0.5 * t)), ..state };
                let laws = std::slice::from_ref(&law);
                let rise = (energy(&body, laws, &at(h)) - energy(&body, laws, &at(-h))) / (2.0 * h);
                let torque = law.value(&Point::at_rest(&body, &state)).unwrap();
                let work: f64 = (0..3).map(|k| torque.0[k] * plane.0[k]).sum();
                assert!((rise + work).abs() <= 1e-7, "{}: {rise} {work}", entry.name);
            }
        }
    }
    assert!(count >= 9, "{count}");
}
