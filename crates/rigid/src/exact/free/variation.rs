//! Derivatives of the angular velocity of a free motion: linear forms in (δω, δi) of start and principal moments.
//!
//! **Tumbling.** `ω = (A_a cn, τA_b sn, σA_c dn)` depends on u and the parameter `m = k²`. Since
//! `∂sn/∂m = −½ cn dn S(u)` at fixed u with
//!
//! ```text
//! S(u) = ∫₀ᵘ (sn/dn)² du = (sn³/3) R_D(cn², 1, dn²)      for |u| <= K,
//! ```
//!
//! a change of m is a shift of u by −½S δm, and `δ(dn)² = −sn² δm` besides. So `δω_a/A_a = δln A_a cn − sn dn δv` with
//! `δv(t) = δv(0) + w`, `w = t δλ − ½ δm ΔS`, and with Δ for the change of a function from u0 to u
//!
//! ```text
//! δω_a = δω_a(0) + A_a (δln A_a Δcn − δv(0) Δ(sn dn) − sn dn w),
//! δω_b = δω_b(0) + A_b (δln A_b Δsn + δv(0) Δ(cn dn) + cn dn w),
//! δω_c = δω_c(0) + A_c (δln A_c Δdn − ½ δm Δ(sn²/dn) − m δv(0) Δ(sn cn) − m sn cn w),
//! ```
//!
//! at any time, since S grows by 2S(K) in each half period. Near m = 1, where S is as large as 1/k'², δm is computed as
//! −δk'². All is analytic at m = 0 and 1, so equal moments and the separatrix are not special. Near a sphere the relative
//! changes of A and λ are large, and λt small; there the changes Δ follow from Jacobi's addition theorems with
//! `x = (u + u0)/2` and `y = (u − u0)/2`,
//!
//! ```text
//! Δsn = 2 cn x dn x sn y/N,   Δcn = −2 sn x dn x sn y dn y/N,   Δdn = −2m sn x cn x sn y cn y/N,
//! N = 1 − m sn²x sn²y = cn²y + sn²y dn²x,
//! Δ∫sn² = 2∫₀ʸ sn² + 2 sn²x sn y cn y dn y/N,
//! ΔS = 2S(y) + 2 sd²x sn y cn y/dn³y /(1 + mk'² sd²x sd²y),
//! ```
//!
//! the last one by `sd(u|m) = sn(k'u|−m/k'²)/k'`.
//!
//! **Steady.** `δω' = A δω + p` with constant A and p, `p_1 = (δi2 − δi3) ω2 ω3/i1`. A has no trace and takes ω
//! to 0, hence `A³ = μA`, `μ = ½ tr A²`, and `exp(At) = 1 + A sin(κt)/κ + A² (1 − cos κt)/κ²`, κ² = −μ. Where p is
//! not 0, two moments are equal and ω lies in their plane, or all three are; then μ = 0, and A² p is.
//!
//! Carlson, *Numer. Algorithms* 10 (1995); DLMF 22.8 (addition), 22.17 (parameters beyond 0 and 1).

use super::FreeMotion;
use super::orbit::Orbit;
use crate::numerics::elliptic::r_d;
use polhode_ga::{Bivector, Rotor};
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

/// Largest change of u for the addition theorems, whose denominators are then not small.
const NEAR: f64 = 1.0;

/// The variation of a motion that is not steady, with moments and rates near 1.
#[derive(Clone, Debug)]
pub(super) struct Tumbling {
    orbit: Orbit,
    motion: FreeMotion,
    /// The same motion with u = 0 at the start.
    from_zero: FreeMotion,
    /// u at time 0; K, infinite on the separatrix.
    start: f64,
    quarter: f64,
    /// At the start.
    first: Functions,
    /// S and ∫sn² at K.
    whole: [f64; 2],
    /// Relative changes of the amplitudes.
    amplitudes: [Form; 3],
    lambda: Form,
    /// δm.
    parameter: Form,
    /// δv(0).
    shift: Form,
}

/// cn, sn and dn, S and ∫sn²; or their changes.
#[derive(Clone, Copy, Debug, Default)]
struct Functions {
    cn: f64,
    sn: f64,
    dn: f64,
    /// Less their values after `halves` half periods, which are so large near the separatrix that the rest would be lost.
    s: f64,
    d: f64,
    halves: f64,
}

impl Tumbling {
    /// None if the motion is steady.
    pub fn new(motion: &FreeMotion) -> Option<Box<Tumbling>> {
        let orbit = motion.orbit.as_ref()?;
        let [[a, b, c], [wa, wb, wc]] = [motion.moments, motion.omega.0].map(|x| orbit.axes.map(|k| x[k]));
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
        let (m, kc2) = (orbit.k2, (orbit.kc * orbit.kc).value());
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
        let mut at_zero = Bivector::default();
        (at_zero.0[orbit.axes[0]], at_zero.0[orbit.axes[2]]) = (x, z);
        let from_zero = FreeMotion::in_principal_axes(motion.moments, Rotor::IDENTITY, at_zero);
        let tumbling = Tumbling {
            orbit: *orbit,
            motion: *motion,
            from_zero,
            start,
            quarter,
            first: Functions::default(),
            whole,
            amplitudes,
            lambda,
            parameter,
            shift,
        };
        Some(Box::new(Tumbling { first: tumbling.functions(start, motion.omega.0), ..tumbling }))
    }

