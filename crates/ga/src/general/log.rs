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
//! With up to five generators C is `x + yU` (see `pair`), and the whole walk takes a few numbers. With
//! more it is walked in the algebra (see `roots`).
//!
//! The walk ends at the logarithm whose numbers `x ± y√q` have imaginary parts within ±π. It has no
//! start where one of those of C is −1 or less: there R turns by a whole turn in some plane, or boosts
//! besides, and R commutes with a bivector Y of that plane; then `log R = Y + log(R exp(−Y))`.
//!
//! Every result is checked: `exp(log R)` must be R again.

use super::pair::{Pair, Ring};
use super::{Calculus, add_scaled, grade, part, reverse, scaled};
use crate::functions::MathError;
use crate::values::{norm, scale_of};
use std::f64::consts::FRAC_PI_2;

/// How far `R~R` may be from a number, and `exp(log R)` from R per unit of `1 + |log R|`.
pub const VERSOR_TOLERANCE: f64 = 1e-12;

/// The most that the size of a logarithm may loosen its check.
const MOST_LENIENT: f64 = 1e3;

/// Rounding of the few sums of products in `M~M`, relative to `|M|²`.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

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
    /// With up to five generators it is found wherever there is one. With more, where the sum of the
    /// angles of B over its planes is below π, and in some other cases; otherwise it is an error.
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

    /// Size and bivector of an even versor; none of zero.
    ///
    /// Where `M~M = 1` to rounding the size is exactly 1: for a boost by more than 18, `M~M` is the
    /// difference of numbers too large to tell it.
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
        let square = self.product(&m, &reverse(&m));
        let total = norm(&m).powi(2);
        let odd = norm(&part(&m, |k| k % 2 == 1));
        let deviation = (norm(&square[1..]) / total).max(odd / total.sqrt());
        if deviation > VERSOR_TOLERANCE {
            return Err(MathError::NotVersor { deviation });
        }
        let unit = 1.0 / (scale * scale);
        if (square[0] - unit).abs() <= ROUNDING * total {
            let bivector = self.log_of_unit(&scaled(&m, scale))?;
            return Ok(Some(Polar { size: 1.0, bivector, null_factor }));
        }
        if square[0].abs() <= ROUNDING * total {
            return Err(MathError::NoLogarithm);
        }
        if square[0] < 0.0 {
            return Err(MathError::NoBivectorLogarithm);
        }
        let size = square[0].sqrt();
        let bivector = self.log_of_unit(&scaled(&m, 1.0 / size))?;
        Ok(Some(Polar { size: size * scale, bivector, null_factor }))
    }

    /// The bivector B with `exp B = R`.
    fn log_of_unit(&self, r: &[f64]) -> Result<Vec<f64>, MathError> {
        let found = self.checked_log(r).or_else(|| {
            self.commuting_planes(r).into_iter().find_map(|plane| {
                let y = scaled(&plane, FRAC_PI_2);
                let rest = self.product(r, &self.exp_bits(&scaled(&y, -1.0)).ok()?);
                let mut log = self.principal_log(&rest)?;
                add_scaled(&mut log, &y, 1.0);
                self.is_log(&log, r).then_some(log)
            })
        });
        found.ok_or(MathError::NoBivectorLogarithm)
    }

    fn checked_log(&self, r: &[f64]) -> Option<Vec<f64>> {
        self.principal_log(r).filter(|log| self.is_log(log, r))
    }

    /// Whether `exp(log) = R`.
    fn is_log(&self, log: &[f64], r: &[f64]) -> bool {
        let Ok(mut difference) = self.exp_bits(log) else { return false };
        add_scaled(&mut difference, r, -1.0);
        norm(&difference) <= VERSOR_TOLERANCE * norm(r) * (1.0 + norm(log)).min(MOST_LENIENT)
    }

    fn principal_log(&self, r: &[f64]) -> Option<Vec<f64>> {
        if self.generators > 5 {
            return self.log_by_roots(r);
        }
        let f = part(r, |k| k == 2);
        let mut unit = part(r, |k| k == 4);
        let mut y = norm(&unit);
        // Rounding of a simple rotor, which would only disturb it near −1.
        if y <= ROUNDING * norm(r) && self.null == 0 {
            y = 0.0;
        }
        unit.iter_mut().for_each(|x| *x = if y > 0.0 { *x / y } else { 0.0 });
        let ring = Ring { q: self.scalar_product(&unit, &unit) };
        let square = self.product(&f, &f);
        let along_unit: f64 = square.iter().zip(&unit).map(|(a, b)| a * b).sum();
        let f_squared = Pair { x: square[0], y: along_unit };
        let turns = ring.radius(f_squared) > ROUNDING * norm(&f).powi(2);
        let factor = log_over_sinh(ring, Pair { x: r[0], y }, turns.then_some(f_squared))?;
        let turned = self.product(&f, &unit);
        Some(
            (0..r.len())
                .map(|b| if grade(b) == 2 { factor.x * f[b] + factor.y * turned[b] } else { 0.0 })
                .collect(),
        )
    }

    /// Bivectors that commute with R, of square about −1, perpendicular to R's own.
    ///
    /// The condition `YR = RY` is linear in Y; its solutions are the eigenvectors of eigenvalue 0 of the
    /// matrix of `|YR − RY|²`.
    fn commuting_planes(&self, r: &[f64]) -> Vec<Vec<f64>> {
        let basis: Vec<usize> = (0..r.len()).filter(|&b| grade(b) == 2).collect();
        let commutators: Vec<Vec<f64>> = basis
            .iter()
            .map(|&b| {
                let mut plane = vec![0.0; r.len()];
                plane[b] = 1.0;
                let mut difference = self.product(&plane, r);
                add_scaled(&mut difference, &self.product(r, &plane), -1.0);
                difference
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let gram = commutators.iter().map(|a| commutators.iter().map(|b| dot(a, b)).collect()).collect();
        let (values, vectors) = super::roots::symmetric_eigen(gram);
        let f = part(r, |k| k == 2);
        let own = dot(&f, &f);
        let bound = VERSOR_TOLERANCE * norm(r).powi(2);
        let commuting = values.iter().zip(vectors).filter(|(value, _)| **value <= bound);
        commuting
            .filter_map(|(_, components)| {
                let mut y = vec![0.0; r.len()];
                basis.iter().zip(components).for_each(|(&b, c)| y[b] = c);
                if own > bound {
                    let along = dot(&y, &f) / own;
                    add_scaled(&mut y, &f, -along);
                }
                let square = self.scalar_product(&y, &y);
                (square < -1e-3).then(|| scaled(&y, 1.0 / (-square).sqrt()))
            })
            .collect()
    }
}

/// The factor κ with `B = F κ`, for `C = cosh B` and, where it is more than rounding, `F² = sinh² B`.
///
/// With a negative real part `1 + C` cancels. Where `−F²` has a root S, so that B turns only, `F/S` is a
/// unit, and turning back by a quarter, `R' = −R F/S = S − C F/S`, leaves the rest: `κ = (π/2 + κ')/S`.
fn log_over_sinh(ring: Ring, c: Pair, f_squared: Option<Pair>) -> Option<Pair> {
    if c.x < 0.0 {
        if let Some(s) = f_squared.and_then(|square| ring.sqrt(square.scale(-1.0))) {
            let over = ring.inverse(s);
            let rest = walk(ring, s, ring.mul(c.scale(-1.0), over))?;
            return Some(rest.plus(over.scale(FRAC_PI_2)));
        }
    }
    walk(ring, c, Pair::ONE)
}

/// Halves `C = cosh B` until it is near 1; returns `phi` times the factor with `B = F · factor`.
fn walk(ring: Ring, mut c: Pair, mut phi: Pair) -> Option<Pair> {
    let one_minus = |c: Pair| Pair { x: 1.0 - c.x, y: -c.y };
    let mut halvings = 0;
    while ring.radius(one_minus(c)) > NEAR {
        c = ring.sqrt(c.plus(Pair::ONE).scale(0.5))?;
        // F/(2 cosh) of half the argument, which doubles again: the factors 2 cancel.
        phi = ring.mul(phi, ring.inverse(c));
        halvings += 1;
        if halvings > MOST_HALVINGS {
            return None;
        }
    }
    Some(ring.mul(phi, ring.series(&ARCOSH, one_minus(c).scale(0.5))))
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
