//! What holds for every element and signature: axioms, errors, grades.

use crate::space::*;
use polhode_ga::Multivector;
use polhode_ga::error::MathError;
use polhode_ga::g3::functions::Function;
use polhode_ga::product::Grades;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// `M M⁻¹ = 1` to a few ulps of the condition number, at any size.
    #[test]
    fn the_inverse_undoes(x in numbers(), e in -200.0..200.0f64) {
        let size = 10f64.powf(e);
        for (p, q, r) in signatures(5).chain([(6, 0, 0), (3, 3, 1)]) {
            let space = Space::new(p, q, r);
            let mut regular = scaled(&x[..space.size()], 0.5 / space.size() as f64);
            regular[0] += 1.0;
            prop_assert!(space.calculus.inverse(&scaled(&regular, size)).is_ok());
            for m in [regular, x[..space.size()].to_vec()] {
                let m = scaled(&m, size);
                let Ok(inverse) = space.calculus.inverse(&m) else { continue };
                let condition = norm(&m) * norm(&inverse) * (space.size() as f64).sqrt();
                let one = space.scalar(1.0);
                let right = distance(&space.product(&m, &inverse), &one);
                let left = distance(&space.product(&inverse, &m), &one);
                prop_assert!(right <= 8.0 * EPS * condition, "{p} {q} {r}: {right:e} {condition}");
                // The error of X is that of MX − 1 times the condition, and XM − 1 feels it.
                prop_assert!(left <= 8.0 * EPS * condition * condition, "{p} {q} {r}: {left:e} {condition}");
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
            let error = distance(&log, &b) / norm(&b);
            prop_assert!(error <= 64.0 * EPS, "{p} {q} {r}: {error:e}");
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
                // Boosts so large that the size is lost, or the rotation beside them.
                Err(MathError::NoLogarithm | MathError::NotVersor { .. }) => continue,
                Err(MathError::NoBivectorLogarithm) if (p, q) == (2, 2) && norm(&m) > 10f64.powf(size + 3.0) => {
                    continue;
                }
                Err(e) => return Err(TestCaseError::fail(format!("{p} {q} {r}: {e}"))),
            };
            let back = space.calculus.exp(&log).unwrap();
            // A rounded versor |R| times its size tells that size to ε|R|² only. Near a whole turn in one
            // half of a rotor of Cl(4, 1) or Cl(2, 2) the check of the logarithm is the bound.
            let length = norm(&m) / space.product(&m, &space.reverse(&m))[0].abs().sqrt();
            let checked = 1e-12 * (1.0 + norm(&log)) + 32.0 * EPS * length;
            let ulps = 64.0 * EPS * (1.0 + norm(&log)) * (1.0 + length);
            let bound = if p + q + r < 5 && (p, q) != (2, 2) { ulps } else { checked };
            let error = distance(&back, &m) / norm(&m);
            prop_assert!(error <= bound, "{p} {q} {r}: {error:e} {bound:e}");
        }
    }

    /// Turned planes: `exp(S B ~S) = S exp(B) ~S` with the closed form of basis planes.
    #[test]
    fn turned_planes_have_the_closed_form(
        x in numbers(),
        u in -40.0..40.0f64,
        v in -40.0..40.0f64,
        e in -15.0..0.0f64,
    ) {
        let space = Space::new(5, 0, 0);
        let s = space.calculus.exp(&space.of_grade(2, &x)).unwrap();
        // Generic, nearly and fully isoclinic, nearly simple.
        for v in [v, u * (1.0 + 10f64.powf(e)), u, 10f64.powf(e)] {
            let b = space.sum(&[(u, &[1, 2]), (v, &[3, 4])]);
            let first = space.sum(&[(u.cos(), &[]), (u.sin(), &[1, 2])]);
            let exp = space.product(&first, &space.sum(&[(v.cos(), &[]), (v.sin(), &[3, 4])]));
            let turn = |m: &[f64]| space.product(&space.product(&s, m), &space.reverse(&s));
            let error = distance(&space.calculus.exp(&turn(&b)).unwrap(), &turn(&exp));
            // The turned plane is rounded, relative to its size.
            prop_assert!(error <= 16.0 * EPS * (1.0 + norm(&b)), "{u} {v} {error:e}");
        }
    }
}

