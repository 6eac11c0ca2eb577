//! Logarithms and roots of versors as rounding leaves them: in null parts, in large ones, in single precision.

use crate::space::*;
use polhode_ga::error::MathError;
use proptest::prelude::*;

/// Algebras with null generators, up to seven generators.
const DEGENERATE: [(usize, usize, usize); 9] =
    [(2, 0, 1), (3, 0, 1), (1, 1, 1), (1, 3, 1), (4, 0, 1), (2, 0, 2), (3, 0, 2), (5, 0, 1), (6, 0, 1)];

fn exp(space: &Space, b: &[f64]) -> Vec<f64> {
    space.calculus.exp(b).unwrap()
}

/// The parts without and with null generators, which have the last numbers.
fn split(space: &Space, r: usize, m: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = space.algebra.signature().generators();
    let has_null = |i: usize| space.algebra.blades()[i].bits >> (n - r) != 0;
    let part = |wanted: bool| (0..m.len()).map(|i| if has_null(i) == wanted { m[i] } else { 0.0 }).collect();
    (part(false), part(true))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    /// `~M M` is 1 to rounding, and so is its root; its logarithm is that rounding, at most `ε|M|²` by sums
    /// of 2ⁿ products. So it is of translations so far that their rounding is larger than 1e-12, but below √ε.
    #[test]
    fn what_cancels_leaves_rounding(x in numbers(), e in -3.0..4.0f64) {
        for (p, q, r) in DEGENERATE {
            let space = Space::new(p, q, r);
            let b = space.of_grade(2, &x);
            let (turn, far) = split(&space, r, &b);
            let motor = space.product(&exp(&space, &turn), &exp(&space, &scaled(&far, 10f64.powf(e / r as f64))));
            let one = space.product(&space.reverse(&motor), &motor);
            let bound = space.size() as f64 * EPS * (1.0 + norm(&motor).powi(2));
            let log = space.calculus.log(&one);
            prop_assert!(log.is_ok(), "{p} {q} {r} {log:?}");
            prop_assert!(norm(&log.unwrap()) <= bound, "{p} {q} {r}");
            let root = space.calculus.sqrt(&one).unwrap();
            prop_assert!(distance(&root, &space.scalar(1.0)) <= bound, "{p} {q} {r}");
        }
    }

    /// Noise in the null parts of a rotor, at and below its rounding: the logarithm of the rotor, and noise.
    #[test]
    fn noise_in_the_null_parts_leaves_the_rotor_alone(x in numbers(), y in numbers(), e in 13.0..300.0f64) {
        for (p, q, r) in DEGENERATE {
            let space = Space::new(p, q, r);
            let turn = split(&space, r, &space.of_grade(2, &x)).0;
            let b = scaled(&turn, 1.0 / (1.0 + norm(&turn)));
            let blades = space.algebra.blades();
            let even: Vec<f64> =
                (0..space.size()).map(|i| if blades[i].grade().is_multiple_of(2) { y[i] } else { 0.0 }).collect();
            let noise = scaled(&split(&space, r, &even).1, 10f64.powf(-e));
            let rotor: Vec<f64> = exp(&space, &b).iter().zip(&noise).map(|(a, b)| a + b).collect();
            let log = space.calculus.log(&rotor);
            prop_assert!(log.is_ok(), "{p} {q} {r} {log:?}");
            let (kept, left) = split(&space, r, &log.unwrap());
            prop_assert!(distance(&kept, &b) <= 64.0 * EPS * norm(&b), "{p} {q} {r}");
            // The derivative of log in the null parts is that of turns below 1 radian, of a few planes.
            prop_assert!(norm(&left) <= 8.0 * norm(&rotor) * norm(&noise), "{p} {q} {r}");
            let root = space.calculus.sqrt(&rotor).unwrap();
            let half = exp(&space, &scaled(&b, 0.5));
            prop_assert!(distance(&split(&space, r, &root).0, &half) <= 64.0 * EPS * norm(&half));
        }
    }

    /// Null parts that are off by more than rounding, but by less than half of the digits, are of the nearest versor.
    #[test]
    fn null_parts_of_half_the_digits_belong_to_a_versor(x in numbers(), y in numbers(), e in 9.5..11.0f64) {
        for (p, q, r) in DEGENERATE {
            let space = Space::new(p, q, r);
            let b = space.of_grade(2, &x);
            let versor = exp(&space, &scaled(&b, 1.0 / (1.0 + norm(&b))));
            let blades = space.algebra.blades();
            let even: Vec<f64> =
                (0..space.size()).map(|i| if blades[i].grade().is_multiple_of(2) { y[i] } else { 0.0 }).collect();
            let noise = split(&space, r, &even).1;
            // All is of size 1 to 3, and the change of the nearest versor not above that of the null parts.
            let noise = scaled(&noise, 10f64.powf(-e) / (1.0 + norm(&noise)));
            let m: Vec<f64> = versor.iter().zip(&noise).map(|(a, b)| a + b).collect();
            let log = space.calculus.log(&m);
            prop_assert!(log.is_ok(), "{p} {q} {r} {log:?}");
            let error = distance(&exp(&space, &log.unwrap()), &m);
            prop_assert!(error <= 8.0 * norm(&versor) * norm(&noise), "{p} {q} {r} {error:e}");
        }
    }

    /// `−S exp(B) ~S` with a boost B: a half turn, in a plane across that of B, commutes with it.
    #[test]
    fn minus_a_boost_is_a_boost_and_a_half_turn(y in numbers(), rapidity in 0.1..6.0f64) {
        for (p, q) in [(3, 1), (4, 1), (1, 3)] {
            let space = Space::new(p, q, 0);
            let moved = exp(&space, &scaled(&space.of_grade(2, &y), 0.5));
            let last: &[usize] = &[1, p + q];
            let boost = space.sum(&[(-rapidity.cosh(), &[]), (-rapidity.sinh(), last)]);
            let m = space.product(&space.product(&moved, &boost), &space.reverse(&moved));
            prop_assume!(norm(&m) < 300.0);
            undone(&space, &m, 1.0)?;
        }
    }

    /// `s S exp(B) ~S`, large by the boost S, with logarithms to the documented size.
    #[test]
    fn large_versors_times_a_number(x in numbers(), y in numbers(), size in 0.1..10.0f64) {
        for (p, q, r) in [(2, 2, 0), (3, 1, 0), (1, 2, 0), (1, 3, 0), (4, 1, 0), (3, 2, 0), (2, 1, 1)] {
            let space = Space::new(p, q, r);
            let [turned, bivector] = boosted(&space, &x, &y);
            prop_assume!(norm(&turned) < 300.0 && norm(&bivector) < 1000.0);
            for size in [1.0, size] {
                undone(&space, &scaled(&turned, size), size)?;
            }
        }
    }

    /// Components rounded to float32: in single precision a versor, in double precision not.
    #[test]
    fn single_precision_has_its_own_rounding(x in numbers(), size in 0.1..2.0f64) {
        let eps = f64::from(f32::EPSILON);
        for (p, q, r) in NAMED.into_iter().chain(DEGENERATE) {
            let space = Space::new(p, q, r);
            let b = space.of_grade(2, &x);
            // As in `log_and_exp_undo_each_other`.
            let b = scaled(&b, size * (0.6 / norm(&b)));
            let rounded: Vec<f64> = exp(&space, &b).iter().map(|x| f64::from(*x as f32)).collect();
            let single = space.calculus.clone().rounded_to(eps);
            let log = single.log(&rounded);
            prop_assert!(log.is_ok(), "{p} {q} {r} {log:?}");
            let error = distance(&log.unwrap(), &b);
            prop_assert!(error <= 4.0 * eps * norm(&rounded).powi(2), "{p} {q} {r} {error:e}");
            let root = single.sqrt(&rounded).unwrap();
            prop_assert!(distance(&space.product(&root, &root), &rounded) <= 4.0 * eps * norm(&rounded).powi(3));
        }
    }
}

