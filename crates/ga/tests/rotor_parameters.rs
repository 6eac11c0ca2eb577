//! Rotors from and to quaternions, matrices, rotation vectors and Euler angles, at the limits of each.

use polhode_ga::g3::attitude::EulerSequence;
use polhode_ga::{Bivector, MathError, Multivector, Rotor, Vector};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

const EPS: f64 = f64::EPSILON;

fn axis(k: usize) -> Vector {
    let mut axis = Vector::default();
    axis.0[k % 3] = 1.0;
    axis
}

fn difference(r: Rotor, s: Rotor) -> f64 {
    (Multivector::from(r) - Multivector::from(s)).norm()
}

/// The distance of the turns: `R` and `−R` turn alike.
fn distance(r: Rotor, s: Rotor) -> f64 {
    difference(r, s).min(difference(r, -s))
}

/// The angles of `R = ±exp(−½α e1e2) exp(−½β e2e3) exp(−½γ e1e2)`.
fn zxz_angles(r: Rotor) -> [f64; 3] {
    EulerSequence::ZXZ.angles(r).expect("there are three axes")
}

fn rotor() -> impl Strategy<Value = Rotor> {
    prop::array::uniform4(-1.0..1.0f64).prop_filter_map("zero", |c| Rotor::from_components(c).ok())
}

fn vector() -> impl Strategy<Value = Vector> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(Vector).prop_filter("zero", |v| v.norm() > 1e-3)
}

#[test]
fn quaternion_units_multiply_as_hamiltons_and_turn_in_the_positive_sense() {
    let unit = |k: usize| {
        let mut q = [0.0; 4];
        q[1 + k % 3] = 1.0;
        Rotor::from_quaternion_wxyz(q).unwrap()
    };
    for k in 0..3 {
        assert_eq!(unit(k) * unit(k + 1), unit(k + 2), "ij = k and its cycles");
        assert_eq!(unit(k) * unit(k), -Rotor::IDENTITY);
        let (half, mut quarter) = (0.5f64.sqrt(), [0.0; 4]);
        (quarter[0], quarter[1 + k]) = (half, half);
        let turned = Rotor::from_quaternion_wxyz(quarter).unwrap().apply(axis(k + 1));
        assert!((turned - axis(k + 2)).norm() <= 4.0 * EPS, "a quarter turn about {k}: {turned:?}");
    }
}

