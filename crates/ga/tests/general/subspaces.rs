//! Complements, join and meet.

use crate::space::*;
use polhode_ga::error::MathError;
use proptest::prelude::*;

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

/// De Morgan's law defines the regressive product: `rc(A ∨ B) = rc(A) ∧ rc(B)`. The pseudoscalar is its unit.
#[test]
fn the_regressive_product_is_the_wedge_of_complements() {
    for (p, q, r) in signatures(5) {
        let space = Space::new(p, q, r);
        let numbers = |seed: usize| (0..space.size()).map(|i| (7 * i + seed) as f64 % 11.0 - 5.0).collect();
        let (a, b): (Vec<f64>, Vec<f64>) = (numbers(1), numbers(4));
        let complement = |m: &[f64]| space.calculus.right_complement(m);
        let vee = space.calculus.vee(&a, &b);
        assert_eq!(complement(&vee), space.wedge(&complement(&a), &complement(&b)));
        let mut pseudoscalar = space.scalar(0.0);
        pseudoscalar[space.size() - 1] = 1.0;
        assert_eq!(space.calculus.vee(&pseudoscalar, &a), a);
    }
}

#[test]
fn join_and_meet_of_subspaces() {
    let g3 = Space::new(3, 0, 0);
    let join = |space: &Space, a: &[f64], b: &[f64]| space.calculus.join(a, b).unwrap();
    let meet = |space: &Space, a: &[f64], b: &[f64]| space.calculus.meet(a, b).unwrap();
    let a = g3.sum(&[(3.0, &[1]), (4.0, &[2])]);
    let unit = g3.sum(&[(0.6, &[1]), (0.8, &[2])]);
    for scale in [2.0, 1e-300, 1e300, -1.0] {
        assert!(distance(&join(&g3, &a, &scaled(&a, scale)), &unit) <= 4.0 * EPS);
    }
    // Two planes through the origin meet in their common line, in which A∨B lies too.
    let (p, q) = (g3.sum(&[(2.0, &[1, 2])]), g3.sum(&[(3.0, &[2, 3]), (1.0, &[2, 1])]));
    let line = meet(&g3, &p, &q);
    assert!(distance(&line, &g3.sum(&[(1.0, &[2])])) <= 4.0 * EPS, "{line:?}");
    assert!(distance(&join(&g3, &p, &q), &g3.sum(&[(1.0, &[1, 2, 3])])) <= 4.0 * EPS);
    let vee = g3.calculus.vee(&p, &q);
    assert!(distance(&scaled(&line, norm(&vee)), &vee) <= 8.0 * EPS * norm(&vee), "{vee:?}");
    // Nothing in common: the wedge. One in the other: the orientations given.
    let e3 = g3.sum(&[(-5.0, &[3])]);
    assert!(distance(&join(&g3, &p, &e3), &g3.sum(&[(-1.0, &[1, 2, 3])])) <= 4.0 * EPS);
    assert_eq!(meet(&g3, &p, &e3), g3.scalar(1.0));
    assert!(distance(&meet(&g3, &p, &scaled(&a, -1.0)), &scaled(&unit, -1.0)) <= 4.0 * EPS);
    assert!(distance(&join(&g3, &scaled(&a, -1.0), &p), &g3.sum(&[(1.0, &[1, 2])])) <= 4.0 * EPS);
    // A metric plays no part.
    let projective = Space::new(2, 0, 2);
    let (p, q) = (projective.sum(&[(1.0, &[1, 3])]), projective.sum(&[(1.0, &[3, 4])]));
    assert_eq!(
        meet(&projective, &p, &q).iter().map(|x| x.abs()).collect::<Vec<_>>(),
        projective.sum(&[(1.0, &[3])])
    );
    // Directions nearer than the tolerance are the same.
    let near = |e: f64| join(&g3, &g3.sum(&[(1.0, &[1])]), &g3.sum(&[(1.0, &[1]), (e, &[2])]));
    assert!(distance(&near(1e-11), &g3.sum(&[(1.0, &[1])])) <= 1e-10);
    assert!(distance(&near(1e-9), &g3.sum(&[(1.0, &[1, 2])])) <= 1e-6);
    let g4 = Space::new(4, 0, 0);
    let mixed = g4.sum(&[(1.0, &[1, 2]), (1.0, &[3, 4])]);
    assert!(matches!(g4.calculus.join(&mixed, &g4.scalar(1.0)), Err(MathError::NotBlade { .. })));
    assert_eq!(g4.calculus.meet(&g4.scalar(0.0), &mixed), Err(MathError::NoSubspace));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// `A = A'∧M`, `B = M∧B'` give J and M back for vectors in general position; where they span the
    /// space, M lies along `A∨B`.
    #[test]
    fn join_and_meet_take_blades_apart(x in numbers()) {
        for (n, common, left, right) in [(4, 1, 1, 2), (5, 2, 1, 1), (5, 1, 2, 2), (6, 2, 2, 1), (4, 2, 1, 1)] {
            let space = Space::new(n, 0, 0);
            let vectors: Vec<Vec<f64>> = x.chunks_exact(n).map(|c| space.of_grade(1, c)).collect();
            let wedge = |list: &[Vec<f64>]| list.iter().fold(space.scalar(1.0), |w, v| space.wedge(&w, v));
            let shared = wedge(&vectors[..common]);
            let a = space.wedge(&wedge(&vectors[common..common + left]), &shared);
            let b = space.wedge(&shared, &wedge(&vectors[common + left..common + left + right]));
            let j = space.wedge(&a, &wedge(&vectors[common + left..common + left + right]));
            // Vectors that nearly depend on each other are not known well.
            prop_assume!(norm(&j) > 0.05);
            let (join, meet) = (space.calculus.join(&a, &b).unwrap(), space.calculus.meet(&a, &b).unwrap());
            let sign = j.iter().zip(&join).map(|(a, b)| a * b).sum::<f64>().signum();
            prop_assert!(distance(&scaled(&join, sign * norm(&j)), &j) <= 1e-12 * norm(&j));
            prop_assert!(distance(&scaled(&meet, sign * norm(&shared)), &shared) <= 1e-12 * norm(&shared));
            // Of the largest components the first, here the only one, is positive.
            let largest = join.iter().copied().fold(0.0, |a: f64, x| if x.abs() > a.abs() { x } else { a });
            prop_assert!(largest > 0.0, "{join:?}");
            if common + left + right == n {
                let vee = space.calculus.vee(&a, &b);
                prop_assert!(distance(&scaled(&meet, norm(&vee)), &vee) <= 1e-12 * norm(&vee));
            }
        }
    }

    /// If A contains B, J = A and M = B, and the same with A and B exchanged.
    #[test]
    fn a_subspace_of_another_is_their_meet(x in numbers()) {
        for (n, inner, outer) in [(3, 1, 2), (4, 1, 3), (4, 2, 3), (5, 2, 4), (3, 1, 3)] {
            let space = Space::new(n, 0, 0);
            let vectors: Vec<Vec<f64>> = x.chunks_exact(n).map(|c| space.of_grade(1, c)).collect();
            let wedge = |list: &[Vec<f64>]| list.iter().fold(space.scalar(1.0), |w, v| space.wedge(&w, v));
            let [part, whole] = [inner, outer].map(|k| wedge(&vectors[..k]));
            // Vectors that nearly depend on each other are not known well.
            prop_assume!(norm(&part) > 0.05 && norm(&whole) > 0.05);
            for sign in [1.0, -1.0] {
                let part = scaled(&part, sign);
                for (a, b) in [(&part, &whole), (&whole, &part)] {
                    let (join, meet) = (space.calculus.join(a, b).unwrap(), space.calculus.meet(a, b).unwrap());
                    prop_assert!(distance(&scaled(&meet, norm(&part)), &part) <= 1e-12 * norm(&part), "{n} {inner}");
                    prop_assert!(distance(&scaled(&join, norm(&whole)), &whole) <= 1e-12 * norm(&whole), "{n} {inner}");
                }
            }
        }
    }
}

#[test]
fn the_dual_divides_by_the_pseudoscalar() {
    for (p, q, r) in signatures(5) {
        let space = Space::new(p, q, r);
        let mut pseudoscalar = space.scalar(0.0);
        pseudoscalar[space.size() - 1] = 1.0;
        let m: Vec<f64> = (0..space.size()).map(|i| i as f64 - 2.5).collect();
        assert_eq!(space.calculus.undual(&m), space.product(&m, &pseudoscalar));
        match space.calculus.dual(&m) {
            Ok(dual) => assert_eq!(space.product(&dual, &pseudoscalar), m),
            Err(error) => assert!(r > 0 && error == MathError::DegenerateMetric, "{p} {q} {r}"),
        }
    }
}
