//! Blades as subspaces: the join and the meet.
//!
//! A blade `A = a1∧…∧ak` stands for the span of its vectors; no metric enters. To decide
//! whether directions are the same, the basis vectors count as orthonormal.

use super::{Calculus, add_scaled, dot, grade, scaled};
use crate::error::MathError;
use crate::g3::values::{norm, scale_of};

/// The sine of the angle below which a direction counts as lying in a subspace, and the relative part
/// of a multivector below which it counts as a blade; 256 roundings where components are rounded more coarsely.
pub const SAME_DIRECTION: f64 = 1e-10;

/// A subspace: orthonormal vectors, and the unit blade with its orientation.
struct Subspace {
    vectors: Vec<Vec<f64>>,
    blade: Vec<f64>,
}

impl Calculus {
    /// The join: the unit blade of the smallest subspace that contains both. See [`Calculus::meet`].
    pub fn join(&self, a: &[f64], b: &[f64]) -> Result<Vec<f64>, MathError> {
        Ok(self.join_and_meet(a, b)?.0)
    }

    /// The meet: the unit blade of the subspace common to both, the scalar 1 where that is zero only.
    ///
    /// Join J and meet M are oriented together: with `A = A'∧M` and `B = M∧B'`, `J = A'∧M∧B'`. If nothing is in common,
    /// `M = 1` and J has the sign of `A∧B`. If A contains B, `J = A` and `M = B`; if B contains A, `J = B` and `M = A`.
    /// Otherwise the first of the largest components of J is positive: if A and B span the space, `J = I` and M has the
    /// sign of `A∨B`.
    pub fn meet(&self, a: &[f64], b: &[f64]) -> Result<Vec<f64>, MathError> {
        Ok(self.join_and_meet(a, b)?.1)
    }

    fn join_and_meet(&self, a: &[f64], b: &[f64]) -> Result<(Vec<f64>, Vec<f64>), MathError> {
        let (a, b) = (self.subspace(&self.read(a)?)?, self.subspace(&self.read(b)?)?);
        let whole =
            [&a.vectors[..], &extend(&a.vectors, &b.vectors, usize::MAX, self.tolerances.direction)].concat();
        let common = a.vectors.len() + b.vectors.len() - whole.len();
        // The complements of A and B together span the complement of the common part.
        let missing = |x: &Subspace| extend(&x.vectors, &whole, whole.len() - x.vectors.len(), 0.0);
        let (from_a, from_b) = (missing(&a), missing(&b));
        let missing = [&from_a[..], &extend(&from_a, &from_b, from_b.len(), 0.0)].concat();
        let shared = extend(&missing, &whole, common, 0.0);
        let (of_a, of_b) = (a.vectors.len() - common, b.vectors.len() - common);
        let mut meet = self.wedge_of(&shared);
        let first = self.wedge_of(&extend(&shared, &a.vectors, of_a, 0.0));
        let last = self.wedge_of(&extend(&shared, &b.vectors, of_b, 0.0));
        let left = self.wedge_bits(&first, &meet);
        let sign = dot(&left, &a.blade) * dot(&self.wedge_bits(&meet, &last), &b.blade);
        let join = self.wedge_bits(&left, &last);
        let mut join = scaled(&join, 1f64.copysign(sign) / norm(&join));
        let flip = if of_b == 0 {
            dot(&meet, &b.blade) < 0.0
        } else if of_a == 0 {
            dot(&meet, &a.blade) < 0.0
        } else {
            common > 0 && self.leads_negative(&join)
        };
        if flip {
            join.iter_mut().chain(&mut meet).for_each(|x| *x = -*x);
        }
        Ok((self.to_basis(&join), self.to_basis(&meet)))
    }

    /// Whether the first component, in basis order, of those as large as the largest is negative.
    fn leads_negative(&self, m: &[f64]) -> bool {
        let m = self.to_basis(m);
        let bound = (1.0 - self.tolerances.direction) * m.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        m.iter().find(|x| x.abs() >= bound).is_some_and(|&x| x < 0.0)
    }

    /// The subspace of a blade; an error if it is not a blade.
    ///
    /// Contractions by all blades one grade lower give vectors of the blade; the wedge of the k most independent ones is
    /// the blade again if it is one.
    fn subspace(&self, m: &[f64]) -> Result<Subspace, MathError> {
        let size = norm(m);
        if size == 0.0 {
            return Err(MathError::NoSubspace);
        }
        let scale = scale_of(m);
        let m: Vec<f64> = m.iter().map(|x| x / scale / (size / scale)).collect();
        let k = (0..m.len()).max_by(|&i, &j| m[i].abs().total_cmp(&m[j].abs())).map_or(0, grade);
        let contraction = |bits: usize| -> Vec<f64> {
            let component =
                |i: usize| if bits >> i & 1 == 1 { 0.0 } else { self.sign(1 << i, bits) * m[bits | 1 << i] };
            (0..self.generators).map(component).collect()
        };
        let lower = (0..m.len()).filter(|&bits| grade(bits) + 1 == k);
        let vectors = extend(&[], &lower.map(contraction).collect::<Vec<_>>(), k as usize, 0.0);
        let blade = self.wedge_of(&vectors);
        let blade = scaled(&blade, 1f64.copysign(dot(&blade, &m)));
        let mut rest = m;
        add_scaled(&mut rest, &blade, -1.0);
        let deviation = norm(&rest);
        if vectors.len() != k as usize || deviation > self.tolerances.direction {
            return Err(MathError::NotBlade { deviation });
        }
        Ok(Subspace { vectors, blade })
    }

    /// The wedge of vectors, 1 of none.
    fn wedge_of(&self, vectors: &[Vec<f64>]) -> Vec<f64> {
        vectors.iter().fold(self.scalar(1.0), |blade, v| {
            let mut vector = vec![0.0; self.size()];
            v.iter().enumerate().for_each(|(i, x)| vector[1 << i] = *x);
            self.wedge_bits(&blade, &vector)
        })
    }
}

/// Up to `most` orthonormal vectors, perpendicular to the orthonormal `base`, that together with it span
/// the candidates to within `tolerance`; the farthest first.
fn extend(base: &[Vec<f64>], candidates: &[Vec<f64>], most: usize, tolerance: f64) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    while found.len() < most {
        let residual = |v: &Vec<f64>| {
            let mut v = v.clone();
            // The second pass removes the rounding of the first (Kahan: twice is enough).
            for u in base.iter().chain(&found).chain(base).chain(&found) {
                let along = dot(&v, u);
                add_scaled(&mut v, u, -along);
            }
            v
        };
        let farthest = candidates.iter().map(residual).max_by(|a, b| norm(a).total_cmp(&norm(b)));
        match farthest {
            Some(v) if norm(&v) > tolerance => found.push(scaled(&v, 1.0 / norm(&v))),
            _ => break,
        }
    }
    found
}
