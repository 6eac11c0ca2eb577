//! Integrals over meshes: exact for polyhedra, covariant, accurate far from the origin.

use polhode_ga::{Rotor, Vector};
use polhode_rigid::{Amount, Body, Solid, TriangleMesh};
use proptest::prelude::*;

const EPS: f64 = f64::EPSILON;

/// The twelve triangles of a box from `low` to `high`, outward.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    let corner = |k: usize| Vector([0, 1, 2].map(|i| if k >> i & 1 == 1 { high[i] } else { low[i] }));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), faces).unwrap()
}

fn assert_same(a: &Body, b: &Body, ulps: f64) {
    let scale = b.inertia.principal_moments()[0].max(b.inertia.principal_moments()[2]);
    assert!((a.mass - b.mass).abs() <= ulps * EPS * b.mass, "{a:?}\n{b:?}");
    let size = (scale / b.mass).sqrt() + b.center_of_mass.norm();
    assert!((a.center_of_mass - b.center_of_mass).norm() <= ulps * EPS * size, "{a:?}\n{b:?}");
    for i in 0..3 {
        for j in 0..3 {
            let difference = a.inertia.matrix()[i][j] - b.inertia.matrix()[i][j];
            assert!(difference.abs() <= ulps * EPS * scale, "{a:?}\n{b:?}");
        }
    }
}

#[test]
fn box_is_exact() {
    let mesh = cuboid([-0.5, -1.0, -1.5], [0.5, 1.0, 1.5]);
    assert_eq!(mesh.volume(), 6.0);
    for amount in [Amount::Mass(5.0), Amount::Density(0.3)] {
        let solid = Solid::Box { lengths: [1.0, 2.0, 3.0] }.body(amount).unwrap();
        let body = mesh.body(amount).unwrap();
        assert_same(&body, &solid, 4.0);
        // The box's moments descend, a mesh's ascend.
        let [c, b, a] = solid.inertia.principal_moments();
        let close = |(x, y): (f64, f64)| (x - y).abs() <= 4.0 * EPS * c;
        assert!(body.inertia.principal_moments().into_iter().zip([a, b, c]).all(close));
    }
}

/// The corner tetrahedron: V = 1/6, centre (¼, ¼, ¼), and about it `∫x xᵀ = V (3 or −1)/80`.
#[test]
fn tetrahedron_is_exact() {
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector).to_vec();
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = TriangleMesh::new(vertices, faces).unwrap();
    let body = mesh.body(Amount::Mass(80.0)).unwrap();
    assert!((mesh.volume() * 6.0 - 1.0).abs() <= EPS);
    assert!((body.center_of_mass - Vector([0.25; 3])).norm() <= EPS);
    for i in 0..3 {
        for j in 0..3 {
            let expected = if i == j { 6.0 } else { 1.0 };
            assert!((body.inertia.matrix()[i][j] - expected).abs() <= 16.0 * EPS);
        }
    }
    let moments = body.inertia.principal_moments();
    assert!((0..3).all(|k| (moments[k] - [5.0, 5.0, 8.0][k]).abs() <= 32.0 * EPS), "{moments:?}");
}

/// A box of a few metres at coordinates of 2⁴⁰: differences are exact. (The second moment about the origin would be 2⁸⁰
/// times as large and lose all digits.)
#[test]
fn far_away_boxes_keep_their_digits() {
    let far = [2.0_f64.powi(40), -(2.0_f64.powi(41)), 2.0_f64.powi(39)];
    let high = [far[0] + 1.0, far[1] + 2.0, far[2] + 3.0];
    let body = cuboid(far, high).body(Amount::Density(1.0)).unwrap();
    let near = cuboid([0.0; 3], [1.0, 2.0, 3.0]).body(Amount::Density(1.0)).unwrap();
    assert_eq!((body.mass, body.inertia), (near.mass, near.inertia));
}

/// Unused vertices are ignored.
#[test]
fn stray_vertices_do_not_count() {
    let mesh = cuboid([0.0; 3], [1.0, 2.0, 3.0]);
    let mut vertices = mesh.vertices().to_vec();
    vertices.push(Vector([1e200, 0.0, -1e300]));
    let stray = TriangleMesh::new(vertices, mesh.faces().to_vec()).unwrap();
    assert_eq!(stray.body(Amount::Mass(1.0)), mesh.body(Amount::Mass(1.0)));
}

#[test]
fn thin_plates_and_needles_are_valid() {
    for lengths in [[1.0, 1.0, 1e-12], [1e-9, 1e-9, 1.0], [1e-30, 1e-30, 2e-30]] {
        let mesh = cuboid([0.0; 3], lengths);
        let solid = Solid::Box { lengths }.body(Amount::Density(3.0)).unwrap();
        let center = Vector(lengths) * 0.5;
        assert_same(
            &mesh.body(Amount::Density(3.0)).unwrap(),
            &solid.moved(Rotor::IDENTITY, center).unwrap(),
            8.0,
        );
    }
}

