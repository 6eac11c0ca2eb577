//! exp and log of rotors within 2 ulps of each component, in hard cases: angles tiny, huge, and near
//! quarter turns, where a component nearly vanishes. The values nearest to the true ones were found by
//! `exp_log_table.py` in many digits.

use polhode_ga::rows::rotor_functions;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};

const TABLE: &str = include_str!("exp_log_table.txt");

/// Arguments of `N` numbers and values of `M`, of the lines with a name.
fn table<const N: usize, const M: usize>(name: &str) -> Vec<([f64; N], [f64; M])> {
    let number = |word: &str| f64::from_bits(u64::from_str_radix(word, 16).unwrap());
    let rows = TABLE.lines().filter_map(|line| line.strip_prefix(name));
    rows.map(|line| {
        let numbers: Vec<f64> = line.split_whitespace().map(number).collect();
        (numbers[..N].try_into().unwrap(), numbers[N..].try_into().unwrap())
    })
    .collect()
}

/// How many binary64 numbers `x` is from `y`; those that differ in sign are far apart, except zeros.
fn ulps(x: f64, y: f64) -> u64 {
    if x.is_sign_negative() == y.is_sign_negative() {
        x.to_bits().abs_diff(y.to_bits())
    } else {
        x.abs().to_bits() + y.abs().to_bits()
    }
}

/// The errors found are at most 1.6 ulps, and the nearest value is half an ulp off.
fn assert_near(got: &[f64], expected: &[f64], of: &[f64]) {
    for (x, y) in got.iter().zip(expected) {
        assert!(ulps(*x, *y) <= 2, "{of:?}: {got:?}, expected {expected:?}");
    }
}

#[test]
fn exp_is_accurate_in_hard_cases() {
    let cases = table::<3, 4>("exp");
    assert!(cases.len() > 100);
    for (b, expected) in &cases {
        assert_near(&Rotor::exp(Bivector(*b)).components(), expected, b);
    }
    let arguments: Vec<f64> = cases.iter().flat_map(|(b, _)| *b).collect();
    let mut out = vec![0.0; 4 * cases.len()];
    rotor_functions::exp(Threads::ONE, &arguments, &mut out).unwrap();
    for ((b, expected), got) in cases.iter().zip(out.chunks_exact(4)) {
        assert_near(got, expected, b);
    }
}

#[test]
fn log_is_accurate_in_hard_cases() {
    let cases = table::<4, 3>("log");
    assert!(cases.len() > 100);
    for (r, expected) in &cases {
        assert_near(&Rotor::from_unit_components(*r).log().0, expected, r);
    }
    let arguments: Vec<f64> = cases.iter().flat_map(|(r, _)| *r).collect();
    let mut out = vec![0.0; 3 * cases.len()];
    rotor_functions::log(Threads::ONE, &arguments, &mut out).unwrap();
    for ((r, expected), got) in cases.iter().zip(out.chunks_exact(3)) {
        assert_near(got, expected, r);
    }
}
