//! The logarithm of even versors, and their square root.
//!
//! A rotor `R = exp B` is `R = C + F` with its even part under reversion `C = cosh B` and its odd part
//! `F = sinh B`, and `F² = C² − 1`. Halving the argument, `cosh(B/2) = √((1 + C)/2)` and
//! `sinh(B/2) = F / 2 cosh(B/2)`, leads to C near 1, where
//!
//! ```text
//! B = F g(C),   g(c) = arcosh c / √(c² − 1) = Σ tⱼ zʲ,   z = (1 − c)/2,   tⱼ/tⱼ₋₁ = 2j/(2j + 1).
//! ```
//!
//! With up to five generators C is `x + yU` (see `pair`), and the halvings work on a few numbers. With more they work in
//! the algebra (see `sqrt`).
//!
//! The halvings lead to the logarithm whose numbers `x ± y√q` have imaginary parts within ±π. They fail if one of those
//! of C is −1 or less: then R makes a whole turn in some plane, perhaps with a boost, and commutes with a bivector Y of
//! that plane; `log R = Y + log(R exp(−Y))`.
//!
//! Every result is checked: `exp(log R)` must equal R.

use super::eigen::diagonalize;
use super::exp::unit_of_grade_4;
use super::pair::{Pair, Ring, SPLITS};
use super::{Calculus, SAME_DIRECTION, add_scaled, dot, grade, part, reverse, scaled};
use crate::error::MathError;
use crate::g3::values::{norm, scale_of};
use std::f64::consts::FRAC_PI_2;

/// Largest factor by which the size of a logarithm loosens its check.
const MOST_LENIENT: f64 = 1e3;

/// Tolerances for components rounded to a spacing `epsilon` of numbers at 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerances {
    /// Rounding of the few sums of products in `M~M`, relative to `|M|²`.
    pub rounding: f64,
    /// Largest distance of `R~R` from a number, and of `exp(log R)` from R per unit of `1 + |log R|`: the rounding
    /// of thousands of products.
    pub versor: f64,
    /// Largest relative uncertainty of a logarithm: half of the digits.
    pub least_certain: f64,
    /// The value of [`SAME_DIRECTION`] for them.
    pub direction: f64,
}

impl Tolerances {
    pub(super) fn new(epsilon: f64) -> Tolerances {
        let least_certain = epsilon.sqrt();
        Tolerances {
            rounding: 32.0 * epsilon,
            versor: (4096.0 * epsilon).min(0.5 * least_certain),
            least_certain,
            direction: SAME_DIRECTION.max(256.0 * epsilon),
        }
    }
}

/// The series of g is summed within `|1 − c| <= NEAR`: 14 terms of ratio 1/16 at most.
pub(super) const NEAR: f64 = 0.125;

/// Halvings lead from the largest number to [`NEAR`] in 13 steps.
pub(super) const MOST_HALVINGS: u32 = 16;

/// `exp(B) = M / size`, after the null generators were scaled by `null_factor`.
struct Polar {
    size: f64,
    bivector: Vec<f64>,
    null_factor: f64,
}

impl Calculus {
    /// The logarithm `ln|M| + B`, B a bivector, of a positive number times an even versor; `exp(log M) = M`.
    /// `log 1 = 0`; `log(−1) = π E` with E the first basis plane of square −1.
    ///
    /// With up to five generators it is found if it exists, up to rounding: with two or more generators of either sign,
    /// a large boost may hide a rotation, and a bivector B near null ones may not be found if |B| is more than 1000: of a
    /// rotor R, `exp(log R)` may be off by `32 ε (|R|² + |B|²)`, and by more than √ε it is an error. With more generators
    /// it is found if the angles of B over its planes sum to less than π, and in most other cases. Otherwise it is an
    /// error.
    ///
    /// Parts with null generators that are not a versor's, such as rounding left where larger parts cancelled, are
    /// replaced by the nearest: `exp(log M)` is M to `√ε` of its largest part.
    pub fn log(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let polar = self.polar(&self.read(m)?)?.ok_or(MathError::NoLogarithm)?;
        let mut log = polar.bivector;
        log[0] += polar.size.ln();
        self.scale_null(&mut log, 1.0 / polar.null_factor);
        self.write(&log)
    }

    /// The square root `√|M| exp(B/2)` of a positive number times an even versor `exp B`; `√0 = 0`.
    pub fn sqrt(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let Some(polar) = self.polar(&self.read(m)?)? else { return Ok(m.to_vec()) };
        let mut root = scaled(&self.exp_bits(&scaled(&polar.bivector, 0.5))?, polar.size.sqrt());
        self.scale_null(&mut root, 1.0 / polar.null_factor);
        self.write(&root)
    }

