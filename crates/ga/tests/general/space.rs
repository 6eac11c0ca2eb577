//! An algebra with its functions, and the product by the table.

use polhode_ga::general::Calculus;
use polhode_ga::table::{Algebra, Signature};
use proptest::prelude::*;

pub const EPS: f64 = f64::EPSILON;

/// An algebra with its functions, and the product by the table.
pub struct Space {
    pub algebra: Algebra,
    pub calculus: Calculus,
}

impl Space {
    pub fn new(p: usize, q: usize, r: usize) -> Space {
        let algebra = Algebra::new(Signature { p, q, r }).unwrap();
        let calculus = Calculus::new(&algebra);
        Space { algebra, calculus }
    }

    pub fn size(&self) -> usize {
        self.algebra.blades().len()
    }

    pub fn product(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        for (i, x) in a.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            for (j, y) in b.iter().enumerate().filter(|(_, y)| **y != 0.0) {
                let (sign, k) = self.algebra.basis_product(i, j);
                out[k] += f64::from(sign) * x * y;
            }
        }
        out
    }

    pub fn wedge(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let blades = self.algebra.blades();
        let mut out = vec![0.0; self.size()];
        for (i, x) in a.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            for (j, y) in b.iter().enumerate().filter(|(j, _)| blades[i].bits & blades[*j].bits == 0) {
                let (sign, k) = self.algebra.basis_product(i, j);
                out[k] += f64::from(sign) * x * y;
            }
        }
        out
    }

    pub fn reverse(&self, m: &[f64]) -> Vec<f64> {
        let sign = |k: usize| if k % 4 < 2 { 1.0 } else { -1.0 };
        m.iter().zip(self.algebra.blades()).map(|(x, b)| sign(b.grade()) * x).collect()
    }

    /// `Σ x E`, E the wedge of the generators, numbered from 1.
    pub fn sum(&self, terms: &[(f64, &[usize])]) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        for (x, generators) in terms {
            let mut blade = self.scalar(*x);
            for g in *generators {
                let mut e = vec![0.0; self.size()];
                e[*g] = 1.0;
                blade = self.product(&blade, &e);
            }
            out.iter_mut().zip(blade).for_each(|(o, b)| *o += b);
        }
        out
    }

    pub fn scalar(&self, x: f64) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        out[0] = x;
        out
    }

    /// The components of grade k from a list that is long enough.
    pub fn of_grade(&self, k: usize, numbers: &[f64]) -> Vec<f64> {
        let mut numbers = numbers.iter();
        let blades = self.algebra.blades();
        blades.iter().map(|b| if b.grade() == k { *numbers.next().unwrap() } else { 0.0 }).collect()
    }
}

pub fn norm(m: &[f64]) -> f64 {
    let scale = m.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    if scale == 0.0 { 0.0 } else { scale * m.iter().map(|x| (x / scale).powi(2)).sum::<f64>().sqrt() }
}

pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "values of one algebra");
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

pub fn scaled(m: &[f64], s: f64) -> Vec<f64> {
    m.iter().map(|x| x * s).collect()
}

pub fn signatures(most: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=most).flat_map(|n| (0..=n).flat_map(move |p| (0..=n - p).map(move |q| (p, q, n - p - q))))
}

/// The algebras that have names: planes, spaces, projective, conformal, spacetime and larger ones.
pub const NAMED: [(usize, usize, usize); 12] = [
    (2, 0, 0),
    (3, 0, 0),
    (3, 0, 1),
    (4, 1, 0),
    (1, 3, 0),
    (3, 1, 0),
    (4, 0, 0),
    (2, 0, 1),
    (2, 2, 0),
    (5, 0, 0),
    (6, 0, 0),
    (4, 4, 0),
];

pub fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0f64, 256)
}
