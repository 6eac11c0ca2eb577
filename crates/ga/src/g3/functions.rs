//! Inverse, exponential, logarithm and square root of any multivector of G3.
//!
//! Split `M = ζ + V` into its central part `ζ = α + βI` and `V = a + B`. I commutes with everything and
//! squares to −1, so ζ is a complex number, and so is `V² = a² + B² + 2 a∧B = w`: V behaves like a
//! number with the two values `±√w`. Hence for any analytic f, with `λ± = ζ ± √w`,
//!
//! ```text
//! f(M) = (f(λ+) + f(λ−))/2 + V (f(λ+) − f(λ−))/(2√w).
//! ```
//!
//! Each function below is this formula, rearranged so that nothing cancels as `w → 0`.

use super::complex::Complex;
use super::rotor::Rotor;
use super::values::{Multivector, scale_of};
use crate::error::MathError;
use crate::product::{Grades, named};
use std::f64::consts::PI;

/// Beyond this `e^(ζ+√w) ± e^(ζ−√w)` do not cancel.
const LARGE: f64 = 1.0;

/// Below this `|M M̄|/|M|²` is rounding of two sums of four products.
const SINGULAR: f64 = 8.0 * f64::EPSILON;

/// `M = ζ + V`, `V² = w`.
fn split(m: Multivector) -> (Complex, Multivector, Complex) {
    let zeta = Complex::new(m.0[0], m.0[7]);
    let (a, b) = (m.vector_part(), m.bivector_part());
    let v = Multivector::from(a) + Multivector::from(b);
    let w = Complex::new(a.norm_squared() - b.norm_squared(), 2.0 * a.wedge_bivector(b).0);
    (zeta, v, w)
}

/// `c + V d` for central c and d.
fn join(c: Complex, v: Multivector, d: Complex) -> Multivector {
    let mut m = v * d.re + v.undual() * d.im;
    m.0[0] += c.re;
    m.0[7] += c.im;
    m
}

fn finite(m: Multivector) -> Result<Multivector, MathError> {
    if m.0.iter().all(|x| x.is_finite()) { Ok(m) } else { Err(MathError::NotFinite) }
}

fn in_range(m: Multivector) -> Result<Multivector, MathError> {
    if m.0.iter().all(|x| x.is_finite()) { Ok(m) } else { Err(MathError::Overflow) }
}

named! {
    /// A function of one multivector, and the grades its values may hold.
    Function: 4 {
        /// [`Multivector::inverse`].
        Inverse "inverse",
        /// [`Multivector::exp`].
        Exp "exp",
        /// [`Multivector::log`].
        Log "log",
        /// [`Multivector::sqrt`].
        Sqrt "sqrt",
    }
}

impl Function {
    /// Its value.
    pub fn apply(self, m: Multivector) -> Result<Multivector, MathError> {
        match self {
            Function::Inverse => m.inverse(),
            Function::Exp => m.exp(),
            Function::Log => m.log(),
            Function::Sqrt => m.sqrt(),
        }
    }

    /// The grades of the value for an argument of grades `g`.
    ///
    /// Two grades that square to a number, such as scalar and vector, are closed under products, power series and
    /// inverse, but of these only the even elements under roots and logarithms.
    pub fn grades(self, g: Grades) -> Grades {
        const CLOSED: [u16; 3] = [0b0101, 0b0011, 0b1001];
        // Inverse: M̄ times a number, when M M̄ has no trivector part.
        const INVERTED: [u16; 9] = [0b0001, 0b0010, 0b0100, 0b1000, 0b0011, 0b0101, 0b1010, 0b1100, 0b1001];
        let closure =
            |sets: &[u16]| sets.iter().map(|&s| Grades(s)).find(|&s| g.within(s)).unwrap_or(Grades::ALL);
        match self {
            Function::Inverse => closure(&INVERTED),
            Function::Exp if g == Grades::SCALAR => Grades::SCALAR,
            Function::Exp => closure(&CLOSED),
            Function::Log | Function::Sqrt => closure(&CLOSED[..1]),
        }
    }
}

impl Multivector {
    /// True where only the scalar and bivector parts are nonzero.
    fn is_even(self) -> bool {
        [1, 2, 3, 7].iter().all(|&i| self.0[i] == 0.0)
    }

    /// Size and rotor of an even element, `M = |M| R`; None for zero.
    fn polar(self) -> Option<(f64, Rotor)> {
        let rotor = Rotor::from_components([self.0[0], self.0[4], self.0[5], self.0[6]]).ok()?;
        Some((self.norm(), rotor))
    }

