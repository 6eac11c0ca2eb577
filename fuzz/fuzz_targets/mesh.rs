//! Mesh files: any bytes are an error that names the file, or a mesh whose body and surface are finite.
#![no_main]

use libfuzzer_sys::fuzz_target;
use polhode_rigid::body::mesh::{MeshFormat, TriangleMesh};
use polhode_rigid::body::solids::Amount;
use polhode_rigid::body::surface::Surface;

// The first byte selects the format; the rest is the file.
fuzz_target!(|data: &[u8]| {
    let Some((choice, bytes)) = data.split_first() else { return };
    let format = [MeshFormat::Stl, MeshFormat::Obj, MeshFormat::Ply][usize::from(choice % 3)];
    let mesh = match TriangleMesh::parse(bytes, format, "part") {
        Ok(mesh) => mesh,
        Err(error) => return assert!(error.to_string().starts_with("part"), "{error}"),
    };
    let surface = Surface::of_mesh(&mesh);
    assert!(!surface.faces.is_empty() && surface.vertices.iter().all(|x| x.0.iter().all(|x| x.is_finite())));
    for amount in [Amount::Density(1000.0), Amount::Mass(2.0)] {
        match mesh.body(amount) {
            Ok(body) => {
                assert!(body.mass > 0.0 && body.mass.is_finite(), "{body:?}");
                assert!(body.center_of_mass.0.iter().all(|x| x.is_finite()), "{body:?}");
                assert!(body.inertia.principal_moments().iter().all(|x| x.is_finite()), "{body:?}");
            }
            Err(error) => assert!(error.to_string().starts_with("part"), "{error}"),
        }
    }
});