/// In G3 the functions of `functions` are another way to the same values.
#[test]
fn g3_has_one_set_of_functions() {
    let space = Space::new(3, 0, 0);
    let m = [0.7, 0.2, -1.3, 0.4, 1.1, -0.6, 0.9, 0.3];
    let even = [0.7, 0.0, 0.0, 0.0, 1.1, -0.6, 0.9, 0.0];
    for (f, m) in [(Function::Inverse, m), (Function::Exp, m), (Function::Log, even), (Function::Sqrt, even)]
    {
        let ours = space.calculus.apply(f, &m).unwrap();
        let theirs = f.apply(Multivector(m)).unwrap().0;
        assert!(distance(&ours, &theirs) <= 16.0 * EPS * norm(&theirs), "{f:?} {ours:?} {theirs:?}");
    }
}

/// Odd elements, of all odd grades, and elements near a versor: `M X = 1` to rounding.
#[test]
fn odd_and_nearly_simple_elements_have_their_inverse() {
    for (p, q, r) in [(3, 0, 0), (4, 0, 0), (1, 3, 0), (3, 0, 1), (5, 0, 0), (2, 2, 1)] {
        let space = Space::new(p, q, r);
        let blades = space.algebra.blades();
        let general: Vec<f64> = (0..space.size()).map(|i| (3.7 * i as f64 + 0.4).sin()).collect();
        let odd: Vec<f64> =
            (0..space.size()).map(|i| if blades[i].grade() % 2 == 1 { general[i] } else { 0.0 }).collect();
        let versor = space.sum(&[(3.0, &[1]), (0.5, &[2])]);
        let near: Vec<f64> = versor.iter().zip(&general).map(|(v, x)| v + 1e-9 * x).collect();
        for m in [odd, near] {
            let inverse = space.calculus.inverse(&m).unwrap();
            let error = distance(&space.product(&m, &inverse), &space.scalar(1.0));
            let condition = norm(&m) * norm(&inverse) * (space.size() as f64).sqrt();
            assert!(error <= 4.0 * EPS * condition, "{p} {q} {r} {error:e}");
        }
    }
    // A nearly null vector with a small part beside it, by which no conjugate makes it a number.
    let space = Space::new(1, 1, 0);
    let m = space.sum(&[(1.0, &[1]), (1.0 - 1e-4, &[2]), (1e-6, &[1, 2]), (1e-6, &[])]);
    let inverse = space.calculus.inverse(&m).unwrap();
    assert!(
        distance(&space.product(&m, &inverse), &space.scalar(1.0)) <= 8.0 * EPS * norm(&m) * norm(&inverse)
    );
}

/// `(s + e1)⁻¹ = (s − e1)/(s² − 1)`, of condition `(1 + s)/(1 − s)`: an error where rounding may have made it up.
#[test]
fn nearly_singular_elements_are_an_error() {
    let space = Space::new(3, 0, 0);
    let with = |gap: f64| space.calculus.inverse(&space.sum(&[(1.0 - gap, &[]), (1.0, &[1])]));
    for gap in [EPS, 2.0 * EPS] {
        let error = with(gap).unwrap_err();
        assert!(
            matches!(error, MathError::IllConditioned { reciprocal_condition: c } if (c / (0.5 * gap) - 1.0).abs() < 1e-6),
            "{error:?} {gap:e}"
        );
    }
    let gap = 2f64.powi(-40);
    let (inverse, square) = (with(gap).unwrap(), (gap - 2.0) * gap);
    let expected = space.sum(&[((1.0 - gap) / square, &[]), (-1.0 / square, &[1])]);
    assert!(distance(&inverse, &expected) <= 4.0 * EPS * norm(&expected) / gap);
}

