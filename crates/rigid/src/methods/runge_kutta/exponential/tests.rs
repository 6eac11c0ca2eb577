use super::*;
use polhode_ga::simd::lanes::One;

#[test]
fn exponential_matches_the_standard_library() {
    for i in 0..=3000 {
        let angle = f64::from(i) * 0.001;
        let turn = [0.6 * angle, 0.0, -0.8 * angle];
        let ([cos, x, y, z], cotangent) = exponential(&One::each(turn), Lanes([angle * angle]));
        let half = 0.5 * angle;
        assert!((cos.0[0] - half.cos()).abs() <= 4.0 * f64::EPSILON, "{angle}");
        let planes = [x, y, z].map(|lanes| lanes.0[0]);
        for (found, part) in planes.into_iter().zip([-0.6, 0.0, 0.8]) {
            assert!((found - part * half.sin()).abs() <= 4.0 * f64::EPSILON, "{angle}");
        }
        // The plain form loses a factor of 1/θ² in accuracy.
        let plain = (1.0 - half * (half.cos() / half.sin())) / (angle * angle);
        if angle > 0.1 {
            let rounding = 4.0 * f64::EPSILON * (1.0 + 1.0 / (angle * angle));
            assert!((cotangent.0[0] - plain).abs() <= rounding, "{angle}");
        }
    }
    let still = exponential(&[One::ZERO; 3], One::ZERO).1.0[0];
    assert!((still - 1.0 / 12.0).abs() <= f64::EPSILON);
}
