use super::*;

#[test]
fn matches_the_standard_library() {
    for i in 0..=4000 {
        let x = f64::from(i) * 0.0005;
        let (Lanes([cos]), Lanes([sinc])) = cosine_and_sinc(Lanes::<1, false>([x * x]));
        let exact = if x == 0.0 { 1.0 } else { x.sin() / x };
        assert!((cos - x.cos()).abs() <= 2.0 * f64::EPSILON, "{x}");
        assert!((sinc - exact).abs() <= 2.0 * f64::EPSILON, "{x}");
    }
}
