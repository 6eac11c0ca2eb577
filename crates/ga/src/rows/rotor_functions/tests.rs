use super::*;
use std::f64::consts::FRAC_PI_2;

/// From nothing to the largest, with the borders of the long way and multiples of π/2 between.
const SIZES: [f64; 20] = [
    0.0,
    5e-324,
    1e-310,
    1e-200,
    1e-121,
    1e-119,
    1e-100,
    1e-60,
    4e-9,
    0.3,
    1.0,
    FRAC_PI_2,
    PI,
    100.0 * PI,
    1e4,
    9.9e5,
    1.1e6,
    1e30,
    1e300,
    f64::MAX,
];

/// Rows of numbers up to any two of the sizes, from a linear congruence.
fn rows(count: usize, width: usize) -> Vec<f64> {
    let mut state = 1u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 40) as f64 / (1 << 24) as f64
    };
    let mut pick = move || (SIZES[(next() * 20.0) as usize], 2.0 * next() - 1.0, next());
    let mut all = Vec::new();
    for _ in 0..count {
        let ((size, ..), (other, ..)) = (pick(), pick());
        for _ in 0..width {
            let (_, factor, choice) = pick();
            all.push(match (choice * 8.0) as usize {
                0 => 0.0,
                1 => other * factor,
                2 => size,
                _ => size * factor,
            });
        }
    }
    all
}

fn assert_same(got: &[f64], expected: &[f64], what: &str) {
    for (i, (x, y)) in got.iter().zip(expected).enumerate() {
        assert!(x.to_bits() == y.to_bits(), "{what}, number {i}: {x:e} {y:e}");
    }
}

/// Every path, with and without fused instructions, for few rows and many: the same bits.
fn check<M: Map<A, B, OUT> + Copy, const A: usize, const B: usize, const OUT: usize>(
    map: M,
    a: &[f64],
    b: &[f64],
) {
    let pick = |i: usize| (std::array::from_fn(|k| a[i * A + k]), std::array::from_fn(|k| b[i * B + k]));
    let expected: Vec<f64> = (0..a.len() / A).flat_map(|i| map.value(pick(i).0, pick(i).1)).collect();
    assert!(expected.iter().all(|x| x.is_finite()));
    for path in Path::available() {
        for count in [0, 1, 7, 8, 9, 63, 64, 65, a.len() / A] {
            let mut out = vec![0.5; count * OUT];
            run(map, (path, Threads::new(3)), &a[..count * A], &b[..count * B], &mut out).unwrap();
            assert_same(&out, &expected[..count * OUT], &format!("{path:?}, {count} rows"));
        }
    }
}

#[test]
fn every_path_gives_the_same_bits() {
    let bivectors = rows(3000, 3);
    check(Exp, &bivectors, &[]);
    let mut rotors = vec![0.0; 4 * 3000];
    exp(Threads::ONE, &bivectors, &mut rotors).unwrap();
    check(Log, &rotors, &[]);
    let others: Vec<f64> = rows(3000, 4).iter().map(|&x| if x.abs() > 1e200 { 1.0 } else { x }).collect();
    check(Log, &others, &[]);
    check(Power, &rotors, &(0..3000).map(|i| 0.01 * f64::from(i) - 10.0).collect::<Vec<_>>());
}

#[test]
fn the_first_bad_row_is_reported() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for at in 0..4 {
            for row in [0, 3, 69, 130] {
                let mut c = vec![0.5; 4 * 140];
                c[4 * row + at] = bad;
                c[4 * 135] = bad;
                for path in Path::available() {
                    assert_eq!(
                        run(Log, (path, Threads::ONE), &c, &[], &mut [0.0; 3 * 140]),
                        Err(row),
                        "{path:?}"
                    );
                    let row = (4 * row + at) / 3;
                    assert_eq!(
                        run(Exp, (path, Threads::ONE), &c[..540], &[], &mut [0.0; 4 * 180]),
                        Err(row),
                        "{path:?}"
                    );
                }
            }
        }
    }
    assert_eq!(power(Threads::ONE, &[0.0, 1.0, 0.0, 0.0], &[1.0, f64::MAX], &mut [0.0; 8]), Err(1));
}

#[test]
fn logarithms_at_the_ends() {
    let cases = [
        ([1.0, 0.0, 0.0, 0.0], [0.0; 3]),
        ([-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, PI]),
        ([-1.0, -0.0, -5e-324, 0.0], [0.0, -PI, 0.0]),
        ([-1.0, f64::MIN_POSITIVE, 0.0, 0.0], [PI, 0.0, 0.0]),
        ([1.0, 5e-324, 0.0, -1e-310], [5e-324, 0.0, -1e-310]),
        ([0.0, 0.0, 1.0, 0.0], [0.0, FRAC_PI_2, 0.0]),
        ([-0.0, 0.0, 0.0, -1.0], [0.0, 0.0, -FRAC_PI_2]),
    ];
    for (rotor, log) in cases {
        assert_eq!(log_one(rotor), log, "{rotor:?}");
    }
}

#[test]
fn powers_multiply_the_angle() {
    let r = exp_one([0.3, -0.2, 0.5]);
    let mut out = [0.0; 12];
    power(Threads::ONE, &r, &[0.0, 1.0, -3.0], &mut out).unwrap();
    let expected = [[1.0, 0.0, 0.0, 0.0], r, exp_one([-0.9, 0.6, -1.5])].concat();
    for (x, y) in out.iter().zip(expected) {
        assert!((x - y).abs() <= 4.0 * f64::EPSILON, "{x} {y}");
    }
}
