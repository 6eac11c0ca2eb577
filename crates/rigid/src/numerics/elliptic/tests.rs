use super::*;
use crate::numerics::wide::{Wide, Wides};
use std::f64::consts::FRAC_PI_2;

fn complete_k(kc: f64) -> f64 {
    FRAC_PI_2 / Means::new(Wide::from(kc)).mean().lane(0).value()
}

/// Π(n) − K, for n <= 0.
fn excess(n: f64, kc: f64) -> f64 {
    let sum = Means::new(Wide::from(kc)).single_sum(DoubleDouble::ONE - n.into()).value();
    0.5 * complete_k(kc) * (n / (1.0 - n)) * sum
}

fn single_r_f(x: f64, y: f64, z: f64) -> f64 {
    r_f([x], [y], [z])[0]
}

fn close(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-15 * 8.0, "{a} {b}");
}

/// Carlson's published check values (1995, section 4).
#[test]
fn published_values() {
    close(single_r_f(1.0, 2.0, 0.0), 1.311_028_777_146_06);
    close(single_r_f(2.0, 3.0, 4.0), 0.584_082_841_677_153_5);
    close(r_j(0.0, 1.0, 2.0, 3.0), 0.776_886_237_785_823_3);
    close(r_j(2.0, 3.0, 4.0, 5.0), 0.142_975_796_671_567_5);
    close(r_d(0.0, 2.0, 1.0), 1.797_210_352_103_388);
    close(r_d(2.0, 3.0, 4.0), 0.165_105_272_942_611_5);
}

#[test]
fn circular_limits() {
    close(complete_k(1.0), FRAC_PI_2);
    // Π(n|0) = π / (2√(1 − n)).
    for n in [-3.0, -1.0, -0.25] {
        close(excess(n, 1.0), FRAC_PI_2 * (1.0 / (1.0f64 - n).sqrt() - 1.0));
    }
    close(excess(-1e-20, 1.0), -0.5e-20 * FRAC_PI_2);
}

/// `K → ln(4/k')` as k' → 0 (DLMF 19.9.1).
#[test]
fn near_the_separatrix() {
    for kc in [1e-9, 1e-100, 1e-150] {
        close(complete_k(kc), (4.0f64 / kc).ln());
        close(mean([kc])[0], FRAC_PI_2 / (4.0f64 / kc).ln());
    }
}

/// `Π(n) − K = (n/3) R_J(0, k'², 1, 1 − n)`.
#[test]
fn means_agree_with_symmetric_forms() {
    for kc in [1.0, 0.9, 0.5, 1e-2, 1e-6] {
        close(complete_k(kc), single_r_f(0.0, kc * kc, 1.0));
        close(complete_k(kc), FRAC_PI_2 / mean([kc])[0]);
        for n in [-1e-9, -0.3, -1.0, -7.0] {
            close(excess(n, kc), n / 3.0 * r_j(0.0, kc * kc, 1.0, 1.0 - n));
        }
    }
    assert_eq!(mean([0.0]), [0.0]);
}

/// The duplication theorem (Carlson 1995, eq. 2.2), for arguments so near to each other that the left side is the series at its
/// full spread, and the right one at a quarter of it.
#[test]
fn the_series_agrees_with_a_duplication() {
    for [x, y, z, p] in [
        [1.0, 1.001_1, 0.999_3, 1.000_9],
        [1.001_1, 1.001_0, 1.000_9, 0.998_9],
        [0.999, 0.998_9, 1.000_2, 1.001_6],
        [1.0, 1.0, 1.001, 1.001],
    ] {
        let [sx, sy, sz, sp] = [x, y, z, p].map(f64::sqrt);
        let (d, lambda) = ((sp + sx) * (sp + sy) * (sp + sz), sx * sy + sx * sz + sy * sz);
        let [a, b, c, e] = [x, y, z, p].map(|x: f64| 0.25 * (x + lambda));
        let beside = (p - x) * (p - y) * (p - z) / (d * d);
        let expected = 0.25 * r_j(a, b, c, e) + 6.0 / d * (1.0 - beside / 3.0);
        assert!((r_j(x, y, z, p) / expected - 1.0).abs() <= 1e-15, "{x} {y} {z} {p}");
    }
}

/// `R_J(1, 1, 1, p) = 3/(1 − p) · (R_C(1, p) − 1)`, with `R_C(1, p) = artanh √(1 − p) / √(1 − p)` for p < 1.
#[test]
fn elementary_values_below_the_mean() {
    for p in [0.01, 0.25, 0.75f64] {
        let root = (1.0 - p).sqrt();
        close(r_j(1.0, 1.0, 1.0, p), 3.0 / (1.0 - p) * (root.atanh() / root - 1.0));
    }
}

/// Lanes that converge after different numbers of steps have the bits that they have alone.
#[test]
fn lanes_are_independent() {
    let kc = [1.0, 0.9, 1e-3, 1e-20, 1e-300, 0.5, 0.999_999, 1e-8];
    let p2 = [1.0, 2.0, 1e6, 1.5, 1e100, 3.0, 1.0 + 1e-12, 7.0];
    let means = Means::<8, true>::new(Wides::from(kc));
    let sum = means.sum(DoubleDoubles { hi: p2, lo: [0.0; 8] });
    let (all, forms) = (mean(kc), r_f(kc.map(|x| x * x), p2, [1.0; 8]));
    let first = first_kind([kc, p2], &kc);
    for l in 0..8 {
        let alone = Means::new(Wide::from(kc[l]));
        assert_eq!(means.mean().lane(l), alone.mean().lane(0));
        assert_eq!(sum.lane(l), alone.single_sum(p2[l].into()));
        assert_eq!(all[l], mean([kc[l]])[0]);
        assert_eq!(forms[l], single_r_f(kc[l] * kc[l], p2[l], 1.0));
        assert_eq!(first[l], first_kind([[kc[l]], [p2[l]]], &[kc[l]])[0]);
    }
}
