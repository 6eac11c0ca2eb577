//! Motions, facts and surfaces for the page.

use crate::about::about;
use crate::opened::crowd::Slice;
use crate::opened::{Files, Opened};
use crate::recorded::Recorded;
use crate::rows::ROW;

const FREE: &str =
    "[body]\nmoments = [3, 2, 1]\n[initial]\nspin = { vector = [0.1, 1, 0.2] }\n[run]\nduration = 2\n";
const HEAVY: &str = "[body]\nsolid = 'cone'\nradius = 0.1\nheight = 0.3\nmass = 1\n[initial]\n\
                     attitude = { plane = 'e2e3', angle = '20 deg' }\nspin = { vector = [0, 0, '20 rev/s'] }\n\
                     [gravity]\nacceleration = 9.81\npivot = [0, 0, -0.1]\n[run]\nduration = 1\n";
const DAMPED: &str = "[body]\nmoments = [3, 2, 1]\n[initial]\nspin = { vector = [0.1, 1, 0.2] }\n[torque]\n\
                      viscous_damping = 0.5\n[run]\nduration = 2\n";
const SWARM: &str = "[ensemble]\nnumber = 20\nattitude = 'uniform'\nspin = { relative = 0.1 }\n";

fn opened(text: &str) -> Opened {
    Opened::new(text, "test.toml", &Files::new(), &mut || true).expect("a scene")
}

