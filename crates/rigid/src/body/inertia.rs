//! The inertia map of a rigid body, a linear map of bivectors to bivectors.
//!
//! A body that turns with angular velocity `Ω` has at `x` the velocity `x·Ω`, hence the angular momentum
//! (handout eq. 4.18)
//!
//! ```text
//! I(B) = ∫ d³x ρ x∧(x·B).
//! ```
//!
//! With `B = I b`, `x∧(x·B)` is `I (x² b − x (x·b))`: on the components `(e2e3, e3e1, e1e2)`, which are
//! those of the axial vector, the map is the familiar matrix `∫ρ (x² − x xᵀ)`. It is symmetric, so it has
//! three principal axes; in them it multiplies the plane `I e_k` by the moment `i_k`.
//!
//! Which moments a body can have follows from `i1 = ∫ρ (x2² + x3²)` and its like: none is negative and
//! none exceeds the sum of the other two, `i1 + i2 − i3 = 2 ∫ρ x3² >= 0`, with equality for a flat body.

use super::Body;
use crate::error::BodyError;
use polhode_ga::general::eigen::symmetric_eigen;
use polhode_ga::{Bivector, Rotor, Vector};
use std::array::from_fn;

/// Tolerance of relations between moments, relative to the largest: a few dozen roundings of sums of matrices.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A moment of a full matrix below this fraction of the largest is rounding of its entries.
const ZERO_MOMENT: f64 = 8.0 * f64::EPSILON;

/// The inertia map `I(B)`, in kg m²; its owner defines the point and the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    matrix: [[f64; 3]; 3],
    moments: [f64; 3],
    frame: Rotor,
}

impl Inertia {
    /// The map with `I(I e_k) = i_k I e_k`: i1 belongs to the axis e1 and the plane e2e3.
    pub fn from_principal_moments(moments: [f64; 3]) -> Result<Inertia, BodyError> {
        check_moments(moments)?;
        let matrix = from_fn(|i| from_fn(|j| if i == j { moments[i] } else { 0.0 }));
        Ok(Inertia { matrix, moments, frame: Rotor::IDENTITY })
    }

    /// The map with this matrix on bivector components. The principal moments ascend; the frame is the rotor nearest
    /// to 1 among those to the principal axes, which may point either way.
    pub fn from_matrix(m: [[f64; 3]; 3]) -> Result<Inertia, BodyError> {
        let inertia = Inertia::from_symmetric(checked_symmetric(m)?)?;
        check_moments(inertia.moments)?;
        Ok(inertia)
    }

    /// Restores a map from its matrix, principal moments and frame.
    pub fn restored(matrix: [[f64; 3]; 3], moments: [f64; 3], frame: Rotor) -> Result<Inertia, BodyError> {
        check_moments(moments)?;
        Ok(Inertia { matrix: checked_symmetric(matrix)?, moments, frame })
    }

    /// The map of point masses about their centre of mass.
    pub fn from_points(masses: &[f64], positions: &[Vector]) -> Result<Inertia, BodyError> {
        Ok(Body::from_points(masses, positions)?.inertia)
    }

    /// From the second moment `C = ∫ρ x xᵀ`: `I = tr C − C`.
    pub(crate) fn from_second_moment(c: [[f64; 3]; 3]) -> Result<Inertia, BodyError> {
        let [x, y, z] = [c[0][0], c[1][1], c[2][2]];
        let diagonal = [y + z, z + x, x + y];
        Inertia::from_matrix(from_fn(|i| from_fn(|j| if i == j { diagonal[i] } else { -c[i][j] })))
    }

    /// From a matrix that is known to be symmetric and valid; an error only if it overflows.
    pub(crate) fn from_symmetric(matrix: [[f64; 3]; 3]) -> Result<Inertia, BodyError> {
        if let Some(&value) = matrix.iter().flatten().find(|x| !x.is_finite()) {
            return Err(BodyError::NotFinite { what: "an entry of the inertia matrix".into(), value });
        }
        let (mut moments, axes) = symmetric_eigen(matrix);
        let diagonal = matrix[0][1] == 0.0 && matrix[1][2] == 0.0 && matrix[0][2] == 0.0;
        if !diagonal {
            let threshold = ZERO_MOMENT * moments[2];
            moments = moments.map(|i| if i.abs() <= threshold { 0.0 } else { i });
        }
        let frame = if is_sphere(moments) { Rotor::IDENTITY } else { nearest_frame(axes) };
        Ok(Inertia { matrix, moments, frame })
    }

    /// The map of a body with the second moments `∫x_k² dm` along axes that a rotor takes to body axes.
    pub fn from_second_moments([a, b, c]: [f64; 3], axes: Rotor) -> Result<Inertia, BodyError> {
        Ok(Inertia::from_principal_moments([b + c, c + a, a + b])?.rotated(axes))
    }

    /// The second moments `∫x_k² dm` along the body axes if these are principal up to rounding; otherwise along the
    /// principal axes, with the rotor that takes them to body axes.
    pub fn second_moments(&self) -> ([f64; 3], Option<Rotor>) {
        let m = &self.matrix;
        let largest = self.moments.into_iter().fold(0.0, f64::max);
        let aligned = [m[0][1], m[1][2], m[0][2]].iter().all(|x| x.abs() <= 1e-12 * largest);
        let moments = if aligned { [m[0][0], m[1][1], m[2][2]] } else { self.moments };
        let half = 0.5 * moments.iter().sum::<f64>();
        (moments.map(|moment| (half - moment).max(0.0)), (!aligned).then_some(self.frame))
    }

