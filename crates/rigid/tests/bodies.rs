//! The inertia map against its definition `I(B) = ∫ρ x∧(x·B)`, valid moments, and the composition of bodies.

use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::{Amount, Body, BodyError, Inertia, Solid};
use proptest::prelude::*;
use std::array::from_fn;

const EPS: f64 = f64::EPSILON;

fn largest(m: [[f64; 3]; 3]) -> f64 {
    m.iter().flatten().fold(0.0, |l: f64, x| l.max(x.abs()))
}

/// Equal up to `ulps` roundings of the largest entry.
fn assert_close(a: [[f64; 3]; 3], b: [[f64; 3]; 3], ulps: f64) {
    let tolerance = ulps * EPS * largest(b);
    let close = (0..3).all(|i| (0..3).all(|j| (a[i][j] - b[i][j]).abs() <= tolerance));
    assert!(close, "{a:?}\n{b:?}");
}

fn axis(k: usize) -> Vector {
    Vector(from_fn(|i| if i == k { 1.0 } else { 0.0 }))
}

fn vector() -> impl Strategy<Value = Vector> {
    prop::array::uniform3(-3.0..3.0_f64).prop_map(Vector)
}

fn rotor() -> impl Strategy<Value = Rotor> {
    vector().prop_map(|v| Rotor::from_rotation_vector(v).unwrap())
}

/// Moments of six point masses in a general position, hence of a possible body.
fn points() -> impl Strategy<Value = (Vec<f64>, Vec<Vector>)> {
    (prop::collection::vec(0.1..2.0_f64, 6), prop::collection::vec(vector(), 6))
}

