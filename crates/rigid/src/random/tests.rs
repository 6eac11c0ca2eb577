use super::*;

/// Reference: the pseudocode of RFC 8439 with four double rounds, in Python.
#[test]
fn words_match_the_cipher() {
    let table = [
        (0, "spin", 0, 0x7355_a009_2232_f08a, 0xae47_a47a_5324_4872),
        (7, "attitude", 3, 0x4909_d109_1d64_11ee, 0x8a84_b7c3_ecaa_f150),
        (1 << 53, "torque.damping", 99_999_999, 0x22fa_2d48_6904_589c, 0xf1bf_e8ae_27b2_164c),
    ];
    for (seed, name, body, first, last) in table {
        let words = Words::new(seed, name, body).next().unwrap();
        assert_eq!((words[0], words[7]), (first, last), "{name}");
        // The words do not depend on the first body.
        for before in 1..=body.min(5) {
            let from_there = Words::new(seed, name, body - before).nth(before as usize);
            assert_eq!(from_there, Some(words), "{name}");
        }
    }
}

/// Reference: mpmath, 20 digits.
#[test]
fn normal_numbers_are_quantiles() {
    let table = [
        (0, -8.209_536_151_601_387),
        (1 << 12, -8.076_571_004_130_125),
        (1 << 63, 2.782_916_424_671_766_7e-16),
        ((1 << 63) - 1, -2.782_916_424_671_766_7e-16),
        (0x7355_a009_2232_f08a, -0.124_334_323_549_359_77),
        (0x4a66_625d_863f_dd9a, -0.551_560_480_148_623_1),
        (0x1353_f7ce_d916_8700, -1.436_008_227_944_182),
        // On both sides of q = 0.425 and of r = 5.
        (0x1333_3333_3333_2000, -1.439_531_470_938_457),
        (0x1333_3333_3333_4000, -1.439_531_470_938_454),
        (0x0f45_0000, -6.657_907_555_407_399),
        (0x0f45_2000, -6.657_902_854_320_481),
        (0x0afe_bff0, -6.706_024_764_388_672),
        (0x0119_7998, -7.034_486_910_047_835_2),
    ];
    for (word, expected) in table {
        let found = normal(word);
        assert!((found - expected).abs() <= 1e-15 * f64::abs(expected), "{found} {expected}");
        assert_eq!(normal(!word), -found);
    }
    assert!(normal(u64::MAX) < LARGEST_NORMAL);
}

#[test]
fn logarithm_and_exponential_match_the_library() {
    for k in 1..1000 {
        let x = 0.037 * k as f64 - 18.0;
        assert!((exp(x) / x.exp() - 1.0).abs() < 4.0 * f64::EPSILON, "{x}");
        let y = x.exp();
        assert!((ln(y) - y.ln()).abs() <= 2.0 * f64::EPSILON * y.ln().abs().max(1.0), "{y}");
    }
    assert_eq!((exp(0.0), ln(1.0)), (1.0, 0.0));
}

/// The standard deviation of the mean of n numbers is 1/√n, of the mean square √(2/n); five of them are exceeded
/// for one seed in a million.
#[test]
fn moments_and_distributions_are_normal_and_uniform() {
    let n = 1 << 17;
    let words: Vec<[u64; 8]> = Words::new(1, "test", 0).take(n).collect();
    let root = (n as f64).sqrt();
    for k in 0..8 {
        let z: Vec<f64> = words.iter().map(|w| normal(w[k])).collect();
        let moment = |power| z.iter().map(|x| x.powi(power)).sum::<f64>() / n as f64;
        assert!(moment(1).abs() < 5.0 / root, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 5.0 * 2f64.sqrt() / root, "{}", moment(2));
        // ⟨z⁶⟩ = 15 and ⟨z⁸⟩ − 9 = 96 are the variances of z³ and z⁴.
        assert!(moment(3).abs() < 5.0 * 15f64.sqrt() / root, "{}", moment(3));
        assert!((moment(4) - 3.0).abs() < 5.0 * 96f64.sqrt() / root, "{}", moment(4));
        let mut u: Vec<f64> = words.iter().map(|w| uniform(w[k])).collect();
        u.sort_by(f64::total_cmp);
        let below = |i: usize| (u[i] - (2.0 * (i as f64 + 0.5) / n as f64 - 1.0)).abs() / 2.0;
        let distance = (0..n).map(below).fold(0.0, f64::max);
        // Kolmogorov: a distance beyond x/√n has the probability 2 exp(−2x²), 3e-6 for x = 2.6.
        assert!(distance < 2.6 / root, "{}", distance * root);
    }
}
