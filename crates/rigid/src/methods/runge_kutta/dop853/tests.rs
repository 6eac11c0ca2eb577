use super::*;

#[test]
fn rows_sum_to_their_nodes() {
    let sum = |row: Sparse| row.iter().map(|(_, a)| a).sum::<f64>();
    for (row, node) in ROWS.iter().zip(NODES) {
        let size: f64 = row.iter().map(|(_, a)| a.abs()).sum();
        assert!((sum(row) - node).abs() <= 4.0 * f64::EPSILON * size.max(1.0), "{node}");
    }
    assert!((sum(WEIGHTS) - 1.0).abs() <= 16.0 * f64::EPSILON);
    // The error estimate of y' = 1 vanishes.
    assert!(sum(FIFTH).abs() <= 16.0 * f64::EPSILON);
    assert!(sum(THIRD).abs() <= 16.0 * f64::EPSILON);
}
