//! Tests of `[ensemble]`: reading, errors, and distributions.

use super::*;
use crate::body::inertia::Inertia;
use crate::laws::registry::{Argument, Shape, torque};
use crate::laws::torque::Torque;
use crate::scene::parameters::PARAMETERS;

/// The minimal scene with these lines in `[ensemble]`.
fn with(ensemble: &str) -> String {
    format!("{LEAST}[ensemble]\n{ensemble}\n")
}

/// The ensemble of a scene.
fn ensemble(scene: &Scene) -> &Ensemble {
    scene.ensemble.as_ref().unwrap()
}

/// Bodies, one per row; position and velocity in a row of `centers`.
struct Drawn {
    rotors: Vec<[f64; 4]>,
    omegas: Vec<[f64; 3]>,
    centers: Vec<Vec<f64>>,
    inertias: Vec<Inertia>,
    laws: Vec<Vec<Torque>>,
}

/// Some bodies of a scene.
fn drawn(text: &str, bodies: Range<usize>) -> Drawn {
    let scene = scene(text);
    let (body, laws) = scene.build().unwrap();
    let all = scene.bodies(ensemble(&scene), (&body, &laws), bodies).unwrap();
    Drawn {
        rotors: all.starts.iter().map(|start| start.rotor.components()).collect(),
        omegas: all.starts.iter().map(|start| start.omega.0).collect(),
        centers: all.starts.iter().map(|s| [s.center.position.0, s.center.velocity.0].concat()).collect(),
        inertias: all.inertias.all().to_vec(),
        laws: all.laws.iter().map(|law| law.all().to_vec()).collect(),
    }
}

/// Kolmogorov's distance of a sample from a distribution, times the root of its size: 2.6 is exceeded for 3 seeds in a
/// million.
fn distance(mut sample: Vec<f64>, below: impl Fn(f64) -> f64) -> f64 {
    sample.sort_by(f64::total_cmp);
    let n = sample.len() as f64;
    let off = |(i, x): (usize, &f64)| (below(*x) - (i as f64 + 0.5) / n).abs();
    sample.iter().enumerate().map(off).fold(0.0, f64::max) * n.sqrt()
}

/// Mean and mean square of numbers.
fn moments(numbers: &[f64]) -> (f64, f64) {
    let n = numbers.len() as f64;
    (numbers.iter().sum::<f64>() / n, numbers.iter().map(|x| x * x).sum::<f64>() / n)
}

/// Whether mean and standard deviation are 0 and this within five standard errors.
fn is_normal(numbers: &[f64], deviation: f64) -> bool {
    let (mean, square) = moments(numbers);
    let usual = 5.0 / (numbers.len() as f64).sqrt();
    mean.abs() < usual * deviation
        && (square - deviation * deviation).abs() < usual * 2f64.sqrt() * deviation * deviation
}