proptest! {
    #[test]
    fn second_moments_are_those_given(given in prop::array::uniform3(0.1..3.0_f64), axes in rotor()) {
        let tolerance = 16.0 * EPS * largest([given; 3]);
        let (found, frame) = Inertia::from_second_moments(given, Rotor::IDENTITY).unwrap().second_moments();
        prop_assert_eq!(frame, None, "the body axes are principal");
        prop_assert!((0..3).all(|k| (found[k] - given[k]).abs() <= tolerance), "{found:?} {given:?}");

        let turned = Inertia::from_second_moments(given, axes).unwrap();
        let (found, frame) = turned.second_moments();
        let again = Inertia::from_second_moments(found, frame.unwrap()).unwrap();
        assert_close(again.matrix(), turned.matrix(), 64.0);
        let ordered = |mut moments: [f64; 3]| { moments.sort_by(f64::total_cmp); moments };
        let (found, given) = (ordered(found), ordered(given));
        prop_assert!((0..3).all(|k| (found[k] - given[k]).abs() <= 4.0 * tolerance), "{found:?} {given:?}");
    }

    #[test]
    fn points_follow_the_definition((masses, positions) in points(), b in vector()) {
        let body = Body::from_points(&masses, &positions).unwrap();
        let b = b.undual();
        let mut expected = Bivector::default();
        for (&m, &x) in masses.iter().zip(&positions) {
            let x = x - body.center_of_mass;
            expected += x.wedge(x.dot_bivector(b)) * m;
        }
        let error = (body.inertia.apply(b) - expected).norm();
        prop_assert!(error <= 32.0 * EPS * largest(body.inertia.matrix()) * b.norm());
        prop_assert_eq!(Inertia::from_points(&masses, &positions).unwrap(), body.inertia);
    }

    #[test]
    fn principal_frame_diagonalises((masses, positions) in points()) {
        let inertia = Inertia::from_points(&masses, &positions).unwrap();
        let (frame, moments) = (inertia.principal_frame(), inertia.principal_moments());
        let norm: f64 = frame.components().iter().map(|x| x * x).sum();
        prop_assert!((norm - 1.0).abs() <= 4.0 * EPS);
        prop_assert!(moments[0] <= moments[1] && moments[1] <= moments[2]);
        for k in 0..3 {
            let plane = frame.apply_bivector(axis(k).undual());
            let error = (inertia.apply(plane) - plane * moments[k]).norm();
            prop_assert!(error <= 64.0 * EPS * moments[2]);
        }
    }

    /// Of the four frames that differ by half turns, the one with the largest scalar part.
    #[test]
    fn principal_frame_is_the_nearest((masses, positions) in points()) {
        let frame = Inertia::from_points(&masses, &positions).unwrap().principal_frame();
        let [s, x, y, z] = frame.components();
        prop_assert!(s >= x.abs().max(y.abs()).max(z.abs()) * (1.0 - 16.0 * EPS));
    }

    #[test]
    fn inverse_undoes_apply((masses, positions) in points(), b in vector()) {
        let inertia = Inertia::from_points(&masses, &positions).unwrap();
        let b = b.undual();
        let [least, _, greatest] = inertia.principal_moments();
        let error = (inertia.inverse(inertia.apply(b)).unwrap() - b).norm();
        prop_assert!(error <= 64.0 * EPS * b.norm() * greatest / least);
    }

    /// `I'(B) = R I(~R B R) ~R`, with the moments kept and the frame turned.
    #[test]
    fn rotated_inertia_turns_with_the_body((masses, positions) in points(), r in rotor(), b in vector()) {
        let inertia = Inertia::from_points(&masses, &positions).unwrap();
        let turned = inertia.rotated(r);
        let b = b.undual();
        let expected = r.apply_bivector(inertia.apply(r.reverse().apply_bivector(b)));
        let scale = largest(inertia.matrix()) * b.norm();
        prop_assert!((turned.apply(b) - expected).norm() <= 64.0 * EPS * scale);
        prop_assert_eq!(turned.principal_moments(), inertia.principal_moments());
        let plane = turned.principal_frame().apply_bivector(axis(0).undual());
        let error = (turned.apply(plane) - plane * turned.principal_moments()[0]).norm();
        prop_assert!(error <= 64.0 * EPS * largest(inertia.matrix()));
    }

    /// Two parts of a cloud, moved alike, combine to the moved whole.
    #[test]
    fn parts_make_the_whole((masses, positions) in points(), r in rotor(), x in vector()) {
        let body = |range: std::ops::Range<usize>| {
            Body::from_points(&masses[range.clone()], &positions[range]).unwrap().moved(r, x).unwrap()
        };
        let (joined, whole) = (body(0..2).combine(&body(2..6)).unwrap(), body(0..6));
        prop_assert!((joined.mass - whole.mass).abs() <= 4.0 * EPS * whole.mass);
        prop_assert!((joined.center_of_mass - whole.center_of_mass).norm() <= 64.0 * EPS);
        // Distances of up to 10 between the parts are rounded, against moments of a few.
        let difference: [[f64; 3]; 3] =
            from_fn(|i| from_fn(|j| joined.inertia.matrix()[i][j] - whole.inertia.matrix()[i][j]));
        let size = whole.mass * 27.0;
        prop_assert!(largest(difference) <= 64.0 * EPS * size);
    }

    /// About a point P, `Σ m (x − P)∧((x − P)·B)`.
    #[test]
    fn parallel_axes((masses, positions) in points(), p in vector(), b in vector()) {
        let body = Body::from_points(&masses, &positions).unwrap();
        let b = b.undual();
        let mut expected = Bivector::default();
        for (&m, &x) in masses.iter().zip(&positions) {
            expected += (x - p).wedge((x - p).dot_bivector(b)) * m;
        }
        let about = body.inertia_about(p).unwrap();
        prop_assert!((about.apply(b) - expected).norm() <= 64.0 * EPS * largest(about.matrix()) * b.norm());
    }

    /// About a point P, `Σ m g (x − P)`; no other direction is a weight moment about P.
    #[test]
    fn weights_of_points((masses, positions) in points(), p in vector(), g in 0.1..20.0_f64) {
        let body = Body::from_points(&masses, &positions).unwrap();
        let mut expected = Vector::default();
        for (&m, &x) in masses.iter().zip(&positions) {
            expected += (x - p) * (m * g);
        }
        let c = body.weight_moment(g, p);
        let size = body.mass * g * 6.0 * 3.0_f64.sqrt();
        prop_assert!((c - expected).norm() <= 64.0 * EPS * size);
        let held = body.moved(Rotor::IDENTITY, -p).unwrap();
        let turned = |angle: f64| {
            let aside = c.wedge(axis((0..3).min_by(|&i, &j| c.0[i].abs().total_cmp(&c.0[j].abs())).unwrap()));
            Rotor::from_plane_angle(aside, angle).unwrap().apply(c)
        };
        prop_assume!(c.norm() > 1e-3 * size);
        prop_assert!(held.has_weight_moment(c) && held.has_weight_moment(turned(1e-7)));
        prop_assert!(!held.has_weight_moment(-c) && !held.has_weight_moment(turned(1e-5)));
        prop_assert!(held.has_weight_moment(Vector::default()));
        // A centre of mass at the fixed point up to rounding has no such weight moment.
        let centered = Body { center_of_mass: held.center_of_mass * 1e-16, ..held };
        prop_assert!(!centered.has_weight_moment(c) && centered.has_weight_moment(c * 1e-16));
    }

    /// A rigid set of points in a plane is a valid body however it is turned, with i1 + i2 = i3.
    #[test]
    fn flat_bodies_are_valid(r in rotor(), angles in prop::collection::vec(0.0..6.3_f64, 3..9)) {
        let positions: Vec<Vector> =
            angles.iter().zip(1..).map(|(a, k)| r.apply(Vector([a.cos(), a.sin(), 0.0]) * f64::from(k))).collect();
        let inertia = Inertia::from_points(&vec![0.7; positions.len()], &positions).unwrap();
        let [a, b, c] = inertia.principal_moments();
        prop_assert!((a + b - c).abs() <= 64.0 * EPS * c);
        prop_assert!(Inertia::from_principal_moments([a, b, c]).is_ok());
    }

    /// A rod has exactly zero moment about its axis in any direction.
    #[test]
    fn rods_are_singular_in_any_direction(r in rotor(), length in 0.1..10.0_f64) {
        let rod = Solid::Rod { length }.body(Amount::Mass(1.0)).unwrap();
        let matrix = rod.inertia.rotated(r).matrix();
        let inertia = Inertia::from_matrix(matrix).unwrap();
        prop_assert_eq!(inertia.principal_moments()[0], 0.0);
        let direction = r.apply(axis(2));
        match inertia.inverse(Bivector([1.0, 0.0, 0.0])) {
            Err(BodyError::Singular { number: 1, axis }) => {
                prop_assert!(axis.wedge(direction).norm() <= 32.0 * EPS);
            }
            other => prop_assert!(false, "{other:?}"),
        }
    }
}

