//! Positions on Kepler orbits, in lanes; a single orbit has one lane and the same bits.
//!
//! Kepler's equation `M = E − e sin E`, for `0 <= M <= π` by symmetry, is `f(E) = (1−e) E + e (E − sin E) − M = 0`: no
//! term cancels another, so f keeps its digits near the periapsis of a long ellipse too. Its root is found without
//! iteration or branches, in two parts.
//!
//! 1. The start of F. L. Markley (Kepler equation solver, Celest. Mech. Dyn. Astron. 63, 1995): the root of the cubic
//!    equation that follows from `sin E ≈ E (6α − (α−3) E²)/(6α + 3E²)`, with `α(M)` exact for `e = 1` at M = 0 and
//!    π. Its relative error ε, largest on `e -> 1`, `E = 1.18`, is below 2.9e-4; with a cube root good to 3e-5, below
//!    3.2e-4.
//! 2. The root of f's series about the start, reverted to order 4 in `u = f/f'`: with `a = f''/2f'`, `b = f'''/6f'` and
//!    `c = f''''/24f'`,
//!
//!    ```text
//!    E = E1 − (u + a u² + (2a² − b) u³ + (5a³ − 5ab + c) u⁴ + r),     r ≈ (14a⁴ − 21a²b + 3b² + 6ac − d) u⁵.
//!    ```
//!
//!    For every e below 1, `f' = (1−e) + e (1 − cos E)` exceeds `e (1 − cos E)`, so `a E <= ½E cot ½E <= 1`,
//!    `|b| E² <= E²/(6 (1 − cos E)) <= π²/12` where cos E < 0 and `<= ⅓` elsewhere, `|c| E³ < ¼` and `|d| E⁴ < ½`: the
//!    rest r is below `18 ε⁴ u`, which is 2⁻⁵⁶ of E. Rounding alone is left: E gets the relative error of f, and dE/E
//!    is `M/(E f') <= 1` times dM/M.
//!
//! Sine and cosine are computed once, of the start, and turned by the small difference.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::{Phase, sin_cos_turns};
use std::f64::consts::{PI, TAU};

/// Constants of orbits, one in each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Elements<const W: usize> {
    /// Turns per second, as sums.
    rate: [[f64; W]; 2],
    /// Turns at time 0, less whole ones, as sums.
    start: [[f64; W]; 2],
    eccentricity: [f64; W],
    /// `√(1−e²)`
    side: [f64; W],
    /// The part of α that M takes off for each rad less than π.
    slope: [f64; W],
    /// Whether there are circles, and ellipses.
    kinds: [bool; 2],
}

impl<const W: usize> Elements<W> {
    /// Of orbits that each have one lane.
    pub fn new(each: [&Elements<1>; W]) -> Elements<W> {
        let of = |numbers: fn(&Elements<1>) -> f64| each.map(numbers);
        Elements {
            rate: [of(|one| one.rate[0][0]), of(|one| one.rate[1][0])],
            start: [of(|one| one.start[0][0]), of(|one| one.start[1][0])],
            eccentricity: of(|one| one.eccentricity[0]),
            side: of(|one| one.side[0]),
            slope: of(|one| one.slope[0]),
            kinds: [0, 1].map(|kind| each.iter().any(|one| one.kinds[kind])),
        }
    }

    /// Positions over the semi-major axis: towards the periapsis, across, and the distance. With the versine
    /// `v = 1 − cos E` they are `(1−e) − v`, `√(1−e²) sin E` and `(1−e) + e v`: small near the periapsis of a long
    /// ellipse, where `1 − e` is exact.
    #[inline(always)]
    pub fn positions<const FMA: bool>(&self, times: &[f64; W]) -> [[f64; W]; 3] {
        let [mut part, mut rest] = [[0.0; W]; 2];
        for l in 0..W {
            let rate = DoubleDouble { hi: self.rate[0][l], lo: self.rate[1][l] };
            let phase = Phase { rate, start: [self.start[0][l], self.start[1][l]] };
            (part[l], rest[l]) = phase.turns::<FMA>(times[l]);
            // After 10³⁵ turns nothing is known of the phase, and the rest may be anything.
            rest[l] = if rest[l].abs() < 1e-6 { rest[l] } else { 0.0 };
        }
        match self.kinds {
            [true, true] => {
                let (circles, mut places) =
                    (on_circles::<W, FMA>(&part, &rest), self.on_ellipses(&part, &rest));
                for l in 0..W {
                    for k in 0..3 {
                        places[k][l] = if self.eccentricity[l] == 0.0 { circles[k][l] } else { places[k][l] };
                    }
                }
                places
            }
            [_, false] => on_circles::<W, FMA>(&part, &rest),
            [false, true] => self.on_ellipses(&part, &rest),
        }
    }

