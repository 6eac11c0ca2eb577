//! exp, log, square root and inverse of multivectors of 3-d space: closed forms, grades, and the edge of the singular.

use polhode_ga::g3::functions::Function;
use polhode_ga::product::Grades;
use polhode_ga::{MathError, Multivector};
use proptest::prelude::*;
use std::f64::consts::PI;

const EPS: f64 = f64::EPSILON;

fn close(a: Multivector, b: Multivector, roundings: f64) -> bool {
    (a - b).norm() <= roundings * EPS * (1.0 + b.norm())
}

fn element(parts: &[(usize, f64)]) -> Multivector {
    let mut m = Multivector::default();
    parts.iter().for_each(|&(k, x)| m.0[k] = x);
    m
}

/// Places of the components.
const E1: usize = 1;
const E2: usize = 2;
const E3: usize = 3;
const E23: usize = 4;
const E12: usize = 6;
const I: usize = 7;

/// `N = e1 + e1e2` squares to zero, so every series ends after its second term.
#[test]
fn functions_of_nilpotent_elements_are_linear() {
    let one = Multivector::scalar(1.0);
    for size in [1e-200, 1e-8, 1.0, 1e3] {
        let n = element(&[(E1, size), (E12, size)]);
        assert_eq!(n * n, Multivector::default());
        assert_eq!(n.exp(), Ok(one + n));
        assert!(close((one + n * 0.5).log().unwrap(), n * 0.5, 8.0), "{size}");
        assert_eq!(n.sqrt(), Err(MathError::NoSquareRoot));
        assert_eq!(n.log(), Err(MathError::NoLogarithm));
        assert_eq!(n.inverse(), Err(MathError::Singular { ratio: 0.0 }));
    }
}

/// Vectors square to positive numbers, `I` and planes to negative ones; `I` commutes with all.
#[test]
fn exponentials_have_their_closed_forms() {
    // e⁻⁸⁰⁰ and cosh 800 leave the range, but the eigenvalues e⁰ and e⁻¹⁶⁰⁰ of exp do not.
    assert!(close(element(&[(0, -800.0), (E1, 800.0)]).exp().unwrap(), element(&[(0, 0.5), (E1, 0.5)]), 4.0));
    for x in [-3.0, -0.7, 1e-9, 0.4, 2.5] {
        let (cosh, sinh) = (f64::cosh(x), f64::sinh(x));
        assert!(close(element(&[(E1, x)]).exp().unwrap(), element(&[(0, cosh), (E1, sinh)]), 8.0));
        let (sin, cos) = f64::sin_cos(x);
        assert!(close(element(&[(I, x)]).exp().unwrap(), element(&[(0, cos), (I, sin)]), 8.0));
        let e = f64::exp(0.5);
        let even = element(&[(0, e * cos), (E23, e * sin)]);
        assert!(close(element(&[(0, 0.5), (E23, x)]).exp().unwrap(), even, 8.0));
        // exp(I/2 + x e2e3) = exp(I/2) exp(x e2e3).
        let product = element(&[(0, f64::cos(0.5)), (I, f64::sin(0.5))]) * element(&[(0, cos), (E23, sin)]);
        assert!(close(element(&[(I, 0.5), (E23, x)]).exp().unwrap(), product, 8.0));
    }
}

/// The logarithm of `cosh t + sinh t e1` is `t e1`, to rounding of `t` itself.
#[test]
fn logarithms_near_one_keep_their_digits() {
    for t in [1e-300, 1e-16, 1e-10, 1e-5, 0.1, 0.5, 1.0] {
        let log = element(&[(0, f64::cosh(t)), (E1, f64::sinh(t))]).log().unwrap();
        assert!((log.0[E1] / t - 1.0).abs() <= 16.0 * EPS, "{t}: {log:?}");
    }
}

/// Their eigenvalues, near `−1 ± 0.1 i`, lie on both sides of the cut of the logarithm.
#[test]
fn logarithms_across_the_cut_invert_exponentials() {
    for odd in [0.01, -0.05] {
        let m = element(&[(0, -1.0), (E23, 0.1), (E2, odd)]);
        let log = m.log().unwrap();
        assert!(close(log.exp().unwrap(), m, 64.0), "{log:?}");
        assert!(log.0[E23].abs() > 2.0, "half a turn is part of it: {log:?}");
    }
    assert!(close(element(&[(0, -1.0)]).log().unwrap(), element(&[(E12, PI)]), 4.0));
}

