//! Scene files: any text is a list of errors at places in it, or a scene that can be built, or not for a stated reason.
#![no_main]

use libfuzzer_sys::fuzz_target;
use polhode_ga::diagnostic::Diagnostic;
use polhode_rigid::body::mesh::{MeshFormat, TriangleMesh};
use polhode_rigid::scene::Scene;
use std::path::Path;

/// More bodies or points take long to read, as they should.
const MOST: usize = 1000;

const TABLE: &str = "initial.spin.rate,torque.damping\n1 rev/s,0.1\n2 rev/s,0.2\n";
const MESH: &str = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fuzz_target!(|text: &str| {
    if !has_many(text) {
        check(text);
    }
});

/// Whether a number of the text may ask for more than [`MOST`] points.
fn has_many(text: &str) -> bool {
    let digits = |word: &str| word.bytes().filter(u8::is_ascii_digit).count() > 3;
    text.contains("from") && text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(digits)
}

fn check(text: &str) {
    let table = |_: &Path| Ok(TABLE.to_owned());
    let scene = match Scene::parse_with(text, Path::new("x.toml"), &table) {
        Ok(scene) => scene,
        Err(problems) => return check_problems(&problems),
    };
    let mesh = |_: &Path| TriangleMesh::parse(MESH.as_bytes(), MeshFormat::Obj, "x.obj");
    let (body, laws) = match scene.build_with(&mesh) {
        Ok(built) => built,
        Err(problems) => return check_problems(&problems),
    };
    assert!(body.mass > 0.0 && body.mass.is_finite(), "{body:?}");
    if let Some(surface) = scene.surface_with(&mesh) {
        assert!(!surface.expect("the body was built").faces.is_empty());
    }
    let setup = scene.setup(&body, &laws);
    assert!(!setup.facts().is_empty());
    assert!(setup.sources(setup.time).iter().all(|source| !source.facts().is_empty()));
    let _ = scene.problem(&body, &laws);
    if scene.run.samples <= MOST {
        let times = scene.times();
        assert_eq!(times.len(), scene.run.samples);
        assert!(times.iter().all(|time| time.is_finite()), "{times:?}");
    }
    if let Some(ensemble) = &scene.ensemble {
        // An error is one of numbers beyond the range of floats.
        if let Ok(bodies) = scene.bodies(ensemble, (&body, &laws), 0..ensemble.number.min(3)) {
            assert_eq!(bodies.starts.len(), ensemble.number.min(3));
        }
        assert!(ensemble.varied().iter().all(|varied| !varied.name.is_empty()));
    }
}

fn check_problems(problems: &[Diagnostic]) {
    assert!(!problems.is_empty());
    for problem in problems {
        assert!(!problem.message.is_empty() && problem.to_string().contains("x.toml"), "{problem}");
    }
}