#[test]
fn an_ensemble_is_read() {
    let text = LEAST
        .replace("[run]", "[torque]\nviscous_damping = [1, 2, 3]\ngravity_gradient = { rate = 1 }\n[run]");
    let ensemble = "[ensemble]\nnumber = 100_000\nseed = 7\nattitude = { normal = ['2 deg', 0, 1] }\n\
        spin = { direction = 'uniform', uniform = '1 deg/s' }\nmoments = { relative = 0.02 }\n\
        position = { normal = '1 mm' }\ntorque.viscous_damping = { relative = 0.1 }\n\
        torque.gravity_gradient = { eccentricity = { uniform = 0 }, period = { normal = '1 ms' } }\n\
        [ensemble.velocity]\nuniform = [1, 2, 3]\n";
    let scene = scene(&format!("{text}{ensemble}"));
    let found = scene.ensemble.unwrap();
    let spread = |form, widths| Spread { form, widths, alike: false };
    let one = |form, width| Spread { form, widths: [width; 3], alike: true };
    assert_eq!((found.number, found.seed, found.directions), (100_000, 7, true));
    let turned = Attitudes::Turned(spread(Form::Normal, [PI / 90.0, 0.0, 1.0]));
    assert_eq!(found.attitude, Some(turned));
    assert_eq!(found.spin, Some(spread(Form::Uniform, [PI / 180.0; 3])));
    assert_eq!(found.moments, Some(spread(Form::Relative, [0.02; 3])));
    assert_eq!(found.position, Some(spread(Form::Normal, [0.001; 3])));
    assert_eq!(found.velocity, Some(spread(Form::Uniform, [1.0, 2.0, 3.0])));
    let parameters: Vec<_> = found.parameters.iter().map(|(p, spread)| (p.name(), *spread)).collect();
    assert_eq!(
        parameters,
        [
            ("torque.viscous_damping".to_owned(), one(Form::Relative, 0.1)),
            ("torque.gravity_gradient.period".to_owned(), one(Form::Normal, 0.001)),
            ("torque.gravity_gradient.eccentricity".to_owned(), one(Form::Uniform, 0.0)),
        ]
    );
    let names: Vec<String> = found.varied().into_iter().map(|varied| varied.name).collect();
    assert_eq!(
        names,
        [
            "attitude",
            "spin.direction",
            "spin",
            "moments",
            "position",
            "velocity",
            "torque.viscous_damping",
            "torque.gravity_gradient.period",
            "torque.gravity_gradient.eccentricity",
        ]
    );
    let least = super::scene(&with("number = 1\nattitude = 'uniform'")).ensemble.unwrap();
    assert_eq!((least.seed, least.attitude, least.spin), (0, Some(Attitudes::Uniform), None));
    assert!(super::scene(LEAST).ensemble.is_none());
}

#[test]
fn errors_in_ensembles_have_a_place() {
    let table = [
        ("attitud = 'uniform'", "12:1: unknown field `attitud`, expected `attitude`"),
        ("attitude = 'unifrm'", "12:12: unknown attitude `unifrm`, expected `uniform`"),
        ("attitude = 3", "12:12: expected a table such as `{ normal = … }`, found an integer"),
        ("attitude = { norml = 1 }", "12:14: unknown field `norml`, expected `normal`"),
        (
            "attitude = { normal = '2 m' }",
            "12:23: expected an angle such as `30 deg`, found a length (`2 m`)",
        ),
        ("attitude = { normal = [1, 2] }", "12:23: expected 3 numbers, found 2"),
        ("attitude = { normal = -1 }", "12:23: must not be negative, found -1"),
        (
            "attitude = { normal = '181 deg' }",
            "12:12: turns by more than half a turn; for every attitude alike write `attitude = \"uniform\"`",
        ),
        ("spin = 0.1", "12:8: expected a table such as `{ relative = 0.01 }`, found a float"),
        (
            "spin = {}",
            "12:8: missing field in the table, expected one of `direction`, `normal`, `uniform`, `relative`",
        ),
        ("spin = { direction = 'x' }", "12:22: unknown direction `x`, expected `uniform`"),
        (
            "spin = { normal = 1, relative = 1 }",
            "12:22: `relative` conflicts with `normal`, give only one of them",
        ),
        ("spin = { relative = 11 }", "12:21: must be from 0 to 10, the deviation of a logarithm, found 11"),
        ("spin = { normal = 1e308 }", "12:8: may draw -inf, but it must be finite; make it narrower"),
        ("moments = { normal = 0.1 }", "12:13: unknown field `normal`, expected `relative`"),
        (
            "position = { relative = 1 }",
            "12:14: unknown field `relative`, expected one of `normal`, `uniform`",
        ),
        ("velocity = { normal = '1 m' }", "12:23: expected a speed such as `3 m/s`, found a length (`1 m`)"),
        ("torque.dampin = { normal = 1 }", "12:8: unknown table `dampin`, expected `damping`"),
        (
            "torque.damping = { normal = 1 }",
            "12:8: a random parameter needs a value in the scene, which has no `damping` in [torque]",
        ),
        (
            "gravity.acceleration = { normal = 1 }",
            "12:9: a random parameter needs a value in the scene, which has no [gravity]",
        ),
        (
            "'torque.damping' = { normal = 1 }",
            "12:1: quotes make this a single name; write torque.damping without quotes",
        ),
        ("torque.pd_control = { normal = 1 }", "12:23: unknown field `normal`, expected one of `kp`, `kd`"),
        ("torque.pd_control.kd = 1", "12:24: expected a table such as `{ relative = … }`, found an integer"),
        (
            "torque.pd_control.kp = { uniform = 2 }",
            "12:24: may draw -1.00e0, but it must not be negative; make it narrower",
        ),
        (
            "torque.pd_control.kp = { normal = 0.2 }",
            "12:24: may draw -6.42e-1, but it must not be negative; make it narrower",
        ),
        (
            "torque.pd_control.kd = { relative = 1 }",
            "12:24: any multiple of 0 is 0; write `normal` or `uniform`",
        ),
        (
            "torque.gravity_gradient.eccentricity = { normal = 0.2 }",
            "12:40: may draw -1.14e0, but it must be at least 0 and below 1; make it narrower",
        ),
        (
            "torque.gravity_gradient = { rate = { normal = 1 }, period = { uniform = 1 } }",
            "12:52: `period` conflicts with `rate`, give only one of them",
        ),
    ];
    let laws =
        "[torque]\npd_control = { kp = 1, kd = 0 }\ngravity_gradient = { rate = 1, eccentricity = 0.5 }\n";
    let scene = LEAST.replace("[run]", &format!("{laws}[run]"));
    for (text, message) in table {
        let found = errors(&format!("{scene}[ensemble]\nnumber = 3\n{text}"));
        assert!(found.len() == 1 && found[0] == message, "{text}: {found:?}");
    }
}