    /// Directions u, whose third component is 0, and `(a/r)³`.
    #[inline(always)]
    pub fn places<const FMA: bool>(&self, times: &[f64; W]) -> [[f64; W]; 3] {
        let [mut x, mut y, mut nearness] = self.positions::<FMA>(times);
        if self.kinds[1] {
            for l in 0..W {
                let near = 1.0 / nearness[l];
                x[l] *= near;
                y[l] *= near;
                nearness[l] = near * near * near;
            }
        }
        [x, y, nearness]
    }

    /// At mean anomalies in turns, each with a small rest.
    #[inline(always)]
    fn on_ellipses(&self, part: &[f64; W], rest: &[f64; W]) -> [[f64; W]; 3] {
        let [mut mean, mut start, mut error, mut sin, mut versine, mut off] = [[0.0; W]; 6];
        for l in 0..W {
            let size = (TAU * (part[l] + rest[l])).abs();
            // False for NaN, which stays.
            mean[l] = if size > PI { PI } else { size };
        }
        for l in 0..W {
            start[l] = markley(mean[l], self.eccentricity[l], self.slope[l]);
        }
        for l in 0..W {
            let (less_its_sine, v) = small_differences(start[l]);
            let e = self.eccentricity[l];
            error[l] = ((1.0 - e) * start[l] + e * less_its_sine) - mean[l];
            (sin[l], versine[l]) = (start[l] - less_its_sine, v);
        }
        for l in 0..W {
            off[l] = reverted(error[l], self.eccentricity[l], sin[l], versine[l]);
        }
        let mut places = [[0.0; W]; 3];
        for l in 0..W {
            let (sin, v) = turned_back(sin[l], versine[l], off[l]);
            let e = self.eccentricity[l];
            places[0][l] = (1.0 - e) - v;
            places[1][l] = (self.side[l] * sin).copysign(part[l] + rest[l]);
            places[2][l] = (1.0 - e) + e * v;
        }
        places
    }
}

impl Elements<1> {
    /// The mean motion n in rad/s, the eccentricity, and the mean anomaly at time 0 in rad.
    pub fn one(rate: f64, eccentricity: f64, anomaly: f64) -> Elements<1> {
        let turns = |angle: f64| DoubleDouble::from(angle) * DoubleDouble::OVER_TWO_PI;
        let (rate, start) = (turns(rate), turns(anomaly));
        let start = start - start.hi.round().into();
        let e = eccentricity;
        Elements {
            rate: [[rate.hi], [rate.lo]],
            start: [[start.hi], [start.lo]],
            eccentricity: [e],
            side: [((1.0 - e) * (1.0 + e)).sqrt()],
            slope: [1.6 * PI / ((PI * PI - 6.0) * (1.0 + e))],
            kinds: [e == 0.0, e != 0.0],
        }
    }
}

#[inline(always)]
fn on_circles<const W: usize, const FMA: bool>(part: &[f64; W], rest: &[f64; W]) -> [[f64; W]; 3] {
    let mut places = [[0.0; W], [0.0; W], [1.0; W]];
    for l in 0..W {
        (places[1][l], places[0][l]) = sin_cos_turns::<FMA>(part[l], rest[l]);
    }
    places
}

/// The start for `0 <= M <= π`. With `d = 3(1−e) + α e`, `q = 2αd(1−e) − M²`, `r = 3αd(d−1+e) M + M³` and
/// `w = (r + √(q³+r²))^⅔` it is `(2rw/(w² + wq + q²) + M)/d`: no difference of large numbers, and never `w = 0`.
#[inline(always)]
fn markley(m: f64, e: f64, slope: f64) -> f64 {
    const LEAST: f64 = 3.0 * PI * PI / (PI * PI - 6.0);
    let alpha = LEAST + slope * (PI - m);
    let near = 1.0 - e;
    let d = 3.0 * near + alpha * e;
    let ad = alpha * d;
    let q = (ad + ad) * near - m * m;
    let r = (3.0 * (ad * (d - near)) + m * m) * m;
    let x = r + (q * (q * q) + r * r).sqrt();
    let w = x * reciprocal_cube_root(x);
    let square = w * w + q * (w + q);
    ((r + r) * w + m * square) / (square * d)
}

