//! Tests of reading scenes.

mod ensembles;
mod errors;
mod laws;

use super::*;
use crate::body::solids::{Amount, Solid};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A scene with most fields.
const GOOD: &str = r#"# A T-handle, spinning about its middle axis.
title = "T-handle"

[body]
mesh = "parts/t-handle.stl"
length_unit = "mm"
density = "7.85 g/cm^3"

[initial]
attitude = { plane = "e1e2", angle = "30 deg" }
spin = { plane = "-e2∧e3", rate = "5 rev/s", frame = "space" }

[gravity]
acceleration = "9.81 m/s^2"
pivot = ["0 m", 0, "-5 cm"]

[run]
duration = "10 s"
interval = "10 ms"
method = "yoshida4"
step = "1 ms"
rtol = 1e-10
drift_bound = 1e-8
"#;

/// A scene with only the required fields.
const LEAST: &str = "[body]\nmoments = [3, 2, 1]\n[initial]\nspin = { vector = [0, 0, 1] }\n\
                     [run]\nduration = 10\n";

fn parse(text: &str) -> Result<Scene, Vec<Diagnostic>> {
    Scene::parse(text, Path::new("x.toml"))
}

fn scene(text: &str) -> Scene {
    parse(text).unwrap_or_else(|errors| panic!("{text}\n{}", rendered(&errors)))
}

fn rendered(errors: &[Diagnostic]) -> String {
    errors.iter().map(|error| format!("{error}\n")).collect()
}

/// `line:column: message` of every error.
fn errors(text: &str) -> Vec<String> {
    let errors = parse(text).map(|scene| panic!("{scene:?}")).unwrap_or_else(|errors| errors);
    let brief = |error: &Diagnostic| match error.position {
        Some((line, column)) => format!("{line}:{column}: {}", error.message),
        None => error.message.clone(),
    };
    errors.iter().map(brief).collect()
}

/// The errors of the least scene with one of its lines replaced.
fn errors_with(old: &str, new: &str) -> Vec<String> {
    assert!(LEAST.contains(old));
    errors(&LEAST.replace(old, new))
}

#[test]
fn a_caption_is_one_line() {
    let text = format!("caption = \"\"\"\nA handle\n that  flips.\"\"\"\n{LEAST}");
    assert_eq!(scene(&text).caption.as_deref(), Some("A handle that flips."));
    assert_eq!(scene(LEAST).caption, None);
}

#[test]
fn a_full_scene_is_read() {
    let scene = scene(GOOD);
    assert_eq!(scene.title.as_deref(), Some("T-handle"));
    let file = "parts/t-handle.stl".to_owned();
    let amount = Amount::Density(7850.0);
    assert_eq!(scene.body, BodySpec::Mesh { file, length_unit: 0.001, amount });
    let plane = Bivector([0.0, 0.0, 1.0]);
    assert_eq!(scene.attitude, Rotor::from_plane_angle(plane, PI / 6.0).unwrap());
    assert_eq!((scene.spin, scene.spin_frame), (Bivector([-5.0 * TAU, 0.0, 0.0]), SpinFrame::Space));
    assert_eq!(scene.gravity, Some(Gravity { acceleration: 9.81, pivot: Vector([0.0, 0.0, -0.05]) }));
    let run = Run {
        duration: 10.0,
        samples: 1001,
        first: None,
        choice: Choice {
            method: "yoshida4".to_owned(),
            step: Some(0.001),
            rtol: Some(1e-10),
            atol: None,
            max_step: None,
            max_steps: None,
        },
        drift_bound: Some(1e-8),
    };
    assert_eq!(scene.run, run);
    assert_eq!((scene.path.as_path(), scene.text.as_str()), (Path::new("x.toml"), GOOD));
}

#[test]
fn times_may_be_a_geometric_progression() {
    let run = |more: &str| scene(&LEAST.replace("[run]", &format!("[run]\n{more}"))).run;
    let (even, uneven) = (run("samples = 6").offsets(), run("samples = 6\nfirst = 0.25").offsets());
    let end = even[5];
    assert_eq!((uneven.len(), uneven[0], uneven[1], uneven[5]), (6, 0.0, 0.25, end));
    let ratio = (end / 0.25).powf(0.25);
    for pair in uneven[1..].windows(2) {
        assert!((pair[1] / pair[0] / ratio - 1.0).abs() < 1e-14);
    }
    for (more, expected) in [
        ("samples = 2\nfirst = 0.25", "needs at least 3 samples"),
        ("first = 1e9", "must be before the end of the run"),
        ("first = 0", "must be"),
        ("interval = 0.5\nfirst = 0.25", "conflicts with"),
    ] {
        let found = errors_with("[run]", &format!("[run]\n{more}")).concat();
        assert!(found.contains(expected), "{more}: {found}");
    }
}

