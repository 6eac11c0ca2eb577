//! Functions of motors `s + I₃ b + m n + p J` in lanes: the formulas of rotors over dual numbers.
//!
//! - Of a bivector `I₃ β + v n` with `C = I₃ (β + εv)`, `Θ² = −C² = θ² + 2ε β·v`: `exp C = cos Θ + C sin Θ/Θ`, where
//!   `cos Θ = cos θ − ε β·v sin θ/θ` and `sin Θ/Θ = sin θ/θ + ε β·v (cos θ − sin θ/θ)/θ²`.
//! - Of a motor of norm 1, `C = I₃ (b + εm) Θ/sin Θ` with `cos Θ = s − εp`, where
//!   `Θ/sin Θ = θ/sin θ + ε p (1 − s θ/sin θ)/sin² θ`.
//! - `M ~M = |M|² + 2εδ` with `|M|² = s² + b²` and `δ = b·m − sp`, which of a motor is 0.

use crate::rows::rotor_functions::{Exp, Log};
use crate::simd::double::quotient;
use std::array::from_fn;

/// Numbers of a motor.
pub const SIZE: usize = 8;

/// Lanes of `s, b, m, p`.
pub type Parts<const W: usize> = [[f64; W]; SIZE];

/// `exp(I₃ β + v n)` of lanes of `·, β, v, ·`; the first is NaN where the general method is needed.
#[inline(always)]
pub fn exp<const W: usize, const FMA: bool>(parts: &Parts<W>) -> Parts<W> {
    let beta = [&parts[1], &parts[2], &parts[3]];
    let [cosine, sinc] = Exp::cosine_and_sinc::<W, FMA>(beta);
    let mut out = [[0.0; W]; SIZE];
    let mut across = [0.0; W];
    for l in 0..W {
        let [_, x, y, z, u, v, w, _] = lane(parts, l);
        let square = x * x + y * y + z * z;
        let along = x * u + y * v + z * w;
        // (cos θ − sin θ/θ)/θ², whose numerator cancels near 0.
        let (near, far) = (horner(&SLOPE, -square), (cosine[l] - sinc[l]) / square);
        across[l] = along * if square < 1.0 { near } else { far };
        out[7][l] = sinc[l] * along;
    }
    for i in 1..4 {
        for l in 0..W {
            let (b, v) = (parts[i][l], parts[i + 3][l]);
            out[i][l] = sinc[l] * b;
            out[i + 3][l] = sinc[l] * v + across[l] * b;
        }
    }
    out[0] = cosine;
    out
}

/// `|M|²`, 1 where |M| is 1 to rounding, and lanes of `ln|M|`, β, v and 0; the logarithm is NaN where the general
/// method is needed. `epsilon` is the spacing of the numbers at 1.
#[inline(always)]
pub fn log<const W: usize, const FMA: bool>(parts: &Parts<W>, epsilon: f64) -> ([f64; W], Parts<W>) {
    /// Up to here `ln(1 + η)` is its series to η⁴.
    const NEAR_1: f64 = 1.0 / (1 << 13) as f64;
    let factor = Log::angle_over_size::<W, FMA>(from_fn(|i| &parts[i]));
    // Below this sin² θ a rotor near −1 may be one of any plane, up to half of the digits.
    let near_minus_1 = 4.0 * epsilon;
    let (rounding, certain) = (32.0 * epsilon, 0.25 * epsilon.sqrt());
    let (mut squares, mut out) = ([1.0; W], [[0.0; W]; SIZE]);
    let [mut sine_squared, mut excess, mut along] = [[0.0; W]; 3];
    for l in 0..W {
        let x = lane(parts, l);
        let [s, b0, b1, b2, m0, m1, m2, p] = x;
        sine_squared[l] = b0 * b0 + b1 * b1 + b2 * b2;
        let square = s * s + sine_squared[l];
        let eta = square - 1.0;
        // 1/|M|² beside 1.
        excess[l] = delta(x) * (2.0 - square);
        let size = larger(larger(1.0, m0, m1), m2, p);
        let turned = (s < 0.0) & (sine_squared[l] < near_minus_1);
        let known = (eta.abs() < NEAR_1) & (excess[l].abs() <= certain * size) & !turned;
        let logarithm = 0.5 * (eta * (1.0 - eta * (0.5 - eta * (1.0 / 3.0 - 0.25 * eta))));
        let is_one = eta.abs() <= rounding;
        let logarithm = if is_one { 0.0 } else { logarithm };
        squares[l] = if is_one { 1.0 } else { square };
        out[0][l] = if known { logarithm } else { f64::NAN };
    }
    for l in 0..W {
        let (s, p) = (parts[0][l], parts[7][l]);
        along[l] = slope(s, sine_squared[l], factor[l]) * (p + excess[l] * s);
    }
    for i in 1..4 {
        for l in 0..W {
            let (b, m) = (parts[i][l], parts[i + 3][l]);
            out[i][l] = factor[l] * b;
            out[i + 3][l] = factor[l] * (m - excess[l] * b) + along[l] * b;
        }
    }
    (squares, out)
}