/// `x^(−⅓)` for a normal x > 0, to 3e-5.
///
/// A third of the exponent, and of the digits with it, gives y to 3.4 %. With `h = 1 − x y³` the result is
/// `y (1−h)^(−⅓)`, a series in h, `|h| < 0.11`, whose next term is `35/243 h⁴`.
#[inline(always)]
fn reciprocal_cube_root(x: f64) -> f64 {
    /// 4/3 of the exponent's bias in the upper half, less what makes the errors of either sign equal.
    const FROM: u64 = 0x553E_F0FF;
    // A third, exact to the last of the 31 bits.
    let third = ((x.to_bits() >> 32) * 0x5555_5556) >> 32;
    let y = f64::from_bits((FROM - third) << 32);
    let h = 1.0 - x * (y * (y * y));
    y + y * (h * (1.0 / 3.0 + h * (2.0 / 9.0 + h * (14.0 / 81.0))))
}

/// `x − sin x` and `1 − cos x` for `0 <= x <= 1.0005 π`, each with a relative error of a few roundings. The polynomials
/// in x² are minimax, good to 2⁻⁵⁷ and 2⁻⁶¹.
#[inline(always)]
fn small_differences(x: f64) -> (f64, f64) {
    const S: [f64; 10] = [
        0.166_666_666_666_666_66,
        -0.008_333_333_333_333_321,
        0.000_198_412_698_412_657_7,
        -2.755_731_922_345_791_6e-6,
        2.505_210_835_066_091_3e-8,
        -1.605_904_251_999_768e-10,
        7.647_133_351_839_128e-13,
        -2.811_022_759_895_743_3e-15,
        8.182_961_464_280_953e-18,
        -1.774_991_384_929_046_6e-20,
    ];
    const C: [f64; 11] = [
        0.5,
        -0.041_666_666_666_666_664,
        0.001_388_888_888_888_882_7,
        -2.480_158_730_157_760_5e-5,
        2.755_731_922_319_996e-7,
        -2.087_675_695_069_266_8e-9,
        1.147_074_450_088_671_8e-11,
        -4.779_456_530_704_528_4e-14,
        1.561_666_869_446_873e-16,
        -4.091_023_794_585_402e-19,
        8.061_372_270_886_715e-22,
    ];
    let z = x * x;
    let (zz, z4) = (z * z, (z * z) * (z * z));
    let low = (S[0] + z * S[1]) + zz * (S[2] + z * S[3]);
    let middle = (S[4] + z * S[5]) + zz * (S[6] + z * S[7]);
    let s = low + z4 * (middle + z4 * (S[8] + z * S[9]));
    let low = (C[0] + z * C[1]) + zz * (C[2] + z * C[3]);
    let middle = (C[4] + z * C[5]) + zz * (C[6] + z * C[7]);
    let c = low + z4 * (middle + z4 * ((C[8] + z * C[9]) + zz * C[10]));
    ((x * z) * s, z * c)
}

/// The start less the root, from f, sine and versine at the start.
#[inline(always)]
fn reverted(f: f64, e: f64, sin: f64, versine: f64) -> f64 {
    let inverse = 1.0 / ((1.0 - e) + e * versine);
    let u = f * inverse;
    let scaled = e * inverse;
    let a = 0.5 * (scaled * sin);
    let b = (1.0 / 6.0) * (scaled * (1.0 - versine));
    // c is −a/12.
    let third = (a + a) * a - b;
    let fourth = a * (5.0 * (a * a - b) - 1.0 / 12.0);
    u + u * (u * (a + u * (third + u * fourth)))
}

/// Sine and versine of `x − y` from those of x, for `|y| < 1.1e-3`: the next terms of the series are below 2⁻⁵⁶ of y.
#[inline(always)]
fn turned_back(sin: f64, versine: f64, y: f64) -> (f64, f64) {
    let square = y * y;
    let (sin_y, versine_y) = (y - y * (square * (1.0 / 6.0)), square * (0.5 - square * (1.0 / 24.0)));
    let cos = 1.0 - versine;
    (sin - (cos * sin_y + sin * versine_y), versine + (cos * versine_y - sin * sin_y))
}

#[cfg(test)]
mod tests;
