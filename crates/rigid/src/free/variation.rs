//! How the angular velocity of a free motion changes with what it starts from.
//!
//! Everything is a linear form in the six numbers (δω, δi), of the start and of the principal moments.
//!
//! **Tumbling.** `ω = (A_a cn, τA_b sn, σA_c dn)` depends on u and the parameter `m = k²`. Since
//! `∂sn/∂m = −½ cn dn S(u)` at fixed u with
//!
//! ```text
//! S(u) = ∫₀ᵘ (sn/dn)² du = (sn³/3) R_D(cn², 1, dn²)      for |u| <= K,
//! ```
//!
//! a change of m is a shift of u by −½S δm, and `δ(dn)² = −sn² δm` besides. With the shift
//! `δv(t) = δv(0) + t δλ − ½ δm (S(u) − S(u0))`
//!
//! ```text
//! δω_a = A_a (δln A_a cn − sn dn δv),   δω_b = A_b (δln A_b sn + cn dn δv),
//! δω_c = A_c (δln A_c dn − ½ δm sn²/dn − m sn cn δv),
//! ```
//!
//! at any time, for S grows by 2S(K) in each half period. All functions are sums of positive terms: no digits are
//! lost as m tends to 0 or 1. Near 1, where S is as large as 1/k'², δm is formed as −δk'². Through 0 and 1 all is
//! analytic, so that equal moments and the separatrix are no exceptions.
//!
//! **Steady.** `δω' = A δω + p` with constant A and p, `p_1 = (δi2 − δi3) ω2 ω3/i1`. A has no trace and takes ω
//! to 0, hence `A³ = μA`, `μ = ½ tr A²`, and `exp(At) = 1 + A sin(κt)/κ + A² (1 − cos κt)/κ²`, κ² = −μ. Where p is
//! not 0, two moments are equal and ω lies in their plane, or all three are; then μ = 0, and A² p is.
//!
//! Carlson, *Numer. Algorithms* 10 (1995); DLMF 22.13 and 19.16.

use super::FreeMotion;
use super::orbit::Orbit;
use crate::elliptic::r_d;
use std::array::from_fn;
use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

/// A linear form in δω and δi, in principal axes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Form(pub [f64; 6]);

impl Form {
    /// δω_k.
    pub fn rate(k: usize) -> Form {
        Form(from_fn(|j| f64::from(j == k)))
    }

    /// δi_k.
    pub fn moment(k: usize) -> Form {
        Form(from_fn(|j| f64::from(j == k + 3)))
    }
}

impl Add for Form {
    type Output = Form;
    fn add(self, o: Form) -> Form {
        Form(from_fn(|j| self.0[j] + o.0[j]))
    }
}

impl Sub for Form {
    type Output = Form;
    fn sub(self, o: Form) -> Form {
        Form(from_fn(|j| self.0[j] - o.0[j]))
    }
}

impl Mul<f64> for Form {
    type Output = Form;
    fn mul(self, x: f64) -> Form {
        Form(self.0.map(|c| c * x))
    }
}

/// At one time, in principal axes: ω, δω, and ∫ω² dt of each component.
pub(super) struct Varied {
    pub omega: [f64; 3],
    pub change: [Form; 3],
    pub squares: [f64; 3],
}

/// Of a motion with moments and rates near 1.
#[derive(Clone, Copy, Debug)]
pub(super) enum Variation {
    Steady(Steady),
    Tumbling(Tumbling),
}

impl Variation {
    /// Of a motion in principal axes.
    pub fn of(motion: &FreeMotion) -> Variation {
        match &motion.orbit {
            Some(orbit) => Variation::Tumbling(Tumbling::new(orbit, motion.moments, motion.omega.0)),
            None => Variation::Steady(Steady::new(motion.moments, motion.omega.0)),
        }
    }

