//! The theta series of a free motion, as polynomials.
//!
//! Used by [`super`] in two forms: trigonometric functions for a small nome `q = exp(−πK'/K)`, hyperbolic ones for a
//! small `q' = exp(−πK/K')`. At the border q = 0.2, q' = 0.002, omitted terms are below 1e-17. A harmonic is a Chebyshev
//! polynomial in `cos 2v` (or `cosh`) times one of sin v, cos v and sin 2v,
//!
//! ```text
//! cos 2nv = T_n,  sin 2nv = sin 2v U_{n−1},  sin (2n+1)v = sin v W_n,  cos (2n+1)v = cos v V_n,
//! ```
//!
//! all with `p_{n+1} = 2x p_n − p_{n−1}`. The factors sin v etc. keep the relative accuracy where a function vanishes.

use crate::exact::lanes::Coefficients;
use crate::numerics::lanes::{
    decay, exp_minus, half_period, horner_in_lane, in_lane, sin_cos_of_quarter, sin_cos_turns,
};
use polhode_ga::simd::lanes::Lanes;
use std::f64::consts::PI;

/// Numbers of `C` motions, computed as those of one.
pub(crate) type Numbers<const C: usize> = Lanes<C, false>;

/// Largest nome of the trigonometric series.
pub(crate) const LARGEST_NOME: f64 = 0.2;

/// Values of the series at `W` times: the rotor `Z` up to its norm, in the frame (e1, e2, d) of quaternion units; cn, sn
/// and dn up to a common denominator; and the part of a turn to add to the precession.
pub(crate) struct State<const W: usize> {
    pub z: [[f64; W]; 4],
    pub functions: [[f64; W]; 3],
    pub denominator: [f64; W],
    pub ahead: [f64; W],
}

/// Series in one form or the other, of one motion or of `C` in lanes.
pub(crate) trait Series<const C: usize>: Coefficients<C, One = <Self as Series<C>>::Alone> {
    /// The series of one motion.
    type Alone: Series<1>;

    /// From `v/2π = u/4K`, reduced to [−½, ½], and its rounding error.
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W>;

    /// Factors that make cn 0, sn K and dn 0 equal to 1.
    fn normalizers(&self) -> [[f64; C]; 3];
}

/// `Σ h_n p_n(x)` in powers of x, with `p_0 = 1` and the given `p_{−1}`.
#[inline(always)]
pub(crate) fn chebyshev<const N: usize, const C: usize>(
    h: &[Numbers<C>; N],
    before: [f64; 2],
) -> [Numbers<C>; N] {
    let (mut previous, mut p, mut sum) = ([0.0; N], [0.0; N], [Numbers::ZERO; N]);
    previous[..2].copy_from_slice(&before);
    p[0] = 1.0;
    for n in 0..N {
        for k in 0..=n {
            sum[k] += h[n] * Numbers::all(p[k]);
        }
        let mut next = [0.0; N];
        for k in 0..N {
            next[k] = if k == 0 { 0.0 } else { 2.0 * p[k - 1] } - previous[k];
        }
        (previous, p) = (p, next);
    }
    sum
}

/// `p_{−1}` of T_n, U_n, V_n and W_n.
pub(crate) const FIRST: [f64; 2] = [0.0, 1.0];
const SECOND: [f64; 2] = [0.0, 0.0];
pub(crate) const THIRD: [f64; 2] = [1.0, 0.0];
pub(crate) const FOURTH: [f64; 2] = [-1.0, 0.0];

/// −1 for odd n.
#[inline(always)]
pub(crate) fn sign(n: usize) -> f64 {
    if n % 2 == 1 { -1.0 } else { 1.0 }
}

/// `xⁿ` by squares.
#[inline(always)]
pub(crate) fn power<const C: usize>(x: Numbers<C>, n: usize) -> Numbers<C> {
    let (mut result, mut square) = (Numbers::all(1.0), x);
    // Exponents are constants below 32, for which the loop is unrolled.
    for bit in 0..5 {
        if n >> bit & 1 == 1 {
            result = result * square;
        }
        square = square * square;
    }
    result
}

/// Coefficients, where those below a limit are 0: subnormal numbers are slow on many machines, and negligible.
#[inline(always)]
pub(crate) fn normal<const C: usize, const N: usize>(c: &[Numbers<C>; N], least: f64) -> [[f64; C]; N] {
    let mut normal = [[0.0; C]; N];
    for k in 0..N {
        for l in 0..C {
            let Lanes(c) = &c[k];
            normal[k][l] = if c[l].abs() < least { 0.0 } else { c[l] };
        }
    }
    normal
}