    /// Size and bivector of an even versor; None for zero.
    ///
    /// If `M~M = 1` to rounding the size is exactly 1, since for a boost above 18 `M~M` is all rounding. Otherwise
    /// `size · exp B` is nearest to M.
    fn polar(&self, m: &[f64]) -> Result<Option<Polar>, MathError> {
        if m.iter().all(|&x| x == 0.0) {
            return Ok(None);
        }
        let scale = scale_of(&self.without_null(m));
        let mut m: Vec<f64> = m.iter().map(|x| x / scale).collect();
        let null_factor = self.balance(&mut m);
        if !m.iter().all(|x| x.is_finite()) {
            return Err(MathError::Overflow);
        }
        let m = self.read_versor(m, null_factor)?;
        let square = self.scalar_product(&m, &reverse(&m));
        let rounding = self.tolerances.rounding * norm(&m).powi(2);
        if (square - 1.0 / (scale * scale)).abs() <= rounding {
            let (bivector, _) = self.log_of_unit(&scaled(&m, scale))?;
            return Ok(Some(Polar { size: 1.0, bivector, null_factor }));
        }
        if square.abs() <= rounding {
            return Err(MathError::NoLogarithm);
        }
        if square < 0.0 {
            return Err(MathError::NoBivectorLogarithm);
        }
        let size = square.sqrt();
        let (bivector, ratio) = self.log_of_unit(&scaled(&m, 1.0 / size))?;
        Ok(Some(Polar { size: ratio * size * scale, bivector, null_factor }))
    }

    /// A balanced even versor times a number, or the error that it is not one.
    ///
    /// The part without null generators is checked on its own scale. The parts with them may be rounding of larger ones
    /// that cancelled, as in `~M M`, which balancing magnifies. If they do not fit, the nearest versor is taken, if the
    /// change is within `least_certain` of the unbalanced size.
    fn read_versor(&self, m: Vec<f64>, null_factor: f64) -> Result<Vec<f64>, MathError> {
        let deviation = self.deviation(&m);
        if self.null == 0 || deviation <= self.tolerances.rounding {
            return self.require_versor(m, deviation);
        }
        let rotor = self.without_null(&m);
        if self.scalar_product(&rotor, &reverse(&rotor)).abs()
            <= self.tolerances.rounding * dot(&rotor, &rotor)
        {
            return Err(MathError::NoLogarithm);
        }
        let deviation = self.deviation(&rotor);
        let versor = self.require_versor(self.nearest_in_null(&m), deviation)?;
        let unbalanced = 1.0 / null_factor.max(1.0);
        let (mut change, mut given) = (versor.clone(), m);
        add_scaled(&mut change, &given, -1.0);
        self.scale_null(&mut change, unbalanced);
        self.scale_null(&mut given, unbalanced);
        let change = norm(&change) / norm(&given);
        if change <= self.tolerances.least_certain {
            Ok(versor)
        } else {
            Err(MathError::NotVersor { deviation: change })
        }
    }

    fn require_versor(&self, m: Vec<f64>, deviation: f64) -> Result<Vec<f64>, MathError> {
        if deviation <= self.tolerances.versor { Ok(m) } else { Err(MathError::NotVersor { deviation }) }
    }

    /// The larger of the non-scalar part of `M~M` and the odd part, relative to `|M|²` and `|M|`.
    fn deviation(&self, m: &[f64]) -> f64 {
        let square = self.product(m, &reverse(m));
        let size = norm(m);
        (norm(&square[1..]) / size.powi(2)).max(norm(&part(m, |k| k % 2 == 1)) / size)
    }

    /// The versor with the same part `M₀` without null generators. `M = M₀(1 + X)` with X nilpotent, and of a versor
    /// `log(1 + X) = X − X²/2 + …` is a bivector: `M₀ exp⟨X⟩₂`. The powers of X have no bivector part, because a product
    /// of two parts with one null generator each is one only if both have the same other generators; these two
    /// anticommute, and the square of X has their sum. The series of exp ends with the power r, the number of null
    /// generators.
    fn nearest_in_null(&self, m: &[f64]) -> Vec<f64> {
        let rotor = self.without_null(m);
        let mut null = m.to_vec();
        add_scaled(&mut null, &rotor, -1.0);
        let square = self.scalar_product(&rotor, &reverse(&rotor));
        let bivector = scaled(&part(&self.product(&reverse(&rotor), &null), |k| k == 2), 1.0 / square);
        let mut exp = self.scalar(1.0);
        for k in (1..=self.null.count_ones()).rev() {
            exp = scaled(&self.product(&bivector, &exp), 1.0 / f64::from(k));
            exp[0] += 1.0;
        }
        self.product(&rotor, &exp)
    }

