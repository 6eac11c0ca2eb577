//! Eigenvalues of symmetric matrices.

/// Sweeps of [`symmetric_eigen`]; a few suffice, for the rotations converge quadratically.
const MOST_SWEEPS: u32 = 30;

/// Eigenvalues and unit eigenvectors of a symmetric matrix by Jacobi's rotations.
pub(super) fn symmetric_eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = a.len();
    let mut vectors: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    for _ in 0..MOST_SWEEPS {
        let mut turned = false;
        for i in 0..n {
            for j in i + 1..n {
                if a[i][j].abs() <= f64::EPSILON * (a[i][i].abs() * a[j][j].abs()).sqrt() {
                    continue;
                }
                turned = true;
                let theta = (a[j][j] - a[i][i]) / (2.0 * a[i][j]);
                let t = f64::copysign(1.0, theta) / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in a.iter_mut() {
                    (row[i], row[j]) = (c * row[i] - s * row[j], s * row[i] + c * row[j]);
                }
                for k in 0..n {
                    (a[i][k], a[j][k]) = (c * a[i][k] - s * a[j][k], s * a[i][k] + c * a[j][k]);
                    (vectors[i][k], vectors[j][k]) =
                        (c * vectors[i][k] - s * vectors[j][k], s * vectors[i][k] + c * vectors[j][k]);
                }
            }
        }
        if !turned {
            break;
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), vectors)
}
