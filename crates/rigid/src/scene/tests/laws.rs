//! Tests of `[torque]`, `[force]` and `[method]`.

use super::*;
use crate::laws::force::Force;
use crate::laws::torque::{Kind, Orbit, Torque};
use crate::state::point::Point;

/// The laws of the least scene with this table `[torque]`.
fn laws(torque: &str) -> Vec<Torque> {
    let scene = scene(&LEAST.replace("[run]", &format!("[torque]\n{torque}\n[run]")));
    scene.torques.into_iter().map(|law| law.torque).collect()
}

/// Compares laws by their debug output.
fn assert_same(found: &[Torque], expected: &[Torque]) {
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
}

#[test]
fn every_law_is_read_with_its_units() {
    let quarter = Rotor::from_plane_angle(Bivector([0.0, 0.0, 1.0]), FRAC_PI_2).unwrap();
    let gains = crate::laws::torque::Gains::new;
    let table = [
        ("damping = '6 1/min'", Torque::Damping(0.1)),
        ("quadratic_damping = '2 mN m s^2/rad^2'", Torque::QuadraticDamping(0.002)),
        ("viscous_damping = '3 N m s/rad'", Torque::ViscousDamping(gains([3.0; 3]))),
        ("viscous_damping = [1, '2 N m s', 3]", Torque::ViscousDamping(gains([1.0, 2.0, 3.0]))),
        (
            "gravity_gradient = { rate = 0.5, eccentricity = 0.1, mean_anomaly = '180 deg' }",
            Torque::GravityGradient(Orbit::new(0.5, 0.1, PI).unwrap()),
        ),
        ("gravity_gradient = { period = '2 s' }", Torque::GravityGradient(Orbit::circular(PI))),
        ("constant_body = ['1 N m', 2, 3]", Torque::ConstantBody(Bivector([1.0, 2.0, 3.0]))),
        ("constant_space = '2 N m e3∧e1'", Torque::ConstantSpace(Bivector([0.0, 2.0, 0.0]))),
        (
            "magnetic = { dipole = [0, '2 A m^2', 0], field = '50 uT e3' }",
            Torque::Magnetic { dipole: Vector([0.0, 2.0, 0.0]), field: Vector([0.0, 0.0, 50e-6]) },
        ),
        (
            "torsion_spring = { stiffness = '2 N m/rad', rest = { plane = 'e1e2', angle = '90 deg' } }",
            Torque::TorsionSpring { stiffness: 2.0, rest: quarter },
        ),
        ("gyrostat = '4 kg m^2/s e2∧e3'", Torque::Wheel(Bivector([4.0, 0.0, 0.0]))),
        (
            "pd_control = { kp = 1, kd = [1, 2, 3] }",
            Torque::Control {
                stiffness: gains([1.0; 3]),
                damping: gains([1.0, 2.0, 3.0]),
                target: Rotor::IDENTITY,
            },
        ),
        ("larmor = [0, 0, '1 rev/s']", Torque::Larmor(Vector([0.0, 0.0, TAU]))),
        ("heavy = '3 N m e1'", Torque::Heavy(Vector([3.0, 0.0, 0.0]))),
    ];
    for (text, law) in table {
        assert_same(&laws(text), &[law]);
    }
    let found = laws("tabulated = { times = [0, '1 min'], torques = [[0, 0, 1], 'e1e2'], frame = 'space' }");
    let [Torque::Tabulated(table)] = &found[..] else { panic!("{found:?}") };
    assert_eq!(
        (table.times(), table.kind, table.axes),
        (&[0.0, 60.0][..], Kind::Linear, crate::laws::torque::Axes::Space)
    );
    assert_eq!(table.torques(), [Bivector([0.0, 0.0, 1.0]); 2]);
}

#[test]
fn laws_add_up_in_the_order_of_the_file() {
    let text = LEAST.replace("[3, 2, 1]", "[3, 2, 1]\nmass = 2\ncenter_of_mass = [0, 0, 1]");
    let tables = "[gravity]\nacceleration = 5\n[torque]\ntorque_body = '-2 N m s Ω'\ndamping = 1\n[run]";
    let (_, laws) = scene(&text.replace("[run]", tables)).build().unwrap();
    assert!(matches!(laws[0].torque, Torque::Heavy(Vector([0.0, 0.0, 10.0]))), "{laws:?}");
    assert_eq!(laws[1].formula.as_deref(), Some("-2 N m s Ω"));
    assert!(matches!(laws[2].torque, Torque::Damping(1.0)));
    assert_eq!(laws.len(), 3);
}

