//! Exponential of a step's rotation and inverse of its differential.

use polhode_ga::simd::lanes::Lanes;

/// `exp(−½σ)` and `c(θ)` for `θ² = square`, to a few roundings up to the longest turn.
///
/// With `x = ½θ` and `z = x²` two series suffice, `s = sin x/x` and `p = (s − cos x)/z`: `cos x = s − z p` and, without
/// cancellation, `c = (1 − x cot x)/4z = p/4s`. Omitted terms are below 1e-19.
#[inline(always)]
pub(super) fn exponential<const W: usize, const F: bool>(
    turn: &[Lanes<W, F>; 3],
    square: Lanes<W, F>,
) -> ([Lanes<W, F>; 4], Lanes<W, F>) {
    let z = Lanes::all(0.25) * square;
    let (sinc, rest) = (series(&SINC, z), series(&REST, z));
    let cos = z.times_from(rest, sinc);
    let half = Lanes::all(-0.5) * sinc;
    let rotor = [cos, half * turn[0], half * turn[1], half * turn[2]];
    (rotor, Lanes::all(0.25) * rest / sinc)
}

/// Coefficients of `sin x/x` in powers of x²: `(−1)ⁿ/(2n+1)!`.
const SINC: [f64; 12] = coefficients(false);

/// Coefficients of `(sin x/x − cos x)/x²`: `(−1)ⁿ (2n+2)/(2n+3)!`.
const REST: [f64; 12] = coefficients(true);

const fn coefficients(rest: bool) -> [f64; 12] {
    let mut all = [0.0; 12];
    // (2n+1)!, exact up to 22! and rounded once or twice beyond.
    let (mut n, mut factorial, mut sign) = (0, 1.0, 1.0);
    while n < 12 {
        let next = factorial * ((2 * n + 2) * (2 * n + 3)) as f64;
        all[n] = sign * if rest { (2 * n + 2) as f64 / next } else { 1.0 / factorial };
        (n, factorial, sign) = (n + 1, next, -sign);
    }
    all
}

/// A polynomial in z; adding adjacent terms first allows parallel multiplications.
#[inline(always)]
fn series<const W: usize, const F: bool>(c: &[f64; 12], z: Lanes<W, F>) -> Lanes<W, F> {
    let z2 = z * z;
    let z4 = z2 * z2;
    let mut quads = [Lanes::ZERO; 3];
    for (i, quad) in quads.iter_mut().enumerate() {
        let [a, b, c, d] = [
            Lanes::all(c[4 * i]),
            Lanes::all(c[4 * i + 1]),
            Lanes::all(c[4 * i + 2]),
            Lanes::all(c[4 * i + 3]),
        ];
        *quad = z2.times_plus(d.times_plus(z, c), b.times_plus(z, a));
    }
    z4.times_plus(z4.times_plus(quads[2], quads[1]), quads[0])
}

#[cfg(test)]
mod tests;