    /// `I(B)`: the angular momentum of a body with angular velocity `B`.
    pub fn apply(&self, b: Bivector) -> Bivector {
        Bivector(from_fn(|i| (0..3).map(|j| self.matrix[i][j] * b.0[j]).sum()))
    }

    /// The angular velocity for the angular momentum `l`. An error for a thin rod, which has no moment about its axis.
    pub fn inverse(&self, l: Bivector) -> Result<Bivector, BodyError> {
        if let Some(k) = self.moments.iter().position(|&i| i == 0.0) {
            let mut axis = Vector::default();
            axis.0[k] = 1.0;
            return Err(BodyError::Singular { number: k + 1, axis: self.frame.apply(axis) });
        }
        let principal = self.frame.reverse().apply_bivector(l);
        Ok(self.frame.apply_bivector(Bivector(from_fn(|k| principal.0[k] / self.moments[k]))))
    }

    /// The symmetric matrix on bivector components.
    pub fn matrix(&self) -> [[f64; 3]; 3] {
        self.matrix
    }

    /// The moments `i_k` about the principal axes `F e_k ~F`.
    pub fn principal_moments(&self) -> [f64; 3] {
        self.moments
    }

    /// The rotor `F` that carries the basis to the principal axes.
    pub fn principal_frame(&self) -> Rotor {
        self.frame
    }

    /// The map of the turned body, `B ↦ R I(~R B R) ~R`: the same moments in a turned frame.
    pub fn rotated(&self, rotor: Rotor) -> Inertia {
        let r = rotor.to_matrix();
        let rows: [[f64; 3]; 3] = from_fn(|i| self.apply(Bivector(r[i])).0);
        let entry = |i: usize, j: usize| (0..3).map(|k| r[i][k] * rows[j][k]).sum::<f64>();
        let matrix = from_fn(|i| from_fn(|j| entry(i.min(j), i.max(j))));
        let frame = if is_sphere(self.moments) { self.frame } else { (rotor * self.frame).renormalized() };
        Inertia { matrix, moments: self.moments, frame }
    }
}

/// Whether any axes are principal axes; the body's own then avoid a rounded rotation.
pub(crate) fn is_sphere([a, b, c]: [f64; 3]) -> bool {
    equal(a, b) && equal(b, c) && equal(a, c)
}

/// Checks that the moments are finite, not negative, and at most the sum of the other two, up to rounding.
fn check_moments(moments: [f64; 3]) -> Result<(), BodyError> {
    if let Some(k) = moments.iter().position(|i| !i.is_finite()) {
        return Err(BodyError::NotFinite { what: format!("the moment i{}", k + 1), value: moments[k] });
    }
    if let Some(k) = moments.iter().position(|&i| i < 0.0) {
        return Err(BodyError::NegativeMoment { number: k + 1, moments });
    }
    for k in 0..3 {
        let others = moments[(k + 1) % 3] + moments[(k + 2) % 3];
        if others < moments[k] * (1.0 - ROUNDING) {
            return Err(BodyError::ImpossibleMoments { number: k + 1, moments });
        }
    }
    Ok(())
}

/// The symmetric part of the matrix, if it is symmetric up to rounding.
fn checked_symmetric(m: [[f64; 3]; 3]) -> Result<[[f64; 3]; 3], BodyError> {
    for i in 0..3 {
        for j in 0..3 {
            if !m[i][j].is_finite() {
                let what = format!("the inertia matrix's entry in row {}, column {}", i + 1, j + 1);
                return Err(BodyError::NotFinite { what, value: m[i][j] });
            }
        }
    }
    let largest = m.iter().flatten().fold(0.0, |l: f64, x| l.max(x.abs()));
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        if (m[i][j] - m[j][i]).abs() > ROUNDING * largest {
            return Err(BodyError::NotSymmetric {
                row: i + 1,
                column: j + 1,
                entry: m[i][j],
                mirrored: m[j][i],
            });
        }
    }
    Ok(from_fn(|i| from_fn(|j| 0.5 * m[i][j] + 0.5 * m[j][i])))
}

/// The rotor from the basis to the axes, with the directions of the axes chosen so that its scalar part is largest.
///
/// Reversing two axes is a half turn about the third, and `F e1e2` has the scalar part `−F_{e1e2}`: the four choices
/// make each component of `F` the scalar part. Ties take the first.
fn nearest_frame(mut axes: [[f64; 3]; 3]) -> Rotor {
    if Vector(axes[0]).cross(Vector(axes[1])).dot(Vector(axes[2])) < 0.0 {
        axes[2] = axes[2].map(|x| -x);
    }
    // Eigenvectors are orthonormal to rounding; only those of a matrix that overflowed are not.
    let columns = from_fn(|i| from_fn(|k| axes[k][i]));
    let frame = Rotor::from_matrix(columns).unwrap_or(Rotor::IDENTITY);
    let components = frame.components();
    let largest = components.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
    let tied = largest * (1.0 - 8.0 * f64::EPSILON);
    let place = components.iter().position(|x| x.abs() >= tied).unwrap_or(0);
    let nearest = match place {
        0 => frame,
        k => frame * Rotor::from_unit_components(from_fn(|i| f64::from(i == k))),
    };
    if nearest.components()[0] < 0.0 { -nearest } else { nearest }
}

/// Relative tolerance of equal moments: the rounding of a diagonalised matrix.
const SAME_MOMENT: f64 = 8.0 * f64::EPSILON;

pub(crate) fn equal(x: f64, y: f64) -> bool {
    (x - y).abs() <= SAME_MOMENT * x.abs().max(y.abs())
}

/// Relative difference of two positive moments.
pub(crate) fn apart(x: f64, y: f64) -> f64 {
    if x == y { 0.0 } else { (x - y).abs() / x.max(y) }
}
