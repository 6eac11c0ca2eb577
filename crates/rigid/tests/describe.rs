//! Descriptions of motions: kinds by the torques, and facts by name.

use polhode_rigid::facts::{Fact, Facts};
use polhode_rigid::scene::Scene;
use std::path::Path;

const START: &str = "[body]\nmoments = [3, 2, 1]\nmass = 2\n[initial]\nspin = { vector = [0.1, 1, 0.2] }\n\
                     [run]\nduration = 2\nsamples = 21\n";

/// The facts of a scene with these tables, from its start and of its motion.
fn facts(tables: &str) -> (Facts, Facts) {
    let scene = Scene::parse(&format!("{START}{tables}"), Path::new("test.toml")).expect("a scene");
    let (body, laws) = scene.build().expect("a body");
    let problem = scene.problem(&body, &laws);
    let motion = problem.simulate(&scene.times(), scene.options(), &mut |_| true).expect("a motion");
    let setup = scene.setup(&body, &laws);
    (setup.facts(), setup.describe(&motion))
}

fn fact<'a>(facts: &'a Facts, name: &str) -> &'a Fact {
    facts.iter().find(|(own, _)| *own == name).map_or(&Fact::None, |(_, fact)| fact)
}

fn kind(tables: &str) -> Fact {
    fact(&facts(tables).1, "kind").clone()
}

#[test]
fn kinds_follow_from_the_torques() {
    for (tables, expected) in [
        ("", "free"),
        ("[force]\nthrust = { force = [0, 0, 1] }", "free"),
        ("[force]\nthrust = { force = [0, 0, 1], at = [1, 0, 0] }", "torqued"),
        ("[torque]\ngyrostat = [0, 0, 1]", "gyrostat"),
        ("[torque]\ndamping = 0.1", "damped"),
        ("[torque]\ndamping = 0.1\ngyrostat = [0, 0, 1]", "torqued"),
        ("[torque]\ngravity_gradient = { rate = 1 }\ndamping = 0.1", "satellite"),
        ("[torque]\nheavy = [0.1, 0, 3]", "heavy"),
    ] {
        assert_eq!(kind(tables), expected.into(), "{tables}");
    }
}

/// Only torques that change L or its direction in the body count as changes: not a weight or a wheel.
#[test]
fn changes_are_those_by_dissipative_and_applied_torques() {
    let changes = |tables: &str| fact(&facts(tables).1, "changes").clone();
    assert_eq!(changes("[torque]\nheavy = [0.1, 0, 3]\ngyrostat = [0, 0, 1]"), Fact::None);
    let Fact::Table(changes) = changes("[torque]\ndamping = 0.5") else { panic!("no changes") };
    let Fact::Table(ends) = fact(&changes, "angular_momentum") else { panic!("no ends") };
    let (Fact::Number(start), Fact::Number(end)) = (fact(ends, "start"), fact(ends, "end")) else {
        panic!("no numbers")
    };
    // L decays as exp(−0.5 t), t = 2 s.
    assert!((end / start - (-1.0_f64).exp()).abs() < 1e-14);
}

#[test]
fn free_motions_are_known_from_the_start() {
    let (start, motion) = facts("");
    assert_eq!((fact(&start, "held"), fact(&start, "top")), (&Fact::Flag(false), &Fact::None));
    let Fact::Table(free) = fact(&start, "free") else { panic!("a free motion") };
    for (name, value) in free {
        assert_eq!(fact(&motion, name), value, "{name}");
    }
    let heavy = facts("[torque]\nheavy = [0.1, 0, 3]").0;
    assert_eq!(fact(&heavy, "heavy"), &[0.1, 0.0, 3.0].into());
    assert_eq!((fact(&heavy, "held"), fact(&heavy, "free")), (&Fact::Flag(true), &Fact::None));
}