    /// `M⁻¹ = M̄ (M M̄)⁻¹`, since with the Clifford conjugate `M̄ = ζ − V` the product `M M̄ = ζ² − w` is
    /// central. It vanishes for null elements such as `1 + e1`, which have no inverse.
    pub fn inverse(self) -> Result<Multivector, MathError> {
        finite(self)?;
        let scale = scale_of(&self.0);
        let m = self / scale;
        let (zeta, v, w) = split(m);
        let determinant = zeta * zeta - w;
        let size = m.norm_squared();
        let ratio = if size == 0.0 { 0.0 } else { determinant.norm() / size };
        if ratio <= SINGULAR {
            return Err(MathError::Singular { ratio });
        }
        let reciprocal = Complex::ONE / determinant;
        in_range(join(zeta * reciprocal, v, -reciprocal) / scale)
    }

    /// `exp M = e^ζ (cosh √w + V sinh √w / √w)`, even in √w. For a large real part of √w the exponents are added first:
    /// `e^(ζ ± √w)` may be finite where `cosh √w` is not.
    pub fn exp(self) -> Result<Multivector, MathError> {
        finite(self)?;
        if self.is_even() {
            let [s, x, y, z] = Rotor::exp(self.bivector_part()).components();
            let e = self.0[0].exp();
            return in_range(Multivector([e * s, 0.0, 0.0, 0.0, e * x, e * y, e * z, 0.0]));
        }
        let scale = scale_of(&self.0);
        let (zeta, v, _) = split(self);
        let (_, _, w) = split(self / scale);
        let root = w.sqrt().scale(scale);
        if root.re.abs() > LARGE {
            let (plus, minus) = ((zeta + root).exp().scale(0.5), (zeta - root).exp().scale(0.5));
            return in_range(join(plus + minus, v, (plus - minus) / root));
        }
        let factor = zeta.exp();
        in_range(join(factor * root.cosh(), v, factor * root.sinhc()))
    }

    /// A logarithm, `exp(log M) = M`. For an even M it is even: `log|M|` plus the log of a rotor; otherwise the
    /// principal one, `½(log λ+ + log λ−) + V (log λ+ − log λ−)/(2√w)`. For small `√w/ζ` the difference, unless it
    /// crosses the cut, is computed as `2 artanh(√w/ζ)`.
    pub fn log(self) -> Result<Multivector, MathError> {
        finite(self)?;
        let scale = scale_of(&self.0);
        let m = self / scale;
        if self.is_even() {
            let (length, rotor) = m.polar().ok_or(MathError::NoLogarithm)?;
            return Ok(Multivector::scalar(scale.ln() + length.ln()) + rotor.log().into());
        }
        let (zeta, v, w) = split(m);
        let root = w.sqrt();
        let (plus, minus) = (zeta + root, zeta - root);
        let smallest = plus.norm().min(minus.norm());
        if smallest <= SINGULAR * (zeta.norm() + root.norm() + v.norm()) {
            return Err(MathError::NoLogarithm);
        }
        let (log_plus, log_minus) = (plus.ln(), minus.ln());
        let difference = log_plus - log_minus;
        let quotient = if root.norm() < 0.5 * zeta.norm() && difference.im.abs() < PI {
            (root / zeta).artanhc() / zeta
        } else {
            difference.scale(0.5) / root
        };
        let mean = (log_plus + log_minus).scale(0.5);
        Ok(Multivector::scalar(scale.ln()) + join(mean, v, quotient))
    }

    /// A square root. For an even M it is `√|M|` times the half-way rotor, `√(−1) = e1e2`; for others
    /// the principal one, `½(√λ+ + √λ−) + V/(√λ+ + √λ−)`.
    pub fn sqrt(self) -> Result<Multivector, MathError> {
        finite(self)?;
        let scale = scale_of(&self.0);
        let m = self / scale;
        if self.is_even() {
            let Some((length, rotor)) = m.polar() else { return Ok(self) };
            let half = Multivector::from(Rotor::exp(rotor.log() * 0.5));
            return Ok(half * (length.sqrt() * scale.sqrt()));
        }
        let (zeta, v, w) = split(m);
        let root = w.sqrt();
        let (plus, minus) = ((zeta + root).sqrt(), (zeta - root).sqrt());
        let (mut sum, difference) = (plus + minus, plus - minus);
        let singular = if sum.norm() < 0.5 * difference.norm() {
            // λ± lie on both sides of the cut and the sum cancels; λ+ − λ− = 2√w does not, unless w or V is rounding.
            sum = root.scale(2.0) / difference;
            w.norm() <= (SINGULAR * v.norm_squared()).max(f64::EPSILON * f64::EPSILON)
        } else {
            sum.norm() * sum.norm() <= SINGULAR * (zeta.norm() + v.norm())
        };
        if singular {
            return Err(MathError::NoSquareRoot);
        }
        Ok(join(sum.scale(0.5), v, Complex::ONE / sum) * scale.sqrt())
    }
}