/// A formula may stand before the first table, use what is defined, and have units.
#[test]
fn formulas_are_torques() {
    let define = "torque_space = 'V(R) - k L'\n[define]\nk = '3 s^-1'\n'V(R)' = '2 N m R e1e2 ~R'\n";
    let scene = scene(&format!("{define}{LEAST}"));
    let (body, laws) = scene.build().unwrap();
    let gyrostat = crate::state::phase::Gyrostat::rigid(body.inertia.principal_moments());
    let momentum = gyrostat.momentum(Bivector([0.0, 0.0, 1.0]));
    let state = crate::state::phase::Phase { rotor: Rotor::IDENTITY, momentum, time: 0.0 };
    let torque = laws[0].torque.clone().in_axes(body.inertia.principal_frame());
    // 2 e1e2 − 3 L, of a turn about the principal axis whose moment is the third.
    let found = torque.value(&Point::at_rest(&gyrostat, &state)).unwrap().norm();
    let expected = (2.0 - 3.0 * gyrostat.moments[2]).abs();
    assert!((found - expected).abs() <= 8.0 * f64::EPSILON, "{found} {expected}");
}

#[test]
fn errors_in_laws_have_a_place() {
    // The table begins in line 5.
    let table = [
        ("dampin = 1", "6:1: unknown field `dampin`, expected `damping`"),
        ("damping = '1 s'", "6:11: expected a rate of decay such as `0.1 /s`, found a time (`1 s`)"),
        ("viscous_damping = [1, -2, 1]", "6:23: must not be negative, found -2"),
        (
            "gravity_gradient = {}",
            "6:20: missing field in `gravity_gradient`, expected one of `rate`, `period`",
        ),
        (
            "gravity_gradient = { rate = 1, period = 2 }",
            "6:32: `period` conflicts with `rate`, give only one of them",
        ),
        (
            "gravity_gradient = { rate = 1, eccentricity = 1 }",
            "6:47: must be at least 0 and below 1, found 1",
        ),
        ("constant_body = 'e1'", "6:17: expected a bivector, found a part of grade 1"),
        ("magnetic = { dipole = [0, 0, 1] }", "6:12: missing field `field` in `magnetic`"),
        (
            "magnetic = { dipole = ['1 T', 0, 1], field = [0, 0, 1] }",
            "6:24: expected a magnetic dipole such as `0.2 A m^2`, found a magnetic field (`1 T`)",
        ),
        ("torsion_spring = 3", "6:18: expected the table `torsion_spring`, found an integer"),
        (
            "pd_control = { kp = 1, kd = 1, target = { angle = 1 } }",
            "6:41: missing field in `target`, expected one of `plane`, `rotor`, `quaternion`, `rotation_vector`",
        ),
        (
            "tabulated = { times = [0, 1], torques = [[0, 0, 1]] }",
            "6:13: 2 times for 1 torques; give one for each",
        ),
        (
            "tabulated = { times = [1, 0], torques = [[0, 0, 1], [0, 0, 1]] }",
            "6:13: times[1] = 0 is not after times[0] = 1; sort the rows",
        ),
        // Inside a formula the place is that of the part.
        ("torque_body = '-k Ω'", "6:17: `k` has no value"),
        ("torque_body = 'e1 + R'", "6:16: "),
        ("torque_body = '3 kg (e1∧e2'", "6:21: "),
        ("torque_body = '~R e3 R'", "6:16: a torque is a bivector, grade 2; this has the grade 1; "),
        ("torque_body = 'Ω = Ω'", "6:16: an equation has no value; write one side, which is a torque"),
        ("torque_body = '2 t Ω'", "6:18: `t` is a unit and a name here; for the name write `2*t`"),
        ("torque_space = 3", "6:16: expected a string, found an integer"),
    ];
    for (text, message) in table {
        let found = errors_with("[run]", &format!("[torque]\n{text}\n[run]"));
        assert!(found.len() == 1 && found[0].starts_with(message), "{text}: {found:?}");
    }
    let both = errors(&format!(
        "torque_body = 'Ω'\n{}",
        LEAST.replace("[run]", "[torque]\ntorque_body = 'Ω'\n[run]")
    ));
    assert_eq!(both, ["1:15: `torque_body` is also in [torque], give only one of them"]);
}

#[test]
fn names_of_the_motion_cannot_be_redefined() {
    let text =
        format!("[define]\nR = 'e1e2'\n{}", LEAST.replace("[run]", "[torque]\ntorque_body = 'Ω'\n[run]"));
    assert_eq!(errors(&text), ["8:16: `R` is given by the motion; rename your value"]);
}