#[test]
fn numbers_and_seeds_have_bounds() {
    let all = "attitude = 'uniform'";
    assert_eq!(errors(&with(&format!("number = 0\n{all}"))), ["8:10: must be from 1 to 100000000, found 0"]);
    assert_eq!(
        errors(&with(&format!("number = 1.5\n{all}"))),
        ["8:10: expected a whole number, found a float"]
    );
    assert_eq!(errors(&with(all)), ["7:1: missing field `number` in [ensemble]"]);
    assert_eq!(
        errors(&with(&format!("number = 3\nseed = -1\n{all}"))),
        ["9:8: must be from 0 to 9007199254740992, found -1"]
    );
    assert_eq!(
        errors(&with(&format!("number = 3\nseed = 0xffff_ffff_ffff_ffff\n{all}")))[0].split(':').next(),
        Some("9")
    );
    let same = errors(&with("number = 3"));
    assert!(
        same.len() == 1 && same[0].starts_with("7:1: all bodies are the same; give at least one of"),
        "{same:?}"
    );
    // With no spin there is no direction, and nothing to multiply.
    let still = with("number = 3\nspin = { direction = 'uniform' }").replace("[0, 0, 1]", "[0, 0, 0]");
    assert_eq!(errors(&still), ["9:8: a spin of 0 has no direction; give a spin in [initial]"]);
}

#[test]
fn errors_are_reported_together_with_those_of_the_scene() {
    let text = with("number = 0\nspin = { norml = 1 }\ntorque.dampng = 1")
        .replace("[run]", "[torque]\ndamping = '1 s'\n[run]");
    let found = errors(&text);
    let lines: Vec<&str> = found.iter().filter_map(|error| error.split(':').next()).collect();
    assert_eq!(lines, ["6", "10", "11", "12"], "{found:?}");
}

const RICH: &str = "number = 1000\nseed = 3\nattitude = 'uniform'\nspin = { direction = 'uniform', relative = 0.1 }\n\
    moments = { relative = 0.1 }\nposition = { normal = 1 }\nvelocity = { uniform = 1 }";