    /// At the time when the angular velocity is `omega`.
    pub fn at(&self, t: f64, omega: [f64; 3]) -> Varied {
        match self {
            Variation::Steady(steady) => steady.at(t),
            Variation::Tumbling(tumbling) => tumbling.at(t, omega),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Tumbling {
    orbit: Orbit,
    /// u at time 0; K, infinite on the separatrix.
    start: f64,
    quarter: f64,
    /// S and ∫sn² at the start and at K.
    first: [f64; 2],
    whole: [f64; 2],
    /// Relative changes of the amplitudes.
    amplitudes: [Form; 3],
    lambda: Form,
    /// δm.
    parameter: Form,
    /// δv(0).
    shift: Form,
}

impl Tumbling {
    fn new(orbit: &Orbit, moments: [f64; 3], omega: [f64; 3]) -> Tumbling {
        let [[a, b, c], [wa, wb, wc]] = [moments, omega].map(|x| orbit.axes.map(|k| x[k]));
        let [va, vb, vc] = orbit.axes.map(Form::rate);
        let [ia, ib, ic] = orbit.axes.map(Form::moment);
        let s = orbit.s;
        let (ab, ac, bc) = (s * (b - a), s * (c - a), s * (c - b));
        let (d_ab, d_ac, d_bc) = ((ib - ia) * s, (ic - ia) * s, (ic - ib) * s);

        // P, Q and D, all positive, and their changes.
        let (a2, b2, c2) = (wa * wa, wb * wb, wc * wc);
        let (p, q) = (a * ac * a2 + b * bc * b2, b * ab * b2 + c * ac * c2);
        let term = |i: f64, w: f64, d: f64, di: Form, dw: Form, dd: Form| {
            (dw * (2.0 * i * w * d)) + (di * d + dd * i) * (w * w)
        };
        let dp = term(a, wa, ac, ia, va, d_ac) + term(b, wb, bc, ib, vb, d_bc);
        let dq = term(b, wb, ab, ib, vb, d_ab) + term(c, wc, ac, ic, vc, d_ac);
        let dd = term(c, wc, bc, ic, vc, d_bc) - term(a, wa, ab, ia, va, d_ab);

        let bcq = bc * q;
        let log_bcq = d_bc * (1.0 / bc) + dq * (1.0 / q);
        let (m, kc2) = (orbit.k2, orbit.kc * orbit.kc);
        let parameter = if m < 0.5 {
            (d_ab * p + dp * ab) * (1.0 / bcq) - log_bcq * m
        } else {
            log_bcq * kc2 - (d_ac * (kc2 * bcq / ac) + dd * ac) * (1.0 / bcq)
        };
        let [log_a, log_b, log_c] = [ia * (1.0 / a), ib * (1.0 / b), ic * (1.0 / c)];
        let [log_ac, log_bc] = [d_ac * (1.0 / ac), d_bc * (1.0 / bc)];
        let lambda = (log_bcq - log_a - log_b - log_c) * (0.5 * orbit.lambda.hi);
        let log_p = dp * (1.0 / p);
        let amplitudes = [
            (log_p - log_a - log_ac) * 0.5,
            (log_p - log_b - log_bc) * 0.5,
            (dq * (1.0 / q) - log_c - log_ac) * 0.5,
        ];

        let [x, y, z] = orbit.amplitudes;
        let (cn, sn, dn) = (wa / x, wb / y, wc / z);
        // Without P, which cancels.
        let between = (log_a + log_ac - log_b - log_bc) * (0.5 * sn * cn);
        let shift = (vb * (cn / y) - va * (sn / x) - between) * (1.0 / dn);

        let quarter = orbit.mean.map_or(f64::INFINITY, |mean| 0.5 * PI / mean.hi);
        let start = orbit.start.1 + if orbit.start.0 == 0.0 { 0.0 } else { orbit.start.0 * quarter };
        let whole = [r_d(0.0, 1.0, kc2), r_d(0.0, kc2, 1.0)].map(|x| x / 3.0);
        let tumbling = Tumbling {
            orbit: *orbit,
            start,
            quarter,
            first: [0.0; 2],
            whole,
            amplitudes,
            lambda,
            parameter,
            shift,
        };
        Tumbling { first: tumbling.integrals(start, [cn, sn, dn]), ..tumbling }
    }

    /// S and ∫sn² to u.
    fn integrals(&self, u: f64, [cn, sn, dn]: [f64; 3]) -> [f64; 2] {
        // So many half periods 2K that cn has its sign; the rest is at most K, or is rounding beyond it.
        let odd = if cn < 0.0 { 1.0 } else { 0.0 };
        let halves = 2.0 * (0.5 * (u / (2.0 * self.quarter) - odd)).round() + odd;
        let sine = if cn < 0.0 { -sn } else { sn };
        let cube = sine * sine * sine / 3.0;
        let rest = [cube * r_d(cn * cn, 1.0, dn * dn), cube * r_d(cn * cn, dn * dn, 1.0)];
        if halves == 0.0 { rest } else { from_fn(|k| 2.0 * halves * self.whole[k] + rest[k]) }
    }

    fn at(&self, t: f64, omega: [f64; 3]) -> Varied {
        let Orbit { axes, amplitudes, lambda, k2: m, .. } = self.orbit;
        let [cn, sn, dn]: [f64; 3] = from_fn(|k| omega[axes[k]] / amplitudes[k]);
        let [s, d] = self.integrals(self.start + lambda.hi * t, [cn, sn, dn]);
        let shift = self.shift + self.lambda * t - self.parameter * (0.5 * (s - self.first[0]));
        let [a, b, c] = self.amplitudes;
        let changes = [
            a * cn - shift * (sn * dn),
            b * sn + shift * (cn * dn),
            c * dn - self.parameter * (0.5 * sn * sn / dn) - shift * (m * sn * cn),
        ];
        let square = (d - self.first[1]) / lambda.hi;
        let squares = [t - square, square, t - m * square];
        let mut varied = Varied { omega, change: [Form::default(); 3], squares: [0.0; 3] };
        for k in 0..3 {
            varied.change[axes[k]] = changes[k] * amplitudes[k];
            varied.squares[axes[k]] = amplitudes[k] * amplitudes[k] * squares[k];
        }
        varied
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Steady {
    omega: [f64; 3],
    /// A, p and μ.
    matrix: [[f64; 3]; 3],
    push: [Form; 3],
    mu: f64,
}

impl Steady {
    fn new(i: [f64; 3], w: [f64; 3]) -> Steady {
        let mut matrix = [[0.0; 3]; 3];
        let push = from_fn(|x| {
            let (y, z) = ((x + 1) % 3, (x + 2) % 3);
            let ratio = (i[y] - i[z]) / i[x];
            matrix[x][y] = ratio * w[z];
            matrix[x][z] = ratio * w[y];
            (Form::moment(y) - Form::moment(z)) * (w[y] * w[z] / i[x])
        });
        let mu = (0..3).map(|x| matrix[x][(x + 1) % 3] * matrix[(x + 1) % 3][x]).sum();
        Steady { omega: w, matrix, push, mu }
    }

    fn times(&self, x: [Form; 3]) -> [Form; 3] {
        self.matrix.map(|row| x[0] * row[0] + x[1] * row[1] + x[2] * row[2])
    }

    fn at(&self, t: f64) -> Varied {
        let root = self.mu.abs().sqrt();
        let phase = root * t;
        let (first, second) = if self.mu == 0.0 {
            (t, 0.5 * t * t)
        } else if self.mu > 0.0 {
            let half = (0.5 * phase).sinh() / root;
            (phase.sinh() / root, 2.0 * half * half)
        } else {
            let half = (0.5 * phase).sin() / root;
            (phase.sin() / root, 2.0 * half * half)
        };
        let start = from_fn(Form::rate);
        let once = self.times(start);
        let twice = self.times(once);
        let pushed = self.times(self.push);
        let change = from_fn(|k| {
            start[k] + once[k] * first + twice[k] * second + self.push[k] * t + pushed[k] * (0.5 * t * t)
        });
        Varied { omega: self.omega, change, squares: self.omega.map(|w| w * w * t) }
    }
}