/// `R Ω_B ~R = Ω_S` and `L_S = R I(Ω_B) ~R` in each row; exact motions have states beyond their run.
#[test]
fn rows_are_consistent() {
    for text in [FREE, HEAVY, DAMPED] {
        let of = opened(text);
        let times: &[f64] = if text == DAMPED { &[2.0, 0.0, 1.3] } else { &[2.0, 0.0, -7.0, 1e6] };
        for (row, time) in of.states(times).unwrap().iter().zip(times) {
            assert_eq!(row[0], *time);
            let twice_kinetic: f64 = (0..3).map(|k| row[5 + k] * row[11 + k]).sum();
            let in_space: f64 = (0..3).map(|k| row[8 + k] * row[14 + k]).sum();
            assert!((twice_kinetic - in_space).abs() < 1e-13 * twice_kinetic, "{text}");
            assert!((row[1..5].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn stepped_motions_have_no_states_beyond_the_run() {
    let error = opened(DAMPED).states(&[3.0]).unwrap_err();
    assert!(error.contains("times[0] = 3 is outside the computed motion"), "{error}");
}

/// States and bodies have absolute times, as the laws do.
#[test]
fn states_begin_at_the_start_time() {
    let late = DAMPED
        .replace("[torque]\n", "time = 5\n[torque]\n")
        .replace("viscous_damping = 0.5", "torque_body = 'sin(t) e1e2'");
    let of = opened(&late);
    assert!(about(&of).to_string().contains(r#""time":5.0"#));
    let rows = of.states(&[5.0, 7.0]).unwrap();
    // Momentum over moment is the rate to a rounding.
    assert!([0.1, 1.0, 0.2].iter().zip(&rows[0][5..8]).all(|(w, x)| (x - w).abs() <= f64::EPSILON));
    assert!(of.states(&[4.0]).unwrap_err().contains("outside the computed motion, 5 s to 7 s"));
    let swarm =
        opened(&format!("{late}{}", SWARM.replace("attitude = 'uniform'\n", "").replace("0.1", "1e-12")));
    for (time, row) in [5.0, 7.0].into_iter().zip(&rows) {
        let rotor = swarm.bodies(1, &mut || true).unwrap().at(time)[0];
        assert!((0..4).all(|k| (rotor[k] - row[1 + k]).abs() < 1e-8), "{time}: {rotor:?}");
    }
}

#[test]
fn motions_beyond_the_time_limit_are_rejected() {
    let long = DAMPED.replace("duration = 2", "duration = 1e6");
    let mut calls = 0;
    let error = Opened::new(&long, "test.toml", &Files::new(), &mut || {
        calls += 1;
        calls < 3
    });
    assert!(error.err().unwrap().contains("too long"));
}

#[test]
fn facts_of_motions() {
    let free = about(&opened(FREE)).to_string();
    assert!(free.contains(r#""method":"exact""#) && free.contains(r#""regime":"long-axis mode""#), "{free}");
    let heavy = about(&opened(HEAVY)).to_string();
    assert!(
        heavy.contains(r#""solid":{"kind":"cone","radius":0.1,"height":0.3},"solid_at":[-0.0,-0.0,0.1]"#),
        "{heavy}"
    );
    assert!(heavy.contains(r#""regime":"nutating with cusps""#), "{heavy}");
    let sleeping = about(&opened(include_str!("../../../viewer/src/presets/sleeping.toml"))).to_string();
    assert!(sleeping.contains(r#""regime":"sleeping, nearly upright""#), "{sleeping}");
    assert!(about(&opened(DAMPED)).to_string().contains(r#""free":null,"top":null"#));
}

#[test]
fn a_missing_mesh_is_reported_at_its_place() {
    let text = FREE.replace("moments = [3, 2, 1]", "mesh = 'part.stl'\nmass = 1");
    let error = Opened::new(&text, "test.toml", &Files::new(), &mut || true).err().unwrap();
    assert!(
        error.starts_with("test.toml:2:8: error: part.stl: ") && error.contains("does not have this file"),
        "{error}"
    );
}

/// A mesh is in the axes of the body, whose origin is the pivot.
#[test]
fn a_surface_is_where_the_body_is() {
    let stl = "solid t\n".to_owned()
        + &[
            [[0, 1, 0], [1, 0, 0], [0, 0, 0]],
            [[1, 0, 0], [0, 0, 1], [0, 0, 0]],
            [[0, 0, 1], [0, 1, 0], [0, 0, 0]],
            [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        ]
        .map(|corners| {
            let rows = corners.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
            format!("facet normal 0 0 0\nouter loop\n{rows}endloop\nendfacet\n")
        })
        .concat()
        + "endsolid t\n";
    let files = Files::from([("part.stl".to_owned(), stl.into_bytes())]);
    let text = HEAVY.replace("solid = 'cone'\nradius = 0.1\nheight = 0.3", "mesh = 'part.stl'");
    let of = Opened::new(&text, "test.toml", &files, &mut || true).expect("a scene");
    let middle = of.surface.as_ref().unwrap().vertices.iter().map(|v| v.0[2]).fold(f64::INFINITY, f64::min);
    assert_eq!(middle, 0.1);
    assert!((of.body.center_of_mass.0[2] - 0.35).abs() < 1e-15);
}

#[test]
fn recordings_are_interpolated_between_rows() {
    let of = opened(FREE);
    let rows = of.states(&[0.0, 0.01, 0.02]).unwrap();
    let recorded = Recorded::new(&rows.concat()).unwrap();
    assert_eq!(recorded.states(&[0.0, 0.01, 0.02]).unwrap(), rows);
    let (found, exact) = (recorded.states(&[0.005]).unwrap()[0], of.states(&[0.005]).unwrap()[0]);
    // The uniform turn is off by about |Ω'| h²/8 = 1e-5.
    assert!((0..ROW).all(|k| (found[k] - exact[k]).abs() < 1e-4));
    assert!(recorded.states(&[0.03]).unwrap_err().contains("recorded from 0 s to 0.02 s"));
    assert!(Recorded::new(&[0.0; 5]).is_err());
    assert!(Recorded::new(&[rows[1], rows[0]].concat()).is_err());
}

/// Bodies of stepped ensembles have the motion of a single body at the frames.
#[test]
fn bodies_of_an_ensemble() {
    let exact = opened(&format!("{FREE}{SWARM}"));
    let rotors = exact.bodies(5, &mut || true).unwrap().at(1.0);
    assert_eq!(rotors.len(), 5);
    let stepped =
        opened(&format!("{DAMPED}{}", SWARM.replace("attitude = 'uniform'\n", "").replace("0.1", "1e-12")));
    let alone = stepped.states(&[2.0]).unwrap()[0];
    for rotor in stepped.bodies(100, &mut || true).unwrap().at(2.0) {
        assert!((0..4).all(|k| (rotor[k] - alone[1 + k]).abs() < 1e-8), "{rotor:?}");
    }
    assert!(opened(FREE).bodies(5, &mut || true).err().unwrap().contains("no table [ensemble]"));
}

/// Slices give the bits of one core, and a body that cannot be computed is named.
#[test]
fn slices_of_an_ensemble() {
    let scene = format!("{DAMPED}{SWARM}");
    let mut of = opened(&scene);
    let bits = |of: &Opened| {
        let crowd = of.bodies(100, &mut || true).unwrap();
        crowd.at(1.3).iter().map(|rotor| rotor.map(f64::to_bits)).collect::<Vec<_>>()
    };
    let cuts = [0, 1, 9, 13, 100];
    let slices = cuts.windows(2).map(|cut| Slice::new(&of, cut[0]..cut[1], &mut || true).unwrap());
    let rotors = slices.flat_map(|slice| slice.rotors).collect();
    of.join(Slice { rotors, problem: String::new() });
    assert_eq!(bits(&of).len(), 20);
    assert_eq!(bits(&of), bits(&opened(&scene)));

    let mut of = opened(&scene.replace("duration = 2", "duration = 1e3"));
    let late = Slice::new(&of, 5..8, &mut || false).unwrap();
    assert!(late.problem.starts_with("body 5: this motion takes too long"), "{}", late.problem);
    of.join(late);
    assert!(bits(&of).concat().iter().all(|&bits| f64::from_bits(bits).is_nan()));
    assert!(of.bodies_problem().starts_with("body 5"));
}

#[test]
fn the_page_gets_the_registry_of_laws() {
    let laws = crate::laws::laws().to_string();
    let damping = r#"{"name":"damping","label":"Damping","formula":"-g I(Ω)","arguments":[{"name":"g","field":"","unit":"1/s","shape":"scalar","period":"","optional":false}]}"#;
    assert!(laws.contains(damping), "{laws}");
    assert!(
        laws.contains(r#""name":"n","field":"rate","unit":"rad/s","shape":"scalar","period":"period""#),
        "{laws}"
    );
}
