//! The theta series of a heavy top, as polynomials.
//!
//! θ1 for α, θ2 for β and for the rate across the axis, over θ4 (see [`super`]). As for a free motion
//! ([`crate::exact::free::series`]) trigonometric functions serve up to a nome `q = exp(−πK'/K)` of 0.2, hyperbolic ones
//! beyond, where `q' = exp(−πK/K')` is below 0.0022.

use crate::exact::free::series::{
    FIRST, FOURTH, NEVER, Numbers, THIRD, chebyshev, normal, of_sum, power, sign,
};
use crate::exact::lanes::Coefficients;
use crate::numerics::lanes::{
    LARGEST, decay, exp_minus, half_period, horner_in_lane, in_lane, sin_cos_of_quarter, sin_cos_turns,
};
use polhode_ga::simd::lanes::Lanes;
use std::f64::consts::PI;

/// The zero of one of the three functions, at `v = i s y` or `π/2 + i s y`.
pub(crate) type Zero = Zeros<1>;

/// Those of the motions in lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Zeros<const C: usize> {
    /// s.
    pub side: [f64; C],
    /// η and K' − η.
    pub eta: [f64; C],
    pub rest: [f64; C],
}

impl<const C: usize> Zeros<C> {
    /// That of lane l.
    pub fn lane(&self, l: usize) -> Zero {
        Zeros { side: [self.side[l]], eta: [self.eta[l]], rest: [self.rest[l]] }
    }
}

/// Values of the series at `W` times: real and imaginary parts of the three functions, their denominator, and the part
/// of a turn to add to each phase.
pub(crate) struct State<const W: usize> {
    pub z: [[[f64; W]; 2]; 3],
    pub denominator: [f64; W],
    pub ahead: [[f64; W]; 3],
}

/// Series in one form or the other, of one motion or of `C` in lanes.
pub(crate) trait Series<const C: usize>: Coefficients<C, One = <Self as Series<C>>::Alone> {
    /// The series of one motion.
    type Alone: Series<1>;

    /// From `v/2π = u/4K`, reduced to [−½, ½], and its rounding error.
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W>;
}

/// Series in the nome q: `θ1(v − i s y) = sin v (…) − i s cos v (…)`, `θ2 = cos v (…) + i s sin v (…)`, the brackets
/// polynomials in cos 2v, in units of `q^¼ e^y`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circular<const C: usize = 1> {
    /// Of the three functions, the two brackets.
    z: [[[[f64; C]; 5]; 2]; 3],
    denominator: [[f64; C]; 5],
}

impl<const C: usize> Circular<C> {
    /// Takes the series of the nomes, of `M = π/2K`, and of the zeros.
    #[inline(always)]
    pub fn set(&mut self, q: &[f64; C], mean: &[f64; C], zeros: &[Zeros<C>; 3]) {
        let q: Numbers<C> = Lanes(*q);
        let [mut powers, mut alternating] = [[Numbers::all(1.0); 5]; 2];
        for n in 1..5 {
            powers[n] = power(q, n * n);
            alternating[n] = Numbers::all(2.0 * sign(n)) * powers[n];
        }
        for k in 0..3 {
            let [sums, differences] = coefficients(&powers, mean, &zeros[k], k == 0);
            // θ1 has odd harmonics with alternating signs.
            let brackets = if k == 0 {
                [chebyshev(&sums, FOURTH), chebyshev(&differences, THIRD)]
            } else {
                [chebyshev(&sums, THIRD), chebyshev(&differences, FOURTH)]
            };
            self.z[k] = [normal(&brackets[0], LEAST), normal(&brackets[1], LEAST)];
        }
        self.denominator = normal(&chebyshev(&alternating, FIRST), LEAST);
    }
}

/// Coefficients below this are negligible.
const LEAST: f64 = 1e-200;

