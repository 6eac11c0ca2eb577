use super::*;
use crate::product::{Plan, Product};
use crate::table::Signature;
use std::f64::consts::PI;

/// Those with e0 first, and with the null generator last.
fn algebras() -> [Algebra; 2] {
    [Algebra::pga(3).unwrap(), Algebra::new(Signature { p: 3, q: 0, r: 1 }).unwrap()]
}

/// Numbers in [−1, 1] from a linear congruence.
fn random() -> impl FnMut() -> f64 {
    let mut state = 5u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 40) as f64 / (1 << 23) as f64 - 1.0
    }
}

/// Bivectors of angles from nothing to many turns, near π and where formulas change, with translations of all sizes.
fn bivectors(motors: &Motors) -> Vec<[f64; BIVECTOR]> {
    const ANGLES: [f64; 16] =
        [0.0, 1e-300, 1e-120, 1e-9, 1e-3, 0.2449, 0.245, 0.5, 0.999, 1.001, 1.57, 2.0, 3.1, PI, 20.0, 1e5];
    const MOVES: [f64; 6] = [0.0, 1e-200, 1e-8, 1.0, 1e6, 1e150];
    let mut next = random();
    let mut found = Vec::new();
    for angle in ANGLES {
        for size in MOVES {
            for _ in 0..4 {
                let plane = [next(), next(), next()];
                let length = plane.iter().map(|x| x * x).sum::<f64>().sqrt();
                let mut parts = [0.0; SIZE];
                for i in 0..3 {
                    parts[1 + i] = angle * plane[i] / length;
                    parts[4 + i] = size * next();
                }
                let mut row = [0.0; BIVECTOR];
                for (part, (at, sign)) in parts.iter().zip(motors.order).skip(1).take(BIVECTOR) {
                    row[at - 1] = sign * part;
                }
                found.push(row);
            }
        }
    }
    found
}

/// The largest difference, beside the largest number; of rotors and of the parts with n by themselves.
fn difference(motors: &Motors, a: &[f64; SIZE], b: &[f64; SIZE]) -> f64 {
    let of = |range: std::ops::Range<usize>| {
        let places = motors.order[range].iter().map(|x| x.0);
        let (most, size) = places.fold((0.0, 0.0), |(most, size): (f64, f64), k| {
            (most.max((a[k] - b[k]).abs()), size.max(b[k].abs()))
        });
        if most == 0.0 { 0.0 } else { most / size }
    };
    of(0..4).max(of(4..SIZE))
}

#[test]
fn exponentials_are_those_of_any_algebra() {
    for algebra in algebras() {
        let motors = Motors::new(&algebra).unwrap();
        for row in bivectors(&motors) {
            let general = motors.rounded_to(f64::EPSILON).general(Function::Exp, &row).unwrap();
            let found = motors.run_row(Function::Exp, &row).unwrap();
            // Those of any algebra have an error that grows by roundings of the angle.
            let angle = row.iter().map(|x| x.abs()).filter(|x| *x < 1.1e5).fold(4.0, f64::max);
            assert!(difference(&motors, &found, &general) < 8.0 * angle * f64::EPSILON, "{row:?}");
        }
    }
}

/// Angles beyond the lanes, and translations whose products overflow: a screw about e3 has a closed form.
#[test]
fn exponentials_of_any_size() {
    let motors = Motors::new(&algebras()[1]).unwrap();
    for (angle, along, across) in [
        (1e7, 1.0, 2.0),
        (1e20, 3e9, -4.0),
        (1e300, 1e5, 1e300),
        (1e5, 1e304, 1e303),
        (11.0 * PI, 1e-300, 0.0),
    ] {
        let mut row = [0.0; BIVECTOR];
        for (part, x) in [(3, angle), (4, across), (6, along)] {
            let (at, sign) = motors.order[part];
            row[at - 1] = sign * x;
        }
        let found = motors.run_row(Function::Exp, &row).unwrap();
        let (sine, cosine) = angle.sin_cos();
        let expected = [cosine, 0.0, 0.0, sine, across * (sine / angle), 0.0, along * cosine, along * sine];
        for ((at, sign), x) in motors.order.into_iter().zip(expected) {
            assert!(
                (sign * found[at] - x).abs() <= 4.0 * f64::EPSILON * along.max(x.abs()).max(1e-15),
                "{angle}"
            );
        }
    }
}

