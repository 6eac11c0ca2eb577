//! The closed forms of the solids against meshes of the same solids.

use polhode_ga::Vector;
use polhode_rigid::{Amount, Body, Solid, TriangleMesh};
use std::f64::consts::{FRAC_PI_2, PI};

const EPS: f64 = f64::EPSILON;

/// The surface that a profile `(r, z)` sweeps about e3; the inside is on the left of the profile.
fn revolve(profile: &[(f64, f64)], segments: usize) -> TriangleMesh {
    let corner = |i: usize, j: usize| {
        let (r, z) = profile[i];
        let angle = 2.0 * PI * (j % segments) as f64 / segments as f64;
        Vector([r * angle.cos(), r * angle.sin(), z])
    };
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for i in 0..profile.len() - 1 {
        for j in 0..segments {
            let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
            for triangle in [[a, b, c], [a, c, d]] {
                // At the axis a quadrilateral is a triangle.
                if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
                    let next = vertices.len() as u32;
                    faces.push([next, next + 1, next + 2]);
                    vertices.extend(triangle);
                }
            }
        }
    }
    TriangleMesh::new(vertices, faces).unwrap()
}

/// An arc about `(0 or r0, z0)` in n steps, its ends on the axis exactly where they belong.
fn arc(center: (f64, f64), radius: f64, from: f64, to: f64, n: usize) -> Vec<(f64, f64)> {
    let point = |k: usize| {
        let angle = from + (to - from) * k as f64 / n as f64;
        let on_axis = center.0 == 0.0 && (angle.abs() - FRAC_PI_2).abs() < 1e-9;
        let r = if on_axis { 0.0 } else { center.0 + radius * angle.cos() };
        (r, center.1 + radius * angle.sin())
    };
    (0..=n).map(point).collect()
}

fn half_circle(radius: f64, n: usize) -> Vec<(f64, f64)> {
    arc((0.0, 0.0), radius, -FRAC_PI_2, FRAC_PI_2, n)
}

/// Two meshes as one surface.
fn joined(a: &TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let shift = a.vertices().len() as u32;
    let vertices = [a.vertices(), b.vertices()].concat();
    let shifted = b.faces().iter().map(|f| f.map(|i| i + shift));
    TriangleMesh::new(vertices, a.faces().iter().copied().chain(shifted).collect()).unwrap()
}

fn reversed(mesh: &TriangleMesh) -> TriangleMesh {
    let faces = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
    TriangleMesh::new(mesh.vertices().to_vec(), faces).unwrap()
}

fn numbers(body: &Body) -> Vec<f64> {
    let m = body.inertia.matrix();
    vec![body.mass, body.center_of_mass.0[2], m[0][0], m[1][1], m[2][2]]
}

/// The error of a faceted surface falls with the square of the step, so that `(4 f(h/2) − f(h))/3` is off
/// only by the fourth power: about the square of the first error, which is below one percent.
fn assert_second_order(solid: Solid, mesh: impl Fn(usize) -> TriangleMesh) {
    let density = Amount::Density(1.7);
    let exact = numbers(&solid.body(density).unwrap());
    let [coarse, fine] = [64, 128].map(|n| numbers(&mesh(n).body(density).unwrap()));
    let relative = |x: f64, k: usize| (x - exact[k]) / exact[k].abs().max(exact[0]);
    let largest = (0..exact.len()).fold(0.0, |l: f64, k| l.max(relative(coarse[k], k).abs()));
    assert!(largest < 0.01, "{solid:?} {largest}");
    for k in 0..exact.len() {
        let (e, f) = (relative(coarse[k], k), relative(fine[k], k));
        let extrapolated = (4.0 * f - e) / 3.0;
        assert!(extrapolated.abs() < largest * largest, "{solid:?} {k} {extrapolated} {largest}");
        assert!(e.abs() < 1e-6 || (f / e - 0.25).abs() < 0.01, "{solid:?} {k} {e} {f}");
    }
}