#[test]
fn omitted_fields_have_defaults() {
    let scene = scene(LEAST);
    assert_eq!(scene.title, None);
    let (moments, center_of_mass) = ([3.0, 2.0, 1.0], Vector::default());
    assert_eq!(scene.body, BodySpec::Moments { moments, mass: None, center_of_mass });
    assert_eq!(scene.attitude, Rotor::IDENTITY);
    assert_eq!((scene.spin, scene.spin_frame), (Bivector([0.0, 0.0, 1.0]), SpinFrame::Body));
    assert_eq!(scene.gravity, None);
    let run = &scene.run;
    assert_eq!((run.samples, run.choice.method.as_str()), (1001, "auto"));
    let Choice { step, rtol, atol, .. } = run.choice;
    assert_eq!((step, rtol, atol, run.drift_bound), (None, None, None, None));
}

#[test]
fn a_byte_order_mark_and_windows_lines_change_nothing() {
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    let (windows, unix) = (scene(&windows), scene(GOOD));
    let windows = Scene { text: unix.text.clone(), ..windows };
    assert_eq!(format!("{windows:?}"), format!("{unix:?}"));
}

#[test]
fn every_solid_is_read() {
    let table = [
        ("box", "lengths = ['1 cm', 2, 3]", Solid::Box { lengths: [0.01, 2.0, 3.0] }),
        ("ellipsoid", "semi_axes = [1, 2, 3]", Solid::Ellipsoid { semi_axes: [1.0, 2.0, 3.0] }),
        ("sphere", "radius = '1 km'", Solid::Sphere { radius: 1000.0 }),
        (
            "hollow_sphere",
            "outer_radius = 2\ninner_radius = 1",
            Solid::HollowSphere { outer_radius: 2.0, inner_radius: 1.0 },
        ),
        ("cylinder", "radius = 1\nheight = 2", Solid::Cylinder { radius: 1.0, height: 2.0 }),
        ("cone", "radius = 1\nheight = 2", Solid::Cone { radius: 1.0, height: 2.0 }),
        ("rod", "length = 1", Solid::Rod { length: 1.0 }),
        ("disc", "radius = 1", Solid::Disc { radius: 1.0 }),
        (
            "torus",
            "major_radius = 2\nminor_radius = 1",
            Solid::Torus { major_radius: 2.0, minor_radius: 1.0 },
        ),
        ("capsule", "radius = 1\nheight = 2", Solid::Capsule { radius: 1.0, height: 2.0 }),
    ];
    for (name, sizes, solid) in table {
        let text = LEAST.replace("moments = [3, 2, 1]", &format!("solid = '{name}'\n{sizes}\nmass = '1 lb'"));
        let amount = Amount::Mass(0.453_592_37);
        assert_eq!(scene(&text).body, BodySpec::Solid { solid, amount }, "{name}");
    }
}

#[test]
fn the_unit_of_a_mesh_has_a_name_or_a_size() {
    for (unit, metres) in [("'mm'", 0.001), ("'inch'", 0.0254), ("0.5", 0.5), ("'25.4 mm'", 0.0254)] {
        let mesh = format!("mesh = 'a.stl'\nlength_unit = {unit}\nmass = 1");
        match scene(&LEAST.replace("moments = [3, 2, 1]", &mesh)).body {
            BodySpec::Mesh { length_unit, .. } => assert_eq!(length_unit, metres, "{unit}"),
            other => panic!("{other:?}"),
        }
    }
    let found = errors_with("moments = [3, 2, 1]", "mesh = 'a.stl'\nlength_unit = 'kg'\nmass = 1");
    assert_eq!(found, ["3:15: expected a length such as `5 cm`, found a mass (`kg`)"]);
}

#[test]
fn an_inertia_may_have_a_mass_and_a_centre() {
    let inertia =
        "inertia = [['3 kg m^2', 0, 0], [0, 2, 0.5], [0, 0.5, 1]]\nmass = 2\ncenter_of_mass = [0, 0, 1]";
    let body = scene(&LEAST.replace("moments = [3, 2, 1]", inertia)).body;
    let matrix = [[3.0, 0.0, 0.0], [0.0, 2.0, 0.5], [0.0, 0.5, 1.0]];
    let center_of_mass = Vector([0.0, 0.0, 1.0]);
    assert_eq!(body, BodySpec::Inertia { matrix, mass: Some(2.0), center_of_mass });
}