#[test]
fn logarithms_and_roots_are_undone() {
    for algebra in algebras() {
        let motors = Motors::new(&algebra).unwrap();
        let product = Plan::new(&algebra, Product::Geometric, GRADES, GRADES);
        for row in bivectors(&motors) {
            let motor = motors.run_row(Function::Exp, &row).unwrap();
            let cosine = motor[0];
            let log = motors.run_row(Function::Log, &motor).unwrap();
            assert_eq!((log[0], log[SIZE - 1]), (0.0, 0.0));
            // Near −1 an error of the motor is one of the logarithm over the sine.
            let lost = 1.0 / (1.0 + cosine.min(0.0)).max(1e-12);
            let again = motors.run_row(Function::Exp, &log[1..SIZE - 1]).unwrap();
            assert!(difference(&motors, &again, &motor) < 16.0 * lost * f64::EPSILON, "{row:?}");
            let root = motors.run_row(Function::Sqrt, &motor).unwrap();
            let mut square = [0.0; SIZE];
            product.run(Threads::ONE, &root, &root, &mut square);
            assert!(difference(&motors, &square, &motor) < 16.0 * lost * f64::EPSILON, "{row:?}");
        }
    }
}

#[test]
fn logarithms_beside_norm_1() {
    let motors = Motors::new(&algebras()[0]).unwrap();
    let row = motors.run_row(Function::Exp, &[0.3, -0.2, 0.5, 0.1, 0.7, -0.4]).unwrap();
    let log = motors.run_row(Function::Log, &row).unwrap();
    for size in [1.0 + 4.0 * f64::EPSILON, 1.0 + 1e-12, 1.0 - 1e-6, 1.0 + 6e-5, 1.0 + 7e-5, 0.9, 2.0, 1e9] {
        let found = motors.run_row(Function::Log, &row.map(|x| size * x)).unwrap();
        let logarithm = if size < 1.0 + 1e-14 && size > 1.0 { 0.0 } else { size.ln() };
        assert!((found[0] - logarithm).abs() < 4.0 * f64::EPSILON, "{size}: {} {logarithm}", found[0]);
        for k in 1..SIZE {
            assert!((found[k] - log[k]).abs() < 8.0 * f64::EPSILON, "{size}");
        }
        let root = motors.run_row(Function::Sqrt, &row.map(|x| size * x)).unwrap();
        let of_1 = motors.run_row(Function::Sqrt, &row).unwrap();
        for k in 0..SIZE {
            assert!((root[k] - size.sqrt() * of_1[k]).abs() < 8.0 * size.sqrt() * f64::EPSILON, "{size}");
        }
    }
}

/// Of even elements that are not motors too.
#[test]
fn norms_and_inverses() {
    let mut next = random();
    for algebra in algebras() {
        let motors = Motors::new(&algebra).unwrap();
        let product = Plan::new(&algebra, Product::Geometric, GRADES, GRADES);
        for size in [1e-300, 1e-60, 1.0, 1e40, 1e200] {
            let row: [f64; SIZE] = std::array::from_fn(|_| size * next());
            let inverse = motors.run_row(Function::Inverse, &row).unwrap();
            let mut one = [0.0; SIZE];
            product.run(Threads::ONE, &row, &inverse, &mut one);
            one[0] -= 1.0;
            assert!(one.iter().all(|x| x.abs() < 1e-14), "{one:?}");

            let unit = motors.normalize_row(&row).unwrap();
            let parts = motors.rounded_to(f64::EPSILON).parts(lanes_of_one(&unit));
            let [s, a, b, c, d, e, f, p] = alone(parts);
            assert!((s * s + a * a + b * b + c * c - 1.0).abs() < 1e-15);
            assert!((a * d + b * e + c * f - s * p).abs() < 1e-14);
            // A motor already: the same.
            let again = motors.normalize_row(&unit).unwrap();
            assert!(difference(&motors, &again, &unit) < 1e-14);
        }
    }
}

