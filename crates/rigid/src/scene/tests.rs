use super::*;
use crate::solids::{Amount, Solid};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A scene with most of what a scene may say.
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

/// The least that a scene must say.
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
        method: "yoshida4".to_owned(),
        step: Some(0.001),
        rtol: Some(1e-10),
        drift_bound: Some(1e-8),
    };
    assert_eq!(scene.run, run);
    assert_eq!((scene.path.as_path(), scene.text.as_str()), (Path::new("x.toml"), GOOD));
}

#[test]
fn what_is_left_out_has_its_default() {
    let scene = scene(LEAST);
    assert_eq!(scene.title, None);
    let (moments, center_of_mass) = ([3.0, 2.0, 1.0], Vector::default());
    assert_eq!(scene.body, BodySpec::Moments { moments, mass: None, center_of_mass });
    assert_eq!(scene.attitude, Rotor::IDENTITY);
    assert_eq!((scene.spin, scene.spin_frame), (Bivector([0.0, 0.0, 1.0]), SpinFrame::Body));
    assert_eq!(scene.gravity, None);
    let run = &scene.run;
    assert_eq!((run.samples, run.method.as_str()), (1001, "auto"));
    assert_eq!((run.step, run.rtol, run.drift_bound), (None, None, None));
}

#[test]
fn a_byte_order_mark_and_windows_lines_change_nothing() {
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    let (windows, unix) = (scene(&windows), scene(GOOD));
    assert_eq!(Scene { text: unix.text.clone(), ..windows }, unix);
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
fn an_inertia_may_have_a_mass_and_a_place() {
    let inertia =
        "inertia = [['3 kg m^2', 0, 0], [0, 2, 0.5], [0, 0.5, 1]]\nmass = 2\ncenter_of_mass = [0, 0, 1]";
    let body = scene(&LEAST.replace("moments = [3, 2, 1]", inertia)).body;
    let matrix = [[3.0, 0.0, 0.0], [0.0, 2.0, 0.5], [0.0, 0.5, 1.0]];
    let center_of_mass = Vector([0.0, 0.0, 1.0]);
    assert_eq!(body, BodySpec::Inertia { matrix, mass: Some(2.0), center_of_mass });
}

/// Every way to say a quarter turn in e1e2 says the same.
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
    for name in ["", "e1", "e1e1", "e1e4", "e1e2e3", "--e1e2", "xy", "e1∧∧e2"] {
        let found = errors_with("vector = [0, 0, 1]", &format!("plane = '{name}', rate = 2"));
        let expected =
            format!("4:18: unknown plane `{name}`, expected one such as `\"e1e2\"` or `[0, 0, 1]`");
        assert_eq!(found, [expected]);
    }
}

#[test]
fn a_spin_in_space_axes_is_turned_to_the_body() {
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
    let times = |run| scene(&LEAST.replace("duration = 10", run)).run.times();
    assert_eq!(times("duration = 1\nsamples = 2"), [0.0, 1.0]);
    assert_eq!(times("duration = '0.3 s'\ninterval = '0.1 s'"), [0.0, 0.3 / 3.0, 0.6 / 3.0, 0.3]);
    let long = times("duration = '1 yr'");
    assert_eq!((long.len(), long[0], long[1000]), (1001, 0.0, 31_557_600.0));
    assert!(long.windows(2).all(|pair| pair[0] < pair[1]));
}

#[test]
fn a_misspelt_field_is_shown_with_its_correction() {
    let shown = parse(&GOOD.replace("duration", "durration")).unwrap_err();
    assert_eq!(
        rendered(&shown),
        "x.toml:17:1: error: missing field `duration` in [run]\n   |\n17 | [run]\n   | ^^^^^\n\
         x.toml:18:1: error: unknown field `durration`, expected `duration`\n   |\n\
         18 | durration = \"10 s\"\n   | ^^^^^^^^^\n"
    );
    let shown = parse(&GOOD.replace("\"5 rev/s\"", "\"5 m\"")).unwrap_err();
    assert_eq!(
        rendered(&shown),
        "x.toml:11:35: error: expected an angular rate such as `5 rev/s`, found a length (`5 m`)\n   |\n\
         11 | spin = { plane = \"-e2∧e3\", rate = \"5 m\", frame = \"space\" }\n   \
         |                                   ^^^^^\n"
    );
}