/// Their eigenvalues `−1 ± size (1 + I)` lie on both sides of the cut of the root, and the roots of these nearly cancel. V is a
/// number times e3, so that the root is as large as those: its square differs by a few roundings.
#[test]
fn roots_across_the_cut_square_to_their_argument() {
    for size in [0.1, 1e-3, 1e-6, 1e-9, 1e-12] {
        for m in [
            element(&[(0, -1.0), (E3, size), (E12, size)]),
            element(&[(0, -1.0), (E3, -size), (E12, -size), (I, -size)]) * 2000.0,
        ] {
            let root = m.sqrt().unwrap();
            assert!(close(root * root, m, 32.0), "{m:?}: {root:?}");
            assert!(root.0[0] > 0.0, "the principal root: {root:?}");
        }
    }
}

/// Scaled so that the largest component is in [1, 2), `1 + (1 − δ) e1` has the eigenvalues δ and 2 − δ. Their product over
/// the squared norm is δ to first order.
#[test]
fn elements_that_are_singular_to_rounding_are_rejected() {
    let near_null = |delta: f64| element(&[(0, 1.0), (E1, 1.0 - delta)]);
    for scale in [1e-200, 1.0, 1e200] {
        let Err(MathError::Singular { ratio }) = (near_null(4.0 * EPS) * scale).inverse() else {
            panic!("an inverse of rounding errors")
        };
        assert!((ratio - 4.0 * EPS).abs() <= 2.0 * EPS, "{ratio}");
        assert!(near_null(64.0 * EPS).inverse().is_ok());
        assert_eq!((near_null(20.0 * EPS) * scale).log(), Err(MathError::NoLogarithm));
        assert!(near_null(64.0 * EPS).log().is_ok());
        // ζ + N with N² = 0 has the double eigenvalue ζ: its root is √ζ + N/(2√ζ).
        let nilpotent = element(&[(E1, 1.0), (E12, 1.0)]);
        let near_nilpotent = (Multivector::scalar(2.0 * EPS) + nilpotent) * scale;
        assert_eq!(near_nilpotent.sqrt(), Err(MathError::NoSquareRoot));
    }
    let root = (Multivector::scalar(0.1) + element(&[(E1, 1.0), (E12, 1.0)])).sqrt().unwrap();
    assert!(close(root * root, element(&[(0, 0.1), (E1, 1.0), (E12, 1.0)]), 32.0));
}

#[test]
fn values_that_are_not_finite_are_rejected() {
    for bad in [f64::NAN, f64::INFINITY] {
        for k in 0..8 {
            let m = Multivector::scalar(1.0) + element(&[(k, bad)]);
            for function in [Function::Inverse, Function::Exp, Function::Log, Function::Sqrt] {
                assert_eq!(function.apply(m), Err(MathError::NotFinite), "{function:?} of {m:?}");
            }
        }
    }
    assert_eq!(element(&[(0, 800.0)]).exp(), Err(MathError::Overflow));
    assert_eq!(element(&[(E1, 1e-310)]).inverse(), Err(MathError::Overflow));
}

proptest! {
    /// The error of a root relative to it is half the relative error of its square, over its condition.
    #[test]
    fn the_square_of_the_root_returns(c in prop::array::uniform8(-10.0..10.0f64), even: bool, e in -140.0..140.0f64) {
        let mut m = Multivector(c) * 10f64.powf(e);
        if even {
            [1, 2, 3, 7].iter().for_each(|&k| m.0[k] = 0.0);
        }
        if let (Ok(root), Ok(inverse)) = (m.sqrt(), m.inverse()) {
            let condition = m.norm() * inverse.norm();
            prop_assert!((root * root - m).norm() <= 32.0 * EPS * condition * m.norm());
        }
    }

    /// For all sets of grades, the value has none but those that are announced; a number stays one.
    #[test]
    fn values_keep_the_grades_that_are_announced(c in prop::array::uniform8(-2.0..2.0f64)) {
        for grades in (1..16).map(Grades) {
            let part = |k: usize| if grades.0 >> k & 1 == 1 { Multivector(c).grade(k) } else { Multivector::default() };
            let m = (0..4).map(part).fold(Multivector::default(), |sum, part| sum + part);
            for function in [Function::Inverse, Function::Exp, Function::Log, Function::Sqrt] {
                let Ok(value) = function.apply(m) else { continue };
                let announced = function.grades(grades);
                for k in (0..4).filter(|k| announced.0 >> k & 1 == 0) {
                    prop_assert!(value.grade(k).norm() <= 64.0 * EPS * value.norm(), "{:?} {:?}", function, grades);
                }
            }
        }
        prop_assert_eq!(Function::Exp.grades(Grades::SCALAR), Grades::SCALAR);
        prop_assert_eq!(Function::Exp.grades(Grades(0b0100)), Grades(0b0101), "turns are even");
    }
}
