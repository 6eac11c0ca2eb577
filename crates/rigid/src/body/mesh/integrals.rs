//! Integrals of 1, `x` and `x xᵀ` over the inside of a closed mesh.
//!
//! A triangle `a, b, c` and the origin span a tetrahedron of signed volume `a·(b x c)/6`. With barycentric
//! coordinates `∫λ_i = V/4`, `∫λ_i λ_j = V (1 + δ_ij)/20`, so with `s = a + b + c`
//!
//! ```text
//! ∫ x = V s/4,     ∫ x xᵀ = V (s sᵀ + a aᵀ + b bᵀ + c cᵀ)/20,
//! ```
//!
//! exact for a polyhedron. Positions relative to a reference point inside, and edges in
//! `a·(b x c) = a·((b − a) x (c − a))`, keep all digits of a mesh far from the origin.

use super::TriangleMesh;
use crate::numerics::sum::{Sum, SymmetricSum};
use polhode_ga::Vector;

/// The integrals about a reference point.
pub(super) struct Integrals {
    /// `∫ 1`.
    pub volume: f64,
    /// A bound on the rounding of the volume.
    pub rounding: f64,
    /// `∫ x`.
    pub first: Vector,
    /// `∫ x xᵀ`.
    pub second: [[f64; 3]; 3],
}

pub(super) fn integrals(mesh: &TriangleMesh, reference: Vector) -> Integrals {
    let (mut volume, mut rounding) = (Sum::default(), 0.0);
    let mut first = [Sum::default(); 3];
    let mut second = SymmetricSum::default();
    for face in &mesh.faces {
        let corners = face.map(|i| mesh.vertices[i as usize]);
        let [a, b, c] = corners.map(|x| x - reference);
        let (u, v) = (corners[1] - corners[0], corners[2] - corners[0]);
        let determinant = a.dot(u.cross(v));
        let s = a + b + c;
        volume.add(determinant);
        // Each of the six products of three rounded differences is off by at most 8 half-ulps.
        rounding += 4.0 * f64::EPSILON * products(a, u, v);
        first.iter_mut().zip(s.0).for_each(|(sum, x)| sum.add(determinant * x));
        let [a, b, c, s] = [a.0, b.0, c.0, s.0];
        second.add(|i, j| determinant * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]));
    }
    Integrals {
        volume: volume.value() / 6.0,
        rounding: rounding / 6.0,
        first: Vector(first.map(|sum| sum.value() / 24.0)),
        second: second.matrix().map(|row| row.map(|x| x / 120.0)),
    }
}

/// The sum of the magnitudes of the six products in `a·(u x v)`.
fn products(a: Vector, u: Vector, v: Vector) -> f64 {
    let [a, u, v] = [a, u, v].map(|x| x.0.map(f64::abs));
    a[0] * (u[1] * v[2] + u[2] * v[1])
        + a[1] * (u[2] * v[0] + u[0] * v[2])
        + a[2] * (u[0] * v[1] + u[1] * v[0])
}