/// Sine and cosine of the sum of two angles.
#[inline(always)]
pub(crate) fn of_sum<const C: usize>(
    [sin, cos]: [Numbers<C>; 2],
    [other_sin, other_cos]: [Numbers<C>; 2],
) -> [Numbers<C>; 2] {
    [sin * other_cos + cos * other_sin, cos * other_cos - sin * other_sin]
}

/// Series in the nome q.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circular<const C: usize = 1> {
    z: [[[f64; C]; 4]; 4],
    functions: [[[f64; C]; 5]; 3],
    denominator: [[f64; C]; 5],
}

impl Circular {
    /// Steady rotation: nothing but precession.
    pub fn steady() -> Circular {
        let mut steady = Circular::empty();
        steady.set(&[0.0], &[0.0], &[1.0]);
        steady
    }
}

impl<const C: usize> Circular<C> {
    /// Takes the series of the nomes, of `ρ = exp(−π(K' − η)/2K)` and s. With `q^{1/2} e^{±y} = ρ, q/ρ` the coefficients of
    /// `θ4(v − i s y | q²)` and `s θ1(v − i s y | q²)` are sums and differences of two positive numbers.
    #[inline(always)]
    pub fn set(&mut self, q: &[f64; C], rho: &[f64; C], s: &[f64; C]) {
        /// Coefficients below this are negligible.
        const LEAST: f64 = 1e-100;
        let [q, rho, s]: [Numbers<C>; 3] = [Lanes(*q), Lanes(*rho), Lanes(*s)];
        let mut other = Numbers::ZERO;
        for l in 0..C {
            other.0[l] = if rho.0[l] > 0.0 { q.0[l] / rho.0[l] } else { 0.0 };
        }
        let one = Numbers::all(1.0);
        let ([mut even, mut less_even], [mut odd, mut less_odd]) = ([[one; 4]; 2], [[one; 4]; 2]);
        for n in 0..4 {
            if n > 0 {
                let weight = Numbers::all(sign(n)) * power(q, 2 * n * n - n);
                let (a, b) = (power(rho, 2 * n), power(other, 2 * n));
                (even[n], less_even[n - 1]) = (weight * (a + b), s * (weight * (a - b)));
            }
            let weight = Numbers::all(sign(n)) * power(q, 2 * n * n + n);
            let (a, b) = (power(rho, 2 * n + 1), power(other, 2 * n + 1));
            (odd[n], less_odd[n]) = (s * (weight * (a + b)), -(weight * (a - b)));
        }
        let [first, second, third, _] = less_even;
        let [a, b, c] = chebyshev(&[first, second, third], SECOND);
        self.z = [
            normal(&chebyshev(&even, FIRST), LEAST),
            normal(&chebyshev(&odd, FOURTH), LEAST),
            normal(&chebyshev(&less_odd, THIRD), LEAST),
            normal(&[a, b, c, Numbers::ZERO], LEAST),
        ];
        let [mut pronics, mut squares, mut other_pronics, mut other_squares] = [[one; 5]; 4];
        for n in 1..5 {
            let alternating = Numbers::all(sign(n));
            (pronics[n], squares[n]) = (power(q, n * n + n), Numbers::all(2.0) * power(q, n * n));
            (other_pronics[n], other_squares[n]) = (alternating * pronics[n], alternating * squares[n]);
        }
        self.functions = [
            normal(&chebyshev(&pronics, THIRD), LEAST),
            normal(&chebyshev(&other_pronics, FOURTH), LEAST),
            normal(&chebyshev(&squares, FIRST), LEAST),
        ];
        self.denominator = normal(&chebyshev(&other_squares, FIRST), LEAST);
    }
}

impl<const C: usize> Series<C> for Circular<C> {
    type Alone = Circular;

    #[inline(always)]
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W> {
        let (mut sin, mut cos, mut x) = ([0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            (sin[l], cos[l]) = sin_cos_turns::<FMA>(turns[l], rest[l]);
            // cos 2v, from the smaller of the two.
            x[l] = 1.0 - 2.0 * (sin[l] * sin[l]);
        }
        let mut z = [[0.0; W]; 4];
        let [even, alternating, odd, [rest @ .., _]] = &self.z;
        for l in 0..W {
            z[0][l] = horner_in_lane(even, l, x[l]);
            z[1][l] = sin[l] * horner_in_lane(alternating, l, x[l]);
            z[2][l] = cos[l] * horner_in_lane(odd, l, x[l]);
            z[3][l] = (2.0 * sin[l] * cos[l]) * horner_in_lane::<3, C>(rest, l, x[l]);
        }
        let (mut functions, mut denominator) = ([[0.0; W]; 3], [0.0; W]);
        for l in 0..W {
            functions[0][l] = cos[l] * horner_in_lane(&self.functions[0], l, x[l]);
            functions[1][l] = sin[l] * horner_in_lane(&self.functions[1], l, x[l]);
            functions[2][l] = horner_in_lane(&self.functions[2], l, x[l]);
            denominator[l] = horner_in_lane(&self.denominator, l, x[l]);
        }
        State { z, functions, denominator, ahead: [0.0; W] }
    }

    #[inline(always)]
    fn normalizers(&self) -> [[f64; C]; 3] {
        let mut factors = [[0.0; C]; 3];
        for (k, x) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            for l in 0..C {
                factors[k][l] =
                    horner_in_lane(&self.denominator, l, x) / horner_in_lane(&self.functions[k], l, x);
            }
        }
        factors
    }
}