/// Where the principal logarithm ends: a whole turn in a plane, alone or with what commutes with it.
#[test]
fn what_has_no_value_is_an_error() {
    let spacetime = Space::new(1, 3, 0);
    let projective = Space::new(3, 0, 1);
    for scale in [1e-200, 1.0 / 3.0, 1e200] {
        for (space, terms) in [
            (&spacetime, vec![(scale, &[1][..]), (scale, &[2][..])]),
            (&spacetime, vec![(scale, &[][..]), (scale, &[1][..])]),
            (
                &spacetime,
                vec![
                    (scale, &[][..]),
                    (scale, &[1, 2][..]),
                    (0.3 * scale, &[3][..]),
                    (0.3 * scale, &[1, 2, 3][..]),
                ],
            ),
            (&projective, vec![(scale, &[4][..])]),
            (&projective, vec![(scale, &[4, 1][..]), (1.0, &[1, 2, 3, 4][..])]),
            (&spacetime, vec![]),
        ] {
            let error = space.calculus.inverse(&space.sum(&terms)).unwrap_err();
            assert!(
                matches!(error, MathError::IllConditioned { reciprocal_condition: c } if c < 1e-14),
                "{error}"
            );
        }
        // A far translation has an inverse all the same, and so has a small number beside it.
        let motor = projective.sum(&[(scale, &[]), (1e10 * scale, &[4, 1])]);
        let inverse = projective.calculus.inverse(&motor).unwrap();
        let expected = projective.sum(&[(1.0 / scale, &[]), (-1e10 / scale, &[4, 1])]);
        assert!(distance(&inverse, &expected) <= 4.0 * EPS * norm(&expected));
    }
    let nearly = spacetime.calculus.inverse(&spacetime.sum(&[(1.0, &[]), (1.0 - 1e-10, &[1])])).unwrap();
    assert!((nearly[0] * 2e-10 - 1.0).abs() < 1e-5);
    let log = |space: &Space, terms: &[(f64, &[usize])]| space.calculus.log(&space.sum(terms));
    assert_eq!(log(&spacetime, &[]), Err(MathError::NoLogarithm));
    assert!(matches!(log(&spacetime, &[(1.0, &[1])]), Err(MathError::NotVersor { .. })));
    assert!(matches!(log(&spacetime, &[(1.0, &[]), (0.5, &[1, 2, 3, 4])]), Err(MathError::NotVersor { .. })));
    assert_eq!(spacetime.calculus.sqrt(&spacetime.scalar(0.0)).unwrap(), spacetime.scalar(0.0));
    for f in [Function::Inverse, Function::Exp, Function::Log, Function::Sqrt] {
        assert_eq!(spacetime.calculus.apply(f, &spacetime.scalar(f64::NAN)), Err(MathError::NotFinite));
        assert_eq!(spacetime.calculus.apply(f, &spacetime.scalar(f64::INFINITY)), Err(MathError::NotFinite));
    }
    assert_eq!(
        spacetime.calculus.exp(&spacetime.sum(&[(1e16, &[1, 2]), (1e16, &[3, 4])])),
        Err(MathError::AngleTooLarge)
    );
    assert_eq!(projective.calculus.dual(&projective.scalar(1.0)), Err(MathError::DegenerateMetric));
}

/// Any element: `exp M exp(−M) = 1`, and the derivative rule `exp(M/2)² = exp M`.
#[test]
fn the_exponential_of_any_element() {
    for (p, q, r) in signatures(5).chain([(6, 0, 0), (3, 3, 1)]) {
        let space = Space::new(p, q, r);
        let m: Vec<f64> =
            (0..space.size()).map(|i| (7.3 * i as f64 + 1.0).sin() * 2.0 / space.size() as f64).collect();
        let [exp, inverse, half] = [1.0, -1.0, 0.5].map(|x| space.calculus.exp(&scaled(&m, x)).unwrap());
        let product = space.product(&exp, &inverse);
        assert!(
            distance(&product, &space.scalar(1.0)) <= 16.0 * EPS * norm(&exp) * norm(&inverse),
            "{p} {q} {r}"
        );
        assert!(
            distance(&space.product(&half, &half), &exp) <= 16.0 * EPS * norm(&half).powi(2),
            "{p} {q} {r}"
        );
    }
}

