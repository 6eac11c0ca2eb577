//! Gains of dampers and controllers along body axes.

use polhode_ga::{Bivector, Rotor};
use std::array::from_fn;

/// A symmetric linear map of bivectors, given by factors along the body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains([[f64; 3]; 3]);

impl Gains {
    /// The map `I e_k ↦ g_k I e_k`.
    pub fn new(along: [f64; 3]) -> Gains {
        Gains(from_fn(|i| from_fn(|j| if i == j { along[i] } else { 0.0 })))
    }

    /// Its factors along the axes.
    pub fn along(&self) -> [f64; 3] {
        from_fn(|i| self.0[i][i])
    }

    /// The entries of its matrix, by rows.
    pub(crate) fn entries(&self) -> [f64; 9] {
        from_fn(|k| self.0[k / 3][k % 3])
    }

    /// The map in other axes: `B ↦ ~F G(F B ~F) F`. A multiple of the identity is returned unchanged.
    pub fn in_axes(self, frame: Rotor) -> Gains {
        let Gains(g) = self;
        if g[0][0] == g[1][1] && g[1][1] == g[2][2] && g[0][1] == 0.0 && g[1][2] == 0.0 && g[2][0] == 0.0 {
            return self;
        }
        // The columns of the matrix are the new axes.
        let f = frame.to_matrix();
        let column = |k: usize| [f[0][k], f[1][k], f[2][k]];
        let mapped: [[f64; 3]; 3] = from_fn(|k| self.times(Bivector(column(k))).0);
        let entry = |i: usize, j: usize| (0..3).map(|k| f[k][i] * mapped[j][k]).sum();
        Gains(from_fn(|i| from_fn(|j| entry(i.min(j), i.max(j)))))
    }

    /// The map of a bivector.
    pub fn times(&self, b: Bivector) -> Bivector {
        Bivector(from_fn(|i| self.0[i][0] * b.0[0] + self.0[i][1] * b.0[1] + self.0[i][2] * b.0[2]))
    }

    /// Whether all gains are zero.
    pub fn is_zero(&self) -> bool {
        self.0.iter().flatten().all(|x| *x == 0.0)
    }

    /// A bound of |G(B)| for |B| = 1: the Frobenius norm.
    pub(crate) fn bound(&self) -> f64 {
        self.0.iter().flatten().map(|x| x * x).sum::<f64>().sqrt()
    }
}
