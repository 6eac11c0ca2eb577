//! Exponentials and logarithms with closed forms, and those at the ends of their ranges.

use crate::space::*;
use polhode_ga::error::MathError;
use std::f64::consts::PI;

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
fn closed_forms() {
    // A translation is exact at any distance.
    let projective = Space::new(3, 0, 1);
    for d in [1e-300, 1.0, 1e200] {
        let b = projective.sum(&[(0.5 * d, &[4, 1]), (-d, &[4, 3])]);
        let mut motor = b.clone();
        motor[0] = 1.0;
        assert_eq!(projective.calculus.exp(&b).unwrap(), motor);
        assert_eq!(projective.calculus.log(&motor).unwrap(), b);
    }
    // A screw along and about e3: the far translation leaves the angle alone.
    for (angle, d) in [(0.3, 1e9), (3.0, 1e-9), (1e-9, 1.0), (0.5 * PI, 2.0), (3.1, -1e4)] {
        let b = projective.sum(&[(angle, &[1, 2]), (d, &[4, 3])]);
        let (c, s) = (angle.cos(), angle.sin());
        let terms: [(f64, &[usize]); 4] = [(c, &[]), (s, &[1, 2]), (c * d, &[4, 3]), (s * d, &[1, 2, 4, 3])];
        let motor = projective.sum(&terms);
        let exp = projective.calculus.exp(&b).unwrap();
        let log = projective.calculus.log(&motor).unwrap();
        for i in 0..16 {
            // Turn and translation each have their own size.
            let size = if projective.algebra.blades()[i].bits & 0b1000 == 0 { 1.0 } else { d.abs() };
            assert!((exp[i] - motor[i]).abs() <= 8.0 * EPS * size * (1.0 + angle), "{angle} {d} {exp:?}");
            assert!((log[i] - b[i]).abs() <= 16.0 * EPS * size, "{angle} {d} {log:?}");
        }
    }
    // Parts with one null generator so small that scaling both to 1 would leave the range.
    let null = Space::new(2, 0, 2);
    let b = null.sum(&[(1e-200, &[1, 3]), (1e-250, &[2, 4])]);
    let mut motor = b.clone();
    motor[0] = 1.0;
    assert_eq!(null.calculus.exp(&b).unwrap(), motor);
    assert_eq!(null.calculus.log(&motor).unwrap(), b);
    // Boosts up to the end of the range.
    let spacetime = Space::new(1, 3, 0);
    for rapidity in [1e-8, 1.0, 30.0, -700.0] {
        let boost = spacetime.sum(&[(f64::cosh(rapidity), &[]), (f64::sinh(rapidity), &[1, 2])]);
        let b = spacetime.sum(&[(rapidity, &[1, 2])]);
        let exp = spacetime.calculus.exp(&b).unwrap();
        assert!(distance(&exp, &boost) <= 4.0 * EPS * norm(&boost) * (1.0 + rapidity.abs()));
        assert!(distance(&spacetime.calculus.log(&boost).unwrap(), &b) <= 8.0 * EPS * rapidity.abs());
    }
    assert_eq!(spacetime.calculus.exp(&spacetime.sum(&[(800.0, &[1, 2])])), Err(MathError::Overflow));
    // A boost beside a null generator: above 18 the rounding of R~R hides that it is 1.
    let plane = Space::new(1, 1, 1);
    let boost = plane.sum(&[(f64::cosh(20.0), &[]), (f64::sinh(20.0), &[1, 2])]);
    let b = plane.sum(&[(20.0, &[1, 2])]);
    assert!(distance(&plane.calculus.log(&boost).unwrap(), &b) <= 8.0 * EPS * 20.0);
    // A null rotation, e1e2 + e2e3 with square 0.
    let null = spacetime.sum(&[(1e5, &[1, 2]), (1e5, &[2, 3])]);
    let mut turned = null.clone();
    turned[0] = 1.0;
    assert_eq!(spacetime.calculus.exp(&null).unwrap(), turned);
    assert_eq!(spacetime.calculus.log(&turned).unwrap(), null);
}