proptest! {
    /// Any numbers give a valid body or an error.
    #[test]
    fn any_numbers_give_a_body_or_an_error(
        m in prop::array::uniform3(prop::array::uniform3(prop::num::f64::ANY)),
        masses in prop::collection::vec(prop::num::f64::POSITIVE, 3),
    ) {
        let possible = |i: &Inertia| i.principal_moments().iter().all(|x| *x >= 0.0 && x.is_finite());
        let [a, b, c] = m;
        let symmetric = [[a[0], a[1], a[2]], [a[1], b[1], b[2]], [a[2], b[2], c[2]]];
        let inertias = [
            Inertia::from_matrix(m),
            Inertia::from_matrix(symmetric),
            Inertia::from_principal_moments(a),
            Inertia::from_points(&masses, &m.map(Vector)),
            Solid::Box { lengths: b.map(f64::abs) }.body(Amount::Density(c[0].abs())).map(|body| body.inertia),
        ];
        for inertia in inertias {
            match inertia {
                Ok(inertia) => prop_assert!(possible(&inertia), "{inertia:?}"),
                Err(e) => prop_assert!(!e.to_string().is_empty()),
            }
        }
    }
}

#[test]
fn possible_moments_are_accepted_in_their_order() {
    for moments in [
        [1.0, 2.0, 3.0],
        [1.0, 1000.0, 1000.5],
        [2.0, 1.0, 2.0],
        [1.0, 1.0, 0.25],
        [0.0, 1.0, 1.0],
        [0.0, 0.0, 0.0],
        // A flat plate, i1 + i2 = i3 but for rounding: 0.1 + 0.2 is not 0.3.
        [0.1, 0.2, 0.1 + 0.2],
        [0.3, 0.1, 0.2],
        [0.1 * 0.1 / 12.0, 0.7 * 0.7 / 12.0, (0.1 * 0.1 + 0.7 * 0.7) / 12.0],
    ] {
        let inertia = Inertia::from_principal_moments(moments).unwrap();
        assert_eq!(inertia.principal_moments(), moments);
        assert_eq!(inertia.principal_frame(), Rotor::IDENTITY);
        let [a, b, c] = moments;
        assert_eq!(inertia.matrix(), [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]);
    }
}

