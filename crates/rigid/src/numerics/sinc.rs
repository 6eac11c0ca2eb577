//! Cosine and sine of small turns.

use polhode_ga::simd::lanes::Lanes;

/// `cos x` and `sin x/x` of `x² = square`, to a rounding or two.
///
/// Up to `x = ½` by series in x²; the first omitted term is `2⁻¹⁶/16!`, below 1e-18. Adding adjacent terms first allows
/// parallel multiplications. Beyond, lane by lane, by the standard library.
#[inline(always)]
pub(crate) fn cosine_and_sinc<const W: usize, const F: bool>(
    square: Lanes<W, F>,
) -> (Lanes<W, F>, Lanes<W, F>) {
    let c = Lanes::all;
    let z = square;
    let (z2, z4) = (z * z, (z * z) * (z * z));
    let low = z2.times_plus(z.times_from(c(1.0 / 720.0), c(1.0 / 24.0)), z.times_from(c(1.0 / 2.0), c(1.0)));
    let high = z2.times_plus(
        z.times_from(c(1.0 / 87_178_291_200.0), c(1.0 / 479_001_600.0)),
        z.times_from(c(1.0 / 3_628_800.0), c(1.0 / 40_320.0)),
    );
    let mut cos = z4.times_plus(high, low);
    let low =
        z2.times_plus(z.times_from(c(1.0 / 5_040.0), c(1.0 / 120.0)), z.times_from(c(1.0 / 6.0), c(1.0)));
    let high = z2.times_plus(
        z.times_from(c(1.0 / 1_307_674_368_000.0), c(1.0 / 6_227_020_800.0)),
        z.times_from(c(1.0 / 39_916_800.0), c(1.0 / 362_880.0)),
    );
    let mut sinc = z4.times_plus(high, low);
    let mut large = false;
    for l in 0..W {
        large |= square.0[l] > SERIES;
    }
    if large {
        beyond(&square.0, &mut cos.0, &mut sinc.0);
    }
    (cos, sinc)
}

/// Largest x² of the series.
const SERIES: f64 = 0.25;

#[cold]
#[inline(never)]
fn beyond<const W: usize>(square: &[f64; W], cos: &mut [f64; W], sinc: &mut [f64; W]) {
    for l in 0..W {
        if square[l] > SERIES {
            let x = square[l].sqrt();
            let (sin, cosine) = x.sin_cos();
            (cos[l], sinc[l]) = (cosine, sin / x);
        }
    }
}

#[cfg(test)]
mod tests;