/// `M/√(M ~M)` of lanes; the first is NaN if |M| is out of range.
#[inline(always)]
pub fn normalized<const W: usize, const FMA: bool>(parts: &Parts<W>) -> Parts<W> {
    let (mut unit, [mut norm, mut reciprocal, mut excess]) = (*parts, [[0.0; W]; 3]);
    for l in 0..W {
        let [s, x, y, z, ..] = lane(parts, l);
        let square = s * s + x * x + y * y + z * z;
        norm[l] = if in_range(square) { square.sqrt() } else { f64::NAN };
        reciprocal[l] = 1.0 / norm[l];
    }
    for part in &mut unit {
        for l in 0..W {
            part[l] = quotient::<FMA>(part[l], norm[l], reciprocal[l]);
        }
    }
    for l in 0..W {
        excess[l] = delta(lane(&unit, l));
    }
    for i in 1..4 {
        for l in 0..W {
            unit[i + 3][l] -= excess[l] * unit[i][l];
        }
    }
    for l in 0..W {
        unit[7][l] += excess[l] * unit[0][l];
    }
    unit
}

/// `~M/(M ~M)`; the first is NaN if |M| is out of range. `1/(|M|² + 2εδ) = (1 − 2εδ/|M|²)/|M|²`.
#[inline(always)]
pub fn inverse<const W: usize, const FMA: bool>(parts: &Parts<W>) -> Parts<W> {
    let mut out = [[0.0; W]; SIZE];
    let [mut norm, mut reciprocal, mut twice] = [[0.0; W]; 3];
    for l in 0..W {
        let x = lane(parts, l);
        let square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3];
        norm[l] = if in_range(square) { square } else { f64::NAN };
        reciprocal[l] = 1.0 / norm[l];
        twice[l] = 2.0 * delta(x) * reciprocal[l];
    }
    for i in 0..SIZE {
        for l in 0..W {
            out[i][l] = match i {
                0 => parts[0][l],
                1..4 => -parts[i][l],
                4..7 => twice[l] * parts[i - 3][l] - parts[i][l],
                _ => parts[i][l] + twice[l] * parts[0][l],
            };
            out[i][l] = quotient::<FMA>(out[i][l], norm[l], reciprocal[l]);
        }
    }
    out
}

/// Whether the reciprocal and the square of a norm² are in range.
#[inline(always)]
fn in_range(square: f64) -> bool {
    (square > 1e-100) & (square < 1e100)
}

/// The numbers of one row.
#[inline(always)]
fn lane<const W: usize>(parts: &Parts<W>, l: usize) -> [f64; SIZE] {
    let [a, b, c, d, e, f, g, h] = parts;
    [a[l], b[l], c[l], d[l], e[l], f[l], g[l], h[l]]
}

/// `δ = b·m − sp`.
#[inline(always)]
fn delta([s, b0, b1, b2, m0, m1, m2, p]: [f64; SIZE]) -> f64 {
    (b0 * m0 + b1 * m1 + b2 * m2) - s * p
}

/// `(1 − s θ/sin θ)/sin² θ` for `θ/sin θ` of a rotor near norm 1.
#[inline(always)]
fn slope(s: f64, sine_squared: f64, factor: f64) -> f64 {
    // With t = tan θ, (1 − artan(t)/t)/t² over cos² θ.
    let cosine_squared = s * s;
    let is_near = (s > 0.0) & (sine_squared < 0.0625 * cosine_squared);
    let reciprocal = 1.0 / if is_near { cosine_squared } else { sine_squared };
    let near = horner(&REST, -sine_squared * reciprocal);
    reciprocal * if is_near { near } else { 1.0 - s * factor }
}

/// The largest of a number and two magnitudes.
#[inline(always)]
fn larger(a: f64, b: f64, c: f64) -> f64 {
    let (b, c) = (b.abs(), c.abs());
    let most = if a > b { a } else { b };
    if most > c { most } else { c }
}

/// `Σ cⱼ xʲ`.
#[inline(always)]
fn horner<const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let mut sum = coefficients[N - 1];
    for k in (0..N - 1).rev() {
        sum = sum * x + coefficients[k];
    }
    sum
}

/// `(cos θ − sin θ/θ)/θ²` in −θ² for θ < 1: the next term is below `22/23! < 1e−21`.
const SLOPE: [f64; 10] = {
    let mut out = [0.0; 10];
    let mut factorial = 6.0;
    let mut k = 0;
    while k < 10 {
        let j = k as f64;
        out[k] = -2.0 * (j + 1.0) / factorial;
        factorial *= (2.0 * j + 4.0) * (2.0 * j + 5.0);
        k += 1;
    }
    out
};

/// `(1 − artan(t)/t)/t²` in −t² for t² < 1/16: the next term is below `16⁻¹³/29`.
const REST: [f64; 13] = {
    let mut out = [0.0; 13];
    let mut k = 0;
    while k < 13 {
        out[k] = 1.0 / (2 * k + 3) as f64;
        k += 1;
    }
    out
};
