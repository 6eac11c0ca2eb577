//! Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations.
//!
//! A rotation in the plane of axes p, q makes `a_pq` zero and moves its square onto the diagonal; repeated sweeps
//! through all planes converge quadratically. Unlike a closed form this keeps full accuracy where eigenvalues nearly
//! coincide; and where a positive matrix is graded, such as `diag(1, 1e-16)` with small couplings, it gives each
//! eigenvalue to rounding of its own size (Demmel and Veselić 1992), provided that "small" is measured against
//! `√(a_pp a_qq)`.

use std::array::from_fn;

/// A bound; convergence is quadratic, in five or six sweeps.
const SWEEPS: usize = 32;

/// Ascending eigenvalues of `a` (its upper triangle) and the unit eigenvectors, `vectors[k]` for the
/// k-th. Orthonormal but of either handedness; a diagonal matrix gives basis vectors.
pub fn symmetric_eigen(mut a: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut v: [[f64; 3]; 3] = from_fn(|i| from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    diagonalize(&mut a, &mut v);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    (order.map(|k| a[k][k]), order.map(|k| v[k]))
}

/// Makes the upper triangle of `a` diagonal; rows of `v`, the identity before, become the eigenvectors.
pub(super) fn diagonalize<R: AsMut<[f64]> + AsRef<[f64]>>(a: &mut [R], v: &mut [R]) {
    for _ in 0..SWEEPS {
        let mut diagonal = true;
        for p in 0..a.len() {
            for q in p + 1..a.len() {
                let at = |i: usize, j: usize| a[i].as_ref()[j];
                let small = f64::EPSILON / 4.0 * at(p, p).abs().sqrt() * at(q, q).abs().sqrt();
                if at(p, q).abs() > small {
                    rotate(a, v, p, q);
                    diagonal = false;
                }
            }
        }
        if diagonal {
            break;
        }
    }
}

/// The rotation by the smaller of the two angles that make `a_pq` zero: with `θ = (a_qq − a_pp)/2a_pq`,
/// its tangent t is the smaller root of `t² + 2θt − 1 = 0`.
fn rotate<R: AsMut<[f64]> + AsRef<[f64]>>(a: &mut [R], v: &mut [R], p: usize, q: usize) {
    let coupling = a[p].as_ref()[q];
    let theta = 0.5 * ((a[q].as_ref()[q] - a[p].as_ref()[p]) / coupling);
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let cos = 1.0 / t.hypot(1.0);
    let sin = t * cos;
    a[p].as_mut()[p] -= t * coupling;
    a[q].as_mut()[q] += t * coupling;
    a[p].as_mut()[q] = 0.0;
    // The couplings of other axes to p and q transform like the vectors. Only the upper triangle is kept.
    let turn = |m: &mut [R], (i, j): (usize, usize), (k, l): (usize, usize)| {
        let (x, y) = (m[i].as_ref()[j], m[k].as_ref()[l]);
        m[i].as_mut()[j] = cos * x - sin * y;
        m[k].as_mut()[l] = sin * x + cos * y;
    };
    for r in (0..a.len()).filter(|&r| r != p && r != q) {
        turn(a, (r.min(p), r.max(p)), (r.min(q), r.max(q)));
    }
    for i in 0..v.len() {
        turn(v, (p, i), (q, i));
    }
}

#[cfg(test)]
mod tests;