/// `exp B` and B, moved by a boost.
fn boosted(space: &Space, x: &[f64], y: &[f64]) -> [Vec<f64>; 2] {
    let b = space.of_grade(2, x);
    let boost = exp(space, &scaled(&space.of_grade(2, y), 2.0));
    [exp(space, &b), b].map(|m| space.product(&space.product(&boost, &m), &space.reverse(&boost)))
}

/// The exponential of the logarithm is the versor M of this size. The size, a difference in `M~M`, is known to `ε|R|²`, and
/// the logarithm B to that by its own size, in sums of its size squared.
fn undone(space: &Space, m: &[f64], size: f64) -> Result<(), TestCaseError> {
    let length = norm(m) / size;
    let log = space.calculus.log(m);
    prop_assert!(log.is_ok(), "{:?} {length} {log:?}", space.algebra.signature());
    let log = log.unwrap();
    let bound = 1e-12 * (1.0 + norm(&log)) + 32.0 * EPS * (length.powi(2) + norm(&log).powi(2));
    let error = distance(&exp(space, &log), m);
    prop_assert!(error <= 2.0 * bound * norm(m), "{:?} {length} {error:e}", space.algebra.signature());
    Ok(())
}

/// Bivectors of size 976 to 1228, with exponentials of size 66 to 172, whose logarithms miss by more than the size of the
/// exponential accounts for.
#[test]
fn logarithms_may_be_larger_than_their_versors() {
    let cases: [[[f64; 10]; 2]; 4] = [
        [
            [0.8, 0.6, -0.1, 0.7, 1.0, -0.9, -0.7, 0.4, 0.8, -0.4],
            [0.1, 0.3, 0.6, 0.8, 0.9, -0.8, 0.2, -0.4, 1.0, 0.2],
        ],
        [
            [1.0, 0.2, -0.7, 0.7, -1.0, 0.8, 0.3, -0.2, 0.1, -0.7],
            [0.0, 0.4, 1.0, 0.5, -0.5, -0.7, 0.8, 0.2, -0.4, 0.7],
        ],
        [
            [0.9, 0.7, -0.3, 0.4, -0.8, -0.4, -0.5, -0.8, -0.3, -0.9],
            [-0.1, 0.9, -0.3, 0.2, 0.8, 1.0, 0.5, 0.6, -0.8, 0.8],
        ],
        [
            [-0.7, 0.9, -0.1, 0.2, -0.4, -0.5, -0.7, -0.6, 0.5, -1.0],
            [-0.4, -0.6, -0.4, 0.5, 0.6, 0.9, 0.4, -0.0, 0.8, -0.3],
        ],
    ];
    let space = Space::new(3, 2, 0);
    for [x, y] in cases {
        let [versor, bivector] = boosted(&space, &x, &y);
        assert!(norm(&bivector) > 5.0 * norm(&versor));
        undone(&space, &versor, 1.0).unwrap();
    }
}