    /// The bivector B with `exp B = R`, and the number by which R is larger than `exp B`.
    fn log_of_unit(&self, r: &[f64]) -> Result<(Vec<f64>, f64), MathError> {
        let checked = |log: Vec<f64>| self.relative_size(&log, r).map(|size| (log, size));
        let principal = self.principal_log(r).and_then(checked);
        let found = principal.or_else(|| {
            self.commuting_planes(r).into_iter().find_map(|plane| {
                let y = scaled(&plane, FRAC_PI_2);
                let rest = self.product(r, &self.exp_bits(&scaled(&y, -1.0)).ok()?);
                let mut log = self.principal_log(&rest)?;
                add_scaled(&mut log, &y, 1.0);
                checked(log)
            })
        });
        found.ok_or(MathError::NoBivectorLogarithm)
    }

    /// The size of R in units of `exp(log)`; None if R is not along it. The rounding of a large R makes `R~R = 1`
    /// uncertain by `ε|R|²`. A bivector B near null ones may be larger than R; it and its exponential are then sums that
    /// cancel, and `exp(log R)` was found to be off by at most `27 ε|B|²`.
    fn relative_size(&self, log: &[f64], r: &[f64]) -> Option<f64> {
        let length = norm(r);
        let (r, exp) = (scaled(r, 1.0 / length), scaled(&self.exp_bits(log).ok()?, 1.0 / length));
        let ratio = dot(&exp, &r) / dot(&exp, &exp);
        let mut difference = scaled(&exp, -ratio);
        add_scaled(&mut difference, &r, 1.0);
        let Tolerances { rounding, versor, least_certain, .. } = self.tolerances;
        let tolerance =
            versor * (1.0 + norm(log)).min(MOST_LENIENT) + rounding * (length.powi(2) + norm(log).powi(2));
        let close = norm(&difference) <= tolerance.min(least_certain);
        (close && (ratio - 1.0).abs() <= tolerance).then_some(ratio)
    }

    /// The result of the halvings, unchecked; None if they fail.
    fn principal_log(&self, r: &[f64]) -> Option<Vec<f64>> {
        if self.generators > 5 {
            return self.log_by_roots(r);
        }
        let f = part(r, |k| k == 2);
        let Some((unit, y)) = self.unit_and_component(r, &f) else {
            return Some(scaled(&f, self.number_factor(r[0], &f, 1.0)?));
        };
        let q = self.scalar_product(&unit, &unit);
        if q > SPLITS {
            // In each half C is a number c, and `F² = λP` with `⟨F²⟩ = λ/2`.
            let mut log = vec![0.0; r.len()];
            for root in [q.sqrt(), -q.sqrt()] {
                let half = self.half(&f, &unit, root);
                add_scaled(&mut log, &half, self.number_factor(r[0] + y * root, &half, 2.0)?);
            }
            return Some(log);
        }
        let (ring, c) = (Ring { q }, Pair { x: r[0], y });
        let negative = r[0] < y.abs() * q.max(0.0).sqrt();
        let turned = negative.then(|| self.turned_factor(ring, c, &f, &unit)).flatten();
        Some(self.times(&f, &unit, turned.or_else(|| sinh_factor(ring, c))?))
    }

    /// The factor κ with `B = F κ` if a number of C is negative, so that 1 + C would cancel. With `F = PS`, P² = −1, a
    /// quarter turn back `−R P = S − C P` exchanges S and C: `B = P(π/2 − C g(S))`. None if F is not a pure rotation, or
    /// `F²` is rounding.
    fn turned_factor(&self, ring: Ring, c: Pair, f: &[f64], unit: &[f64]) -> Option<Pair> {
        let square = self.square_in_ring(f, unit);
        if ring.radius(square) <= self.tolerances.rounding * norm(f).powi(2) {
            return None;
        }
        let s = ring.sqrt(square.scale(-1.0))?;
        let angle = Pair { x: FRAC_PI_2, y: 0.0 }.plus(ring.mul(c, sinh_factor(ring, s)?).scale(-1.0));
        Some(ring.mul(angle, ring.inverse(s)))
    }

    /// The factor κ with `B = F κ` where `C = cosh B` is a number c, and `F² = sinh² B` is `multiple · ⟨F²⟩`.
    fn number_factor(&self, c: f64, f: &[f64], multiple: f64) -> Option<f64> {
        let scale = scale_of(f);
        let f = scaled(f, 1.0 / scale);
        let square = multiple * self.scalar_product(&f, &f);
        let sinh = square.abs().sqrt() * scale;
        if c > 0.0 {
            // κ is smooth at F² = 0, so the sign of a rounded F² does not matter.
            let b = if square < 0.0 { sinh.atan2(c) } else { sinh.asinh() };
            Some(if sinh > 0.0 { b / sinh } else { 1.0 })
        } else {
            let turns = square < -self.tolerances.rounding * norm(&f).powi(2);
            turns.then(|| sinh.atan2(c) / sinh)
        }
    }

