//! The theta series of a heavy top, as polynomials.
//!
//! θ1 for α, θ2 for β and for the rate across the axis, over θ4 (see [`super`]). As for a free motion
//! ([`crate::exact::free::series`]) trigonometric functions serve up to a nome `q = exp(−πK'/K)` of 0.2, hyperbolic ones
//! beyond, where `q' = exp(−πK/K')` is below 0.0022.

use crate::exact::free::series::{FIRST, FOURTH, NEVER, THIRD, chebyshev, sign};
use crate::numerics::lanes::{HalfPeriod, exp_minus, half_period, horner, sin_cos_turns};
use std::f64::consts::PI;

/// The zero of one of the three functions, at `v = i s y` or `π/2 + i s y`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zero {
    /// s.
    pub side: f64,
    /// η and K' − η.
    pub eta: f64,
    pub rest: f64,
}

/// Values of the series at `W` times: real and imaginary parts of the three functions, their denominator, and the part
/// of a turn to add to each phase.
pub(super) struct State<const W: usize> {
    pub z: [[[f64; W]; 2]; 3],
    pub denominator: [f64; W],
    pub ahead: [[f64; W]; 3],
}

/// Series in one form or the other.
pub(super) trait Series: Copy + Sync {
    /// From `v/2π = u/4K`, reduced to [−½, ½], and its rounding error.
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W>;
}

/// Series in the nome q: `θ1(v − i s y) = sin v (…) − i s cos v (…)`, `θ2 = cos v (…) + i s sin v (…)`, the brackets
/// polynomials in cos 2v, in units of `q^¼ e^y`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circular {
    /// Of the three functions, the two brackets.
    z: [[[f64; 5]; 2]; 3],
    denominator: [f64; 5],
}

impl Circular {
    /// From the nome, `M = π/2K`, and the zeros.
    pub fn new(q: f64, mean: f64, zeros: [Zero; 3]) -> Circular {
        // q^{n²} ρ^{2n} (1 ± e^{−2(2n+1)y}) with ρ = q^½ e^y; the difference keeps its digits.
        let coefficients = |zero: Zero| {
            let rho = (-zero.rest * mean).exp();
            let size = move |n: usize| q.powi((n * n) as i32) * rho.powi(2 * n as i32);
            let less = move |n: usize| (-2.0 * (2 * n + 1) as f64 * (zero.eta * mean)).exp_m1();
            let sums: [f64; 5] = std::array::from_fn(|n| size(n) * (2.0 + less(n)));
            let differences: [f64; 5] = std::array::from_fn(|n| -zero.side * size(n) * less(n));
            (sums, differences)
        };
        let alternating = |c: [f64; 5]| std::array::from_fn(|n| sign(n) * c[n]);
        let odd = |zero: Zero| {
            let (sums, differences) = coefficients(zero);
            let minus = alternating(differences).map(|c: f64| -c);
            [chebyshev::<5>(alternating(sums), FOURTH), chebyshev::<5>(minus, THIRD)]
        };
        let even = |zero: Zero| {
            let (sums, differences) = coefficients(zero);
            [chebyshev::<5>(sums, THIRD), chebyshev::<5>(differences, FOURTH)]
        };
        let squares = |n: usize| if n == 0 { 1.0 } else { 2.0 * sign(n) * q.powi((n * n) as i32) };
        // Subnormal coefficients are slow on many machines and negligible.
        let normal = |c: f64| if c.abs() < 1e-200 { 0.0 } else { c };
        let z = [odd(zeros[0]), even(zeros[1]), even(zeros[2])];
        Circular {
            z: z.map(|brackets| brackets.map(|c| c.map(normal))),
            denominator: chebyshev::<5>(std::array::from_fn(squares), FIRST).map(normal),
        }
    }
}

impl Series for Circular {
    #[inline(always)]
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W> {
        let (mut z, mut denominator) = ([[[0.0; W]; 2]; 3], [0.0; W]);
        for l in 0..W {
            let (sin, cos) = sin_cos_turns::<FMA>(turns[l], rest[l]);
            let x = 1.0 - 2.0 * (sin * sin);
            for (k, [re, im]) in [[sin, cos], [cos, sin], [cos, sin]].into_iter().enumerate() {
                z[k][0][l] = re * horner(&self.z[k][0], x);
                z[k][1][l] = im * horner(&self.z[k][1], x);
            }
            denominator[l] = horner(&self.denominator, x);
        }
        State { z, denominator, ahead: [[0.0; W]; 3] }
    }
}

/// Series in the nome q' and `X = πu/2K'` for u within a half period, where it is at most `B = πK/2K'`. With
/// `g = e^{−2X}` and `f = e^{−2(B − X)}` they are polynomials in `h = 2q' cosh 2X = f + q'g`, which is at most
/// about 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hyperbolic {
    /// B.
    border: f64,
    nome: f64,
    alpha: [[f64; 3]; 2],
    beta: Fourth,
    across: Fourth,
    denominator: [f64; 3],
    ahead: [f64; 3],
}

