//! Tests of scenes on disk and of their bodies.

use super::*;
use crate::body::solids::Amount;

/// A temporary folder, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("polhode-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, content).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The scene with this `[body]`, at a path without a file.
fn scene(body: &str) -> Scene {
    let rest = "[initial]\nspin = { vector = [0, 0, 1] }\n[run]\nduration = 10\n";
    Scene::parse(&format!("[body]\n{body}\n{rest}"), Path::new("x.toml")).unwrap()
}

/// The first line of the only error of an impossible body.
fn body_error(scene: &Scene) -> String {
    let errors = scene.build_body().unwrap_err();
    assert_eq!(errors.len(), 1);
    errors[0].to_string().lines().next().unwrap().to_owned()
}

/// A tetrahedron with a corner at the origin and legs of 60 along the axes.
const TETRAHEDRON: &str = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn invalid_files_are_rejected() {
    let folder = Folder::new("scenes");
    let message =
        |path: &Path| Scene::read(path).unwrap_err()[0].to_string().replace(path.to_str().unwrap(), "P");
    assert_eq!(message(&folder.0), "P: error: is a directory, expected a scene file");
    assert_eq!(message(&folder.0.join("none")), "P: error: no such file");
    let not_utf8 = folder.write("x", b"a = 1\nb = \"\xff\"");
    assert_eq!(
        message(&not_utf8),
        "P:2:6: error: not UTF-8 text from here on, save the file as UTF-8\n  |\n\
         2 | b = \"\u{fffd}\"\n  |      ^"
    );
    let large = folder.write("y", vec![b'#'; 10_000_001]);
    assert_eq!(message(&large), "P: error: larger than 10 MB, expected a scene file");
    let text = scene("moments = [3, 2, 1]").text;
    let good = folder.write("z", &text);
    assert_eq!(format!("{:?}", Scene::read(&good)), format!("{:?}", Scene::parse(&text, &good)));
}

#[test]
fn a_mesh_beside_the_scene_becomes_a_body_in_metres() {
    let folder = Folder::new("mesh");
    let text = scene("mesh = 'parts/a.obj'\nlength_unit = 'mm'\ndensity = '1 g/cm^3'").text;
    let path = folder.write("x.toml", text);
    std::fs::create_dir_all(folder.0.join("parts")).unwrap();
    folder.write("parts/a.obj", TETRAHEDRON);
    let body = Scene::read(&path).unwrap().build_body().unwrap();
    // a³/6 · 1000 kg/m³ for a = 60 mm; the centre of mass is the mean of the corners.
    assert!((body.mass - 0.036).abs() < 0.036 * 1e-14, "{}", body.mass);
    assert!((body.center_of_mass - Vector([0.015; 3])).norm() < 1e-16);
}

#[test]
fn an_impossible_mesh_is_reported_at_its_field() {
    let folder = Folder::new("open");
    let text = scene("mesh = 'a.obj'\nmass = 1").text;
    let path = folder.write("x.toml", text);
    let error = || body_error(&Scene::read(&path).unwrap());
    let start = format!("{}:2:8: error: {}: ", path.display(), folder.0.join("a.obj").display());
    assert!(error().starts_with(&(start.clone() + "cannot be read: ")), "{}", error());
    folder.write("a.obj", TETRAHEDRON.trim_end().rsplit_once('\n').unwrap().0);
    assert!(error().starts_with(&(start + "the mesh is open: 3 edges ")), "{}", error());
}

#[test]
fn solids_and_given_inertias_become_bodies() {
    let body = scene("solid = 'cylinder'\nradius = '2 m'\nheight = 3\nmass = 5").build_body().unwrap();
    assert_eq!(body, crate::Solid::Cylinder { radius: 2.0, height: 3.0 }.body(Amount::Mass(5.0)).unwrap());
    let body = scene("moments = [3, 2, 1.5]\nmass = 4\ncenter_of_mass = [0, 0, 1]").build_body().unwrap();
    assert_eq!((body.mass, body.center_of_mass), (4.0, Vector([0.0, 0.0, 1.0])));
    assert_eq!(body.inertia.principal_moments(), [3.0, 2.0, 1.5]);
    let body = scene("inertia = [[3, 0, 0], [0, 2, 0.5], [0, 0.5, 2]]").build_body().unwrap();
    assert_eq!(body.mass, 1.0);
    assert_eq!(body.inertia.matrix(), [[3.0, 0.0, 0.0], [0.0, 2.0, 0.5], [0.0, 0.5, 2.0]]);
}

#[test]
fn impossible_bodies_are_reported_at_their_field() {
    let table = [
        ("moments = [9, 2, 1]", "x.toml:2:11: error: no body has the principal moments 9.0, 2.0, 1.0: "),
        (
            "inertia = [[1, 2, 0], [0, 1, 0], [0, 0, 1]]",
            "x.toml:2:11: error: the inertia matrix is not symmetric: ",
        ),
        ("solid = 'rod'\nlength = 1\ndensity = 1", "x.toml:4:11: error: a rod has no volume, "),
        (
            "solid = 'hollow_sphere'\nouter_radius = 1\ninner_radius = 2\nmass = 1",
            "x.toml:4:16: error: inner_radius must be between 0 and ",
        ),
        (
            "solid = 'torus'\nminor_radius = 2\nmajor_radius = 1\nmass = 1",
            "x.toml:3:16: error: a torus with minor_radius = 2.0 m ",
        ),
        (
            "solid = 'sphere'\nradius = 1e200\ndensity = 1",
            "x.toml:4:11: error: mass must be positive and finite, got inf kg",
        ),
        (
            "solid = 'sphere'\nradius = 1e-200\nmass = 1",
            "x.toml:2:9: error: the largest moment of inertia, 0.0 kg m²",
        ),
    ];
    for (body, message) in table {
        let error = body_error(&scene(body));
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn gravity_needs_a_mass() {
    let free = scene("moments = [3, 2, 1]");
    assert!(free.build_body().is_ok());
    let heavy = Scene { gravity: Some(Gravity { acceleration: 9.8, pivot: Vector::default() }), ..free };
    assert_eq!(body_error(&heavy), "x.toml:1:1: error: gravity acts on the mass, add the field `mass`");
}