#[test]
fn forces_move_the_centre_of_mass() {
    let table = "[force]\nconstant = '2 N e1'\nthrust = { force = [1, 0, 0], at = [0, '1 cm', 0] }\ndrag = '3 N s/m'\n\
                 quadratic_drag = 4\nspring = { stiffness = '20 N/m', anchor = [1, 2, 3] }\n\
                 central = '398600.4418 km^3/s^2'\n[run]";
    let text = LEAST
        .replace("[3, 2, 1]", "[3, 2, 1]\nmass = 2")
        .replace("[run]", table)
        .replace("spin", "position = ['1 km', 0, 0]\nvelocity = '3 m/s e2'\nspin");
    let scene = scene(&text);
    assert_eq!(scene.center.position, Vector([1000.0, 0.0, 0.0]));
    assert_eq!(scene.center.velocity, Vector([0.0, 3.0, 0.0]));
    let found: Vec<&Force> = scene.forces.iter().map(|push| &push.force).collect();
    let expected = [
        Force::Constant(Vector([2.0, 0.0, 0.0])),
        Force::Body(Vector([1.0, 0.0, 0.0])),
        Force::Drag(3.0),
        Force::QuadraticDrag(4.0),
        Force::Spring(20.0, Vector([1.0, 2.0, 3.0])),
        Force::Central(3.986_004_418e14),
    ];
    assert_eq!(format!("{found:?}"), format!("{:?}", expected.iter().collect::<Vec<_>>()));
    assert_eq!(scene.forces[1].at, Some(Vector([0.0, 0.01, 0.0])));
    assert!(scene.build().is_ok());
}

#[test]
fn a_weight_acts_at_the_centre_of_mass() {
    let held = |body: &str, c: &str| {
        let text =
            LEAST.replace("[3, 2, 1]", body).replace("[run]", &format!("[torque]\nheavy = {c}\n[run]"));
        scene(&text).build().map(|(body, _)| body.center_of_mass)
    };
    let above = "[3, 2, 1]\nmass = 2\ncenter_of_mass = [0, 0.1, 1]";
    assert!(held(above, "[0, 1.962, 19.62]").is_ok());
    assert!(held(above, "[0, 0, 0]").is_ok());
    // Moments without a centre of mass are those about the fixed point.
    assert!(held("[3, 2, 1]\nmass = 2", "[0, 3, 4]").is_ok());
    assert!(held("[3, 2, 1]", "[0, 3, 4]").is_ok());
    for c in ["[0, 0, 1]", "[0, -1.962, -19.62]"] {
        let message = held(above, c).unwrap_err()[0].to_string();
        assert!(message.contains(": error: (0, ") && message.contains("(0, 0.1, 1) m"), "{message}");
        assert!(message.contains("[gravity] with a pivot") && message.contains("heavy = "), "{message}");
    }
}

#[test]
fn forces_need_a_mass_and_a_body_that_is_not_held() {
    let message =
        |text: &str| scene(text).build().unwrap_err()[0].to_string().lines().next().unwrap().to_owned();
    let pushed = LEAST.replace("[run]", "[force]\ndrag = 1\n[run]");
    assert_eq!(message(&pushed), "x.toml:1:1: error: a force moves the mass, add the field `mass`");
    let massive = pushed.replace("[3, 2, 1]", "[3, 2, 1]\nmass = 1");
    assert_eq!(
        message(&massive.replace("[force]", "[torque]\nheavy = [0, 0, 1]\n[force]")),
        "x.toml:8:1: error: the body is held at a fixed point, where no force moves it; remove [force]"
    );
    let beside = LEAST.replace("[3, 2, 1]", "[3, 2, 1]\ncenter_of_mass = [0, 0, 1]");
    assert_eq!(
        message(&beside.replace("[run]", "[torque]\nheavy = [0, 0, 1]\n[run]")),
        "x.toml:1:1: error: the inertia about the fixed point depends on the mass, add the field `mass`"
    );
}

#[test]
fn the_method_may_have_a_table() {
    let method = "duration = 10\n[method]\nname = 'dop853'\nstep = '1 ms'\nrtol = 1e-9\natol = 1e-8";
    let expected = Choice {
        method: "dop853".to_owned(),
        step: Some(0.001),
        rtol: Some(1e-9),
        atol: Some(1e-8),
        max_step: None,
        max_steps: None,
    };
    assert_eq!(scene(&LEAST.replace("duration = 10", method)).run.choice, expected);
    let both = "duration = 10\nmethod = 'dop853'\nstep = 1\nrtol = 0.1\n[method]\nname = 'rk4'\nstep = 1\nrtol = 0.1";
    assert_eq!(
        errors_with("duration = 10", both),
        [
            "11:1: `name` of [method] is `method` of [run], give only one of them",
            "12:1: `step` of [method] is `step` of [run], give only one of them",
            "13:1: `rtol` of [method] is `rtol` of [run], give only one of them",
        ]
    );
    assert_eq!(errors_with("duration = 10", "duration = 10\n[method]\nname = 'euler'\natol = 2").len(), 2);
    let unknown = errors_with("duration = 10", "duration = 10\n[method]\ntol = 2");
    assert!(
        unknown.len() == 1 && unknown[0].starts_with("8:1: unknown field `tol`, expected `"),
        "{unknown:?}"
    );
}
