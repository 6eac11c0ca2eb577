use super::*;

#[test]
fn small_terms_survive_large_ones() {
    let mut sum = Sum::default();
    for x in [1.0, 1e100, 1.0, -1e100] {
        sum.add(x);
    }
    assert_eq!(sum.value(), 2.0);
}