    /// Of u, where the angular velocity is `omega`.
    fn functions(&self, u: f64, omega: [f64; 3]) -> Functions {
        let [cn, sn, dn] = from_fn(|k| omega[self.orbit.axes[k]] / self.orbit.amplitudes[k]);
        // The number of half periods 2K with the sign of cn; the rest is at most K up to rounding.
        let odd = if cn < 0.0 { 1.0 } else { 0.0 };
        let halves = 2.0 * (0.5 * (u / (2.0 * self.quarter) - odd)).round() + odd;
        let sine = if cn < 0.0 { -sn } else { sn };
        let cube = sine * sine * sine / 3.0;
        let (s, d) = (cube * r_d(cn * cn, 1.0, dn * dn), cube * r_d(cn * cn, dn * dn, 1.0));
        Functions { cn, sn, dn, s, d, halves }
    }

    /// The changes of the functions from the start to time t, where they are `now`.
    fn changes(&self, t: f64, now: Functions) -> Functions {
        let Functions { cn, sn, dn, s, d, halves } = self.first;
        let y = 0.5 * self.orbit.lambda.hi * t;
        if y.abs() > 0.5 * NEAR {
            let halves = now.halves - halves;
            // Infinite on the separatrix, where there are no half periods.
            let [more_s, more_d] =
                if halves == 0.0 { [0.0; 2] } else { self.whole.map(|x| 2.0 * halves * x) };
            return Functions {
                cn: now.cn - cn,
                sn: now.sn - sn,
                dn: now.dn - dn,
                s: more_s + (now.s - s),
                d: more_d + (now.d - d),
                halves,
            };
        }
        let m = self.orbit.k2;
        let x = self.functions(self.start + y, self.motion.at(0.5 * t).1.0);
        let y = self.functions(y, self.from_zero.at(0.5 * t).1.0);
        let sine = y.sn * x.dn;
        let twice = 2.0 * y.sn / (y.cn * y.cn + sine * sine);
        let (tangent, kc) = (x.sn / x.dn, self.orbit.kc.value());
        let part = kc * tangent * y.sn / y.dn;
        Functions {
            cn: -twice * x.sn * x.dn * y.dn,
            sn: twice * x.cn * x.dn,
            dn: -twice * m * x.sn * x.cn * y.cn,
            s: 2.0 * (y.s + tangent * tangent * y.sn * y.cn / (y.dn * y.dn * y.dn) / (1.0 + m * part * part)),
            d: 2.0 * y.d + twice * x.sn * x.sn * y.cn * y.dn,
            // A time this short is less than half of a half period.
            halves: 0.0,
        }
    }

    pub fn at(&self, t: f64) -> Varied {
        let Orbit { axes, amplitudes, lambda, k2: m, .. } = self.orbit;
        let omega = self.motion.at(t).1.0;
        let (first, now) = (self.first, self.functions(self.start + lambda.hi * t, omega));
        let change = self.changes(t, now);
        let (sn, dn) = (0.5 * (first.sn + now.sn), 0.5 * (first.dn + now.dn));
        let cn = 0.5 * (first.cn + now.cn);
        let squares = 0.5 * (first.sn * first.sn + now.sn * now.sn);
        let quotient = (2.0 * change.sn * sn * dn - squares * change.dn) / (first.dn * now.dn);
        let shift = self.lambda * t - self.parameter * (0.5 * change.s);
        let [a, b, c] = self.amplitudes;
        let changes = [
            a * change.cn - self.shift * (change.sn * dn + sn * change.dn) - shift * (now.sn * now.dn),
            b * change.sn + self.shift * (change.cn * dn + cn * change.dn) + shift * (now.cn * now.dn),
            c * change.dn
                - self.parameter * (0.5 * quotient)
                - (self.shift * (change.sn * cn + sn * change.cn) + shift * (now.sn * now.cn)) * m,
        ];
        let square = change.d / lambda.hi;
        let squares = [t - square, square, t - m * square];
        let mut varied = Varied { omega, change: [Form::default(); 3], squares: [0.0; 3] };
        for k in 0..3 {
            varied.change[axes[k]] = Form::rate(axes[k]) + changes[k] * amplitudes[k];
            varied.squares[axes[k]] = amplitudes[k] * amplitudes[k] * squares[k];
        }
        varied
    }
}

/// Of a steady motion with the moments i and the rates w.
pub(super) fn steady(i: [f64; 3], w: [f64; 3], t: f64) -> Varied {
    // A and p.
    let mut matrix = [[0.0; 3]; 3];
    let push = from_fn(|x| {
        let (y, z) = ((x + 1) % 3, (x + 2) % 3);
        let ratio = (i[y] - i[z]) / i[x];
        (matrix[x][y], matrix[x][z]) = (ratio * w[z], ratio * w[y]);
        (Form::moment(y) - Form::moment(z)) * (w[y] * w[z] / i[x])
    });
    let mu: f64 = (0..3).map(|x| matrix[x][(x + 1) % 3] * matrix[(x + 1) % 3][x]).sum();
    let root = mu.abs().sqrt();
    let (first, second) = if mu == 0.0 {
        (t, 0.5 * t * t)
    } else {
        let function = if mu > 0.0 { f64::sinh } else { f64::sin };
        let half = function(0.5 * root * t) / root;
        (function(root * t) / root, 2.0 * half * half)
    };
    let times = |x: [Form; 3]| matrix.map(|row| x[0] * row[0] + x[1] * row[1] + x[2] * row[2]);
    let start = from_fn(Form::rate);
    let once = times(start);
    let (twice, pushed) = (times(once), times(push));
    let change =
        from_fn(|k| start[k] + once[k] * first + twice[k] * second + push[k] * t + pushed[k] * (0.5 * t * t));
    Varied { omega: w, change, squares: w.map(|w| w * w * t) }
}