#[test]
fn a_diagonal_matrix_keeps_its_axes() {
    let diagonal = |[a, b, c]: [f64; 3]| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
    let ascending = Inertia::from_matrix(diagonal([1.0, 2.0, 3.0])).unwrap();
    assert_eq!(ascending, Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap());
    let inertia = Inertia::from_matrix(diagonal([3.0, 1.0, 2.5])).unwrap();
    assert_eq!(inertia.principal_moments(), [1.0, 2.5, 3.0]);
    // e1 → e2 → e3 → e1: a third of a turn about (1, 1, 1), all components one half.
    assert_eq!(inertia.principal_frame().components(), [0.5, -0.5, -0.5, -0.5]);
    assert_eq!(inertia.apply(Bivector([1.0, 1.0, 1.0])), Bivector([3.0, 1.0, 2.5]));
}

/// Two half boxes beside each other are the box, and so are two bodies the other way round.
#[test]
fn two_half_boxes_are_a_box() {
    let half = Solid::Box { lengths: [1.0, 3.0, 0.5] }.body(Amount::Density(2.0)).unwrap();
    let [left, right] = [-0.5, 0.5].map(|x| half.moved(Rotor::IDENTITY, Vector([x, 0.0, 0.0])).unwrap());
    let whole = Solid::Box { lengths: [2.0, 3.0, 0.5] }.body(Amount::Density(2.0)).unwrap();
    for joined in [left.combine(&right).unwrap(), right.combine(&left).unwrap()] {
        assert_eq!((joined.mass, joined.center_of_mass), (whole.mass, whole.center_of_mass));
        assert_close(joined.inertia.matrix(), whole.inertia.matrix(), 4.0);
    }
}

/// A speck far away moves the common centre of mass a little, in either order.
#[test]
fn a_light_body_far_away_keeps_the_digits_of_a_heavy_one() {
    let body = |mass, x| {
        let inertia = Inertia::from_principal_moments([mass; 3]).unwrap();
        Body::new(mass, inertia, Vector([x, 0.0, 0.0])).unwrap()
    };
    let (light, heavy) = (body(1.0, 1e10), body(1e20, 1e-3));
    let (one, other) = (light.combine(&heavy).unwrap(), heavy.combine(&light).unwrap());
    assert_eq!(one, other);
    let expected = 1e-3 + 1e-10;
    assert!((one.center_of_mass.0[0] - expected).abs() <= EPS * expected, "{:?}", one.center_of_mass);
}

/// Points far from the origin lose no digits: their distances are exact.
#[test]
fn far_away_points_keep_their_digits() {
    let near = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [4.0, -1.0, 0.5], [2.0, 2.0, -6.0]].map(Vector);
    let shift = Vector([2.0_f64.powi(40), -(2.0_f64.powi(41)), 2.0_f64.powi(39)]);
    let masses = [1.0, 2.0, 3.0, 4.0];
    let inertia = |points: [Vector; 4]| Inertia::from_points(&masses, &points).unwrap();
    assert_eq!(inertia(near.map(|x| x + shift)), inertia(near));
}