impl<const C: usize> Coefficients<C> for Circular<C> {
    type One = Circular;

    fn empty() -> Circular<C> {
        let none = [0.0; C];
        Circular { z: [[none; 4]; 4], functions: [[none; 5]; 3], denominator: [none; 5] }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let (z, functions) = (self.z.as_flattened_mut(), self.functions.as_flattened_mut());
        z.iter_mut().chain(functions).chain(&mut self.denominator)
    }
}

/// Series in the nome q', by Jacobi's imaginary transformation, in `x = πu/4K'` for u within a half period; at
/// u = ±K it is ±X.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hyperbolic<const C: usize = 1> {
    /// X.
    border: [f64; C],
    nome: [f64; C],
    z: [[[f64; C]; 4]; 4],
    functions: [[[f64; C]; 4]; 3],
    denominator: [[f64; C]; 4],
    ahead: [f64; C],
}

/// Scale of u in turns on the separatrix: the border is never reached.
pub(crate) const NEVER: f64 = (1u128 << 70) as f64;

impl<const C: usize> Hyperbolic<C> {
    /// Takes the series of X, of `γ = πη/4K'` in [0, π/4] and of s. On the separatrix, the limit K → ∞, `u = NEVER · turns`.
    #[inline(always)]
    pub fn set<const FMA: bool>(
        &mut self,
        border: &[f64; C],
        gamma: &[f64; C],
        s: &[f64; C],
        on_separatrix: &[bool; C],
    ) {
        let (mut root, mut odd) = (Numbers::<C>::ZERO, [Numbers::<C>::ZERO; 2]);
        for l in 0..C {
            self.border[l] = if on_separatrix[l] { NEVER / 8.0 } else { border[l] };
            self.ahead[l] = if on_separatrix[l] { 0.0 } else { s[l] * gamma[l] / PI };
            root.0[l] = decay(2.0 * self.border[l]);
            (odd[0].0[l], odd[1].0[l]) = sin_cos_of_quarter::<FMA>(gamma[l]);
        }
        let (nome, s, two) = (root * root, Lanes(*s), Numbers::all(2.0));
        self.nome = nome.0;
        // The sines and cosines of odd multiples of γ, with their weights q'^{(n² + n)/2}, at most q' but for the first.
        let double = of_sum(odd, odd);
        let [mut sin, mut cos] = odd.map(|first| [first; 4]);
        let [mut pronics, mut squares] = [[Numbers::all(1.0); 4]; 2];
        for n in 1..4 {
            odd = of_sum(odd, double);
            let weight = power(root, n * n + n);
            (sin[n], cos[n]) = (weight * odd[0], weight * odd[1]);
            (pronics[n], squares[n]) = (power(nome, n * n + n), two * power(nome, n * n));
        }
        let (mut other_cos, mut other_sin, mut less_sin, mut other_pronics) = (cos, sin, sin, pronics);
        for n in 0..4 {
            let alternating = Numbers::all(sign(n));
            (other_cos[n], other_sin[n]) = (s * (alternating * cos[n]), -(alternating * sin[n]));
            (less_sin[n], other_pronics[n]) = (-(s * sin[n]), alternating * pronics[n]);
        }
        self.z = [
            normal(&chebyshev(&cos, THIRD), 0.0),
            normal(&chebyshev(&other_cos, FOURTH), 0.0),
            normal(&chebyshev(&other_sin, THIRD), 0.0),
            normal(&chebyshev(&less_sin, FOURTH), 0.0),
        ];
        // θ4(2ix|q') without the factor that vanishes at ±X: 1 − 2q'³ cosh 4x and 1 − 2q'⁵ cosh 4x.
        let (third, fifth) = (two * power(nome, 3), two * power(nome, 5));
        self.functions = [
            normal(&[Numbers::all(1.0), -(third + fifth), third * fifth, Numbers::ZERO], 0.0),
            normal(&chebyshev(&other_pronics, FOURTH), 0.0),
            normal(&chebyshev(&squares, FIRST), 0.0),
        ];
        self.denominator = normal(&chebyshev(&pronics, THIRD), 0.0);
    }
}