#[test]
fn large_angles_keep_their_digits() {
    let spacetime = Space::new(1, 3, 0);
    for (boost, angle) in [(300.0, 2.0), (1.0, 1e3), (700.0, 1e3), (20.0, 3.1)] {
        let exp = spacetime.calculus.exp(&spacetime.sum(&[(boost, &[1, 2]), (angle, &[3, 4])])).unwrap();
        let (c, s, ch, sh) = (f64::cos(angle), f64::sin(angle), f64::cosh(boost), f64::sinh(boost));
        let terms: [(f64, &[usize]); 4] =
            [(c * ch, &[]), (s * ch, &[3, 4]), (c * sh, &[1, 2]), (s * sh, &[1, 2, 3, 4])];
        let expected = spacetime.sum(&terms);
        assert!(
            distance(&exp, &expected) <= 2.0 * EPS * norm(&expected) * (boost + angle),
            "{boost} {angle}"
        );
        if angle < PI {
            let log = spacetime.calculus.log(&expected).unwrap();
            assert!(
                distance(&spacetime.calculus.exp(&log).unwrap(), &expected)
                    <= 4.0 * EPS * norm(&expected) * boost
            );
        }
    }
}

#[test]
fn whole_turns_have_logarithms_where_a_plane_is_left() {
    let cases: [(Space, Vec<f64>); 6] = [
        ((4, 0, 0), vec![(1.0, &[1, 2, 3, 4][..])]),
        ((4, 0, 0), vec![(-1.0, &[1, 2, 3, 4][..])]),
        ((5, 0, 0), vec![(0.6, &[1, 2, 3, 5][..]), (0.8, &[1, 2, 4, 5][..])]),
        ((3, 0, 1), vec![(-1.0, &[][..]), (0.3, &[4, 1][..]), (2.0, &[4, 2][..]), (-0.7, &[4, 3][..])]),
        (
            (1, 3, 0),
            vec![
                (-f64::cosh(0.8), &[][..]),
                (f64::sinh(0.8) * 0.6, &[1, 2][..]),
                (f64::sinh(0.8) * 0.8, &[1, 4][..]),
            ],
        ),
        ((4, 1, 0), vec![(-f64::cosh(2.0), &[][..]), (-f64::sinh(2.0), &[3, 5][..])]),
    ]
    .map(|((p, q, r), terms)| {
        let space = Space::new(p, q, r);
        let rotor = space.sum(&terms);
        (space, rotor)
    });
    // A boost seen from a frame that moves along e3: the plane of the turn that commutes with it moves too.
    let spacetime = Space::new(1, 3, 0);
    // Their components are dyadic, so that nothing rounds.
    let frame = spacetime.sum(&[(1.25, &[]), (0.75, &[1, 3])]);
    let boost = spacetime.sum(&[(-1.25, &[]), (-0.75, &[1, 2])]);
    let moving = spacetime.product(&spacetime.product(&frame, &boost), &spacetime.reverse(&frame));
    for (space, rotor) in cases.into_iter().chain([(spacetime, moving)]) {
        let log = space.calculus.log(&rotor).unwrap();
        let back = space.calculus.exp(&log).unwrap();
        assert!(distance(&back, &rotor) <= 32.0 * EPS * norm(&rotor) * norm(&log), "{rotor:?} {log:?}");
        let root = space.calculus.sqrt(&rotor).unwrap();
        assert!(distance(&space.product(&root, &root), &rotor) <= 32.0 * EPS * norm(&rotor) * norm(&log));
    }
    let none: [(Space, Vec<f64>); 7] = [
        ((1, 1, 0), vec![(-f64::cosh(0.8), &[][..]), (f64::sinh(0.8), &[1, 2][..])]),
        ((1, 1, 0), vec![(1.0, &[1, 2][..])]),
        ((2, 1, 0), vec![(-1.0, &[][..]), (1.0, &[1, 2][..]), (1.0, &[1, 3][..])]),
        ((2, 0, 1), vec![(-1.0, &[][..]), (1.0, &[1, 3][..])]),
        ((1, 3, 0), vec![(-1.0, &[][..]), (1.0, &[1, 2][..]), (1.0, &[2, 3][..])]),
        ((1, 2, 0), vec![(-1.0, &[][..]), (1e-9, &[1, 2][..])]),
        // A boost in a moving plane of two space dimensions, which leaves no plane to turn in.
        (
            (1, 2, 0),
            vec![
                (-f64::cosh(2.0), &[][..]),
                (1.25 * f64::sinh(2.0), &[1, 2][..]),
                (0.75 * f64::sinh(2.0), &[2, 3][..]),
            ],
        ),
    ]
    .map(|((p, q, r), terms)| {
        let space = Space::new(p, q, r);
        let rotor = space.sum(&terms);
        (space, rotor)
    });
    for (space, rotor) in none {
        assert_eq!(space.calculus.log(&rotor), Err(MathError::NoBivectorLogarithm), "{rotor:?}");
    }
}