#[test]
fn a_body_depends_only_on_its_seed_and_number() {
    let all = drawn(&with(RICH), 0..1000);
    // A part, in a smaller ensemble.
    let part = drawn(&with(&RICH.replace("1000", "20")), 7..20);
    for row in 0..13 {
        assert_eq!(part.rotors[row], all.rotors[7 + row]);
        assert_eq!(part.omegas[row], all.omegas[7 + row]);
        assert_eq!(part.centers[row], all.centers[7 + row]);
        assert_eq!(part.inertias[row], all.inertias[7 + row]);
    }
    // With less drawn beside it.
    let attitudes = drawn(&with("number = 1000\nseed = 3\nattitude = 'uniform'"), 0..1000);
    assert_eq!(attitudes.rotors, all.rotors);
    assert_eq!((attitudes.inertias.len(), attitudes.omegas[5]), (1, [0.0, 0.0, 1.0]));
    let directions = drawn(&with("number = 1000\nseed = 3\nspin = { direction = 'uniform' }"), 0..1000);
    for (one, other) in directions.omegas.iter().zip(&all.omegas) {
        let along: f64 = (0..3).map(|k| one[k] * other[k]).sum();
        assert!((along - Bivector(*other).norm()).abs() < 4.0 * f64::EPSILON * along);
    }
    // Another seed, other bodies; another name, other numbers.
    assert_ne!(drawn(&with(&RICH.replace("seed = 3", "seed = 4")), 0..1).rotors, all.rotors[..1]);
    assert_ne!(all.centers[0][..3], all.centers[0][3..]);
}

/// Draws must not change between releases.
#[test]
fn draws_are_reproducible() {
    let bodies = drawn(&with(RICH), 41..42);
    assert_eq!(
        bodies.rotors[0],
        [0.8719188113794327, -0.14627036359753096, 0.16668752286219002, 0.43655221545399353]
    );
    assert_eq!(bodies.omegas[0], [-0.1302962944178382, 0.8995451493179032, -0.2345530262739654]);
    assert_eq!(
        bodies.centers[0],
        [
            -0.5242654641649374,
            -1.4124677921740065,
            -2.3280533895410884,
            0.8384785522809668,
            -0.7974515528046762,
            -0.4382554313201805
        ]
    );
    assert_eq!(
        bodies.inertias[0].principal_moments(),
        [2.9841028518591592, 2.0631972327716683, 0.9209056190874909]
    );
}

#[test]
fn uniform_attitudes_are_uniform() {
    let n = 50_000;
    let bodies = drawn(&with(&format!("number = {n}\nattitude = 'uniform'")), 0..n);
    let rotors: Vec<Rotor> = bodies.rotors.iter().map(|r| Rotor::from_components(*r).unwrap()).collect();
    // Rotors are unit to rounding, and kept as they are.
    assert!(rotors.iter().zip(&bodies.rotors).all(|(rotor, row)| rotor.components() == *row));
    // Every entry of the matrix has mean 0 and, as a component of a direction, lies in [−1, 1] all alike.
    for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
        let entries: Vec<f64> = rotors.iter().map(|rotor| rotor.to_matrix()[i][j]).collect();
        assert!(moments(&entries).0.abs() < 5.0 / (3.0 * n as f64).sqrt());
        assert!(distance(entries, |x| 0.5 * (1.0 + x)) < 2.6);
    }
    // The angle θ of the turn has the density (1 − cos θ)/π.
    let angles = bodies.rotors.iter().map(|r| 2.0 * r[0].abs().min(1.0).acos()).collect();
    assert!(distance(angles, |x| (x - x.sin()) / PI) < 2.6);
}

#[test]
fn attitudes_turn_about_the_axes_of_the_body() {
    let n = 20_000;
    let text = with(&format!("number = {n}\nattitude = {{ normal = [0.3, '2 deg', 0] }}"))
        .replace("spin =", "attitude = { plane = 'e1e2', angle = '90 deg' }\nspin =");
    let nominal = scene(&text).attitude;
    let turns: Vec<[f64; 3]> = drawn(&text, 0..n)
        .rotors
        .iter()
        .map(|row| (nominal.reverse() * Rotor::from_components(*row).unwrap()).to_rotation_vector().0)
        .collect();
    let component = |k: usize| turns.iter().map(|turn| turn[k]).collect::<Vec<f64>>();
    assert!(is_normal(&component(0), 0.3) && is_normal(&component(1), PI / 90.0));
    assert!(component(2).iter().all(|x| x.abs() < 1e-15));
}

