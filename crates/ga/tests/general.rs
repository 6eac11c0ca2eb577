//! Functions of multivectors in every signature, against the table and closed forms.

use polhode_ga::functions::{Function, MathError};
use polhode_ga::general::Calculus;
use polhode_ga::product::Grades;
use polhode_ga::table::{Algebra, Signature};
use proptest::prelude::*;
use std::f64::consts::PI;

const EPS: f64 = f64::EPSILON;

/// An algebra with its functions, and the product by the table.
struct Space {
    algebra: Algebra,
    calculus: Calculus,
}

impl Space {
    fn new(p: usize, q: usize, r: usize) -> Space {
        let algebra = Algebra::new(Signature { p, q, r }).unwrap();
        let calculus = Calculus::new(&algebra);
        Space { algebra, calculus }
    }

    fn size(&self) -> usize {
        self.algebra.blades().len()
    }

    fn product(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        for (i, x) in a.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            for (j, y) in b.iter().enumerate().filter(|(_, y)| **y != 0.0) {
                let (sign, k) = self.algebra.basis_product(i, j);
                out[k] += f64::from(sign) * x * y;
            }
        }
        out
    }

    fn wedge(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
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

    fn reverse(&self, m: &[f64]) -> Vec<f64> {
        let sign = |k: usize| if k % 4 < 2 { 1.0 } else { -1.0 };
        m.iter().zip(self.algebra.blades()).map(|(x, b)| sign(b.grade()) * x).collect()
    }

    /// `Σ x E`, E the wedge of the generators, numbered from 1.
    fn sum(&self, terms: &[(f64, &[usize])]) -> Vec<f64> {
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

    fn scalar(&self, x: f64) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        out[0] = x;
        out
    }

    /// The components of grade k from a list that is long enough.
    fn of_grade(&self, k: usize, numbers: &[f64]) -> Vec<f64> {
        let mut numbers = numbers.iter();
        let blades = self.algebra.blades();
        blades.iter().map(|b| if b.grade() == k { *numbers.next().unwrap() } else { 0.0 }).collect()
    }

    fn planes(&self) -> usize {
        self.algebra.blades().iter().filter(|b| b.grade() == 2).count()
    }
}

fn norm(m: &[f64]) -> f64 {
    let scale = m.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    if scale == 0.0 { 0.0 } else { scale * m.iter().map(|x| (x / scale).powi(2)).sum::<f64>().sqrt() }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

fn scaled(m: &[f64], s: f64) -> Vec<f64> {
    m.iter().map(|x| x * s).collect()
}

fn signatures(most: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=most).flat_map(|n| (0..=n).flat_map(move |p| (0..=n - p).map(move |q| (p, q, n - p - q))))
}