#[test]
fn round_solids_are_the_limits_of_their_meshes() {
    let sphere = |radius: f64, n: usize| revolve(&half_circle(radius, n), n);
    assert_second_order(Solid::Sphere { radius: 0.9 }, |n| sphere(0.9, n));
    assert_second_order(Solid::Ellipsoid { semi_axes: [1.0, 0.5, 2.0] }, |n| {
        let ball = sphere(1.0, n);
        let stretched = ball.vertices().iter().map(|v| Vector([v.0[0], 0.5 * v.0[1], 2.0 * v.0[2]]));
        TriangleMesh::new(stretched.collect(), ball.faces().to_vec()).unwrap()
    });
    assert_second_order(Solid::HollowSphere { outer_radius: 1.0, inner_radius: 0.6 }, |n| {
        joined(&sphere(1.0, n), &reversed(&sphere(0.6, n)))
    });
    assert_second_order(Solid::Cylinder { radius: 0.7, height: 1.5 }, |n| {
        revolve(&[(0.0, -0.75), (0.7, -0.75), (0.7, 0.75), (0.0, 0.75)], n)
    });
    assert_second_order(Solid::Cone { radius: 0.7, height: 1.5 }, |n| {
        revolve(&[(0.0, 0.0), (0.7, 0.0), (0.0, 1.5)], n)
    });
    assert_second_order(Solid::Torus { major_radius: 1.2, minor_radius: 0.4 }, |n| {
        let mut circle = arc((1.2, 0.0), 0.4, 0.0, 2.0 * PI, n);
        circle[n] = circle[0];
        revolve(&circle, n)
    });
    assert_second_order(Solid::Capsule { radius: 0.5, height: 1.4 }, |n| {
        let lower = arc((0.0, -0.7), 0.5, -FRAC_PI_2, 0.0, n);
        let upper = arc((0.0, 0.7), 0.5, 0.0, FRAC_PI_2, n);
        revolve(&[lower, upper].concat(), n)
    });
}

#[test]
fn a_thin_box_and_a_thin_cylinder_are_a_rod_and_a_disc() {
    let mass = Amount::Mass(2.0);
    let moments = |solid: Solid| solid.body(mass).unwrap().inertia.principal_moments();
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-15);
    let thin = 1e-9;
    assert!(close(moments(Solid::Rod { length: 3.0 }), moments(Solid::Box { lengths: [thin, thin, 3.0] })));
    assert!(close(
        moments(Solid::Disc { radius: 1.5 }),
        moments(Solid::Cylinder { radius: 1.5, height: thin })
    ));
}

/// Between the thin shell, ⅔ m r², and the ball, ⅖ m r², the closed form has no seam.
#[test]
fn hollow_sphere_runs_from_ball_to_shell() {
    let moment = |inner_radius| {
        let solid = Solid::HollowSphere { outer_radius: 2.0, inner_radius };
        solid.body(Amount::Mass(3.0)).unwrap().inertia.principal_moments()[0]
    };
    assert_eq!(moment(0.0), 0.4 * 3.0 * 4.0);
    assert!((moment(2.0) - 8.0).abs() <= 4.0 * EPS * 8.0);
    // d(i)/d(inner) at the shell is m r·2/3, so 1e-9 m less changes it by 4e-9.
    assert!((moment(2.0) - moment(2.0 - 1e-9) - 4e-9).abs() < 1e-14);
    let thin = Solid::HollowSphere { outer_radius: 2.0, inner_radius: 2.0 };
    assert_eq!(thin.volume(), None);
}

#[test]
fn volumes() {
    assert_eq!(Solid::Box { lengths: [2.0, 3.0, 4.0] }.volume(), Some(24.0));
    assert_eq!(Solid::Sphere { radius: 1.0 }.volume(), Some(4.0 / 3.0 * PI));
    assert_eq!(Solid::Rod { length: 1.0 }.volume(), None);
    assert_eq!(Solid::Disc { radius: 1.0 }.volume(), None);
    assert_eq!(Solid::Sphere { radius: -1.0 }.volume(), None);
}

