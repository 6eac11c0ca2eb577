//! Surfaces are closed meshes that enclose nearly the volume of their solid, and have nearly its inertia.

use polhode_ga::{Rotor, Vector};
use polhode_rigid::{Amount, Body, Solid, Surface, TriangleMesh};

/// The uniform body inside a surface; `TriangleMesh::body` requires that the surface is closed and oriented.
fn inside(surface: &Surface, mass: f64) -> Body {
    let mesh = TriangleMesh::new(surface.vertices.clone(), surface.faces.clone()).unwrap();
    assert_eq!(surface.tints.len(), surface.faces.len());
    assert!(mesh.volume() > 0.0);
    mesh.body(Amount::Mass(mass)).unwrap()
}

fn volume(surface: &Surface) -> f64 {
    TriangleMesh::new(surface.vertices.clone(), surface.faces.clone()).unwrap().volume()
}

/// A regular polygon of n sides in a circle has a fraction `1 − (2π/n)²/6` of its area and `1 − (2π/n)²/3` of its second
/// moment. The circles have 64 sides, that of the tube of a torus 32: together at most (2π/64)²/3 + (2π/32)²/3 = 1.6%.
const INSCRIBED: f64 = 0.02;

#[test]
fn surfaces_enclose_their_solids() {
    for solid in [
        Solid::Box { lengths: [3.0, 2.0, 1.0] },
        Solid::Ellipsoid { semi_axes: [3.0, 2.0, 1.0] },
        Solid::Sphere { radius: 2.0 },
        Solid::Cylinder { radius: 1.0, height: 3.0 },
        Solid::Cone { radius: 1.0, height: 3.0 },
        Solid::Torus { major_radius: 2.0, minor_radius: 0.6 },
        Solid::Torus { major_radius: 2.0, minor_radius: 2.0 },
        Solid::Capsule { radius: 1.0, height: 2.0 },
    ] {
        let surface = Surface::of_solid(solid);
        let (found, exact) = (inside(&surface, 1.0), solid.body(Amount::Mass(1.0)).unwrap());
        let share = volume(&surface) / solid.volume().unwrap();
        assert!(share > 1.0 - INSCRIBED && share < 1.0 + 1e-12, "{solid:?}: {share}");
        assert!((found.center_of_mass - exact.center_of_mass).norm() < INSCRIBED, "{solid:?}");
        for i in 0..3 {
            for j in 0..3 {
                let (a, b) = (found.inertia.matrix()[i][j], exact.inertia.matrix()[i][j]);
                let largest = exact.inertia.matrix()[0][0].max(exact.inertia.matrix()[2][2]);
                assert!((a - b).abs() < INSCRIBED * largest, "{solid:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn the_outside_of_a_hollow_sphere_is_a_sphere() {
    let hollow = Surface::of_solid(Solid::HollowSphere { outer_radius: 2.0, inner_radius: 2.0 });
    assert_eq!(hollow, Surface::of_solid(Solid::Sphere { radius: 2.0 }));
}

/// What has no thickness is drawn with 3% of its longest side.
#[test]
fn thin_bodies_are_drawn_with_one_thickness() {
    let sides = [
        Surface::of_solid(Solid::Rod { length: 2.0 }).extents(),
        Surface::of_solid(Solid::Disc { radius: 1.0 }).extents(),
        // A square plate: i3 = i1 + i2, and i1 = m a²/12 with a = 2.
        Surface::of_inertia(3.0, [1.0, 1.0, 2.0], Rotor::IDENTITY, Vector::default()).extents(),
    ];
    for (found, expected) in sides.iter().flatten().zip([0.06, 0.06, 2.0, 2.0, 2.0, 0.06, 2.0, 2.0, 0.06]) {
        assert!((found - expected).abs() < 1e-12, "{sides:?}");
    }
}

/// The equivalent box has the moments of the body, about its principal axes wherever these point.
#[test]
fn a_body_of_known_inertia_is_an_equivalent_box() {
    let frame = Rotor::from_components([0.9, 0.1, -0.3, 0.2]).unwrap();
    let surface = Surface::of_inertia(2.0, [1.0, 1.5, 2.0], frame, Vector::default());
    assert_eq!((surface.vertices.len(), surface.faces.len()), (8, 12));
    let inertia = inside(&surface, 2.0).inertia;
    for (found, exact) in inertia.principal_moments().into_iter().zip([1.0, 1.5, 2.0]) {
        assert!((found - exact).abs() < 1e-12);
    }
    let axis = inertia.principal_frame().apply(Vector([0.0, 0.0, 1.0]));
    assert!((axis.dot(frame.apply(Vector([0.0, 0.0, 1.0]))).abs() - 1.0).abs() < 1e-12);
    // A ball has the faces of a sphere.
    let ball = Surface::of_inertia(1.0, [1.0; 3], frame, Vector::default());
    assert_eq!(ball.faces.len(), Surface::of_solid(Solid::Sphere { radius: 1.0 }).faces.len());
}

/// On an arm along an axis of symmetry a top whose tip is the fixed point, otherwise a box around the centre of mass.
#[test]
fn a_held_body_is_drawn_on_its_arm() {
    let arm = Vector([0.0, 0.0, -0.5]);
    let top = Surface::of_inertia(4.0, [3.0, 3.0, 1.0], Rotor::IDENTITY, arm);
    let body = inside(&top, 4.0);
    assert!(top.vertices[0].norm() == 0.0);
    // The profile was chosen with its centre of mass near 1: within 10% of the arm.
    assert!((body.center_of_mass - arm).norm() < 0.1 * 0.5, "{:?}", body.center_of_mass);
    let on_box = Surface::of_inertia(4.0, [3.0, 2.5, 1.0], Rotor::IDENTITY, arm);
    assert!((inside(&on_box, 4.0).center_of_mass - arm).norm() < 1e-12);
    assert!(on_box.vertices.iter().all(|x| (*x - arm).norm() < 0.31));
}

/// Faces of a solid of revolution lie in one quadrant, whose tint they have.
#[test]
fn quadrants_alternate() {
    let surface = Surface::of_solid(Solid::Capsule { radius: 1.0, height: 2.0 });
    for (face, tint) in surface.faces.iter().zip(&surface.tints) {
        let center = face.iter().fold(Vector::default(), |sum, &v| sum + surface.vertices[v as usize]);
        assert_eq!(*tint, u32::from(center.0[0] * center.0[1] > 0.0));
    }
}

/// A box is filled by solids that touch its sides, except by a ball in a long box.
#[test]
fn solids_fill_a_box() {
    let sides = [2.0, 2.0, 3.0];
    for kind in ["box", "ellipsoid", "cylinder", "cone", "capsule"] {
        let found = Surface::of_solid(Solid::filling(kind, sides).unwrap()).extents();
        assert!(found.iter().zip(sides).all(|(a, b)| (a - b).abs() < 1e-12), "{kind}: {found:?}");
    }
    for kind in ["sphere", "hollow_sphere", "rod", "disc", "torus"] {
        let solid = Solid::filling(kind, sides).unwrap();
        assert_eq!(solid.facts()[0], ("kind", kind.into()));
        assert!(solid.body(Amount::Mass(1.0)).is_ok());
    }
    assert_eq!(Solid::filling("cube", sides), None);
}