/// `θ4(s γ + iX | q')` as a product.
#[derive(Clone, Copy, Debug)]
struct Fourth {
    side: f64,
    /// 2 sin² γ, cos 2γ and sin 2γ.
    versine: f64,
    cos: f64,
    sin: f64,
}

impl Fourth {
    fn new(side: f64, gamma: f64) -> Fourth {
        let (sin, cos) = (2.0 * gamma).sin_cos();
        Fourth { side, versine: 2.0 * gamma.sin().powi(2), cos, sin }
    }

    /// For X >= 0, from f, 1 − f and q'g: the first two factors are `1 − f e^{−2iγ}` and `1 − q'g e^{2iγ}`, the others
    /// `1 − q'^{2n} T` with the sum T of what is subtracted in the first two.
    #[inline(always)]
    fn value(&self, f: f64, one_less_f: f64, qg: f64, tail: [f64; 2]) -> [f64; 2] {
        let (a, b) = (one_less_f + f * self.versine, f * self.sin);
        let (c, d) = (1.0 - qg * self.cos, -(qg * self.sin));
        let (re, im) = (a * c - b * d, a * d + b * c);
        let (t, s) = ((f + qg) * self.cos, (qg - f) * self.sin);
        let (t2, s2) = (t * t - s * s, 2.0 * (t * s));
        let (x, y) = (1.0 + (tail[0] * t + tail[1] * t2), tail[0] * s + tail[1] * s2);
        [re * x - im * y, re * y + im * x]
    }
}

impl Hyperbolic {
    /// From B, and for each zero its side and `γ = πη/2K'`.
    pub fn new(border: f64, zeros: [(f64, f64); 3]) -> Hyperbolic {
        let q = (-2.0 * border).exp();
        let [q2, q4, q5, q6] = [2, 4, 5, 6].map(|n| q.powi(n));
        let (s, gamma) = zeros[0];
        let [s1, s3, s5] = [1.0, 3.0, 5.0].map(|n: f64| s * (n * gamma).sin());
        let [c1, c3, c5] = [1.0, 3.0, 5.0].map(|n: f64| (n * gamma).cos());
        Hyperbolic {
            border,
            nome: q,
            alpha: [
                [c1 - q2 * c3 - q6 * c5, -q * c3 + q5 * c5, q4 * c5],
                [-(s1 + q2 * s3 - q6 * s5), q * s3 + q5 * s5, -q4 * s5],
            ],
            beta: Fourth::new(zeros[1].0, zeros[1].1),
            across: Fourth::new(zeros[2].0, zeros[2].1),
            denominator: [1.0 - q2 - q6, q - q5, q4],
            ahead: zeros.map(|(side, gamma)| side * gamma / PI),
        }
    }

    /// The limit K → ∞, with `u = NEVER · turns`.
    pub fn separatrix(gamma: f64, side: f64) -> Hyperbolic {
        let border = NEVER / 4.0;
        let zeros = [(side, gamma), (1.0, 0.0), (1.0, 0.0)];
        Hyperbolic { ahead: [0.0; 3], ..Hyperbolic::new(border, zeros) }
    }
}

impl Series for Hyperbolic {
    #[inline(always)]
    fn state<const W: usize, const FMA: bool>(&self, turns: &[f64; W], rest: &[f64; W]) -> State<W> {
        /// Largest X whose `e^{−X}` is a normal number.
        const MOST: f64 = 700.0;
        let (mut z, mut denominator, mut ahead) = ([[[0.0; W]; 2]; 3], [0.0; W], [[0.0; W]; 3]);
        let tail = [-(self.nome * self.nome) * (1.0 + self.nome * self.nome), self.nome.powi(6)];
        for l in 0..W {
            let HalfPeriod { odd, side, part, from_middle, to_border } = half_period(turns[l], rest[l]);
            let near = (2.0 * self.border * from_middle).min(MOST);
            let far = (4.0 * self.border * to_border).min(MOST);
            let (root, root_less) = exp_minus(near);
            let (g, g_less) = (root * root, root_less * (1.0 + root));
            let (f, f_less) = exp_minus(far);
            let qg = self.nome * g;
            let h = f + qg;
            // In units of ½ e^X, with the sign of u's half period.
            let (cosh, sinh) = (odd * (1.0 + g), odd * (-g_less * side));
            z[0][0][l] = sinh * horner(&self.alpha[0], h);
            z[0][1][l] = cosh * horner(&self.alpha[1], h);
            let unit = odd * (2.0 * root);
            for (z, fourth) in z[1..].iter_mut().zip([&self.beta, &self.across]) {
                let [re, im] = fourth.value(f, -f_less, qg, tail);
                z[0][l] = unit * re;
                z[1][l] = (unit * (fourth.side * side)) * im;
            }
            denominator[l] = (1.0 + g) * horner(&self.denominator, h);
            for k in 0..3 {
                ahead[k][l] = self.ahead[k] * (part + 2.0 * rest[l]);
            }
        }
        State { z, denominator, ahead }
    }
}