/// The trace is −1 there, so that the scalar part cannot be the one that the others are divided by. The two rotors of a half
/// turn differ by its sense; the positive one is taken.
#[test]
fn half_turns_about_each_axis_come_back_from_their_matrices() {
    for k in 0..3 {
        let turn = Rotor::from_rotation_vector(axis(k) * PI).unwrap();
        let mut matrix = [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        matrix[k][k] = 1.0;
        assert!(difference(Rotor::from_matrix(matrix).unwrap(), turn) <= 2.0 * EPS, "{k}");
    }
}

#[test]
fn a_matrix_that_is_not_a_rotation_is_rejected() {
    let scaled = |x: f64| [[x, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(Rotor::from_matrix(scaled(-1.0)), Err(MathError::Reflection));
    assert_eq!(Rotor::from_matrix(scaled(f64::NAN)), Err(MathError::NotFinite));
    let Err(MathError::NotOrthogonal { deviation }) = Rotor::from_matrix(scaled(2.0)) else {
        panic!("accepted")
    };
    assert_eq!(deviation, 3.0, "|2² − 1|");
}

#[test]
fn values_without_a_direction_are_rejected() {
    let (zero, x) = (Vector::default(), axis(0));
    for none in [zero, Vector([f64::NAN, 1.0, 0.0]), Vector([f64::INFINITY, 1.0, 0.0])] {
        assert_eq!(Rotor::from_vectors(none, x), Err(MathError::NoDirection));
        assert_eq!(Rotor::from_vectors(x, none), Err(MathError::NoDirection));
        assert_eq!(Rotor::from_plane_angle(none.undual(), 1.0), Err(MathError::NoPlane));
    }
    assert_eq!(Rotor::from_plane_angle(x.undual(), f64::NAN), Err(MathError::NotFinite));
    assert_eq!(Rotor::from_rotation_vector(Vector([0.0, f64::INFINITY, 0.0])), Err(MathError::NotFinite));
    assert_eq!(Rotor::from_components([0.0; 4]), Err(MathError::ZeroRotor));
    assert_eq!(Rotor::from_components([f64::NAN, 1.0, 0.0, 0.0]), Err(MathError::NotFinite));
}

/// Three and four of the smallest subnormal number are to each other as 0.6 to 0.8 to 1.
#[test]
fn sizes_of_components_do_not_matter() {
    for size in [f64::from_bits(1), 1e-310, 1e-200, 1.0, 1e200, 4e307] {
        let [s, x, y, z] = Rotor::from_components([3.0 * size, 0.0, -4.0 * size, 0.0]).unwrap().components();
        // 1e-310 is itself rounded, to 2⁻⁴⁴ of it.
        let rounded = if size == 1e-310 { 2f64.powi(-44) } else { EPS };
        assert!(
            (s - 0.6).abs() <= rounded && (y + 0.8).abs() <= rounded && x == 0.0 && z == 0.0,
            "{size}: {s} {y}"
        );
    }
}

/// With β = 0 only α + γ is determined; with β = π only α − γ.
#[test]
fn euler_angles_at_the_poles_are_one_turn_about_e3() {
    let turn = |plane: [f64; 3], angle: f64| Rotor::exp(Bivector(plane) * (-0.5 * angle));
    for angle in [-3.0, -1.0, 0.0, 0.5, 2.0, 3.0] {
        let [alpha, beta, gamma] = zxz_angles(turn([0.0, 0.0, 1.0], angle));
        assert!((alpha - angle).abs() <= 4.0 * EPS && beta == 0.0 && gamma == 0.0, "{alpha} {beta} {gamma}");
        let over = turn([0.0, 0.0, 1.0], angle) * turn([1.0, 0.0, 0.0], PI);
        let [alpha, beta, gamma] = zxz_angles(over);
        assert!((beta - PI).abs() <= 4.0 * EPS);
        let back = turn([0.0, 0.0, 1.0], alpha - gamma) * turn([1.0, 0.0, 0.0], PI);
        assert!(distance(back, over) <= 8.0 * EPS);
    }
    // The line of nodes along e2 and e1: one component of the tilt is zero.
    for (plane, nodes) in [([0.0, 1.0, 0.0], FRAC_PI_2), ([1.0, 0.0, 0.0], 0.0)] {
        let [alpha, beta, gamma] = zxz_angles(turn(plane, 1.0));
        assert!((alpha - nodes).abs() + (beta - 1.0).abs() + (gamma + nodes).abs() <= 8.0 * EPS);
    }
}

proptest! {
    /// Each angle rounds to half an ulp of at most π, and three turns are multiplied.
    #[test]
    fn euler_angles_give_the_turn_back(r in rotor()) {
        let [alpha, beta, gamma] = zxz_angles(r);
        prop_assert!(alpha.abs() <= PI && gamma.abs() <= PI && (0.0..=PI).contains(&beta));
        let turn = |plane: [f64; 3], angle: f64| Rotor::exp(Bivector(plane) * (-0.5 * angle));
        let (z, x) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        prop_assert!(distance(turn(z, alpha) * turn(x, beta) * turn(z, gamma), r) <= 16.0 * EPS);
    }

    /// By Rodrigues' formula a turn by θ leaves its axis, and takes `p` perpendicular to it to `p cos θ + n×p sin θ`.
    #[test]
    fn a_rotation_vector_turns_about_itself_by_its_length(n in vector(), p in vector(), angle in 0.0..PI) {
        let n = n / n.norm();
        let p = p - n * n.dot(p);
        let r = Rotor::from_rotation_vector(n * angle).unwrap();
        prop_assert!((r.apply(n) - n).norm() <= 8.0 * EPS);
        let expected = p * angle.cos() + n.cross(p) * angle.sin();
        prop_assert!((r.apply(p) - expected).norm() <= 16.0 * EPS);
        prop_assert!((r.to_rotation_vector() - n * angle).norm() <= 16.0 * EPS);
        // The other rotor of the turn, and the turn the long way round, have the same rotation vector.
        prop_assert!(((-r).to_rotation_vector() - n * angle).norm() <= 16.0 * EPS);
        let long = Rotor::from_rotation_vector(n * (angle - 2.0 * PI)).unwrap();
        prop_assert!(angle < 1e-3 || (long.to_rotation_vector() - n * angle).norm() <= 32.0 * EPS);
    }

    /// A rotor is not rounded again, and rows of quaternions come back bit by bit.
    #[test]
    fn unit_components_are_kept(r in rotor()) {
        prop_assert_eq!(Rotor::from_components(r.components()), Ok(r));
        prop_assert_eq!(Rotor::from_quaternion_wxyz(r.to_quaternion_wxyz()), Ok(r));
    }

    #[test]
    fn the_plane_of_a_rotor_is_a_unit_plane(r in rotor()) {
        prop_assert!((r.plane_angle().0.norm() - 1.0).abs() <= 4.0 * EPS);
    }

    /// Only directions count, even where the squares of the lengths overflow or underflow.
    #[test]
    fn sizes_of_vectors_do_not_matter(a in vector(), b in vector(), e in -300.0..300.0f64) {
        let r = Rotor::from_vectors(a, b).unwrap();
        let scaled = Rotor::from_vectors(a * 10f64.powf(e), b * 10f64.powf(-e)).unwrap();
        // The direction of the sum is known to rounding over its size.
        let known = (a / a.norm() + b / b.norm()).norm();
        prop_assert!(difference(r, scaled) <= 32.0 * EPS / known);
    }

    /// Newton's step for a norm of 1 + e leaves −3/2 e², and does not turn.
    #[test]
    fn renormalizing_squares_the_error_of_the_norm(r in rotor(), e in -1e-4..1e-4f64) {
        let drifted = Rotor::from_unit_components(r.components().map(|c| c * (1.0 + e)));
        prop_assert!(difference(drifted.renormalized(), r) <= 2.0 * e * e + 4.0 * EPS);
    }

    /// The series leaves 5/16 of the cube of the excess of the squared norm, which is 4e here.
    #[test]
    fn composing_rotors_of_single_precision_is_a_rotor(r in rotor(), s in rotor(), e in -1e-6..1e-6f64) {
        let drifted = |r: Rotor| Rotor::from_unit_components(r.components().map(|c| c * (1.0 + e)));
        prop_assert!(difference(drifted(s).compose(drifted(r)), s * r) <= 32.0 * e.abs().powi(3) + 8.0 * EPS);
    }
}