/// A cavity is a shell wound the other way: the box less its inside.
#[test]
fn cavities_are_taken_out() {
    let (outer, inner) = (cuboid([0.0; 3], [4.0, 4.0, 4.0]), cuboid([1.0; 3], [2.0, 2.0, 3.0]));
    let vertices = [outer.vertices(), inner.vertices()].concat();
    let reversed = inner.faces().iter().map(|&[a, b, c]| [a + 8, c + 8, b + 8]);
    let faces = outer.faces().iter().copied().chain(reversed).collect();
    let hollow = TriangleMesh::new(vertices, faces).unwrap().body(Amount::Density(1.0)).unwrap();
    assert_eq!(hollow.mass, 62.0);
    let [whole, filling] = [&outer, &inner].map(|m| m.body(Amount::Density(1.0)).unwrap());
    assert_same(&hollow.combine(&filling).unwrap(), &whole, 16.0);
}

/// Two boxes that share an edge have four triangles at it, two each way.
#[test]
fn bodies_may_touch_along_an_edge() {
    let (a, b) = (cuboid([0.0; 3], [1.0; 3]), cuboid([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]));
    let vertices = [a.vertices(), b.vertices()].concat();
    let faces = a.faces().iter().copied().chain(b.faces().iter().map(|f| f.map(|i| i + 8))).collect();
    let both = TriangleMesh::new(vertices, faces).unwrap().body(Amount::Density(1.0)).unwrap();
    let [a, b] = [a, b].map(|m| m.body(Amount::Density(1.0)).unwrap());
    assert_same(&both, &a.combine(&b).unwrap(), 16.0);
}

#[test]
fn scaling_by_the_unit() {
    let millimetres = cuboid([0.0; 3], [1000.0, 2000.0, 3000.0]);
    let metres = cuboid([0.0; 3], [1.0, 2.0, 3.0]);
    let [a, b] = [millimetres.scaled(0.001).unwrap(), metres].map(|m| m.body(Amount::Density(2.0)).unwrap());
    assert_same(&a, &b, 16.0);
}

/// An octahedron with its corners pulled about: not convex in general, closed always.
fn dented() -> impl Strategy<Value = TriangleMesh> {
    prop::collection::vec(prop::array::uniform3(-0.2..0.2_f64), 6).prop_map(|dents| {
        let corners = [
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ];
        let vertices = corners.iter().zip(dents).map(|(&c, d)| Vector(c) + Vector(d)).collect();
        let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        TriangleMesh::new(vertices, faces.to_vec()).unwrap()
    })
}

proptest! {
    /// The body of the moved mesh is the moved body. The moved vertices are rounded at their distance.
    #[test]
    fn meshes_move_like_bodies(
        mesh in dented(),
        axis in prop::array::uniform3(-3.0..3.0_f64),
        shift in prop::array::uniform3(-1e3..1e3_f64),
    ) {
        let (r, shift) = (Rotor::from_rotation_vector(Vector(axis)).unwrap(), Vector(shift));
        let vertices = mesh.vertices().iter().map(|&x| r.apply(x) + shift).collect();
        let moved = TriangleMesh::new(vertices, mesh.faces().to_vec()).unwrap();
        let body = moved.body(Amount::Density(1.0)).unwrap();
        let expected = mesh.body(Amount::Density(1.0)).unwrap().moved(r, shift).unwrap();
        let ulps = 16.0 * (1.0 + shift.norm());
        prop_assert!((body.mass - expected.mass).abs() <= ulps * EPS * expected.mass);
        prop_assert!((body.center_of_mass - expected.center_of_mass).norm() <= ulps * EPS);
        for i in 0..3 {
            for j in 0..3 {
                let difference = body.inertia.matrix()[i][j] - expected.inertia.matrix()[i][j];
                prop_assert!(difference.abs() <= ulps * EPS, "{difference}");
            }
        }
    }
}

/// The grid of a torus, a million triangles: hash maps and sorting, nothing quadratic.
#[test]
fn a_million_triangles() {
    let (rings, segments) = (1000_usize, 500_usize);
    let vertex = |k: usize| {
        let angle = |i: usize, n: usize| std::f64::consts::TAU * i as f64 / n as f64;
        let (u, v) = (angle(k / segments, rings), angle(k % segments, segments));
        let r = 2.0 + v.cos();
        Vector([r * u.cos(), r * u.sin(), v.sin()])
    };
    let index = |i: usize, j: usize| (i % rings * segments + j % segments) as u32;
    let faces = (0..rings * segments).flat_map(|k| {
        let (i, j) = (k / segments, k % segments);
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let mesh = TriangleMesh::new((0..rings * segments).map(vertex).collect(), faces.collect()).unwrap();
    let body = mesh.body(Amount::Density(1.0)).unwrap();
    let torus = Solid::Torus { major_radius: 2.0, minor_radius: 1.0 }.body(Amount::Density(1.0)).unwrap();
    let deviation = body.inertia.matrix()[2][2] / torus.inertia.matrix()[2][2] - 1.0;
    // Second order in the steps: a few times (2π/500)² / 12.
    assert!(deviation < 0.0 && deviation > -1e-4, "{deviation}");
}