/// All forms give the same quarter turn in e1e2.
#[test]
fn the_attitude_has_four_forms() {
    let quarter = Rotor::from_plane_angle(Bivector([0.0, 0.0, 1.0]), FRAC_PI_2).unwrap();
    let forms = [
        "plane = 'e1e2', angle = '90 deg'",
        "plane = '-e2e1', angle = '0.25 rev'",
        "plane = 'e2 ^ e1', angle = -1.5707963267948966",
        "plane = [0, 0, 7], angle = '90°'",
        "plane = [0, 0, 1e-320], angle = '90°'",
        "plane = [0, 0, 1e308], angle = '90°'",
        "rotor = [1, 0, 0, -1]",
        "quaternion = [1, 0, 0, 1], order = 'wxyz'",
        "quaternion = [0, 0, 1, 1], order = 'xyzw'",
        "rotation_vector = [0, 0, '90 deg']",
    ];
    for form in forms {
        let attitude = scene(&LEAST.replace("spin", &format!("attitude = {{ {form} }}\nspin"))).attitude;
        for (a, b) in attitude.components().into_iter().zip(quarter.components()) {
            // Each component is a sine, cosine or quotient of numbers good to an ulp.
            assert!((a - b).abs() <= 2.0 * f64::EPSILON, "{form} {attitude:?}");
        }
    }
}

#[test]
fn planes_are_named_by_two_basis_vectors() {
    let table = [
        ("e2e3", [1.0, 0.0, 0.0]),
        ("e3e1", [0.0, 1.0, 0.0]),
        ("e1e2", [0.0, 0.0, 1.0]),
        ("e3e2", [-1.0, 0.0, 0.0]),
        ("e1∧e3", [0.0, -1.0, 0.0]),
        ("\u{2212}e1^e2", [0.0, 0.0, -1.0]),
    ];
    for (name, components) in table {
        let spin = format!("plane = '{name}', rate = 2");
        let scene = scene(&LEAST.replace("vector = [0, 0, 1]", &spin));
        assert_eq!(scene.spin, Bivector(components) * 2.0, "{name}");
    }
    for name in ["", "e1", "e1e1", "e1e4", "e1e2e3", "xy", "e1∧∧e2", "e1∧e1"] {
        let found = errors_with("vector = [0, 0, 1]", &format!("plane = '{name}', rate = 2"));
        assert!(found.len() == 1 && found[0].starts_with("4:"), "{found:?}");
    }
}

#[test]
fn attitude_spin_plane_and_pivot_may_be_formulas() {
    let define = "[define]\n'θ' = '30 deg'\nn = 'cos(θ) e3 + sin(θ) e1'\n'unit(B)' = 'B/norm(B)'\nrate = 3\n";
    let with = |old: &str, new: &str| scene(&format!("{define}{}", LEAST.replace(old, new)));
    let spin = with("{ vector = [0, 0, 1] }", "'5 rev/s undual(n)'").spin;
    assert!((spin - Bivector([0.5, 0.0, 0.75_f64.sqrt()]) * (5.0 * TAU)).norm() <= 64.0 * f64::EPSILON);
    let space = with("{ vector = [0, 0, 1] }", "{ formula = 'rate unit(e1∧(e2 + e3))', frame = 'space' }");
    assert_eq!(space.spin_frame, SpinFrame::Space);
    assert!((space.spin.norm() - 3.0).abs() <= 4.0 * f64::EPSILON);
    let attitude = with("spin", "attitude = 'e^(-e1e2 θ/2)'\nspin").attitude;
    let expected = Rotor::from_plane_angle(Bivector([0.0, 0.0, 1.0]), PI / 6.0).unwrap();
    assert_eq!(attitude.components(), expected.components());
    let plane = with("vector = [0, 0, 1]", "plane = 'n∧e2', rate = 2").spin;
    assert!((plane - Bivector([-0.75_f64.sqrt(), 0.0, 0.5]) * 2.0).norm() <= 4.0 * f64::EPSILON);
    let pivot = with("[run]", "[gravity]\nacceleration = 9.81\npivot = '-4 cm e3'\n[run]");
    assert_eq!(pivot.gravity.unwrap().pivot, Vector([0.0, 0.0, -0.04]));
}

#[test]
fn a_spin_in_space_axes_is_converted_to_body_axes() {
    // R turns e1 to e2 by 90°, so ~R turns e2, dual to e3e1, back to e1.
    let text = LEAST.replace(
        "spin = { vector = [0, 0, 1] }",
        "attitude = { plane = 'e1e2', angle = '90 deg' }\nspin = { bivector = [0, 3, 0], frame = 'space' }",
    );
    let difference = scene(&text).omega_body() - Bivector([3.0, 0.0, 0.0]);
    assert!(difference.norm() <= 8.0 * f64::EPSILON);
    assert_eq!(scene(LEAST).omega_body(), Bivector([0.0, 0.0, 1.0]));
}

#[test]
fn times_run_from_zero_to_the_duration() {
    let times = |run| scene(&LEAST.replace("duration = 10", run)).times();
    assert_eq!(times("duration = 1\nsamples = 2"), [0.0, 1.0]);
    assert_eq!(times("duration = '0.3 s'\ninterval = '0.1 s'"), [0.0, 0.3 / 3.0, 0.6 / 3.0, 0.3]);
    let long = times("duration = '1 yr'");
    assert_eq!((long.len(), long[0], long[1000]), (1001, 0.0, 31_557_600.0));
    assert!(long.windows(2).all(|pair| pair[0] < pair[1]));
}
