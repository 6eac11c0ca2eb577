//! Linear maps of bivectors for bodies in lanes: gains of springs, dampers and controllers.

use crate::laws::torque::lanes::{Three, add, part};
use polhode_ga::simd::lanes::{Lanes, mapped};

/// A linear map for each body.
pub(super) enum Gain<const W: usize, const F: bool> {
    /// Along the principal axes of every body.
    Diagonal(Three<W, F>),
    /// By rows.
    Matrix([Three<W, F>; 3]),
}

impl<const W: usize, const F: bool> Gain<W, F> {
    /// Maps all to zero.
    pub const NONE: Self = Gain::Diagonal([Lanes::ZERO; 3]);

    /// From its matrix, by rows.
    pub fn new(m: [Three<W, F>; 3]) -> Gain<W, F> {
        let off = [&m[0][1], &m[0][2], &m[1][0], &m[1][2], &m[2][0], &m[2][1]];
        if off.iter().all(|lanes| lanes.0.iter().all(|x| *x == 0.0)) {
            Gain::Diagonal([m[0][0], m[1][1], m[2][2]])
        } else {
            Gain::Matrix(m)
        }
    }

    /// That of `P` of the bodies, from `first` on.
    #[inline(always)]
    pub fn part<const P: usize>(&self, first: usize) -> Gain<P, F> {
        match self {
            Gain::Diagonal(entries) => Gain::Diagonal(part(entries, first)),
            Gain::Matrix([x, y, z]) => Gain::Matrix([part(x, first), part(y, first), part(z, first)]),
        }
    }

    /// Its matrix, by rows.
    fn rows(&self) -> [Three<W, F>; 3] {
        match *self {
            Gain::Diagonal([x, y, z]) => {
                let zero = Lanes::ZERO;
                [[x, zero, zero], [zero, y, zero], [zero, zero, z]]
            }
            Gain::Matrix(m) => m,
        }
    }

    /// Adds the other map.
    pub fn join(&mut self, other: &Gain<W, F>) {
        let (mut sum, other) = (self.rows(), other.rows());
        for k in 0..3 {
            add(&mut sum[k], &other[k]);
        }
        *self = Gain::new(sum);
    }

    /// The negative of the map of a bivector: the torque against it.
    #[inline(always)]
    pub fn against(&self, v: &Three<W, F>) -> Three<W, F> {
        let [x, y, z] = match self {
            Gain::Diagonal([x, y, z]) => [*x * v[0], *y * v[1], *z * v[2]],
            Gain::Matrix(m) => mapped(m, v),
        };
        [-x, -y, -z]
    }
}
