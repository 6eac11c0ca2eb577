//! Torque formulas as in scenes, with names, values and functions.

use polhode_ga::formula::{Error, Given, Input, Meaning, Names, Space, Type, define};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor, Vector};
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::torque::{Axes, Dependence, Torque};
use polhode_rigid::state::phase::{Gyrostat, Phase};
use polhode_rigid::state::point::Point;

/// A law with a vector c, a number k, and the function `pull(a, b) = a∧b`.
fn law(text: &str, axes: Axes) -> Result<Torque, Error> {
    let mut names = Names::new([]);
    names.bind("c".to_owned(), Meaning::Value(Type::of(Grades(0b0010))));
    names.bind("k".to_owned(), Meaning::Value(Type::SCALAR));
    define("pull(a, b)", "a∧b", Space::g3(), &mut names)?;
    let value = |input: &Input| match input.name.as_str() {
        "c" => Graded::new(&[0.5, 0.25, 1.0], Grades(0b0010)).map(Given::Value),
        "k" => Some(Given::Value(Graded::default().map(|_| 2.0))),
        _ => None,
    };
    Formula::new(text, Purpose::Torque(axes), names, value).map(Torque::Formula)
}

fn state() -> (Gyrostat, Phase) {
    let body = Gyrostat { moments: [1.0, 2.0, 2.5], wheel: Bivector([0.1, 0.0, 0.3]) };
    let rotor = Rotor::from_components([4.0, 1.0, -2.0, 1.0]).unwrap();
    (body, Phase { rotor, momentum: Bivector([0.5, -0.5, 3.0]), time: 0.5 })
}

#[test]
fn formulas_match_the_built_in_laws() {
    let (body, state) = state();
    let heavy = Torque::Heavy(Vector([0.5, 0.25, 1.0])).value(&Point::at_rest(&body, &state)).unwrap();
    for text in ["(~R e3 R) ∧ c", "pull(~R e3 R, c)"] {
        assert_eq!(law(text, Axes::Body).unwrap().value(&Point::at_rest(&body, &state)).unwrap(), heavy);
    }
    let damping = Torque::QuadraticDamping(2.0).value(&Point::at_rest(&body, &state)).unwrap();
    assert_eq!(
        law("-k norm(Ω) Ω", Axes::Body).unwrap().value(&Point::at_rest(&body, &state)).unwrap(),
        damping
    );
}

/// Seen from other axes of the body it is the same torque.
#[test]
fn a_formula_is_in_the_axes_of_the_body() {
    let (_, state) = state();
    // A sphere without a wheel is the same in all axes, so both are principal ones.
    let sphere = Gyrostat::rigid([2.0; 3]);
    let frame = Rotor::from_components([1.0, 2.0, 3.0, 4.0]).unwrap();
    let in_body_axes = Phase {
        rotor: state.rotor * frame.reverse(),
        momentum: frame.apply_bivector(state.momentum),
        time: state.time,
    };
    for (text, axes) in
        [("t (~R e3 R) ∧ c − k Ω + Ω × L_B", Axes::Body), ("L × (R c ~R I) + k Ω", Axes::Space)]
    {
        let law = law(text, axes).unwrap();
        let expected = law.value(&Point::at_rest(&sphere, &in_body_axes)).unwrap();
        let found = frame.apply_bivector(law.in_axes(frame).value(&Point::at_rest(&sphere, &state)).unwrap());
        assert!((found - expected).norm() <= 32.0 * f64::EPSILON * expected.norm(), "{text}");
    }
}

#[test]
fn dependence_follows_from_the_variables() {
    let depends = |text: &str| {
        let law = law(text, Axes::Body).unwrap();
        (law.dependence(), law.is_autonomous())
    };
    assert_eq!(depends("(~R e3 R) ∧ c"), (Dependence::Attitude, true));
    assert_eq!(depends("I(e1e2) + t c∧e1"), (Dependence::Attitude, false));
    for text in ["k Ω", "Ω_B", "Omega_S", "L_B", "⟨L R⟩_2"] {
        assert_eq!(depends(text), (Dependence::Rate, true), "{text}");
    }
}

#[test]
fn invalid_torques_are_errors_with_a_place() {
    for (text, part) in [
        ("R e3 ~R", "the torque with the axial vector v is `I v`"),
        ("Ω Ω_S", "grades 0, 2"),
        ("Ω = c ∧ e1", "write one side"),
        ("c ∧ q", "`q` has no value"),
    ] {
        let error = law(text, Axes::Body).unwrap_err();
        assert!(error.message.contains(part), "{}", error.message);
        assert!(error.span.start < error.span.end && error.span.end <= text.len());
    }
    let (body, mut state) = state();
    state.time = 1.0;
    let error =
        law("k Ω + Ω/(t − 1)", Axes::Body).unwrap().value(&Point::at_rest(&body, &state)).unwrap_err();
    assert!(error.message.contains("`Ω/(t − 1)` in the formula"), "{error}");
}