#[test]
fn spins_spread_in_the_axes_in_which_they_are_given() {
    let n = 20_000;
    let given = "spin = { vector = [0, 3, 4]";
    let text = |ensemble: &str| {
        with(&format!("number = {n}\nattitude = 'uniform'\n{ensemble}"))
            .replace("spin = { vector = [0, 0, 1]", given)
    };
    let omegas = |text: &str| drawn(text, 0..n);
    let component =
        |rows: &[[f64; 3]], k: usize, x: f64| rows.iter().map(|row| row[k] - x).collect::<Vec<f64>>();

    let body = omegas(&text("spin = { normal = [0.1, 0.2, 0] }")).omegas;
    assert!(is_normal(&component(&body, 0, 0.0), 0.1) && is_normal(&component(&body, 1, 3.0), 0.2));
    assert!(component(&body, 2, 4.0).iter().all(|x| *x == 0.0));

    // In space the same numbers, turned into each body.
    let space = omegas(&text("spin = { normal = [0.1, 0.2, 0] }").replace("4]", "4], frame = 'space'"));
    for ((row, omega), expected) in space.rotors.iter().zip(&space.omegas).zip(&body) {
        let rotor = Rotor::from_components(*row).unwrap();
        let back = rotor.apply_bivector(Bivector(*omega)) - Bivector(*expected);
        // Two turns, each by a rotor whose square is 1 to two roundings, with some six more.
        assert!(back.norm() < 16.0 * f64::EPSILON * 5.0);
    }

    // A factor for all components, whose logarithm is normal.
    let scaled = omegas(&text("spin = { relative = 0.05 }")).omegas;
    let logarithms: Vec<f64> = scaled.iter().map(|row| (row[1] / 3.0).ln()).collect();
    assert!(is_normal(&logarithms, 0.05));
    assert!(scaled.iter().all(|row| row[0] == 0.0 && (row[2] / row[1] - 4.0 / 3.0).abs() < 1e-15));

    let wide = omegas(&text("spin = { uniform = 2 }")).omegas;
    assert!(distance(component(&wide, 2, 4.0), |x| 0.25 * (2.0 + x)) < 2.6);

    // Archimedes: the components of a direction are uniform in [−1, 1].
    let turned = omegas(&text("spin = { direction = 'uniform' }")).omegas;
    assert!(turned.iter().all(|row| (Bivector(*row).norm() - 5.0).abs() < 4.0 * f64::EPSILON * 5.0));
    for k in 0..3 {
        assert!(distance(component(&turned, k, 0.0), |x| 0.1 * (5.0 + x)) < 2.6);
    }
}

#[test]
fn drawn_moments_are_physical() {
    let n = 20_000;
    for given in ["[3, 2, 1.5]", "[3, 2, 1]", "[1, 1, 1]", "[2, 1, 1]"] {
        let text = with(&format!("number = {n}\nmoments = {{ relative = 1 }}")).replace("[3, 2, 1]", given);
        let bodies = drawn(&text, 0..n);
        let integrals = |[a, b, c]: [f64; 3]| [b + c - a, c + a - b, a + b - c].map(|x| 0.5 * x);
        let nominal = integrals(scene(&text).build_body().unwrap().inertia.principal_moments());
        for k in 0..3 {
            let ratio = |inertia: &crate::Inertia| integrals(inertia.principal_moments())[k] / nominal[k];
            // Flat bodies stay flat; the other integrals have factors whose logarithms are normal, and lose
            // no more digits in the differences than 1 in 1e8 of the moments.
            if nominal[k] == 0.0 {
                let largest = |i: &crate::Inertia| i.principal_moments().into_iter().fold(0.0, f64::max);
                let flat =
                    |i: &crate::Inertia| integrals(i.principal_moments())[k].abs() <= largest(i) * 4e-16;
                assert!(bodies.inertias.iter().all(flat));
            } else {
                let logarithms: Vec<f64> = bodies.inertias.iter().map(|i| ratio(i).ln()).collect();
                assert!(is_normal(&logarithms, 1.0), "{given} {k} {:?}", moments(&logarithms));
            }
        }
    }
}

