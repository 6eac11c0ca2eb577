use super::{BinCounts, UNKNOWN, WIDTH, bin, bounds};
use polhode_ga::simd::threads::Threads;

/// Numbers of both signs over many powers of 2.
fn numbers(count: usize) -> Vec<f64> {
    let mut state = 7_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| (next() - 0.3) * 2.0_f64.powf(20.0 * next())).collect()
}

fn sorted(mut x: Vec<f64>) -> Vec<f64> {
    x.sort_by(f64::total_cmp);
    x
}

#[test]
fn bins_rise_and_hold_their_numbers() {
    let x = sorted([numbers(2000), vec![0.0, 1.0, -1.0, 1e-300, f64::MIN_POSITIVE]].concat());
    for pair in x.windows(2) {
        assert!(bin(pair[0]) <= bin(pair[1]));
    }
    for x in x {
        let [near, far] = bounds(bin(x));
        assert!(near.abs() <= x.abs() && (x.abs() < far.abs() || x == 0.0), "{x}");
        assert!((far - near).abs() <= WIDTH * near.abs());
    }
    assert_eq!([f64::NAN, f64::INFINITY].map(bin), [UNKNOWN; 2]);
}

#[test]
fn quantiles_are_those_of_the_numbers_to_the_width_of_a_bin() {
    let x = numbers(5001);
    let mut counts = BinCounts::new(1);
    counts.add(&x.iter().map(|x| bin(*x)).collect::<Vec<_>>(), Threads::ONE);
    let x = sorted(x);
    for (k, level) in [(0, 0.0), (250, 0.05), (2500, 0.5), (4750, 0.95), (5000, 1.0)] {
        let found = counts.quantiles(&[level])[0][0];
        assert!((found - x[k]).abs() <= WIDTH * x[k].abs(), "{level}: {found}, {}", x[k]);
    }
}

#[test]
fn parts_and_threads_do_not_change_counts() {
    let columns = 7;
    let bins: Vec<i32> = numbers(columns * 3000).iter().map(|x| bin(*x)).collect();
    let mut whole = BinCounts::new(columns);
    whole.add(&bins, Threads::new(5));
    let mut parts = BinCounts::new(columns);
    for part in bins.chunks(columns * 700).rev() {
        let mut own = BinCounts::new(columns);
        own.add(part, Threads::ONE);
        let (mut at, mut bins, mut counts) = (vec![], vec![], vec![]);
        for (column, bin, count) in own.filled() {
            at.push(column);
            bins.push(bin);
            counts.push(count);
        }
        assert!(parts.add_filled(&at, &bins, &counts));
    }
    assert!(whole.filled().eq(parts.filled()));
    let mut twice = whole.clone();
    assert!(twice.merge(&parts) && !twice.merge(&BinCounts::new(1)));
    assert!(twice.filled().eq(whole.filled().map(|(column, bin, count)| (column, bin, 2 * count))));
    assert!(!parts.add_filled(&[columns as u32], &[1], &[1]));
}

#[test]
fn nothing_has_no_quantiles() {
    let mut counts = BinCounts::new(2);
    counts.add(&[UNKNOWN, bin(2.0)], Threads::ONE);
    let found = counts.quantiles(&[0.0, 0.5]);
    assert!(found[0].iter().all(|x| x.is_nan()));
    assert!(found[1].iter().all(|x| (x - 2.0).abs() <= 2.0 * WIDTH));
}