#[test]
fn everything_wrong_with_a_file_is_reported_in_its_order() {
    let text = "title = 3\ntilte = 1\n[body]\nsolid = 'bx'\n[initial]\nspin = { rate = '5 m' }\n[gravty]\n\
                [run]\nduration = -1\nsamples = 1\nmethod = 'rk4'\nrtol = 2\n";
    assert_eq!(
        errors(text),
        [
            "1:9: expected a string, found an integer",
            "2:1: unknown field `tilte`, expected one of `title`, `body`, `initial`, `gravity`, `run`",
            "3:1: missing field in [body], expected one of `density`, `mass`",
            "4:9: unknown solid `bx`, expected one of `box`, `ellipsoid`, `sphere`, `hollow_sphere`, \
             `cylinder`, `cone`, `rod`, `disc`, `torus`, `capsule`",
            "6:8: missing field in `spin`, expected one of `plane`, `vector`, `bivector`",
            "7:2: unknown table `gravty`, expected `gravity`",
            "9:12: must be more than 0, found -1",
            "10:11: must be from 2 to 10000000, found 1",
            "11:10: unknown method `rk4`, expected one of `auto`, `strang`, `yoshida4`, `kahan_li6`, `kahan_li8`",
            "12:8: must be between 0 and 1, such as `1e-10`, found 2",
        ]
    );
}

#[test]
fn fields_that_exclude_each_other_are_reported_at_the_second() {
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "moments = [3, 2, 1]\nsolid = 'box'"),
        ["3:1: `solid` conflicts with `moments`, give only one of them"]
    );
    assert_eq!(
        errors_with("duration = 10", "interval = 1\nsamples = 3\nduration = 10"),
        ["7:1: `samples` conflicts with `interval`, give only one of them"]
    );
    assert_eq!(
        errors_with("[3, 2, 1]", "[3, 2, 1]\ndensity = 1"),
        ["3:1: `density` does not go with `moments`; fields that do: `mass`, `center_of_mass`"]
    );
    assert_eq!(
        errors_with("vector = [0, 0, 1]", "vector = [0, 0, 1], rate = 1"),
        ["4:30: `rate` does not go with `vector`; remove it"]
    );
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'box'\nlengths = [1, 1, 1]\nradius = 1\nmass = 1"),
        ["4:1: `radius` does not go with `box`; fields that do: `lengths`"]
    );
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'rod'\nlength = 1\nmass = 1\ndensity = 1"),
        ["5:1: `density` conflicts with `mass`, give only one of them"]
    );
}

#[test]
fn missing_fields_are_reported_at_their_table() {
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'cylinder'"),
        [
            "1:1: missing field `radius` in [body]",
            "1:1: missing field `height` in [body]",
            "1:1: missing field in [body], expected one of `density`, `mass`"
        ]
    );
    assert_eq!(errors_with("vector = [0, 0, 1]", "plane = 'e1e2'"), ["4:8: missing field `rate` in `spin`"]);
    assert_eq!(
        errors_with("spin", "attitude = { quaternion = [1, 0, 0, 0] }\nspin"),
        ["4:12: missing field `order` in `attitude`"]
    );
    assert_eq!(
        errors("title = 'x'  \n\n"),
        ["1:12: missing table [body]", "1:12: missing table [initial]", "1:12: missing table [run]"]
    );
}

#[test]
fn wrong_types_and_sizes_are_named() {
    let table = [
        ("moments = [3, 2, 1]", "moments = 3", "2:11: expected an array of 3 numbers, found an integer"),
        ("moments = [3, 2, 1]", "moments = [3, 2]", "2:11: expected 3 numbers, found 2"),
        (
            "[3, 2, 1]",
            "[3, true, 1]",
            "2:15: expected a moment of inertia such as `\"3 kg m^2\"`, found a boolean",
        ),
        ("[3, 2, 1]", "[3, nan, 1]", "2:15: `nan` is not a finite number"),
        ("[3, 2, 1]", "[3, 1e999, 1]", "2:15: `1e999` is not a finite number"),
        (
            "[3, 2, 1]",
            "[3, 9007199254740993, 1]",
            "2:15: the integer is beyond 2^53; write it with a decimal point",
        ),
        (
            "moments = [3, 2, 1]",
            "inertia = [[1, 0, 0], 0, [0, 0, 1]]",
            "2:23: expected an array of 3 numbers, found an integer",
        ),
        (
            "moments = [3, 2, 1]",
            "mesh = ''\nmass = 1",
            "2:8: expected the path of a mesh file, relative to the scene file",
        ),
        ("moments = [3, 2, 1]", "mesh = 'a'\nmass = 0", "3:8: must be more than 0, found 0"),
        ("duration = 10", "duration = 10\nsamples = 1e3", "7:11: expected a whole number, found a float"),
        (
            "duration = 10",
            "duration = 1979-05-27",
            "6:12: expected a time such as `\"10 s\"`, found a date or time",
        ),
        (
            "duration = 10",
            "duration = '10'",
            "6:12: expected a time such as `10 s`, found `10` without a unit",
        ),
        (
            "duration = 10",
            "duration = 1e305",
            "6:12: a duration of 1e305 s is too long to divide into samples",
        ),
        ("{ vector = [0, 0, 1] }", "'fast'", "4:8: expected the table `spin`, found a string"),
        ("[run]", "[[run]]", "5:1: expected the table [run], found an array"),
    ];
    for (old, new, message) in table {
        assert_eq!(errors_with(old, new), [message]);
    }
    // A row that holds several errors shows each.
    assert_eq!(errors_with("[3, 2, 1]", "['x', 2, '1 m']").len(), 2);
}