#[test]
fn moments_are_drawn_along_the_principal_axes_and_about_the_fixed_point() {
    let turned = "inertia = [[3, 0, 0], [0, 2, 0.5], [0, 0.5, 2]]\nmass = 2\ncenter_of_mass = [0, 0, 1]";
    let text = with("number = 10\nmoments = { relative = 0.1 }").replace("moments = [3, 2, 1]", turned);
    let nominal = scene(&text).build_body().unwrap().inertia;
    let free = drawn(&text, 0..10);
    for inertia in &free.inertias {
        let [a, b] = [nominal, *inertia].map(|i| i.principal_frame());
        assert!((a.components()[1] - b.components()[1]).abs() < 1e-15, "{a:?} {b:?}");
    }
    let held = drawn(&text.replace("[run]", "[gravity]\nacceleration = 10\n[run]"), 0..10);
    for (about, inertia) in held.inertias.iter().zip(&free.inertias) {
        // m d² is 2 about e1 and e2.
        let (m, c) = (about.matrix(), inertia.matrix());
        assert!((m[0][0] - c[0][0] - 2.0).abs() < 1e-14 && (m[1][1] - c[1][1] - 2.0).abs() < 1e-14);
        assert!((m[2][2] - c[2][2]).abs() < 1e-14 && (m[1][2] - c[1][2]).abs() < 1e-14);
    }
    assert!(matches!(held.laws[0][..], [Torque::Heavy(Vector([0.0, 0.0, 20.0]))]));
}

#[test]
fn gravity_varies_as_the_acceleration() {
    let body = "moments = [3, 2, 1]\nmass = 2\ncenter_of_mass = [0, 0, 0.5]";
    let text =
        with("number = 20_000\ngravity.acceleration = { normal = 0.1 }\ntorque.heavy = { relative = 0.1 }")
            .replace("moments = [3, 2, 1]", body)
            .replace("[run]", "[torque]\nheavy = [0, 0, 1]\n[gravity]\nacceleration = 10\n[run]");
    let laws = drawn(&text, 0..20_000).laws;
    let weight = |torque: &Torque| if let Torque::Heavy(c) = torque { c.0 } else { panic!("{torque:?}") };
    let above: Vec<f64> = laws[0].iter().map(|law| weight(law)[2] - 10.0).collect();
    assert!(is_normal(&above, 0.1));
    let factors: Vec<f64> = laws[1].iter().map(|law| weight(law)[2].ln()).collect();
    assert!(is_normal(&factors, 0.1));
}

#[test]
fn parameters_of_one_law_are_drawn_independently() {
    let laws = "[torque]\nmagnetic = { dipole = [1, 2, 3], field = [0, 0, 1] }\nviscous_damping = 2\n\
                pd_control = { kp = [1, 2, 3], kd = 1 }\ntorque_body = 'Ω'\n[run]";
    let text = |more: &str| with(&format!("number = 5\n{more}")).replace("[run]", laws);
    let dipole = "torque.magnetic.dipole = { normal = [1, 0, 0] }";
    let both = format!(
        "{dipole}\ntorque.magnetic.field = {{ relative = 0.5 }}\n\
         torque.viscous_damping = {{ uniform = 1 }}\ntorque.pd_control.kp = {{ uniform = 0.5 }}"
    );
    let (one, two) = (drawn(&text(dipole), 0..5), drawn(&text(&both), 0..5));
    for row in 0..5 {
        let (Torque::Magnetic { dipole: a, .. }, Torque::Magnetic { dipole: b, field }) =
            (&one.laws[0][row], &two.laws[0][row])
        else {
            panic!("{:?}", one.laws)
        };
        assert_eq!((a, a.0[1], a.0[2], field.0[0]), (b, 2.0, 3.0, 0.0));
        assert_ne!((a.0[0], field.0[2]), (1.0, 1.0));
        // One number for all axes stays one; three differ.
        let Torque::ViscousDamping(damping) = &two.laws[1][row] else { panic!("{:?}", two.laws) };
        assert_eq!(damping.along(), [damping.along()[0]; 3]);
        let Torque::Control { stiffness, damping, .. } = &two.laws[2][row] else { panic!("{:?}", two.laws) };
        let off = [0, 1, 2].map(|k| stiffness.along()[k] - (k as f64 + 1.0));
        assert!(off[0] != off[1] && off[1] != off[2] && damping.along() == [1.0; 3]);
    }
    // Constant laws have a single row.
    assert_eq!(one.laws.iter().map(Vec::len).collect::<Vec<_>>(), [5, 1, 1, 1]);
}