    /// The unit U along the part Q of grade 4, and `Q = yU`; None if it is rounding, for a simple rotor. The direction is
    /// that of Q or of `F∧F = 2⟨R⟩Q`, whichever has less rounding.
    fn unit_and_component(&self, r: &[f64], f: &[f64]) -> Option<(Vec<f64>, f64)> {
        let length = norm(f).powi(2);
        let ((unit, size), scale) = if length < r[0].abs() {
            (unit_of_grade_4(&self.product(f, f)), length)
        } else {
            (unit_of_grade_4(r), norm(r))
        };
        (size > self.tolerances.rounding * scale).then(|| {
            let y = dot(r, &unit);
            (unit, y)
        })
    }

    /// `F²` of a bivector as a pair.
    fn square_in_ring(&self, f: &[f64], unit: &[f64]) -> Pair {
        let square = self.product(f, f);
        Pair { x: square[0], y: dot(&square, unit) }
    }

    /// A bivector times a pair.
    fn times(&self, f: &[f64], unit: &[f64], factor: Pair) -> Vec<f64> {
        let mut out = part(&self.product(f, unit), |k| k == 2);
        out.iter_mut().zip(f).for_each(|(o, f)| *o = factor.x * f + factor.y * *o);
        out
    }

    /// Bivectors that commute with R, of square about −1: R's own, and others perpendicular to it.
    ///
    /// The condition `YR = RY` is linear in Y; its solutions are the eigenvectors of eigenvalue 0 of the
    /// matrix of `|YR − RY|²`.
    fn commuting_planes(&self, r: &[f64]) -> Vec<Vec<f64>> {
        let basis: Vec<usize> = (0..r.len()).filter(|&b| grade(b) == 2).collect();
        let commutator = |&b: &usize| {
            let mut plane = vec![0.0; r.len()];
            plane[b] = 1.0;
            let mut difference = self.product(&plane, r);
            add_scaled(&mut difference, &self.product(r, &plane), -1.0);
            difference
        };
        let commutators: Vec<Vec<f64>> = basis.iter().map(commutator).collect();
        let row = |a: &Vec<f64>| commutators.iter().map(|b| dot(a, b)).collect();
        let mut matrix: Vec<Vec<f64>> = commutators.iter().map(row).collect();
        let unit = |i| (0..basis.len()).map(|j| f64::from(i == j)).collect();
        let mut vectors: Vec<Vec<f64>> = (0..basis.len()).map(unit).collect();
        diagonalize(&mut matrix, &mut vectors);
        let own = part(r, |k| k == 2);
        let bound = self.tolerances.rounding * norm(r).powi(2);
        let others =
            vectors.iter().enumerate().filter(|&(i, _)| matrix[i][i] <= bound).map(|(_, components)| {
                let mut y = vec![0.0; r.len()];
                basis.iter().zip(components).for_each(|(&b, &c)| y[b] = c);
                if dot(&own, &own) > bound {
                    let along = dot(&y, &own) / dot(&own, &own);
                    add_scaled(&mut y, &own, -along);
                }
                y
            });
        let turning = |y: Vec<f64>| {
            let square = self.scalar_product(&y, &y);
            (square < -1e-3 * dot(&y, &y)).then(|| scaled(&y, 1.0 / (-square).sqrt()))
        };
        std::iter::once(own.clone()).chain(others).filter_map(turning).collect()
    }
}

/// The factor κ with `B = F κ` for `C = cosh B`: halves until C is near 1.
fn sinh_factor(ring: Ring, mut c: Pair) -> Option<Pair> {
    let one_minus = |c: Pair| Pair { x: 1.0 - c.x, y: -c.y };
    let mut factor = Pair::ONE;
    for _ in 0..=MOST_HALVINGS {
        if ring.radius(one_minus(c)) <= NEAR {
            return Some(ring.mul(factor, ring.series(&ARCOSH, one_minus(c).scale(0.5))));
        }
        c = ring.sqrt(c.plus(Pair::ONE).scale(0.5))?;
        // B = 2 · B/2, with sinh(B/2) = F / 2 cosh(B/2): the factors 2 cancel.
        factor = ring.mul(factor, ring.inverse(c));
    }
    None
}

/// The coefficients tⱼ of g.
pub(super) const ARCOSH: [f64; 14] = {
    let mut t = [1.0; 14];
    let mut j = 1;
    while j < 14 {
        t[j] = t[j - 1] * (2 * j) as f64 / (2 * j + 1) as f64;
        j += 1;
    }
    t
};