#[test]
fn errors_of_impossible_inertias() {
    let moments = |m| Inertia::from_principal_moments(m).unwrap_err().to_string();
    assert_eq!(
        moments([1.0, 1.0, 3.0]),
        "no body has the principal moments 1.0, 1.0, 3.0: i3 = 3.0 exceeds i1 + i2 = 2.0; \
         check the units and the point they refer to (the centre of mass)"
    );
    assert!(moments([5.0, 1.0, 3.0]).contains("i1 = 5.0 exceeds i2 + i3 = 4.0"));
    assert!(moments([1.0, 5.0, 3.0]).contains("i2 = 5.0 exceeds i1 + i3 = 4.0"));
    assert!(moments([0.0, 1.0, 1.0 + 1e-12]).contains("i3 = 1.000000000001 exceeds"));
    assert_eq!(
        moments([1.0, -1.0, 1.0]),
        "no body has the principal moments 1.0, -1.0, 1.0: i2 is negative; moments are integrals of squares, check the signs"
    );
    assert_eq!(moments([1.0, 1.0, f64::NAN]), "the moment i3 is NaN; give a finite number");
    assert_eq!(moments([f64::INFINITY, 1.0, 1.0]), "the moment i1 is inf; give a finite number");

    let matrix = |m| Inertia::from_matrix(m).unwrap_err().to_string();
    assert_eq!(
        matrix([[2.0, 0.1, 0.0], [0.1, 2.0, 0.3], [0.0, 0.2, 2.0]]),
        "the inertia matrix is not symmetric: row 2, column 3 is 0.3 but row 3, column 2 is 0.2; make them equal"
    );
    assert_eq!(
        matrix([[2.0, 0.1, 0.0], [0.1, f64::NAN, 0.3], [0.0, 0.2, 2.0]]),
        "the inertia matrix's entry in row 2, column 2 is NaN; give a finite number"
    );
    // Eigenvalues −1, 1, 1.
    assert!(matrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).contains("i1 is negative"));
    assert!(matrix([[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]]).contains("exceeds i1 + i2 = 2.0"));

    let rod = Inertia::from_principal_moments([1.0, 0.0, 1.0]).unwrap();
    assert_eq!(
        rod.inverse(Bivector([1.0, 0.0, 0.0])).unwrap_err().to_string(),
        "the inertia has no inverse: the moment i2 about the axis (0.0, 1.0, 0.0) is zero, as for a thin rod; give the body a thickness"
    );
}

#[test]
fn rounding_is_not_asymmetry() {
    let m = [[2.0, 0.1, 0.0], [0.1 + EPS, 2.0, 0.3], [0.0, 0.3 - EPS, 2.0]];
    let matrix = Inertia::from_matrix(m).unwrap().matrix();
    assert_eq!(matrix[0][1], matrix[1][0]);
    assert_eq!(matrix[1][2], matrix[2][1]);
}

#[test]
fn errors_of_impossible_bodies() {
    let inertia = Inertia::from_principal_moments([1.0; 3]).unwrap();
    let body = |mass, x| Body::new(mass, inertia, Vector([0.0, x, 0.0])).unwrap_err().to_string();
    assert_eq!(body(0.0, 0.0), "mass must be positive and finite, got 0.0 kg");
    assert_eq!(body(-1.0, 0.0), "mass must be positive and finite, got -1.0 kg");
    assert_eq!(body(f64::NAN, 0.0), "mass must be positive and finite, got NaN kg");
    assert_eq!(body(1.0, f64::INFINITY), "the centre of mass's component e2 is inf; give a finite number");

    let points = |m: &[f64], x: &[Vector]| Body::from_points(m, x).unwrap_err().to_string();
    let origin = Vector::default();
    assert_eq!(points(&[], &[]), "a body needs at least one point mass, got none");
    assert_eq!(
        points(&[1.0], &[origin, origin]),
        "1 masses for 2 positions; give one mass for every position"
    );
    assert_eq!(points(&[1.0, -2.0], &[origin, origin]), "masses[1] must be finite and >= 0, got -2.0 kg");
    assert_eq!(
        points(&[1.0, 2.0], &[origin, Vector([0.0, f64::NAN, 1.0])]),
        "positions[1] = (0.0, NaN, 1.0) is not finite; remove the point"
    );
    assert_eq!(points(&[0.0], &[origin]), "mass must be positive and finite, got 0.0 kg");
}

/// A point has no moments, whatever is beside it without mass; masses apart have some, unless these underflow.
#[test]
fn masses_at_one_place_are_a_point() {
    let (at, beside) = (Vector([3.0, 0.0, 0.0]), Vector([1.0, 0.0, 0.0]));
    for (masses, positions) in
        [(vec![2.0], vec![at]), (vec![0.5, 1.5], vec![at, at]), (vec![0.0, 2.0], vec![beside, at])]
    {
        let body = Body::from_points(&masses, &positions).unwrap();
        assert_eq!((body.mass, body.center_of_mass), (2.0, at));
        assert_eq!(body.inertia.principal_moments(), [0.0; 3]);
    }
    let near = [Vector::default(), Vector([1e-200, 0.0, 0.0])];
    assert!(matches!(Body::from_points(&[1.0, 1.0], &near), Err(BodyError::TooSmall { .. })));
}
