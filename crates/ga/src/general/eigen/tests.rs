use super::*;
use crate::{Rotor, Vector};
use proptest::prelude::*;

/// `Σ λ_k v_k v_kᵀ` for the axes of a rotated basis.
fn with_axes(rotor: Rotor, values: [f64; 3]) -> [[f64; 3]; 3] {
    let m = rotor.to_matrix();
    from_fn(|i| from_fn(|j| (0..3).map(|k| values[k] * m[i][k] * m[j][k]).sum()))
}

fn largest(values: [f64; 3]) -> f64 {
    values.into_iter().fold(0.0, |m, x| m.max(x.abs()))
}

#[test]
fn diagonal_matrices_are_unchanged() {
    let a = [[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
    let expected = ([1.0, 2.0, 3.0], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    assert_eq!(symmetric_eigen(a), expected);
}

/// `[[1, b], [b, d]]` with d = 1e-16 and b² = d/4 has eigenvalues near 1 and ¾d(1 − d/4 …); the small one must be
/// accurate relative to itself.
#[test]
fn graded_matrix_keeps_relative_accuracy() {
    let a = [[1.0, 0.5e-8, 0.0], [0.5e-8, 1e-16, 0.0], [0.0, 0.0, 1.0]];
    let (values, _) = symmetric_eigen(a);
    assert!((values[0] / 0.75e-16 - 1.0).abs() < 4.0 * f64::EPSILON, "{values:?}");
}

#[test]
fn extreme_and_singular_matrices_converge() {
    for scale in [1e-300, 1.0, 1e300] {
        let all = [[scale; 3]; 3];
        let (values, _) = symmetric_eigen(all);
        assert!((values[2] / (3.0 * scale) - 1.0).abs() < 8.0 * f64::EPSILON);
        assert!(values[0].abs() < 4.0 * f64::EPSILON * scale && values[1].abs() < 4.0 * f64::EPSILON * scale);
    }
    symmetric_eigen([[f64::NAN; 3]; 3]);
    symmetric_eigen([[f64::INFINITY; 3]; 3]);
}

proptest! {
    /// Some six sweeps of three rotations: each entry is rounded a few dozen times.
    #[test]
    fn recovers_values_and_vectors(
        axes in prop::array::uniform3(-4.0..4.0_f64),
        base in 0.1..10.0_f64,
        gap in prop::sample::select(vec![0.0, 1e-15, 1e-12, 1e-8, 1e-4, 1.0]),
        ratio in prop::sample::select(vec![1.0, 1e-3, 1e-8, 1e-16, 0.0]),
    ) {
        let rotor = Rotor::from_rotation_vector(Vector(axes)).unwrap();
        let mut expected = [base * ratio, base, base * (1.0 + gap)];
        let a = with_axes(rotor, expected);
        expected.sort_by(f64::total_cmp);
        let (values, vectors) = symmetric_eigen(a);
        let tolerance = 32.0 * f64::EPSILON * largest(expected);
        for k in 0..3 {
            prop_assert!((values[k] - expected[k]).abs() < tolerance, "{values:?} {expected:?}");
            for i in 0..3 {
                let av: f64 = (0..3).map(|j| a[i][j] * vectors[k][j]).sum();
                prop_assert!((av - values[k] * vectors[k][i]).abs() < tolerance);
            }
            for l in 0..3 {
                let product = Vector(vectors[k]).dot(Vector(vectors[l]));
                let unit = if k == l { 1.0 } else { 0.0 };
                prop_assert!((product - unit).abs() < 32.0 * f64::EPSILON);
            }
        }
    }
}