/// `q^{n²} ρ^{2n} (1 ± e^{−2(2n+1)y})` with `ρ = q^½ e^y`, from the powers of the nomes: the difference keeps its digits,
/// and has the sign s; with alternating signs, −s (−1)ⁿ.
#[inline(always)]
fn coefficients<const C: usize>(
    powers: &[Numbers<C>; 5],
    mean: &[f64; C],
    zeros: &Zeros<C>,
    alternating: bool,
) -> [[Numbers<C>; 5]; 2] {
    let (mut rho, mut less) = (Numbers::<C>::ZERO, Numbers::<C>::ZERO);
    for l in 0..C {
        rho.0[l] = decay(zeros.rest[l] * mean[l]);
        less.0[l] = exp_minus((2.0 * (zeros.eta[l] * mean[l])).min(LARGEST)).1;
    }
    let less = powers_less_one(less);
    let side: Numbers<C> = Lanes(zeros.side);
    let [mut sums, mut differences] = [[Numbers::ZERO; 5]; 2];
    for n in 0..5 {
        let size = powers[n] * power(rho, 2 * n);
        (sums[n], differences[n]) = (size * (Numbers::all(2.0) + less[n]), -side * size * less[n]);
        if alternating {
            let sign = Numbers::all(sign(n));
            (sums[n], differences[n]) = (sign * sums[n], -(sign * differences[n]));
        }
    }
    [sums, differences]
}

/// `x^{2n+1} − 1` from `x − 1`, in (−1, 0], without cancellation: `ab − 1 = (a − 1) + (b − 1) + (a − 1)(b − 1)`.
#[inline(always)]
fn powers_less_one<const C: usize>(first: Numbers<C>) -> [Numbers<C>; 5] {
    let square = first * (Numbers::all(2.0) + first);
    let (mut powers, mut last) = ([Numbers::ZERO; 5], first);
    for n in 0..5 {
        powers[n] = last;
        last = last + square * (Numbers::all(1.0) + last);
    }
    powers
}

impl<const C: usize> Series<C> for Circular<C> {
    type Alone = Circular;

    #[inline(always)]
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W> {
        let (mut sin, mut cos, mut x) = ([0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            (sin[l], cos[l]) = sin_cos_turns::<FMA>(turns[l], rest[l]);
            x[l] = 1.0 - 2.0 * (sin[l] * sin[l]);
        }
        let (mut z, mut denominator) = ([[[0.0; W]; 2]; 3], [0.0; W]);
        for l in 0..W {
            let [alpha, beta, across] = &self.z;
            z[0][0][l] = sin[l] * horner_in_lane(&alpha[0], l, x[l]);
            z[0][1][l] = cos[l] * horner_in_lane(&alpha[1], l, x[l]);
            z[1][0][l] = cos[l] * horner_in_lane(&beta[0], l, x[l]);
            z[1][1][l] = sin[l] * horner_in_lane(&beta[1], l, x[l]);
            z[2][0][l] = cos[l] * horner_in_lane(&across[0], l, x[l]);
            z[2][1][l] = sin[l] * horner_in_lane(&across[1], l, x[l]);
            denominator[l] = horner_in_lane(&self.denominator, l, x[l]);
        }
        State { z, denominator, ahead: [[0.0; W]; 3] }
    }
}

impl<const C: usize> Coefficients<C> for Circular<C> {
    type One = Circular;

    fn empty() -> Circular<C> {
        let none = [0.0; C];
        Circular { z: [[[none; 5]; 2]; 3], denominator: [none; 5] }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        self.z.as_flattened_mut().as_flattened_mut().iter_mut().chain(&mut self.denominator)
    }
}

/// Series in the nome q' and `X = πu/2K'` for u within a half period, where it is at most `B = πK/2K'`. With
/// `g = e^{−2X}` and `f = e^{−2(B − X)}` they are polynomials in `h = 2q' cosh 2X = f + q'g`, which is at most
/// about 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hyperbolic<const C: usize = 1> {
    /// B.
    border: [f64; C],
    nome: [f64; C],
    /// Coefficients of [`Fourth`]'s last factors.
    tail: [[f64; C]; 2],
    alpha: [[[f64; C]; 3]; 2],
    beta: Fourth<C>,
    across: Fourth<C>,
    denominator: [[f64; C]; 3],
    ahead: [[f64; C]; 3],
}

