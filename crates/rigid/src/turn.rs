//! The cosine and sine of the many small turns of steps.

/// `cos x` and `sin x/x` of `x² = square`, to a rounding or two.
///
/// Up to `x = ½` by their series in x², which need no root; the first term left out is `2⁻¹⁶/16!`, below 1e-18. Adjacent
/// terms are added first, so that many multiplications run at once.
#[inline]
pub(crate) fn cosine_and_sinc(square: f64) -> (f64, f64) {
    if square > 0.25 {
        let x = square.sqrt();
        let (sin, cos) = x.sin_cos();
        return (cos, sin / x);
    }
    let z = square;
    let (z2, z4) = (z * z, (z * z) * (z * z));
    let cos = ((1.0 - z * (1.0 / 2.0)) + z2 * (1.0 / 24.0 - z * (1.0 / 720.0)))
        + z4 * ((1.0 / 40_320.0 - z * (1.0 / 3_628_800.0))
            + z2 * (1.0 / 479_001_600.0 - z * (1.0 / 87_178_291_200.0)));
    let sinc = ((1.0 - z * (1.0 / 6.0)) + z2 * (1.0 / 120.0 - z * (1.0 / 5_040.0)))
        + z4 * ((1.0 / 362_880.0 - z * (1.0 / 39_916_800.0))
            + z2 * (1.0 / 6_227_020_800.0 - z * (1.0 / 1_307_674_368_000.0)));
    (cos, sinc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_those_of_the_library() {
        for i in 0..=4000 {
            let x = f64::from(i) * 0.0005;
            let (cos, sinc) = cosine_and_sinc(x * x);
            let exact = if x == 0.0 { 1.0 } else { x.sin() / x };
            assert!((cos - x.cos()).abs() <= 2.0 * f64::EPSILON, "{x}");
            assert!((sinc - exact).abs() <= 2.0 * f64::EPSILON, "{x}");
        }
    }
}