/// Every path, for few rows and many: the same bits.
fn check<M: Map<A, 0, SIZE> + Copy, const A: usize>(map: M, rows: &[f64]) {
    let expected: Vec<f64> = rows.as_chunks::<A>().0.iter().flat_map(|&row| map.value(row, [])).collect();
    assert!(!expected.iter().any(|x| x.is_nan()));
    for path in Path::available() {
        for count in [0, 1, 7, 8, 9, 63, 64, 65, rows.len() / A] {
            let mut out = vec![0.5; count * SIZE];
            run(map, (path, Threads::new(3)), &rows[..count * A], &[], &mut out).unwrap();
            for (x, y) in out.iter().zip(&expected) {
                assert_eq!(x.to_bits(), y.to_bits(), "{path:?}, {count} rows");
            }
        }
    }
}

#[test]
fn every_path_gives_the_same_bits() {
    for algebra in algebras() {
        let motors = Motors::new(&algebra).unwrap();
        let of = motors.rounded_to(f64::EPSILON);
        let bivectors = bivectors(&motors).concat();
        check(Exp(of), &bivectors);
        let mut rows = vec![0.0; bivectors.len() / BIVECTOR * SIZE];
        motors.run(Function::Exp, Threads::ONE, &bivectors, &mut rows).unwrap();
        check(Log(of), &rows);
        check(Sqrt(of), &rows);
        check(Inverse(of), &rows);
        check(Normalized(of), &rows);
    }
}

#[test]
fn rows_without_a_value() {
    let motors = Motors::new(&algebras()[0]).unwrap();
    let one: [f64; SIZE] = std::array::from_fn(|k| f64::from(k == 0));
    let mut no_motor = one;
    no_motor[SIZE - 1] = 0.1;
    let mut infinite = one;
    infinite[3] = f64::INFINITY;
    for (f, bad, error) in [
        (Function::Log, no_motor, "not an even versor"),
        (Function::Log, [0.0; SIZE], "no logarithm"),
        (Function::Sqrt, no_motor, "not an even versor"),
        (Function::Inverse, [0.0; SIZE], "no inverse"),
        (Function::Log, infinite, "finite"),
    ] {
        let rows = [one, one, bad, one, bad].concat();
        assert_eq!(motors.run(f, Threads::ONE, &rows, &mut [0.0; 5 * SIZE]), Err(2));
        let found = motors.run_row(f, &bad).unwrap_err().to_string();
        assert!(found.contains(error), "{f:?}: {found}");
    }
    assert_eq!(motors.normalize(Threads::ONE, &[0.0; SIZE], &mut [0.0; SIZE]), Err(0));
    assert_eq!(motors.normalize_row(&infinite), None);
    assert_eq!(motors.run_row(Function::Exp, &[f64::MAX; BIVECTOR]), Err(MathError::Overflow));
}

#[test]
fn other_algebras_have_none() {
    for (p, q, r) in [(3, 0, 0), (3, 1, 0), (2, 0, 1), (4, 0, 1), (3, 0, 2), (2, 1, 1)] {
        assert!(Motors::new(&Algebra::new(Signature { p, q, r }).unwrap()).is_none());
    }
}

/// Motors of single precision deviate by its roundings.
#[test]
fn single_precision() {
    let motors = Motors::new(&algebras()[0]).unwrap();
    let rows: Vec<f32> = (0..60).map(|k| (k * k % 17) as f32 / 9.0 - 0.9).collect();
    let mut out = vec![0f32; 80];
    motors.run(Function::Exp, Threads::ONE, &rows, &mut out).unwrap();
    let mut logs = vec![0f32; 80];
    motors.run(Function::Log, Threads::ONE, &out, &mut logs).unwrap();
    for (row, log) in rows.chunks(BIVECTOR).zip(logs.chunks(SIZE)) {
        assert_eq!(log[0], 0.0);
        for (x, y) in row.iter().zip(&log[1..]) {
            assert!((x - y).abs() < 2e-6, "{row:?} {log:?}");
        }
    }
}