#[test]
fn an_attitude_of_zero_is_reported_at_its_value() {
    let message = "4:22: all components are zero, which is no rotor; give the identity as 1, 0, 0, 0";
    assert_eq!(errors_with("spin", "attitude = { rotor = [0, 0, 0, 0] }\nspin"), [message]);
    let message =
        "4:22: a bivector of size zero spans no plane, expected one such as `\"e1e2\"` or `[0, 0, 1]`";
    assert_eq!(errors_with("spin", "attitude = { plane = [0, 0, 0], angle = 1 }\nspin"), [message]);
}

#[test]
fn an_interval_must_divide_the_duration() {
    let with = |run: &str| errors_with("duration = 10", &format!("duration = 10\n{run}"));
    let message = "7:12: does not divide the duration of 10 s, write `samples = 4` instead";
    assert_eq!(with("interval = 3"), [message]);
    let message = "7:12: does not divide the duration of 10 s, write `samples = 2` instead";
    assert_eq!(with("interval = 30"), [message]);
    let message = "7:12: gives more than 10000000 samples in 10 s, make it longer";
    assert_eq!(with("interval = '1 us'"), [message]);
    assert_eq!(with("interval = 1e-320"), [message]);
}

#[test]
fn syntax_errors_have_a_place() {
    assert_eq!(errors("[body\n"), ["1:6: unclosed table, expected `]`"]);
    assert_eq!(errors("a = 1\na = 2\n"), ["2:1: duplicate key"]);
    assert_eq!(errors("a = \"x\ty\u{1}\"\n").len(), 1);
    assert_eq!(errors(" \r\n "), ["the file is empty, a scene needs the tables [body], [initial] and [run]"]);
    for deep in ["[", "{a=", "[{a="] {
        assert_eq!(errors(&format!("a = {}", deep.repeat(5000))).len(), 1);
    }
    assert_eq!(errors(&format!("a{} = 1", ".a".repeat(5000))).len(), 1);
}

#[test]
fn very_many_errors_are_cut_off() {
    let text: String = (0..100_000).map(|i| format!("a{i} = 1\n")).collect();
    let errors = errors(&text);
    assert_eq!((errors.len(), errors[100].as_str()), (101, "and 99903 more"));
}

#[test]
fn what_turns_out_wrong_later_finds_its_place() {
    let scene = scene(GOOD);
    let at = |field| scene.diagnose(field, "m").position;
    assert_eq!(at("body.mesh"), Some((5, 8)));
    assert_eq!(at("body.density"), Some((7, 11)));
    assert_eq!(at("body.mass"), Some((4, 1)));
    assert_eq!(at("initial.spin.rate"), Some((11, 35)));
    assert_eq!(at("gravity.pivot"), Some((15, 9)));
    assert_eq!(
        scene.diagnose("body.mesh", "the surface is open").to_string(),
        "x.toml:5:8: error: the surface is open\n  |\n5 | mesh = \"parts/t-handle.stl\"\n  |        ^^^^^^^^^^^^^^^^^^^^"
    );
}

proptest! {
    #[test]
    fn any_text_has_an_answer(text in "(\\PC|[\t\r\n=\\[\\]{}\"'.,#])*") {
        let _ = parse(&text);
    }

    /// Bytes deleted, doubled or replaced, and the end cut off.
    #[test]
    fn any_mutation_of_a_scene_has_an_answer(
        edits in prop::collection::vec((0usize..GOOD.len(), 0u8..3, any::<u8>()), 0..4),
        end in 0usize..2 * GOOD.len(),
    ) {
        let mut bytes = GOOD.as_bytes().to_vec();
        for (at, edit, byte) in edits {
            let at = at.min(bytes.len() - 1);
            match edit {
                0 => { bytes.remove(at); }
                1 => bytes.insert(at, bytes[at]),
                _ => bytes[at] = byte,
            }
        }
        bytes.truncate(end);
        let text = String::from_utf8_lossy(&bytes);
        match parse(&text) {
            Ok(scene) => prop_assert_eq!(scene.run.times().len(), scene.run.samples),
            Err(errors) => {
                prop_assert!(!errors.is_empty());
                let lines = text.lines().count().max(1);
                for (line, _) in errors.iter().filter_map(|error| error.position) {
                    prop_assert!(line <= lines + 1);
                }
            }
        }
    }
}
