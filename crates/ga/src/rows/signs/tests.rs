use super::*;

/// Any number of rows and threads, also beyond the caches and where blocks begin within rows.
#[test]
fn rows_are_multiplied_by_their_signs() {
    let signs = [1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0];
    for (count, threads) in [(0, 1), (1, 1), (200, 1), (40_000, 3), (400_000, 2)] {
        for size in [1, 3, 7] {
            let rows: Vec<f64> = (0..count * size).map(|i| i as f64 - 5.0).collect();
            let mut out = vec![f64::NAN; rows.len()];
            with_signs(Threads::new(threads), &rows, &signs[..size], &mut out);
            for (i, x) in out.iter().enumerate() {
                assert!(*x == rows[i] * signs[i % size], "{count} rows of {size}, number {i}");
            }
        }
    }
    let mut out = [0.0_f32; 4];
    with_signs(Threads::ONE, &[0.1_f32, 0.2, 0.3, 0.4], &[1.0, -1.0], &mut out);
    assert_eq!(out, [0.1, -0.2, 0.3, -0.4]);
}