#[test]
fn errors_of_impossible_solids() {
    let error = |solid: Solid, amount| solid.body(amount).unwrap_err().to_string();
    let mass = Amount::Mass(1.0);
    assert_eq!(error(Solid::Sphere { radius: 0.0 }, mass), "radius must be positive and finite, got 0.0 m");
    assert!(error(Solid::Box { lengths: [1.0, -2.0, 1.0] }, mass).starts_with("lengths[1] must be positive"));
    assert!(
        error(Solid::Ellipsoid { semi_axes: [1.0, 2.0, f64::NAN] }, mass)
            .starts_with("semi_axes[2] must be positive")
    );
    assert_eq!(
        error(Solid::HollowSphere { outer_radius: 1.0, inner_radius: 1.5 }, mass),
        "inner_radius must be between 0 and outer_radius = 1.0 m, got 1.5 m"
    );
    assert!(error(Solid::Torus { major_radius: 1.0, minor_radius: 1.5 }, mass).contains("intersects itself"));
    let density = Amount::Density(1.0);
    assert_eq!(
        error(Solid::Rod { length: 1.0 }, density),
        "a rod has no volume, so a density does not determine its mass; give the mass"
    );
    assert!(
        error(Solid::HollowSphere { outer_radius: 1.0, inner_radius: 1.0 }, density)
            .starts_with("a hollow sphere with equal radii has no volume")
    );
    let ball = Solid::Sphere { radius: 1.0 };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            error(ball, Amount::Density(bad)),
            format!("density must be positive and finite, got {bad:?} kg/m³")
        );
        assert!(
            error(ball, Amount::Mass(bad))
                .starts_with(&format!("mass must be positive and finite, got {bad:?} kg"))
        );
    }
    assert!(error(Solid::Sphere { radius: 1e200 }, mass).contains("i1 is inf"));
    assert!(error(Solid::Sphere { radius: 1e-200 }, mass).contains("below the range of floating point"));
}

/// The solids for a box reach its sides: with two equal sides those about e3, in a cube spheres too.
#[test]
fn solids_fill_a_box() {
    let filling = |kind: &str, sides: [f64; 3]| Solid::filling(kind, sides).unwrap();
    let near = |x: f64, y: f64| (x - y).abs() <= 4.0 * f64::EPSILON;
    let (width, height) = (1.2, 1.6);
    let about_e3 = [width, width, height];
    assert!(matches!(filling("box", [1.0, 2.0, 3.0]), Solid::Box { lengths: [1.0, 2.0, 3.0] }));
    assert!(matches!(filling("ellipsoid", [1.0, 2.0, 3.0]), Solid::Ellipsoid { semi_axes: [0.5, 1.0, 1.5] }));
    for kind in ["sphere", "hollow_sphere"] {
        let (outer, inner) = match filling(kind, [width; 3]) {
            Solid::Sphere { radius } => (radius, 0.0),
            Solid::HollowSphere { outer_radius, inner_radius } => (outer_radius, inner_radius),
            other => panic!("{other:?}"),
        };
        assert!(near(2.0 * outer, width) && inner < outer && (inner > 0.0) == (kind == "hollow_sphere"));
    }
    for kind in ["cylinder", "cone", "capsule"] {
        let (radius, length) = match filling(kind, about_e3) {
            Solid::Cylinder { radius, height } | Solid::Cone { radius, height } => (radius, height),
            Solid::Capsule { radius, height } => (radius, height + 2.0 * radius),
            other => panic!("{other:?}"),
        };
        assert!(near(2.0 * radius, width) && near(length, height), "{kind}");
    }
    // A capsule in a flat box is nearly a sphere, and a torus in a high one keeps its hole.
    assert!(matches!(filling("capsule", [width, width, 0.1]), Solid::Capsule { height, .. } if height > 0.0));
    for height in [0.2, 10.0] {
        let Solid::Torus { major_radius, minor_radius } = filling("torus", [width, width, height]) else {
            panic!("a torus")
        };
        assert!(near(2.0 * (major_radius + minor_radius), width));
        assert!(2.0 * minor_radius <= height && major_radius > minor_radius);
    }
    assert!(matches!(filling("rod", [1.0, 3.0, 2.0]), Solid::Rod { length: 3.0 }));
    assert!(Solid::filling("cube", about_e3).is_none());
}
