//! Counter-based random numbers, which depend only on the seed, a name and the number of the body.
//!
//! ChaCha8 maps a key and a counter to 64 random bytes. The key is the seed and the name, the counter is the body: body i
//! owns the i-th block of eight 64-bit words, in whatever order bodies are drawn.
//!
//! All arithmetic uses `+ − × ÷ √` only, so the numbers have the same bits on every machine.

use crate::numerics::lanes::{exp_minus, horner};
use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// Upper bound of [`normal`]: the quantile of the smallest probability, 2⁻⁵³, is 8.2095.
pub(crate) const LARGEST_NORMAL: f64 = 8.21;

/// The random words of successive bodies.
pub(crate) struct Words(ChaCha8Rng);

impl Words {
    /// The words of a name, starting with body `first`.
    pub fn new(seed: u64, name: &str, first: u64) -> Words {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&hash(name).to_le_bytes());
        let mut words = ChaCha8Rng::from_seed(key);
        words.set_block_pos(first);
        Words(words)
    }
}

impl Iterator for Words {
    type Item = [u64; 8];

    fn next(&mut self) -> Option<[u64; 8]> {
        Some(std::array::from_fn(|_| self.0.next_u64()))
    }
}

/// The hash FNV-1a.
fn hash(name: &str) -> u64 {
    name.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// One of 2⁵² equally spaced numbers between −½ and ½, symmetric about 0, which is not one of them.
fn centered(word: u64) -> f64 {
    ((word >> 12) as f64 + 0.5) / (1u64 << 52) as f64 - 0.5
}

/// A uniform number between −1 and 1.
pub(crate) fn uniform(word: u64) -> f64 {
    2.0 * centered(word)
}

/// A standard normal number: the quantile of the probability that the word gives, by Wichura's rational functions
/// (algorithm AS 241, Appl. Statist. 37, 1988), to a relative error of 1e-15.
///
/// Near the middle their argument is the distance q of the probability from ½, in the tails `r = √(−ln p)`, p the
/// smaller tail probability. Never 0, and never larger than [`LARGEST_NORMAL`].
#[allow(clippy::excessive_precision)]
pub(crate) fn normal(word: u64) -> f64 {
    const MIDDLE: [[f64; 8]; 2] = [
        [
            3.387132872796366608,
            133.14166789178437745,
            1971.5909503065514427,
            13731.693765509461125,
            45921.953931549871457,
            67265.770927008700853,
            33430.575583588128105,
            2509.0809287301226727,
        ],
        [
            1.0,
            42.313330701600911252,
            687.1870074920579083,
            5394.1960214247511077,
            21213.794301586595867,
            39307.89580009271061,
            28729.085735721942674,
            5226.495278852545925,
        ],
    ];
    const TAIL: [[f64; 8]; 2] = [
        [
            1.42343711074968357734,
            4.6303378461565452959,
            5.7694972214606914055,
            3.64784832476320460504,
            1.27045825245236838258,
            0.24178072517745061177,
            0.0227238449892691845833,
            7.7454501427834140764e-4,
        ],
        [
            1.0,
            2.05319162663775882187,
            1.6763848301838038494,
            0.68976733498510000455,
            0.14810397642748007459,
            0.0151986665636164571966,
            5.475938084995344946e-4,
            1.05075007164441684324e-9,
        ],
    ];
    const FAR_TAIL: [[f64; 8]; 2] = [
        [
            6.6579046435011037772,
            5.4637849111641143699,
            1.7848265399172913358,
            0.29656057182850489123,
            0.026532189526576123093,
            0.0012426609473880784386,
            2.71155556874348757815e-5,
            2.01033439929228813265e-7,
        ],
        [
            1.0,
            0.59983220655588793769,
            0.13692988092273580531,
            0.0148753612908506148525,
            7.868691311456132591e-4,
            1.8463183175100546818e-5,
            1.4215117583164458887e-7,
            2.04426310338993978564e-15,
        ],
    ];
    let quotient = |[above, below]: &[[f64; 8]; 2], x: f64| horner(above, x) / horner(below, x);
    let q = centered(word);
    if q.abs() <= 0.425 {
        return q * quotient(&MIDDLE, 0.180625 - q * q);
    }
    let r = (-ln(0.5 - q.abs())).sqrt();
    let size = if r <= 5.0 { quotient(&TAIL, r - 1.6) } else { quotient(&FAR_TAIL, r - 5.0) };
    size.copysign(q)
}

/// The logarithm of a normal float > 0, to a few roundings of the larger of it and 1.
///
/// `x = m 2^e` with m from √½ to √2, and `ln m = 2 artanh s`, `s = (m − 1)/(m + 1)`, |s| < 0.172: the terms
/// `s^(2k+1)/(2k + 1)` of its series fall below 2⁻⁵³ s for k = 10.
fn ln(x: f64) -> f64 {
    /// 1/(2k + 1).
    const SERIES: [f64; 11] = {
        let mut series = [0.0; 11];
        let mut k = 0;
        while k < 11 {
            series[k] = 1.0 / (2 * k + 1) as f64;
            k += 1;
        }
        series
    };
    let bits = x.to_bits();
    let (mut exponent, mut m) =
        ((bits >> 52) as f64 - 1023.0, f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52));
    if m > std::f64::consts::SQRT_2 {
        (exponent, m) = (exponent + 1.0, 0.5 * m);
    }
    let s = (m - 1.0) / (m + 1.0);
    exponent * std::f64::consts::LN_2 + 2.0 * s * horner(&SERIES, s * s)
}

/// `e^x`, for |x| < 700.
pub(crate) fn exp(x: f64) -> f64 {
    let small = exp_minus(x.abs()).0;
    if x > 0.0 { 1.0 / small } else { small }
}

#[cfg(test)]
mod tests;
