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

use crate::complex::Complex;
use crate::product::Grades;
use crate::rotor::{MATRIX_TOLERANCE, Rotor};
use crate::values::{Multivector, scale_of};
use std::f64::consts::PI;
use std::fmt;

/// Why a function has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MathError {
    /// A component is NaN or infinite.
    NotFinite,
    /// A rotor needs a component that is not zero.
    ZeroRotor,
    /// A plane of zero or non-finite size has no direction.
    NoPlane,
    /// A vector of zero or non-finite length has no direction.
    NoDirection,
    /// The matrix is not orthogonal within the tolerance.
    NotOrthogonal {
        /// `max |MᵀM − 1|`.
        deviation: f64,
    },
    /// The matrix is orthogonal with determinant −1.
    Reflection,
    /// No inverse: `|M M̄| / |M|²`, M̄ the Clifford conjugate, is zero to rounding.
    Singular {
        /// That ratio.
        ratio: f64,
    },
    /// No logarithm: an eigenvalue is zero to rounding.
    NoLogarithm,
    /// No square root: the two eigenvalues' roots cancel.
    NoSquareRoot,
    /// No inverse: the condition number of multiplication by the multivector is beyond rounding.
    IllConditioned {
        /// Its reciprocal.
        reciprocal_condition: f64,
    },
    /// No number times an even versor.
    NotVersor {
        /// The larger of its odd part and what in `M~M` is no number, relative to `|M|` and `|M|²`.
        deviation: f64,
    },
    /// No bivector has this versor as its exponential, or none was found.
    NoBivectorLogarithm,
    /// An angle so large that its rounding is more than a turn.
    AngleTooLarge,
    /// A metric with null generators has no `I⁻¹`.
    DegenerateMetric,
    /// Zero stands for no subspace.
    NoSubspace,
    /// No wedge product of vectors.
    NotBlade {
        /// The part that no blade accounts for, relative to `|M|`.
        deviation: f64,
    },
    /// The result is beyond the range of floating point.
    Overflow,
    /// A quotient by 0.
    DivisionByZero,
}

impl fmt::Display for MathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MathError::NotFinite => write!(f, "a component is NaN or infinite; remove such values first"),
            MathError::ZeroRotor => {
                write!(f, "all components are zero, which is no rotor; give the identity as 1, 0, 0, 0")
            }
            MathError::NoPlane => {
                write!(f, "a bivector of zero or non-finite size spans no plane; give a nonzero one")
            }
            MathError::NoDirection => {
                write!(f, "a vector of zero or non-finite length has no direction; give a nonzero one")
            }
            MathError::NotOrthogonal { deviation } => write!(
                f,
                "not a rotation matrix: max |MᵀM − 1| = {deviation:.3e}, more than {MATRIX_TOLERANCE:e}; orthogonalize it first"
            ),
            MathError::Reflection => write!(
                f,
                "the matrix has determinant −1, a reflection; a rotation has +1; swap or flip an axis"
            ),
            MathError::Singular { ratio } => write!(
                f,
                "no inverse: the multivector is singular to rounding (|M M̄|/|M|² = {ratio:.1e}, M̄ its Clifford conjugate)"
            ),
            MathError::NoLogarithm => write!(f, "no logarithm: the multivector is singular to rounding"),
            MathError::NoSquareRoot => write!(f, "no square root: the multivector is singular to rounding"),
            MathError::IllConditioned { reciprocal_condition } => write!(
                f,
                "no inverse: singular to rounding (reciprocal condition {reciprocal_condition:.1e})"
            ),
            MathError::NotVersor { deviation } => write!(
                f,
                "not an even versor (a product of an even number of vectors): M ~M is no number, or M not even \
                 (relative deviation {deviation:.1e}); logarithm and square root are known for versors only"
            ),
            MathError::NoBivectorLogarithm => {
                write!(f, "no logarithm: no bivector was found that has this versor as its exponential")
            }
            MathError::AngleTooLarge => {
                write!(f, "an angle beyond 2^52, whose rounding is a turn; reduce it first")
            }
            MathError::DegenerateMetric => write!(
                f,
                "no dual: a generator squares to zero, so the pseudoscalar has no inverse; take the complement"
            ),
            MathError::NoSubspace => write!(f, "zero stands for no subspace; give a nonzero blade"),
            MathError::NotBlade { deviation } => write!(
                f,
                "not a blade (a wedge product of vectors): a part of {deviation:.1e} of it remains; give one grade, factored"
            ),
            MathError::Overflow => write!(
                f,
                "the result is beyond the range of floating point (1.8e308); scale the argument down"
            ),
            MathError::DivisionByZero => write!(f, "division by zero; give a divisor that is not 0"),
        }
    }
}

impl std::error::Error for MathError {}

/// Beyond this `cosh` and `sinh` are exponentials that no longer nearly cancel in `e^(ζ+√w) ± e^(ζ−√w)`.
const LARGE: f64 = 1.0;

/// Below this `|M M̄|/|M|²` is rounding: each of its two parts sums four products of terms up to |M|².
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

/// A function of one multivector, and the grades its values may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// [`Multivector::inverse`].
    Inverse,
    /// [`Multivector::exp`].
    Exp,
    /// [`Multivector::log`].
    Log,
    /// [`Multivector::sqrt`].
    Sqrt,
}

impl Function {
    /// Every function.
    pub const ALL: [Function; 4] = [Function::Inverse, Function::Exp, Function::Log, Function::Sqrt];

    /// The function of this name: `inverse`, `exp`, `log`, `sqrt`.
    pub fn from_name(name: &str) -> Option<Function> {
        Function::ALL.into_iter().find(|f| f.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Function::Inverse => "inverse",
            Function::Exp => "exp",
            Function::Log => "log",
            Function::Sqrt => "sqrt",
        }
    }

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
    /// Two grades that square to a number, such as scalar and vector, are closed under products, and so
    /// under power series and inverse. Roots and logarithms leave them, except the even elements.
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

    /// Size and rotor of an even element, `M = |M| R`; none of zero.
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

    /// `exp M = e^ζ (cosh √w + V sinh √w / √w)`; both are even in √w, so either root serves. For a large
    /// real part of √w the exponents are added first: `e^(ζ ± √w)` may exist where `cosh √w` does not.
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

    /// A logarithm, `exp(log M) = M`. For an even M it is even: `log|M|` plus the log of a rotor; for
    /// others the principal one, `½(log λ+ + log λ−) + V (log λ+ − log λ−)/(2√w)`. Where `√w/ζ` is small
    /// the difference cancels, unless the two logarithms lie on either side of the cut; it is then
    /// `2 artanh(√w/ζ)`.
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
        let sum = (zeta + root).sqrt() + (zeta - root).sqrt();
        if sum.norm() * sum.norm() <= SINGULAR * (zeta.norm() + v.norm()) {
            return Err(MathError::NoSquareRoot);
        }
        Ok(join(sum.scale(0.5), v, Complex::ONE / sum) * scale.sqrt())
    }
}