#[test]
fn every_parameter_is_read_and_set() {
    for parameter in PARAMETERS.iter().skip(1) {
        let entry = torque(parameter.law).unwrap();
        let own = |argument: &Argument| match argument.shape {
            Shape::Rotor => vec![1.0, 0.0, 0.0, 0.0],
            _ => (0..argument.shape.size()).map(|k| 0.5 + 0.125 * k as f64).collect(),
        };
        let law = &entry.build(&entry.arguments.iter().flat_map(own).collect::<Vec<_>>()).unwrap();
        let wanted = if parameter.size == 3 { [0.5, 0.25, 0.125] } else { [0.5, 0.0, 0.0] };
        let set = parameter.set(law, wanted).unwrap();
        assert_eq!(parameter.of(&set).unwrap().0, wanted, "{}", parameter.name());
        // And the others of its law stay.
        for other in PARAMETERS.iter().filter(|p| p.law == parameter.law && p.field != parameter.field) {
            if !(matches!(other.field, "rate" | "period") && matches!(parameter.field, "rate" | "period")) {
                assert_eq!(other.of(&set), other.of(law), "{} {}", parameter.name(), other.name());
            }
        }
    }
}

#[test]
fn overflow_is_reported_with_the_body_number() {
    let text = with("number = 9\nmoments = { relative = 10 }").replace("[3, 2, 1]", "[3e307, 2e307, 2e307]");
    let scene = scene(&text);
    let (body, laws) = scene.build().unwrap();
    let error = scene.bodies(ensemble(&scene), (&body, &laws), 2..9).unwrap_err();
    assert!(error.body >= 2 && error.to_string().starts_with(&format!("body {}: ", error.body)), "{error}");
}

#[test]
fn what_is_kept_is_read_in_a_fixed_order() {
    let found = scene(&with("number = 2\nattitude = \"uniform\"\nkeep = [\"regime\", \"last\", \"last\"]"));
    assert_eq!(ensemble(&found).keep, ["last", "regime"]);
    let found = scene(&with("number = 2\nattitude = \"uniform\""));
    assert!(ensemble(&found).keep.is_empty());
}

#[test]
fn errors_in_what_is_kept_have_a_place_and_a_remedy() {
    let words = "`last`, `extrema`, `regime`, `periods`, `quantiles`, `events`";
    for (keep, expected) in [
        ("[\"first\"]", words),
        ("[]", "nothing is kept; give some of last, extrema"),
        ("\"last\"", "expected an array of words such as"),
    ] {
        let text = with(&format!("number = 2\nattitude = \"uniform\"\nkeep = {keep}"));
        let problems = Scene::parse(&text, Path::new("a.toml")).unwrap_err();
        assert!(problems[0].to_string().contains(expected), "{}", problems[0]);
    }
    let damped = format!("{LEAST}[torque]\ndamping = 0.1\n[ensemble]\nnumber = 2\nattitude = \"uniform\"\n");
    let problems = Scene::parse(&format!("{damped}keep = [\"periods\"]"), Path::new("a.toml")).unwrap_err();
    assert!(problems[0].to_string().contains("`periods` needs a body without torques"), "{}", problems[0]);
}