/// `θ4(s γ + iX | q')` as a product.
#[derive(Clone, Copy, Debug)]
struct Fourth<const C: usize> {
    side: [f64; C],
    /// 2 sin² γ, cos 2γ and sin 2γ.
    versine: [f64; C],
    cos: [f64; C],
    sin: [f64; C],
}

/// Numbers common to the two products, for X >= 0: f, 1 − f and q'g.
#[derive(Clone, Copy)]
struct Exponentials {
    f: f64,
    one_less_f: f64,
    qg: f64,
    tail: [f64; 2],
}

impl<const C: usize> Fourth<C> {
    fn empty() -> Fourth<C> {
        let none = [0.0; C];
        Fourth { side: none, versine: none, cos: none, sin: none }
    }

    /// Sets the product for the zero on side s at γ, from the sine and cosine of γ.
    #[inline(always)]
    fn set(&mut self, side: &[f64; C], sin: Numbers<C>, cos: Numbers<C>) {
        let [double_sin, double_cos] = of_sum([sin, cos], [sin, cos]);
        (self.side, self.versine) = (*side, (Numbers::all(2.0) * sin * sin).0);
        (self.sin, self.cos) = (double_sin.0, double_cos.0);
    }

    fn each(&mut self) -> [&mut [f64; C]; 4] {
        [&mut self.side, &mut self.versine, &mut self.cos, &mut self.sin]
    }

    /// In lane l: the first two factors are `1 − f e^{−2iγ}` and `1 − q'g e^{2iγ}`, the others `1 − q'^{2n} T` with the
    /// sum T of what is subtracted in the first two.
    #[inline(always)]
    fn value(&self, l: usize, at: Exponentials) -> [f64; 2] {
        let Exponentials { f, one_less_f, qg, tail } = at;
        let (versine, cos, sin) = (in_lane(&self.versine, l), in_lane(&self.cos, l), in_lane(&self.sin, l));
        let (a, b) = (one_less_f + f * versine, f * sin);
        let (c, d) = (1.0 - qg * cos, -(qg * sin));
        let (re, im) = (a * c - b * d, a * d + b * c);
        let (t, s) = ((f + qg) * cos, (qg - f) * sin);
        let (t2, s2) = (t * t - s * s, 2.0 * (t * s));
        let (x, y) = (1.0 + (tail[0] * t + tail[1] * t2), tail[0] * s + tail[1] * s2);
        [re * x - im * y, re * y + im * x]
    }
}

impl<const C: usize> Hyperbolic<C> {
    /// Takes the series of B, and for each zero of its side and `γ = πη/2K'` in [0, π/2]. On the separatrix, the limit
    /// K → ∞ with `u = NEVER · turns`, only the first zero counts.
    #[inline(always)]
    pub fn set<const FMA: bool>(
        &mut self,
        border: &[f64; C],
        sides: [&[f64; C]; 3],
        gammas: &[[f64; C]; 3],
        on_separatrix: &[bool; C],
    ) {
        let (mut q, one) = (Numbers::<C>::ZERO, Numbers::all(1.0));
        for l in 0..C {
            self.border[l] = if on_separatrix[l] { NEVER / 4.0 } else { border[l] };
            q.0[l] = decay(2.0 * self.border[l]);
        }
        let (mut side, [mut sin, mut cos]) = ([[0.0; C]; 3], [[Numbers::<C>::ZERO; 3]; 2]);
        for k in 0..3 {
            for l in 0..C {
                let absent = (k > 0) & on_separatrix[l];
                let gamma = if absent { 0.0 } else { gammas[k][l] };
                side[k][l] = if absent { 1.0 } else { sides[k][l] };
                (sin[k].0[l], cos[k].0[l]) = sin_cos_of_quarter::<FMA>(gamma);
                self.ahead[k][l] = if on_separatrix[l] { 0.0 } else { side[k][l] * gamma / PI };
            }
        }
        let [q2, q4, q5, q6] = [power(q, 2), power(q, 4), power(q, 5), power(q, 6)];
        self.nome = q.0;
        self.tail = [(-(q2 * (one + q2))).0, q6.0];
        // The cosines of γ, 3γ and 5γ, and s times the sines.
        let first = [sin[0], cos[0]];
        let double = of_sum(first, first);
        let third = of_sum(first, double);
        let [fifth_sin, c5] = of_sum(third, double);
        let (s, c1, c3) = (Lanes(side[0]), first[1], third[1]);
        let [s1, s3, s5] = [s * first[0], s * third[0], s * fifth_sin];
        self.alpha = [
            [(c1 - q2 * c3 - q6 * c5).0, (q5 * c5 - q * c3).0, (q4 * c5).0],
            [(q6 * s5 - s1 - q2 * s3).0, (q * s3 + q5 * s5).0, (-(q4 * s5)).0],
        ];
        self.beta.set(&side[1], sin[1], cos[1]);
        self.across.set(&side[2], sin[2], cos[2]);
        self.denominator = [(one - q2 - q6).0, (q - q5).0, q4.0];
    }
}