/// The algebras that have names: planes, spaces, projective, conformal, spacetime and larger ones.
const NAMED: [(usize, usize, usize); 12] = [
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

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0f64, 256)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// `M M⁻¹ = 1` to a few ulps of the condition number, at any size.
    #[test]
    fn the_inverse_undoes(x in numbers(), e in -200.0..200.0f64) {
        let size = 10f64.powf(e);
        for (p, q, r) in signatures(5).chain([(6, 0, 0), (3, 3, 1)]) {
            let space = Space::new(p, q, r);
            let m = scaled(&x[..space.size()], size);
            let Ok(inverse) = space.calculus.inverse(&m) else { continue };
            let condition = norm(&m) * norm(&inverse) * (space.size() as f64).sqrt();
            let one = space.scalar(1.0);
            for product in [space.product(&m, &inverse), space.product(&inverse, &m)] {
                prop_assert!(distance(&product, &one) <= 8.0 * EPS * condition, "{p} {q} {r}: {} {condition}", distance(&product, &one));
            }
        }
    }

    /// `log(exp B) = B` for angles whose sum over the planes is below π, and `exp(log R) = R`.
    #[test]
    fn log_and_exp_undo_each_other(x in numbers(), e in -20.0..0.0f64) {
        for (p, q, r) in NAMED {
            let space = Space::new(p, q, r);
            let b = scaled(&space.of_grade(2, &x), 10f64.powf(e));
            // The sum of the angles of m planes is below √m |B| and √m < 2.
            let b = scaled(&b, (1.2 / norm(&b)).min(1.0));
            let exp = space.calculus.exp(&b).unwrap();
            let log = space.calculus.log(&exp).unwrap();
            prop_assert!(distance(&log, &b) <= 64.0 * EPS * norm(&b), "{p} {q} {r}: {:e}", distance(&log, &b) / norm(&b));
        }
    }

    #[test]
    fn exp_of_log_returns(x in numbers(), size in -50.0..50.0f64, angle in 0.0..10.0f64) {
        for (p, q, r) in NAMED.into_iter().filter(|(p, q, r)| p + q + r <= 5) {
            let space = Space::new(p, q, r);
            let m = space.calculus.exp(&scaled(&space.of_grade(2, &x), angle)).unwrap();
            let m = scaled(&m, 10f64.powf(size));
            let log = match space.calculus.log(&m) {
                Ok(log) => log,
                // Boosts so large that the size is lost.
                Err(MathError::NoLogarithm | MathError::NotVersor { .. }) => continue,
                Err(e) => return Err(TestCaseError::fail(format!("{p} {q} {r} {e}"))),
            };
            let back = space.calculus.exp(&log).unwrap();
            prop_assert!(distance(&back, &m) <= 1e-11 * norm(&m), "{p} {q} {r}: {:e}", distance(&back, &m) / norm(&m));
        }
    }

    /// Turned planes: `exp(S B ~S) = S exp(B) ~S` with the closed form of basis planes.
    #[test]
    fn turned_planes_have_the_closed_form(x in numbers(), angles in prop::array::uniform2(-40.0..40.0f64), near in -15.0..0.0f64) {
        let space = Space::new(5, 0, 0);
        let s = space.calculus.exp(&space.of_grade(2, &x)).unwrap();
        for (u, v) in [(angles[0], angles[1]), (angles[0], angles[0] * (1.0 + 10f64.powf(near))), (angles[0], angles[0]), (angles[0], 10f64.powf(near))] {
            let b = space.sum(&[(u, &[1, 2]), (v, &[3, 4])]);
            let exp = space.product(&space.sum(&[(u.cos(), &[]), (u.sin(), &[1, 2])]), &space.sum(&[(v.cos(), &[]), (v.sin(), &[3, 4])]));
            let turn = |m: &[f64]| space.product(&space.product(&s, m), &space.reverse(&s));
            let error = distance(&space.calculus.exp(&turn(&b)).unwrap(), &turn(&exp));
            prop_assert!(error <= 16.0 * EPS * (1.0 + norm(&b)), "{u} {v} {}", error / EPS / (1.0 + norm(&b)));
        }
    }
}

#[test]
fn complements_fill_the_space() {
    for (p, q, r) in signatures(6).chain([(8, 0, 0), (4, 3, 1)]) {
        let space = Space::new(p, q, r);
        let last = space.size() - 1;
        let mut pseudoscalar = space.scalar(0.0);
        pseudoscalar[last] = 1.0;
        for i in 0..space.size() {
            let mut e = space.scalar(0.0);
            e[i] = 1.0;
            let (right, left) = (space.calculus.right_complement(&e), space.calculus.left_complement(&e));
            assert_eq!(space.wedge(&e, &right), pseudoscalar);
            assert_eq!(space.wedge(&left, &e), pseudoscalar);
            assert_eq!(space.calculus.left_complement(&right), e);
        }
    }
}

#[test]
fn minus_one_turns_in_the_first_plane() {
    for (p, q, r) in NAMED {
        let space = Space::new(p, q, r);
        let log = space.calculus.log(&space.scalar(-1.0)).unwrap();
        let first = if p > 1 { space.sum(&[(PI, &[1, 2])]) } else { space.sum(&[(PI, &[2, 3])]) };
        assert!(distance(&log, &first) <= 8.0 * EPS, "{p} {q} {r} {log:?}");
        assert_eq!(space.calculus.log(&space.scalar(1.0)).unwrap(), space.scalar(0.0));
    }
}

#[test]
fn grades() {
    let space = Space::new(3, 0, 1);
    assert_eq!(space.calculus.grades(Function::Exp, Grades(0b100)), Grades(0b10101));
}