#[test]
fn what_is_not_a_versor_stays_an_error() {
    let projective = Space::new(3, 0, 1);
    let with = |e: f64| projective.sum(&[(1.0, &[]), (e, &[1, 2, 3, 4])]);
    // Below the rounding of 1 the null part is nothing; half of the digits is where it is too much.
    assert_eq!(projective.calculus.log(&with(1e-17)).unwrap(), projective.scalar(0.0));
    assert_eq!(projective.calculus.sqrt(&with(1e-300)).unwrap(), projective.scalar(1.0));
    for e in [1e-7, 1e-3, 1.0, 1e8, 1e200] {
        for m in [with(e), scaled(&with(e), 1e-50)] {
            let refused = projective.calculus.log(&m);
            assert!(
                matches!(refused, Err(MathError::NotVersor { deviation }) if deviation > 5e-8),
                "{refused:?}"
            );
        }
    }
    let single = projective.calculus.clone().rounded_to(f64::from(f32::EPSILON));
    assert_eq!(single.log(&with(1e-5)).unwrap(), projective.scalar(0.0));
    assert!(matches!(single.log(&with(1e-3)), Err(MathError::NotVersor { .. })));
    // Without a rotor there is nothing that the null parts could be of.
    let null = Space::new(2, 0, 2).sum(&[(1.0, &[1, 3]), (0.5, &[1, 4]), (0.3, &[1, 2, 3, 4])]);
    assert_eq!(Space::new(2, 0, 2).calculus.log(&null), Err(MathError::NoLogarithm));
    // Two null planes whose square is not a number.
    let planes = Space::new(2, 0, 2).sum(&[(1.0, &[1, 3]), (1.0, &[2, 4])]);
    assert_eq!(Space::new(2, 0, 2).calculus.log(&planes), Err(MathError::NoLogarithm));
    let light = Space::new(1, 1, 1).sum(&[(1.0, &[]), (1.0, &[1, 2]), (0.3, &[1, 3])]);
    assert_eq!(Space::new(1, 1, 1).calculus.log(&light), Err(MathError::NoLogarithm));
    let four = Space::new(4, 0, 0);
    let rotor = four.sum(&[(1.0, &[]), (1e-3, &[1, 2, 3, 4])]);
    let single = four.calculus.clone().rounded_to(f64::from(f32::EPSILON));
    assert!(matches!(single.log(&rotor), Err(MathError::NotVersor { .. })));
    // `M~M = 1 + 2e·e1e2e3e4 + e²`: thousands of roundings are a versor, half of the digits of a float32 are not.
    let with = |e: f64| four.sum(&[(1.0, &[]), (e, &[1, 2, 3, 4])]);
    assert!(four.calculus.log(&with(1e-13)).is_ok());
    assert!(matches!(four.calculus.log(&with(1e-11)), Err(MathError::NotVersor { .. })));
    assert!(single.log(&with(2e-5)).is_ok());
    assert!(matches!(single.log(&with(1.2e-4)), Err(MathError::NotVersor { .. })));
    assert!(projective.calculus.log(&projective.sum(&[(1e-17, &[1, 4])])).is_err());
}