/// Nearly a whole turn with a small boost: C is nearly −1, and 1 + C would cancel.
#[test]
fn nearly_whole_turns_keep_their_digits() {
    for (space, boost) in [(Space::new(1, 3, 0), &[1, 2][..]), (Space::new(4, 1, 0), &[2, 5])] {
        for (gap, rapidity) in [(1e-3, 2e-3), (1e-5, 2e-5), (1e-7, 1e-6)] {
            let angle = PI - gap;
            let b = space.sum(&[(angle, &[3, 4]), (rapidity, boost)]);
            let turn = space.sum(&[(angle.cos(), &[]), (angle.sin(), &[3, 4])]);
            let boost = space.sum(&[(rapidity.cosh(), &[]), (rapidity.sinh(), boost)]);
            let log = space.calculus.log(&space.product(&turn, &boost)).unwrap();
            // The sine of the gap has the rounding of π.
            assert!(distance(&log, &b) <= 16.0 * EPS, "{gap} {}", distance(&log, &b));
        }
    }
}

/// With six generators and more: small and moderate angles, whole turns, half turns in all planes.
#[test]
fn many_planes() {
    let space = Space::new(6, 0, 0);
    for angles in
        [[0.1, 0.2, 0.3], [1.0, 1e-9, -2.0], [PI, 0.0, 0.0], [0.5 * PI, 0.5 * PI, 0.0], [1.5, 1.5, 1e-3]]
    {
        let planes: [&[usize]; 3] = [&[1, 2], &[3, 4], &[5, 6]];
        let b = space.sum(&[0, 1, 2].map(|i| (angles[i], planes[i])));
        let factors = [0, 1, 2].map(|i| space.sum(&[(angles[i].cos(), &[]), (angles[i].sin(), planes[i])]));
        let rotor = space.product(&space.product(&factors[0], &factors[1]), &factors[2]);
        assert!(
            distance(&space.calculus.exp(&b).unwrap(), &rotor) <= 8.0 * EPS * (1.0 + norm(&b)),
            "{angles:?}"
        );
        let log = space.calculus.log(&rotor).unwrap();
        assert!(distance(&space.calculus.exp(&log).unwrap(), &rotor) <= 1e-12, "{angles:?}");
    }
    let boosts = Space::new(4, 4, 0);
    let b = boosts.sum(&[(2.0, &[1, 5]), (-1.0, &[2, 6]), (0.5, &[3, 4]), (0.7, &[7, 8])]);
    let log = boosts.calculus.log(&boosts.calculus.exp(&b).unwrap()).unwrap();
    assert!(distance(&log, &b) <= 1e-12, "{}", distance(&log, &b));
    // A boost R by 10 is as large as e¹⁰, and its logarithm known to the documented ε|R|².
    let far = Space::new(5, 1, 0);
    let b = far.sum(&[(10.0, &[1, 6]), (0.5, &[2, 3])]);
    let rotor = far.calculus.exp(&b).unwrap();
    let log = far.calculus.log(&rotor).unwrap();
    assert!(distance(&log, &b) <= 32.0 * EPS * (norm(&rotor).powi(2) + norm(&b).powi(2)));
}

/// `exp(−1600 + 800 (E + F)) = (1 + E)(1 + F)/4` to rounding for two planes of square 1.
#[test]
fn exponentials_may_be_in_range_where_their_parts_are_not() {
    let space = Space::new(2, 2, 0);
    let m = space.sum(&[(-1600.0, &[]), (800.0, &[1, 3]), (800.0, &[2, 4])]);
    // Each plane by itself: e⁻⁸⁰⁰ (cosh 800 + E sinh 800) = (1 + E)/2.
    let [first, second]: [&[usize]; 2] = [&[1, 3], &[2, 4]];
    let [e, f] = [first, second].map(|plane| space.sum(&[(0.5, &[]), (0.5, plane)]));
    let exp = space.calculus.exp(&m).unwrap();
    assert!(distance(&exp, &space.product(&e, &f)) <= 8.0 * EPS);
}