impl<const C: usize> Series<C> for Hyperbolic<C> {
    type Alone = Hyperbolic;

    #[inline(always)]
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W> {
        /// Largest X whose `e^{−X}` is a normal number.
        const MOST: f64 = 700.0;
        let (mut z, mut denominator, mut ahead) = ([[[0.0; W]; 2]; 3], [0.0; W], [[0.0; W]; 3]);
        let (mut odd, mut side, mut near, mut far) = ([0.0; W], [0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            let at = half_period(turns[l], rest[l]);
            (odd[l], side[l]) = (at.odd, at.side);
            let border = in_lane(&self.border, l);
            near[l] = (2.0 * border * at.from_middle).min(MOST);
            far[l] = (4.0 * border * at.to_border).min(MOST);
            for k in 0..3 {
                ahead[k][l] = in_lane(&self.ahead[k], l) * (at.part + 2.0 * rest[l]);
            }
        }
        let (mut root, mut root_less, mut f, mut f_less) = ([0.0; W], [0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            (root[l], root_less[l]) = exp_minus(near[l]);
            (f[l], f_less[l]) = exp_minus(far[l]);
        }
        for l in 0..W {
            let (g, g_less) = (root[l] * root[l], root_less[l] * (1.0 + root[l]));
            let qg = in_lane(&self.nome, l) * g;
            let h = f[l] + qg;
            // In units of ½ e^X, with the sign of u's half period.
            let (cosh, sinh) = (odd[l] * (1.0 + g), odd[l] * (-g_less * side[l]));
            z[0][0][l] = sinh * horner_in_lane(&self.alpha[0], l, h);
            z[0][1][l] = cosh * horner_in_lane(&self.alpha[1], l, h);
            denominator[l] = (1.0 + g) * horner_in_lane(&self.denominator, l, h);
            let tail = [in_lane(&self.tail[0], l), in_lane(&self.tail[1], l)];
            let at = Exponentials { f: f[l], one_less_f: -f_less[l], qg, tail };
            let unit = odd[l] * (2.0 * root[l]);
            let [beta, across] = [self.beta.value(l, at), self.across.value(l, at)];
            z[1][0][l] = unit * beta[0];
            z[1][1][l] = (unit * (in_lane(&self.beta.side, l) * side[l])) * beta[1];
            z[2][0][l] = unit * across[0];
            z[2][1][l] = (unit * (in_lane(&self.across.side, l) * side[l])) * across[1];
        }
        State { z, denominator, ahead }
    }
}

impl<const C: usize> Coefficients<C> for Hyperbolic<C> {
    type One = Hyperbolic;

    fn empty() -> Hyperbolic<C> {
        let none = [0.0; C];
        Hyperbolic {
            border: none,
            nome: none,
            tail: [none; 2],
            alpha: [[none; 3]; 2],
            beta: Fourth::empty(),
            across: Fourth::empty(),
            denominator: [none; 3],
            ahead: [none; 3],
        }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let single = [&mut self.border, &mut self.nome].into_iter().chain(&mut self.tail);
        let fourths = self.beta.each().into_iter().chain(self.across.each());
        let rows = self.alpha.as_flattened_mut().iter_mut().chain(&mut self.denominator);
        single.chain(fourths).chain(rows).chain(&mut self.ahead)
    }
}