impl<const C: usize> Series<C> for Hyperbolic<C> {
    type Alone = Hyperbolic;

    #[inline(always)]
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W> {
        /// Largest argument with a finite `cosh²`; 2X of a periodic motion is less.
        const MOST: f64 = 352.0;
        let (mut ahead, mut odd, mut side) = ([0.0; W], [0.0; W], [0.0; W]);
        // 4|x| and 8(X − |x|), as far as they matter.
        let (mut near, mut far) = ([0.0; W], [0.0; W]);
        for l in 0..W {
            let at = half_period(turns[l], rest[l]);
            (odd[l], side[l]) = (at.odd, at.side);
            ahead[l] = in_lane(&self.ahead, l) * (at.part + 2.0 * rest[l]);
            let border = in_lane(&self.border, l);
            near[l] = (4.0 * border * at.from_middle).min(MOST);
            far[l] = (8.0 * border * at.to_border).min(700.0);
        }
        // e^{−2|x|} and less 1; 1 − e^{−4(X − |x|)}.
        let (mut g, mut m, mut last) = ([0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            (g[l], m[l]) = exp_minus(near[l]);
            last[l] = -exp_minus(far[l]).1;
        }
        let mut c = [0.0; W];
        for l in 0..W {
            c[l] = 0.5 * (g[l] + 1.0 / g[l]);
        }
        // All in units of ½ e^{|x|}.
        let mut z = [[0.0; W]; 4];
        for l in 0..W {
            let (cosh, sinh) = (1.0 + g[l], -m[l] * side[l]);
            z[0][l] = cosh * horner_in_lane(&self.z[0], l, c[l]);
            z[1][l] = odd[l] * (sinh * horner_in_lane(&self.z[1], l, c[l]));
            z[2][l] = odd[l] * (cosh * horner_in_lane(&self.z[2], l, c[l]));
            z[3][l] = sinh * horner_in_lane(&self.z[3], l, c[l]);
        }
        // And these in units of ½ e^{2|x|}.
        let (mut functions, mut denominator) = ([[0.0; W]; 3], [0.0; W]);
        for l in 0..W {
            let y = 2.0 * (c[l] * c[l]) - 1.0;
            let square = g[l] * g[l];
            let cosine = (2.0 * g[l]) * (last[l] * (1.0 - in_lane(&self.nome, l) * square));
            functions[0][l] = odd[l] * (cosine * horner_in_lane(&self.functions[0], l, y));
            functions[1][l] =
                (odd[l] * side[l]) * ((-m[l] * (1.0 + g[l])) * horner_in_lane(&self.functions[1], l, y));
            functions[2][l] = (2.0 * g[l]) * horner_in_lane(&self.functions[2], l, y);
            denominator[l] = (1.0 + square) * horner_in_lane(&self.denominator, l, y);
        }
        State { z, functions, denominator, ahead }
    }

    /// From cn and dn at x = 0, and sn at X, where `k² sn² + dn² = 1` with dn = k'.
    fn normalizers(&self) -> [[f64; C]; 3] {
        let mut factors = [[0.0; C]; 3];
        for l in 0..C {
            let denominator = |y: f64| horner_in_lane(&self.denominator, l, y);
            let function = |k: usize, y: f64| horner_in_lane(&self.functions[k], l, y);
            let at_0 = |k: usize| denominator(1.0) / function(k, 1.0);
            let double = 2.0 * self.border[l].min(176.0);
            let g = decay(double);
            let y = 0.5 * (1.0 / (g * g) + g * g);
            let sinh = (1.0 - g * g) / (1.0 + g * g) * function(1, y);
            let less = (1.0 - self.nome[l]) * (1.0 - self.nome[l]);
            (factors[0][l], factors[1][l], factors[2][l]) = (at_0(0) / less, denominator(y) / sinh, at_0(2));
        }
        factors
    }
}

impl<const C: usize> Coefficients<C> for Hyperbolic<C> {
    type One = Hyperbolic;

    fn empty() -> Hyperbolic<C> {
        let none = [0.0; C];
        Hyperbolic {
            border: none,
            nome: none,
            z: [[none; 4]; 4],
            functions: [[none; 4]; 3],
            denominator: [none; 4],
            ahead: none,
        }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let (z, functions) = (self.z.as_flattened_mut(), self.functions.as_flattened_mut());
        let single = [&mut self.border, &mut self.nome, &mut self.ahead];
        z.iter_mut().chain(functions).chain(&mut self.denominator).chain(single)
    }
}