/// A product of thousands of rotors, each of which rounds, still is a versor, and a large angle loosens its logarithm's check.
#[test]
fn thousands_of_products_leave_a_versor() {
    for (p, q, r) in [(4, 0, 0), (5, 0, 0), (6, 0, 0), (3, 0, 1)] {
        let space = Space::new(p, q, r);
        let planes = p * (p - 1) / 2;
        let b = space.of_grade(
            2,
            &(0..28).map(|i| if i < planes { (i as f64 + 0.3).sin() } else { 0.0 }).collect::<Vec<_>>(),
        );
        let b = scaled(&b, 2.0 / norm(&b));
        let rotor = exp(&space, &b);
        // The error of n products is at most that of each, n times; this is it at its largest.
        let worst: Vec<f64> =
            rotor.iter().enumerate().map(|(i, x)| x * (1.0 + 1e-13 * (1.7 * i as f64).sin())).collect();
        undone(&space, &worst, 1.0).unwrap();
    }
}

/// Null parts of rounding do not count in the condition of the inverse, whose own null parts they make.
#[test]
fn noise_does_not_make_a_boost_singular() {
    let space = Space::new(1, 1, 1);
    for rapidity in [5.0, 11.0, 16.0] {
        let (c, s) = (f64::cosh(rapidity), f64::sinh(rapidity));
        let boost = space.sum(&[(c, &[]), (s, &[1, 2]), (1e-17, &[1, 3]), (-1e-17, &[2, 3])]);
        let inverse = space.calculus.inverse(&boost).unwrap();
        let expected = space.sum(&[(c, &[]), (-s, &[1, 2])]);
        assert!(distance(&inverse, &expected) <= 1e-15 * (c + s) * (c + s) * c, "{rapidity}");
    }
}

/// Float32 vectors span blades to their rounding only.
#[test]
fn blades_in_single_precision() {
    let space = Space::new(5, 0, 0);
    let vector = |k: usize| -> Vec<f64> {
        space.of_grade(1, &(0..5).map(|i| ((i + 5 * k) as f64).powi(2).sin()).collect::<Vec<_>>())
    };
    let rounded = |m: Vec<f64>| -> Vec<f64> { m.iter().map(|x| f64::from(*x as f32)).collect() };
    let a = rounded(space.wedge(&vector(0), &vector(1)));
    let b = rounded(space.wedge(&vector(1), &vector(2)));
    let single = space.calculus.clone().rounded_to(f64::from(f32::EPSILON));
    let meet = single.meet(&a, &b).unwrap();
    let along = scaled(&vector(1), 1.0 / norm(&vector(1)));
    let error = distance(&meet, &along).min(distance(&meet, &scaled(&along, -1.0)));
    assert!(error <= 16.0 * f64::from(f32::EPSILON), "{error:e}");
    assert!(matches!(space.calculus.meet(&a, &b), Err(MathError::NotBlade { .. })));
}