/// Values keep to the grades that their types foretell.
#[test]
fn values_keep_to_their_grades() {
    let functions = [Function::Inverse, Function::Exp, Function::Log, Function::Sqrt];
    for (p, q, r) in signatures(5).chain([(6, 0, 0)]) {
        let space = Space::new(p, q, r);
        let blades = space.algebra.blades();
        for grades in 1..1u16 << (p + q + r + 1) {
            let grades = Grades(grades);
            let component = |i: usize| (3.7 * i as f64 + 0.4).sin();
            let of = |i: usize| if grades.contains(blades[i].grade()) { component(i) } else { 0.0 };
            let m: Vec<f64> = (0..space.size()).map(of).collect();
            for f in functions {
                let kept = space.calculus.grades(f, grades);
                let Ok(value) = space.calculus.apply(f, &m) else { continue };
                let stray: Vec<f64> = (0..space.size())
                    .filter(|&i| !kept.contains(blades[i].grade()))
                    .map(|i| value[i])
                    .collect();
                let condition = norm(&m) * norm(&value);
                assert!(
                    norm(&stray) <= 64.0 * EPS * norm(&value) * (1.0 + condition),
                    "{p} {q} {r} {grades:?} {f:?} {stray:?}"
                );
            }
        }
    }
    // The inverse of a bivector is one while its square has only one part besides the scalar, and so are three planes'.
    for n in 2..8 {
        let kept = if n <= 5 { Grades::BIVECTOR } else { Grades(0x55 & ((1 << (n + 1)) - 1)) };
        assert_eq!(Space::new(n, 0, 0).calculus.grades(Function::Inverse, Grades::BIVECTOR), kept, "{n}");
    }
    let projective = Space::new(3, 0, 1).calculus;
    assert_eq!(projective.grades(Function::Exp, Grades(0b100)), Grades(0b10101));
    assert_eq!(projective.grades(Function::Log, Grades(0b10101)), Grades(0b101));
    assert_eq!(projective.grades(Function::Inverse, Grades(0b10)), Grades(0b10));
}

/// A number added to M is a factor, however small: `exp(s + V) = e^s exp V`.
#[test]
fn scalars_become_factors() {
    for (p, q, r) in [(3, 0, 0), (1, 3, 0), (3, 0, 1), (2, 2, 0), (4, 1, 0), (6, 0, 0)] {
        let space = Space::new(p, q, r);
        let general: Vec<f64> = (0..space.size()).map(|i| (7.3 * i as f64 + 1.0).sin()).collect();
        for mut v in [general.clone(), space.of_grade(2, &general), space.of_grade(1, &general)] {
            v[0] = 0.0;
            let exp = space.calculus.exp(&v).unwrap();
            for s in [-600.0, -50.0, 1.0, 300.0] {
                v[0] = s;
                let expected = scaled(&exp, f64::exp(s));
                let error = distance(&space.calculus.exp(&v).unwrap(), &expected);
                // The exponent of a boost is s added to a number, and rounded.
                assert!(error <= (8.0 + s.abs()) * EPS * norm(&expected), "{p} {q} {r} {s}");
            }
        }
    }
    // Neither factor of e^(−720) e^(710) is in range with all its digits, the product is.
    let spacetime = Space::new(1, 3, 0);
    let exp =
        spacetime.calculus.exp(&spacetime.sum(&[(-720.0, &[]), (710.0, &[1, 2]), (1.0, &[3, 4])])).unwrap();
    assert!((exp[0] / (0.5 * f64::exp(-10.0) * f64::cos(1.0)) - 1.0).abs() <= 2.0 * EPS * 710.0, "{exp:?}");
}

/// Vectors, their complements and pseudoscalars square to numbers in any metric, and planes generate the even elements; so
/// their exponentials have no other grades. These sets are the smallest, for each grade occurs.
#[test]
fn exponentials_of_blades_have_two_grades() {
    for (p, q, r) in signatures(6).filter(|(p, q, r)| p + q + r > 2) {
        let (calculus, n) = (Space::new(p, q, r).calculus, p + q + r);
        let set = |grades: &[usize]| Grades(grades.iter().fold(0, |set, k| set | 1 << k));
        for k in [1, n - 1, n] {
            assert_eq!(calculus.grades(Function::Exp, set(&[k])), set(&[0, k]), "grade {k} of {p}, {q}, {r}");
        }
        let even: Vec<usize> = (0..=n).step_by(2).collect();
        let odd: Vec<usize> = (1..=n).step_by(2).collect();
        assert_eq!(calculus.grades(Function::Sqrt, set(&[0, 2])), set(&even));
        assert_eq!(calculus.grades(Function::Exp, set(&[0, 2])), set(if n == 3 { &[0, 2] } else { &even }));
        assert_eq!(calculus.grades(Function::Log, set(&[0, 2])), set(&[0, 2]));
        if n > 3 {
            assert_eq!(calculus.grades(Function::Inverse, set(&[1, 3])), set(&odd));
        }
    }
}
